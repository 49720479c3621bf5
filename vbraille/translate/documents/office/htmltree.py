"""A word processor's document as a tree of HTML, which the reader of HTML makes into blocks."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from lxml import etree

if TYPE_CHECKING:
    from collections import Counter
    from collections.abc import Iterable, Iterator

    from lxml.etree import _Element as Element

_NO_LANGUAGE = frozenset(("", "none", "zxx", "und", "x-none", "mul"))
_LONGEST_CHAIN = 20  # styles that are based on each other
HEADING = re.compile(r"heading ([1-9])$", re.I)
QUOTES = frozenset(("quote", "intense quote", "block text", "block quote", "quotations"))
CODES = frozenset(("source code", "html preformatted", "preformatted text", "plain text", "code"))
# Characters of the font Symbol, from 0x41 to 0x7A, and some signs of it and of Wingdings.
_GREEK = "ΑΒΧΔΕΦΓΗΙϑΚΛΜΝΟΠΘΡΣΤΥςΩΞΨΖ[∴]⊥_‾αβχδεφγηιϕκλμνοπθρστυϖωξψζ"
_SYMBOL = {0xA3: "≤", 0xA5: "∞", 0xAC: "←", 0xAD: "↑", 0xAE: "→", 0xAF: "↓", 0xB0: "°", 0xB1: "±"}
_SYMBOL |= {0xB2: "″", 0xB3: "≥", 0xB4: "×", 0xB7: "•", 0xB8: "÷", 0xB9: "≠", 0xBA: "≡", 0xBB: "≈"}
_SYMBOL |= {0xC7: "∩", 0xC8: "∪", 0xCC: "⊂", 0xCE: "∈", 0xD6: "√", 0xE5: "∑", 0xF2: "∫"}
_WINGDINGS = {0x6F: "☐", 0x71: "☐", 0xA8: "☐", 0xFE: "☑", 0xFD: "☒", 0xFC: "✓", 0xFB: "✗"}
_WINGDINGS |= {0x4A: "☺", 0x4C: "☹", 0x9F: "•", 0xA7: "▪", 0xDF: "←", 0xE0: "→", 0xE8: "→"}
_FONTS = {"symbol": _SYMBOL, "wingdings": _WINGDINGS}
_LONGEST_TEXT = 4_096  # characters
DEEPEST = 60  # lists, quotations and tables in each other


def put(parent: Element, name: str, text: str = "", **attributes: str) -> Element:
    """Put an element with a text at the end of another; "_" in attributes' names stands for "-"."""
    named = {name.strip("_").replace("_", "-"): value for name, value in attributes.items()}
    element = etree.SubElement(parent, name, named)
    element.text = text or None
    return element


def last_of(parent: Element) -> Element | None:
    """Last element in another, however many there are."""
    return next(parent.iterchildren(reversed=True), None)


def put_text(parent: Element, text: str) -> None:
    """Put text at the end of an element."""
    last = last_of(parent)
    before = (parent.text if last is None else last.tail) or ""
    if len(before) > _LONGEST_TEXT:  # which would be copied for each piece
        put(parent, "span", text)
    elif last is None:
        parent.text = before + text
    else:
        last.tail = before + text


def put_page(parent: Element, number: str = "") -> None:
    """Say that a page of the printed document begins here."""
    put(parent, "span", role="doc-pagebreak", aria_label=number)


def put_unshown(parent: Element, what: str) -> None:
    """Say that something stands here that cannot be shown."""
    names = {"picture": "img", "drawing": "canvas", "symbol": "symbol"}
    if what in names:
        put(parent, names[what])
    else:
        put(parent, "canvas", aria_label=what)


def remove(element: Element) -> None:
    """Take an element out, with the text after it."""
    around = element.getparent()
    if around is not None:
        around.remove(element)


def put_inner(
    parent: Element, styles: Iterable[str], language: str = "", *, without: Iterable[str] = ()
) -> Element:
    """Put elements of these names within each other, but for some; give the innermost.

    What ends right before goes on, if it is the same.
    """
    left_out = frozenset(without)
    names = [style for style in styles if style not in left_out]
    for name in ["span"] * bool(language) + names:
        attributes = {"lang": language} if name == "span" else {}
        last = last_of(parent)
        is_same = (
            last is not None
            and last.tag == name
            and not last.tail
            and dict(last.attrib) == attributes
        )
        parent = last if last is not None and is_same else put(parent, name, **attributes)
    return parent


def unwrap(cell: Element) -> None:
    """Have a cell of nothing but paragraphs hold their text, with line breaks between."""
    paragraphs = list(cell)
    if any(child.tag != "p" for child in paragraphs):
        return
    for paragraph in paragraphs:
        cell.remove(paragraph)
    for number, paragraph in enumerate(paragraphs):
        if number:
            put(cell, "br")
        put_text(cell, paragraph.text or "")
        cell.extend(list(paragraph))


class Notes:
    """Notes of a document, numbered by their first references."""

    def __init__(self) -> None:
        self._numbers: dict[str, str] = {}

    def refer(self, parent: Element, identity: str) -> bool:
        """Put a reference to a note; tell whether it is the first to it."""
        first = identity not in self._numbers
        number = self._numbers.setdefault(identity, str(len(self._numbers) + 1))
        put(parent, "a", number, role="doc-noteref", href=f"#{identity}")
        return first

    def section(self, body: Element) -> Iterator[tuple[str, Element]]:
        """Put a section of all notes at the end; give the name and the element of each."""
        if not self._numbers:
            return
        listed = put(put(body, "section", role="doc-endnotes"), "ol")
        done = 0
        while done < len(self._numbers):  # a note may refer to others
            identity = list(self._numbers)[done]
            yield identity, put(listed, "li", id=identity, role="doc-endnote")
            done += 1


class Pictures:
    """The text of a picture that stands alone, which its caption often repeats."""

    def __init__(self) -> None:
        self._said = ""

    def repeats(self, paragraph: Element) -> bool:
        """Tell whether a paragraph only repeats the text of the picture before it."""
        said, self._said = self._said, ""
        only = paragraph[0] if len(paragraph) == 1 and not paragraph.text else None
        if only is not None and only.tag == "img" and not only.tail:
            self._said = only.get("alt", "").strip()
        return bool(said) and "".join(map(str, paragraph.itertext())).strip() == said


def tag_of(language: str | None, country: str | None = None) -> str:
    """Tag of a language as a word processor has it; empty if that is no language."""
    language = (language or "").strip()
    if language.lower() in _NO_LANGUAGE:
        return ""
    country = (country or "").strip()
    return f"{language}-{country}" if country.lower() not in _NO_LANGUAGE else language


def primary(tag: str) -> str:
    """First part of a tag: the language without its country."""
    return tag.replace("_", "-").partition("-")[0].lower()


def most_frequent(counted: Counter[str], otherwise: str) -> str:
    """Tag of the language that most characters are in; the other tag if none was counted."""
    most = counted.most_common(1)
    return most[0][0] if most and most[0][1] else otherwise


def chain(name: str, based: dict[str, str]) -> list[str]:
    """Names of a style and of those that it is based on."""
    names: list[str] = []
    while name in based and name not in names and len(names) < _LONGEST_CHAIN:
        names.append(name)
        name = based[name]
    return names


def told(about: Element | None, name: str) -> str:
    """Value of the first of Dublin Core's elements with a name."""
    found = None if about is None else about.find(f".//{{http://purl.org/dc/elements/1.1/}}{name}")
    return "" if found is None else " ".join("".join(map(str, found.itertext())).split())


def field_target(instruction: str) -> str:
    """Address of the link that a field makes of its text; empty if it makes none."""
    words = instruction.split()
    if not words or words[0].upper() != "HYPERLINK":
        return ""
    told = [word.strip('"') for word in words[1:] if not word.startswith("\\") or word == "\\l"]
    if "\\l" in told:
        place = told.index("\\l")
        return f"{''.join(told[:place])}#{''.join(told[place + 1 : place + 2])}"
    return told[0] if told else ""


def symbol(code: int, font: str) -> str:
    """Character of a code of a font of signs; empty if it is not known here."""
    plain = code & 0xFF if 0xF000 <= code < 0xF100 else code
    name = font.lower().split(" ")[0]
    if name == "symbol" and 0x41 <= plain < 0x41 + len(_GREEK):
        return _GREEK[plain - 0x41]
    if name in _FONTS and plain in _FONTS[name]:
        return _FONTS[name][plain]
    if name == "symbol" and 0x20 < plain < 0x41:
        return chr(plain)
    return chr(code) if 0x20 < code < 0xD800 and name not in _FONTS else ""
