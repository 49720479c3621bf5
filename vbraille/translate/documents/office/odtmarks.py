"""Languages, small letters and pages in the XML of an ODT file, as annotations."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import count
from typing import TYPE_CHECKING

from vbraille.translate.documents.office.annotations import Languages, annotation, primary, tag_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element

_OASIS = "{urn:oasis:names:tc:opendocument:xmlns:"
_TEXT = f"{_OASIS}text:1.0}}"
_STYLE = f"{_OASIS}style:1.0}}"
_FO = f"{_OASIS}xsl-fo-compatible:1.0}}"
_PARAGRAPHS = (f"{_TEXT}p", f"{_TEXT}h")
_BREAK = f"{_TEXT}soft-page-break"
_LONGEST_CHAIN = 20  # styles that are based on each other
_DEEPEST = 200  # spans in each other


@dataclass(frozen=True, slots=True)
class _Look:
    """What styles say of a text."""

    language: str = ""
    small: str = ""
    underline: bool = False

    def with_style(self, other: _Look) -> _Look:
        """Look of text that has another style inside of this one."""
        return _Look(
            other.language or self.language,
            other.small or self.small,
            self.underline or other.underline,
        )


@dataclass(slots=True)
class _Styles:
    """Looks by the names of styles, and which of these begin a page."""

    looks: dict[str, _Look] = field(default_factory=dict)
    breaking: set[str] = field(default_factory=set)
    usual: _Look = _Look()


def mark_odt(roots: list[_Element], styles: _Element | None, language: str) -> str:
    """Annotate the text of a document.

    Parameters
    ----------
    roots
        The document, alone; it is changed.
    styles
        Common styles, if there are any.
    language
        Tag of the document's language as its metadata have it; empty if they do not say.

    Returns
    -------
    str
        Tag of the language that most of the text is in; empty if nothing says.
    """
    (root,) = roots
    found = _read_styles([holder for holder in (styles, root) if holder is not None])
    usual = found.usual.language or language
    around = replace(found.usual, language=usual)
    places = [
        place
        for paragraph in root.iter(*_PARAGRAPHS)
        for place in _texts(paragraph, around, found.looks, 0)
    ]
    languages = Languages()
    for holder, is_tail, look in places:
        languages.count(look.language, len((holder.tail if is_tail else holder.text) or ""))
    most = languages.most(usual)
    for holder, is_tail, look in places:
        words = _words(look, most)
        text = holder.tail if is_tail else holder.text
        if words and text:
            marked = annotation(words, text)
            if is_tail:
                holder.tail = marked
            else:
                holder.text = marked
    _mark_pages(root, found.breaking)
    return most


def _words(look: _Look, most: str) -> list[str]:
    words = [look.small] if look.small else []
    if look.underline:
        words.append("u")
    if look.language and primary(look.language) != primary(most):
        words.append(f"lang={look.language}")
    return words


def _read_styles(holders: list[_Element]) -> _Styles:
    found = _Styles()
    based: dict[str, str] = {}
    for holder in holders:
        for style in holder.iter(f"{_STYLE}default-style"):
            if style.get(f"{_STYLE}family") == "paragraph":
                found.usual = _look(style)
        for style in holder.iter(f"{_STYLE}style"):
            name = style.get(f"{_STYLE}name", "")
            found.looks[name] = _look(style)
            based[name] = style.get(f"{_STYLE}parent-style-name", "")
            properties = style.find(f"{_STYLE}paragraph-properties")
            broken = properties is not None and properties.get(f"{_FO}break-before") == "page"
            if broken or style.get(f"{_STYLE}master-page-name"):
                found.breaking.add(name)
    for name in list(found.looks):
        look, at = found.looks[name], based.get(name, "")
        for _ in range(_LONGEST_CHAIN):
            if at not in based:
                break
            look, at = found.looks[at].with_style(look), based[at]
        found.looks[name] = look
    return found


def _look(style: _Element) -> _Look:
    properties = style.find(f"{_STYLE}text-properties")
    if properties is None:
        return _Look()
    position = properties.get(f"{_STYLE}text-position", "").split()[:1]
    raised = position[0] if position else ""
    small = "sub" if raised.startswith(("sub", "-")) else "sup" if raised == "super" else ""
    if not small and raised.rstrip("%").isdigit() and raised != "0%":
        small = "sup"
    line = properties.get(f"{_STYLE}text-underline-style", "none")
    tag = tag_of(properties.get(f"{_FO}language"), properties.get(f"{_FO}country"))
    return _Look(tag, small, line != "none")


def _texts(
    element: _Element, around: _Look, looks: dict[str, _Look], depth: int
) -> Iterator[tuple[_Element, bool, _Look]]:
    """Texts of a paragraph: the element that holds each, whether after its end, and its look."""
    look = around.with_style(looks.get(element.get(f"{_TEXT}style-name", ""), _Look()))
    yield element, False, look
    for child in element:
        if child.tag in (f"{_TEXT}span", f"{_TEXT}a") and depth < _DEEPEST:
            yield from _texts(child, look, looks, depth + 1)
        yield child, True, look


def _mark_pages(root: _Element, breaking: set[str]) -> None:
    """Annotate where pages begin; with numbers where the word processor laid out the document."""
    laid = next(root.iter(_BREAK), None) is not None
    numbers = count(2)
    pending, first = "", True
    for element in list(root.iter(_BREAK, *_PARAGRAPHS)):
        is_break = element.tag == _BREAK
        broken = not first and element.get(f"{_TEXT}style-name", "") in breaking
        if is_break or broken:
            mark = annotation([f"page={next(numbers)}" if laid else "page="])
            parent = element.getparent()
            if (
                is_break
                and parent is not None
                and parent.tag.startswith(_TEXT)
                and (parent.tag in (*_PARAGRAPHS, f"{_TEXT}span"))
            ):
                element.tail = mark + (element.tail or "")
                continue
            pending += mark
        if not is_break:
            first = False
            if pending:
                element.text, pending = pending + (element.text or ""), ""
