"""Styles of elements: attributes, style sheets and the style attribute, by the cascade of CSS."""

from __future__ import annotations

import re
import time
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import cssselect2
import tinycss2

from vbraille.errors import InputError
from vbraille.scene.svg.document import name_of, short, text_of
from vbraille.scene.svg.values import is_length, is_paint

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from vbraille.scene.svg.document import Element
    from vbraille.scene.svg.values import Units

Style = dict[str, str]
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
INITIAL: Style = {name: value for name, (value, _) in _PROPERTIES.items()}
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
            css = text_of(element)
            if (element.get("type") or "text/css").strip() not in ("text/css", ""):
                note(element, "the style sheet is not CSS; it is ignored")
            elif (element.get("media") or "").strip().lower() not in _MEDIA:
                note(element, f"the style sheet is for {element.get('media')}; it is ignored")
            elif len(css) > _MOST_CSS:
                note(element, f"the style sheet has over {_MOST_CSS} characters; it is ignored")
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
        found["font-size"] = repr(units.length(found["font-size"], units.font) or units.font)
        return found
