"""Lines of a Dot Pad: cells to pins, and which line is sent when. No port; time is given.

A Dot Pad takes one line after another, and says of each that it was taken, and when it stands.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from vbraille.conventional.dotpadpackets import DotPadCommand, DotPadPacket, encode_packet
from vbraille.conventional.driver import filled

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vbraille.conventional.dotpadpackets import DotPadArea

PATIENCE_S: Final = 1.0  # more than a line takes to come up
RETRY_S: Final = 0.1
_REFUSALS: Final = 4
_GAP: Final = 1  # pins between cells, and between rows of cells, in the area of pins
# Bits of a byte of pins: the left column from the top, then the right one. Dots 7 and 8 are the
# lowest of theirs.
_BITS: Final = (0, 1, 2, 4, 5, 6, 3, 7)
_PINS: Final = bytes(
    sum(1 << bit for dot, bit in enumerate(_BITS) if mask >> dot & 1) for mask in range(256)
)
_BRAILLE_HEIGHT: Final = 4


def text_lines(cells: bytes, area: DotPadArea) -> dict[int, bytes]:
    """Pins of each line of the text area, by its destination.

    Parameters
    ----------
    cells
        Dot masks, row after row; those for which there is no room are left out.
    area
        The area.
    """
    pins = filled(cells, area.rows * area.columns).translate(_PINS)
    return {
        area.first + row: pins[row * area.columns : (row + 1) * area.columns]
        for row in range(area.rows)
    }


def graphic_size(area: DotPadArea, cell_height: int) -> tuple[int, int]:
    """Rows and columns of braille cells that the area of pins has room for, a pin between them.

    Parameters
    ----------
    area
        The area.
    cell_height
        Rows of pins in a line of the area.
    """
    rows = (area.rows * cell_height + _GAP) // (_BRAILLE_HEIGHT + _GAP)
    return rows, (2 * area.columns + _GAP) // (2 + _GAP)


def graphic_lines(cells: bytes, area: DotPadArea, cell_height: int) -> dict[int, bytes]:
    """Pins of each line of the area of pins, with braille cells a pin apart.

    Parameters
    ----------
    cells
        Dot masks, row after row of `graphic_size`; those for which there is no room are left out.
    area
        The area.
    cell_height
        Rows of pins in a line of the area.
    """
    rows, columns = graphic_size(area, cell_height)
    lines = [bytearray(area.columns) for _ in range(area.rows)]
    for cell, mask in enumerate(filled(cells, rows * columns).translate(_PINS)):
        row, column = divmod(cell, columns)
        for pin in range(8):
            if mask >> pin & 1:
                right, down = divmod(pin, _BRAILLE_HEIGHT)
                x = column * (2 + _GAP) + right
                line, y = divmod(row * (_BRAILLE_HEIGHT + _GAP) + down, cell_height)
                lines[line][x // 2] |= 1 << (y + _BRAILLE_HEIGHT * (x % 2))
    return {area.first + row: bytes(line) for row, line in enumerate(lines)}


@dataclass(slots=True)
class _OnItsWay:
    destination: int
    pins: bytes
    sent_s: float
    taken: bool = False


class DotPadLines:
    """What should stand on each line, what does, and which line is on its way.

    Parameters
    ----------
    refresh_s
        Time in which the Dot Pad brings a line up, in s.
    """

    def __init__(self, refresh_s: float) -> None:
        self._refresh_s = refresh_s
        self._wanted: dict[int, bytes] = {}
        self._standing: dict[int, bytes] = {}
        self._on_its_way: _OnItsWay | None = None
        self._refusals = 0
        self._not_before_s = float("-inf")

    def want(self, lines: Mapping[int, bytes]) -> None:
        """Say what should stand there: pins by destination."""
        self._wanted.update(lines)

    @property
    def settled(self) -> bool:
        """Whether all that is wanted stands there."""
        return self._on_its_way is None and all(
            self._standing.get(destination) == pins for destination, pins in self._wanted.items()
        )

    @property
    def refused(self) -> bool:
        """Whether the Dot Pad has refused lines again and again."""
        return self._refusals >= _REFUSALS

    def silent(self, now_s: float) -> bool:
        """Whether a line was sent, and nothing was heard of it for too long."""
        going = self._on_its_way
        return going is not None and not going.taken and self._late(going, now_s)

    def send(self, now_s: float) -> bytes:
        """Bytes to be sent now; none as long as a line is on its way, or there is nothing."""
        going = self._on_its_way
        if going is not None and going.taken and self._late(going, now_s):
            self._stands(going)  # it has only not been said
        if self._on_its_way is not None or now_s < self._not_before_s:
            return b""
        for destination, pins in self._wanted.items():
            if self._standing.get(destination) != pins:
                self._on_its_way = _OnItsWay(destination, pins, now_s)
                # The byte before the pins is the column at which they begin.
                packet = DotPadPacket(DotPadCommand.SHOW_LINE, b"\0" + pins, destination)
                return encode_packet(packet)
        return b""

    def take(self, packet: DotPadPacket, now_s: float) -> None:
        """Take what the Dot Pad says of the line that is on its way."""
        going = self._on_its_way
        if going is None:
            return
        if packet.command == DotPadCommand.LINE_STANDS:
            self._stands(going)
        elif packet.command == DotPadCommand.LINE_TAKEN and not any(packet.content[:1]):
            going.taken = True
        elif packet.command in (DotPadCommand.LINE_TAKEN, DotPadCommand.REFUSED):
            self._on_its_way = None
            self._refusals += 1
            self._not_before_s = now_s + RETRY_S

    def _stands(self, going: _OnItsWay) -> None:
        self._standing[going.destination] = going.pins
        self._on_its_way = None
        self._refusals = 0

    def _late(self, going: _OnItsWay, now_s: float) -> bool:
        return now_s - going.sent_s > self._refresh_s + PATIENCE_S
