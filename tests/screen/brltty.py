"""A real BRLTTY that drives a screen of the program's, and a program that writes by BrlAPI."""

import shutil
import socket
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from vbraille.engine.record import tick_dtype
from vbraille.reading.brltty import Port
from vbraille.reading.device import ReadingDevice
from vbraille.reading.exploration import Exploration
from vbraille.reading.keys import Keyboard
from vbraille.reading.outputs import Console
from vbraille.reading.screen import Screen

PATIENCE_S = 40.0
_LINE_MM = 50.0  # five cells


class Brltty:
    """BRLTTY with its Virtual driver, at a socket; a context manager."""

    def __init__(self, folder, place):
        program = shutil.which("brltty")
        if program is None:
            pytest.skip("brltty is not installed")
        with socket.create_server(("127.0.0.1", 0)) as free:
            self.number = free.getsockname()[1] - 4101  # BrlAPI's first port
        self._command = [
            *(program, "-b", "vr", "-d", f"client:{place}", "-x", "no", "-n", "-e", "-q"),
            *("-A", f"auth=none,host=127.0.0.1:{self.number}", "-f", "/dev/null"),
            *("-P", str(folder / "pid"), "-W", str(folder), "-U", str(folder)),
        ]
        self.process = None

    def __enter__(self):
        silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        self.process = subprocess.Popen(self._command, **silent)
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

    def client(self):
        """Connect by BrlAPI, once that is ready."""
        sys.path.append("/usr/lib/python3/dist-packages")
        brlapi = pytest.importorskip("brlapi")
        sys.path.pop()
        end_s = time.monotonic() + PATIENCE_S
        while True:
            try:
                client = brlapi.Connection(f"127.0.0.1:{self.number}".encode(), b"none")
                break
            except brlapi.ConnectionError:
                assert time.monotonic() < end_s
                time.sleep(0.05)
        client.enterTtyMode(1)
        return client


class Heard:
    """An output that keeps what is said."""

    def __init__(self):
        self.said, self.shown = [], []

    def say(self, sentence, cue=None):  # noqa: ARG002
        self.said.append(sentence)

    def show(self, what):
        self.shown.append((what.text, list(what.line_masks)))


class Shown:
    """A screen on a simulated device, which goes on as long as something is waited for."""

    def __init__(self, device, port, model):
        self.device, self.port, self.heard = device, port, Heard()
        self.ticks = []
        self._kind = tick_dtype(model.display.shape)
        keyboard = Keyboard()
        self.screen = Screen(port, device, [self.heard], model.style, keyboard)
        follow = self.screen.follow
        self.screen.follow = lambda ticks: (self.ticks.append(ticks), follow(ticks))
        self._loop = Exploration(self.screen, device, keyboard, Console())

    def written_by(self, brltty):
        """A program that can write what is shown, once BRLTTY knows the size."""
        # BRLTTY 6.5 ends with a segmentation fault if a program writes while its first message
        # is being shown.
        self.until(lambda: "no screen" in self.screen.talk.text)
        self.rest(0.5)
        client = brltty.client()
        rows, cells = self.screen.talk.masks.shape
        self.until(lambda: client.displaySize == (cells, rows))
        return client

    def until(self, so, patience_s=PATIENCE_S):
        """Go on until something is so."""
        end_s = time.monotonic() + patience_s
        while not so():
            self._loop.step()
            assert time.monotonic() < end_s, self.heard.said

    def felt(self, model, rows=1):
        """Go on until the hand has been over each row; ticks whose change has faded in."""
        self.ticks.clear()
        self.screen.steer()

        def is_enough():
            ticks = self.settled()
            found = (of_row(ticks, model, row if rows > 1 else None) for row in range(rows))
            places = [at["x_mm"] for at in found]
            return all(x.size and x.min() < 0 and x.max() > _LINE_MM for x in places)

        self.until(is_enough)
        return self.settled()

    def settled(self):
        """Ticks so far, of those whose change has faded in."""
        ticks = np.concatenate(self.ticks) if self.ticks else np.zeros(0, self._kind)
        return ticks[ticks["share"] >= 1]

    def rest(self, seconds):
        """Go on for a while; the ticks meanwhile."""
        self.ticks.clear()
        end_s = time.monotonic() + seconds
        self.until(lambda: time.monotonic() > end_s)
        return self.settled()


@contextmanager
def shown(folder, model, hand="sweep:80"):
    """A screen on a simulated device of a model."""
    place = Path(folder) / "socket"
    port = Port(str(place))
    with ReadingDevice("sim", model.display, hand=hand) as device:
        try:
            device.start(model)
            yield Shown(device, port, model)
        finally:
            port.close()


def of_row(ticks, model, row):
    """Ticks in the middle of a row of a page; all of them for None."""
    if row is None:
        return ticks
    at = ticks["y_mm"] / model.style.geometry.line_pitch_mm - row - 0.5
    return ticks[np.abs(at) < 0.1]


def decoded(ticks, model, count, row=None):
    """Dot masks of the first cells of a line, by what actuators did where its dots are."""
    style, display = model.style, model.display
    geometry = style.geometry
    offsets = display.column_offsets_mm() - display.span_mm / 2
    ticks = of_row(ticks, model, row)
    places = ticks["x_mm"][:, None] + offsets
    masks = []
    for cell in range(count):
        mask = 0
        for dot in range(6):
            column, dot_row = divmod(dot, 3)
            middle = cell * geometry.cell_pitch_mm + geometry.dot_width_mm / 2
            middle += column * geometry.dot_spacing_mm
            actuators = (style.mapping.left, style.mapping.right)[column].index(dot_row)
            felt = ticks["frame"][:, actuators][np.abs(places - middle) < 0.7]
            assert felt.size, "the hand was not there"
            mask |= (felt.mean() > 0.2) << dot
        masks.append(int(mask))
    return masks
