"""Frames of the gallery's pictures by this commit, against those by another one.

python -m tests.benchmarks.bench_gallery FOLDER

FOLDER is a work tree of the other commit. Each makes its frames in a process of its own; the two
take turns.
"""

from __future__ import annotations

import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.timing import Result, seconds
from vbraille.pictures.composing import compose
from vbraille.pictures.loading import load_scene
from vbraille.render import MODELS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

HERE = Path(__file__).parents[2]
SCENES = sorted((HERE / "texts/scenes/gallery").glob("*.scene"))
MODEL = MODELS["stress2-8x8"]
SWEEPS, PLACES = 20, 100  # over the canvas, from side to side
TURNS, TIMES = 200, 3


@cache
def made(name: str) -> Callable[[], object]:
    """Compile a picture; what is returned makes its frames, in sweeps over the canvas."""
    loaded = load_scene(name, MODEL.style)
    program, canvas = compose(loaded, MODEL.display), loaded.scene.canvas
    places = np.meshgrid(
        np.linspace(0, canvas.width_mm, PLACES),
        (np.arange(SWEEPS) + 0.5) * canvas.height_mm / SWEEPS,
    )
    x_mm, y_mm = (axis.ravel() for axis in places)
    return lambda: program.poses(x_mm, y_mm)


def make_frames() -> None:
    """Make the frames of each picture that a line of the input names; say how long it took."""
    for line in sys.stdin:
        frames = made(line.rstrip())
        print(min(seconds(frames) for _ in range(TIMES)), flush=True)


class FrameMaker:
    """A process that makes frames by the commit in a folder."""

    def __init__(self, folder: Path) -> None:
        self._process = subprocess.Popen(
            [sys.executable, __file__],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={"PYTHONPATH": f"{folder}:{HERE}"},
        )

    def seconds(self, scene: Path) -> float:
        """Time of all frames of a picture."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        print(scene, file=self._process.stdin, flush=True)
        return float(self._process.stdout.readline())

    def end(self) -> None:
        """End the process."""
        self._process.communicate()


def run(other: Path = HERE) -> Iterator[Result]:
    """Measure each picture, and the slowest of them."""
    makers = FrameMaker(HERE), FrameMaker(other)
    worst = 0.0
    for scene in SCENES:
        # What others do on the machine only makes frames slower: the least of each counts.
        ours, theirs = map(
            min, zip(*([m.seconds(scene) for m in makers] for _ in range(TURNS)), strict=True)
        )
        share = ours / theirs
        frame_us = ours / SWEEPS / PLACES * 1e6
        worst = max(worst, share)
        yield Result(
            f"a frame of {scene.name}, against the other commit's",
            "≤ 1.1 ×",
            f"{share:.2f} ×, {frame_us:.2f} µs",
            share <= 1.1,
        )
    for maker in makers:
        maker.end()
    yield Result(f"the most of {len(SCENES)}", "≤ 1.1 ×", f"{worst:.2f} ×", worst <= 1.1)


if __name__ == "__main__":
    if len(sys.argv) == 1:
        make_frames()
    else:
        for result in run(Path(sys.argv[1])):
            print(result.row(), flush=True)
