"""Recordings of a reading, or of a way over a picture, that no device took part in."""

from __future__ import annotations

import hashlib
import math
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.engine.engine import EndOfLine
from vbraille.errors import InputError
from vbraille.newfile import new_file
from vbraille.pictures.paths import PosedPath
from vbraille.reading.frames import print_of
from vbraille.recording import Recorder, SceneRecorded
from vbraille.signals import EAR
from vbraille.simulation.steering import Area
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from numpy.typing import NDArray

    from vbraille.layout import Layout, Line
    from vbraille.render import Model
    from vbraille.render.program import Program
    from vbraille.scene.scene import Canvas
    from vbraille.simulation.hand import Hand

    Stretch = tuple[list[Line], NDArray[np.float64], NDArray[np.float64]]

_BLOCK_FRAMES = 16_384


class Rendered(NamedTuple):
    """Numbers of lines and frames of a recording, and its length in seconds."""

    lines: int
    frames: int
    seconds: float


def lines_per_page(height_mm: float | None, pitch_mm: float) -> int:
    """Number of lines whose middle a carriage reaches that goes so far across; 0 for one axis.

    Raises
    ------
    InputError
        If it reaches none.
    """
    if not height_mm:
        return 0
    if height_mm < pitch_mm / 2:
        raise InputError(f"{setting('height')} {height_mm:g} mm is less than half a line")
    return math.floor(height_mm / pitch_mm + 0.5)


def render_reading(
    path: str,
    lines: Iterable[Line],
    layout: Layout,
    model: Model,
    hand: Hand,
    rate_hz: float,
    per_page: int = 0,
    *,
    replace_file: bool = False,
    done: Callable[[Line], None] = lambda _line: None,
) -> Rendered:
    """Write every frame of a reading to an HDF5 file.

    Parameters
    ----------
    path
        File to make.
    lines, layout
        Lines that are read, and the layout that they are from.
    model
        Display and style.
    hand
        Hand that reads.
    rate_hz
        Frames a second.
    per_page
        Lines that are shown at once; 0 for one line on a carriage of one axis.
    replace_file
        Whether the file may be there already.
    done
        Function that is told the last line that is done.

    Raises
    ------
    InputError, VbrailleError
        If the file cannot be made, or the disk cannot take it.
    """
    style, display, source = model.style, model.display, layout.book.source
    count = frames = 0
    with EAR.deferred(), new_file(path, replace=replace_file) as file:
        recorder = Recorder(file, display, layout.width)
        for page, x_mm, y_mm in _walk(iter(lines), model, hand, rate_hz, per_page):
            if not count:
                recorder.describe(
                    model,
                    rate_hz=rate_hz,
                    first_line=layout.number(page[0]),
                    source=source.name,
                    sha256=source.sha256(),
                )
            row = min([recorder.add_line(line.masks, print_of(line)) for line in page])
            if per_page:
                program = style.render_page([line.masks for line in page], display)
            else:
                program = style.render(page[0].masks, display)
                y_mm = np.full(x_mm.size, program.own_y_mm)
            t_s, still = (frames + np.arange(x_mm.size)) / rate_hz, np.zeros((x_mm.size, 2))
            way = PosedPath(t_s, x_mm, y_mm, still[:, 0], still)
            _write(recorder, program, way, row, len(page))
            frames += x_mm.size
            count += len(page)
            done(page[-1])
    return Rendered(count, frames, frames / rate_hz)


def render_picture(
    path: str,
    scene: str,
    model: Model,
    make_path: Callable[[Canvas], PosedPath],
    rate_hz: float,
    hand: str,
    *,
    replace_file: bool = False,
    done: Callable[[float], None] = lambda _share: None,
) -> tuple[Rendered, tuple[str, ...]]:
    """Write the frames of a way over a tactile picture to an HDF5 file.

    Parameters
    ----------
    path, scene
        File to make, and the picture's file.
    model
        Display.
    make_path
        Function that makes the way over a canvas.
    rate_hz
        Frames a second.
    hand
        Name of the way, which the file keeps.
    replace_file
        Whether the file may be there already.
    done
        Function that is told the share of the frames that is done.

    Returns
    -------
    Rendered, tuple[str, ...]
        What the recording holds, and notes on the picture's file.

    Raises
    ------
    InputError, VbrailleError
        If the picture cannot be used, the file cannot be made, or the disk cannot take it.
    """
    from vbraille.pictures.composing import compose
    from vbraille.pictures.loading import load_scene
    from vbraille.pictures.scenes import small_png

    display = replace(model.display, rate_hz=rate_hz)
    try:
        written = Path(scene).read_bytes()
    except OSError as error:
        raise InputError(f"{scene} cannot be read: {error.strerror}") from None
    loaded = load_scene(scene, model.style)
    canvas = loaded.scene.canvas
    way = make_path(canvas)
    program = compose(loaded, display, rate_hz=rate_hz)
    frames = way.t_s.size
    with EAR.deferred(), new_file(path, replace=replace_file) as file:
        recorder = Recorder(file, display, 1)
        recorder.describe(
            model,
            rate_hz=rate_hz,
            source=Path(scene).name,
            sha256=hashlib.sha256(written).hexdigest(),
            scene=SceneRecorded(
                text=written,
                title=loaded.title,
                description=loaded.scene.description,
                width_mm=canvas.width_mm,
                height_mm=canvas.height_mm,
                map_png=small_png(loaded.scene, loaded.assets),
            ),
            path=hand,
        )
        _write(recorder, program, way, done=done)
    return Rendered(0, frames, frames / rate_hz), loaded.notes


def _write(
    recorder: Recorder,
    program: Program,
    way: PosedPath,
    row: int = 0,
    rows: int = 1,
    done: Callable[[float], None] = lambda _share: None,
) -> None:
    """Write the frames of a program on a way over it, whose parts are some rows of the page."""
    for start in range(0, way.t_s.size, _BLOCK_FRAMES):
        x_mm, y_mm, theta_rad, t_s, velocity = (
            each[start : start + _BLOCK_FRAMES]
            for each in (way.x_mm, way.y_mm, way.theta_rad, way.t_s, way.velocity_mm_s)
        )
        going_on = start > 0
        part, frames = program.poses(x_mm, y_mm, theta_rad, t_s, velocity, going_on=going_on)
        line = row + part.clip(0, rows - 1)
        recorder.add_frames(t_s, x_mm, line, frames, y_mm=y_mm, theta_rad=theta_rad, part=part)
        EAR.heed()
        done((start + t_s.size) / way.t_s.size)


def _walk(
    lines: Iterator[Line], model: Model, hand: Hand, rate_hz: float, per_page: int
) -> Iterator[Stretch]:
    """Lines that are shown at once, and places along and down the page of the array's centre."""
    span_mm, geometry = model.display.span_mm, model.style.geometry
    x_mm = y_mm = np.zeros(0)
    pitch_mm = geometry.line_pitch_mm
    while page := list(islice(lines, per_page or 1)):
        end_mm = max(geometry.extent_mm(len(line)) for line in page)
        if per_page:
            motion = hand.read_page(Area(len(page), pitch_mm, end_mm, start_mm=-span_mm))
        else:
            motion = hand.read_line(-span_mm, end_mm)
        if not (hand.goes_on and x_mm.size):
            _, x_mm, y_mm, _ = motion.sample(rate_hz)
            x_mm = x_mm + span_mm / 2  # hands move the left
        end = None
        if hand.goes_on and not per_page:  # it goes on from line to line
            end = EndOfLine(span_mm, end_mm).find(x_mm)
        stop = x_mm.size if end is None else end + 1
        yield page, x_mm[:stop], y_mm[:stop]
        x_mm, y_mm = x_mm[stop:], y_mm[stop:]
        if hand.goes_on and not x_mm.size:
            return  # the hand has recorded no more
