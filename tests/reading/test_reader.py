"""A book under the hand, with time turned by hand: lines, pages, jumps, tuning."""

import sys

import numpy as np
import pytest

from tests.reading.bench import TWO, Reading
from vbraille.errors import InputError
from vbraille.reading.outputs import Cue

WORDS = " ".join(f"word{n}" for n in range(400))
ROWS = "\n\n".join(f"row {n} of the text" for n in range(40))


def test_a_hand_reads_line_after_line_to_the_end():
    with Reading("one two three four five six seven eight nine ten", attended=False) as reading:
        while not reading.reader.done:
            reading.run(0.1)
        assert reading.line == reading.reader.layout.count() == reading.reader.lines_read


def test_a_person_at_the_end_may_go_back():
    with Reading("one") as reading:
        assert "end of the text" in reading.run(3)
        assert reading.press("p") == ["no previous line"]
        assert not reading.reader.done


@pytest.mark.parametrize(("first", "last"), [(9, None), (400, 401)])
def test_a_line_past_the_end_is_refused(first, last):
    with (
        pytest.raises(InputError, match=f"line {first} is past the end"),
        Reading("one two", lines=(first, last)),
    ):
        pass


def test_keys_do_not_leave_the_lines_that_are_read():
    with Reading(WORDS, lines=(3, 5), hand="sweep:1") as reading:
        assert reading.line == 3
        assert reading.press("p") == ["no previous line"]
        assert reading.press("n", "n") == ["line 4", "line 5"]
        assert reading.press("n") == ["no next line"]
        assert reading.press("<", ">") == ["line 3", "line 5"]
        reading.press("g")
        assert reading.type("40%")[-1] == "outside the lines being read"


def test_a_line_that_is_longer_than_the_hand_goes_comes_in_parts():
    with Reading(WORDS, cells=60, hand="sweep:1") as reading:
        width = reading.reader.width
        assert reading.press("right") == [f"from cell {width + 1}"]
        reading.press("right", "right")
        assert reading.line == 2
        reading.press("left")
        assert reading.line == 1
        assert reading.reader.part.first == 60 // width * width


def test_what_is_under_the_finger_stays_there_when_distances_change():
    with Reading(WORDS, hand="sweep:1") as reading:
        reading.press("n", "n")
        reading.finger(100.0)
        before = reading.reader.place
        for key in "sSjJdDx":
            reading.press(key)
            reading.run(0.3)
            assert abs(reading.reader.place - before) <= 2, key  # a contraction stands for two


def test_a_tuning_is_undone_and_refused_in_one_sentence():
    with Reading(WORDS, hand="sweep:1") as reading:
        style = reading.reader.style
        assert reading.press("U") == ["nothing to undo"]
        assert reading.press("T") == ["texture: 0.9"]
        assert reading.press("#") == ["mapping: " + reading.reader.style.mapping.name]
        reading.press("U", "U")
        assert reading.reader.style == style
        said = [reading.press("j") for _ in range(600)]
        assert all(len(each) == 1 for each in said)
        assert reading.reader.style.geometry.cell_gap_mm > style.geometry.cell_gap_mm


def test_a_change_by_a_key_fades_and_never_jumps():
    with Reading(WORDS, hand="sweep:1") as reading:
        reading.finger(60.0)
        frames = []
        engine = reading.device.engine
        for key in ("n", "T", "C", "s", "#", "n"):
            reading.press(key)
            for _ in range(10):
                ticks = engine.poll()
                frames.append(ticks["frame"].copy())
        steps = np.abs(np.diff(np.concatenate(frames), axis=0)).max()
        assert steps < 0.03


def test_from_a_key_to_the_frame_are_few_calls():
    with Reading(ROWS, hand="sweep:1") as reading:
        reading.press("n", "p", "e")
        calls, modules = 0, set()

        def count(frame, event, _):
            nonlocal calls
            name = frame.f_globals.get("__name__", "")
            if event == "call" and name.startswith("vbraille.reading") and "texts" not in name:
                calls += 1
                modules.add(name)

        sys.setprofile(count)
        try:
            reading.press("n")
        finally:
            sys.setprofile(None)
        assert calls <= 80
        assert len(modules) <= 8


def test_time_brings_the_next_line_and_a_pause_does_not_count():
    with Reading(WORDS, hand="sweep:1") as reading:
        assert reading.press("v") == ["autoscroll: 8.0 cells a second"]
        now_s, reader = 100.0, reading.reader
        reader.idle(now_s)
        cells = len(reader.line)
        for _ in range(round(cells / 8 / 0.2) + 1):
            now_s += 0.2
            reader.idle(now_s)
        assert reading.line == 2
        reading.press(" ")
        for _ in range(100):
            now_s += 0.2
            reader.idle(now_s)
        assert reading.line == 2


# A page on a carriage of two axes


def test_the_line_under_the_finger_is_the_line_that_is_read():
    with Reading(ROWS, TWO, hand="sweep:1") as reading:
        pitch_mm = reading.reader.style.geometry.line_pitch_mm
        reading.finger(20.0, 3.5 * pitch_mm)
        assert reading.line == 4
        # It strays within the band beyond the line's edge.
        reading.finger(20.0, 4.0 * pitch_mm + 0.4 * reading.reader.style.straying.band * pitch_mm)
        assert reading.line == 4
        reading.finger(20.0, 4.6 * pitch_mm)
        assert reading.line == 5


@pytest.mark.parametrize("key", ["n", "p", ">", "<"])
def test_a_jump_brings_its_line_into_the_row_of_the_finger(key):
    with Reading(ROWS, TWO, hand="sweep:1") as reading:
        pitch_mm = reading.reader.style.geometry.line_pitch_mm
        reading.finger(20.0, 5.5 * pitch_mm)
        before = reading.line
        reading.press(key)
        wanted = {"n": before + 1, "p": before - 1, "<": 1}
        assert reading.line == wanted.get(key, reading.reader.layout.count())
        assert reading.reader.row == 5
        reading.run(0.5)
        assert reading.reader.row == 5


def test_a_finger_that_stays_below_the_page_turns_it_once():
    with Reading(ROWS, TWO, hand="sweep:1") as reading:
        reader, pitch_mm = reading.reader, reading.reader.style.geometry.line_pitch_mm
        rows = reader.rows
        reading.finger(20.0, 0.5 * pitch_mm)
        below_mm = reading.device.display.height_mm - 1
        said = reading.finger(20.0, below_mm) + reading.run(2.0)
        assert said.count(f"page: lines {rows + 1} to {2 * rows}") == 1
        assert not [each for each in said if each.startswith(f"page: lines {2 * rows + 1}")]
        reading.finger(20.0, 0.5 * pitch_mm)
        assert reading.line == rows + 1
        assert Cue.PAGE_END in reading.heard.cues


def test_pages_turn_by_keys_and_the_first_is_a_whole_one():
    with Reading(ROWS, TWO, hand="sweep:1") as reading:
        rows = reading.reader.rows
        assert reading.press("[") == ["no previous page"]
        assert reading.press("]")[0] == f"page: lines {rows + 1} to {2 * rows}"
        assert reading.press("[")[0] == f"page: lines 1 to {rows}"
        while reading.press("]")[0] != "no next page":
            pass
        assert reading.reader.lines[-1] == reading.reader.layout.last()


def test_straying_and_its_band_are_changed_and_taken_back():
    with Reading(ROWS, TWO, hand="sweep:1") as reading:
        before = reading.reader.style
        assert reading.press("=") == ["shown: what lies under each contactor"]
        assert reading.reader.style.straying.manner == "free"
        reading.press(")", "U", "U")
        assert reading.reader.style == before
