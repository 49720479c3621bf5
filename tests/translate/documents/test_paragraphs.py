"""Characters into paragraphs: the rules one by one, and the laws of cutting."""

import random
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conftest import SEED
from tests.tiers import examples
from tests.translate.model import Piece, pieces_of
from vbraille.translate.documents.document import PIECE_CHARACTERS, split_paragraphs
from vbraille.translate.documents.encodings import (
    LONGEST_BLANK,
    Stretch,
    shorten_blanks,
)
from vbraille.translate.source import Block, to_codes, to_text

# What the rules speak of, and a few letters.
AWKWARD = list("aaé- \n\r\t\f\v\x85\xa0\xad\u2010\u2028\u2029\u202f\u0301\ufeff\0\ud800😀.")
AWKWARD += ["\b", "_", "_\b", "a\ba", "\b_"]
AWKWARD += ["\n\n", "\r\n", " and", "-\n", "-\nor ", "\xad\n", "  "]
AWKWARD += ["\n- ", "\n– ", "\n•\t", "\n1. ", "\n(2) ", "\n3)", ":\n", "\na) ", "\nb) ", "\n7. "]
awkward_texts = st.lists(st.sampled_from(AWKWARD), max_size=40).map("".join)


def at(codes, first: int = 0) -> Stretch:
    """Characters from a place of a document on."""
    if isinstance(codes, str):
        codes = to_codes(codes)
    return Stretch.whole(codes, first)


def split(text: str, **how) -> list[str]:
    return [str(b.text) for b in split_paragraphs(at(text), **how).blocks]


def pieces(blocks: list[Block]) -> list[Piece]:
    return [Piece(str(b.text), b.text.places.tolist(), b.continues) for b in blocks]


class TestProse:
    @pytest.mark.parametrize(
        ("text", "paragraphs"),
        [
            ("one\ntwo", ["one two"]),
            ("one\r\ntwo\rthree\vfour\u2028five\x85six", ["one two three four five six"]),
            ("one\n\ntwo", ["one", "two"]),
            ("one\r\n\r\ntwo\r\rthree", ["one", "two", "three"]),
            ("one\n \t \ntwo", ["one", "two"]),
            ("one\ftwo\u2029three", ["one", "two", "three"]),
            ("\n\n  one  \n\n\n\n", ["one"]),
            ("one \t\u2003\u3000 two", ["one two"]),
            (" \n", []),
            ("", []),
        ],
    )
    def test_blank_lines_separate_and_lines_join(self, text, paragraphs):
        assert split(text) == paragraphs

    @pytest.mark.parametrize(
        ("text", "paragraph"),
        [
            ("exam\xadple", "example"),
            ("exam\xad\nple", "example"),
            ("exam\xad\r\n  ple", "example"),
            ("exam\xad ple", "exam ple"),
            ("well-\nknown", "well-known"),
            ("well\u2010\nknown", "well\u2010known"),
            ("pre-\nand post-war", "pre- and post-war"),
            ("ein-\noder", "ein- oder"),
            ("pre-\norder", "pre-order"),
            ("1990-\n95", "1990-95"),
            ("COVID-\n19", "COVID-19"),
            ("16-\nbit", "16-bit"),
            ("19-\nand 20-year-olds", "19- and 20-year-olds"),
            ("- \nitem", "- item"),
            ("a -\nb", "a - b"),
            ("a-\n\xa0", "a- \xa0"),
            ("a-\n\x1c\x1c", "a- \x1c\x1c"),
            ("a-\n-", "a- -"),
            ("-\xad\na", "-a"),
        ],
    )
    def test_hyphens_at_the_end_of_a_line(self, text, paragraph):
        assert split(text) == [paragraph]

    @pytest.mark.parametrize(
        ("text", "paragraph"),
        [
            ("_\bb_\bo", "bo"),
            ("b\b_o\b_", "bo"),
            ("b\bbo\bo\bo", "bo"),
            ("_\bb\bb", "b"),
            ("a _\bb\n_\bc", "a b c"),
            ("e\b'", "e\b'"),
            ("\ba\b", "\ba\b"),
        ],
    )
    def test_overstrikes_are_no_text(self, text, paragraph):
        assert split(text) == [paragraph]
        assert split(text, keep_lines=True) == paragraph.replace("b c", "b\nc").split("\n")

    @pytest.mark.parametrize(
        ("text", "paragraphs"),
        [
            ("Buy\n- milk\n- eggs\n  of hens\n- tea", ["Buy", "- milk", "- eggs of hens", "- tea"]),
            ("• one\n• two", ["• one", "• two"]),
            ("Buy\n-\u202fmilk\n-\u2007tea", ["Buy", "-\xa0milk", "-\xa0tea"]),
            ("* one\n* two\nand more", ["* one", "* two and more"]),
            ("Steps\n1. go\n2. come\nback\n3. stay", ["Steps", "1. go", "2. come back", "3. stay"]),
            ("9) nine\n10) ten\n12) no", ["9) nine", "10) ten 12) no"]),
            ("(a) one\n(b) two", ["(a) one", "(b) two"]),
            ("as follows:\n4. four\n5. five", ["as follows:", "4. four", "5. five"]),
            ("It was in\n1990. Then it was\n12. So", ["It was in 1990. Then it was 12. So"]),
            ("a dash\n– like this – is none", ["a dash – like this – is none"]),
            ("– Oui.\n– Non.", ["– Oui.", "– Non."]),
            ("1. one\n\n2 is\n2. no", ["1. one", "2 is 2. no"]),
            ("-5 is\n-6 plus\n*not*", ["-5 is -6 plus *not*"]),
            ("1.5 is\n1.", ["1.5 is 1."]),
        ],
    )
    def test_items_of_a_list_are_paragraphs(self, text, paragraphs):
        assert split(text) == paragraphs

    @pytest.mark.parametrize("space", ["\xa0", "\u2007", "\u202f"])
    def test_no_break_spaces_stay(self, space):
        assert split(f"12{space}500  {space} km") == ["12\xa0500 \xa0 km"]

    def test_controls_surrogates_and_zeros_stay(self):
        text = "a\0b\x01\x1b\ud800c\udfff\x7f"
        assert split(text) == [text]

    def test_a_byte_order_mark_goes_and_splits_no_word(self):
        assert split("\ufeffone tw\ufeffo") == ["one two"]

    def test_accents_join_their_letters(self):
        found = split_paragraphs(at("e\u0301te\u0323\u0301 x\u0301", 5)).blocks[0].text
        assert str(found) == "\xe9t\u1eb9\u0301 x\u0301"
        assert found.places.tolist() == [5, 7, 8, 10, 11, 12, 13]
        assert found.end == 14

    def test_accents_do_not_depend_on_what_else_is_in_the_text(self):
        alone = split("\u0627\u0653")
        assert split("\u0627\u0653\n\ne\u0301") == [*alone, "\xe9"]

    def test_every_character_knows_its_place(self):
        text = "  one\r\n  two\n\n\tthree  four"
        found = split_paragraphs(at(text, 100)).blocks
        assert [b.text.places.tolist() for b in found] == [
            [102, 103, 104, 105, 109, 110, 111],
            [115, 116, 117, 118, 119, 120, 122, 123, 124, 125],
        ]
        assert [b.text.end for b in found] == [112, 126]

    @examples(150)
    @given(awkward_texts)
    def test_as_the_model(self, text):
        assert pieces(split_paragraphs(at(text)).blocks) == pieces_of(text)


class TestLinesKept:
    @pytest.mark.parametrize(
        ("text", "lines"),
        [
            ("one\ntwo", ["one", "two"]),
            ("one\n\ntwo\n\n\n\nthree", ["one", "", "two", "", "three"]),
            ("one\r\n\r\ntwo\r\n", ["one", "", "two"]),
            ("one\n \t \n  two  \nthree", ["one", "", "  two", "three"]),
            ("if x:\n\treturn  y", ["if x:", " return  y"]),
            ("well-\nknown", ["well-", "known"]),
            ("one\ftwo", ["one", "two"]),
            ("\n\n\n", []),
            ("\n\n one", [" one"]),
            ("exam\xad\nple", ["exam", "ple"]),
        ],
    )
    def test_lines_and_their_blanks(self, text, lines):
        assert split(text, keep_lines=True) == lines

    @examples(150)
    @given(awkward_texts)
    def test_as_the_model(self, text):
        found = split_paragraphs(at(text), keep_lines=True).blocks
        assert pieces(found) == pieces_of(text, keep_lines=True)


class TestInParts:
    @examples(150)
    @given(awkward_texts, st.data(), st.booleans())
    def test_reading_on_later_gives_the_same(self, text, data, keep_lines):
        codes = to_codes(text)
        end = data.draw(st.integers(0, codes.size))
        early = split_paragraphs(at(codes[:end], 7), final=False, keep_lines=keep_lines)
        assert early.used <= end
        late = split_paragraphs(
            at(codes[early.used :], 7 + early.used),
            continues=early.continues,
            item=early.item,
            keep_lines=keep_lines,
        )
        whole = split_paragraphs(at(codes, 7), keep_lines=keep_lines)
        assert pieces(early.blocks + late.blocks) == pieces(whole.blocks)

    @pytest.mark.parametrize("end", range(-9, 10))
    @pytest.mark.parametrize(
        "tail", ["pre-\nand so on", "pre-\nandante", "e\u0301e\u0301e\u0301 x"]
    )
    def test_a_long_paragraph_is_cut_alike_wherever_the_part_ends(self, tail, end):
        text = "a" * (PIECE_CHARACTERS - 4) + tail
        codes = to_codes(text)
        early = split_paragraphs(at(codes[: PIECE_CHARACTERS + end]), final=False)
        late = split_paragraphs(
            at(codes[early.used :], early.used), continues=early.continues, item=early.item
        )
        assert pieces(early.blocks + late.blocks) == pieces_of(text)

    def test_blanks_are_done_with_at_once(self):
        for blank in ("\n" * 100, " \n\f " * 100):
            found = split_paragraphs(at(f"one{blank}"), final=False)
            assert pieces(found.blocks) == [Piece("one", [0, 1, 2], False)]
            assert found.used == 3 + len(blank)
            assert split_paragraphs(at(blank), final=False).used == len(blank)

    def test_with_lines_kept_an_indent_waits_for_its_text(self):
        found = split_paragraphs(at("\n\n   "), final=False, keep_lines=True)
        assert (found.blocks, found.used) == ([], 2)


class TestCounting:
    @examples(200)
    @given(awkward_texts, st.booleans(), st.booleans(), st.booleans(), st.integers(0, 3))
    def test_counting_tells_what_making_the_paragraphs_tells(
        self, text, final, keep_lines, continues, item
    ):
        how = {"final": final, "keep_lines": keep_lines, "continues": continues, "item": item}
        made = split_paragraphs(at(text, 5), **how)
        counted = split_paragraphs(at(text, 5), **how, count=True)
        assert counted.blocks == []
        assert made.count == len(made.blocks)
        assert made.end == (made.blocks[-1].text.end if made.blocks else 0)
        assert replace(made, blocks=[]) == counted

    @pytest.mark.parametrize("final", [False, True])
    def test_a_paragraph_that_is_cut_counts_as_its_pieces(self, final):
        stretch = at("one\n\n" + "word " * PIECE_CHARACTERS)
        made = split_paragraphs(stretch, final=final)
        counted = split_paragraphs(stretch, final=final, count=True)
        assert made.count > 4
        assert replace(counted, blocks=[]) == replace(made, blocks=[])


class TestLongBlanks:
    @given(st.lists(st.tuples(st.integers(0, 2), st.integers(1, 2 * LONGEST_BLANK)), max_size=6))
    def test_runs_are_shortened_alike_in_parts_and_whole(self, runs):
        texts = [("x", " ", " \t")[kind] * length for kind, length in runs]
        text = "".join(texts)
        parts, blanks, begun = [at("")], 0, 0
        for part in texts:
            shortened, blanks = shorten_blanks(to_codes(part), begun, blanks)
            begun += len(part)
            parts.append(shortened)
        whole, end = shorten_blanks(to_codes(text), 0)
        joined = Stretch.joined(parts)
        assert end == blanks == len(text) - len(text.rstrip())
        for stretch in (whole, joined):
            kept = to_text(stretch.codes)
            assert kept == re.sub(r"\s+", lambda run: run[0][:LONGEST_BLANK], text)
            assert "".join(text[n] for n in stretch.place(np.arange(len(stretch)))) == kept


class TestLongParagraphs:
    @pytest.mark.parametrize("keep_lines", [False, True])
    def test_pieces_are_the_whole(self, keep_lines):
        chance = random.Random(SEED)
        for kind in (["a", "b"], ["a", " "], ["ab", " ", ". "], ["e", "\u0301"], ["\u0301"]):
            text = f"x{''.join(chance.choices(kind, k=20_000))}x"
            found = split_paragraphs(at(text), keep_lines=keep_lines).blocks
            assert len(found) > 1
            assert all(0 < len(b.text) <= PIECE_CHARACTERS + 1 for b in found)
            assert [b.continues for b in found] == [False] + [True] * (len(found) - 1)
            assert pieces(found) == pieces_of(text, keep_lines=keep_lines)

    def test_cut_after_a_sentence_else_at_a_space_else_anywhere(self):
        sentences = split("It is so. " * 1_000)
        assert all(p.endswith(". ") for p in sentences[:-1])
        words = split("word " * 2_000)
        assert all(p.endswith("word ") for p in words[:-1])
        letters = split("w" * 20_000)
        assert [len(p) for p in letters] == [8_192, 8_192, 3_616]

    def test_an_accent_stays_with_its_letter(self):
        for text in split("e\u0301" * 4_095 + "abe\u0301" + "z" * 9_000):
            assert not text.startswith("\u0301")


@given(awkward_texts)
def test_the_alphabet_holds_all_characters(text):
    for block in split_paragraphs(at(text)).blocks:
        assert block.text.alphabet >= set(block.text.codes.tolist())
