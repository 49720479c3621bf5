"""Drawings of ink as SVG files, true to scale, with their title and description."""

from __future__ import annotations

import base64
import io
from itertools import count
from typing import TYPE_CHECKING
from xml.etree import ElementTree as Xml

from PIL import Image

from vbraille.pictures.ink import (
    InkArea,
    InkClip,
    InkDiscs,
    InkDrawing,
    InkLine,
    InkMark,
    InkRaster,
    InkText,
)
from vbraille.pictures.words import plain

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.pictures.ink import Contours

_SVG = "http://www.w3.org/2000/svg"


def svg(drawing: InkDrawing) -> bytes:
    """Make the SVG file of a drawing; a unit of it is a mm.

    Its title and description are what screen readers say of the picture.
    """
    width, height = _length(drawing.width_mm), _length(drawing.height_mm)
    root = Xml.Element(
        "svg",
        {
            "xmlns": _SVG,
            "width": f"{width}mm",
            "height": f"{height}mm",
            "viewBox": f"0 0 {width} {height}",
            "role": "img",
            "aria-labelledby": "title description",
        },
    )
    Xml.SubElement(root, "title", {"id": "title"}).text = plain(drawing.title)
    Xml.SubElement(root, "desc", {"id": "description"}).text = plain(drawing.description)
    Xml.SubElement(root, "rect", {"width": width, "height": height, "fill": "#fff"})
    names = count(1)
    for mark in drawing.marks:
        _add(root, mark, names)
    Xml.indent(root, " ")
    return Xml.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"


def _add(parent: Xml.Element, mark: InkMark, names: Iterator[int]) -> None:
    match mark:
        case InkArea():
            keys = {"d": _path(mark.contours, closed=True), "fill": _ink(mark.gray)}
            Xml.SubElement(parent, "path", {**keys, "fill-rule": "evenodd"})
        case InkLine():
            Xml.SubElement(parent, "path", _line(mark))
        case InkDiscs():
            group = Xml.SubElement(parent, "g", {"fill": _ink(mark.gray)})
            radius = _length(mark.radius_mm)
            for x, y in mark.centers_mm.tolist():
                Xml.SubElement(group, "circle", {"cx": _length(x), "cy": _length(y), "r": radius})
        case InkText():
            keys = {"x": _length(mark.place_mm[0]), "y": _length(mark.place_mm[1])}
            keys |= {"font-size": _length(mark.size_mm), "font-family": "sans-serif"}
            if mark.centered:
                keys["text-anchor"] = "middle"
            Xml.SubElement(parent, "text", keys).text = plain(mark.text)
        case InkRaster():
            Xml.SubElement(parent, "image", _image(mark))
        case InkClip():
            _add_clip(parent, mark, names)


def _add_clip(parent: Xml.Element, mark: InkClip, names: Iterator[int]) -> None:
    name = f"clip{next(names)}"
    clip = Xml.SubElement(parent, "clipPath", {"id": name})
    inside = {"d": _path(mark.contours, closed=True), "clip-rule": "evenodd"}
    Xml.SubElement(clip, "path", inside)
    group = Xml.SubElement(parent, "g", {"clip-path": f"url(#{name})"})
    for inner in mark.marks:
        _add(group, inner, names)


def _line(mark: InkLine) -> dict[str, str]:
    keys = {"d": _path(mark.contours, closed=mark.closed), "fill": "none"}
    keys |= {"stroke": _ink(mark.gray), "stroke-width": _length(mark.width_mm)}
    if mark.round_ends:
        keys |= {"stroke-linecap": "round", "stroke-linejoin": "round"}
    if mark.dashes_mm is not None:
        keys["stroke-dasharray"] = " ".join(map(_length, mark.dashes_mm))
        if mark.into_mm:
            keys["stroke-dashoffset"] = _length(mark.into_mm)
    return keys


def _image(mark: InkRaster) -> dict[str, str]:
    content = io.BytesIO()
    Image.fromarray(mark.pixels).save(content, "png", optimize=True)
    return {
        "x": _length(mark.place_mm[0]),
        "y": _length(mark.place_mm[1]),
        "width": _length(mark.width_mm),
        "height": _length(mark.height_mm),
        "preserveAspectRatio": "none",
        "href": f"data:image/png;base64,{base64.b64encode(content.getvalue()).decode()}",
    }


def _path(contours: Contours, *, closed: bool) -> str:
    end = "Z" if closed else ""
    return "".join(
        "M" + "L".join(f"{_length(x)} {_length(y)}" for x, y in contour.tolist()) + end
        for contour in contours
    )


def _ink(gray: float) -> str:
    level = round(255 * min(max(gray, 0.0), 1.0))
    return f"#{level:02x}{level:02x}{level:02x}"


def _length(value_mm: float) -> str:
    """Spell a length to the micrometre, without an exponent or "-0"."""
    return f"{round(value_mm, 3) + 0.0:.3f}".rstrip("0").rstrip(".")
