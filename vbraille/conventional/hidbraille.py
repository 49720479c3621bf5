"""Braille displays among human interface devices: rows of cells to reports, reports to keys.

Usage page 0x41 of the HID Usage Tables says what the usages are. No file, no time.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from vbraille.conventional.driver import filled
from vbraille.conventional.hiddescriptor import HidKind, parse_descriptor
from vbraille.conventional.messages import KeyPressed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.conventional.hiddescriptor import HidField, HidReports

_PAGE: Final = 0x41 << 16
_DISPLAY, _ROW, _EIGHT_DOTS, _SIX_DOTS = _PAGE | 1, _PAGE | 2, _PAGE | 3, _PAGE | 4
_ROUTERS, _ROUTER = _PAGE | 0xFA, _PAGE | 0x100
_BUTTONS: Final = 0x09 << 16
# Buttons of these collections are numbered, each for itself.
_SIDES: Final = {
    _PAGE | 0x20C: "FACE",
    _PAGE | 0x20D: "LEFT",
    _PAGE | 0x20E: "RIGHT",
    _PAGE | 0x20F: "TOP",
}
_MOST_CELLS: Final = 1024
_MOST_BITS: Final = 1 << 16
# Names of keys as BRLTTY has them, by usage.
_NAMES: Final = {
    # Joystick: centre, up, down, left, right; the directional pad likewise.
    0x210: "HOME",
    0x211: "LNUP",
    0x212: "LNDN",
    0x213: "FWINLT",
    0x214: "FWINRT",
    0x215: "HOME",
    0x216: "LNUP",
    0x217: "LNDN",
    0x218: "FWINLT",
    0x219: "FWINRT",
    # Panning keys: left, right.
    0x21A: "FWINLT",
    0x21B: "FWINRT",
    # Rocker: up, down, press.
    0x21C: "LNUP",
    0x21D: "LNDN",
    0x21E: "ROCKER",
}


@dataclass(frozen=True, slots=True)
class HidBraille:
    """A braille display, as its descriptor has it.

    Parameters
    ----------
    reports
        What the descriptor says.
    rows
        Fields of cells of each row of the display, from the top.
    columns
        Number of cells in a row; rows of another length are left blank.
    routers
        Cell of the first key of each field of routing keys, from 0, by the place of the field in
        `reports`.
    """

    reports: HidReports
    rows: tuple[tuple[HidField, ...], ...]
    columns: int
    routers: dict[int, int]

    def packed(self, cells: bytes) -> list[bytes]:
        """Reports that have cells stand on the display, as they are written, number first.

        Parameters
        ----------
        cells
            Dot masks, row after row; those for which there is no room are left out.
        """
        shown = filled(cells, len(self.rows) * self.columns)
        reports: dict[int, int] = {}
        for number, row in enumerate(self.rows):
            left = shown[number * self.columns : (number + 1) * self.columns]
            for part in row:
                dots = 0x3F if part.usage(0) == _SIX_DOTS else 0xFF
                mine, left = left[: part.count], left[part.count :]
                bits = sum((mask & dots) << at * part.size for at, mask in enumerate(mine))
                reports[part.report] = reports.get(part.report, 0) | bits << part.bit
        return [
            bytes([report])
            + bits.to_bytes(_bytes(self.reports.bits[HidKind.OUTPUT, report]), "little")
            for report, bits in reports.items()
        ]

    def keys_down(self, told: bytes) -> tuple[int, frozenset[KeyPressed]]:
        """Report of what was read, and the keys that it says are down.

        Parameters
        ----------
        told
            What was read; it begins with the number of its report if reports have one.
        """
        report = told[0] if self.reports.numbered and told else 0
        body = told[1:] if self.reports.numbered else told
        bits = int.from_bytes(body, "little")
        down = {
            key
            for place, part in enumerate(self.reports.fields)
            if part.kind is HidKind.INPUT and part.report == report and not part.constant
            for element in _on(part, bits, 8 * len(body))
            if (key := self._key(place, part, element)) is not None
        }
        return report, frozenset(down)

    def _key(self, place: int, part: HidField, element: int) -> KeyPressed | None:
        usage = part.usage(element)
        if usage == _ROUTER:
            first = self.routers.get(place)
            return None if first is None else KeyPressed("ROUTE", first + element)
        if usage & ~0xFFFF == _BUTTONS:
            sides = [_SIDES[found.usage] for found in part.collections if found.usage in _SIDES]
            return KeyPressed(f"{(sides or ['BUTTON'])[-1]}_{usage & 0xFFFF}")
        name = _NAMES.get(usage & 0xFFFF) if usage & ~0xFFFF == _PAGE else None
        return None if name is None else KeyPressed(name)


def braille_of(descriptor: bytes) -> HidBraille | None:
    """Braille display of a report descriptor; None if it has none with cells."""
    reports = parse_descriptor(descriptor)
    if any(bits > _MOST_BITS for bits in reports.bits.values()):
        return None
    rows: dict[int, list[HidField]] = {}
    for part in reports.fields:
        outermost = part.collections[0].usage if part.collections else 0
        if part.kind is HidKind.OUTPUT and _has_cells(part) and outermost == _DISPLAY:
            rows.setdefault(_row(part), []).append(part)
    if not rows:
        return None
    counts = {row: sum(part.count for part in parts) for row, parts in rows.items()}
    columns = next(iter(counts.values()))
    # What is shorter or longer than the first row is for something else, such as a status.
    alike = [row for row, count in counts.items() if count == columns]
    if not 0 < columns * len(alike) <= _MOST_CELLS:
        return None
    if any(part.size < 6 for row in alike for part in rows[row]):
        return None
    routers = _routers(reports, {row: at * columns for at, row in enumerate(alike)})
    return HidBraille(reports, tuple(tuple(rows[row]) for row in alike), columns, routers)


def _has_cells(part: HidField) -> bool:
    """Whether a field has cells.

    The sample in the standard (HUTRR78) calls the cells of a row a row, and constant, and makers
    have copied it.
    """
    return part.usage(0) in (_EIGHT_DOTS, _SIX_DOTS) or (
        part.usage(0) == _ROW and part.collections[-1:] != () and part.collections[-1].usage == _ROW
    )


def _row(part: HidField) -> int:
    """Number of the innermost row that a field is in; -1 if it is in none."""
    found = (within.number for within in reversed(part.collections) if within.usage == _ROW)
    return next(found, -1)


def _routers(reports: HidReports, first_cells: dict[int, int]) -> dict[int, int]:
    """Cell of the first routing key of each field of the first set, by the field's place."""
    routers: dict[int, int] = {}
    passed: dict[int, int] = {}  # keys of each set, by the number of its collection
    for place, part in enumerate(reports.fields):
        sets = [within.number for within in part.collections if within.usage == _ROUTERS]
        if part.kind is not HidKind.INPUT or part.usage(0) != _ROUTER or not sets:
            continue
        within = sets[-1]
        routers[place] = first_cells.get(_row(part), 0) + passed.get(within, 0)
        keys = part.count if part.variable else part.highest - part.lowest + 1
        passed[within] = passed.get(within, 0) + max(keys, 0)
    return routers


def _on(part: HidField, bits: int, length: int) -> Iterator[int]:
    """Elements of a field that are on, in a report of so many bits."""
    mask = (1 << part.size) - 1
    for element in range(part.count):
        at = part.bit + element * part.size
        if not part.size or at + part.size > length:
            return
        value = bits >> at & mask
        if not part.variable:
            if part.lowest <= value <= part.highest and (value or part.lowest):
                yield value - part.lowest
        elif value:
            yield element


def _bytes(bits: int) -> int:
    return (bits + 7) // 8
