"""How the fields of messages go over the wire, and what values they may have.

A message is a frozen dataclass whose annotations are `Annotated[type, field]`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from struct import Struct
from typing import TYPE_CHECKING, Any, Protocol, get_args, get_type_hints

if TYPE_CHECKING:
    from enum import IntEnum


class WrongLengthError(ValueError):
    """A message that ends before its last field, or goes on where nothing may be appended."""


class Field(Protocol):
    """How one field of a message goes over the wire."""

    def check(self, name: str, value: Any, message: Any) -> None:
        """Raise ValueError if the value is out of range; a fixed field asks no message for it."""
        ...

    def pack(self, value: Any) -> bytes:
        """Bytes of a checked value."""
        ...

    def unpack(self, body: bytes, at: int, earlier: dict[str, Any]) -> tuple[Any, int]:
        """Value at a place of a message, and the place after it; WrongLengthError past the end."""
        ...


class Fixed:
    """A field that a letter of `struct` describes, least significant byte first."""

    __slots__ = ()
    code: str
    # Whether a value is something else in the message than on the wire.
    converts = True

    @property
    def any(self) -> bool:
        """Whether all that its bytes can say is in range."""
        return False

    def raw(self, value: Any) -> int:
        """Value as it is on the wire."""
        return value

    def value(self, raw: int) -> Any:
        """Value as it is in the message."""
        return raw

    def pack(self, value: Any) -> bytes:
        """Bytes of a checked value."""
        return Struct("<" + self.code).pack(self.raw(value))

    def unpack(self, body: bytes, at: int, _earlier: dict[str, Any]) -> tuple[Any, int]:
        """Value, and the place after it."""
        layout = Struct("<" + self.code)
        if len(body) - at < layout.size:
            raise WrongLengthError
        return self.value(layout.unpack_from(body, at)[0]), at + layout.size


@dataclass(frozen=True, slots=True)
class Number(Fixed):
    """An integer from `low` to `high`."""

    code: str
    low: int
    high: int
    unit: str = ""
    converts = False

    @property
    def any(self) -> bool:
        """Whether all that its bytes can say is in range; of a signed number never said."""
        return self.low == 0 and self.high == 256 ** Struct(self.code).size - 1

    def check(self, name: str, value: int, _message: Any) -> None:
        """From `low` to `high`."""
        if not self.low <= value <= self.high:
            unit = f" {self.unit}" if self.unit else ""
            raise ValueError(f"{name} is {value}; it must be {self.low} to {self.high}{unit}")


@dataclass(frozen=True, slots=True)
class OptionalNumber(Number):
    """A number or None, for which `none`, out of the number's range, stands on the wire."""

    none: int = 0
    converts = True

    @property
    def any(self) -> bool:
        """Whether all that its bytes can say is in range, or none."""
        half = 128 * 256 ** (Struct(self.code).size - 1)
        return self.code.islower() and (self.none, self.low, self.high) == (
            -half,
            1 - half,
            half - 1,
        )

    def raw(self, value: int | None) -> int:
        """`none` for None."""
        return self.none if value is None else value

    def value(self, raw: int) -> int | None:
        """None for `none`."""
        return None if raw == self.none else raw

    def check(self, name: str, value: int | None, message: Any) -> None:
        """None, or a number from `low` to `high`."""
        if value is not None:
            Number.check(self, name, value, message)


@dataclass(frozen=True, slots=True)
class OneOf(Fixed):
    """One of the numbers of an enumeration."""

    code: str
    of: type[IntEnum]

    def value(self, raw: int) -> IntEnum | int:
        """Member of the enumeration; the number itself if it has none such, for `check` to name."""
        return self.of(raw) if raw in list(self.of) else raw

    def check(self, name: str, value: int, _message: Any) -> None:
        """One of the numbers."""
        if value not in list(self.of):
            names = ", ".join(f"{choice.value} ({choice.name})" for choice in self.of)
            raise ValueError(f"{name} is {value}; it must be one of {names}")


@dataclass(frozen=True, slots=True)
class Text:
    """A byte with a length in bytes, then so many bytes of printable UTF-8.

    Bytes that are no UTF-8 and characters that are not printable are read as U+FFFD:
    what a device has to say must not be lost for them.
    """

    fewest: int
    most: int = 0xFF

    def check(self, name: str, value: str, _message: Any) -> None:
        """Printable, and of the length allowed."""
        if not value.isprintable() or (self.fewest and not value.strip()):
            raise ValueError(f"{name} is {value!r}; it must be printable, and not blank")
        if not self.fewest <= len(value.encode()) <= self.most:
            raise ValueError(f"{name} is {value!r}; it must be {self.fewest} to {self.most} bytes")

    def pack(self, value: str) -> bytes:
        """Length and text."""
        text = value.encode()
        return bytes((len(text),)) + text

    def unpack(self, body: bytes, at: int, _earlier: dict[str, Any]) -> tuple[str, int]:
        """Text, and the place after it."""
        if at >= len(body) or len(body) - at - 1 < body[at]:
            raise WrongLengthError
        end = at + 1 + body[at]
        text = body[at + 1 : end].decode(errors="replace")
        return "".join(sign if sign.isprintable() else "\ufffd" for sign in text), end


@dataclass(frozen=True, slots=True)
class PerActuator:
    """A byte from 0 to `high` for each actuator, row by row."""

    high: int

    def check(self, name: str, value: bytes, message: Any) -> None:
        """As many as there are actuators, up to `high`."""
        actuators = message.rows * message.columns
        if len(value) != actuators:
            raise ValueError(f"{name} are {len(value)} bytes; there are {actuators} actuators")
        if max(value) > self.high:
            raise ValueError(f"{name} are up to {max(value)}; they must be 0 to {self.high}")

    def pack(self, value: bytes) -> bytes:
        """The bytes as they are."""
        return bytes(value)

    def unpack(self, body: bytes, at: int, earlier: dict[str, Any]) -> tuple[bytes, int]:
        """As many bytes as rows and columns, before it in the message, say."""
        end = at + earlier["rows"] * earlier["columns"]
        if end > len(body):
            raise WrongLengthError
        return body[at:end], end


@dataclass(frozen=True, slots=True)
class Packed:
    """All the bytes to the message's end: nothing can be appended after them."""

    most: int

    def check(self, name: str, value: bytes, _message: Any) -> None:
        """From one byte to `most`."""
        if not 1 <= len(value) <= self.most:
            raise ValueError(f"{name} are {len(value)} bytes; they must be 1 to {self.most}")

    def pack(self, value: bytes) -> bytes:
        """The bytes as they are."""
        return bytes(value)

    def unpack(self, body: bytes, at: int, _earlier: dict[str, Any]) -> tuple[bytes, int]:
        """All that is left."""
        if not 1 <= len(body) - at <= self.most:
            raise WrongLengthError
        return body[at:], len(body)


class Message:
    """A message that has checked itself: ValueError naming the field and its range."""

    __slots__ = ()

    def __post_init__(self) -> None:
        bounds, others = _checks(type(self))
        # Numbers are checked here without a call each: STATE has six, 1000 times a second.
        for name, low, high, field in bounds:
            if not low <= getattr(self, name) <= high:
                field.check(name, getattr(self, name), self)
        for name, field in others:
            field.check(name, getattr(self, name), self)


@cache
def fields_of(message: type[Message]) -> tuple[tuple[str, Field], ...]:
    """Fields of a message in the wire's order, by their names."""
    hints = get_type_hints(message, include_extras=True)
    return tuple((name, get_args(hint)[1]) for name, hint in hints.items())


def places_of(message: type[Message]) -> tuple[tuple[int, int, bool], ...]:
    """Where the numbers are that a message begins with: first byte, bytes, whether it is signed.

    From the first field on whose width is not fixed, nobody can say.
    """
    places = []
    at = 1  # after the type
    for _, field in fields_of(message):
        if not isinstance(field, Fixed):
            break
        width = Struct("<" + field.code).size
        places.append((at, width, field.code.islower()))
        at += width
    return tuple(places)


@cache
def _checks(
    message: type[Message],
) -> tuple[list[tuple[str, int, int, Field]], list[tuple[str, Field]]]:
    bounds: list[tuple[str, int, int, Field]] = []
    others: list[tuple[str, Field]] = []
    for name, field in fields_of(message):
        if isinstance(field, Number) and not field.converts:
            bounds.append((name, field.low, field.high, field))
        else:
            others.append((name, field))
    return bounds, others
