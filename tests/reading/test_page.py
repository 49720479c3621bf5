"""A page under a hand that a test holds: the line under the finger is the one that is read."""

import io
import math
from dataclasses import replace

import numpy as np
import pytest

from tests.reading.held import Held
from vbraille.devices.events import Button
from vbraille.engine.constants import IDLE_S
from vbraille.engine.record import Flag
from vbraille.layout.pages import Layout
from vbraille.reading.advancing import STAY_S
from vbraille.reading.commands.table import bound_by
from vbraille.reading.keys import Bindings
from vbraille.reading.liveview import LastSentences, ReadState
from vbraille.reading.outputs import Echo
from vbraille.reading.view import Cue
from vbraille.render import LATERO, STRESS2_8X8
from vbraille.render.braille.style import MOST_TILT_RAD
from vbraille.translate import Book
from vbraille.translate.braillefiles.lines import open_brf

ROWS, LINES = 4, 10
PITCH_MM = STRESS2_8X8.style.geometry.line_pitch_mm
LETTERS = "abcdefghij"


class Bench(Held):
    """A reading of ten lines of so many cells, four on a page, under a hand that is held."""

    def __init__(self, model=STRESS2_8X8, rows=ROWS, lines=LINES, width=10, letters=3, **how):
        self.said, self.cues = LastSentences(), []
        super().__init__(model, rows, self.said.add, attended=how.pop("attended", True))
        self.x_mm = 10.0
        self.opened.start(replace(self.own, style=model.style))
        text = "".join(f"{letter * letters}\n" for letter in LETTERS[:lines])
        bound = bound_by(Bindings(buttons={"button 3": "WINDN"}))
        layout = Layout(Book(open_brf(io.BytesIO(text.encode()), "text.brf")), width)
        self.opened.show(layout, cue=self.cues.append, bound=bound, **how)

    @property
    def line(self):
        return self.reader.line.number

    @property
    def page(self):
        return [None if part is None else part.line.number for part in self.surface.windows]

    def to_row(self, row, seconds=0.3):
        """Put the finger into the middle of a row."""
        self.y_mm = (row + 0.5) * PITCH_MM
        self.run(seconds)

    def press(self, key):
        """Press a key; what is said of it."""
        before = self.said.count
        self.reader.press(key)
        return self.said.last[len(self.said.last) - (self.said.count - before) :]

    def felt(self):
        """Dots of the first cell that the array shows, when it goes over the line."""
        frames = []
        for self.x_mm in np.linspace(0.0, 8.0, 60):
            self.run(0.02)
            frames.append(self.opened.frame)
        rows = np.array(frames).max(axis=(0, 2)) > 0.9
        return rows.tolist()


def test_a_page_has_as_many_lines_as_there_is_room_for_with_a_foot_below_them():
    assert Bench().page == [1, 2, 3, 4]
    assert Bench(rows=1).page == [1]
    assert Bench(rows=20).page == list(range(1, LINES + 1))
    bench = Bench(rows=0)  # less than a line: one line, wherever along y the array is
    assert bench.page == [1]
    assert not bench.reader.under.surface.paged


def test_the_line_under_the_finger_is_where_somebody_is():
    bench = Bench(echo=Echo.CELLS)
    bench.to_row(0)
    for row in (2, 1, 3):
        bench.to_row(row)
        assert bench.line == row + 1
        assert bench.said.last[-1] == "cells: " + "⠁⠃⠉⠙"[row] * 3
        assert bench.press("i")[0] == f"line: {row + 1}"
        assert bench.reader.character == 4 * row
    assert bench.press("u") == ["cell: dots 1-4-5", "character: d", "word: ddd"]
    assert bench.reader.lines == 4


def test_a_finger_that_only_crosses_lines_is_on_none_of_them():
    bench = Bench(echo=Echo.CELLS)
    bench.to_row(0)
    said = bench.said.count
    for row in (1, 2, 3, 2, 1):
        bench.to_row(row, 0.06)
    bench.to_row(0)
    assert bench.line == 1
    assert bench.said.count == said


@pytest.mark.parametrize("stray", [0.55, -0.55])
@pytest.mark.parametrize("rests", ["still", "paused", "turned"])
def test_a_finger_that_has_strayed_is_on_its_line_after_a_rest(stray, rests):
    bench = Bench()
    bench.to_row(2)
    bench.to_row(2 + stray)
    bench.opened.paused = rests == "paused"
    bench.theta = 2 * MOST_TILT_RAD * (rests == "turned")
    bench.run(1.5 * IDLE_S)
    assert not bench.opened.frame.any()
    assert bench.line == 3
    bench.opened.paused, bench.theta = False, 0.0
    bench.x_mm += 1.0
    bench.run(0.3)
    assert bench.opened.frame.any()
    assert bench.line == 3


@pytest.mark.parametrize("stray", [0.55, -0.55])
def test_a_finger_that_strays_within_the_band_stays_on_its_line(stray):
    bench = Bench()
    bench.to_row(2)
    bench.to_row(2 + stray)
    assert bench.line == 3
    for key in "t)":  # even if the page comes in another style
        bench.press(key)
        bench.run(0.3)
        assert bench.line == 3
    bench.press("(")
    assert bench.press("(") == ["band: 0.15 line pitches"]
    bench.to_row(2 + 1.2 * stray)
    assert bench.line == (4 if stray > 0 else 2)


def test_below_the_last_line_a_finger_that_stays_turns_the_page_and_one_that_comes_back_does_not():
    bench = Bench()
    bench.to_row(3)
    bench.y_mm = (ROWS + 0.4) * PITCH_MM
    bench.run(STAY_S - 0.1)
    bench.to_row(3)
    assert bench.page == [1, 2, 3, 4]
    bench.y_mm = (ROWS + 0.4) * PITCH_MM
    bench.run(STAY_S + 0.1)
    assert bench.page == [5, 6, 7, 8]
    assert bench.said.last[-1] == "page: lines 5 to 8"
    assert bench.cues[-1] is Cue.PAGE_END
    assert bench.line == 5  # where reading goes on
    bench.run(3 * STAY_S)  # which is once: the finger must have been on the page
    assert bench.page == [5, 6, 7, 8]
    bench.to_row(1)
    assert bench.line == 6


def put_aside(bench):
    bench.opened.paused = True


def take_away(bench):
    bench.device.taking = False


def unplug(bench):
    bench.device.place = lambda _: None


def turn(bench):
    bench.theta = 2 * MOST_TILT_RAD


@pytest.mark.parametrize("lose", [put_aside, take_away, unplug, turn])
def test_time_in_which_nothing_is_felt_is_no_staying_below_the_page(lose):
    bench = Bench()
    bench.to_row(3)
    bench.y_mm = (ROWS + 0.4) * PITCH_MM
    bench.run(0.2)
    was = bench.device.place
    lose(bench)
    bench.run(3 * STAY_S)
    assert bench.page == [1, 2, 3, 4]
    bench.device.place, bench.device.taking = was, True
    bench.opened.paused, bench.theta = False, 0.0
    bench.run(STAY_S - 0.1)
    assert bench.page == [1, 2, 3, 4]
    bench.run(0.3)
    assert bench.page == [5, 6, 7, 8]


def test_a_page_comes_by_a_fade():
    bench = Bench()
    bench.felt()
    bench.run(0.5)
    before = len(bench.device.sent)
    bench.press("]")
    bench.run(0.5)
    steps = np.abs(np.diff(bench.device.sent[before - 1 :], axis=0)).max()
    assert 0 < steps <= 0.1 + 1e-6


def test_keys_and_buttons_turn_pages():
    bench = Bench()
    bench.to_row(1)
    assert bench.press("]") == ["page: lines 5 to 8"]
    assert (bench.page, bench.line) == ([5, 6, 7, 8], 6)
    bench.device.pressed = [Button(3, pressed=True)]
    bench.run(0.1)
    assert bench.page == [9, 10]
    assert bench.press("]") == ["last page"]
    assert bench.press("[") == ["page: lines 5 to 8"]
    assert bench.press("n") == ["line: 7"]
    assert bench.page == [6, 7, 8, 9]
    assert bench.press("[") == ["page: lines 2 to 5"]
    assert bench.press("[") == ["page: lines 1 to 4"]  # the first page is a whole one
    assert bench.press("[") == ["first page"]


def test_what_somebody_goes_to_comes_under_the_finger_with_the_page_around_it():
    bench = Bench()
    bench.to_row(2)
    bench.reader.jump(4 * 6)  # line 7
    assert (bench.page, bench.line) == ([5, 6, 7, 8], 7)
    bench.reader.jump(4 * 7)  # on the same page
    assert (bench.page, bench.line) == ([6, 7, 8, 9], 8)
    bench.press("<")
    assert (bench.page, bench.line) == ([None, None, 1, 2], 1)
    bench.run(0.3)
    assert (bench.line, bench.press("i")[0]) == (1, "line: 1")
    bench.to_row(0)  # nothing is there
    assert bench.line == 1
    bench.to_row(3)
    assert bench.line == 2
    bench.press("b")
    assert bench.line == 8


def test_each_line_is_felt_in_its_row():
    bench = Bench()
    letters = {0: (1,), 1: (1, 2), 2: (1, 4), 3: (1, 4, 5)}
    rows = {1: 0, 4: 0, 2: 2, 5: 2, 3: 4, 6: 4}  # every second row of actuators
    for row, dots in letters.items():
        bench.to_row(row, 0.5)
        raised = {rows[dot] for dot in dots}
        assert bench.felt() == [n in raised for n in range(8)]


def test_the_end_of_the_text_is_below_its_last_line():
    bench = Bench(lines=6, attended=False)
    bench.to_row(3)
    bench.press("]")
    bench.to_row(1)
    assert not bench.opened.done
    bench.to_row(2, STAY_S + 0.1)  # the page has two lines
    assert bench.opened.done


def test_the_end_of_a_line_is_signalled_and_that_of_a_page():
    bench = Bench()
    bench.to_row(1)
    assert bench.cues == []
    bench.x_mm = 60.0
    bench.run(0.1)
    assert bench.cues == [Cue.LINE_END]
    bench.x_mm = 0.0
    bench.to_row(3)
    bench.x_mm = 60.0
    bench.run(0.1)
    assert bench.cues == [Cue.LINE_END, Cue.PAGE_END]


@pytest.mark.parametrize("sign", [1, -1])
def test_an_array_that_is_turned_too_far_rests_and_says_so_once(sign):
    bench = Bench()
    bench.to_row(1)
    bench.theta = sign * 0.9 * MOST_TILT_RAD
    bench.felt()
    assert bench.opened.frame.any() or bench.felt()
    said = bench.said.count
    bench.theta = sign * math.radians(30)
    bench.run(0.5)
    assert not bench.opened.frame.any()
    side = "right" if sign > 0 else "left"
    assert bench.said.last[-1] == (
        "turned: the array is turned by 30 degrees, and braille is felt up to 20; "
        f"turn it back to the {side}"
    )
    bench.theta = sign * 0.95 * MOST_TILT_RAD  # not enough yet
    bench.run(0.5)
    assert not bench.opened.frame.any()
    assert bench.said.count == said + 1
    bench.theta = 0.0
    bench.run(0.5)
    assert bench.said.last[-1] == "upright: braille is felt again"
    assert any(bench.felt())
    assert np.abs(np.diff(bench.device.sent, axis=0)).max() < 1


def test_lines_farther_apart_come_in_fewer_rows_and_the_one_under_the_finger_stays():
    bench = Bench()
    bench.to_row(2)
    bench.reader.tune(line_pitch_mm=2 * PITCH_MM)
    bench.run(0.3)
    assert (bench.page, bench.line) == ([2, 3], 3)
    bench.reader.tune(line_pitch_mm=PITCH_MM)
    bench.run(0.3)
    assert (bench.page, bench.line) == ([1, 2, 3, 4], 3)


def test_cells_farther_apart_leave_the_character_under_the_finger():
    bench = Bench()
    bench.to_row(2)
    bench.x_mm = 14.0
    bench.run(0.3)
    before = bench.reader.character
    bench.reader.tune(dot_spacing_mm=5.0)
    bench.run(0.3)
    assert bench.reader.character == before == 4 * 2 + 1
    assert bench.page == [1, 2, 3, 4]


def test_a_free_page_is_a_choice_that_can_be_taken_back():
    bench = Bench()
    bench.to_row(1)
    assert bench.press("=") == ["straying: each actuator shows what lies under it"]
    bench.run(0.3)
    assert bench.reader.style.straying.manner == "free"
    bench.to_row(1.1, 0.5)
    ticks = len(bench.device.sent)
    bench.to_row(2.1, 0.5)  # from line to line nothing fades
    assert bench.line == 3
    assert len(bench.device.sent) > ticks
    assert bench.press("U")
    assert bench.reader.style.straying.manner == "line"


def test_lines_that_are_longer_than_the_surface_are_panned_together():
    bench = Bench(letters=40, width=60)
    wide = bench.reader.under.width
    assert 3 < wide < 40
    bench.to_row(2)
    assert bench.reader.pan(1)
    assert (bench.page, bench.line) == ([1, 2, 3, 4], 3)
    offsets = [part.offset for part in bench.reader.under.surface.windows]
    assert offsets == [wide] * ROWS
    bench.reader.jump(41 * 3)
    bench.reader.go_on()
    assert bench.reader.window.offset == wide
    assert bench.reader.pan(-1)
    assert not bench.reader.pan(-1)
    assert bench.reader.window.offset == 0


def test_pages_of_the_live_view_see_all_lines_of_the_page():
    bench = Bench()
    viewed = ReadState(bench.opened, "A title", bench.said)
    bench.to_row(2)
    state = viewed.changed()
    assert [line.number for line in state.lines] == [1, 2, 3, 4]
    assert [line.top_mm for line in state.lines] == [row * PITCH_MM for row in range(ROWS)]
    assert [line.under for line in state.lines] == [False, False, True, False]
    assert (state.array.height_mm, state.array.turns) == (4.5 * PITCH_MM, True)
    assert viewed.changed() is None
    bench.to_row(0)
    assert [line.under for line in viewed.changed().lines] == [True, False, False, False]


def test_records_say_that_the_array_is_turned():
    bench = Bench(LATERO)
    bench.theta = 1.0
    bench.run(0.1)
    assert int(bench.opened._newest["flags"]) & (Flag.TURNED | Flag.RESTING) == (
        Flag.TURNED | Flag.RESTING
    )
