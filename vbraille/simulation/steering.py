"""Channels of shared memory that move a simulated hand past the engine: orders, and a pose.

What is told goes into two slots in turn, each with its number and a checksum, and then the number
of the last one is published. Neither side waits for the other: a slot that is in the writing, or
seen in the wrong order, is taken later. `Steering` has orders, one after the other, and `Pointer` a
pose at which a hand is held, ahead of them.
"""

from __future__ import annotations

import math
import mmap
import os
import select
import struct
import weakref
from dataclasses import astuple, dataclass
from typing import Any, Final
from zlib import crc32

from vbraille.files import open_memory

_HEADER_BYTES: Final = 64
_NUMBERS: Final = struct.Struct("<2q")  # checksum, and the number of what is told


class TwoSlots:
    """Both ends of the memory.

    Parameters
    ----------
    purpose
        What the memory does, such as "steers a hand".
    form
        Form of what is told, as `struct.Struct` takes it, without the order of its bytes.
    spare_bytes
        Unused bytes, by which the memory differs in size from that of another purpose.
    descriptor
        Descriptor of memory that another `TwoSlots` has made; None makes new memory.

    Attributes
    ----------
    descriptor : int
        Descriptor of the memory; the `TwoSlots` that made it closes it.
    memory : memoryview
        The memory.
    words : memoryview of int64[8]
        Words at its start: the first is the number of what was told last, 0 before anything was,
        and the others are free.

    Raises
    ------
    ValueError
        If the descriptor is that of something else.
    """

    def __init__(
        self, purpose: str, form: str, descriptor: int | None, *, spare_bytes: int = 0
    ) -> None:
        self._slot = struct.Struct(f"{_NUMBERS.format}{form}")
        size = _HEADER_BYTES + 2 * self._slot.size + spare_bytes
        if descriptor is None:
            descriptor = open_memory(f"vbraille {purpose}", size)
            weakref.finalize(self, os.close, descriptor)
        self.descriptor = descriptor
        try:
            if os.fstat(descriptor).st_size != size:
                raise ValueError(f"descriptor {descriptor} is not of memory that {purpose}")
            self.memory = memoryview(mmap.mmap(descriptor, size))
        except OSError as error:
            raise ValueError(
                f"descriptor {descriptor} is not of memory that {purpose}: {error.strerror}"
            ) from None
        self.words = self.memory[:_HEADER_BYTES].cast("q")

    def tell(self, *values: float) -> None:
        """Tell the other end something new."""
        number = self.words[0] + 1
        slot = self._slot.pack(0, number, *values)
        at = self._place(number)
        self.memory[at : at + self._slot.size] = crc32(slot).to_bytes(8, "little") + slot[8:]
        self.words[0] = number

    def take(self, number: int) -> tuple[Any, ...] | None:
        """Take what was told under a number; None if that is being written."""
        at = self._place(number)
        slot = bytes(self.memory[at : at + self._slot.size])
        checksum, there, *values = self._slot.unpack(slot)
        if there != number or checksum != crc32(bytes(8) + slot[8:]):
            return None
        return tuple(values)

    def _place(self, number: int) -> int:
        return _HEADER_BYTES + number % 2 * self._slot.size


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
    """Order to go straight to a pose and stay there, as if a person held the hand.

    Parameters
    ----------
    x_mm, y_mm, theta_rad
        Pose as in `vbraille.display`: place of the array's centre, and angle by which it is turned.

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
        # Orders that were given before this is opened are not for the hand that obeys from now on.
        self._taken = self._words[_GIVEN]

    def give(self, order: HandOrder) -> None:
        """Give the hand another order from now on.

        The hand sets out at once: show what it is to read first.
        """
        numbers = (*astuple(order), *[0.0] * _MOST_NUMBERS)[:_MOST_NUMBERS]
        self._slots.tell(_KINDS.index(type(order)), *numbers)

    def done_at(self, time_ns: int) -> bool:
        """Tell whether the hand had followed all orders by a time of the device's clock."""
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


_COUNT: Final = 0  # word of the memory: how often the hand was moved or let go
# Not as large as the memory of a `Steering`, for which it cannot be taken by mistake.
_SPARE_BYTES: Final = 8
# So many times the holder is taken to be alive before it is looked at again: a look takes longer.
_LOOKS: Final = 64


class Pointer:
    """Both ends of the channel by which a person holds a simulated hand.

    Parameters
    ----------
    descriptor
        Descriptor of memory that another `Pointer` has made; None makes new memory.

    Attributes
    ----------
    descriptor : int
        Descriptor of the memory; the `Pointer` that made it closes it.

    Raises
    ------
    ValueError
        If the descriptor is that of something else.
    """

    def __init__(self, descriptor: int | None = None) -> None:
        # What is told is whether the hand is held, by which process, and where: x, y and θ.
        self._slots = TwoSlots("holds a hand", "2q3d", descriptor, spare_bytes=_SPARE_BYTES)
        self.descriptor = self._slots.descriptor
        self._words = self._slots.words
        self._seen = 0
        self._at: BeAt | None = None
        self._holder = 0
        self._looks = 0

    def hold(self, at: BeAt) -> None:
        """Hold the hand at a pose from now on; the hand goes there as fast as a hand is led."""
        self._write(at)

    def let_go(self) -> None:
        """Let the hand go, so that it does what it was told to."""
        self._write(None)

    def at(self) -> BeAt | None:
        """Pose at which the hand is held, the same object until it changes; None if it is not."""
        number = self._words[_COUNT]
        if number != self._seen:
            self._read(number)
        elif self._at is not None:
            self._looks += 1
            if self._looks >= _LOOKS:
                self._looks = 0
                self._at = self._at if _lives(self._holder) else None
        return self._at

    @property
    def held(self) -> bool:
        """Tell whether a person holds the hand."""
        return self.at() is not None

    def _write(self, at: BeAt | None) -> None:
        place = (0.0, 0.0, 0.0) if at is None else (at.x_mm, at.y_mm, at.theta_rad)
        self._slots.tell(at is not None, os.getpid(), *place)

    def _read(self, number: int) -> None:
        """Take what was written last; nothing, if that is being written."""
        told = self._slots.take(number)
        if told is None:
            return
        held, holder, *place = told
        self._seen, self._holder, self._looks = number, holder, 0
        self._at = BeAt(*place) if held else None


def _lives(process: int) -> bool:
    """Tell whether a process has not ended; one that its parent has not waited for yet has."""
    try:
        descriptor = os.pidfd_open(process)
    except OSError:
        return False
    try:
        ending = select.poll()
        ending.register(descriptor, select.POLLIN)
        return not ending.poll(0)
    finally:
        os.close(descriptor)
