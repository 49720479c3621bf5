"""Textures of drawn surfaces and lines: by colour, or as a scene says by class."""

from __future__ import annotations

import colorsys
import re
from typing import TYPE_CHECKING

from vbraille.scene.patterns import Along, Dotting, Fill, Stroke, Uniform, Use
from vbraille.toml import Table

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.scene.svg.document import Color, Style

    Note = Callable[[str], None]

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
    spread = max(color[:3]) - min(color[:3])
    if color.darkness < 0.08 and spread < 0.2:
        return "white"
    if spread < 0.12:
        return "gray"
    hue = 360 * colorsys.rgb_to_hsv(*color[:3])[0]
    return next(name for end, name in _HUES if hue <= end)


def strength_of(color: Color, note: Note) -> float | None:
    """Amplitude that stands for a colour, 0 for white; None for a colour that is not felt.

    Grays are as strong as they are dark. Colours are as strong as can be.
    """
    hue = hue_of(color)
    if hue == "white" and LEAST_SHARE < color.alpha < _HIDING:
        note("its white is seen through, and left out")
        return None
    if color.alpha <= LEAST_SHARE:
        return None
    amounts = {"white": 0.0, "gray": color.darkness}
    return round(amounts.get(hue, 1.0) * color.alpha, 3)


def fill_of(color: Color, note: Note) -> Fill | None:
    """Fill of a surface of a colour; None for a surface that is not felt."""
    strength = strength_of(color, note)
    if strength is None:
        return None
    if hue_of(color) == "white":
        return Fill(texture=Uniform(level=0.0))
    return Fill(texture=Use(name=BY_HUE[hue_of(color)], amplitude=strength))


def stroke_of(color: Color, width_mm: float, dashes_mm: list[float], note: Note) -> Stroke | None:
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
    strength = strength_of(color, note) if width_mm > 0 else None
    if strength is None:
        return None
    if width_mm < LEAST_STROKE_MM:
        note(f"its line is drawn {LEAST_STROKE_MM:g} mm wide, not to be missed")
    along = None
    if dashes_mm and dashes_mm[1] > 0:
        dash, gap = (min(max(one, _LEAST_DASH_MM), _MOST_STROKE_MM) for one in dashes_mm[:2])
        along = Along(ridge_mm=round(gap, 4), gap_mm=round(dash, 4))
        if dashes_mm != dashes_mm[:2] * (len(dashes_mm) // 2):
            note("its first dash and the gap after it count, and no others")
    width_mm = round(min(max(width_mm, LEAST_STROKE_MM), _MOST_STROKE_MM), 4)
    return Stroke(width_mm=width_mm, edge_mm=_EDGE_MM, amplitude=strength, along=along)


def dashes_of(style: Style, scale_mm: float) -> list[float]:
    """Lengths of dashes and gaps in mm; empty for a whole line."""
    words = re.split(r"[\s,]+", style["stroke-dasharray"])
    lengths = [(style.length(word, style.diagonal) or 0.0) * scale_mm for word in words]
    if min(lengths) < 0 or sum(lengths) <= 0:
        return []
    return lengths * 2 if len(lengths) % 2 else lengths
