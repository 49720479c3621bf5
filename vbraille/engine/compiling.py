"""Compile all that a reading calls, so that the first one does not wait for it.

What all kernels share, the frames, is compiled first. Then two processes go on, each with half of
the rest; `python -m vbraille.engine.compiling` is the second.
"""

from __future__ import annotations

import subprocess
import sys

import numpy as np

from vbraille.devices.levels import pack
from vbraille.engine import ticks
from vbraille.engine.hostprocess import warm_up
from vbraille.engine.record import FLOATS, INTS
from vbraille.render import MODELS, work
from vbraille.render.compiling import SceneMap, compile_scene
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.textures import Uniform


def compile_all() -> None:
    """Compile the ticks, the frames of `vbraille render`, those of a replay, and pictures.

    Raises
    ------
    subprocess.CalledProcessError
        If the other process fails, which says why on standard error.
    """
    # The frames were compiled with the modules above, which name the types of their numbers.
    other = subprocess.Popen([sys.executable, "-m", "vbraille.engine.compiling"])
    try:
        _compile_ticks()
    finally:
        code = other.wait()
    if code:
        raise subprocess.CalledProcessError(code, other.args)


def _compile_ticks() -> None:
    """Ticks of each display, and the frames of a replay."""
    pack(np.zeros((1, 1)), 1, np.zeros(1, np.uint8))
    for model in MODELS.values():
        display = model.display
        warm_up(display)
        line = model.style.render(np.zeros(1, np.uint8), display)
        ints, floats = np.zeros((1, len(INTS)), np.int64), np.zeros((1, len(FLOATS)))
        frames = np.zeros((4, 1, *display.shape))
        output, held, target = frames[1:, 0]
        ticks.replay(
            line.numbers,
            line.table,
            line.scratch,
            ints,
            floats,
            np.zeros(work.AT),
            output,
            held,
            target,
            frames[0],
        )


def _compile_pictures() -> None:
    """Frames of lines and pictures along a path, and maps, whose grids they share."""
    for model in MODELS.values():
        line = model.style.render(np.zeros(1, np.uint8), model.display)
        line.path(np.zeros(1))
        line.poses(np.zeros(1), np.zeros(1))
        line.frame(0.0, np.zeros(model.display.shape))
        compile_scene(_SCENE, model.display).poses(np.zeros(1), np.zeros(1))
    SceneMap(_SCENE).deflections(np.zeros(1), np.zeros(1))


_SCENE = Scene(canvas=Canvas(width_mm=10.0, height_mm=10.0), elements=(Uniform(),))

if __name__ == "__main__":
    _compile_pictures()
