"""What the fields of messages may hold, and how they go over the wire.

A message is a frozen dataclass whose annotations are `Annotated[type, field]`. Its checks, its
encoding and its decoding all follow from these fields. The table of messages is
`vbraille.devices.wire.messages`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from struct import Struct
from typing import TYPE_CHECKING, Any, Protocol, get_args, get_type_hints

if TYPE_CHECKING:
    from enum import IntEnum


class WrongLengthError(ValueError):
    """Error of bytes that are fewer than they must be, or more than they may be."""


class Field(Protocol):
    """How one field of a message goes over the wire."""

    def check(self, name: str, value: Any, message: Any) -> None:
        """Raise ValueError if the value is out of range, WrongLengthError if its length is."""
        ...

    def pack(self, value: Any) -> bytes:
        """Give the bytes of a checked value."""
        ...

    def unpack(self, body: bytes, at: int, earlier: dict[str, Any]) -> tuple[Any, int]:
        """Give the value that begins at a place of a body, unchecked, and the place after it.

        WrongLengthError if the body ends within the value. `earlier` are the fields before it.
        """
        ...


class Fixed:
    """A field that is packed by one `struct` code, the least significant byte first.

    Attributes
    ----------
    code
        Code that `struct` has for the field.
    takes_all
        Whether every value that the bytes can hold is in range.
    """

    __slots__ = ()
    code: str
    takes_all = False

    @property
    def meanings(self) -> dict[int, Any]:
        """Meanings of those numbers on the wire that mean something else in the message."""
        return {}

    @property
    def layout(self) -> Struct:
        """Layout of the field by itself."""
        return Struct("<" + self.code)

    def pack(self, value: Any) -> bytes:
        """Give the bytes of a checked value."""
        return self.layout.pack(to_wire(self.meanings).get(value, value))

    def unpack(self, body: bytes, at: int, _earlier: dict[str, Any]) -> tuple[Any, int]:
        """Give the value, and the place after it."""
        end = at + self.layout.size
        if end > len(body):
            raise WrongLengthError
        (raw,) = self.layout.unpack_from(body, at)
        return self.meanings.get(raw, raw), end


def to_wire(meanings: dict[int, Any]) -> dict[Any, int]:
    """Inverse of `Fixed.meanings`: numbers on the wire by what the message has."""
    return {value: raw for raw, value in meanings.items()}


@dataclass(frozen=True, slots=True)
class Number(Fixed):
    """An integer from `low` to `high`; it may be None if `none` stands for that on the wire."""

    code: str
    low: int
    high: int
    unit: str = ""
    none: int | None = None  # a number out of the range

    @property
    def takes_all(self) -> bool:
        """Whether every value that the bytes can hold is in range."""
        return self.high - self.low + 1 + len(self.meanings) == 256**self.layout.size

    @property
    def meanings(self) -> dict[int, Any]:
        """Meaning of the number `none`, which is None."""
        return {} if self.none is None else {self.none: None}

    def check(self, name: str, value: int | None, _message: Any) -> None:
        """Check that the value is from `low` to `high`, or None where that can be told."""
        if value is None and self.none is not None:
            return
        if value is None or not self.low <= value <= self.high:
            unit = f" {self.unit}" if self.unit else ""
            raise ValueError(f"{name} is {value}; it must be {self.low} to {self.high}{unit}")


@dataclass(frozen=True, slots=True)
class OneOf(Fixed):
    """One of the numbers of an enumeration."""

    code: str
    of: type[IntEnum]

    @property
    def meanings(self) -> dict[int, Any]:
        """Each number means its member; an unknown one stays a number, so that `check` names it."""
        return {int(choice): choice for choice in self.of}

    def check(self, name: str, value: int, _message: Any) -> None:
        """Check that the value is one of the numbers."""
        if value not in list(self.of):
            names = ", ".join(f"{choice.value} ({choice.name})" for choice in self.of)
            raise ValueError(f"{name} is {value}; it must be one of {names}")


@dataclass(frozen=True, slots=True)
class ShortText:
    """A byte with a length in bytes, then so many bytes of printable UTF-8.

    Bytes that are no UTF-8 and characters that are not printable are read as U+FFFD, so that
    the rest of what a device says is not lost.
    """

    fewest: int
    most: int = 0xFF

    def check(self, name: str, value: str, _message: Any) -> None:
        """Check that the text is printable, and of a length that is allowed."""
        if not value.isprintable() or (self.fewest and not value.strip()):
            raise ValueError(f"{name} is {value!r}; it must be printable, and not blank")
        if not self.fewest <= len(value.encode()) <= self.most:
            raise ValueError(f"{name} is {value!r}; it must be {self.fewest} to {self.most} bytes")

    def pack(self, value: str) -> bytes:
        """Give the length of the text, then the text."""
        text = value.encode()
        return bytes((len(text),)) + text

    def unpack(self, body: bytes, at: int, _earlier: dict[str, Any]) -> tuple[str, int]:
        """Give the text, and the place after it."""
        if at >= len(body) or len(body) - at - 1 < body[at]:
            raise WrongLengthError
        end = at + 1 + body[at]
        text = body[at + 1 : end].decode(errors="replace")
        return "".join(sign if sign.isprintable() else "\ufffd" for sign in text), end


@dataclass(frozen=True, slots=True)
class PerActuator:
    """A byte from 0 to `high` for each actuator, row by row."""

    high: int
    pack = bytes

    def check(self, name: str, value: bytes, message: Any) -> None:
        """Check that there is a byte for each actuator, from 0 to `high`."""
        actuators = message.rows * message.columns
        if len(value) != actuators:
            raise WrongLengthError(
                f"{name} are {len(value)} bytes; there are {actuators} actuators"
            )
        if max(value) > self.high:
            raise ValueError(f"{name} are up to {max(value)}; they must be 0 to {self.high}")

    def unpack(self, body: bytes, at: int, earlier: dict[str, Any]) -> tuple[bytes, int]:
        """Give as many bytes as the earlier rows and columns tell, or as many as are left."""
        end = at + earlier["rows"] * earlier["columns"]
        return body[at:end], end


@dataclass(frozen=True, slots=True)
class Packed:
    """All bytes up to the message's end, 1 to `most`; no field can come after them."""

    most: int
    pack = bytes

    def check(self, name: str, value: bytes, _message: Any) -> None:
        """Check that there are 1 to `most` bytes."""
        if not 1 <= len(value) <= self.most:
            raise WrongLengthError(f"{name} are {len(value)} bytes; they must be 1 to {self.most}")

    def unpack(self, body: bytes, at: int, _earlier: dict[str, Any]) -> tuple[bytes, int]:
        """Give all bytes that are left."""
        return body[at:], len(body)


class Message:
    """A message, which checks itself: ValueError names the field and its range."""

    __slots__ = ()

    def __post_init__(self) -> None:
        for name, field in fields_of(type(self)):
            field.check(name, getattr(self, name), self)


@cache
def fields_of(message: type[Message]) -> tuple[tuple[str, Field], ...]:
    """Fields of a message in the wire's order, by their names."""
    hints = get_type_hints(message, include_extras=True)
    return tuple((name, get_args(hint)[1]) for name, hint in hints.items())


def head_of(message: type[Message]) -> list[Fixed]:
    """The fixed fields that a message begins with, up to the first of another kind."""
    head: list[Fixed] = []
    for _, field in fields_of(message):
        if not isinstance(field, Fixed):
            break
        head.append(field)
    return head


def places_of(message: type[Message]) -> tuple[tuple[int, int, bool], ...]:
    """Places of the numbers that a message begins with: first byte, width, whether it is signed.

    The list ends at the first field whose width is not fixed, since later places may vary.
    """
    places = []
    at = 1  # the first byte is the type
    for field in head_of(message):
        width = field.layout.size
        places.append((at, width, field.code.islower()))
        at += width
    return tuple(places)
