"""What the loop is to do, in memory that another process writes.

One side posts, the other looks each tick; neither waits for the other. Pictures
go into two slots in turn, each with a checksum: a picture that is in the
writing, or seen in the wrong order, is left for the next tick.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from zlib import crc32

import numpy as np

from vbraille.render import work

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.engine.posted import PostedPicture
    from vbraille.render.renderer import Renderer

_PUBLISHED, _PAUSED, _ZEROED, _STOPPED = range(4)
_HEADER_BYTES = 64


class Mailbox:
    """Pictures and orders for a loop.

    Parameters
    ----------
    buffer
        Zeroed memory of `bytes_needed`, shared.
    shape
        Rows and columns of the array.
    cells
        Most cells of a line.
    """

    def __init__(self, buffer: memoryview, shape: tuple[int, int], cells: int) -> None:
        self._words = buffer[:_HEADER_BYTES].cast(
            "q"
        )  # a view of numpy's takes three times as long
        self._slots = np.frombuffer(buffer, slot_dtype(shape, cells), 2, _HEADER_BYTES)

    @staticmethod
    def bytes_needed(shape: tuple[int, int], cells: int) -> int:
        """Size of the buffer, a multiple of 8."""
        return _HEADER_BYTES + 2 * slot_dtype(shape, cells).itemsize

    @property
    def published(self) -> int:
        """Number of the last picture posted; 0 before the first."""
        return self._words[_PUBLISHED]

    def post(self, picture: Renderer, line: int) -> None:
        """Post a picture of a line.

        Raises
        ------
        ValueError
            If it has more cells, or another array, than the mailbox was made for.
        """
        number = self.published + 1
        slot = self._slots[number % 2]
        gains = slot["gains"]
        used = picture.gains.shape[1]
        if picture.gains.shape[0] != gains.shape[0] or used > gains.shape[1]:
            raise ValueError(
                f"a line of {picture.gains.shape} gains does not go into {gains.shape}"
            )
        slot["number"] = number
        slot["line"] = line
        slot["parameters"] = picture.parameters
        gains[:, :used] = picture.gains
        gains[:, used:] = 0.0
        slot["checksum"] = _checksum(self._slots[number % 2 : number % 2 + 1])
        self._words[_PUBLISHED] = number

    def take(self, out: PostedPicture) -> bool:
        """Copy the last picture posted; False if it is not whole, and to be tried again."""
        number = self.published
        np.copyto(out.slot, self._slots[number % 2])
        if out.number != number or out.slot["checksum"] != _checksum(out.slot.reshape(1)):
            return False
        out.update()
        return True

    @property
    def paused(self) -> bool:
        """Whether the array is to rest."""
        return bool(self._words[_PAUSED])

    @paused.setter
    def paused(self, paused: bool) -> None:
        self._words[_PAUSED] = paused

    @property
    def zeroed(self) -> int:
        """How often the reader has said that the carriage is at the left stop."""
        return self._words[_ZEROED]

    def zero(self) -> None:
        """Say so."""
        self._words[_ZEROED] += 1

    @property
    def stopped(self) -> bool:
        """Whether the loop is to end."""
        return bool(self._words[_STOPPED])

    def stop(self) -> None:
        """End the loop."""
        self._words[_STOPPED] = 1


def slot_dtype(shape: tuple[int, int], cells: int) -> np.dtype:
    """One slot: what the kernels know of a line of so many cells at most."""
    rows, _ = shape
    return np.dtype(
        [
            ("checksum", "<i8"),
            ("number", "<i8"),
            ("line", "<i8"),
            ("parameters", "<f8", (work.IDLE + rows,)),
            ("gains", "<f8", (rows, 2 * (cells + 2))),
        ]
    )


def _checksum(slots: NDArray[np.void]) -> int:
    """Of the one slot in an array, but for its own place."""
    return crc32(slots.view(np.uint8)[8:].tobytes())
