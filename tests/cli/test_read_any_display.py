"""Reading on a device that no model names: its display is what it says of itself."""

import re
import threading
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest

from tests.cli import program
from tests.render.reader import read_back
from tests.shown import LATERO, array_of
from tests.tiers import heavy
from vbraille.devices.serial.wire import Encoder
from vbraille.render.braille.models import model_of
from vbraille.simulation.firmware import Controller, describe
from vbraille.simulation.hand import Sweep
from vbraille.simulation.pty import Port
from vbraille.simulation.simulator import Simulator

STEP_MM = 0.5
TURN_MM = 101.0  # beyond the longer line
# Frames that it takes at a place before one is felt. Of those that come after the STATE which told
# the place, one may have been on its way, or was made by a host that was interrupted in between;
# others may have waited for as long as the device was late itself.
FRAMES = 5
LATE_US = 2000


class Felt(Controller):
    """A controller under a finger that goes on from a place when it has felt what is there.

    However late the host or the device is, what is felt was made for the place where it is felt.
    """

    def __init__(self, info):
        super().__init__(info)
        self.places_mm, self.frames_felt = [], []
        self._place_mm, self._going = 0.0, STEP_MM
        self._came, self._ticked_us = 0, 0

    def tick(self, now_us, *_at):  # where it is, is its own
        if self.resting or now_us - self._ticked_us > LATE_US:
            self._came = self.frames
        elif self.frames - self._came >= FRAMES:
            self._feel()
            self._came = self.frames
        self._ticked_us = now_us
        return super().tick(now_us, self._place_mm)

    def _feel(self):
        self.places_mm.append(self._place_mm)
        self.frames_felt.append(self.levels / self.info.top_level)
        self._place_mm = max(self._place_mm + self._going, 0.0)
        if self._place_mm > TURN_MM:
            self._going = -20 * STEP_MM
        elif not self._place_mm:
            self._going = STEP_MM


@contextmanager
def device_of(display):
    """A device with this display; its spec, and the controller in it."""
    port, ended = Port(), threading.Event()
    info = describe(display, Encoder.ABSOLUTE)
    simulator = Simulator(info, Sweep(300.0), port, say=lambda _: None)
    simulator.controller = Felt(info)
    thread = threading.Thread(target=simulator.run, args=(ended.is_set,))
    thread.start()
    try:
        yield f"serial:{port.path}", simulator.controller
    finally:
        ended.set()
        thread.join()
        port.unplug()


def last_pass(felt, display):
    """Frames and places of the array's centre the last time that the finger went rightward."""
    way_mm = np.array(felt.places_mm)
    ended = int(np.flatnonzero(way_mm > TURN_MM - STEP_MM)[-1])
    begun = int(np.flatnonzero(way_mm[:ended] == 0)[-1])
    frames = np.array(felt.frames_felt)[begun:ended].reshape(-1, *display.shape)
    return frames, way_mm[begun:ended] - display.span_mm / 2


def test_a_text_is_read_on_eight_rows_of_eight(tmp_path):
    (tmp_path / "text.txt").write_text("no\n\nbraille\n")
    # No model has these distances.
    display = replace(LATERO, row_pitch_mm=1.5, travel_mm=120.0)
    style = model_of(display).style
    with device_of(display) as (spec, felt):
        done = program.run(
            "read", tmp_path / "text.txt", "--device", spec, "--grade", "1", "--echo", "cells"
        )
    assert (done.returncode, done.stderr) == (0, program.line_width(10, program.UNCONTRACTED))
    assert done.stdout.splitlines()[-1].startswith("summary: lines 2,")
    cells = re.findall("^cells: (.*)$", done.stdout, re.MULTILINE)
    assert cells == ["⠀⠀⠝⠕", "⠀⠀⠃⠗⠁⠊⠇⠇⠑"]
    frames, x_mm = last_pass(felt, display)
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
    with device_of(array_of(rows, 8, 1.2, 1.5)) as (spec, _):
        done = call("read", tmp_path / "text.txt", "--device", spec, *options)
    assert (done.code, done.out) == (2, "")
    assert sentence in done.err
    assert len(done.err.splitlines()) == 1
