"""Styles of elements: attributes, style sheets and the style attribute, by the cascade of CSS."""

from __future__ import annotations

import re
import time
from typing import TYPE_CHECKING, Any, NamedTuple

from vbraille.errors import InputError
from vbraille.scene.svg.document import name_of, short, text_of
from vbraille.scene.svg.values import is_length, length_of, one_of, paint_of, share_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from vbraille.scene.svg.document import Element
    from vbraille.scene.svg.values import Units

Style = dict[str, str]


def _any(_: str) -> bool:
    return True


def _is_list(text: str) -> bool:
    return text == "none" or all(map(is_length, re.split(r"[\s,]+", text.strip())))


def _is_share(text: str) -> bool:
    return share_of(text) is not None


def _is_paint(text: str) -> bool:
    return paint_of(text) is not None


def _is_size(text: str) -> bool:
    return text == "auto" or is_length(text)


# Properties that count, each with the check of its values; a declaration with a value that is not
# understood counts as not written, so that the one below it in the cascade holds.
_FONT_SIZES = {"xx-small": 9.0, "x-small": 10.0, "small": 13.0, "medium": 16.0, "large": 18.0,
               "x-large": 24.0, "xx-large": 32.0}  # fmt: skip
INHERITED: dict[str, Callable[[str], bool]] = {
    "color": _is_paint,
    "fill": _is_paint,
    "stroke": _is_paint,
    "fill-opacity": _is_share,
    "stroke-opacity": _is_share,
    "fill-rule": one_of("nonzero", "evenodd"),
    "clip-rule": one_of("nonzero", "evenodd"),
    "font-size": lambda text: text in (*_FONT_SIZES, "smaller", "larger") or is_length(text),
    "stroke-width": is_length,
    "stroke-dasharray": _is_list,
    "stroke-linecap": one_of("butt", "round", "square"),
    "stroke-linejoin": one_of("miter", "round", "bevel", "miter-clip", "arcs"),
    "stroke-miterlimit": is_length,
    "text-anchor": one_of("start", "middle", "end"),
    "dominant-baseline": _any,
    "visibility": one_of("visible", "hidden", "collapse"),
    "marker-start": _any,
    "marker-mid": _any,
    "marker-end": _any,
}
OWN: dict[str, Callable[[str], bool]] = {
    "clip-path": _any,
    "display": _any,
    "filter": _any,
    "mask": _any,
    "opacity": _is_share,
    "overflow": one_of("visible", "hidden", "scroll", "auto"),
    "transform": _any,
    "transform-origin": _any,
    "transform-box": _any,
    "translate": _any,
    "rotate": _any,
    "scale": _any,
    "vector-effect": _any,
    **dict.fromkeys(("x", "y", "cx", "cy", "r"), is_length),
    **dict.fromkeys(("rx", "ry", "width", "height"), _is_size),
}
# Attributes of these names are something else than the property.
_NO_ATTRIBUTES = frozenset(("rotate", "scale", "translate"))
_NO_TEXT_ATTRIBUTES = _NO_ATTRIBUTES | {"x", "y"}
_TEXTS = frozenset(("text", "tspan", "tref"))
_MARKERS = ("marker-start", "marker-mid", "marker-end")
_MOST_CSS = 2_000_000  # characters
_MOST_RULES = 1000
_MOST_COMBINED = 4  # elements that a selector names, one within or after another
_MOST_MATCHING_S = 2.0  # of processor time
_COMBINATOR = re.compile(r"\s*[>+~]\s*|\s+")
_MEDIA = frozenset(("", "all", "screen"))


class Declared(NamedTuple):
    """A declaration that is understood."""

    name: str
    value: str
    important: bool


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
        If it takes longer than 2 s of processor time to find whose rules they are.
    """

    def __init__(self, root: Element, note: Callable[[Element, str], None]) -> None:
        import cssselect2

        self._note = note
        self._matcher = cssselect2.Matcher()
        self._count = 0
        self._understood: dict[tuple[str, str], bool] = {}
        self._own: dict[str, list[Declared]] = {}
        for element in root.iter():
            if name_of(element) == "style":
                self._read(element)
        self._matched: dict[Element, list[Declared]] = {}
        if self._count:
            self._match(root)

    def _read(self, element: Element) -> None:
        """Take the rules of an element ``style``."""
        import tinycss2

        css = text_of(element)
        if (element.get("type") or "text/css").strip() not in ("text/css", ""):
            self._note(element, "the style sheet is not CSS; it is ignored")
        elif (element.get("media") or "").strip().lower() not in _MEDIA:
            self._note(element, f"the style sheet is for {element.get('media')}; it is ignored")
        elif len(css) > _MOST_CSS:
            self._note(element, "the style sheet has more than 2 million characters; it is ignored")
        else:
            rules = tinycss2.parse_stylesheet(css, skip_comments=True, skip_whitespace=True)
            self._take(element, rules)

    def _take(self, element: Element, rules: Iterable[Any]) -> None:
        """Take rules, and those within @media that hold for a screen."""
        import tinycss2

        for rule in rules:
            if rule.type == "at-rule" and rule.lower_at_keyword == "media" and rule.content:
                media = tinycss2.serialize(rule.prelude).strip().lower()
                if media in _MEDIA:
                    self._take(element, tinycss2.parse_rule_list(rule.content, True, True))
                elif media != "print":
                    self._note(element, f"the style sheet's @media {short(media)} is ignored")
            elif rule.type == "at-rule":
                if rule.lower_at_keyword == "import":
                    self._note(element, "the style sheet's @import is ignored; nothing is fetched")
                elif rule.lower_at_keyword not in ("charset", "font-face", "namespace"):
                    self._note(element, f"the style sheet's @{rule.at_keyword} is ignored")
            elif rule.type == "qualified-rule":
                self._add(element, rule)
            else:
                self._note(element, "a part of the style sheet is not understood; it is ignored")

    def _add(self, element: Element, rule: Any) -> None:
        """Add a rule to those that elements are matched with."""
        import cssselect2
        import tinycss2

        written = tinycss2.serialize(rule.prelude).strip()
        try:
            selectors = list(cssselect2.compile_selector_list(rule.prelude))
        except cssselect2.SelectorError:
            self._note(element, f"the style sheet's selector {short(written)!r} is ignored")
            return
        if any(
            len(_COMBINATOR.findall(one.strip())) > _MOST_COMBINED for one in written.split(",")
        ):
            self._note(element, f"the style sheet's selector {short(written)!r} is too long")
            return
        declared = self._declarations(rule.content)
        for selector in selectors:
            self._count += 1
            if self._count == _MOST_RULES + 1:
                self._note(
                    element, f"the style sheet's rules after the first {_MOST_RULES} are ignored"
                )
            if self._count <= _MOST_RULES and selector.pseudo_element is None:
                self._matcher.add_selector(selector, declared)

    def _declarations(self, content: Any, element: Element | None = None) -> list[Declared]:
        """Declarations that are understood; the others of an element's own style are noted."""
        import tinycss2

        found: list[Declared] = []
        for one in tinycss2.parse_blocks_contents(
            content, skip_comments=True, skip_whitespace=True
        ):
            if one.type == "declaration":
                value = tinycss2.serialize(one.value).strip()
                declared = self._declared(one.lower_name, value, important=one.important)
                if not declared and element is not None and one.lower_name in (*INHERITED, *OWN):
                    self._note(element, _not_understood(one.lower_name, value))
                found += declared
        return found

    def _declared(self, name: str, value: str, *, important: bool = False) -> list[Declared]:
        """Declarations of a property or a shorthand; none if the value is not understood."""
        if name == "marker":
            return [Declared(one, value, important) for one in _MARKERS]
        if name == "font":
            size = next((w.partition("/")[0] for w in value.split() if _is_font_size(w)), "")
            return [Declared("font-size", size, important)] if size else []
        check = INHERITED.get(name) or OWN.get(name)
        if check is None:
            return []
        known = (name, value)
        if known not in self._understood:
            if len(self._understood) > _MOST_RULES:
                self._understood.clear()
            self._understood[known] = value in ("inherit", "initial", "unset") or check(value)
        return [Declared(name, value, important)] if self._understood[known] else []

    def _match(self, root: Element) -> None:
        """Find the declarations of all elements."""
        import cssselect2

        start = time.process_time()
        for wrapper in cssselect2.ElementWrapper.from_xml_root(root).iter_subtree():
            found = self._matcher.match(wrapper)
            if found:
                self._matched[wrapper.etree_element] = [one for *_, said in found for one in said]
            if time.process_time() - start > _MOST_MATCHING_S:
                raise InputError("the style sheet takes too long to apply; simplify it")

    def of(self, element: Element, above: Mapping[str, str], units: Units) -> Style:
        """Style of an element.

        Parameters
        ----------
        element
            The element.
        above
            Style of the element around it.
        units
            Sizes that lengths of its letters are of.
        """
        said: list[Declared] = []
        others = _NO_ATTRIBUTES if name_of(element) not in _TEXTS else _NO_TEXT_ATTRIBUTES
        for key, value in element.items():
            name, text = str(key), str(value).strip()
            if (name in INHERITED or name in OWN) and name not in others:
                declared = self._declared(name, text)
                said += declared
                if not declared and text:
                    self._note(element, _not_understood(name, text))
        said += self._matched.get(element, [])
        if style := element.get("style"):
            if style not in self._own:
                self._own[style] = self._declarations(style, element)
            said += self._own[style]
        said.sort(key=lambda one: one.important)
        found = {name: value for name, value in above.items() if name in INHERITED}
        for name, value, _ in said:
            if value == "inherit" or (value == "unset" and name in INHERITED):
                value = above.get(name, "initial")
            if value in ("initial", "unset"):
                found.pop(name, None)
                if name == "overflow":  # without a style, drawings in drawings hide what is outside
                    found[name] = "visible"
            else:
                found[name] = value
        size = _font_size(found.get("font-size"), units)
        if size is not None:
            found["font-size"] = size
        return found


def _not_understood(name: str, value: str) -> str:
    return f"its {name} {short(value, 40)!r} is not understood; it is ignored"


def _is_font_size(word: str) -> bool:
    size = word.partition("/")[0]
    return size in _FONT_SIZES or (is_length(size) and not size.isdigit())


def _font_size(text: str | None, units: Units) -> str | None:
    """Size of letters in user units, as a text that an element within can inherit."""
    if text is None:
        return None
    size = _FONT_SIZES.get(text)
    if size is None:
        share = {"smaller": 1 / 1.2, "larger": 1.2}.get(text)
        size = share * units.font if share else length_of(text, units.font, units)
    return None if size is None or size < 0 else repr(size)
