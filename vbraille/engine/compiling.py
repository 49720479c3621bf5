"""Compile all that a reading calls, so that the first one does not wait for it."""

from __future__ import annotations

import numpy as np

from vbraille.devices.levels import pack
from vbraille.engine.hostprocess import warm_up
from vbraille.engine.record import FLOATS, INTS
from vbraille.engine.ticks import replay
from vbraille.render import MODELS, work
from vbraille.render.compiling import SceneMap, compile_scene
from vbraille.scene.patterns import Uniform
from vbraille.scene.scene import Canvas, Scene


def compile_all() -> None:
    """Compile the ticks, the frames of `vbraille render`, those of a replay, and pictures."""
    pack(np.zeros((1, 1)), 1, np.zeros(1, np.uint8))
    one = np.zeros(1)
    for model in MODELS.values():
        display = model.display
        warm_up(display)
        line = model.style.render(np.zeros(1, np.uint8), display)
        line.path(one)
        line.poses(one, one)
        line.frame(0.0, np.zeros(display.shape))
        compile_scene(_SCENE, display).poses(one, one)
        records = np.zeros((1, len(INTS)), np.int64), np.zeros((1, len(FLOATS)))
        frames = np.zeros((4, 1, *display.shape))
        output, held, target = frames[1:, 0]
        program = line.numbers, line.table, line.scratch
        replay(*program, *records, np.zeros(work.AT), output, held, target, frames[0])
    SceneMap(_SCENE).deflections(one, one)


_SCENE = Scene(canvas=Canvas(width_mm=10.0, height_mm=10.0), elements=(Uniform(),))
