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
from vbraille.devices.wire.messages import Encoder
from vbraille.render.braille.models import model_of
from vbraille.simulation.firmware import Controller, describe
from vbraille.simulation.hand import Sweep
from vbraille.simulation.pty import Port
from vbraille.simulation.simulator import Simulator

SPEED_MM_S = 50.0
FRESH_US = 3000  # a frame as old as that was made for a place further left


class Felt(Controller):
    """A controller that keeps what a fingertip feels, and where."""

    def __init__(self, info):
        super().__init__(info)
        self.ways_mm, self.frames_felt, self.fresh = [], [], []

    def tick(self, now_us, way_mm):
        said = super().tick(now_us, way_mm)
        self.ways_mm.append(way_mm)
        self.frames_felt.append(self.levels / self.info.top_level)
        self.fresh.append(not self.resting and now_us - self.last_frame_us < FRESH_US)
        return said


@contextmanager
def device_of(display):
    """A device with this display, moved by a hand; its spec, and the controller in it."""
    port, ended = Port(), threading.Event()
    info = describe(display, Encoder.ABSOLUTE)
    simulator = Simulator(info, Sweep(SPEED_MM_S), port, say=lambda _: None)
    simulator.controller = Felt(info)
    thread = threading.Thread(target=simulator.run, args=(ended.is_set,))
    thread.start()
    try:
        yield f"serial:{port.path}", simulator.controller
    finally:
        ended.set()
        thread.join()
        port.unplug()


def last_pass(felt, display, end_mm):
    """Frames and places of the array's centre the last time that the hand went over the line."""
    x_mm = np.array(felt.ways_mm) - display.span_mm / 2
    on = np.flatnonzero(x_mm > end_mm + display.span_mm / 2)
    # When it came past the end for the last time, and when it had left the left stop before that.
    ended = int(on[np.flatnonzero(np.diff(on, prepend=-2) > 1)[-1]])
    begun = int(np.flatnonzero(x_mm[:ended] <= -display.span_mm / 2)[-1])
    kept = np.arange(begun, ended)[np.array(felt.fresh[begun:ended])]
    return np.array(felt.frames_felt)[kept].reshape(-1, *display.shape), x_mm[kept]


def test_a_text_is_read_on_eight_rows_of_eight(tmp_path):
    (tmp_path / "text.txt").write_text("no\n\nbraille\n")
    display = replace(LATERO, travel_mm=120.0)
    style = model_of(display).style
    with device_of(display) as (spec, felt):
        done = program.run(
            "read", tmp_path / "text.txt", "--device", spec, "--grade", "1", "--echo", "cells"
        )
    assert (done.returncode, done.stderr) == (0, "line width: 10 cells, table en-ueb-g1.ctb\n")
    assert done.stdout.splitlines()[-1].startswith("summary: lines 2,")
    cells = re.findall("^cells: (.*)$", done.stdout, re.MULTILINE)
    assert cells == ["⠀⠀⠝⠕", "⠀⠀⠃⠗⠁⠊⠇⠇⠑"]
    frames, x_mm = last_pass(felt, display, style.geometry.extent_mm(len(cells[1])))
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
    with device_of(array_of(rows, 8, 1.2, 1.6125)) as (spec, _):
        done = call("read", tmp_path / "text.txt", "--device", spec, *options)
    assert (done.code, done.out) == (2, "")
    assert sentence in done.err
    assert len(done.err.splitlines()) == 1
