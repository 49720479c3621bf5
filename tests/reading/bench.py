"""A reading in this process: a simulated hand, a clock turned by hand, keys by their names."""

import time
from dataclasses import replace
from pathlib import Path

from vbraille.reading.device import ReadingDevice
from vbraille.reading.exploration import Exploration
from vbraille.reading.outputs import Console
from vbraille.reading.places import Places
from vbraille.reading.reader import Reader
from vbraille.render import STRESS2, STRESS2_8X8
from vbraille.simulation.steering import Hold
from vbraille.testing import ManualClock, simulated_device
from vbraille.translate import Book, BrailleTable, text_source

ONE, TWO = STRESS2, STRESS2_8X8


class Heard(Console):
    """An output that keeps what it is told."""

    def __init__(self):
        super().__init__()
        self.said, self.cues = [], []

    def say(self, sentence, cue=None):
        if sentence:
            self.said.append(sentence)
        self.cues.append(cue)

    def show(self, _what):
        pass


class NoKeyboard:
    """Keys of no terminal."""

    attached, must_stop = True, False

    def catch_interrupts(self, *, caught):
        pass

    def pressed(self, _wait_s):
        return []


class Reading:
    """A text under a simulated hand; a context manager."""

    def __init__(self, text, model=ONE, hand="sweep:1000", places=None, digest="", **how):
        self.heard = Heard()
        clock = ManualClock()
        given = simulated_device(model, hand=hand, clock=clock)
        self.device = ReadingDevice(given, model.display, clock=clock)
        self.device.start(replace(model, display=given.display))
        table = BrailleTable("en-ueb-g1.ctb")
        source = text if not isinstance(text, str) else text_source(text)
        self.book = Book(source, table)
        places = places or Places(None, print)
        kept = places.book(digest, Path(f"/{digest}"), "book")
        self.reader = Reader(self.book, self.device, [self.heard], kept, **how)
        self.reader.begin()
        self.loop = Exploration(self.reader, self.device, NoKeyboard(), self.heard)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.device.close()

    @property
    def line(self):
        """Number of the line under the hand."""
        return self.reader.layout.number(self.reader.line)

    def press(self, *keys):
        """Press keys, and give what is said."""
        before = len(self.heard.said)
        for key in keys:
            self.loop.press(key)
        return self.heard.said[before:]

    def type(self, text):
        """Type a text and Enter, and give what is said."""
        return self.press(*text, "enter")

    def run(self, seconds=0.2):
        """Let time go by, and give what is said."""
        before = len(self.heard.said)
        for _ in range(round(seconds / 0.02)):
            self.loop.step()
        return self.heard.said[before:]

    def until(self, done):
        """Let time go by until something is so."""
        end_s = time.monotonic() + 60
        while not done():
            assert time.monotonic() < end_s, self.heard.said[-5:]
            self.loop.step()

    def finger(self, x_mm, y_mm=0.0):
        """Move the finger to a place, where it stays, and give what is said."""
        before = len(self.heard.said)
        self.device.engine.give(Hold(x_mm, y_mm, 0.0))
        end_s = time.monotonic() + 10
        while time.monotonic() < end_s:
            self.loop.step()
            pose = self.device.pose
            down_mm = abs(pose.y_mm - y_mm) if pose and self.device.display.height_mm else 0
            if pose and abs(pose.x_mm - x_mm) < 0.5 and down_mm < 0.5:
                break
        self.run(0.2)
        return self.heard.said[before:]
