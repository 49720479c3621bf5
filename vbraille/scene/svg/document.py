"""SVG files: trees of elements read within limits, their values and their styles."""

from __future__ import annotations

import cmath
import math
import re
import time
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import cssselect2
import tinycss2
from tinycss2.color5 import parse_color

from vbraille.errors import InputError
from vbraille.files import read_bytes

if TYPE_CHECKING:
    from pathlib import Path

    from lxml.etree import _Element

    Element = _Element
    from collections.abc import Callable, Iterable, Mapping, Sequence


SVG = "{http://www.w3.org/2000/svg}"
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
_XLINK_HREF = "{http://www.w3.org/1999/xlink}href"
MOST_BYTES = 50_000_000
MOST_ELEMENTS = 50_000
_LONGEST_NAME, LONGEST_TEXT = 200, 2000
# Ids that programs give by themselves say nothing, and are the same in many drawings.
_GIVEN = re.compile(
    r"(?:svg|g|layer|path|rect|circle|ellipse|line|poly(?:gon|line)|text|tspan|use|image|symbol"
    r"|XMLID|SVGID|Layer|Ebene|Calque|Capa|Livello|Laag)?[-_]?\d[\d_-]*",
)


def read_tree(path: Path) -> Element:
    """Read an SVG file.

    Entities that the file itself declares are replaced; nothing else is fetched.

    Returns
    -------
    lxml element
        The element ``svg``. Elements know their lines.

    Raises
    ------
    InputError
        If the file cannot be read, is not SVG, is not well formed, has more than 50,000 elements,
        elements more than 256 deep, or is larger than 50 MB.
    """
    from lxml import etree

    content = read_bytes(path, "drawing", MOST_BYTES)
    if content.startswith(b"\x1f\x8b"):
        raise InputError(f"{path} is a compressed SVG; save it as a plain one")
    too_many = f"{path} has more than {MOST_ELEMENTS} elements; draw it with fewer"
    if content.count(b"<") > 3 * MOST_ELEMENTS:  # most have two, and it is not read for nothing
        raise InputError(too_many)
    parser = etree.XMLParser(
        resolve_entities="internal",  # pyright: ignore[reportArgumentType] - since lxml 5
        no_network=True,
        load_dtd=False,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
    )
    try:
        root = etree.fromstring(content, parser)
    except etree.XMLSyntaxError as error:
        problem = short(error.msg or "it ends too soon", 150)
        if "depth" in problem.lower():
            raise InputError(f"{path} has elements far too deep; ungroup some of them") from None
        if "entity" in problem.lower():
            raise InputError(
                f"{path} has entities that cannot be replaced: {problem}; save it without them"
            ) from None
        raise InputError(f"{path} is not well-formed XML: {problem}") from None
    if sum(1 for _ in root.iter()) > MOST_ELEMENTS:
        raise InputError(too_many)
    if root.tag not in (f"{SVG}svg", "svg"):
        raise InputError(f"{path} is not SVG: it is a document of {short(str(root.tag))}")
    return root


def name_of(element: Element) -> str:
    """Name of an element without its namespace; empty if it is none of SVG's."""
    tag = element.tag
    if not isinstance(tag, str):  # an entity that nothing declares
        return ""
    name = tag.removeprefix(SVG)
    return "" if name.startswith("{") else name


def text_of(element: Element) -> str:
    """All characters within an element."""
    return "".join(map(str, element.itertext()))


def link_of(element: Element) -> str:
    """Reference of an element, such as ``#lake``; empty for none."""
    return (element.get("href") or element.get(_XLINK_HREF) or "").strip()


def target_of(reference: str) -> str:
    """Id in a reference ``url(#id)``; empty if it is another.

    >>> target_of("url( '#lake' ) red"), target_of("url(http://a.b/c)")
    ('lake', '')
    """
    found = re.match(r"""\s*url\(\s*["']?\s*#([^"')]*)""", reference)
    return found[1].strip() if found else ""


def short(text: str, most: int = 60) -> str:
    """Text for a message: printable, on one line and not long."""
    plain = "".join(char if char.isprintable() else " " for char in text)
    return plain if len(plain) <= most else f"{plain[:most]}…"


def plain(text: str, most: int = _LONGEST_NAME) -> str:
    """Text with single spaces, without control characters, and not too long."""
    return short(" ".join(short(text, len(text)).split()), most)


def title_of(element: Element) -> str:
    """Title of an element: its own, or the label that Inkscape gives it; empty for none."""
    label = element.get(f"{INKSCAPE}label") or element.get("aria-label") or ""
    return _said(element, "title", _LONGEST_NAME) or ("" if label[:1] == "#" else plain(label))


def description_of(element: Element) -> str:
    """Description of an element; empty for none."""
    return _said(element, "desc", LONGEST_TEXT)


def _said(element: Element, name: str, most: int) -> str:
    return next((plain(text_of(child), most) for child in element if name_of(child) == name), "")


def id_of(element: Element) -> str:
    """Id that an author gave an element; empty if a program did, or it has none."""
    own = element.get("id") or ""
    return "" if _GIVEN.fullmatch(own) or not own.isprintable() else own[:_LONGEST_NAME]


_NUMBERS = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_LONGEST = 10_000  # characters of a value
# Millimetres of a pixel of CSS, 96 to the inch.
PX_MM = 25.4 / 96
_UNITS = {"": 1.0, "px": 1.0, "pt": 96 / 72, "pc": 16.0, "mm": 96 / 25.4, "cm": 960 / 25.4,
          "in": 96.0, "q": 24 / 25.4, "rem": 16.0,
          "deg": 1.0, "grad": 0.9, "rad": 180 / math.pi, "turn": 360.0}  # fmt: skip
_OF_LETTERS = {"em": 1.0, "ic": 1.0, "ex": 0.5, "ch": 0.5}
# Percentages of the page: its width, its height, and the smaller and the larger of these.
_OF_PAGE = {"vw": 0, "vi": 0, "vh": 1, "vb": 1, "vmin": 2, "vmax": 3}
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
class Style:
    """Values of the properties of an element, and the sizes to which its relative lengths refer.

    Parameters
    ----------
    values
        Values by the names of the properties.
    view
        Width and height of the viewport around in user units, which percentages are of.
    page
        Width and height of the whole drawing, in pixels.
    """

    values: Mapping[str, str]
    view: Point = (1.0, 1.0)
    page: Point = (1.0, 1.0)

    def __getitem__(self, name: str) -> str:
        """Value of a property."""
        return self.values[name]

    @property
    def diagonal(self) -> float:
        """Length to which percentages refer where a length has no direction, such as a radius."""
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
        if token.type == "percentage":
            return token.value * whole / 100
        unit = getattr(token, "lower_unit", "")
        if unit in _OF_LETTERS:
            return token.value * float(self["font-size"]) * _OF_LETTERS[unit]
        if unit in _OF_PAGE:
            return token.value / 100 * (*self.page, *sorted(self.page))[_OF_PAGE[unit]]
        return token.value * _UNITS[unit]

    def _sum(self, tokens: Sequence[Any], whole: float) -> float:
        """Value of numbers with operators between them."""
        shown = _shown(tokens)
        terms = [self.number(shown[0], whole)]
        for operator, token in zip(shown[1::2], shown[2::2], strict=True):
            value = self.number(token, whole)
            if operator == "*":
                terms[-1] *= value
            elif operator == "/":
                terms[-1] /= value
            else:
                terms.append({"+": value, "-": -value}[operator.value])
        return sum(terms)


_PLAIN = Style({"font-size": "16"})


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
    return _PLAIN.length(text, 1.0) is not None


def share_of(text: str) -> float:
    """Opacity, from 0 to 1; 1 if it is not understood."""
    value = _PLAIN.length(text, 1.0)
    return 1.0 if value is None else min(max(value, 0.0), 1.0)


def angle_of(text: str) -> float:
    """Angle in degrees; 0 if it is not understood.

    >>> angle_of("0.25turn"), angle_of("40grad"), angle_of("wide")
    (90.0, 36.0, 0.0)
    """
    return _PLAIN.length(text, 0.0) or 0.0


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


def transform_of(text: str, style: Style, box: Box) -> AffineMap | None:
    """Map of a transform of SVG or CSS; None if it is not understood.

    Parameters
    ----------
    text
        The transform as it is written.
    style, box
        Style of its element, and the box that percentages are of.
    """
    whole = AffineMap()
    try:
        for function in tokens_of(re.sub(r"\s+\(", "(", text)) or [None]:
            if function == ",":
                continue
            kind = function.lower_name
            tokens = [token for one in arguments_of(function) for token in one]
            wholes = (box[3:] if kind == "translatey" else box[2:]) + (1.0,) * len(tokens)
            numbers = map(style.number, tokens, wholes)
            whole = whole @ _TRANSFORMS[kind](*numbers)
    except NOT_UNDERSTOOD:
        return None
    return whole


def origin_of(text: str, style: Style, box: Box) -> complex | None:
    """Place of a transform-origin; None if it is not understood."""
    words = text.split()[:2]
    if words[0] in ("top", "bottom") or words[1:] in (["left"], ["right"]):
        words.reverse()
    words = [*words, "center"][:2]
    x, y = (
        style.length(_ORIGINS.get(word, word), whole)
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


Declaration = tuple[str, str, bool]  # property, value, and whether it is important


def _is_list(text: str) -> bool:
    return text == "none" or all(map(is_length, re.split(r"[\s,]+", text[:10_000])))


def _is_size(text: str) -> bool:
    return text == "auto" or is_length(text)


# Properties that count, each with its value where none is written, and with the check of its values
# or the words that they may be; None for any. A declaration with a value that is not understood
# counts as not written, so that the one below it in the cascade holds.
_INHERITED: dict[str, tuple[str, Any]] = {
    "color": ("black", is_paint),
    "fill": ("black", is_paint),
    "stroke": ("none", is_paint),
    **dict.fromkeys(("fill-opacity", "stroke-opacity", "stroke-width"), ("1", is_length)),
    "font-size": ("16", is_length),
    **dict.fromkeys(("fill-rule", "clip-rule"), ("nonzero", ("nonzero", "evenodd"))),
    "stroke-dasharray": ("none", _is_list),
    "text-anchor": ("start", ("start", "middle", "end")),
    "dominant-baseline": ("auto", None),
    "visibility": ("visible", ("visible", "hidden", "collapse")),
    **dict.fromkeys(("marker-start", "marker-mid", "marker-end"), ("none", None)),
}
_PROPERTIES = {
    **_INHERITED,
    **dict.fromkeys(("clip-path", "filter", "mask", "transform", "transform-box",
                     "translate", "rotate", "scale", "vector-effect"), ("none", None)),
    "display": ("inline", None),
    "transform-origin": ("0 0", None),
    **dict.fromkeys(("opacity", "stop-opacity"), ("1", is_length)),
    **dict.fromkeys(("x", "y", "cx", "cy", "r"), ("0", is_length)),
    **dict.fromkeys(("rx", "ry", "width", "height"), ("auto", _is_size)),
    "stop-color": ("black", is_paint),
    "overflow": ("visible", ("visible", "hidden", "scroll", "auto")),
}  # fmt: skip
INITIAL = {name: value for name, (value, _) in _PROPERTIES.items()}
_SHORTHANDS = {"marker": ("marker-start", "marker-mid", "marker-end"), "font": ("font-size",)}
# Attributes of these names are something else than the property.
_NO_ATTRIBUTES = frozenset(("rotate", "scale", "translate"))
_HIDING = frozenset(("svg", "symbol", "marker"))  # what is outside of their viewport
_TEXTS = frozenset(("text", "tspan", "tref"))
_MOST_CSS = 500_000  # characters
_MOST_COMBINED = 4  # elements that a selector names, one within or after another
_MOST_MATCHING_S = 1.0  # of processor time
_COMBINATOR = re.compile(r"\s*[>+~]\s*|\s+")
_MEDIA = frozenset(("", "all", "screen"))


@lru_cache(maxsize=10_000)
def _is_understood(name: str, value: str) -> bool:
    _, check = _PROPERTIES[name]
    if check is None or value in ("inherit", "initial", "unset"):
        return bool(value)
    return bool(check(value)) if callable(check) else value in check


@lru_cache(maxsize=10_000)
def _declarations(css: str) -> tuple[list[Declaration], list[Declaration]]:
    """Declarations of properties that count: those that are understood, and the others."""
    understood: list[Declaration] = []
    others: list[Declaration] = []
    for one in tinycss2.parse_blocks_contents(css, skip_comments=True, skip_whitespace=True):
        if one.type != "declaration":
            continue
        parts = one.value
        if one.lower_name == "font":  # its size is the first number with a unit
            parts = [part for part in parts if part.type in ("dimension", "percentage")][:1]
        value = tinycss2.serialize(parts or one.value).strip()
        for name in _SHORTHANDS.get(one.lower_name, (one.lower_name,)):
            if name in _PROPERTIES:
                into = understood if _is_understood(name, value) else others
                into.append((name, value, one.important))
    return understood, others


class StyleSheets:
    """All style sheets of a drawing.

    Parameters
    ----------
    root
        The drawing.
    note
        Function that keeps a remark on an element.

    Raises
    ------
    InputError
        If it takes longer than 1 s of processor time to find whose rules they are.
    """

    def __init__(self, root: Element, note: Callable[[Element, str], None]) -> None:
        self.note = note
        self._matcher = cssselect2.Matcher()
        self._matched: dict[Element, list[Declaration]] = {}
        sheets = [element for element in root.iter() if name_of(element) == "style"]
        for element in sheets:
            css, kind = text_of(element), (element.get("type") or "text/css").strip()
            media = (element.get("media") or "").strip().lower()
            if kind not in ("text/css", "") or media not in _MEDIA or len(css) > _MOST_CSS:
                note(element, f"the style sheet is not CSS for a screen, or has over {_MOST_CSS} "
                     "characters; it is ignored")  # fmt: skip
            else:
                self._take(element, tinycss2.parse_stylesheet(css, True, True))
        start = time.process_time()
        for one in cssselect2.ElementWrapper.from_xml_root(root).iter_subtree() if sheets else ():
            found = [said for *_, rule in self._matcher.match(one) for said in rule]
            self._matched[one.etree_element] = found
            if time.process_time() - start > _MOST_MATCHING_S:
                raise InputError("the style sheet takes too long to apply; simplify it")

    def _take(self, element: Element, rules: Iterable[Any]) -> None:
        """Take rules, and those within @media that hold for a screen."""
        for rule in rules:
            written = tinycss2.serialize(getattr(rule, "prelude", ())).strip()
            if rule.type == "qualified-rule":
                self._add(element, rule, written)
            elif rule.type != "at-rule":
                self.note(element, "a part of the style sheet is not understood; it is ignored")
            elif rule.lower_at_keyword == "media" and written.lower() in _MEDIA:
                self._take(element, tinycss2.parse_rule_list(rule.content or (), True, True))
            elif (rule.lower_at_keyword, written.lower()) != ("media", "print") and (
                rule.lower_at_keyword not in ("charset", "font-face", "namespace")
            ):
                at_rule = short(f"@{rule.at_keyword} {written}")
                self.note(element, f"the style sheet's {at_rule} is ignored")

    def _add(self, element: Element, rule: Any, written: str) -> None:
        """Add a rule to those that elements are matched with."""
        parts = written.split(",")
        if any(len(_COMBINATOR.findall(one.strip())) > _MOST_COMBINED for one in parts):
            self.note(element, f"the style sheet's selector {short(written)!r} is too long")
            return
        try:
            selectors = cssselect2.compile_selector_list(rule.prelude)
        except cssselect2.SelectorError:
            self.note(element, f"the style sheet's selector {short(written)!r} is ignored")
            return
        declared, _ = _declarations(tinycss2.serialize(rule.content))
        for selector in selectors:
            if selector.pseudo_element is None:
                self._matcher.add_selector(selector, declared)

    def of(self, element: Element, above: Style) -> Style:
        """Style of an element in one that has another style."""
        said: list[Declaration] = []
        wrong: list[Declaration] = []
        places = ("x", "y") if name_of(element) in _TEXTS else ()
        for key, value in element.items():
            name, value = str(key), str(value).strip()
            if name in _PROPERTIES and name not in _NO_ATTRIBUTES and name not in places:
                (said if _is_understood(name, value) else wrong).append((name, value, False))
        own, others = _declarations(element.get("style") or "")
        said += [*self._matched.get(element, ()), *own]
        for name, value, _ in [*wrong, *others]:
            if value:
                self.note(
                    element, f"its {name} {short(value, 40)!r} is not understood; it is ignored"
                )
        inherited = {name: above[name] for name in _INHERITED}
        found = INITIAL | inherited
        if name_of(element) in _HIDING and element.getparent() is not None:
            found["overflow"] = "hidden"
        for name, value, _ in sorted(said, key=lambda one: one[2]):
            if value == "inherit":
                found[name] = above[name]
            elif value in ("initial", "unset"):
                found[name] = (INITIAL if value == "initial" else INITIAL | inherited)[name]
            else:
                found[name] = value
        font = float(above["font-size"])
        found["font-size"] = repr(above.length(found["font-size"], font) or font)
        return replace(above, values=found)
