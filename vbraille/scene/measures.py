"""Numbers that a picture may have, the checks of them, and what its parts share."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Annotated, Any, NamedTuple, get_args, get_origin, get_type_hints

import msgspec

from vbraille.errors import check_range
from vbraille.toml import Table, words_of

_Check = Callable[[str, Any], None]


def limits(low: float, high: float, unit: str = "") -> msgspec.Meta:
    """Limits of the numbers of a field, which `Measured` checks and editors are told."""
    return msgspec.Meta(
        extra={"limits": (low, high, unit)},
        extra_json_schema={"minimum": low, "maximum": high},
    )


# No table is larger, and floating point is still good to a nanometre there.
MOST_MM = 10_000.0
# Ridges below this size are finer than any array can show, and would cost as much as coarse ones.
LEAST_MM = 0.05
# Two points of a path that are nearer are one: there is no direction between them.
LEAST_APART_MM = 1e-6
LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ = 0.1, 50.0

Length = Annotated[float, limits(LEAST_MM, MOST_MM, " mm")]
Distance = Annotated[float, limits(0.0, MOST_MM, " mm")]
Size = Annotated[float, limits(0.1, MOST_MM, " mm")]
Coordinate = Annotated[float, limits(-MOST_MM, MOST_MM, " mm")]
# A place on the canvas, x and y in mm: x grows to the right, y down towards the reader.
Point = tuple[Coordinate, Coordinate]
Velocity = Annotated[float, limits(-1000.0, 1000.0, " mm/s")]
Angle = Annotated[float, limits(-360.0, 360.0, "°")]
Share = Annotated[float, limits(0.0, 1.0)]
Frequency = Annotated[float, limits(LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ, " Hz")]


class Measured(Table, frozen=True, kw_only=True):
    """A table whose numbers are within the limits of its fields.

    Raises
    ------
    ValueError
        If a number is out of range, or a signal is given as the speed of what does not move.
    """

    def __post_init__(self) -> None:
        for name, words, check in _checks(type(self)):
            check(words, getattr(self, name))
        by = getattr(self, "velocity_by", "")
        speed = getattr(self, "velocity_mm_s", 0) or getattr(self, "velocity_deg_s", 0)
        if by and speed in (0, (0, 0)):
            raise ValueError(f"velocity_by is {by!r} without a velocity; add one, or leave it out")


@cache
def _checks(kind: type[Measured]) -> list[tuple[str, str, _Check]]:
    """Names, words and checks of the fields of a table that have limits."""
    hints = get_type_hints(kind, include_extras=True)
    found = ((name, words_of(name), _check_of(hint)) for name, hint in hints.items())
    return [(name, words, check) for name, words, check in found if check is not None]


def _check_of(hint: Any) -> _Check | None:
    """Function that checks values of a type, places and lists too; None if it has no limits."""
    inner = get_args(hint)
    if get_origin(hint) is Annotated:
        low, high, unit = inner[1].extra["limits"]
        return lambda what, value: check_range(what, value, low, high, unit)
    check = next(filter(None, map(_check_of, inner)), None)
    if check is None or get_origin(hint) is not tuple:
        return check

    def check_each(what: str, values: Any) -> None:
        is_list = Ellipsis in inner
        if values is not None and not is_list and len(values) != len(inner):
            raise ValueError(f"{what} has {len(values)} numbers; give {len(inner)}")
        for number, value in enumerate(values or ()):
            one = f"number {number + 1}" if is_list else "xy"[number]
            check(f"{what}, {one}", value)

    return check_each


class RidgeWave(NamedTuple):
    """A ridge and a gap that come again and again: their length, and their speed per second.

    Both are in mm along a line, in degrees around a place.
    """

    length: float
    speed: float
    in_mm: bool = True

    @property
    def flow_hz(self) -> float:
        """Number of waves that pass a place in a second."""
        return abs(self.speed) / self.length


def check_file(name: str, what: str = "file") -> None:
    """Check the name of a file that is read with a scene, by a key.

    Raises
    ------
    ValueError
        If it is empty, or a place in the net, since nothing is fetched.
    """
    if not name.strip():
        raise ValueError(f"{what} is empty; give the name of a file")
    if "://" in name:
        raise ValueError(f"{what} is {name!r}; give the name of a file, since nothing is fetched")
