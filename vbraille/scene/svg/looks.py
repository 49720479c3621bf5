"""Textures of drawn surfaces and lines: by colour, or as a scene says by class."""

from __future__ import annotations

import colorsys
import re
from typing import TYPE_CHECKING

from vbraille.scene.measures import LEAST_MM
from vbraille.scene.patterns import Fill, Uniform, Use
from vbraille.scene.strokes import Along, Dotting, Stroke
from vbraille.scene.svg.values import length_of
from vbraille.toml import Table

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.svg.values import Color, Units

# Textures of the bank by hue; white surfaces are smooth, and hide the shapes below.
BY_HUE = {
    "gray": "stock:linear-0",
    "blue": "stock:linear-90",
    "green": "stock:dots",
    "yellow": "stock:linear-45",
    "purple": "stock:grid",
    "red": "stock:vibration",
}
_HUES = ((20, "red"), (70, "yellow"), (170, "green"), (260, "blue"), (330, "purple"), (360, "red"))
# Thinner lines are drawn as wide as this: a finger on actuators 1.2 mm apart misses them.
LEAST_STROKE_MM = 2.0
LEAST_SHARE = 0.02  # fainter paints are not felt
_HIDING = 0.9  # white paints fainter than this hide nothing to speak of
_MOST_STROKE_MM = 1000.0
_EDGE_MM = 1.0
_LEAST_DASH_MM = 1.5


class ClassLook(Table, frozen=True, kw_only=True):
    """Look of the shapes of a class in a drawing.

    Parameters
    ----------
    fill
        Fill of closed shapes, in place of their colour; None to keep the colour.
    stroke
        Stroke of lines, in place of theirs; None to keep the drawing's.
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


def hue_of(color: Color) -> str:
    """Hue of a colour in a word: gray, white, or a key of `BY_HUE`."""
    red, green, blue = color.red, color.green, color.blue
    spread = max(red, green, blue) - min(red, green, blue)
    if color.darkness < 0.08 and spread < 0.2:
        return "white"
    if spread < 0.12:
        return "gray"
    hue = 360 * colorsys.rgb_to_hsv(red, green, blue)[0]
    return next(name for end, name in _HUES if hue <= end)


def fill_of(color: Color, note: Callable[[str], None]) -> Fill | None:
    """Fill of a surface of a colour; None for a surface that is not felt.

    Grays are as strong as they are dark. Colours are as strong as can be.
    """
    if color.alpha <= LEAST_SHARE:
        return None
    hue = hue_of(color)
    if hue == "white":
        if color.alpha < _HIDING:
            note("its white is seen through, and left out")
            return None
        return Fill(texture=Uniform(level=0.0))
    amount = color.darkness if hue == "gray" else 1.0
    texture: AnyPattern = Use(name=BY_HUE[hue], amplitude=round(amount * color.alpha, 3))
    return Fill(texture=texture)


def stroke_of(
    color: Color,
    width_mm: float,
    dashes_mm: list[float],
    note: Callable[[str], None],
) -> Stroke | None:
    """Stroke of a line of a colour; None for a line that is not felt.

    Parameters
    ----------
    color
        Colour of the line.
    width_mm
        Width of the line; less than 2 mm becomes 2 mm.
    dashes_mm
        Lengths of dashes and gaps; empty for a whole line.
    note
        Function that keeps a remark.
    """
    if color.alpha <= LEAST_SHARE or width_mm <= 0:
        return None
    white = hue_of(color) == "white"
    if white and color.alpha < _HIDING:
        note("its white is seen through, and left out")
        return None
    if width_mm < LEAST_STROKE_MM:
        note(f"its line is drawn {LEAST_STROKE_MM:g} mm wide, not to be missed")
    width_mm = round(min(max(width_mm, LEAST_STROKE_MM), _MOST_STROKE_MM), 4)
    amount = color.darkness if hue_of(color) == "gray" else 1.0
    return Stroke(
        width_mm=width_mm,
        edge_mm=min(_EDGE_MM, width_mm / 2),
        amplitude=0.0 if white else round(amount * color.alpha, 3),
        along=_dashed(dashes_mm, note),
    )


def dashes_of(style: Mapping[str, str], scale_mm: float, units: Units) -> list[float]:
    """Lengths of dashes and gaps in mm; empty for a whole line."""
    text = style.get("stroke-dasharray", "none").strip()
    words = [word for word in re.split(r"[\s,]+", text) if word]
    lengths = [length_of(word, units.diagonal, units) for word in words]
    known = [length * scale_mm for length in lengths if length is not None and length >= 0]
    if len(known) != len(lengths) or sum(known) <= 0:
        return []
    return known * 2 if len(known) % 2 else known


def _dashed(dashes_mm: list[float], note: Callable[[str], None]) -> Along | None:
    """Texture along a stroke that is drawn with dashes: cut in its gaps."""
    if not dashes_mm or dashes_mm[1] <= 0:
        return None
    dash, gap = dashes_mm[:2]
    if any(
        list(pair) != [dash, gap] for pair in zip(dashes_mm[2::2], dashes_mm[3::2], strict=True)
    ):
        note("its first dash and the gap after it count, and no others")
    dash = min(max(dash, _LEAST_DASH_MM), _MOST_STROKE_MM)
    gap = min(max(gap, _LEAST_DASH_MM, LEAST_MM), _MOST_STROKE_MM)
    return Along(ridge_mm=round(gap, 4), gap_mm=round(dash, 4))
