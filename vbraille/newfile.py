"""HDF5 files that get their names only once they are whole.

HDF5 would crash the process some time after a failed write; what is written goes through a file of
our own, which keeps the failure until a caller asks.
"""

from __future__ import annotations

import io
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import h5py

from vbraille.errors import InputError, VbrailleError
from vbraille.files import check_unused, whole_file

if TYPE_CHECKING:
    from collections.abc import Iterator

    from _typeshed import ReadableBuffer as Buffer
    from _typeshed import WriteableBuffer


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
            check_unused(path, replace=replace)
            target = _Target(partial)
        except OSError as error:
            raise InputError(f"{path} cannot be written: {error.strerror}") from None
        try:
            with target, NewFile(target) as file:
                yield file
            target.check()
        except _DiskError as error:
            raise VbrailleError(f"{path} could not be written: {error}") from None
        check_unused(path, replace=replace)  # another process may have made one meanwhile


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
