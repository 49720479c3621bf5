"""Report descriptors of USB's class for human interface devices: bytes to fields of reports.

The Device Class Definition for HID 1.11, 6.2.2, says what the bytes mean. Nothing here is about
braille.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

_LONG: Final = 0xFE
_SIZES: Final = (0, 1, 2, 4)
_MAIN, _GLOBAL, _LOCAL = 0, 1, 2
_COLLECTION, _END_COLLECTION = 0xA, 0xC
_PAGE, _LOWEST, _HIGHEST, _SIZE, _REPORT, _COUNT, _PUSH, _POP = 0, 1, 2, 7, 8, 9, 0xA, 0xB
_USAGE, _USAGE_FROM, _USAGE_TO = 0, 1, 2
_CONSTANT, _VARIABLE = 1, 2
_MOST_USAGES: Final = 4096  # no device has more, and a broken descriptor may say so


class HidKind(Enum):
    """Direction of a field, by the tag of its item."""

    INPUT = 8
    OUTPUT = 9
    FEATURE = 0xB


@dataclass(frozen=True, slots=True)
class HidCollection:
    """A collection.

    Parameters
    ----------
    usage
        What it is: the usage page in the upper 16 bits, the usage in the lower ones.
    number
        Number of the collection in the descriptor, from 0.
    """

    usage: int
    number: int


@dataclass(frozen=True, slots=True)
class HidField:
    """A field of a report: elements of one size, side by side.

    Parameters
    ----------
    kind
        Whether it comes from the device or goes to it.
    report
        Number of its report; 0 if reports have none.
    bit
        Place of its first bit in the report, after the report's number.
    size
        Bits of an element.
    count
        Number of its elements.
    constant
        Whether it is said to hold nothing that changes.
    variable
        Whether each element is one control; otherwise each says which control is on.
    lowest, highest
        Smallest and largest value of an element.
    usages
        What the elements are, in order, at least one; the last is that of all that follow.
    collections
        Collections that it is in, the outermost first.
    """

    kind: HidKind
    report: int
    bit: int
    size: int
    count: int
    constant: bool
    variable: bool
    lowest: int
    highest: int
    usages: tuple[int, ...]
    collections: tuple[HidCollection, ...]

    def usage(self, element: int) -> int:
        """What an element is."""
        return self.usages[min(element, len(self.usages) - 1)]


@dataclass(frozen=True, slots=True)
class HidReports:
    """What a descriptor says.

    Parameters
    ----------
    fields
        Fields that have a usage, in the order of the descriptor.
    bits
        Number of bits of each report, without its number, by its direction and number.
    numbered
        Whether reports begin with their number.
    """

    fields: tuple[HidField, ...]
    bits: dict[tuple[HidKind, int], int]
    numbered: bool


@dataclass(frozen=True, slots=True)
class _Globals:
    page: int = 0
    lowest: int = 0
    highest: int = 0
    size: int = 0
    report: int = 0
    count: int = 0


_GLOBAL_NAMES: Final = {
    _PAGE: "page",
    _LOWEST: "lowest",
    _HIGHEST: "highest",
    _SIZE: "size",
    _REPORT: "report",
    _COUNT: "count",
}


@dataclass(slots=True)
class _Locals:
    """What holds for the next main item only: usages, and whether each has its own page."""

    usages: list[tuple[int, bool]] = field(default_factory=list)
    first: tuple[int, bool] | None = None

    def take(self, tag: int, value: int, whole: bool) -> None:
        if tag == _USAGE:
            self.usages.append((value, whole))
        elif tag == _USAGE_FROM:
            self.first = (value, whole)
        elif tag == _USAGE_TO and self.first is not None:
            first = self.first[0]
            last = min(value, first + _MOST_USAGES)
            self.usages += [(usage, self.first[1]) for usage in range(first, last + 1)]
            self.first = None

    def named(self, page: int) -> tuple[int, ...]:
        return tuple(usage if whole else page << 16 | usage for usage, whole in self.usages)


def parse_descriptor(descriptor: bytes) -> HidReports:
    """Reports of a descriptor; one that breaks off says what it says until there."""
    fields: list[HidField] = []
    bits: dict[tuple[HidKind, int], int] = {}
    now, kept, here = _Globals(), list[_Globals](), _Locals()
    inside: tuple[HidCollection, ...] = ()
    collections, numbered = 0, False
    for kind, tag, raw in _items(descriptor):
        value = int.from_bytes(raw, "little")
        if kind == _GLOBAL:
            if tag == _PUSH:
                kept.append(now)
            elif tag == _POP:
                now = kept.pop() if kept else now
            elif tag in _GLOBAL_NAMES:
                if tag == _LOWEST or (tag == _HIGHEST and now.lowest < 0):
                    value = int.from_bytes(raw, "little", signed=True)
                now = replace(now, **{_GLOBAL_NAMES[tag]: value})
                numbered |= tag == _REPORT
        elif kind == _LOCAL:
            here.take(tag, value, len(raw) == 4)
        elif kind == _MAIN:
            usages, here = here.named(now.page), _Locals()
            if tag == _COLLECTION:
                inside = (*inside, HidCollection(usages[0] if usages else 0, collections))
                collections += 1
            elif tag == _END_COLLECTION:
                inside = inside[:-1]
            elif tag in (known.value for known in HidKind):
                where = (HidKind(tag), now.report)
                bit = bits.get(where, 0)
                bits[where] = bit + now.size * now.count
                if usages:
                    flags = (bool(value & _CONSTANT), bool(value & _VARIABLE))
                    size = (now.size, now.count, *flags, now.lowest, now.highest)
                    fields.append(HidField(*where, bit, *size, usages, inside))
    return HidReports(tuple(fields), bits, numbered)


def _items(descriptor: bytes) -> Iterator[tuple[int, int, bytes]]:
    """Type, tag and content of each item."""
    place = 0
    while place < len(descriptor):
        prefix = descriptor[place]
        if prefix == _LONG:  # nobody has defined any
            place += 3 + (descriptor[place + 1] if place + 1 < len(descriptor) else 0)
            continue
        end = place + 1 + _SIZES[prefix & 3]
        if end > len(descriptor):
            return
        yield prefix >> 2 & 3, prefix >> 4, descriptor[place + 1 : end]
        place = end
