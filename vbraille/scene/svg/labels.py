"""Texts of a drawing as labels of braille."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.scene.measures import MOST_MM
from vbraille.scene.patterns import Label
from vbraille.scene.svg.document import link_of, name_of, plain
from vbraille.scene.svg.outlines import TOO_FAR, segments_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from vbraille.scene.svg.document import Element
    from vbraille.scene.svg.styles import Style, StyleSheets
    from vbraille.scene.svg.values import AffineMap, Units

    Ids = Mapping[str, Element]

# The size of braille is the device's, not the drawing's, and is not known here. These are a
# Latero's, which are among the largest: labels placed by them meet nothing on other devices.
CELL_MM, HEIGHT_MM, LINE_MM = 11.1, 9.0, 12.5
_LONGEST_TEXT = 2000
_ANCHORS = {"start": 0.0, "middle": 0.5, "end": 1.0}
# How far the foot of letters is above the place of a text, as a share of the height of a cell.
_BASELINES = {"middle": 0.5, "central": 0.5, "hanging": 1.0, "text-before-edge": 1.0,
              "text-top": 1.0}  # fmt: skip
_PARTS = ("tspan", "a", "textPath", "tref")


@dataclass(slots=True)
class _Line:
    """A line of a text: the place of its start, middle or end, its style and its characters."""

    element: Element
    style: Style
    place: complex
    text: str = ""


def labels_of(
    sheets: StyleSheets, ids: Ids, element: Element, matrix: AffineMap, style: Style, units: Units
) -> Iterator[tuple[Element, Label]]:
    """Labels of an element ``text``, one for each of its lines.

    A label stands so that its cells end at the line's foot. Its length is not known before it
    is translated; where the anchor is its middle or end, a cell for each character is taken.
    Lines of a text stand at least as far apart as lines of braille.

    Raises
    ------
    ValueError
        If it stands farther than 10 m from the drawing's corner.
    """
    lines: list[_Line] = []
    _gather(sheets, ids, element, style, units, lines)
    angle = cmath.phase(matrix.p + matrix.q)
    along = cmath.rect(1.0, angle)
    down = along * 1j
    before: complex | None = None
    for line in lines:
        text = plain(line.text, _LONGEST_TEXT)
        if not text:
            continue
        share = _ANCHORS[line.style["text-anchor"]]
        base = _BASELINES.get(line.style["dominant-baseline"], 0.0)
        corner = matrix(line.place)
        corner -= down * HEIGHT_MM * (1 - base) + along * share * len(text) * CELL_MM
        if before is not None:
            below = ((corner - before) / down).real
            corner += down * (LINE_MM - below if 0 < below < LINE_MM else 0.0)
        before = corner
        place = round(corner.real, 4) + 0.0, round(corner.imag, 4) + 0.0
        if not max(map(abs, place)) <= MOST_MM:
            raise ValueError(TOO_FAR)
        degrees = round(math.degrees(angle), 4) + 0.0
        yield line.element, Label(text=text, place_mm=place, angle_deg=degrees)


def _gather(
    sheets: StyleSheets, ids: Ids, element: Element, style: Style, units: Units, lines: list[_Line]
) -> None:
    """Add the lines of a text or a part of it, which begins one where it has a place."""
    before = lines[-1].place if lines else 0j
    place = _place(sheets, ids, element, units, before)
    if place is not None or not lines:
        lines.append(_Line(element, style, place or 0j))
    lines[-1].text += element.text or ""
    for child in element:
        if name_of(child) in _PARTS:
            inner = sheets.of(child, style, units)
            if inner["display"] != "none" and inner["visibility"] != "hidden":
                _gather(sheets, ids, child, inner, units.sized(inner), lines)
        lines[-1].text += child.tail or ""


def _place(
    sheets: StyleSheets, ids: Ids, element: Element, units: Units, before: complex
) -> complex | None:
    """Place of a part of a text; None if it goes on where the part before ends."""
    if name_of(element) == "textPath":
        sheets.note(element, "its path is not followed: the text is straight from where it begins")
        path = ids.get(link_of(element)[1:])
        segments, _ = segments_of("" if path is None else path.get("d") or "")
        return segments[0].end if len(segments) else None
    if element.get("rotate"):
        sheets.note(element, "its letters are turned, which is not felt")
    found: dict[str, str] = {}
    for name in ("x", "y", "dx", "dy"):
        words = (element.get(name) or "").replace(",", " ").split()
        if words:
            found[name] = words[0]
        if len(words) > 1:
            sheets.note(element, f"its letters have places in {name}; the first one counts")
    move = units.place(found.get("dx"), found.get("dy"))
    if "x" not in found and "y" not in found and not move.imag:
        return None
    place = units.place(found.get("x"), found.get("y"))
    x = place.real if "x" in found else before.real
    y = place.imag if "y" in found else before.imag
    return complex(x, y) + move
