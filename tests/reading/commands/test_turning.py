"""Knobs that a reader turns while the hand moves: what is said, what is felt, where they stop."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.engine.test_loop import biggest_step, run, straight
from tests.reading.test_reader import SPAN_MM, Bench
from tests.tiers import examples
from vbraille.config.settings import KNOBS
from vbraille.layout.texts import cells_per_line
from vbraille.reading.commands.table import calling
from vbraille.reading.commands.turning import (
    change_mapping,
    save_settings,
    turn,
    undo_turn,
)
from vbraille.reading.view import Cue, View
from vbraille.render import STRESS2, VBD, Tuning
from vbraille.translate import Book, BrailleTable, Document

TEXT = (
    "A fingertip that reads a page of braille goes from left to right and hardly ever stops, "
    "and what it feels of each cell is over in a tenth of a second. So the knobs are turned "
    "while it moves, and the letter under it stays where it is.\n\nThat is what is tried here."
)
BOOK = Book(Document.from_text(TEXT), BrailleTable("en-ueb-g2.ctb"))
LENGTHS = ("dot_width_mm", "dot_spacing_mm", "cell_gap_mm")


def bench(**options):
    made = Bench(
        text=TEXT, width=cells_per_line(STRESS2.style.geometry, STRESS2.display), **options
    )
    made.cues = []
    made.reader.cue = made.cues.append
    return made


def does(bench, command):
    before = len(bench.said)
    command(bench.reader)
    return bench.said[before:]


def put(bench, x_mm):
    """Hold the array's centre at a place along the line."""
    bench.device.move(straight((0, x_mm - SPAN_MM / 2), (60, x_mm - SPAN_MM / 2)))
    run(bench.loop, 0.6)
    bench.reader.step(bench.engine.poll())


def text_of(layout):
    return "".join(line.text for line in layout.lines())


@pytest.mark.parametrize("name", KNOBS)
def test_each_knob_says_its_value_and_stops_at_its_bounds_with_a_cue(name):
    one = bench()
    knob = KNOBS[name]
    before = knob.value(one.reader.style)
    if before < knob.high:
        (said,) = does(one, calling(turn, name, 1))
        assert said == f"{knob.label}: {before + knob.step:g} {knob.unit}".strip()
        assert knob.value(one.reader.style) == pytest.approx(before + knob.step)
        assert not one.cues
    does(one, calling(turn, name, -100_000))
    (said,) = does(one, calling(turn, name, -1))
    assert said.startswith(f"{knob.label}: {knob.value(one.reader.style):g}")
    assert ", the least" in said
    assert one.cues[-1] is Cue.LIMIT


def test_a_width_is_said_with_its_unit():
    one = bench()
    assert does(one, calling(turn, "dot_width_mm", -1)) == ["dot width: 2.4 mm"]
    assert does(one, calling(turn, "texture_cycles", 1)) == ["texture cycles: 9"]
    assert does(one, calling(turn, "texture_cycles", 1)) == ["texture cycles: 11"]
    assert does(one, calling(turn, "texture_cycles", 1)) == ["texture cycles: 11, the most"]


def test_a_dot_stays_narrower_than_a_cell_and_a_cell_on_the_line():
    one = bench()
    one.reader.tune(dot_width_mm=11.0)
    assert does(one, calling(turn, "dot_width_mm", 1)) == [
        "dot width: 11 mm, the most: a dot must not be wider than the cell pitch"
    ]
    assert does(one, calling(turn, "cell_gap_mm", -1)) == [
        "cell gap: 7.4 mm, the least: a dot must not be wider than the cell pitch"
    ]
    assert one.cues == [Cue.LIMIT] * 2
    one.reader.tune(travel_mm=27.0)
    assert does(one, calling(turn, "dot_spacing_mm", 100))[0].endswith(
        "the most: the carriage would have no room for a cell"
    )


def test_mappings_come_in_turn_and_dot_rows_where_one_is_shown():
    one = bench()
    said = [does(one, change_mapping)[0] for _ in range(7)]
    assert said[0] == "mapping: paired"
    assert said[-1] == "mapping: alternate"
    assert len(set(said)) == 7


class OneRow(View):
    """As much of a reader as a turn needs, on a display that shows one row of dots."""

    def __init__(self):
        self.style, self.engine = VBD.style, SimpleNamespace(display=VBD.display)
        self.said, self.cues, self.styles_before = [], [], []
        self.say, self.cue = self.said.append, self.cues.append

    def tune(self, **turned):
        self.style = self.style.replace(**turned)


def test_where_one_row_of_dots_is_shown_it_is_turned_and_texture_has_one_wavelength():
    reader = OneRow()
    for _ in range(3):
        change_mapping(reader)
    assert reader.said == [f"dot row: {row}" for row in (2, 3, 1)]
    turn(reader, "texture_cycles", 1)
    assert reader.said[3:] == [
        "texture cycles: 7, the most: the texture of this display has a fixed wavelength"
    ]
    assert reader.cues == [Cue.LIMIT]


def test_undo_takes_back_one_turn_after_the_other():
    one = bench(tuning=Tuning(texture=0.5))
    first = one.reader.style
    does(one, calling(turn, "texture", 1))
    does(one, calling(turn, "cell_gap_mm", -1))
    does(one, change_mapping)
    assert [does(one, undo_turn)[0] for _ in range(4)] == [
        "undo: mapping alternate",
        "undo: cell gap 7.4 mm",
        "undo: texture 0.5",
        "undo: nothing was turned",
    ]
    assert one.reader.style == first
    assert one.cues == [Cue.LIMIT]


def test_save_says_what_was_saved():
    one = bench()
    assert does(one, save_settings) == ["saved: nothing, since no settings file is in use"]
    kept = []
    one.reader.save_style = lambda style: kept.append(style) or "saved: profile evening"
    assert does(one, save_settings) == ["saved: profile evening"]
    assert kept == [one.reader.style]


@pytest.mark.no_cover
@pytest.mark.parametrize("name", ["texture", "contrast", "dot_width_mm", "cell_gap_mm"])
def test_a_turn_is_felt_within_50_ms_and_nothing_jumps(name):
    one = bench()
    put(one, 60.0)
    while not one.loop.output.any():  # over a dot
        put(one, one.engine.x_mm + 1)
    before, sent = one.loop.output.copy(), len(one.device.sent)
    turn(one.reader, name, -2)
    run(one.loop, 0.3)
    frames = one.device.sent[sent - 1 :]
    moved = [np.abs(frame - before).max() > 0.002 for frame in frames]
    after = one.loop.output
    assert np.abs(after - before).max() > 0.02  # it makes a difference here
    assert moved.index(True) <= 50  # ticks of 1 ms
    assert biggest_step(frames) < 0.05  # of the whole swing, in a millisecond
    assert np.allclose(frames[150], after)  # and 0.15 s later it is all there


@pytest.mark.no_cover
@examples(40)
@given(
    x_mm=st.floats(0, 285),
    turns=st.lists(st.tuples(st.sampled_from(LENGTHS), st.integers(-8, 8)), max_size=5),
    line=st.integers(1, 5),
)
def test_the_character_under_the_finger_stays_there_and_nothing_is_lost(x_mm, turns, line):
    one = bench(book=BOOK)
    reader = one.reader
    whole = text_of(reader.layout)
    reader.go(line)
    one.loop.state.now["x_mm"], one.loop.state.now["placed"] = x_mm, True
    for name, steps in turns:
        cell, before, geometry = reader.cell, reader.window, reader.style.geometry
        span = None if cell is None else before.line.source(cell)
        turn(reader, name, steps)
        assert text_of(reader.layout) == whole
        if span is None:
            continue
        now = reader.window
        assert now.line.source(reader.cell) == span or not before.line.masks[cell]
        assert -reader.style.geometry.cell_pitch_mm < now.start_mm <= 0
        # The finger is over the same share of the cell, which the bounds of the cell may round.
        moved = now.share_at(x_mm, reader.style.geometry) - before.share_at(x_mm, geometry)
        assert abs(moved) < 1e-6 or abs(moved) > 1 - 1e-6
