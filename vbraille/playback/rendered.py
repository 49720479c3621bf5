"""Recordings of `vbraille render`, played back: `docs/recording.md` describes the file."""

from __future__ import annotations

import base64
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import h5py
import numpy as np
from msgspec.structs import replace as replace_fields

from vbraille.errors import InputError
from vbraille.live.messages import PlayedEvent, SceneShown, ViewState
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

    from numpy.typing import NDArray

    from vbraille.live.messages import LineShown
    from vbraille.render.program import Program

_PIECE_FRAMES: Final = 1024
# Lines above and below the one under the hand that are told to a page.
_AROUND: Final = 3
_MOST_MOMENTS: Final = 4000
# Numbers that are unpacked at once to find where they change.
_BLOCK: Final = 1 << 18


class Rendered(Playback):
    """Frames of a file that `vbraille render` wrote.

    Parameters
    ----------
    path
        Path of the file.

    Raises
    ------
    InputError
        If it is no such file, has no frames, or is of another format.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._path = path
        try:
            self._file = h5py.File(path, "r")
        except UNLIKE as error:
            raise InputError(_not_one(path, "it is damaged, or was not written whole")) from error
        try:
            self._open()
        except InputError:
            self._file.close()
            raise
        except UNLIKE as error:
            self._file.close()
            raise InputError(_not_one(path, "it is HDF5 of something else")) from error

    def first_s(self, number: int) -> float:
        """Time of the first frame of a piece; about, where the file is damaged."""
        return self._time_s(number * _PIECE_FRAMES)

    def read(self, number: int) -> Piece:
        """Read a piece; it is empty where the file is damaged."""
        span = slice(number * _PIECE_FRAMES, (number + 1) * _PIECE_FRAMES)
        try:
            frames = self._numbers["frames"][span].astype(np.float32, copy=False)
            ticks = np.zeros(frames.shape[0], PLAYED)
            times_s = np.nan_to_num(self._numbers["t_s"][span], posinf=0.0)
            lines = self._numbers["line"][span].astype(np.int64)
            for name in ("x_mm", "y_mm", "theta_rad", "part"):
                ticks[name] = self._numbers[name][span]
        except OSError:
            return Piece.damaged(self._display)
        rows = np.where((lines >= 0) & (lines < self._lengths.size), lines, -1)
        ticks["scene"] = rows + 1
        ticks["line"] = np.where(rows >= 0, rows + self._first_line, 0)
        ticks["tick"] = np.arange(span.start, span.start + frames.shape[0])
        ticks["time_s"] = np.maximum.accumulate(times_s)
        steps_s = np.diff(ticks["time_s"], prepend=ticks["time_s"][:1])
        with np.errstate(divide="ignore", invalid="ignore"):
            ticks["vx_mm_s"] = np.diff(ticks["x_mm"], prepend=ticks["x_mm"][:1]) / steps_s
        ticks["share"] = 1.0
        return Piece(ticks, frames)

    def describe(self, scene: int) -> ViewState:
        """Make what a page shows of a line of the recording; scene 0 is no line."""
        style = self._style
        return ViewState(
            number=0,
            title=self._title,
            array=array_shown(self._display),
            geometry={} if style is None else geometry_shown(style.geometry),
            rows_shown=[] if style is None else rows_shown(style, self._display),
            lines=self._lines(scene - 1) if scene and self._picture is None else [],
            place=self._name(scene - 1) if scene and self._picture is None else "",
            mapping="" if self._picture else f"mapping: {self._told('mapping', 'not known')}",
            device="recording",
            facts=self._facts,
            scene=self._picture,
        )

    def program(self, scene: int) -> tuple[Program, str] | None:
        """Compile the line of a scene, or the page that it is on, and tell its title."""
        if self._style is None or not scene:
            return None
        first, stop = self._page(scene - 1)
        masks = [found for row in range(first, stop) if (found := self._masks(row)) is not None]
        if len(masks) < stop - first:
            return None
        if self._paged:
            title = f"{self._title}, {self._name(first)} to {self._name(stop - 1)}"
            return self._style.render_page(masks, self._display), title
        return self._style.render(masks[0], self._display), f"{self._title}, {self._name(first)}"

    def _open(self) -> None:
        file = self._file
        check_format(file)
        needed = (*NUMBERS, "frames", "page/cells", "page/length")
        self._numbers = found = {name: dataset_in(file, name) for name in needed}
        count = found["frames"].shape[0]
        if any(found[name].shape != (count,) for name in NUMBERS):
            raise ValueError
        if not count:
            raise InputError(f"{self._path} has no frame; there is nothing to play")
        self._count, self.pieces = count, -(-count // _PIECE_FRAMES)
        self._rate_hz = float(self._told("rate_hz", "nan"))
        model = model_in(file)
        self._display = model.display
        self._style = model.style if model.name and "scene" not in file else None
        self._picture = self._find_picture()
        self._first_line = max(int(self._told("first_line", "1")), 0)
        self._lengths = found["page/length"][:].astype(np.int64)
        self._title = self._told("source", self._path.name)
        if self._picture is not None:
            self._title = self._picture.title or self._title
        self._facts = [
            ("model", self._told("model", "not known")),
            ("recorded by", f"vbraille {self._told('vbraille_version', 'not known')}"),
            ("frames", f"{count}, {self._rate_hz:g} a second"),
        ]
        self.length_s = float(self._time_s(count - 1))
        starts, lines = _changes(found["line"])
        part_starts, parts = _changes(found["part"])
        self._paged = bool(np.any(parts))
        self._pages = np.arange(self._lengths.size)
        if self._paged:
            self._pages = self._find_pages(starts, lines, part_starts, parts)
        if self._paged and self._style is not None:
            height_mm = self._style.geometry.line_pitch_mm * np.diff(self._page(0)).item()
            self._display = replace(self._display, height_mm=height_mm)
        self.moments = [] if self._picture else self._find_moments(starts, lines)

    def _find_picture(self) -> SceneShown | None:
        """Tactile picture that was recorded; None where lines were. The carriage goes over it."""
        scene = scene_of(self._file)
        if scene is None:
            return None
        self._display = replace(
            self._display, travel_mm=scene.width_mm, height_mm=scene.height_mm, turns=True
        )
        image = f"data:image/png;base64,{base64.b64encode(scene.map_png).decode()}"
        return SceneShown(scene.title, scene.description, scene.width_mm, scene.height_mm, image)

    def _told(self, name: str, otherwise: str) -> str:
        return str(self._file.attrs.get(name, otherwise))

    def _time_s(self, frame: int) -> float:
        """Time of a frame; about, where the file is damaged."""
        try:
            return float(np.nan_to_num(self._numbers["t_s"][frame], posinf=0.0))
        except OSError:
            return frame / self._rate_hz

    def _find_pages(
        self,
        starts: NDArray[np.int64],
        lines: NDArray[np.int64],
        part_starts: NDArray[np.int64],
        parts: NDArray[np.int64],
    ) -> NDArray[np.int64]:
        """Rows at which pages of lines begin."""
        at = np.union1d(starts, part_starts)
        row = lines[np.searchsorted(starts, at, "right") - 1]
        part = parts[np.searchsorted(part_starts, at, "right") - 1]
        # Above a page the row is that of its first line, below it that of its last one. Pages
        # follow each other, so that one which would begin before the page so far is below it.
        first = np.maximum.accumulate(np.where(part < 0, row, row - part))
        return np.unique(np.concatenate([[0], first.clip(0, max(self._lengths.size - 1, 0))]))

    def _page(self, row: int) -> tuple[int, int]:
        """Rows of the lines that were shown together with a line: the first, and after the last."""
        page = int(np.searchsorted(self._pages, row, "right")) - 1
        stop = self._pages[page + 1] if page + 1 < len(self._pages) else self._lengths.size
        return int(self._pages[page]), int(stop)

    def _masks(self, row: int) -> NDArray[np.uint8] | None:
        """Read the cells of a line; None where the file is damaged."""
        try:
            cells = self._numbers["page/cells"][row].astype(np.uint8)
        except OSError:
            return None
        return cells[: max(int(self._lengths[row]), 0)]

    def _print(self, row: int, masks: NDArray[np.uint8] | None) -> dict[str, Any]:
        """Read the text of a line and what each cell stands for; nothing where it is damaged."""
        if masks is None:
            return {}
        try:
            printed = print_in(self._file, row, masks.size)
        except UNLIKE:
            return {}
        return {
            "text": printed.text,
            "sources": [(begin, end) for begin, end in printed.sources.tolist()],
        }

    def _lines(self, row: int) -> list[LineShown]:
        """Lines around one; of those that were shown by themselves, the others are beside it."""
        first, stop = self._page(row) if self._paged else (0, self._lengths.size)
        top = first if self._paged else row
        geometry = STRESS2.style.geometry if self._style is None else self._style.geometry
        return [
            replace_fields(
                cells_shown(
                    at + self._first_line,
                    () if (masks := self._masks(at)) is None else masks,
                    top_mm=(at - top) * geometry.line_pitch_mm,
                    under=at == row,
                ),
                **self._print(at, masks),
            )
            for at in range(max(first, row - _AROUND), min(stop, row + _AROUND + 1))
        ]

    def _name(self, row: int) -> str:
        return f"line {row + self._first_line}"

    def _find_moments(
        self, starts: NDArray[np.int64], lines: NDArray[np.int64]
    ) -> list[PlayedEvent]:
        """Find the moments at which the hand came to each line."""
        every = -(-starts.size // _MOST_MOMENTS)
        # Reading a time takes long; as a rule frames are evenly spaced.
        even = abs(self.length_s * self._rate_hz - (self._count - 1)) < 1e-3
        return [
            PlayedEvent(
                start / self._rate_hz if even else self._time_s(start), "line", self._name(row)
            )
            for start, row in zip(starts[::every].tolist(), lines[::every].tolist(), strict=True)
        ]


def _changes(dataset: h5py.Dataset) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Find where the numbers of a dataset change, without all of them in memory at once.

    Parameters
    ----------
    dataset : int64[n]
        Numbers that seldom change; at least one.

    Returns
    -------
    int64[m], int64[m]
        Indices at which a stretch of equal numbers begins, and the numbers.
    """
    starts, values = [0], [int(dataset[0])]
    for first in range(0, dataset.shape[0], _BLOCK):
        numbers = dataset[first : first + _BLOCK].astype(np.int64)
        at = np.flatnonzero(np.diff(numbers, prepend=values[-1]))
        starts += (at + first).tolist()
        values += numbers[at].tolist()
    return np.array(starts), np.array(values)


def _not_one(path: Path, why: str) -> str:
    return (
        f"{path} cannot be played: {why}; give what vbraille render wrote, or the directory of a "
        f"session"
    )
