"""Numbers of SVG files: lengths with units, transforms, and what a viewBox does."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_LENGTH = re.compile(
    rf"\s*({_NUMBER})\s*(px|pt|pc|mm|cm|in|em|ex|q|%)?\s*", re.IGNORECASE | re.ASCII
)
_NUMBERS = re.compile(_NUMBER, re.ASCII)
_TRANSFORM = re.compile(r"\s*,?\s*(matrix|translate|scale|rotate|skewX|skewY)\s*\(([^()]*)\)\s*")
# Pixels of CSS, 96 to the inch.
PX_MM = 25.4 / 96
_PX = {
    "": 1.0,
    "px": 1.0,
    "pt": 96 / 72,
    "pc": 16.0,
    "mm": 96 / 25.4,
    "cm": 960 / 25.4,
    "in": 96.0,
    "q": 24 / 25.4,
}


def length_px(text: str | None, whole: float, font: float = 16.0) -> float | None:
    """Length in pixels of SVG's, which are user units.

    Parameters
    ----------
    text
        The length as it is written.
    whole
        What a percentage is of.
    font
        Size of the letters, for the units em and ex.

    Returns
    -------
    float or None
        The length; None if nothing, or no finite length, is written.

    >>> length_px("1in", 0), length_px("50%", 30), length_px("auto", 30)
    (96.0, 15.0, None)
    """
    found = _LENGTH.fullmatch(text or "")
    if found is None:
        return None
    value, unit = float(found[1]), (found[2] or "").lower()
    if unit == "%":
        value *= whole / 100
    elif unit in ("em", "ex"):
        value *= font if unit == "em" else font / 2
    else:
        value *= _PX[unit]
    return value if math.isfinite(value) else None


def numbers_of(text: str | None) -> list[float]:
    """All numbers of a list."""
    return [float(number) for number in _NUMBERS.findall(text or "")]


@dataclass(frozen=True, slots=True)
class AffineMap:
    """An affine map, x' = a x + c y + e and y' = b x + d y + f, as SVG writes it."""

    a: float = 1.0
    b: float = 0.0
    c: float = 0.0
    d: float = 1.0
    e: float = 0.0
    f: float = 0.0

    def __matmul__(self, first: AffineMap) -> AffineMap:
        """Map that does ``first``, and then this one."""
        return AffineMap(
            self.a * first.a + self.c * first.b,
            self.b * first.a + self.d * first.b,
            self.a * first.c + self.c * first.d,
            self.b * first.c + self.d * first.d,
            self.a * first.e + self.c * first.f + self.e,
            self.b * first.e + self.d * first.f + self.f,
        )

    def put(self, place: complex) -> complex:
        """Transform a place, as a complex number."""
        x, y = place.real, place.imag
        return complex(self.a * x + self.c * y + self.e, self.b * x + self.d * y + self.f)

    @property
    def scale(self) -> float:
        """Factor of lengths: the root of that of areas."""
        return math.sqrt(abs(self.a * self.d - self.b * self.c))

    @property
    def largest(self) -> float:
        """Largest factor of lengths in any direction."""
        total = self.a**2 + self.b**2 + self.c**2 + self.d**2
        area = (self.a * self.d - self.b * self.c) ** 2
        return math.sqrt((total + math.sqrt(max(total**2 - 4 * area, 0.0))) / 2)

    @property
    def keeps_circles(self) -> bool:
        """Tell whether a circle stays a circle."""
        slack = 1e-6 * (abs(self.a) + abs(self.b) + abs(self.c) + abs(self.d))
        turned = abs(self.a - self.d) <= slack and abs(self.b + self.c) <= slack
        return turned or (abs(self.a + self.d) <= slack and abs(self.b - self.c) <= slack)

    @property
    def finite(self) -> bool:
        """Tell whether all its numbers are finite."""
        return all(map(math.isfinite, (self.a, self.b, self.c, self.d, self.e, self.f)))


def transform_of(text: str | None) -> AffineMap | None:
    """Map of an attribute ``transform``; None if it is not understood.

    >>> transform_of("translate(10) scale(2)").put(1 + 1j)
    (12+2j)
    """
    whole, at = AffineMap(), 0
    text = (text or "").strip()
    while at < len(text):
        found = _TRANSFORM.match(text, at)
        if found is None:
            return None
        one = _one(found[1], numbers_of(found[2]))
        if one is None or not one.finite:
            return None
        whole, at = whole @ one, found.end()
    return whole if whole.finite else None


def _one(kind: str, of: list[float]) -> AffineMap | None:
    """Map of one function; None if it has a number of numbers that it cannot have."""
    match kind, len(of):
        case "matrix", 6:
            return AffineMap(*of)
        case "translate", 1 | 2:
            return AffineMap(e=of[0], f=(*of, 0.0)[1])
        case "scale", 1 | 2:
            return AffineMap(a=of[0], d=of[-1])
        case "rotate", 1 | 3:
            angle = math.radians(of[0])
            cos, sin = math.cos(angle), math.sin(angle)
            turn = AffineMap(cos, sin, -sin, cos)
            if len(of) == 1:
                return turn
            return AffineMap(e=of[1], f=of[2]) @ turn @ AffineMap(e=-of[1], f=-of[2])
        case "skewX", 1:
            return AffineMap(c=math.tan(math.radians(of[0])))
        case "skewY", 1:
            return AffineMap(b=math.tan(math.radians(of[0])))
        case _:
            return None


def fit(view: tuple[float, float, float, float], size: tuple[float, float], how: str) -> AffineMap:
    """Map of a viewBox into a rectangle at the origin, by ``preserveAspectRatio``.

    Parameters
    ----------
    view
        The viewBox: left, top, width, height, the last two positive.
    size
        Width and height of the rectangle.
    how
        Attribute ``preserveAspectRatio``; empty for what is usual, to fit it into the middle.
    """
    left, top, width, height = view
    across, down = size[0] / width, size[1] / height
    words = how.split()
    align = next((word for word in words if word != "defer"), "xMidYMid")
    if align == "none":
        return AffineMap(a=across, d=down, e=-left * across, f=-top * down)
    one = max(across, down) if "slice" in words else min(across, down)
    shares = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
    x, y = shares.get(align[1:4], 0.5), shares.get(align[5:8], 0.5)
    return AffineMap(
        a=one,
        d=one,
        e=x * (size[0] - width * one) - left * one,
        f=y * (size[1] - height * one) - top * one,
    )
