"""``vbraille render``."""

from __future__ import annotations

import math
import sys
import time
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.cli.old.build import (
    build_book,
    build_lengths,
    build_page,
    build_show,
    lay_out,
    note_unseen_dots,
)
from vbraille.cli.old.terminal import WorkProgress
from vbraille.config.options import CHOICE_OF_TABLE, OPTIONS, PATH
from vbraille.config.settings import settle
from vbraille.display import check_rate
from vbraille.engine.engine import EndOfLine
from vbraille.errors import InputError
from vbraille.newfile import new_file
from vbraille.reading.advancing import too_fast_note
from vbraille.reading.frames import print_of
from vbraille.recording import Recorder
from vbraille.render import MODELS
from vbraille.signals import EAR
from vbraille.simulation.hand import Area
from vbraille.simulation.motion import SLACK
from vbraille.simulation.recorded import Recorded
from vbraille.simulation.specs import parse_hand
from vbraille.wording import count, duration

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.cli.old.build import Page
    from vbraille.layout.pages import Line
    from vbraille.simulation.hand import Hand

_BLOCK_FRAMES = 16_384
_PICTURE_HANDS = ("wide", "spot")
_SCENES = (".scene", ".svg", ".svgz", ".gen", ".tx")
_MOST_HEIGHT_MM = 10_000.0
# So many frames tell how well the rest can be compressed, and take less than half a second.
_ESTIMATED_FROM = 100_000
_LONG_FRAMES = 1_000_000


def run(arguments: argparse.Namespace) -> int:
    """Write the frames of every line asked for, and say how many."""
    if Path(arguments.out).suffix.lower() not in (".h5", ".hdf5"):
        raise InputError(f"{arguments.out} does not end in .h5; render writes HDF5")
    if _is_scene(arguments):
        from vbraille.cli.old.commands import renderscene  # loads what only pictures need

        return renderscene.run(arguments)
    settle(arguments, CHOICE_OF_TABLE)
    model = build_show(arguments, MODELS[arguments.model or "stress2"])
    rate_hz = check_rate(arguments.rate)
    hand = parse_hand(arguments.hand or str(OPTIONS["hand"].default), arguments.seed)
    model = build_lengths(arguments, model)
    model = build_page(arguments, replace(model, display=replace(model.display, height_mm=0.0)))
    pages = _lines_per_page(arguments.height, model.style.geometry.line_pitch_mm)
    page = lay_out(arguments, build_book(arguments), model)
    style, display = model.style, model.display
    note_unseen_dots(page)
    with EAR.at_once():  # numba compiles
        style.render(np.zeros(1, np.uint8), display).path(np.zeros(1))
    lines = frames = 0
    estimate = _Estimate(rate_hz)
    too_fast: str | None = None
    progress = WorkProgress(verbose=arguments.verbose)
    with (
        EAR.deferred(),
        new_file(arguments.out, replace=arguments.force) as file,
    ):
        recorder = Recorder(file, display, page.layout.width)
        recorder.describe(
            model=model,
            rate_hz=rate_hz,
            first_line=page.first,
            source=page.source.name,
            sha256=page.source.sha256(),
        )
        for stretch in _walk(page, hand, rate_hz, pages):
            last = stretch.lines[-1]
            estimate.before(page.share_before(stretch.lines[0]), frames, recorder)
            row = min([recorder.add_line(line.masks, print_of(line)) for line in stretch.lines])
            masks = [line.masks for line in stretch.lines]
            program = (
                style.render_page(masks, display) if pages else style.render(masks[0], display)
            )
            for start in range(0, stretch.x_mm.size, _BLOCK_FRAMES):
                x_mm = stretch.x_mm[start : start + _BLOCK_FRAMES]
                t_s = (frames + np.arange(x_mm.size)) / rate_hz
                if stretch.y_mm is None:
                    made = program.path(x_mm)
                    recorder.add_frames(t_s, x_mm, row, made, y_mm=program.own_y_mm)
                else:
                    y_mm = stretch.y_mm[start : start + _BLOCK_FRAMES]
                    part, made = program.poses(x_mm, y_mm)
                    at = row + np.clip(part, 0, len(masks) - 1)
                    recorder.add_frames(t_s, x_mm, at, made, y_mm=y_mm, part=part)
                frames += x_mm.size
                EAR.heed()
            lines += len(masks)
            too_fast = too_fast or too_fast_note(_fastest(stretch.x_mm, rate_hz), style)
            progress.at(page.progress(last))
    if too_fast is not None:
        print(too_fast, file=sys.stderr)
    page.say_note()
    page.say_unknown()
    print(
        f"rendered: {count(lines, 'line')}, {count(frames, 'frame')}, "
        f"{frames / rate_hz:.1f} s of reading"
    )
    return 0


def _is_scene(arguments: argparse.Namespace) -> bool:
    """Tell whether the file is a tactile picture, which has options of its own."""
    suffix = Path(arguments.file).suffix.lower()
    if suffix in _SCENES or (arguments.hand or "").partition(":")[0] in _PICTURE_HANDS:
        return True
    for name in PATH:
        if getattr(arguments, name) is not None:
            raise InputError(f"--{name} is for a way over a tactile picture; leave it out")
    return False


class _Stretch(NamedTuple):
    """Lines that are shown at once, and where the array's centre goes meanwhile.

    Parameters
    ----------
    lines
        The line, or all lines of a page.
    x_mm : float64[n]
        Places along the lines.
    y_mm : float64[n] or None
        Places down the page; None for a carriage that only goes along its line.
    """

    lines: list[Line]
    x_mm: NDArray[np.float64]
    y_mm: NDArray[np.float64] | None = None


def _lines_per_page(height_mm: float | None, pitch_mm: float) -> int:
    """Number of lines whose middle a carriage of this workspace reaches; 0 for one axis."""
    if height_mm is None:
        return 0
    if not pitch_mm / 2 <= height_mm <= _MOST_HEIGHT_MM:
        raise InputError(
            f"--height is {height_mm:g} mm; it must be {pitch_mm / 2:g}, half a line pitch, to "
            f"{_MOST_HEIGHT_MM:g} mm"
        )
    return math.floor(height_mm / pitch_mm + 0.5)


def _walk(page: Page, hand: Hand | Recorded, rate_hz: float, pages: int) -> Iterator[_Stretch]:
    """Stretches in order with the way of the hand: lines, or pages of ``pages`` lines."""
    if pages:
        return _walk_pages(page, hand, rate_hz, pages)
    return _walk_lines(page, hand, rate_hz)


def _walk_pages(
    page: Page, hand: Hand | Recorded, rate_hz: float, pages: int
) -> Iterator[_Stretch]:
    span_mm, geometry = page.model.display.span_mm, page.model.style.geometry
    found = page.lines()
    while lines := list(islice(found, pages)):
        end_mm = max(geometry.extent_mm(len(line)) for line in lines)
        if isinstance(hand, Recorded):
            motion = hand.motion()
        else:
            area = Area(len(lines), geometry.line_pitch_mm, -span_mm, end_mm)
            motion = hand.read_page(area)
        at_s = np.arange(1 + math.floor(motion.duration_s * rate_hz + SLACK)) / rate_hz
        x_mm = np.interp(at_s, motion.t_s, motion.x_mm) + span_mm / 2
        y_mm = np.zeros(at_s.size)
        if motion.y_mm is not None:
            y_mm = np.interp(at_s, motion.t_s, motion.y_mm)
        yield _Stretch(lines, x_mm, y_mm)
        if isinstance(hand, Recorded):
            return  # the hand has recorded no more


def _walk_lines(page: Page, hand: Hand | Recorded, rate_hz: float) -> Iterator[_Stretch]:
    span_mm = page.model.display.span_mm
    middle_mm = span_mm / 2  # hands move the left column
    recorded = hand.motion().sample(rate_hz) + middle_mm if isinstance(hand, Recorded) else None
    for line in page.lines():
        end_mm = page.model.style.geometry.extent_mm(len(line))
        if recorded is None:
            assert not isinstance(hand, Recorded)
            yield _Stretch([line], hand.read_line(-span_mm, end_mm).sample(rate_hz) + middle_mm)
            continue
        if not recorded.size:
            return
        done = EndOfLine(span_mm, end_mm).find(recorded)
        stop = recorded.size if done is None else done + 1
        yield _Stretch([line], recorded[:stop])
        recorded = recorded[stop:]


def _fastest(x_mm: NDArray[np.float64], rate_hz: float) -> float:
    """Largest speed to the right, in mm/s, as a mean over a twentieth of a second."""
    window = max(1, round(rate_hz / 20))
    if x_mm.size <= window:
        return 0.0
    return float((x_mm[window:] - x_mm[:-window]).max()) * rate_hz / window


class _Estimate:
    """Estimate of what a long recording will take, said once when a small part is done."""

    def __init__(self, rate_hz: float) -> None:
        self._rate_hz = rate_hz
        self._begun_s = time.monotonic()
        self._share = 0.0
        self._said = False

    def before(self, share: float, frames: int, recorder: Recorder) -> None:
        """Take note of what is done before a line: its share of all, its frames, its file.

        Shares of a book grow from paragraph to paragraph, and are right where one begins.
        """
        begins, self._share = share > self._share, share
        if self._said or not begins or frames < _ESTIMATED_FROM:
            return
        self._said = True
        if frames / share < _LONG_FRAMES:
            return
        seconds = (time.monotonic() - self._begun_s) / share
        print(
            f"estimate: about {frames / share / 1e6:.2g} million frames, "
            f"{duration(frames / share / self._rate_hz)} of reading, "
            f"{recorder.stored_bytes / share / 1e6:.2g} MB, {duration(seconds)} of work",
            file=sys.stderr,
            flush=True,
        )
