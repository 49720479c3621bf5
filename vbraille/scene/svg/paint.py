"""Textures of drawn surfaces and lines: by colour, or as a scene says by class."""

from __future__ import annotations

import colorsys
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.scene.measures import LEAST_MM
from vbraille.scene.patterns import Fill, Uniform, Use
from vbraille.scene.strokes import Along, Dotting, Stroke
from vbraille.scene.svg.numbers import length_px
from vbraille.tomlfile import Table

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vbraille.scene.patterns import AnyPattern


_HEX = re.compile(r"#(?:[0-9a-f]{3,4}|[0-9a-f]{6}|[0-9a-f]{8})")
_FUNCTION = re.compile(r"rgba?\(([^()]*)\)|hsla?\(([^()]*)\)")
_SPLIT = re.compile(r"[\s,/]+")

Color = tuple[float, float, float]


def color_of(text: str) -> Color | None:
    """Red, green and blue of a colour, each from 0 to 1; None if it is not understood.

    >>> color_of("#f00"), color_of("rgb(100%, 0, 127.5)"), color_of("url(#wood)")
    ((1.0, 0.0, 0.0), (1.0, 0.0, 0.5), None)
    """
    from PIL import ImageColor

    text = text.strip().lower()
    if text in ImageColor.colormap or _HEX.fullmatch(text):
        red, green, blue = (of / 255 for of in ImageColor.getrgb(text)[:3])
        return red, green, blue
    if found := _FUNCTION.fullmatch(text):
        return _of_function(_SPLIT.split((found[1] or found[2]).strip()), hues=found[1] is None)
    return None


def _of_function(parts: list[str], *, hues: bool) -> Color | None:
    """Colour of the numbers in the brackets of rgb() or hsl()."""
    try:
        numbers = [float(part.rstrip("%").removesuffix("deg")) for part in parts[:3]]
    except ValueError:
        return None
    if len(numbers) < 3:
        return None
    if hues:
        hue, saturation, lightness = numbers
        return colorsys.hls_to_rgb(
            hue / 360 % 1.0, _share(lightness / 100), _share(saturation / 100)
        )
    wholes = [100 if part.endswith("%") else 255 for part in parts[:3]]
    red, green, blue = (_share(n / whole) for n, whole in zip(numbers, wholes, strict=True))
    return red, green, blue


def _share(value: float) -> float:
    return min(max(value, 0.0), 1.0)


def darkness(color: Color) -> float:
    """Tell how dark a colour is, from 0, white, to 1, black, by luminance (ITU-R 601)."""
    red, green, blue = color
    return 1.0 - (0.299 * red + 0.587 * green + 0.114 * blue)


def hue_of(color: Color) -> str:
    """Hue of a colour in a word.

    >>> hue_of((0.0, 0.0, 1.0)), hue_of((0.2, 0.2, 0.25)), hue_of((1.0, 1.0, 0.95))
    ('blue', 'gray', 'white')
    """
    lightest, darkest = max(color), min(color)
    if darkness(color) < 0.08 and lightest - darkest < 0.2:
        return "white"
    if lightest - darkest < 0.12:
        return "gray"
    hue = 360 * colorsys.rgb_to_hsv(*color)[0]
    for end, name in ((20, "red"), (70, "yellow"), (170, "green"), (260, "blue"), (330, "purple")):
        if hue < end:
            return name
    return "red"


# Textures of the bank by hue; white surfaces are smooth, and hide what they lie on.
BY_HUE = {
    "gray": "stock:linear-0",
    "blue": "stock:linear-90",
    "green": "stock:dots",
    "yellow": "stock:linear-45",
    "purple": "stock:grid",
    "red": "stock:vibration",
}
# What is thinner is drawn so wide: a finger on actuators 1.2 mm apart misses thinner lines.
LEAST_STROKE_MM = 2.0
_MOST_STROKE_MM = 1000.0
_EDGE_MM = 1.0
_LEAST_DASH_MM = 1.5
_SEPARATOR = re.compile(r"[\s,]+")


class ClassLook(Table, frozen=True, kw_only=True):
    """Look of the shapes of a class in a drawing.

    Parameters
    ----------
    fill
        What fills closed shapes, in place of their colour; None if the colour says it.
    stroke
        Stroke of lines, in place of theirs; None if the drawing says it.
    dots
        Dots in place of a stroke; None for none.
    hidden
        Whether they are left out.

    Raises
    ------
    ValueError
        If there are a stroke and dots.
    """

    fill: Fill | None = None
    stroke: Stroke | None = None
    dots: Dotting | None = None
    hidden: bool = False

    def __post_init__(self) -> None:
        if self.stroke is not None and self.dots is not None:
            raise ValueError("dots cannot be given beside a stroke; leave one out")


@dataclass(frozen=True, slots=True)
class ShapeLook:
    """Look of a shape as it is drawn here.

    Parameters
    ----------
    stroke, dots, fill
        As a shape has them.
    notes
        What could not be kept of the drawing's style, each in a few words.
    """

    stroke: Stroke | None
    dots: Dotting | None
    fill: Fill | None
    notes: tuple[str, ...] = ()


def drawn(style: Mapping[str, str], scale_mm: float, look: ClassLook | None) -> ShapeLook:
    """Say how a shape of a style is drawn.

    Parameters
    ----------
    style
        Style of the shape.
    scale_mm
        Millimetres of one of its units.
    look
        What the scene says of its class; None if nothing.
    """
    notes: list[str] = []
    look = look or ClassLook()
    fill = look.fill or _fill(style, notes)
    if look.dots is not None:
        return ShapeLook(None, look.dots, fill, tuple(notes))
    stroke = look.stroke or _stroke(style, scale_mm, notes)
    return ShapeLook(stroke, None, fill, tuple(notes))


def _fill(style: Mapping[str, str], notes: list[str]) -> Fill | None:
    opacity = share_of(style.get("fill-opacity"))
    paint = _paint(style, "fill", "black", notes)
    if paint is None or opacity <= 0.0:
        return None
    hue, amount = paint
    if hue == "white":
        texture: AnyPattern = Uniform(level=0.0)
    else:
        texture = Use(name=BY_HUE[hue], amplitude=round(amount * opacity, 3))
    return Fill(texture=texture)


def _stroke(style: Mapping[str, str], scale_mm: float, notes: list[str]) -> Stroke | None:
    opacity = share_of(style.get("stroke-opacity"))
    paint = _paint(style, "stroke", "none", notes)
    width = length_px(style.get("stroke-width", "1"), 0.0)
    width = 1.0 if width is None else width
    if paint is None or opacity <= 0.0 or width <= 0.0:
        return None
    width_mm = width * scale_mm
    if width_mm < LEAST_STROKE_MM:
        notes.append(f"its line is drawn {LEAST_STROKE_MM:g} mm wide, not to be missed")
        width_mm = LEAST_STROKE_MM
    width_mm = round(min(width_mm, _MOST_STROKE_MM), 4)
    hue, amount = paint
    return Stroke(
        width_mm=width_mm,
        edge_mm=min(_EDGE_MM, width_mm / 2),
        amplitude=0.0 if hue == "white" else round(amount * opacity, 3),
        along=_dashes(style, scale_mm, notes),
    )


def _paint(
    style: Mapping[str, str], name: str, usual: str, notes: list[str]
) -> tuple[str, float] | None:
    """Hue of a paint, and how strong it is; None for no paint.

    Grays are as strong as they are dark. Colours are as strong as can be.
    """
    text = style.get(name, usual).strip()
    if text in ("none", "transparent", ""):
        return None
    if text in ("currentColor", "currentcolor"):
        text = style.get("color", "black")
    if text.startswith("url("):
        _, _, instead = text.partition(")")
        notes.append(f"its {name} {text[:40]} is felt as a plain gray one")
        text = instead.strip() or "black"
        if text == "none":
            return None
    color = color_of(text)
    if color is None:
        notes.append(f"its {name} {text[:40]!r} is not understood; it is felt as black")
        color = (0.0, 0.0, 0.0)
    hue = hue_of(color)
    return hue, darkness(color) if hue == "gray" else 1.0


def share_of(text: str | None) -> float:
    """Opacity, from 0 to 1; 1 if none is written that is understood."""
    value = length_px(text, 1.0)
    return 1.0 if value is None else min(max(value, 0.0), 1.0)


def _dashes(style: Mapping[str, str], scale_mm: float, notes: list[str]) -> Along | None:
    """Texture along a stroke that is drawn with dashes: cut in its gaps."""
    text = style.get("stroke-dasharray", "none").strip()
    if text in ("none", ""):
        return None
    lengths = [length_px(part, 0.0) for part in _SEPARATOR.split(text)]
    known = [length for length in lengths if length is not None and length >= 0]
    if len(known) != len(lengths) or sum(known) <= 0:
        return None
    dash, gap = known[0], known[1] if len(known) > 1 else known[0]
    if len(known) > 2:
        notes.append("of its dashes the first and the gap after it count")
    if gap <= 0:
        return None
    dash_mm = min(max(dash * scale_mm, _LEAST_DASH_MM), _MOST_STROKE_MM)
    gap_mm = min(max(gap * scale_mm, _LEAST_DASH_MM, LEAST_MM), _MOST_STROKE_MM)
    return Along(ridge_mm=round(gap_mm, 4), gap_mm=round(dash_mm, 4))
