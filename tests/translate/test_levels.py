"""Superscripts and subscripts in braille: never a digit glued to a number."""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import by_tier, examples
from tests.translate.blocks import block_of
from vbraille.translate.languages import find_table
from vbraille.translate.levels import small_number
from vbraille.translate.liblouis import BrailleTable, list_tables
from vbraille.translate.source import Mark, MarkKind

table_of = cache(BrailleTable)
SUPER, SUB = MarkKind.SUPERSCRIPT, MarkKind.SUBSCRIPT
LANGUAGES = sorted({table.language for table in list_tables() if table.language})


def block(source: str):
    """Block of a text as pandoc's Markdown has it: x^2^ and H~2~O."""
    text, marks = "", []
    for part in re.split(r"(\^[^^]+\^|~[^~]+~)", source):
        kind = {"^": SUPER, "~": SUB}.get(part[:1])
        said = part[1:-1] if kind else part
        if kind:
            marks.append(Mark(kind, len(text), len(text) + len(said)))
        text += said
    return replace(block_of(text), marks=tuple(marks))


def cells(source: str, table: str):
    found = block(source)
    return table_of(table).translate(found.text, found.marks)


def written(source: str, table: str) -> str:
    return cells(source, table).to_unicode()


@pytest.mark.parametrize(
    ("table", "source", "braille"),
    [
        ("en-ueb-g2.ctb", "10^6^", "⠼⠁⠚⠰⠔⠼⠋"),
        ("en-ueb-g2.ctb", "10^12^", "⠼⠁⠚⠰⠔⠼⠁⠃"),
        ("en-ueb-g2.ctb", "H~2~O", "⠠⠓⠰⠢⠼⠃⠠⠕"),
        ("en-ueb-g2.ctb", "x^n^", "⠭⠰⠔⠝"),
        ("en-ueb-g2.ctb", "x^n+1^", "⠭⠰⠔⠣⠝⠐⠖⠼⠁⠜"),
        ("en-ueb-g2.ctb", "x~ij~", "⠭⠰⠢⠐⠣⠊⠚⠐⠜"),
        ("en-ueb-g2.ctb", "5^2^3", "⠼⠑⠰⠔⠣⠼⠃⠜⠼⠉"),
        ("en-ueb-g2.ctb", "19^th^", "⠼⠁⠊⠞⠓"),
        ("fr-bfu-comp6.utb", "10^6^", "⠠⠡⠼⠈⠫"),
        ("fr-bfu-comp6.utb", "H~2~O", "⠨⠓⠐⠤⠠⠣⠨⠕"),
        ("de-g2.ctb", "10^12^", "⠼⠁⠚⠌⠂⠆"),
        ("es.tbl", "10^6^", "⠼⠁⠚⠡⠼⠋"),
        ("es.tbl", "H~2~O", "⠨⠓⠣⠼⠃⠜⠨⠕"),
        ("sk-g1.ctb", "10^12^", "⠼⠁⠚⠌⠼⠁⠃⠱"),
        ("ar.tbl", "10^12^", "⠼⠁⠚⠼⠢⠁⠃"),
        ("nl.tbl", "H~2~O", "⠨⠓⠡⠆⠨⠕"),
        ("no-no-g0.utb", "10^6^", "⠼⠁⠚⠨⠋"),
        ("ru-litbrl.ctb", "10^6^", "⠼⠁⠚⠰⠢⠼⠋"),
        ("it.tbl", "10^2^", "⠼⠁⠚⠈⠠⠣"),
        ("it.tbl", "10^6^", "⠼⠁⠚⠮⠼⠋"),
        ("el.ctb", "10^6^ m", "⠼⠁⠚⠀⠼⠋⠀⠀⠰⠍"),
    ],
)
def test_a_table_writes_them_its_own_way(table, source, braille):
    assert written(source, table) == braille


@pytest.mark.parametrize("language", LANGUAGES[:: by_tier(4, 1, 1)])
def test_no_table_glues_them_to_a_number(language):
    table = find_table(language)
    if written("12", table) == written("21", table):  # it knows no digits
        return
    plain = written("106", table), written("19312", table), written("H2O", table)
    assert written("10^6^", table) != plain[0] != written("10~6~", table)
    assert written("1931^2^", table) != plain[1]
    assert written("H~2~O", table) != plain[2]
    assert written("10⁶", table) == written("10^6^", table) != written("10⁷", table)
    assert written("H₂O", table) == written("H~2~O", table)


def test_numbers_in_unicode_are_one_number():
    assert written("10¹²", "en-ueb-g2.ctb") == written("10^12^", "en-ueb-g2.ctb")
    assert small_number("−3", SUPER) == "⁻³"
    assert small_number("n", SUB) == "ₙ"
    assert small_number("in", SUPER) == "in"


@examples(100)
@given(
    st.lists(st.sampled_from(["x", "12", "^2^", "~n+1~", "^th^", " ", "⁶", "^a b^"]), min_size=1),
    st.sampled_from(["en-ueb-g2.ctb", "de-g2.ctb", "ru-litbrl.ctb", "no-no-g0.utb"]),
)
def test_places_lead_back_to_the_text_in_order(parts, table):
    found, text = cells("".join(parts), table), block("".join(parts)).text
    assert found.end == text.end
    assert (np.diff(found.starts) >= 0).all()
    assert set(found.starts.tolist()) <= set(text.places.tolist())
