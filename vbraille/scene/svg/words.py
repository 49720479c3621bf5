"""Words of SVG: titles, descriptions, ids, and texts as labels."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from vbraille.scene.measures import MOST_MM
from vbraille.scene.patterns import Label
from vbraille.scene.svg.numbers import AffineMap, length_px
from vbraille.scene.svg.outlines import TOO_FAR, contours_of_path
from vbraille.scene.svg.style import styled
from vbraille.scene.svg.tree import INKSCAPE, link_of, name_of, text_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from vbraille.scene.svg.style import StyleSheet
    from vbraille.scene.svg.tree import Element

# The size of braille is the device's, not the drawing's, and is not known here. These are a
# Latero's, which are among the largest: labels placed by them meet nothing on other devices.
CELL_MM, HEIGHT_MM, LINE_MM = 11.1, 9.0, 12.5
_LONGEST_NAME, _LONGEST_TEXT = 200, 2000
# Ids that programs give by themselves say nothing, and are the same in many drawings.
_GIVEN = re.compile(
    r"(?:svg|g|layer|path|rect|circle|ellipse|line|poly(?:gon|line)|text|tspan|use|image|symbol"
    r"|XMLID|SVGID|Layer|Ebene|Calque|Capa|Livello|Laag)?[-_]?\d[\d_-]*",
)


def plain(text: str, most: int = _LONGEST_NAME) -> str:
    """Text on one line, without control characters, and not too long."""
    words = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return words if len(words) <= most else f"{words[:most]}…"


def title_of(element: Element) -> str:
    """Title of an element: its own, or the label that Inkscape gives it; empty for none."""
    for child in element:
        if name_of(child) == "title":
            return plain(text_of(child))
    label = element.get(f"{INKSCAPE}label") or element.get("aria-label") or ""
    return "" if label.startswith("#") else plain(label)


def description_of(element: Element) -> str:
    """Description of an element; empty for none."""
    for child in element:
        if name_of(child) == "desc":
            return plain(text_of(child), _LONGEST_TEXT)
    return ""


def id_of(element: Element) -> str:
    """Id that an author gave an element; empty if a program did, or it has none."""
    own = element.get("id") or ""
    return "" if _GIVEN.fullmatch(own) or not own.isprintable() else own[:_LONGEST_NAME]


@dataclass(frozen=True, slots=True)
class _Line:
    """A line of a text: where it begins or has its middle or end, and its characters."""

    place: complex
    anchor: str
    text: str
    element: Element


def labels_of(
    element: Element,
    matrix: AffineMap,
    style: Mapping[str, str],
    sheet: StyleSheet,
    ids: Mapping[str, Element],
) -> Iterator[tuple[Element, Label]]:
    """Labels of an element ``text``, one for each of its lines.

    A label stands so that its cells end at the line's foot. How long it will be is not known
    before it is translated; where the anchor is its middle or end, a cell for each character is
    taken. Lines of a text stand at least as far apart as lines of braille.

    Parameters
    ----------
    element
        The element.
    matrix
        Map from its coordinates to mm on the canvas.
    style
        Style of the element.
    sheet
        The drawing's style sheets.
    ids
        Elements of the drawing by their ids; a text along a path begins where that does.

    Raises
    ------
    ValueError
        If it stands farther than 10 m from the drawing's corner.
    """
    angle = math.atan2(matrix.b, matrix.a)
    along = complex(math.cos(angle), math.sin(angle))
    down = along * 1j
    before: complex | None = None
    for line in _lines(element, style, sheet, ids):
        text = plain(line.text, _LONGEST_TEXT)
        if not text:
            continue
        share = {"middle": 0.5, "end": 1.0}.get(line.anchor, 0.0)
        foot = matrix.put(line.place)
        corner = foot - down * HEIGHT_MM - along * share * len(text) * CELL_MM
        if before is not None:
            below = ((corner - before) / down).real
            if 0 < below < LINE_MM:
                corner += down * (LINE_MM - below)
        before = corner
        if not (abs(corner.real) <= MOST_MM and abs(corner.imag) <= MOST_MM):
            raise ValueError(TOO_FAR)
        place = round(corner.real, 4) + 0.0, round(corner.imag, 4) + 0.0
        degrees = round(math.degrees(angle), 4) + 0.0
        yield line.element, Label(text=text, place_mm=place, angle_deg=degrees)


def _lines(
    element: Element, style: Mapping[str, str], sheet: StyleSheet, ids: Mapping[str, Element]
) -> Iterator[_Line]:
    """Lines of a text, which begin anew wherever a part of it has a place of its own."""
    start = _place(element, style, complex(0, 0))
    line = _Line(start or 0j, style.get("text-anchor", "start"), "", element)
    done: list[_Line] = []

    def go(one: Element, style: Mapping[str, str], line: _Line, depth: int) -> _Line:
        line = replace(line, text=line.text + (one.text or ""))
        for child in one:
            if name_of(child) in ("tspan", "a", "textPath", "tref") and depth < 20:
                inner = styled(child, style, sheet)
                if inner.get("display") != "none" and inner.get("visibility") != "hidden":
                    place = _place(child, inner, line.place)
                    if name_of(child) == "textPath":
                        place = _start_of(ids.get(link_of(child)[1:]), place)
                    if place is not None:
                        done.append(line)
                        line = _Line(place, inner.get("text-anchor", "start"), "", child)
                    line = go(child, inner, line, depth + 1)
            line = replace(line, text=line.text + (child.tail or ""))
        return line

    last = go(element, style, line, 0)
    yield from done
    yield last


def _place(element: Element, style: Mapping[str, str], before: complex) -> complex | None:
    """Place that a part of a text has itself; None if it goes on where the part before ends."""
    font = length_px(style.get("font-size"), 16.0) or 16.0
    found = [_first(element.get(name), font) for name in ("x", "y", "dx", "dy")]
    x, y, dx, dy = found
    if x is None and y is None and not dy:
        return None
    return complex(
        (before.real if x is None else x) + (dx or 0.0),
        (before.imag if y is None else y) + (dy or 0.0),
    )


def _start_of(path: Element | None, otherwise: complex | None) -> complex | None:
    """Place at which a path begins, in its own coordinates; ``otherwise`` if it has none."""
    try:
        found = contours_of_path("" if path is None else path.get("d") or "", AffineMap())
    except ValueError:
        return otherwise
    return complex(*found[0].points_mm[0]) if found else otherwise


def _first(text: str | None, font: float) -> float | None:
    """First length of a list of them."""
    words = (text or "").replace(",", " ").split()
    return length_px(words[0], 0.0, font) if words else None
