"""Frames and poses in HDF5: one layout for `render` and playback.

`docs/recording.md` describes it.
"""

from __future__ import annotations

import io
import json
import os
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import h5py
import numpy as np

from vbraille.errors import InputError, VbrailleError
from vbraille.files import whole_file
from vbraille.version import __version__
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator

    from _typeshed import ReadableBuffer as Buffer
    from _typeshed import WriteableBuffer
    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.render.braille.models import Model

FORMAT = 2
CHUNK_FRAMES = 1024
_CHUNK_LINES = 64


class Recorder:
    """Append frames and lines to an open file.

    Parameters
    ----------
    file
        An open file, as `new_file` gives it.
    display
        The actuators and the carriage.
    width
        Number of cells in a line.
    """

    def __init__(self, file: NewFile, display: Display, width: int) -> None:
        self._file = file
        rows, columns = display.shape

        def growing(name: str, dtype: str, *shape: int, chunk: int = CHUNK_FRAMES) -> h5py.Dataset:
            # The filters that every HDF5 library has. Bytes of frames are shared out by their
            # places in a number (shuffle) to no advantage; those of times and places are.
            return file.create_dataset(
                name,
                (0, *shape),
                dtype,
                maxshape=(None, *shape),
                chunks=(chunk, *shape),
                compression="gzip",
                compression_opts=1,
                shuffle=name != "frames",
            )

        self._time = growing("t_s", "f8")
        self._pose = [growing(name, "f8") for name in ("x_mm", "y_mm", "theta_rad")]
        self._line = growing("line", "i8")
        self._part = growing("part", "i8")
        self._frames = growing("frames", "f4", rows, columns)
        self._cells = growing("page/cells", "u1", width, chunk=_CHUNK_LINES)
        self._length = growing("page/length", "i8", chunk=_CHUNK_LINES)
        file.attrs["column_offset_mm"] = display.column_offsets_mm()
        file.attrs["row_offset_mm"] = display.row_offsets_mm()
        file.attrs["vbraille_version"] = __version__
        file.attrs["format"] = FORMAT

    def describe(
        self,
        *,
        model: Model,
        rate_hz: float,
        first_line: int,
        source: str,
        sha256: str,
        calibration: dict[str, Any] | None = None,
    ) -> None:
        """Write what was rendered, and how, as attributes."""
        self._file.attrs.update(
            model=model.name,
            mapping=model.style.mapping.name,
            geometry=json.dumps(asdict(model.style.geometry)),
            tuning=json.dumps(asdict(model.style.tuning)),
            rate_hz=rate_hz,
            first_line=first_line,
            source=source,
            source_sha256=sha256,
            calibration=json.dumps(calibration),
        )

    @property
    def stored_bytes(self) -> int:
        """Tell how many bytes the frames and their places take on the disk so far, compressed."""
        kept = (self._time, *self._pose, self._line, self._part, self._frames)
        return sum(dataset.id.get_storage_size() for dataset in kept)

    def add_line(self, masks: NDArray[np.uint8]) -> int:
        """Append a line of the page, and return its row in ``page/cells``."""
        row = self._length.shape[0]
        self._cells.resize(row + 1, 0)
        self._cells[row, : masks.size] = masks
        self._length.resize(row + 1, 0)
        self._length[row] = masks.size
        return row

    def add_frames(
        self,
        t_s: NDArray[np.float64],
        x_mm: NDArray[np.float64],
        line: NDArray[np.int64] | int,
        frames: NDArray[np.float32],
        *,
        y_mm: NDArray[np.float64] | float = 0.0,
        theta_rad: NDArray[np.float64] | float = 0.0,
        part: NDArray[np.int64] | int = 0,
    ) -> None:
        """Append frames of one line, or of a page of lines.

        Parameters
        ----------
        t_s, x_mm : float64[n]
            Times, and places of the array's centre.
        line : int64[n] or int
            Number of the row of ``page/cells`` that was under the array.
        frames : float32[n, rows, columns]
            Deflections, 0 … 1.
        y_mm, theta_rad : float64[n]
            The rest of the pose, see `vbraille.pose`.
        part : int64[n]
            Which part of a picture that has several was under the array.
        """
        before = self._time.shape[0]
        after = before + t_s.size
        for dataset, values in (
            (self._time, t_s),
            *zip(self._pose, (x_mm, y_mm, theta_rad), strict=True),
            (self._line, line),
            (self._part, part),
            (self._frames, frames),
        ):
            dataset.resize(after, 0)
            dataset[before:after] = values
        self._file.check()


class Poses(NamedTuple):
    """Where the array was at each frame of a recording.

    Parameters
    ----------
    t_s : float64[n]
        Time of each frame, from 0.
    x_mm, y_mm, theta_rad : float64[n]
        Pose of the array then; see `vbraille.pose`.
    """

    t_s: NDArray[np.float64]
    x_mm: NDArray[np.float64]
    y_mm: NDArray[np.float64]
    theta_rad: NDArray[np.float64]


def poses_of(file: h5py.File) -> Poses:
    """Read the poses of a recording of any format.

    A recording of format 1, which has no attribute ``format``, holds places of the array's left
    column; its poses are made of them.

    Raises
    ------
    InputError
        If it is of a newer format.
    """
    if _format_of(file) > 1:
        return Poses(*(_numbers(file, name) for name in Poses._fields))
    left_mm = _numbers(file, "x_mm")
    nothing = np.zeros(left_mm.size)
    return Poses(_numbers(file, "t_s"), left_mm + _half_mm(file), nothing, nothing)


def anchor_mm(file: h5py.File) -> float:
    """Tell how far right of the array's left column the places in a recording were taken.

    `vbraille.render.program.Program.with_anchor` with this distance makes a program of the line
    that gives the same frames for ``x_mm`` as it stands in the file, bit for bit.

    Raises
    ------
    InputError
        If it is of a newer format.
    """
    return 0.0 if _format_of(file) == 1 else _half_mm(file)


def _numbers(file: h5py.File, name: str) -> NDArray[np.float64]:
    dataset = file[name]
    assert isinstance(dataset, h5py.Dataset)
    return dataset[:]


def _half_mm(file: h5py.File) -> float:
    """Tell the distance from the array's left column to its centre."""
    return float(np.asarray(file.attrs["column_offset_mm"])[-1]) / 2


def _format_of(file: h5py.File) -> int:
    found = int(np.asarray(file.attrs.get("format", 1)))
    if found > FORMAT:
        raise InputError(
            f"{file.filename} is a recording of format {found}, and this vbraille knows format "
            f"{FORMAT}; use the vbraille that made it, or a newer one"
        )
    return found


@contextmanager
def new_file(path: Path | str, *, replace: bool = False) -> Iterator[NewFile]:
    """Open an HDF5 file for writing, which gets its name only once it is whole.

    If anything ends the writing early, nothing is left behind.

    Parameters
    ----------
    path
        Path of the file to make.
    replace
        Whether it may take the place of a file that is there.

    Raises
    ------
    InputError
        If no file can be made there, or one is there that may not be replaced.
    VbrailleError
        If writing fails, as on a full disk.
    """
    path = Path(path)
    with whole_file(path, replace=True) as partial:
        try:
            if path.is_dir():
                raise InputError(f"{path} is a directory; give the name of a file in it")
            if not replace:
                _refuse_existing(path)
            target = _Target(partial)
        except OSError as error:
            raise InputError(f"{path} cannot be written: {error.strerror}") from None
        try:
            with target, NewFile(target) as file:
                yield file
            target.check()
        except _DiskError as error:
            raise VbrailleError(f"{path} could not be written: {error}") from None
        if not replace:  # somebody may have made one meanwhile
            _refuse_existing(path)


def _refuse_existing(path: Path) -> None:
    if os.path.lexists(path):
        raise InputError(
            f"{path} is there already; choose another name, or replace it by {setting('force')}"
        )


class NewFile(h5py.File):
    """A file that is being written."""

    def __init__(self, target: _Target) -> None:
        super().__init__(target, "w")
        self.check = target.check


class _DiskError(Exception):
    """The system refused to write; the message says why."""


class _Target(io.FileIO):
    """A file for HDF5, which would crash the process some time after a failed write.

    The first failure is kept for `check`, and what comes later goes nowhere.
    """

    def __init__(self, path: Path) -> None:
        self._error: OSError | None = None
        super().__init__(path, "w+")

    def check(self) -> None:
        """Raise `_DiskError` if a write has failed."""
        if self._error is not None:
            raise _DiskError(self._error.strerror)

    def write(self, data: Buffer) -> int:
        view = memoryview(data).cast("B")
        done = 0
        while self._error is None and done < view.nbytes:
            try:
                done += super().write(view[done:])
            except OSError as error:
                self._error = error
        return view.nbytes

    def truncate(self, size: int | None = None) -> int:
        if self._error is None:
            try:
                return super().truncate(size)
            except OSError as error:
                self._error = error
        return size or 0

    def readinto(self, buffer: WriteableBuffer) -> int:
        # What was never written reads as zeros.
        view = memoryview(buffer).cast("B")
        count = super().readinto(view) or 0
        if self._error is not None:
            view[count:] = bytes(view.nbytes - count)
            count = view.nbytes
        return count
