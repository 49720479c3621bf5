"""Orders to a simulated hand, in memory that the process of its device shares.

Whoever runs a simulated device tells its hand from outside what to do next, and sees when that is
done; the engine between the two knows nothing of it. One side gives orders and the other takes
them; neither waits for the other. A descriptor of the memory goes into the spec of the device
(``sim:?hand=HAND&steering=DESCRIPTOR``), and is inherited where the device is in another process.
"""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass
from typing import Final

from vbraille.simulation.twoslots import TwoSlots

# Words of the memory: number of the last order given, number of the last one done, and when it was.
_GIVEN, _DONE, _DONE_NS = range(3)
_MOST_NUMBERS: Final = 4


@dataclass(frozen=True, slots=True)
class ReadLine:
    """Order to read a line from the left stop to its end and back; a recorded hand goes on.

    Parameters
    ----------
    end_mm
        Place where the last dot of the line ends.
    """

    end_mm: float


@dataclass(frozen=True, slots=True)
class ReadPage:
    """Order to read a page from its first line to its last; a recorded hand goes on.

    Parameters
    ----------
    lines
        Number of lines; line n, from 0, takes y from n to n + 1 line pitches.
    pitch_mm
        Distance from one line to the next.
    end_mm
        Place where the last dot of the longest line ends.
    foot_mm
        How far below the last line the hand then goes and stays, as one does that asks for the
        next page; 0 if it ends on the last line.

    Raises
    ------
    ValueError
        If there is no line, the pitch is not above 0, or the foot is above the last line.
    """

    lines: int
    pitch_mm: float
    end_mm: float
    foot_mm: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "lines", int(self.lines))  # numbers in memory are all doubles
        if self.lines < 1 or not 0 < self.pitch_mm < math.inf:
            raise ValueError(
                f"a page of {self.lines} lines {self.pitch_mm:g} mm apart is not possible; "
                f"it must have 1 or more, and a pitch above 0"
            )
        if not 0 <= self.foot_mm < math.inf:
            raise ValueError(f"foot is {self.foot_mm:g} mm; it must be 0 or more")


@dataclass(frozen=True, slots=True)
class BeAt:
    """Order to go straight to a pose and stay there, as if somebody held the hand.

    Parameters
    ----------
    x_mm, y_mm, theta_rad
        Pose as in `vbraille.pose`: place of the array's centre, and angle by which it is turned.

    Raises
    ------
    ValueError
        If a value is not finite.
    """

    x_mm: float
    y_mm: float = 0.0
    theta_rad: float = 0.0

    def __post_init__(self) -> None:
        if not all(map(math.isfinite, astuple(self))):
            raise ValueError(f"a hand cannot be at {astuple(self)}; it must be numbers")


@dataclass(frozen=True, slots=True)
class GlideTo:
    """Order to glide straight to a place and stay there, as a hand does that keys steer.

    Parameters
    ----------
    x_mm, y_mm
        Place of the array's centre; the array stays turned as it is.
    speed_mm_s
        Speed of the way.

    Raises
    ------
    ValueError
        If a value is not finite, or the speed is not above 0.
    """

    x_mm: float
    y_mm: float
    speed_mm_s: float

    def __post_init__(self) -> None:
        if not all(map(math.isfinite, astuple(self))) or not self.speed_mm_s > 0:
            raise ValueError(f"a hand cannot glide as {astuple(self)} says; it must be numbers")


HandOrder = ReadLine | ReadPage | BeAt | GlideTo
_KINDS: Final[tuple[type[HandOrder], ...]] = (ReadLine, ReadPage, BeAt, GlideTo)


class Steering:
    """Both ends of the channel that steers a simulated hand.

    Parameters
    ----------
    descriptor
        Descriptor of memory that another `Steering` has made; None makes new memory.

    Attributes
    ----------
    descriptor : int
        Descriptor of the memory; the `Steering` that made it closes it.

    Raises
    ------
    ValueError
        If the descriptor is that of something else.
    """

    def __init__(self, descriptor: int | None = None) -> None:
        # An order is its kind and its numbers.
        self._slots = TwoSlots("steers a hand", f"q{_MOST_NUMBERS}d", descriptor)
        self.descriptor = self._slots.descriptor
        self._words = self._slots.words
        # Orders that were given before this is opened are not for whoever takes orders from now on.
        self._taken = self._words[_GIVEN]

    def give(self, order: HandOrder) -> None:
        """Give the hand another order from now on.

        The hand sets out at once: show what it is to read first.
        """
        numbers = (*astuple(order), *[0.0] * _MOST_NUMBERS)[:_MOST_NUMBERS]
        self._slots.tell(_KINDS.index(type(order)), *numbers)

    def done_at(self, time_ns: int) -> bool:
        """Whether the hand had followed all orders by a time of the device's clock."""
        given = self._words[_GIVEN]
        return given > 0 and self._words[_DONE] == given and self._words[_DONE_NS] <= time_ns

    def take(self) -> HandOrder | None:
        """Last order given, for the device; None if it was taken before, or is being written."""
        number = self._words[_GIVEN]
        if number == self._taken:
            return None
        told = self._slots.take(number)
        if told is None:
            return None
        kind, *numbers = told
        self._taken = number
        order = _KINDS[kind]
        return order(*numbers[: len(order.__slots__)])

    def answer(self, time_ns: int) -> None:
        """Tell, for the device, when the order taken last was done, by its clock."""
        self._words[_DONE_NS] = time_ns
        self._words[_DONE] = self._taken
