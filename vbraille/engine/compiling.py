"""Compile all that a reading calls, so that the first one does not wait for it."""

from __future__ import annotations

import numpy as np

from vbraille.engine import ticks
from vbraille.engine.hostprocess import warm_up
from vbraille.engine.mailbox import Extent
from vbraille.engine.record import FLOATS, INTS
from vbraille.render import MODELS, work
from vbraille.render.program import scratch_for
from vbraille.render.scene.compiling import SceneMap, compile_scene
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.textures import Uniform


def compile_all() -> None:
    """Compile the ticks, the frames of `vbraille render`, those of a replay, and pictures."""
    scene = Scene(canvas=Canvas(width_mm=10.0, height_mm=10.0), elements=(Uniform(),))
    SceneMap(scene).deflections(np.zeros(1), np.zeros(1))
    for model in MODELS.values():
        display, style = model.display, model.style
        warm_up(display, Extent(display.rows, display.columns, 0, 2))
        line = style.render(np.zeros(1, np.uint8), display)
        line.path(np.zeros(1))
        line.poses(np.zeros(1), np.zeros(1))
        line.frame(0.0, np.zeros(display.shape))
        compile_scene(scene, display).poses(np.zeros(1), np.zeros(1))
        ints, floats = np.zeros((1, len(INTS)), np.int64), np.zeros((1, len(FLOATS)))
        frames = np.zeros((4, 1, *display.shape))
        scratch = scratch_for(display.shape)
        output, held, target = frames[1:, 0]
        ticks.replay(
            line.numbers,
            line.table,
            scratch,
            ints,
            floats,
            np.zeros(work.AT),
            output,
            held,
            target,
            frames[0],
        )
