"""Parts of a page's state: lines with where their cells come from, arrays, rows and knobs."""

import io

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples
from vbraille.config.settings import KNOBS
from vbraille.layout.pages import Layout
from vbraille.live.states import (
    array_shown,
    geometry_shown,
    knobs_shown,
    line_shown,
    rows_shown,
)
from vbraille.render import STRESS2, VBD
from vbraille.render.braille.mappings import MAPPINGS
from vbraille.translate import Book, BrailleTable, Document
from vbraille.translate.braillefiles.lines import open_brf

TEXT = "The little  children can knowledge.\n\n12 people & a word: \U0001d54f\n"


def layout(text=TEXT, width=12, table="en-ueb-g2.ctb"):
    return Layout(Book(Document.from_text(text), BrailleTable(table)), width)


def parts(shown):
    """What of the text each cell stands for."""
    return [shown.text[begin:end] for begin, end in shown.sources]


def test_each_cell_of_contracted_braille_tells_its_text():
    shown = line_shown(layout(width=20).line(1))
    assert shown.text == "The little children can knowledge."
    assert shown.cells[2:5] == [0b100000, 0b101110, 0]
    assert parts(shown)[:12] == [
        *("", "", "The", "The", " ", "little", "little", " ", "children", "children", " "),
        "can",
    ]
    assert (shown.start_mm, shown.top_mm, shown.under, shown.number) == (0.0, 0.0, False, 1)


@examples(60)
@given(
    st.text("ab the TION12,.\n —é\U0001d54f", max_size=60),
    st.integers(3, 30),
    st.integers(-3, 20),
    st.integers(0, 30),
    st.sampled_from(["en-ueb-g1.ctb", "en-ueb-g2.ctb"]),
)
def test_any_part_of_any_line_tells_what_its_cells_stand_for(text, width, first, count, table):
    """A cell's text is that which the line itself tells of the cell."""
    for line in layout(f"a{text}", width, table).lines():
        shown = line_shown(line, first=first, count=count)
        assert len(shown.cells) == len(shown.sources) == count
        for number, (mask, (begin, end)) in enumerate(zip(shown.cells, shown.sources, strict=True)):
            cell = first + number
            assert 0 <= begin <= end <= len(shown.text)
            if not 0 <= cell < len(line):
                assert (mask, begin) == (0, end)
                continue
            assert mask == line.masks[cell]
            source = line.source(cell)
            there = () if source is None else line.block.text.places
            wanted = [
                chr(line.block.text.codes[at])
                for at in range(line.first, line.after)
                if source is not None and source[0] <= there[at] < source[1]
            ]
            assert shown.text[begin:end] == "".join(wanted)


def test_of_a_long_line_only_the_text_of_what_is_shown_is_told():
    (line,) = layout("one two three four five six", 80).lines()
    shown = line_shown(line, first=6, count=5, start_mm=-3.0, top_mm=14.0, number=9, under=True)
    assert shown.cells == line.masks[6:11].tolist()
    assert (shown.text, parts(shown)) == ("wo thr", ["w", "o", " ", "th", "r"])
    assert (shown.start_mm, shown.top_mm, shown.number, shown.under) == (-3.0, 14.0, 9, True)


def test_a_part_that_begins_before_the_line_begins_with_blanks():
    line = layout(width=20).line(1)
    shown = line_shown(line, first=-2, count=6)
    assert shown.cells == [0, 0, *line.masks[:4].tolist()]
    assert parts(shown) == ["", "", "", "", "The", "The"]


def test_a_line_that_is_braille_already_has_no_print():
    line = Layout(Book(open_brf(io.BytesIO(b",read ,me"), "text")), 20).line(1)
    shown = line_shown(line)
    assert shown.text == ""
    assert set(shown.sources) == {(0, 0)}
    assert shown.cells == line.masks.tolist()
    assert np.any(shown.cells)


def test_a_blank_line_is_shown():
    line = next(
        line
        for line in Layout(
            Book(Document.from_text("a\n\n\nb", keep_lines=True), BrailleTable("en-ueb-g2.ctb")), 9
        ).lines()
        if not len(line)
    )
    shown = line_shown(line)
    assert (shown.cells, shown.sources, shown.text.strip()) == ([], [], "")


@pytest.mark.parametrize(("model", "rest_right"), [(STRESS2, True), (VBD, False)])
def test_the_array_is_that_of_the_display(model, rest_right):
    display, shown = model.display, array_shown(model.display)
    for name in ("name", "rows", "columns", "column_pitch_mm", "travel_mm", "rate_hz"):
        assert getattr(shown, name) == getattr(display, name)
    assert (shown.rest_right, shown.swing_mm) == (rest_right, 0.2)
    distances = geometry_shown(model.style.geometry)
    assert distances["dot_spacing_mm"] == model.style.geometry.dot_spacing_mm
    assert "travel_mm" not in distances


def test_rows_of_actuators_tell_the_rows_of_dots_that_they_show():
    off = (-1, -1)
    display = STRESS2.display
    assert rows_shown(STRESS2.style, display) == [(0, 0), off, (1, 1), off, (2, 2), off]
    assert rows_shown(VBD.style, VBD.display) == [(0, 0)]
    split = STRESS2.style.replace(mapping=MAPPINGS["split-columns"])
    assert rows_shown(split, display)[:2] == [(0, -1), (-1, 0)]
    low = STRESS2.style.replace(mapping=MAPPINGS["three-rows"], first_row=3)
    assert rows_shown(low, display) == [off, off, off, (0, 0), (1, 1), (2, 2)]


def test_all_knobs_are_shown_with_their_bounds_and_why_one_is_fixed():
    shown = {knob.name: knob for knob in knobs_shown(VBD.style)}
    assert list(shown) == list(KNOBS)
    assert shown["dot_width_mm"].value == 2.0
    assert (shown["texture"].low, shown["texture"].high, shown["texture"].step) == (0, 1, 0.1)
    assert shown["texture_cycles"].fixed
    assert not any(knob.fixed for knob in knobs_shown(STRESS2.style))
