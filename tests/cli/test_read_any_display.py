"""Reading on a device that no model names: its display is what it says of itself."""

import re
import threading
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest

import vbraille
from tests.cli import program
from tests.render.reader import read_back
from tests.shown import LATERO, array_of
from tests.tiers import heavy
from vbraille.devices.serial.wire import Encoder
from vbraille.render.braille.models import model_of
from vbraille.simulation.firmware import describe
from vbraille.simulation.hand import Sweep
from vbraille.simulation.pty import Port
from vbraille.simulation.simulator import Simulator
from vbraille.testing import ManualClock

STEP_MM = 0.1  # that the finger goes between two frames


class Kept(vbraille.Device):
    """A device under a finger that goes to and fro, and keeps each frame with its place."""

    # No model has these distances.
    display = replace(LATERO, row_pitch_mm=1.5, travel_mm=120.0)

    def __init__(self):
        self.ticks, self.places_mm, self.sent = 0, [], []

    def read(self):
        self.ticks += 1
        there_and_back_mm = STEP_MM * self.ticks % (2 * self.display.travel_mm)
        way_mm = min(there_and_back_mm, 2 * self.display.travel_mm - there_and_back_mm)
        self.x_mm = way_mm - self.display.span_mm / 2
        return vbraille.Pose(self.ticks * 1_000_000, self.x_mm)

    def _send(self, frame):
        self.places_mm.append(self.x_mm)
        self.sent.append(frame.copy())

    def _release(self):
        pass

    def last_pass(self):
        """Frames and places the last time that the finger went rightward."""
        x_mm = np.array(self.places_mm)
        rightward = np.flatnonzero(np.diff(x_mm, append=x_mm[-1:]) > 0)
        begun = rightward[np.flatnonzero(np.diff(rightward, prepend=-2) > 1)[-1]]
        ended = begun + int(np.argmax(x_mm[begun:]))
        return np.array(self.sent[begun:ended]), x_mm[begun:ended]


@contextmanager
def device_of(display):
    """A device with this display behind a port; its spec."""
    port, ended = Port(), threading.Event()
    info = describe(display, Encoder.ABSOLUTE)
    simulator = Simulator(info, Sweep(300.0), port, say=lambda _: None)
    thread = threading.Thread(target=simulator.run, args=(ended.is_set,))
    thread.start()
    try:
        yield f"serial:{port.path}"
    finally:
        ended.set()
        thread.join()
        port.unplug()


def test_a_text_is_read_on_eight_rows_of_eight(tmp_path):
    (tmp_path / "text.txt").write_text("no\n\nbraille\n")
    display = Kept.display
    with device_of(display) as spec:
        done = program.run(
            "read", tmp_path / "text.txt", "--device", spec, "--grade", "1", "--echo", "cells"
        )
    assert (done.returncode, done.stderr) == (0, program.line_width(10, program.UNCONTRACTED))
    assert done.stdout.splitlines()[-1].startswith("summary: lines 2,")
    cells = re.findall("^cells: (.*)$", done.stdout, re.MULTILINE)
    assert cells == ["⠀⠀⠝⠕", "⠀⠀⠃⠗⠁⠊⠇⠇⠑"]
    device, style = Kept(), model_of(display).style
    with vbraille.open(device, clock=ManualClock()) as opened:
        assert [line.text.strip() for line in opened.read("no\n\nbraille", grade=1)] == [
            "no",
            "braille",
        ]
    frames, x_mm = device.last_pass()
    assert not frames[:, [0, 7]].any()  # six rows show braille, the outer ones rest
    read = read_back(frames, x_mm, array=display, mapping=style.mapping, geometry=style.geometry)
    assert "".join(chr(0x2800 + mask) for mask in read.tolist()).rstrip("⠀") == cells[1]


@pytest.mark.parametrize(
    ("rows", "options", "sentence"),
    [
        (8, ("--model", "stress2"), "array has 8 × 8 actuators and the page is for 6 × 10; "),
        # Of a page laid out for a model these two are said the same way, and are tested there.
        pytest.param(
            8,
            ("--dot-row", "2"),
            "the array shows all dot rows; --mapping chooses how",
            marks=heavy,
        ),
        pytest.param(
            4, ("--mapping", "paired"), "mapping paired needs 6 actuator rows", marks=heavy
        ),
        (2, ("--mapping", "paired"), "the array has 2 rows of actuators; --dot-row chooses dots"),
    ],
)
def test_what_a_display_cannot_show_is_one_sentence(call, tmp_path, rows, options, sentence):
    (tmp_path / "text.txt").write_text("no\n")
    with device_of(array_of(rows, 8, 1.2, 1.5)) as spec:
        done = call("read", tmp_path / "text.txt", "--device", spec, *options)
    assert (done.code, done.out) == (2, "")
    assert sentence in done.err
    assert len(done.err.splitlines()) == 1
