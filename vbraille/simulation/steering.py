"""Orders to a simulated hand, which an engine's `give` takes to it."""

from __future__ import annotations

from typing import Annotated, Final

import msgspec

_Finite = Annotated[float, msgspec.Meta(ge=-1e9, le=1e9)]


class ReadLine(msgspec.Struct, frozen=True, tag=True):
    """Order to read the line that is shown, once: to its end, and back to the start.

    Parameters
    ----------
    end_mm
        Place of the array's left column at the end of the line.
    """

    end_mm: _Finite


class Area(msgspec.Struct, frozen=True):
    """Area of a page that its lines take.

    Parameters
    ----------
    lines, pitch_mm
        Number of lines, and distance from one to the next; line n, from 0, takes y from n to n + 1
        pitches.
    end_mm
        Place of the array's left column at the end of each line.
    foot_mm
        How far below the last line a hand goes at the end, and stays there; 0 if it does not.
    start_mm
        Place of the array's left column at the start of each line; a device knows its own.
    """

    lines: Annotated[int, msgspec.Meta(ge=1)]
    pitch_mm: Annotated[float, msgspec.Meta(gt=0, le=1e9)]
    end_mm: _Finite
    foot_mm: _Finite = 0.0
    start_mm: _Finite = 0.0

    @property
    def height_mm(self) -> float:
        """Height of all lines together."""
        return self.lines * self.pitch_mm

    def middle_mm(self, line: int) -> float:
        """Place of the middle of a line along y."""
        return (line + 0.5) * self.pitch_mm


class ReadPage(Area, frozen=True, tag=True):
    """Order to read the lines of a page from its top, once."""


class GlideTo(msgspec.Struct, frozen=True, tag=True):
    """Order to glide straight to a place and stay there, as a hand does that keys steer.

    Parameters
    ----------
    x_mm, y_mm
        Place of the array's centre; the array stays turned as it is.
    speed_mm_s
        Speed of the way.
    """

    x_mm: _Finite
    y_mm: _Finite
    speed_mm_s: Annotated[float, msgspec.Meta(gt=0, le=1e9)]


class Hold(msgspec.Struct, frozen=True, tag=True):
    """Be held by a person at a pose of the array's centre, ahead of all orders, until `LetGo`."""

    x_mm: _Finite
    y_mm: _Finite = 0.0
    theta_rad: _Finite = 0.0


class LetGo(msgspec.Struct, frozen=True, tag=True):
    """Be held no more, and go on with what was not done yet."""


HandOrder = ReadLine | ReadPage | GlideTo | Hold | LetGo
_decoder: Final = msgspec.json.Decoder(HandOrder)


def to_json(order: HandOrder) -> bytes:
    """JSON of an order.

    Raises
    ------
    ValueError
        If a number of it is not possible.
    """
    encoded = msgspec.json.encode(order)
    from_json(encoded)
    return encoded


def from_json(told: bytes) -> HandOrder:
    """Order of which `to_json` made this."""
    return _decoder.decode(told)
