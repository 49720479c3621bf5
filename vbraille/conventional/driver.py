"""What every driver of a conventional display can do, whatever it speaks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from vbraille.errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.conventional.messages import DisplayStands, KeyPressed, KeyTyped


class DisplayGoneError(DeviceError):
    """The display is not there, or no longer; it may come back. The message says what helps."""


class CellDriver(Protocol):
    """A display that is open. Every method raises `DisplayGoneError` if it is there no more."""

    @property
    def descriptor(self) -> int:
        """Number of an open file that can be read when there may be keys."""
        ...

    def check(self) -> DisplayStands:
        """Say what display it is now, which may be another than before."""
        ...

    def write(self, cells: bytes) -> None:
        """Show cells from the left of the first row, and nothing on the others.

        Parameters
        ----------
        cells
            Dot masks; those for which there is no room are left out.
        """
        ...

    def pressed(self) -> Sequence[KeyPressed | KeyTyped]:
        """Give the keys that were pressed since the last call, without waiting."""
        ...

    def close(self) -> None:
        """Give the display back to whoever else shows something; further calls do nothing."""
        ...


def filled(cells: bytes, count: int) -> bytes:
    r"""Cells of a whole display: those given, cut or followed by blank ones.

    >>> filled(bytes([1, 2]), 3)
    b'\x01\x02\x00'
    """
    return cells[:count].ljust(count, b"\0")
