"""Documents that are read by the chunk: it does not show, and no more is read than is wanted."""

import gc
import io
import random
import tracemalloc

import numpy as np
import pytest

from tests.conftest import SEED
from tests.tiers import heavy
from tests.translate.documents.pieces import (
    Repeated,
    blocks,
    document,
    iter_blocks,
    made_text,
    piece,
    pieces,
)
from tests.translate.model import pieces_of
from vbraille.translate import Document
from vbraille.translate.documents.document import CHUNK_BYTES


@pytest.fixture(scope="module")
def words(texts) -> tuple[str, ...]:
    text = (texts / "francais.txt").read_text() + (texts / "deutsch.txt").read_text()
    return tuple(sorted(set(text.split())))


@pytest.mark.no_cover
class TestChunks:
    """Where the file's chunks end must not show."""

    @pytest.mark.parametrize(
        ("encoding", "length", "keep_lines"),
        [
            ("utf-8", 135_000, False),
            ("utf-16-be", 67_500, True),
            ("utf-32", 35_000, False),
            # What is found is the same text, decoded from other bytes.
            pytest.param("utf-8", 135_000, True, marks=heavy),
            pytest.param("utf-16", 67_500, False, marks=heavy),
            pytest.param("gb18030", 135_000, False, marks=heavy),
        ],
    )
    def test_as_the_model(self, words, encoding, length, keep_lines):
        text = made_text(words, length, ends=True)
        raw = text.encode(encoding)
        assert len(raw) > 2 * CHUNK_BYTES
        named = encoding if encoding == "gb18030" else None
        found = pieces(document(raw, named, keep_lines=keep_lines))
        assert found == pieces_of(text, keep_lines=keep_lines)

    def test_a_paragraph_longer_than_many_blocks(self, words):
        no_items = tuple(word for word in words if word[0].isalpha() and word[-1] not in ").")
        text = made_text(no_items, 140_000, ends=False)
        found = pieces(document(text.encode()))
        assert found == pieces_of(text)
        assert len(found) > 16
        assert {p.continues for p in found[1:]} == {True}

    def test_a_run_of_blanks_of_any_length_takes_no_memory_and_keeps_the_places(self):
        blanks = 2_000_000
        raw = b"x" + b" " * blanks + b"y\nz"
        for keep_lines in (False, True):
            gc.collect()
            tracemalloc.start()
            found = pieces(document(raw, keep_lines=keep_lines))
            _, peak = tracemalloc.get_traced_memory()
            tracemalloc.stop()
            assert peak < 12 * CHUNK_BYTES * 8
            shown = "".join(piece.text for piece in found)
            places = [place for piece in found for place in piece.source]
            assert shown.split() == (["x", "yz"] if keep_lines else ["x", "y", "z"])
            letters = [place for place, c in zip(places, shown, strict=True) if c != " "]
            assert letters == [0, blanks + 1, blanks + 3]

    @pytest.mark.parametrize(
        "unit",
        [
            "€",
            "\r\n\r\n",
            "x\xad\n",
            "e\u0301 ",
            *(pytest.param(u, marks=heavy) for u in ("é", "😀", "\r\n")),
        ],
    )
    def test_what_straddles_a_boundary(self, unit):
        line, size = b"a" * 62 + b"\n\n", len(unit.encode())
        for shift in range(size + 1):
            before = (line * 1_024)[2 * size - shift :]
            tail = f"{unit * 4}end of it"
            after = f"\n\n{tail}"
            expected = [
                p._replace(source=[len(before) + at for at in p.source]) for p in pieces_of(tail)
            ]
            for whole in (tail, tail + after):
                found = pieces(document(before + whole.encode()))
                assert found[1_024:][: len(expected)] == expected

    @pytest.mark.parametrize("shift", [3, CHUNK_BYTES - 1])
    def test_blanks_in_front_move_the_places_and_nothing_else(self, words, shift):
        text = made_text(words, 135_000, ends=True)
        plain = blocks(document(text.encode()))
        moved = blocks(document(b" " * shift + text.encode()))
        assert [str(p.text) for p in moved] == [str(p.text) for p in plain]
        assert np.array_equal(
            np.concatenate([p.text.places for p in moved]),
            np.concatenate([p.text.places for p in plain]) + shift,
        )

    @pytest.mark.parametrize(
        ("blank", "keep_lines"),
        [
            *((blank, False) for blank in ("\n", " ", "\r\n", " \t\n", "\f", "\ufeff", "\xad")),
            *((blank, True) for blank in ("\n", "\ufeff", "\xad")),
            # Kept lines of these take as long as that of "\n", which ends lines as they do.
            *(pytest.param(blank, True, marks=heavy) for blank in (" ", "\r\n", " \t\n", "\f")),
        ],
    )
    def test_long_stretches_of_nothing(self, blank, keep_lines):
        nothing = blank * (CHUNK_BYTES // len(blank.encode()) + 1)
        text = f"\n{nothing}  one{nothing}  two  {nothing}"
        found = pieces(document(text.encode(), keep_lines=keep_lines))
        assert found == pieces_of(text, keep_lines=keep_lines)

    def test_nothing_but_blanks(self):
        blank = document(b" \n" * 100_000)
        assert blank.block(0) is None
        assert blank.block_at(0) is None
        assert document(b"\n").block(0) is None

    @pytest.mark.parametrize("damage", [70_000, 131_071])
    def test_a_later_bad_byte_is_windows_1252(self, damage):
        raw = bytearray("aé€ ".encode() * 20_000)
        raw[damage] = 0x92
        text = bytes(raw).decode("utf-8", "surrogateescape")
        whole = "".join(
            bytes([ord(c) - 0xDC00]).decode("cp1252") if "\udc80" <= c <= "\udcff" else c
            for c in text
        )
        found = document(bytes(raw))
        assert pieces(found) == pieces_of(whole)
        assert found.encoding.name == "utf-8"


@pytest.mark.no_cover
class TestRandomAccess:
    @pytest.mark.parametrize("keep_lines", [False, True])
    def test_blocks_in_any_order(self, words, keep_lines):
        text = made_text(words, 80_000, ends=True)
        one = document(text.encode(), keep_lines=keep_lines)
        expected = pieces(one)
        order = list(range(len(expected))) * 2
        random.Random(SEED).shuffle(order)
        other = document(text.encode(), keep_lines=keep_lines)
        for n in order[:25]:
            assert piece(other.block(n)) == expected[n]
            assert piece(one.block(n)) == expected[n]
        assert other.block(len(expected)) is None
        assert other.block(-1) is None

    def test_pieces_of_a_long_paragraph_in_any_order(self, words):
        text = made_text(words, 140_000, ends=False)
        expected = pieces(document(text.encode()))
        other = document(text.encode())
        for n in (13, 3, 16, 0, 11, 12, 10):
            assert piece(other.block(n)) == expected[n]

    def test_an_encoding_with_a_state(self):
        text = "日本語の文章。\n\n" * 5_000
        raw = text.encode("iso2022_jp")
        other = document(raw, "iso2022_jp")
        assert pieces(other) == pieces_of(text)
        for n in (4_999, 5, 3_789):
            assert str(other.block(n).text) == "日本語の文章。"

    @pytest.mark.parametrize("keep_lines", [False, True])
    def test_block_at(self, words, keep_lines):
        text = made_text(words, 80_000, ends=True)
        found = blocks(document(text.encode(), keep_lines=keep_lines))
        chance = random.Random(SEED)
        other = document(text.encode(), keep_lines=keep_lines)
        for n in chance.sample(range(len(found)), 15):
            text = found[n].text
            if len(text):
                assert other.block_at(int(text.places[0])) == n
                assert other.block_at(int(text.places[-1])) == n
                assert other.block_at(text.end) != n
        assert other.block_at(0) == 0
        assert other.block_at(found[-1].text.end) is None
        assert other.block_at(10**12) is None

    def test_blanks_belong_to_what_follows(self):
        found = document(b"  one\n\n\ntwo\n\n")
        assert [found.block_at(c) for c in range(14)] == [0] * 5 + [1] * 6 + [None] * 3

    def test_progress_grows_from_0_to_1(self, words):
        found = document(made_text(words, 80_000, ends=True).encode())
        count = len(blocks(found))
        shares = [found.progress(n) for n in range(count + 1)]
        assert shares == sorted(shares)
        assert shares[0] == 0
        assert shares[-1] == 1
        assert abs(shares[count // 2] - 0.5) < 0.1


@pytest.mark.no_cover
class TestLazy:
    def test_only_what_is_asked_for_is_read(self):
        stream = Repeated(b"A short paragraph.\n\n", 10**9)
        found = Document(stream)
        assert str(found.block(100).text) == "A short paragraph."
        assert found.block_at(1_000) == 50
        assert stream.taken <= 4 * CHUNK_BYTES

    @pytest.mark.parametrize(
        ("text", "size"),
        [
            (b"Some words in a line.\nAnd some more words. " * 40 + b"\n\n", 1_200_000),
            (b"word and no end ", 1_200_000),
            (b"abcdefghij", 1_200_000),
            (b"\n", 10_000_000),
            (b"\n \r\n", 1_500_000),
        ],
    )
    def test_a_big_text_takes_little_memory(self, text, size):
        gc.collect()
        tracemalloc.start()
        try:
            count = sum(1 for _ in iter_blocks(Document(Repeated(text, size))))
            _, peak = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
        assert count >= (0 if text.isspace() else size / 8_193)
        assert peak < 8_000_000


@pytest.mark.parametrize("keep_lines", [False, True])
def test_chunks_whose_blocks_nobody_wants_are_passed_and_end_where_they_would(keep_lines):
    text = "".join(f"Paragraph {n}\n" + "\n" * (n % 3 == 0) for n in range(20_000))
    text += "a long one " * 20_000 + "\n\n- an item\n\n\n"
    read, passed, sought = (
        Document(io.BytesIO(text.encode()), "a", "utf-8", keep_lines=keep_lines) for _ in range(3)
    )
    number = 0
    while read.block(number) is not None:
        number += 1
    while passed.extend():
        assert passed.index().rows == read.index().rows[: len(passed.index().rows)]
    assert passed.index() == read.index()
    assert passed.complete
    assert sought.block(number) is None
    assert sought.index() == read.index()
    assert str(passed.block(number - 1).text) == str(read.block(number - 1).text)
    assert not passed.extend()
