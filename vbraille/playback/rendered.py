"""Recordings of `vbraille render`, played back: `docs/recording.md` describes the file."""

from __future__ import annotations

import base64
from contextlib import ExitStack
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import h5py
import numpy as np
from msgspec.structs import replace as replace_fields

from vbraille.errors import InputError
from vbraille.live.messages import LineShown, PlayedEvent, SceneShown, ViewState
from vbraille.live.states import array_shown, cells_shown, geometry_shown, rows_shown
from vbraille.playback.recorded import PLAYED, Piece, Playback
from vbraille.recording import (
    NUMBERS,
    UNLIKE,
    check_format,
    dataset_in,
    model_in,
    print_in,
    scene_of,
)
from vbraille.render import STRESS2

if TYPE_CHECKING:
    from pathlib import Path

_PIECE_FRAMES: Final = 1024
_AROUND: Final = 3  # lines above and below the one under the hand
_MOST_MOMENTS: Final = 4000


def open_recording(path: Path) -> Playback:
    """Open what `vbraille render` wrote.

    Raises
    ------
    InputError
        If it is something else, or has no whole frame.
    """
    with ExitStack() as opened:
        try:
            file = opened.enter_context(h5py.File(path, "r"))
            found = Rendered(file, path.name)
            found.locate(0.0)  # there is a whole frame, which later calls find at the worst
        except FileNotFoundError:
            raise InputError(f"there is no file {path}; check the name") from None
        except BlockingIOError:
            raise InputError(f"{path} is open in another program; close it there") from None
        except UNLIKE:
            raise InputError(
                f"{path} is no recording, or is damaged; give what vbraille render wrote, or a "
                f"session"
            ) from None
        opened.pop_all()
    return found


class Rendered(Playback):
    """Frames of a file that `vbraille render` wrote."""

    def __init__(self, file: h5py.File, name: str) -> None:
        super().__init__()
        check_format(file)
        self._file = file
        needed = (*NUMBERS, "frames", "page/cells", "page/length")
        self._numbers = found = {name: dataset_in(file, name) for name in needed}
        count = found["frames"].shape[0]
        if any(found[name].shape != (count,) for name in NUMBERS):
            raise ValueError("numbers and frames are not as many")
        if not count:
            raise InputError(f"{name} has no frame; there is nothing to play")
        if (np.diff(found["t_s"]) < 0).any():
            raise InputError("the times of a recording must increase")
        model = model_in(file)
        self.pieces = -(-count // _PIECE_FRAMES)
        self._rate_hz = model.display.rate_hz
        self._display = model.display
        self._style = model.style if model.name and "scene" not in file else None
        self._first_line = max(int(np.asarray(file.attrs["first_line"])), 0)
        self._lengths = found["page/length"][:].astype(np.int64)
        self._title = str(file.attrs["source"])
        self._facts = [
            ("model", str(file.attrs["model"]) or "not known"),
            ("recorded by", f"vbraille {file.attrs['vbraille_version']}"),
            ("frames", f"{count}, {self._rate_hz:g} a second"),
        ]
        self.length_s = self._time_s(count - 1)
        self._picture = self._find_picture()
        line, part = (found[name][:].astype(np.int64) for name in ("line", "part"))
        starts = np.flatnonzero(np.diff(line, prepend=-1))
        every = -(-starts.size // _MOST_MOMENTS)
        self.moments = [] if self._picture else [
            PlayedEvent(self._time_s(start), "line", self._name(line[start]))
            for start in starts[::every].tolist()
        ]  # fmt: skip
        # The rows at which pages of lines begin. Above a page the row is that of its first line,
        # below it that of its last one; pages follow each other.
        first = np.maximum.accumulate(np.where(part < 0, line, line - part))
        self._paged = bool(part.any())
        self._pages = np.unique([0, *first]) if self._paged else np.arange(self._lengths.size)
        if self._paged and self._style is not None:
            first_row, after_row = self._page(0)
            high_mm = self._style.geometry.line_pitch_mm * (after_row - first_row)
            self._display = replace(self._display, height_mm=high_mm)

    def first_s(self, number: int) -> float:
        """Give the time of the first frame of a piece; about, where the file is damaged."""
        return self._time_s(number * _PIECE_FRAMES)

    def read(self, number: int) -> Piece:
        """Read a piece; it is empty where the file is damaged."""
        span = slice(number * _PIECE_FRAMES, (number + 1) * _PIECE_FRAMES)
        try:
            frames = self._numbers["frames"][span].astype(np.float32, copy=False)
            found = {name: self._numbers[name][span] for name in NUMBERS}
        except OSError:
            return Piece(np.zeros(0, PLAYED), np.zeros((0, *self._display.shape), np.float32))
        ticks = np.zeros(frames.shape[0], PLAYED)
        for name in ("x_mm", "y_mm", "theta_rad", "part"):
            ticks[name] = found[name]
        known = (found["line"] >= 0) & (found["line"] < self._lengths.size)
        ticks["scene"] = np.where(known, found["line"] + 1, 0)
        ticks["line"] = np.where(known, found["line"] + self._first_line, 0)
        ticks["tick"] = np.arange(span.start, span.start + frames.shape[0])
        ticks["time_s"] = np.maximum.accumulate(np.nan_to_num(found["t_s"], posinf=0.0))
        ticks["share"] = 1.0
        with np.errstate(divide="ignore", invalid="ignore"):
            step_s = np.diff(ticks["time_s"], prepend=ticks["time_s"][:1])
            ticks["vx_mm_s"] = np.diff(ticks["x_mm"], prepend=ticks["x_mm"][:1]) / step_s
        return Piece(ticks, frames)

    def describe(self, scene: int) -> ViewState:
        """Make what a page shows of a line of the recording; scene 0 is no line."""
        style, lined = self._style, scene > 0 and self._picture is None
        return ViewState(
            title=self._title if self._picture is None else self._picture.title or self._title,
            array=array_shown(self._display),
            geometry={} if style is None else geometry_shown(style.geometry),
            rows_shown=[] if style is None else rows_shown(style, self._display),
            lines=self._lines(scene - 1) if lined else [],
            place=self._name(scene - 1) if lined else "",
            mapping="" if self._picture else f"mapping: {self._file.attrs['mapping']}",
            device="recording",
            facts=self._facts,
            scene=self._picture,
        )

    def _find_picture(self) -> SceneShown | None:
        """Find the tactile picture that was recorded; the carriage goes over all of it."""
        scene = scene_of(self._file)
        if scene is None:
            return None
        self._display = replace(
            self._display, travel_mm=scene.width_mm, height_mm=scene.height_mm, turns=True
        )
        image = f"data:image/png;base64,{base64.b64encode(scene.map_png).decode()}"
        return SceneShown(scene.title, scene.description, scene.width_mm, scene.height_mm, image)

    def _time_s(self, frame: int) -> float:
        try:
            return float(np.nan_to_num(self._numbers["t_s"][frame], posinf=0.0))
        except OSError:
            return frame / self._rate_hz

    def _page(self, row: int) -> tuple[int, int]:
        """Give the rows of the lines on the page of a line: the first, and after the last."""
        page = int(np.searchsorted(self._pages, row, "right"))
        after = self._pages[page] if page < len(self._pages) else self._lengths.size
        return int(self._pages[page - 1]), int(after)

    def _lines(self, row: int) -> list[LineShown]:
        """Show the lines around one."""
        first, after = self._page(row) if self._paged else (0, self._lengths.size)
        top = first if self._paged else row
        geometry = (self._style or STRESS2.style).geometry
        return [
            self._line(at, (at - top) * geometry.line_pitch_mm, under=at == row)
            for at in range(max(first, row - _AROUND), min(after, row + _AROUND + 1))
        ]

    def _line(self, row: int, top_mm: float, *, under: bool) -> LineShown:
        number = row + self._first_line
        try:
            masks = self._numbers["page/cells"][row][: self._lengths[row]]
            text, sources = print_in(self._file, row, masks.size)
        except UNLIKE:  # damaged
            return cells_shown(number, (), top_mm=top_mm, under=under)
        shown = cells_shown(number, masks, text, top_mm=top_mm, under=under)
        return replace_fields(shown, sources=[(begin, end) for begin, end in sources.tolist()])

    def _name(self, row: int) -> str:
        return f"line {row + self._first_line}"
