"""``vbraille render`` of a tactile picture."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.old.terminal import WorkProgress, say_line
from vbraille.config.options import PATH
from vbraille.display import check_rate
from vbraille.errors import InputError
from vbraille.feeling.composing import compose
from vbraille.feeling.loading import load_scene
from vbraille.feeling.paths import PathOptions, path_of
from vbraille.newfile import new_file
from vbraille.pictures.scenes import small_png
from vbraille.recording import Recorder, SceneRecorded
from vbraille.render import MODELS
from vbraille.signals import EAR
from vbraille.wording import count

if TYPE_CHECKING:
    import argparse

_BLOCK_FRAMES = 16_384
_MODEL = "stress2-8x8"


def path_options(arguments: argparse.Namespace) -> PathOptions:
    """Options of the path, as they were given."""
    given = {name: getattr(arguments, name) for name in PATH}
    return PathOptions(arguments.hand or "wide", **given)


def run(arguments: argparse.Namespace) -> int:
    """Write the frames of a picture along a path, and say how many."""
    model = MODELS[arguments.model or _MODEL]
    rate_hz = check_rate(arguments.rate)
    display = replace(model.display, rate_hz=rate_hz)
    try:
        written = Path(arguments.file).read_bytes()
    except OSError as error:
        raise InputError(f"{arguments.file} cannot be read: {error.strerror}") from None
    loaded = load_scene(arguments.file, model.style)
    path = path_of(path_options(arguments), loaded.scene.canvas, display.span_mm, rate_hz)
    with EAR.at_once():  # numba compiles
        program = compose(loaded, display, rate_hz=rate_hz)
        program.poses(path.x_mm[:1], path.y_mm[:1], path.theta_rad[:1])
    for note in loaded.notes:
        say_line(f"note: {note}", aside=True)
    frames = path.t_s.size
    progress = WorkProgress(verbose=arguments.verbose)
    with (
        EAR.deferred(),
        new_file(arguments.out, replace=arguments.force) as file,
    ):
        recorder = Recorder(file, display, 1)
        recorder.describe_scene(
            SceneRecorded(
                text=written,
                title=loaded.title,
                description=loaded.scene.description,
                width_mm=loaded.scene.canvas.width_mm,
                height_mm=loaded.scene.canvas.height_mm,
                map_png=small_png(loaded.scene, loaded.assets),
            ),
            model=model,
            rate_hz=rate_hz,
            source=Path(arguments.file).name,
            sha256=hashlib.sha256(written).hexdigest(),
            path=arguments.hand or "wide",
        )
        for start in range(0, frames, _BLOCK_FRAMES):
            span = slice(start, start + _BLOCK_FRAMES)
            t_s, x_mm, y_mm = path.t_s[span], path.x_mm[span], path.y_mm[span]
            theta_rad = path.theta_rad[span]
            velocity = path.velocity_mm_s[span]
            _, made = program.poses(x_mm, y_mm, theta_rad, t_s, velocity, going_on=start > 0)
            recorder.add_frames(t_s, x_mm, 0, made, y_mm=y_mm, theta_rad=theta_rad)
            EAR.heed()
            progress.at((start + t_s.size) / frames)
    say_line(f"rendered: {count(frames, 'frame')}, {frames / rate_hz:.1f} s on the path")
    return 0
