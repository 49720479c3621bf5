"""Moving along lines that may be longer than the hand can go, and back from jumps."""

import pytest

from tests.engine.test_loop import straight
from tests.reading.test_reader import Bench
from vbraille.layout.pages import Layout
from vbraille.reading.outputs import Echo
from vbraille.reading.view import Cue
from vbraille.render import STRESS2

LONG = " ".join(f"w{n:02}" for n in range(40))  # many more cells than the hand can cross
PITCH = STRESS2.style.geometry.cell_pitch_mm
SPAN_MM = STRESS2.display.span_mm
CROSSED = 26  # cells


def finger_at(bench, cell):
    """Put the finger on a cell of what is shown, and let the reader know."""
    x_mm = cell * PITCH + 3 - SPAN_MM / 2
    bench.device.move(straight((0, x_mm), (60, x_mm)))
    bench.run(3)


def shown(bench):
    """Cells under the hand, as they are printed."""
    window = bench.reader.window
    return window.line.printed[max(window.offset, 0) :].to_unicode()[: len(window)]


def test_a_pan_shows_the_line_in_parts_and_wraps_to_the_next_and_back():
    bench = Bench(LONG, width=60)
    assert bench.reader.under.width == CROSSED
    whole = [line.printed.to_unicode() for line in bench.layout.lines()]
    seen = [shown(bench)]
    said = []
    for _ in range(len(whole) * 3 - 1):
        said += bench.press(["right"])
        seen.append(shown(bench))
        if said[-1] == "last line":
            break
    last = len(whole)
    parts = [line[at : at + CROSSED] for line in whole for at in range(0, len(line), CROSSED)]
    assert seen[: len(parts)] == parts
    assert said[:3] == ["cells: 27 to 52", f"cells: 53 to {len(whole[0])}", "line: 2"]
    assert said[-1] == "last line"
    for part in reversed(parts[:-1]):
        bench.press(["left"])
        assert shown(bench) == part
    assert bench.press(["left"]) == ["first line"]
    assert bench.reader.lines == 2 * last - 1  # a part is no line of its own


def test_the_ends_of_a_line_are_where_its_parts_are():
    bench = Bench(LONG, width=60)
    assert bench.press(["home"]) == ["start of line"]
    assert bench.press(["end"]) == [f"cells: 53 to {len(bench.reader.line)}"]
    assert bench.press(["end"]) == ["end of line"]
    assert bench.press(["home"]) == ["cells: 1 to 26"]
    short = Bench("one", width=CROSSED)
    assert short.press(["end", "home"]) == ["end of line", "start of line"]


def test_the_cell_under_the_finger_is_told_in_every_part():
    bench = Bench(LONG, width=60)
    finger_at(bench, 3)
    assert bench.reader.cell == 3
    bench.press(["right"])
    bench.run(0.05)
    assert bench.reader.cell == 3 + CROSSED
    assert bench.reader.line.source(3 + CROSSED)[0] == bench.reader.character


def test_the_hand_s_return_brings_the_next_part_and_a_hand_at_the_end_has_not_read_it():
    bench = Bench(LONG, width=60)
    end_mm = STRESS2.style.geometry.extent_mm(CROSSED) + 1

    def move(*places):
        bench.device.move(straight(*enumerate(places)))
        bench.run(len(places) + 2)

    move(-SPAN_MM, end_mm)
    assert bench.reader.window.offset == 0
    move(end_mm, -SPAN_MM)
    assert bench.reader.window.offset == CROSSED
    move(-SPAN_MM, end_mm)
    bench.press(["right"])
    assert bench.reader.window.offset == 2 * CROSSED
    move(end_mm, -SPAN_MM)  # the hand comes home, but never went over this part
    assert bench.reader.window.offset == 2 * CROSSED


def test_top_bottom_and_back_are_a_stack_of_jumps():
    text = "\n\n".join(f"paragraph {n} of this" for n in range(1, 40))
    bench = Bench(text, echo=Echo.TEXT)
    assert bench.press("b") == ["back: there was no jump"]
    bench.press("nn")
    assert bench.press(">") == ["line: 39", "text: paragraph 39 of this"]
    assert bench.press("<") == ["line: 1", "text: paragraph 1 of this"]
    assert bench.press("b")[0] == "line: 39"
    assert bench.press("b")[0] == "line: 3"
    assert bench.press("b") == ["back: there was no jump"]


def test_top_and_bottom_are_those_of_the_range():
    text = "\n\n".join(f"p {n}" for n in range(1, 10))
    bench = Bench(text, first=3, last=7)
    assert bench.press("><b") == ["line: 7", "line: 3", "line: 7"]
    assert bench.press("n") == ["last line"]


def test_blank_lines_are_passed_over_when_that_is_wanted():
    bench = Bench("one\n\n\n\ntwo\n", keep_lines=True)
    assert bench.press("nn") == ["line: 2", "line: 3"]
    bench.press("pp")
    assert bench.press("z") == ["blank lines: skipped"]
    assert bench.press("np") == ["line: 3", "line: 1"]
    assert bench.press("zn") == ["blank lines: read", "line: 2"]


def test_cues_for_the_end_of_a_line_of_a_page_and_for_limits():
    cues = []
    text = "\n".join("abcdefgh" for _ in range(60))
    bench = Bench(text, keep_lines=True, cue=cues.append, advance=False, first=24)
    end_mm = STRESS2.style.geometry.extent_mm(8) + 1

    def read_a_line():
        bench.device.move(straight((0, -SPAN_MM), (0.5, end_mm), (1, -SPAN_MM)))
        bench.run(1.5)

    read_a_line()
    assert cues == [Cue.LINE_END]
    bench.press("n")
    read_a_line()
    assert cues == [Cue.LINE_END, Cue.PAGE_END]
    bench.press("pp")
    assert cues == [Cue.LINE_END, Cue.PAGE_END, Cue.LIMIT]


@pytest.mark.parametrize("cell", [2, 9, 14])
def test_what_is_under_the_finger_stays_there_when_the_page_is_laid_out_anew(cell):
    bench = Bench("some words that are long enough to take two lines of this width", width=CROSSED)
    bench.press("n")
    finger_at(bench, cell)
    before = bench.reader.character
    bench.reader.lay_out_again(width=17)
    assert isinstance(bench.reader.layout, Layout)
    assert bench.reader.layout.width == 17
    bench.run(0.05)
    line = bench.reader.line
    assert bench.reader.cell == line.cell_of(before)
    first, after = line.source(bench.reader.cell)
    assert first <= before < after


def test_where_no_cell_is_under_the_finger_the_line_stays_at_its_beginning():
    bench = Bench("one two", width=CROSSED)
    finger_at(bench, len(bench.reader.line) + 5)
    before = bench.reader.window
    assert bench.reader.cell is None
    bench.reader.lay_out_again(width=CROSSED - 1)
    assert (bench.reader.window.offset, bench.reader.window.start_mm) == (0, before.start_mm)
