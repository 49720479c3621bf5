"""Words of a drawing: titles, descriptions, ids, and texts as labels of braille."""

from __future__ import annotations

import cmath
import math
import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from vbraille.scene.measures import MOST_MM
from vbraille.scene.patterns import Label
from vbraille.scene.svg.document import INKSCAPE, link_of, name_of, text_of
from vbraille.scene.svg.outlines import TOO_FAR, segments_of
from vbraille.scene.svg.values import Units, length_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from vbraille.scene.svg.document import Element
    from vbraille.scene.svg.styles import StyleSheets
    from vbraille.scene.svg.values import AffineMap

# The size of braille is the device's, not the drawing's, and is not known here. These are a
# Latero's, which are among the largest: labels placed by them meet nothing on other devices.
CELL_MM, HEIGHT_MM, LINE_MM = 11.1, 9.0, 12.5
_LONGEST_NAME, _LONGEST_TEXT = 200, 2000
_MOST_NESTED = 20
# How far the foot of letters is above the place of a text, as a share of the height of a cell.
_BASELINES = {"middle": 0.5, "central": 0.5, "hanging": 1.0, "text-before-edge": 1.0,
              "text-top": 1.0}  # fmt: skip
_PARTS = ("tspan", "a", "textPath", "tref")
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
    """A line of a text: the place of its start, middle or end, its style and its characters."""

    place: complex
    style: Mapping[str, str]
    text: str
    element: Element


class TextReader:
    """Reader of a drawing's texts.

    Parameters
    ----------
    sheets
        The drawing's style sheets.
    ids
        Elements of the drawing by their ids.
    note
        Function that keeps a remark on an element.
    """

    def __init__(
        self,
        sheets: StyleSheets,
        ids: Mapping[str, Element],
        note: Callable[[Element, str], None],
    ) -> None:
        self._sheets, self._ids, self._note = sheets, ids, note

    def labels(
        self, element: Element, matrix: AffineMap, style: Mapping[str, str], units: Units
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
        angle = math.atan2(matrix.b, matrix.a)
        along = cmath.rect(1.0, angle)
        down = along * 1j
        before: complex | None = None
        for line in self._lines(element, style, units):
            text = plain(line.text, _LONGEST_TEXT)
            if not text:
                continue
            share = {"middle": 0.5, "end": 1.0}.get(line.style.get("text-anchor", ""), 0.0)
            base = _BASELINES.get(line.style.get("dominant-baseline", "").strip(), 0.0)
            foot = matrix.put(line.place)
            corner = foot - down * HEIGHT_MM * (1 - base) - along * share * len(text) * CELL_MM
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

    def _lines(self, element: Element, style: Mapping[str, str], units: Units) -> Iterator[_Line]:
        """Lines of a text, which begin anew wherever a part of it has a place of its own."""
        start = self._place(element, style, units, 0j)
        done: list[_Line] = []

        def go(one: Element, style: Mapping[str, str], line: _Line, depth: int) -> _Line:
            line = replace(line, text=line.text + (one.text or ""))
            for child in one:
                if name_of(child) in _PARTS and depth < _MOST_NESTED:
                    inner = self._sheets.of(child, style, _with_font(units, style))
                    if inner.get("display") != "none" and inner.get("visibility") != "hidden":
                        place = self._place(child, inner, units, line.place)
                        if name_of(child) == "textPath":
                            place = self._start(child, place)
                        if place is not None:
                            done.append(line)
                            line = _Line(place, inner, "", child)
                        line = go(child, inner, line, depth + 1)
                line = replace(line, text=line.text + (child.tail or ""))
            return line

        last = go(element, style, _Line(start or 0j, style, "", element), 0)
        yield from done
        yield last

    def _place(
        self, element: Element, style: Mapping[str, str], units: Units, before: complex
    ) -> complex | None:
        """Place of a part of a text; None if it goes on where the part before ends."""
        units = _with_font(units, style)
        found: list[float | None] = []
        for name, whole in zip(("x", "y", "dx", "dy"), units.view * 2, strict=True):
            words = (element.get(name) or "").replace(",", " ").split()
            found.append(length_of(words[0], whole, units) if words else None)
            if len(words) > 1:
                self._note(element, f"its letters have places in {name}; the first one counts")
        if element.get("rotate"):
            self._note(element, "its letters are turned, which is not felt")
        x, y, dx, dy = found
        if x is None and y is None and not dy:
            return None
        return complex(
            (before.real if x is None else x) + (dx or 0.0),
            (before.imag if y is None else y) + (dy or 0.0),
        )

    def _start(self, element: Element, otherwise: complex | None) -> complex | None:
        """Place at which the path of a text begins; ``otherwise`` if it has none."""
        self._note(element, "its path is not followed: the text is straight from where it begins")
        path = self._ids.get(link_of(element)[1:])
        segments, _ = segments_of("" if path is None else path.get("d") or "")
        return segments[0].end if len(segments) else otherwise


def _with_font(units: Units, style: Mapping[str, str]) -> Units:
    """Units with the size of an element's letters."""
    return replace(units, font=length_of(style.get("font-size"), units.font, units) or units.font)
