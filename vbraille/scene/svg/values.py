"""Values of SVG and CSS: lengths, numbers, transforms, colours and paints."""

from __future__ import annotations

import cmath
import math
import re
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import tinycss2
from tinycss2.color5 import parse_color

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

_NUMBERS = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_LONGEST = 10_000  # characters of a value
# Millimetres of a pixel of CSS, 96 to the inch.
PX_MM = 25.4 / 96
_UNITS = {"": 1.0, "px": 1.0, "pt": 96 / 72, "pc": 16.0, "mm": 96 / 25.4, "cm": 960 / 25.4,
          "in": 96.0, "q": 24 / 25.4, "rem": 16.0,
          "deg": 1.0, "grad": 0.9, "rad": 180 / math.pi, "turn": 360.0}  # fmt: skip
_FUNCTIONS: dict[str, Callable[..., float]] = {
    "calc": lambda value: value,
    "min": lambda *values: min(values),
    "max": lambda *values: max(values),
    "clamp": lambda least, value, most: max(least, min(value, most)),
}
_ORIGINS = {"left": "0%", "top": "0%", "center": "50%", "right": "100%", "bottom": "100%"}
# Errors that values which are not understood end in.
NOT_UNDERSTOOD = (ValueError, TypeError, LookupError, ArithmeticError, AttributeError)

Point = tuple[float, float]
Box = tuple[float, float, float, float]  # left, top, width, height


@lru_cache(maxsize=10_000)
def tokens_of(text: str) -> list[Any]:
    """Component values of CSS without white space; none of a text that is far too long."""
    values = tinycss2.parse_component_value_list(text[: _LONGEST + 1], skip_comments=True)
    return _shown(values) if len(text) <= _LONGEST else []


def _shown(tokens: Sequence[Any]) -> list[Any]:
    return [token for token in tokens if token.type != "whitespace"]


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

    view: Point = (1.0, 1.0)
    page: Point = (1.0, 1.0)
    font: float = 16.0

    def sized(self, style: Mapping[str, str]) -> Units:
        """Units with the size of the letters that a style has."""
        return replace(self, font=float(style["font-size"]))

    @property
    def diagonal(self) -> float:
        """Length that percentages of lengths in no direction are of."""
        return math.hypot(*self.view) / math.sqrt(2)

    def length(self, text: str | None, whole: float) -> float | None:
        """Length in user units, of ``whole`` if it is in percent; None if it is no finite one."""
        try:
            (token,) = tokens_of(text or "")
            value = self.number(token, whole)
        except NOT_UNDERSTOOD:
            return None
        return value if math.isfinite(value) else None

    def place(self, x: str | None, y: str | None) -> complex:
        """Place of two lengths; 0 for those that are none."""
        return complex(
            self.length(x, self.view[0]) or 0.0,
            self.length(y, self.view[1]) or 0.0,
        )

    def number(self, token: Any, whole: float) -> float:
        """Value of a number, of brackets or of a function, such as calc()."""
        if token.type == "() block":
            return self._sum(token.content, whole)
        if token.type == "function":
            values = [self._sum(one, whole) for one in arguments_of(token)]
            return _FUNCTIONS[token.lower_name](*values)
        unit = "%" if token.type == "percentage" else getattr(token, "lower_unit", "")
        if unit in _UNITS:
            return token.value * _UNITS[unit]
        (width, height), font = self.page, self.font
        sizes = {"%": whole, "em": font * 100, "ic": font * 100, "ex": font * 50, "ch": font * 50,
                 "vw": width, "vi": width, "vh": height, "vb": height,
                 "vmin": min(width, height), "vmax": max(width, height)}  # fmt: skip
        return token.value * sizes[unit] / 100

    def _sum(self, tokens: Sequence[Any], whole: float) -> float:
        """Value of numbers with operators between them."""
        shown = _shown(tokens)
        terms = [self.number(shown[0], whole)]
        for operator, token in zip(shown[1::2], shown[2::2], strict=True):
            value = self.number(token, whole)
            match operator.value:
                case "+":
                    terms.append(value)
                case "-":
                    terms.append(-value)
                case "*":
                    terms[-1] *= value
                case "/":
                    terms[-1] /= value
                case _:
                    raise ValueError("no operator")
        return sum(terms)


def arguments_of(function: Any) -> list[list[Any]]:
    """Values of a function's arguments, which commas divide."""
    found: list[list[Any]] = [[]]
    for token in _shown(function.arguments):
        if token == ",":
            found.append([])
        else:
            found[-1].append(token)
    return found


def is_length(text: str) -> bool:
    """Tell whether a text is a length of CSS or SVG."""
    return Units().length(text, 1.0) is not None


def share_of(text: str) -> float:
    """Opacity, from 0 to 1; 1 if it is not understood."""
    value = Units().length(text, 1.0)
    return 1.0 if value is None else min(max(value, 0.0), 1.0)


def angle_of(text: str) -> float:
    """Angle in degrees; 0 if it is not understood.

    >>> angle_of("0.25turn"), angle_of("40grad"), angle_of("wide")
    (90.0, 36.0, 0.0)
    """
    return Units().length(text, 0.0) or 0.0


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
    """An affine map of places as complex numbers: z becomes p z + q z̄ + r."""

    p: complex = 1.0
    q: complex = 0.0
    r: complex = 0.0

    def __call__(self, place: complex) -> complex:
        """Transform a place."""
        return self.p * place + self.q * place.conjugate() + self.r

    def __matmul__(self, first: AffineMap) -> AffineMap:
        """Map that does ``first``, and then this one."""
        return AffineMap(
            self.p * first.p + self.q * first.q.conjugate(),
            self.p * first.q + self.q * first.p.conjugate(),
            self(first.r),
        )

    @property
    def _sizes(self) -> Point:
        # Unlike abs(), they are infinite where they are too large.
        return math.hypot(self.p.real, self.p.imag), math.hypot(self.q.real, self.q.imag)

    @property
    def largest(self) -> float:
        """Largest factor of lengths in any direction."""
        return sum(self._sizes)

    @property
    def scale(self) -> float:
        """Factor of lengths: the root of that of areas."""
        p, q = self._sizes
        return math.sqrt(abs(p - q) * (p + q))

    @property
    def keeps_circles(self) -> bool:
        """Tell whether a circle stays a circle."""
        return min(self._sizes) <= 1e-6 * self.largest


def affine(a: float, b: float, c: float, d: float, e: float = 0.0, f: float = 0.0) -> AffineMap:
    """Map of x' = a x + c y + e and y' = b x + d y + f, as SVG writes it."""
    return AffineMap(complex(a + d, b - c) / 2, complex(a - d, b + c) / 2, complex(e, f))


def turned(degrees: float, x: float = 0.0, y: float = 0.0) -> AffineMap:
    """Rotation about a place, from +x towards +y."""
    return about(complex(x, y), AffineMap(cmath.rect(1.0, math.radians(degrees))))


def about(place: complex, inner: AffineMap) -> AffineMap:
    """Map as it is about a place in place of the origin."""
    return AffineMap(r=place) @ inner @ AffineMap(r=-place)


def _slope(degrees: float) -> float:
    return math.tan(math.radians(degrees))


_TRANSFORMS: dict[str, Callable[..., AffineMap]] = {
    "matrix": lambda a, b, c, d, e, f: affine(a, b, c, d, e, f),
    "translate": lambda x, y=0.0: AffineMap(r=complex(x, y)),
    "translatex": lambda x: AffineMap(r=x),
    "translatey": lambda y: AffineMap(r=1j * y),
    "scale": lambda x, y=None: affine(x, 0.0, 0.0, x if y is None else y),
    "scalex": lambda x: affine(x, 0.0, 0.0, 1.0),
    "scaley": lambda y: affine(1.0, 0.0, 0.0, y),
    "rotate": turned,
    "skew": lambda x, y=0.0: affine(1.0, _slope(y), _slope(x), 1.0),
    "skewx": lambda x: affine(1.0, 0.0, _slope(x), 1.0),
    "skewy": lambda y: affine(1.0, _slope(y), 0.0, 1.0),
}


def transform_of(text: str, units: Units, box: Box) -> AffineMap | None:
    """Map of a transform of SVG or CSS; None if it is not understood.

    Parameters
    ----------
    text
        The transform as it is written.
    units, box
        Sizes that lengths are of, and the box that percentages are of.
    """
    whole = AffineMap()
    try:
        for function in tokens_of(re.sub(r"\s+\(", "(", text)) or [None]:
            if function == ",":
                continue
            kind = function.lower_name
            tokens = [token for one in arguments_of(function) for token in one]
            wholes = (box[3:] if kind == "translatey" else box[2:]) + (1.0,) * len(tokens)
            numbers = map(units.number, tokens, wholes)
            whole = whole @ _TRANSFORMS[kind](*numbers)
    except NOT_UNDERSTOOD:
        return None
    return whole


def origin_of(text: str, units: Units, box: Box) -> complex | None:
    """Place of a transform-origin; None if it is not understood."""
    words = text.split()[:2]
    if words[0] in ("top", "bottom") or words[1:] in (["left"], ["right"]):
        words.reverse()
    words = [*words, "center"][:2]
    x, y = (
        units.length(_ORIGINS.get(word, word), whole)
        for word, whole in zip(words, box[2:], strict=True)
    )
    return None if x is None or y is None else complex(box[0] + x, box[1] + y)


def view_box_of(text: str | None) -> Box | None:
    """Left, top, width and height of an attribute viewBox; None if it cannot be one."""
    numbers = numbers_of(text)
    if len(numbers) != 4 or min(numbers[2:]) <= 0 or max(map(abs, numbers)) >= 1e9:
        return None
    left, top, width, height = numbers
    return left, top, width, height


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
    if "none" not in words:
        across = down = max(across, down) if "slice" in words else min(across, down)
    align = next((word for word in words if word.startswith("x")), "xMidYMid")
    shares = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
    x = shares.get(align[1:4], 0.5) * (size[0] - width * across) - left * across
    y = shares.get(align[5:8], 0.5) * (size[1] - height * down) - top * down
    return affine(across, 0.0, 0.0, down, x, y)


class Color(NamedTuple):
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


@lru_cache(maxsize=10_000)
def color_of(text: str) -> Color | None:
    """Colour of CSS; None if it is not understood.

    >>> color_of("#f00"), color_of("rgb(100%, 0%, 50%)").blue, color_of("wood")
    (Color(red=1.0, green=0.0, blue=0.0, alpha=1.0), 0.5, None)
    """
    try:
        token, *others = tokens_of(text)
        if others and others[0].lower_name != "icc-color":
            return None
        parts: Any = parse_color(token)
        return Color(*(min(max(one or 0.0, 0.0), 1.0) for one in parts.to("srgb")))
    except (*NOT_UNDERSTOOD, NotImplementedError):
        return None


def is_paint(text: str) -> bool:
    """Tell whether a text is a paint of a fill or a stroke."""
    if text.lower().startswith("url("):
        _, closed, fallback = text.partition(")")
        return bool(closed) and (not fallback.strip() or is_paint(fallback.strip()))
    words = ("none", "currentcolor", "context-fill", "context-stroke")
    return text.lower() in words or color_of(text) is not None
