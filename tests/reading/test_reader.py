"""A reader on the manual clock: lines, commands, and what is said."""

import io
from dataclasses import replace

import numpy as np
import pytest

from tests.engine.test_loop import Recording, biggest_step, run, straight
from vbraille.engine.clock import ManualClock
from vbraille.engine.loop import LocalEngine
from vbraille.errors import InputError
from vbraille.layout.pages import Layout
from vbraille.reading.commands.table import BOUND
from vbraille.reading.outputs import Echo
from vbraille.reading.reader import Reader
from vbraille.render import STRESS2, Tuning
from vbraille.simulation.hand import Sweep
from vbraille.translate import Book, BrailleTable, Document
from vbraille.translate.braillefiles.lines import open_brf

SPAN_MM = 10.8
TEXT = "one two three\n\nfour five six\n\nseven eight nine\n"


class Device(Recording):
    """A device that counts how often it was told that it is at its left stop."""

    zeroed = 0

    def set_zero(self) -> None:
        self.zeroed += 1


class Bench:
    """A reader with its device, and all that it says."""

    def __init__(
        self,
        text=TEXT,
        hand=None,
        tuning=STRESS2.style.tuning,
        width=20,
        book=None,
        rate_hz=1000.0,
        keep_lines=False,
        **options,
    ):
        self.clock = ManualClock()
        self.device = Device(self.clock, hand, rate_hz=rate_hz)
        self.engine = LocalEngine(
            self.device, self.clock, rate_hz=rate_hz, poll_ticks=round(rate_hz / 100)
        )
        self.loop = self.engine
        self.said: list[str] = []
        if book is None:
            document = Document.from_text(text, keep_lines=keep_lines)
            book = Book(document, BrailleTable("en-ueb-g2.ctb"))
        self.layout = Layout(book, width)
        self.reader = Reader(
            self.layout,
            self.engine,
            model=replace(STRESS2, style=replace(STRESS2.style, tuning=tuning)),
            say=self.said.append,
            steering=self.device.steering,
            **{"bound": BOUND, **options},
        )
        self.reader.start()

    def run(self, seconds=60.0):
        for _ in range(int(seconds * 100)):
            if self.reader.done:
                return
            self.reader.step(self.engine.poll())

    def press(self, keys):
        before = len(self.said)
        for key in keys:
            self.reader.press(key)
        return self.said[before:]


@pytest.mark.no_cover
def test_the_hand_s_return_brings_the_next_line_until_the_end():
    bench = Bench(hand=Sweep(100), echo=Echo.BOTH)
    bench.run()
    assert bench.reader.done
    assert bench.reader.lines == 3
    lines = list(bench.layout.lines())
    assert [s for s in bench.said if not s.startswith("speed")] == [
        said
        for line in lines
        for said in (
            f"line: {line.number}",
            f"cells: {line.printed.to_unicode()}",
            f"text: {line.text}",
        )
    ]
    assert biggest_step(bench.device.sent) < 1  # a frame a tick, and the hand's own motion only


def test_a_text_that_is_braille_already_is_read_like_any_other():
    braille = open_brf(io.BytesIO(b",read ,me\n  #c"), "text")
    bench = Bench(book=Book(braille), hand=Sweep(400), echo=Echo.BOTH)
    bench.run()
    assert bench.reader.done
    assert [said for said in bench.said if not said.startswith("speed")] == [
        "line: 1",
        "cells: ⠠⠗⠑⠁⠙⠀⠠⠍⠑",
        "text: ,read ,me",
        "line: 2",
        "cells: ⠀⠀⠼⠉",
        "text: #c",
    ]


@pytest.mark.parametrize(
    ("echo", "labels"), [("none", []), ("text", ["line", "text"]), ("cells", ["line", "cells"])]
)
def test_echo(echo, labels):
    bench = Bench(echo=Echo(echo))
    assert [said.split(":")[0] for said in bench.said] == labels


def test_a_range_of_lines():
    bench = Bench(hand=Sweep(200), echo=Echo.TEXT, first=2, last=2)
    bench.run()
    assert bench.said[:2] == ["line: 2", "text: four five six"]
    assert bench.reader.lines == 1


def test_a_range_past_the_end_is_refused():
    with pytest.raises(InputError, match=r"ends at line \d+; line 9 is past that"):
        Bench(first=9)


@pytest.mark.no_cover
def test_with_keys_only_a_key_brings_the_next_line():
    bench = Bench(hand=Sweep(300), advance=False, echo=Echo.TEXT)
    bench.run(10)
    assert not bench.reader.done
    assert bench.press("n") == ["line: 2", "text: four five six"]


def test_at_a_terminal_the_end_of_the_text_waits_for_keys():
    bench = Bench(hand=Sweep(300), stay=True, echo=Echo.TEXT, first=3)
    bench.run(10)
    assert not bench.reader.done
    assert bench.said[-1] == "end of text; p goes back, q stops"
    assert bench.said.count(bench.said[-1]) == 1
    assert bench.press("p") == ["first line"]
    bench.press("q")
    assert bench.reader.done


def test_next_and_previous_line_and_their_ends():
    bench = Bench(echo=Echo.TEXT)
    assert bench.press("p") == ["first line"]
    assert bench.press("n")[0] == "line: 2"
    assert bench.press(["down"])[0] == "line: 3"
    assert bench.press("n") == ["last line"]
    assert bench.press(["up"])[0] == "line: 2"


def test_the_word_is_the_one_under_the_middle_of_the_array():
    bench = Bench()
    assert bench.press("w") == ["word: none here"]  # it is not known yet where the hand is
    pitch = STRESS2.style.geometry.cell_pitch_mm
    cells = {}
    line = bench.layout.line(1)
    for cell in range(len(line)):
        bench.device.move(
            straight((0, cell * pitch + 3 - SPAN_MM / 2), (1, cell * pitch + 3 - SPAN_MM / 2))
        )
        run(bench.loop, 1)
        cells[cell] = bench.press("w")[0]
    assert cells[0] == cells[1] == "word: none here"  # the indent
    words = [cells[cell].removeprefix("word: ") for cell in range(len(line))]
    assert [w for n, w in enumerate(words) if w != "none here" and w != words[n - 1]] == [
        "one",
        "two",
        "three",
    ]


def test_pause_and_go_on():
    bench = Bench(hand=Sweep(40))
    bench.run(1)
    assert not bench.loop.resting
    assert bench.press(" ") == ["paused"]
    bench.run(0.03)
    assert bench.loop.resting
    assert bench.press(" ") == ["reading"]
    bench.run(0.5)
    assert not bench.loop.resting


def test_each_turn_is_said_in_one_line_shown_and_kept_in_bounds():
    bench = Bench(tuning=Tuning(texture=0.8, contrast=0.15))
    bench.device.move(straight((0, 25.0), (60, 25.0)))
    run(bench.loop, 0.5)
    before = bench.loop.output.copy()
    assert bench.press("ttt") == ["texture: 0.9", "texture: 1", "texture: 1, the most"]
    assert bench.press("CCC") == ["contrast: 0.05", "contrast: 0", "contrast: 0, the least"]
    assert bench.press("Tcc") == ["texture: 0.9", "contrast: 0.1", "contrast: 0.2"]
    assert bench.reader.style.tuning == Tuning(texture=0.9, contrast=0.2)
    run(bench.loop, 0.5)
    assert np.abs(bench.loop.output - before).max() > 0.01


@pytest.mark.no_cover
def test_a_hand_too_fast_for_texture_is_told_once():
    def told(speed, tuning=STRESS2.style.tuning):
        bench = Bench(text="one", hand=Sweep(speed), tuning=tuning)
        bench.run()
        return [said for said in bench.said if said.startswith("speed")]

    assert told(70) == []
    assert len(told(80)) == 1
    assert "below 74 mm/s" in told(80)[0]
    assert told(80, Tuning(texture=0)) == []
