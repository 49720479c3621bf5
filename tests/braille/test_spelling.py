"""Cells are spelled, typed and said in one way, and typing errors are caught while they can be."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.braille.spelling import (
    LETTERS,
    parse_answer,
    say_cells,
    spell,
)

LEGIBILITY = {"l": 0b000001, "r": 0b001000, "n": 0}
ROW_1 = 0b001001
SIX_DOTS = 0b111111

# Dots of literary braille: k to t are a to j with dot 3, u to z have dots 3 and 6; w came later.
TO_J = {"a": "1", "b": "12", "c": "14", "d": "145", "e": "15"}
TO_J |= {"f": "124", "g": "1245", "h": "125", "i": "24", "j": "245"}
DOTS = (
    TO_J
    | {letter: f"{TO_J[above]}3" for letter, above in zip("klmnopqrst", TO_J, strict=True)}
    | {letter: f"{TO_J[above]}36" for letter, above in zip("uvxyz", "abcde", strict=True)}
    | {"w": "2456"}
)


def mask_of(dots):
    return sum(1 << int(dot) - 1 for dot in dots)


def braille(*dots):
    return "".join(chr(0x2800 + mask_of(d)) for d in dots)


class TestSpell:
    def test_letters_are_those_of_literary_braille(self):
        assert {letter: mask_of(dots) for letter, dots in DOTS.items()} == LETTERS
        assert spell("".join(LETTERS), {}) == tuple(LETTERS.values())

    @pytest.mark.parametrize(
        ("text", "masks"),
        [
            ("", ()),
            ("1-4", (0b1001,)),
            ("14", (0b1001,)),
            ("0", (0,)),
            ("14 1 0 4", (0b1001, 1, 0, 0b1000)),
            ("ab", (1, 3)),
            ("a 4 c", (1, 0b1000, 0b1001)),
            ("⠿⠀a", (63, 0, 1)),
            ("⣿", (255,)),
            ("ln", (1, 0)),
        ],
    )
    def test_what_a_protocol_may_have(self, text, masks):
        assert spell(text, LEGIBILITY) == masks

    def test_keys_win_over_letters(self):
        assert spell("l", {}) == (0b111,)
        assert spell("l", LEGIBILITY) == (1,)

    @pytest.mark.parametrize(
        "text", ["A", "é", "?", ".", "a?", "9", "-", "1-", "-1", "1--2", "00", "1-0", "10", "²"]
    )
    def test_what_is_no_cell(self, text):
        with pytest.raises(ValueError, match=r"^'.*' (is no cell|is not the dots of a cell)"):
            spell(text, LEGIBILITY)

    def test_dot_numbers_that_run_together(self):
        with pytest.raises(ValueError, match=r"^'44' has a dot twice; put a space between"):
            spell("44", {})
        with pytest.raises(ValueError, match=r"^'4' is no cell; .* between spaces$"):
            spell("a4", {})


class TestAnswer:
    @pytest.mark.parametrize(
        ("typed", "kept"),
        [
            ("lr", braille("1", "4")),
            ("a 4", braille("1", "4")),
            ("A 4", braille("1", "4")),
            ("LR", braille("1", "4")),
            ("  c\tn ", braille("14", "")),
            ("1-4 0", braille("14", "")),
            ("14 0", braille("14", "")),
            ("⠁⠀", braille("1", "")),
            ("l?", braille("1") + "?"),
            ("? ?", "??"),
            ("?", "??"),
        ],
    )
    def test_of_two_places(self, typed, kept):
        assert parse_answer(typed, places=2, keys=LEGIBILITY, shown_dots=ROW_1) == kept

    def test_of_letters(self):
        kept = braille(*(DOTS[letter] for letter in "epkgn"))
        for typed in ("epkgn", "EPKGN", "e p k g n", "15 1234 k gn"):
            assert parse_answer(typed, places=5, keys={}, shown_dots=SIX_DOTS) == kept

    @pytest.mark.parametrize(
        ("typed", "places", "says"),
        [
            ("", 2, "nothing was typed; type 2 places, or ? if none was read"),
            (" \t", 1, "nothing was typed; type 1 place, or ? if none was read"),
            ("l", 2, "only 1 of 2 places typed; type all, with ? for what was not read"),
            ("l?r", 5, "only 3 of 5 places typed; type all, with ? for what was not read"),
            ("lrn", 2, "3 places typed, and 2 asked for; type no more"),
            (
                "z",
                1,
                "'z' has dots 1, 3, 5 and 6, and the display shows dots 1 and 4 only; "
                "type a cell of those, or ? for one not read",
            ),
            (
                "8",
                1,
                "'8' has dot 8, and the display shows dots 1 and 4 only; "
                "type a cell of those, or ? for one not read",
            ),
        ],
    )
    def test_typing_errors_say_what_to_do(self, typed, places, says):
        with pytest.raises(ValueError, match=f"^{re.escape(says)}$"):
            parse_answer(typed, places=places, keys=LEGIBILITY, shown_dots=ROW_1)

    def test_a_key_in_capitals_is_another_key(self):
        keys = {"A": 8}
        assert parse_answer("aA", places=2, keys=keys, shown_dots=ROW_1) == braille("1", "4")

    @given(st.text(max_size=12))
    def test_whatever_is_typed_is_an_answer_or_an_error(self, typed):
        try:
            answer = parse_answer(typed, places=2, keys=LEGIBILITY, shown_dots=ROW_1)
        except ValueError:
            return
        assert len(answer) == 2
        assert set(answer) <= {*braille("", "1", "4", "14"), "?"}

    @given(st.lists(st.integers(0, 63) | st.none(), min_size=1, max_size=6))
    def test_an_answer_typed_again_is_the_same(self, places):
        answer = "".join("?" if mask is None else chr(0x2800 + mask) for mask in places)
        typed = parse_answer(answer, places=len(places), keys={}, shown_dots=SIX_DOTS)
        assert typed == answer


class TestSay:
    @pytest.mark.parametrize(
        ("answer", "keys", "said"),
        [
            (braille("1", "14", "4", ""), {}, "a c 4 blank"),
            (braille("1", "14", "4", ""), LEGIBILITY, "l c r n"),
            (braille("15", "123456") + "?", {}, "e 1-2-3-4-5-6 ?"),
            (braille("123"), {}, "l"),
            ("", {}, ""),
        ],
    )
    def test_words(self, answer, keys, said):
        assert say_cells(answer, keys) == said

    def test_a_letter_that_is_the_key_of_another_cell_is_said_by_its_dots(self):
        assert say_cells(braille("123", "1"), LEGIBILITY) == "1-2-3 l"

    @given(st.lists(st.integers(0, 255), min_size=1, max_size=6))
    def test_what_is_said_can_be_typed(self, masks):
        answer = "".join(chr(0x2800 + mask) for mask in masks)
        said = say_cells(answer, LEGIBILITY)
        typed = parse_answer(said, places=len(masks), keys=LEGIBILITY, shown_dots=255)
        assert typed == answer
