"""Frames and positions in HDF5: one layout for `render`, sessions and playback.

`docs/recording.md` describes it.
"""

from __future__ import annotations

import io
import json
import os
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import h5py

from vbraille import __version__
from vbraille.errors import InputError, VbrailleError
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from _typeshed import ReadableBuffer as Buffer
    from _typeshed import WriteableBuffer
    from numpy.typing import NDArray

    from vbraille.geometry import Geometry
    from vbraille.render.arrays import ActuatorArray
    from vbraille.render.mappings import Mapping
    from vbraille.render.models import Model
    from vbraille.render.tuning import Tuning

CHUNK_FRAMES = 1024
_CHUNK_LINES = 64


class Recorder:
    """Append frames and lines to an open file.

    Parameters
    ----------
    file
        Of `new_file`.
    array
        The actuators.
    width
        Cells a line.
    """

    def __init__(self, file: NewFile, array: ActuatorArray, width: int) -> None:
        self._file = file
        rows, columns = array.shape

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
        self._place = growing("x_mm", "f8")
        self._line = growing("line", "i8")
        self._frames = growing("frames", "f4", rows, columns)
        self._cells = growing("page/cells", "u1", width, chunk=_CHUNK_LINES)
        self._length = growing("page/length", "i8", chunk=_CHUNK_LINES)
        file.attrs["column_offset_mm"] = array.column_offsets_mm()
        file.attrs["row_offset_mm"] = array.row_offsets_mm()
        file.attrs["vbraille_version"] = __version__

    def describe(
        self,
        *,
        model: Model,
        mapping: Mapping,
        geometry: Geometry,
        tuning: Tuning,
        rate_hz: float,
        first_line: int,
        source: str,
        sha256: str,
    ) -> None:
        """Write what was rendered, and how, as attributes."""
        self._file.attrs.update(
            model=model.name,
            mapping=mapping.name,
            geometry=json.dumps(asdict(geometry)),
            tuning=json.dumps(asdict(tuning)),
            rate_hz=rate_hz,
            first_line=first_line,
            source=source,
            source_sha256=sha256,
        )

    @property
    def stored_bytes(self) -> int:
        """What the frames and their places take on the disk so far, compressed."""
        kept = (self._time, self._place, self._line, self._frames)
        return sum(dataset.id.get_storage_size() for dataset in kept)

    def add_line(self, masks: NDArray[np.uint8]) -> int:
        """Append a line of the page; its row in ``page/cells``."""
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
        line: int,
        frames: NDArray[np.float32],
    ) -> None:
        """Append the frames of a stretch of one line.

        Parameters
        ----------
        t_s, x_mm : float64[n]
            When, and where the array's left column was.
        line
            Row of ``page/cells``.
        frames : float32[n, rows, columns]
            Deflections, 0 … 1.
        """
        before = self._time.shape[0]
        after = before + t_s.size
        for dataset, values in (
            (self._time, t_s),
            (self._place, x_mm),
            (self._line, line),
            (self._frames, frames),
        ):
            dataset.resize(after, 0)
            dataset[before:after] = values
        self._file.check()


@contextmanager
def new_file(path: Path | str, *, replace: bool = False) -> Iterator[NewFile]:
    """Write an HDF5 file under another name, which gets its own once it is whole.

    Whatever ends the writing early leaves nothing behind.

    Parameters
    ----------
    path
        The file to make.
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
    partial = path.with_name(f".{path.name}.partial")
    try:
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
            if not replace:  # somebody may have made one meanwhile
                _refuse_existing(path)
            partial.replace(path)
        except _DiskError as error:
            raise VbrailleError(f"{path} could not be written: {error}") from None
    finally:
        with suppress(OSError):
            partial.unlink(missing_ok=True)


def _refuse_existing(path: Path) -> None:
    if os.path.lexists(path):
        raise InputError(
            f"{path} is there already; choose another name, or replace it by {setting('force')}"
        )


class NewFile(h5py.File):
    """A file in the making."""

    def __init__(self, target: _Target) -> None:
        super().__init__(target, "w")
        self.check = target.check


class _DiskError(Exception):
    """The system did not write; says why."""


class _Target(io.FileIO):
    """A file for HDF5, which crashes the process some time after a write has failed.

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
