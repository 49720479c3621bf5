"""Values of SVG and CSS: lengths, numbers, transforms, colours and paints."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_LENGTH = re.compile(rf"\s*({_NUMBER})\s*([a-zA-Z]*|%)\s*", re.ASCII)
_NUMBERS = re.compile(_NUMBER, re.ASCII)
_CALLED = re.compile(r"\s*,?\s*([a-zA-Z]+)\s*\(([^()]*)\)", re.ASCII)
# Millimetres of a pixel of CSS, 96 to the inch.
PX_MM = 25.4 / 96
_PX = {"": 1.0, "px": 1.0, "pt": 96 / 72, "pc": 16.0, "mm": 96 / 25.4, "cm": 960 / 25.4,
       "in": 96.0, "q": 24 / 25.4}  # fmt: skip
_FONTS = {"em": 1.0, "ex": 0.5, "ch": 0.5, "ic": 1.0}
_ANGLES = {"": 1.0, "deg": 1.0, "grad": 0.9, "rad": 180 / math.pi, "turn": 360.0}
_KEYWORD_SHARES = {"left": 0.0, "top": 0.0, "center": 0.5, "right": 1.0, "bottom": 1.0}
_MOST_NESTED = 20

Point = tuple[float, float]
Box = tuple[float, float, float, float]  # left, top, width, height


@dataclass(frozen=True, slots=True)
class Units:
    """Sizes that relative lengths are of, in user units.

    Parameters
    ----------
    view
        Width and height of the viewport around, which percentages are of.
    page
        Width and height of the whole drawing, in pixels.
    font
        Size of the letters.
    """

    view: Point
    page: Point
    font: float = 16.0

    @property
    def diagonal(self) -> float:
        """Length that percentages of lengths in no direction are of."""
        return math.sqrt((self.view[0] ** 2 + self.view[1] ** 2) / 2)

    def px(self, value: float, unit: str, whole: float) -> float | None:
        """Number of a unit in user units; None for an unknown unit."""
        unit = unit.lower()
        if unit == "%":
            return value * whole / 100
        if unit in _FONTS:
            return value * self.font * _FONTS[unit]
        width, height = self.page
        wholes = {"rem": 1600.0, "vw": width, "vi": width, "vh": height, "vb": height,
                  "vmin": min(width, height), "vmax": max(width, height)}  # fmt: skip
        if unit in wholes:
            return value * wholes[unit] / 100
        return value * _PX[unit] if unit in _PX else None


def length_of(text: str | None, whole: float, units: Units) -> float | None:
    """Length in user units.

    Parameters
    ----------
    text
        The length as it is written; calc(), min(), max() and clamp() are computed.
    whole
        Length that a percentage is of.
    units
        Sizes that other units are of.

    Returns
    -------
    float or None
        The length; None if nothing, or no finite length, is written.
    """
    found = _LENGTH.fullmatch(text or "")
    if found is not None:
        value = units.px(float(found[1]), found[2], whole)
    elif "(" in (text or ""):
        value = _computed(text or "", whole, units)
    else:
        return None
    return value if value is not None and math.isfinite(value) else None


def _computed(text: str, whole: float, units: Units) -> float | None:
    """Length of a function of CSS, such as calc()."""
    import tinycss2

    tokens = tinycss2.parse_component_value_list(text, skip_comments=True)
    try:
        return _sum([one for one in tokens if one.type != "whitespace"], whole, units, 0)
    except (ValueError, ZeroDivisionError, OverflowError):
        return None


def _sum(tokens: Sequence[Any], whole: float, units: Units, depth: int) -> float:
    """Sum of products that tokens of CSS write."""
    total, sign, product, operator = 0.0, 1.0, None, "*"
    for token in tokens:
        if token.type == "literal" and token.value in "+-*/":
            if product is None:
                raise ValueError("an operator stands where a number is needed")
            if token.value in "+-":
                total += sign * product
                sign = 1.0 if token.value == "+" else -1.0
                product = None
            operator = "*" if token.value in "+-" else token.value
            continue
        value = _operand(token, whole, units, depth)
        if product is None:
            product = value
        else:
            product = product / value if operator == "/" else product * value
    if product is None:
        raise ValueError("a number is missing")
    return total + sign * product


def _operand(token: Any, whole: float, units: Units, depth: int) -> float:
    """Value of a number, of brackets or of a function."""
    if depth > _MOST_NESTED:
        raise ValueError("brackets stand too deep")
    if token.type in ("number", "percentage", "dimension"):
        unit = {"number": "", "percentage": "%"}.get(token.type) or getattr(token, "unit", "")
        value = units.px(token.value, unit, whole)
        if value is None:
            raise ValueError("a unit is unknown")
        return value
    if token.type == "() block":
        inside = [one for one in token.content if one.type != "whitespace"]
        return _sum(inside, whole, units, depth + 1)
    if token.type != "function":
        raise ValueError("it is not a number")
    arguments: list[list[Any]] = [[]]
    for one in token.arguments:
        if one.type == "literal" and one.value == ",":
            arguments.append([])
        elif one.type != "whitespace":
            arguments[-1].append(one)
    values = [_sum(argument, whole, units, depth + 1) for argument in arguments]
    match token.lower_name, len(values):
        case "calc", 1:
            return values[0]
        case "min", _:
            return min(values)
        case "max", _:
            return max(values)
        case "clamp", 3:
            return max(values[0], min(values[1], values[2]))
        case _:
            raise ValueError("a function is unknown")


def numbers_of(text: str | None) -> list[float]:
    """All numbers of a list; of one that goes wrong those before.

    >>> numbers_of("1,2 .5-3e1"), numbers_of("1 2 x 3")
    ([1.0, 2.0, 0.5, -30.0], [1.0, 2.0])
    """
    found, at = [], 0
    text = text or ""
    for number in _NUMBERS.finditer(text):
        if text[at : number.start()].strip(" \t\r\n,"):
            break
        found.append(float(number[0]))
        at = number.end()
    return found


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


def turned_by(degrees: float) -> AffineMap:
    """Rotation about the origin, from +x towards +y."""
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return AffineMap(cos, sin, -sin, cos)


def transform_of(text: str | None, units: Units, box: Box) -> AffineMap | None:
    """Map of a transform of SVG or CSS; None if it is not understood.

    Parameters
    ----------
    text
        The transform as it is written.
    units, box
        Sizes that lengths are of, and the box that percentages are of.
    """
    whole, at = AffineMap(), 0
    text = (text or "").strip()
    if text == "none":
        return whole
    while at < len(text):
        found = _CALLED.match(text, at)
        one = None if found is None else _step(found[1], found[2], units, box)
        if found is None or one is None or not one.finite:
            return None
        whole, at = whole @ one, found.end()
        at += len(text[at:]) - len(text[at:].lstrip())
    return whole if whole.finite else None


def _step(kind: str, inside: str, units: Units, box: Box) -> AffineMap | None:
    """Map of one function of a transform; None if its numbers are not understood."""
    words = [word for word in re.split(r"[\s,]+", inside.strip()) if word]
    if kind in ("translate", "translateX", "translateY"):
        wholes = (box[3],) if kind == "translateY" else box[2:]
        lengths = [
            length_of(word, whole, units) for word, whole in zip(words, wholes, strict=False)
        ]
        if None in lengths or not 1 <= len(words) <= (2 if kind == "translate" else 1):
            return None
        moves = [length or 0.0 for length in lengths]
        return (
            AffineMap(f=moves[0])
            if kind == "translateY"
            else AffineMap(e=moves[0], f=sum(moves[1:]))
        )
    if kind in ("rotate", "skew", "skewX", "skewY"):
        angles = [angle_of(word) for word in words[: 1 if kind != "skew" else 2]]
        places = [length_of(word, 0.0, units) for word in words[1:3]] if kind == "rotate" else []
        if not angles or None in angles or None in places or len(places) == 1:
            return None
        degrees = [angle or 0.0 for angle in angles]
        if kind == "rotate":
            x, y = (place or 0.0 for place in places or (0.0, 0.0))
            return AffineMap(e=x, f=y) @ turned_by(degrees[0]) @ AffineMap(e=-x, f=-y)
        slopes = [math.tan(math.radians(angle)) for angle in degrees]
        if kind == "skewY":
            return AffineMap(b=slopes[0])
        return AffineMap(c=slopes[0], b=sum(slopes[1:]))
    numbers = numbers_of(inside)
    if len(numbers) != len(words):
        return None
    match kind, len(numbers):
        case "matrix", 6:
            return AffineMap(*numbers)
        case "scale", 1 | 2:
            return AffineMap(a=numbers[0], d=numbers[-1])
        case "scaleX", 1:
            return AffineMap(a=numbers[0])
        case "scaleY", 1:
            return AffineMap(d=numbers[0])
        case _:
            return None


def angle_of(text: str) -> float | None:
    """Angle in degrees; None if it is not understood.

    >>> angle_of("0.25turn"), angle_of("40grad"), angle_of("wide")
    (90.0, 36.0, None)
    """
    found = _LENGTH.fullmatch(text)
    if found is None or found[2].lower() not in _ANGLES:
        return None
    return float(found[1]) * _ANGLES[found[2].lower()]


def origin_of(text: str, units: Units, box: Box) -> complex | None:
    """Place of a transform-origin; None if it is not understood."""
    words = text.split()[:2]
    if (words and words[0] in ("top", "bottom")) or (words[1:] and words[1] in ("left", "right")):
        words.reverse()
    words = [*words, *["center"] * (2 - len(words))]
    place: list[float] = []
    for word, start, whole in zip(words, box[:2], box[2:], strict=True):
        share = _KEYWORD_SHARES.get(word)
        length = length_of(word, whole, units) if share is None else share * whole
        if length is None:
            return None
        place.append(start + length)
    return complex(*place)


def view_box_of(text: str | None) -> Box | None:
    """Left, top, width and height of an attribute viewBox; None if it cannot be one."""
    numbers = numbers_of(text)
    if len(numbers) != 4 or not all(0 < size < 1e9 for size in numbers[2:]):
        return None
    left, top, width, height = numbers
    return (left, top, width, height) if abs(left) < 1e9 and abs(top) < 1e9 else None


def fit(view: Box, size: Point, how: str) -> AffineMap:
    """Map of a viewBox into a rectangle at the origin.

    Parameters
    ----------
    view
        The viewBox; its width and height are positive.
    size
        Width and height of the rectangle.
    how
        Attribute ``preserveAspectRatio``; empty to fit it into the middle.
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


@dataclass(frozen=True, slots=True)
class Color:
    """A colour: red, green, blue and alpha, each from 0 to 1."""

    red: float
    green: float
    blue: float
    alpha: float = 1.0

    @property
    def darkness(self) -> float:
        """Darkness from 0, white, to 1, black, by luminance (ITU-R 601)."""
        return 1.0 - (0.299 * self.red + 0.587 * self.green + 0.114 * self.blue)


BLACK = Color(0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Paint:
    """A paint as it is written.

    Parameters
    ----------
    kind
        "none", "color", "currentcolor", "context-fill", "context-stroke", or "url".
    color
        The colour; of "url", that of its fallback.
    target
        Id of the gradient or pattern.
    otherwise
        Paint of "url" where there is no such gradient: a kind, or empty for nothing said.
    """

    kind: str
    color: Color = BLACK
    target: str = ""
    otherwise: str = ""


def paint_of(text: str) -> Paint | None:
    """Paint of a fill or a stroke; None if it is not understood."""
    from vbraille.scene.svg.document import target_of

    text = text.strip()
    lower = text.lower()
    if lower in ("none", "context-fill", "context-stroke", "currentcolor"):
        return Paint(lower)
    if lower.startswith("url("):
        _, closed, rest = text.partition(")")
        if not closed:
            return None
        fallback = paint_of(rest) if rest.strip() else None
        color = BLACK if fallback is None else fallback.color
        return Paint("url", color, target_of(text), "" if fallback is None else fallback.kind)
    color = color_of(text)
    return None if color is None else Paint("color", color)


def color_of(text: str) -> Color | None:
    """Colour of CSS; None if it is not understood.

    >>> color_of("#f00"), color_of("rgb(100%, 0%, 50%)").blue, color_of("wood")
    (Color(red=1.0, green=0.0, blue=0.0, alpha=1.0), 0.5, None)
    """
    import tinycss2
    from tinycss2.color5 import parse_color

    tokens = tinycss2.parse_component_value_list(text, skip_comments=True)
    shown = [one for one in tokens if one.type != "whitespace"]
    profile = len(shown) > 1 and getattr(shown[1], "lower_name", "") == "icc-color"
    if len(shown) != 1 and not profile:
        return None
    try:
        found = parse_color(tinycss2.serialize(shown[:1]))
        if found is None or isinstance(found, str):
            return None
        red, green, blue, alpha = (min(max(one or 0.0, 0.0), 1.0) for one in found.to("srgb"))
    except (NotImplementedError, ValueError, TypeError):
        return None
    return Color(red, green, blue, alpha)


def share_of(text: str | None) -> float | None:
    """Opacity, from 0 to 1; None if it is not understood."""
    units = Units((0.0, 0.0), (0.0, 0.0))
    value = length_of(text, 1.0, units)
    return None if value is None else min(max(value, 0.0), 1.0)


def is_length(text: str) -> bool:
    """Tell whether a text is a length of CSS or SVG."""
    return length_of(text, 1.0, Units((1.0, 1.0), (1.0, 1.0))) is not None


def one_of(*words: str) -> Callable[[str], bool]:
    """Check of a value that is one of some words."""
    return frozenset(words).__contains__
