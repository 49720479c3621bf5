"""Styles of SVG's elements: their attributes, style sheets, and what they inherit."""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from vbraille.scene.svg.tree import name_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vbraille.scene.svg.tree import Element

# What counts here; nothing else of a style is looked at, but for what is ignored and said so.
INHERITED = frozenset(
    (
        "color",
        "fill",
        "fill-opacity",
        "fill-rule",
        "font-size",
        "marker",
        "marker-end",
        "marker-mid",
        "marker-start",
        "stroke",
        "stroke-dasharray",
        "stroke-opacity",
        "stroke-width",
        "text-anchor",
        "visibility",
    )
)
OWN = frozenset(("clip-path", "display", "filter", "mask", "opacity"))
_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_SIMPLE = re.compile(r"(\*|[A-Za-z][\w-]*)?((?:[.#][\w-]+)*)")
_PART = re.compile(r"([.#])([\w-]+)")
_BRACE = re.compile(r"[{}]")
_MOST_CSS = 2_000_000  # characters
_MOST_RULES = 1000


@dataclass(slots=True)
class StyleSheet:
    """Rules of a drawing's style sheets.

    Parameters
    ----------
    rules
        For the last class, id or name of each selector, the rules that end with it: what else the
        element must be, how special the rule is, and what it says.
    ignored
        What of the sheets is ignored, each in a few words.
    """

    rules: dict[str, list[_StyleRule]] = field(default_factory=lambda: defaultdict(list))
    ignored: list[str] = field(default_factory=list)
    _count: int = 0

    def add(self, css: str) -> None:
        """Add the rules of a sheet, of which selectors of one element are understood."""
        if len(css) > _MOST_CSS:
            self.ignored.append("the style sheet is longer than 2 million characters; ignored")
            return
        css = _COMMENT.sub("", css).replace("<!--", "").replace("-->", "")
        at = 0
        while (opened := css.find("{", at)) >= 0:
            head = self._without_statements(css[at:opened])
            closed = _end_of_block(css, opened)
            if head.startswith("@"):
                self.ignored.append(f"the style sheet's {head.split()[0][:40]} is ignored")
            else:
                said = declarations(css[opened + 1 : closed])
                for selector in head.split(","):
                    self._add_rule(selector.strip(), said)
            at = closed + 1
        self._without_statements(css[at:])

    def _without_statements(self, head: str) -> str:
        """Text before a block without statements such as @import, which nothing is fetched for."""
        *statements, rest = head.split(";")
        for statement in (*statements, *([rest] if "@import" in rest else [])):
            name = statement.strip().split(None, 1)[:1]
            if name == ["@import"]:
                self.ignored.append("the style sheet's @import is ignored; nothing is fetched")
            elif name and name != ["@charset"]:
                self.ignored.append(f"the style sheet's {name[0][:40]} is ignored")
        return rest.strip()

    def _add_rule(self, selector: str, said: Mapping[str, str]) -> None:
        found = _SIMPLE.fullmatch(selector)
        if found is None or not selector:
            self.ignored.append(f"the style sheet's selector {selector[:40]!r} is ignored")
            return
        if self._count == _MOST_RULES:
            self.ignored.append(
                f"the style sheet's rules after the first {_MOST_RULES} are ignored"
            )
        if self._count >= _MOST_RULES:
            self._count += 1
            return
        parts = _PART.findall(found[2])
        tag = "" if found[1] in (None, "*") else found[1]
        kinds = [kind for kind, _ in parts]
        self._count += 1
        weight = (kinds.count("#"), kinds.count("."), bool(tag), self._count)
        key = f"{parts[-1][0]}{parts[-1][1]}" if parts else tag or "*"
        self.rules[key].append(_StyleRule(weight, tag, frozenset(k + n for k, n in parts), said))

    def said_of(self, element: Element) -> dict[str, str]:
        """Tell what the sheets say of an element, the most special last."""
        if not self.rules:
            return {}
        names = {f".{name}" for name in classes_of(element)}
        if own := element.get("id"):
            names.add(f"#{own}")
        tag = name_of(element)
        found = [
            rule
            for key in (*sorted(names), tag, "*")
            for rule in self.rules.get(key, ())
            if rule.names <= names and rule.tag in ("", tag)
        ]
        said: dict[str, str] = {}
        for rule in sorted(found, key=lambda rule: rule.weight):
            said |= rule.said
        return said


@dataclass(frozen=True, slots=True)
class _StyleRule:
    weight: tuple[int, int, bool, int]
    tag: str
    names: frozenset[str]
    said: Mapping[str, str]


def classes_of(element: Element) -> list[str]:
    """Names of an element's classes, in order."""
    return (element.get("class") or "").split()


def declarations(text: str) -> dict[str, str]:
    """Declarations of a style that count here, by their names."""
    said: dict[str, str] = {}
    for declaration in text.split(";"):
        name, colon, value = declaration.partition(":")
        name = name.strip().lower()
        if colon and (name in INHERITED or name in OWN):
            said[name] = value.replace("!important", "").strip()
    return said


def styled(element: Element, above: Mapping[str, str], sheet: StyleSheet) -> dict[str, str]:
    """Style of an element: what it inherits, its attributes, style sheets, its own style.

    Parameters
    ----------
    element
        The element.
    above
        Style of what it stands in.
    sheet
        The drawing's style sheets.
    """
    own = {str(k): str(v).strip() for k, v in element.items() if k in INHERITED or k in OWN}
    own |= sheet.said_of(element)
    if style := element.get("style"):
        own |= declarations(style)
    style = {name: value for name, value in above.items() if name in INHERITED}
    for name, value in own.items():
        if value == "inherit":
            if name in above:
                style[name] = above[name]
        else:
            style[name] = value
    return style


def _end_of_block(css: str, opened: int) -> int:
    """End of a block of a style sheet, that may have blocks in it."""
    depth = 0
    for found in _BRACE.finditer(css, opened):
        depth += 1 if found[0] == "{" else -1
        if not depth:
            return found.start()
    return len(css)
