"""A word processor's document as a tree of HTML: looks, styles, lists and notes of all formats."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from vbraille.translate.html import tree_blocks
from vbraille.translate.numbering import BULLET, numeral
from vbraille.translate.trees import Element

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from vbraille.translate.blocks import Block
    from vbraille.translate.source import Source

HIDDEN = "hidden"  # among the elements of a look: text that is not shown
_NO_LANGUAGE = frozenset(("", "none", "zxx", "und", "x-none", "mul"))
_LONGEST_CHAIN = 20  # styles that are based on each other
_HEADING = re.compile(r"heading ([1-9])$")
_TITLES = frozenset(("title", "titel", "titre"))
_QUOTES = frozenset(("quote", "intense quote", "block text", "block quote", "quotations"))
_CODES = frozenset(("source code", "html preformatted", "preformatted text", "plain text", "code"))
_BOXES = frozenset("☐☑☒")  # bullets of lists of what is done
_PRIVATE = re.compile("[\uf000-\uf0ff]")  # where fonts of signs have theirs
_PLACE = re.compile(r"%([1-9])")
# Characters of the font Symbol, from 0x41 to 0x7A, and some signs of it and of Wingdings.
_GREEK = "ΑΒΧΔΕΦΓΗΙϑΚΛΜΝΟΠΘΡΣΤΥςΩΞΨΖ[∴]⊥_‾αβχδεφγηιϕκλμνοπθρστυϖωξψζ"
_SYMBOL = dict(enumerate(_GREEK, 0x41)) | dict(
    zip(
        (0x22, 0x24, 0x27, 0x2A, 0x40, 0xA3, 0xA5, 0xAB, 0xAC, 0xAD, 0xAE, 0xAF, 0xB0, 0xB1, 0xB2,
         0xB3, 0xB4, 0xB6, 0xB7, 0xB8, 0xB9, 0xBA, 0xBB, 0xBC, 0xC7, 0xC8, 0xCC, 0xCD, 0xCE, 0xCF,
         0xD1, 0xD2, 0xD3, 0xD4, 0xD5, 0xD6, 0xD7, 0xDB, 0xDE, 0xE5, 0xF2),
        "∀∃∋∗≅≤∞↔←↑→↓°±″≥×∂•÷≠≡≈…∩∪⊂⊆∈∉∇®©™∏√⋅⇔⇒∑∫",
        strict=True,
    )
)  # fmt: skip
_WINGDINGS = {0x6F: "☐", 0x71: "☐", 0xA8: "☐", 0xFE: "☑", 0xFD: "☒", 0xFC: "✔", 0xFB: "✘"}
_WINGDINGS |= {0x4A: "☺", 0x4C: "☹", 0x6C: "●", 0x6E: "■", 0x9F: "•", 0xA7: "▪", 0xDF: "←"}
_WINGDINGS |= {0xE0: "→", 0xE8: "→", 0x28: "☎", 0x2A: "✉", 0xD8: "➢"}
FONTS = {"symbol": _SYMBOL, "wingdings": _WINGDINGS}


@dataclass(frozen=True, slots=True)
class Look:
    """The language of a text, and how it looks.

    Parameters
    ----------
    language
        Tag of the language; empty if nothing is said of it.
    on, off
        Names of HTML's elements for how it looks, and `HIDDEN`; and those that it does not have
        even where the text around it has them.
    font
        Name of a font of signs; empty for another.
    """

    language: str = ""
    on: frozenset[str] = frozenset()
    off: frozenset[str] = frozenset()
    font: str = ""

    def within(self, around: Look) -> Look:
        """Look of text that says this much of itself, inside of text of another look."""
        return Look(
            self.language or around.language,
            (around.on - self.off) | self.on,
            (around.off - self.on) | self.off,
            self.font or around.font,
        )


@dataclass(frozen=True, slots=True)
class Style:
    """A style of paragraphs or of characters, or what a paragraph says of itself.

    Parameters
    ----------
    name
        Name that people know, in lower case.
    based
        Key of the style that it is based on.
    look
        What it says of its text, without the styles below it.
    level
        Level as a heading, 0 for none; None if nothing is said of it.
    listed, at
        Key of the list that its paragraphs are items of, and the level in that, from 0; None if
        nothing is said of them.
    """

    name: str = ""
    based: str = ""
    look: Look = field(default_factory=Look)
    level: int | None = None
    listed: str | None = None
    at: int | None = None


class Styles(dict[str, Style]):
    """Styles of a document by their keys."""

    def chain(self, key: str) -> list[Style]:
        """A style and those that it is based on; nothing for one that is not there."""
        keys: list[str] = []
        while key in self and key not in keys and len(keys) < _LONGEST_CHAIN:
            keys.append(key)
            key = self[key].based
        return [self[key] for key in keys]

    def look(self, key: str) -> Look:
        """Look of a style, with those of the styles that it is based on."""
        look = Look()
        for style in reversed(self.chain(key)):
            look = style.look.within(look)
        return look


def heading_level(styles: list[Style]) -> int:
    """Level of a heading by the styles of a paragraph, its own first; 0 if it is none."""
    for style in styles:
        if style.level is not None:
            return style.level
        found = _HEADING.match(style.name)
        if found is not None:
            return int(found[1])
        if style.name in _TITLES:
            return 1
    return 0


@dataclass(frozen=True, slots=True)
class Level:
    """A level of a list.

    Parameters
    ----------
    form
        Form of its numbers, as of `numeral`, or "bullet", or "none".
    text
        Text around its number, such as "%1.%2)".
    start
        Number of its first item.
    legal
        Whether the numbers of all levels are plain in it.
    """

    form: str
    text: str
    start: int = 1
    legal: bool = False


class Numbering:
    """Counts the items of a list."""

    def __init__(self, levels: dict[int, Level]) -> None:
        self.levels = levels
        self._counts: dict[int, int] = {}

    def restart(self, at: int, number: int | None = None) -> None:
        """Begin a level anew, and those within it; with a number, that is the next item's."""
        self._counts = {level: n for level, n in self._counts.items() if level < at}
        if number is not None:
            self._counts[at] = number - 1

    def marker(self, at: int) -> str:
        """Count an item of a level, and give what stands before it."""
        level = self.levels.get(at, Level("bullet", "•"))
        number = self._counts.get(at, level.start - 1) + 1
        self.restart(at, number + 1)
        if level.form == "none" or (level.form == "bullet" and not level.text.strip()):
            return ""
        if level.form == "bullet":
            return f"{level.text} " if level.text in _BOXES else BULLET

        def numbered(found: re.Match[str]) -> str:
            place = int(found[1]) - 1
            one = self.levels.get(place, level)
            form = "1" if level.legal else one.form
            return numeral(self._counts.get(place, one.start), form)

        label = _PLACE.sub(numbered, level.text).strip()
        return f"{label} " if label else ""


class Draft:
    """The tree that a document becomes, and what can be said of it only when all is read.

    Attributes
    ----------
    body : Element
        Element for the text.
    notes : dict
        Numbers of notes, by their keys, in the order of their first references.
    """

    def __init__(self) -> None:
        self.body = Element("body")
        self.notes: dict[str, str] = {}
        self._counted: Counter[str] = Counter()  # characters of each language

    def say(self, into: Element, text: str, look: Look) -> None:
        """Put text of a look at the end of an element; what ends right before goes on."""
        if not text or HIDDEN in look.on:
            return
        if look.font:
            text = _PRIVATE.sub(lambda found: symbol(ord(found[0]), look.font) or found[0], text)
        self._counted[look.language] += len(text)
        named = [("span", {"lang": look.language})] if look.language else []
        for name, attributes in [*named, *((tag, {}) for tag in sorted(look.on))]:
            last = into.children[-1] if into.children else ""
            if isinstance(last, Element) and (last.name, last.attributes) == (name, attributes):
                into = last
            else:
                into = into.add(name, **attributes)
        into.say(text)

    def refer(self, into: Element, key: str) -> None:
        """Put a reference to a note; notes are numbered by their first references."""
        number = self.notes.setdefault(key, str(len(self.notes) + 1))
        into.add("a", number, role="doc-noteref", href=f"#{key}")

    def note_items(self) -> Iterator[tuple[str, Element]]:
        """Put a list of all notes at the end; give the key and the element of each."""
        if not self.notes:
            return
        listed = self.body.add("section", role="doc-endnotes").add("ol")
        done = 0
        while done < len(self.notes):  # a note may refer to others
            key = list(self.notes)[done]
            yield key, listed.add("li", id=key, role="doc-endnote")
            done += 1

    def blocks(self, source: Source, usual: str) -> Iterator[Block]:
        """Blocks of the document, whose language is that of most of its text."""
        most = self._counted.most_common(1)
        source.language = most[0][0] if most and most[0][0] else usual
        return tree_blocks(source, self.body)


class Flow:
    """Blocks of a body, of a cell, of a note or of a box, one after the other."""

    def __init__(self, into: Element) -> None:
        self._into = into
        self._list: Element | None = None
        self._quote: Element | None = None

    def add(
        self, paragraph: Element, styles: list[Style], level: int, item: tuple[str, int, str] | None
    ) -> None:
        """Add a paragraph.

        Parameters
        ----------
        paragraph
            Element with the paragraph's text.
        styles
            Styles of the paragraph, by which it is a quotation or code.
        level
            Level of a heading, 0 for others.
        item
            For an item of a list: the list's key, the level from 0, and what stands before it.
        """
        if not paragraph.children:
            return
        names = {style.name for style in styles}
        into, quote = self._into, None
        if level:
            paragraph.name = f"h{min(level, 6)}"
            _make_plain(paragraph)
            self._list = None
        elif item is not None:
            key, at, marker = item
            if self._list is None or (self._list.get("class") != key and not at):
                self._list = into.add("ul", class_=key)
            into, paragraph.name = self._list, "li"
            paragraph.attributes |= {"data-level": str(at + 1), "data-marker": marker}
        else:
            self._list = None
            if names & _QUOTES:
                into = quote = self._quote or into.add("blockquote")
                _make_plain(paragraph)
            elif names & _CODES:
                paragraph.name = "pre"
        self._quote = quote
        into.children.append(paragraph)

    def add_table(self, table: Element) -> None:
        """Add a table that has been read."""
        self._list = self._quote = None
        self._into.children.append(table)


def _make_plain(element: Element) -> None:
    """Take out emphasis that all the text has: it is that of a heading or of a quotation."""
    text = "".join(element.text.split())
    for tag in ("b", "i", "u"):
        found = list(element.iter(tag))
        if text and "".join("".join(each.text.split()) for each in found) == text:
            for inner in found:
                inner.name = "span"


def within(holder: Element, names: Collection[str], skipped: Collection[str]) -> Iterator[Element]:
    """Elements of some names in another, whatever holds them there that is not skipped."""
    for element in holder.elements:
        if element.name in names:
            yield element
        elif element.name not in skipped:
            yield from within(element, names, skipped)


def put_picture(into: Element, described: str, what: str = "picture") -> None:
    """Put the text that describes a picture; without one, say what cannot be shown here."""
    if described.strip():
        into.add("img", alt=described.strip())
    elif what == "picture":
        into.add("img")
    else:
        into.add("canvas", aria_label="" if what == "drawing" else what)


def tag_of(language: str, country: str = "") -> str:
    """Tag of a language as a word processor has it; empty if that is no language."""
    language, country = language.strip(), country.strip()
    if language.lower() in _NO_LANGUAGE:
        return ""
    return f"{language}-{country}" if country.lower() not in _NO_LANGUAGE else language


def dublin_core(about: Element, name: str) -> str:
    """Value of the first of Dublin Core's elements with a name; empty if there is none."""
    return next((" ".join(each.text.split()) for each in about.iter(name)), "")


def symbol(code: int, font: str) -> str:
    """Character of a code of a font of signs; empty if it is not known here."""
    plain = code & 0xFF if 0xF000 <= code < 0xF100 else code
    name = font.lower().split(" ")[0]
    if name in FONTS and plain in FONTS[name]:
        return FONTS[name][plain]
    if name == "symbol" and 0x20 <= plain < 0x7F:
        return chr(plain)
    return chr(code) if 0x20 < code < 0xD800 and name not in FONTS else ""
