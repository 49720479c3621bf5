"""A word processor's document as a tree of HTML, which the reader of HTML makes into blocks."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING

from lxml import etree

from vbraille.translate.documents.markup.tables import BULLET, numeral

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from lxml.etree import _Element as Element

_NO_LANGUAGE = frozenset(("", "none", "zxx", "und", "x-none", "mul"))
_LONGEST_CHAIN = 20  # styles that are based on each other
_HEADING = re.compile(r"heading ([1-9])$", re.I)
_TITLES = frozenset(("title", "titel", "titre"))
_QUOTES = frozenset(("quote", "intense quote", "block text", "block quote", "quotations"))
_CODES = frozenset(("source code", "html preformatted", "preformatted text", "plain text", "code"))
_BOXES = frozenset("☐☑☒")  # bullets of lists of what is done
_PLACE = re.compile(r"%([1-9])")
# Characters of the font Symbol, from 0x41 to 0x7A, and some signs of it and of Wingdings.
_GREEK = "ΑΒΧΔΕΦΓΗΙϑΚΛΜΝΟΠΘΡΣΤΥςΩΞΨΖ[∴]⊥_‾αβχδεφγηιϕκλμνοπθρστυϖωξψζ"
_SYMBOL = {0xA3: "≤", 0xA5: "∞", 0xAC: "←", 0xAD: "↑", 0xAE: "→", 0xAF: "↓", 0xB0: "°", 0xB1: "±"}
_SYMBOL |= {0xB2: "″", 0xB3: "≥", 0xB4: "×", 0xB7: "•", 0xB8: "÷", 0xB9: "≠", 0xBA: "≡", 0xBB: "≈"}
_SYMBOL |= {0xC7: "∩", 0xC8: "∪", 0xCC: "⊂", 0xCE: "∈", 0xD6: "√", 0xE5: "∑", 0xF2: "∫"}
_WINGDINGS = {0x6F: "☐", 0x71: "☐", 0xA8: "☐", 0xFE: "☑", 0xFD: "☒", 0xFC: "✓", 0xFB: "✗"}
_WINGDINGS |= {0x4A: "☺", 0x4C: "☹", 0x9F: "•", 0xA7: "▪", 0xDF: "←", 0xE0: "→", 0xE8: "→"}
_FONTS = {"symbol": _SYMBOL, "wingdings": _WINGDINGS}
_LONGEST_TEXT = 4_096  # characters
_UNSHOWN = {
    "picture": "img",
    "drawing": "canvas",
    "symbol": "symbol",
    "embedded object": "object",
    "form field": "input",
}
HIDDEN = "hidden"  # among the elements of a look: text that is not shown


@dataclass(frozen=True, slots=True)
class Look:
    """The language of a text, and how it looks.

    Parameters
    ----------
    language
        Tag of the language; empty if nothing is said of it.
    tags
        Names of HTML's elements for how it looks, and `HIDDEN`.
    without
        Those that it does not have even where the text around it has them.
    """

    language: str = ""
    tags: frozenset[str] = frozenset()
    without: frozenset[str] = frozenset()

    def within(self, around: Look) -> Look:
        """Look of text that says this much of itself, inside of text of another look."""
        return Look(
            self.language or around.language,
            (around.tags - self.without) | self.tags,
            (around.without - self.tags) | self.without,
        )


PLAIN = Look()


@dataclass(frozen=True, slots=True)
class TextStyle:
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
    begins_page
        Whether its paragraphs begin a page.
    """

    name: str = ""
    based: str = ""
    look: Look = PLAIN
    level: int | None = None
    listed: str | None = None
    at: int | None = None
    begins_page: bool = False


class Styles(dict[str, TextStyle]):
    """Styles of a document by their keys."""

    def __init__(self) -> None:
        super().__init__()
        self._looks: dict[str, Look] = {}

    def chain(self, key: str) -> list[TextStyle]:
        """List a style and those that it is based on; nothing for one that is not there."""
        keys: list[str] = []
        while key in self and key not in keys and len(keys) < _LONGEST_CHAIN:
            keys.append(key)
            key = self[key].based
        return [self[key] for key in keys]

    def look(self, key: str) -> Look:
        """Look of text in a style, by all that it is based on."""
        if key not in self._looks:
            look = PLAIN
            for style in reversed(self.chain(key)):
                look = style.look.within(look)
            self._looks[key] = look
        return self._looks[key]


def heading_level(styles: Iterable[TextStyle]) -> int:
    """Level of a heading by what its styles say, the nearest first; 0 for what is none."""
    for style in styles:
        found = _HEADING.search(style.name)
        if found is not None:
            return int(found[1])
        if style.level is not None:
            return style.level
        if style.name in _TITLES:
            return 1
    return 0


@dataclass(frozen=True, slots=True)
class Level:
    """A level of a list.

    Parameters
    ----------
    form
        TextStyle of its numbers: "1", "a", "A", "i" or "I"; "bullet", or "none" for further
        paragraphs of the items above.
    text
        Bullet, or text around the numbers, as "%1.%2)".
    start
        Number of the first item.
    """

    form: str
    text: str
    start: int = 1


_BULLETS = Level("bullet", "•")


class Numbering:
    """Numbers of the items of a list, by its levels, which count from 0."""

    def __init__(self, levels: Mapping[int, Level]) -> None:
        self.levels = levels
        self._counts: dict[int, int] = {}

    def restart(self, at: int) -> None:
        """Begin a level anew, and those within it."""
        self._counts = {level: n for level, n in self._counts.items() if level < at}

    def marker(self, at: int, number: int | None = None) -> str | None:
        """Count an item, and give what stands before it; None for a further paragraph of the last.

        Parameters
        ----------
        at
            Level of the item.
        number
            Number of the item, if that is not the next one.
        """
        level = self.levels.get(at, _BULLETS)
        if level.form == "none" or (level.form == "bullet" and not level.text.strip()):
            return None
        count = self._counts.get(at, level.start - 1) + 1
        self.restart(at)
        self._counts[at] = count if number is None else number
        if level.form == "bullet":
            return f"{level.text} " if level.text in _BOXES else BULLET

        def numbered(found: re.Match[str]) -> str:
            place = int(found[1]) - 1
            one = self.levels.get(place, level)
            return numeral(self._counts.get(place, one.start), one.form)

        label = _PLACE.sub(numbered, level.text).strip()
        return f"{label} " if label else ""


class OfficeTable:
    """A table that is being read, row by row.

    Attributes
    ----------
    column : int
        Column of the row's next cell.
    """

    def __init__(self) -> None:
        self._table = self._line = etree.Element("table")
        self._cells: list[Element] = []
        self._above: dict[int, Element] = {}  # cells that may go on in the next row
        self._name = "td"
        self.column = 0

    def row(self, *, is_head: bool) -> None:
        """Begin a row."""
        self._name, self.column = "th" if is_head else "td", 0
        self._line = put(put(self._table, "thead") if is_head else self._table, "tr")

    def cell(
        self, columns: int, *, rows: int = 1, goes_on: bool = False, cell: Element | None = None
    ) -> Element:
        """Add a cell.

        Parameters
        ----------
        columns, rows
            Size of the cell.
        goes_on
            Whether it is a part of the cell above, whose text is that one's.
        cell
            Element with the cell's text; a new one if there is none yet.

        Returns
        -------
        Element
            Element for the cell's text.
        """
        cell = etree.Element("td") if cell is None else cell
        above = self._above.get(self.column) if goes_on else None
        if above is not None:
            _widen(above, "rowspan", 1)
        else:
            cell.tag = self._name
            _widen(cell, "colspan", columns - 1)
            _widen(cell, "rowspan", rows - 1)
            self._line.append(cell)
            self._cells.append(cell)
            self._above[self.column] = cell
        self.column += columns
        return cell

    def widen(self, columns: int) -> None:
        """Give the last cell of the row so many more columns."""
        _widen(self._cells[-1], "colspan", columns)
        self.column += columns

    def finish(self) -> Element:
        """Give the table; one of a single cell is but a box around its text."""
        if len(self._cells) <= 1:
            for element in (self._table, *self._table, *chain(*self._table), *self._cells):
                element.tag = "div"
            return self._table
        for cell in self._cells:
            _unwrap(cell)
            if cell.tag == "th":
                _make_plain(cell)
        return self._table


class BlockFlow:
    """Blocks of a body, of a cell, of a note or of a box, one after the other.

    Parameters
    ----------
    into
        Element that they are put into.
    """

    def __init__(self, into: Element) -> None:
        self.into = into
        self._items: list[Element] = []  # of the lists that are open, by level
        self._picture = ""  # text of a picture that stood alone, which its caption often repeats

    def add(
        self,
        paragraph: Element,
        styles: Sequence[TextStyle] = (),
        level: int = 0,
        item: tuple[str, int, str | None] | None = None,
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
            For an item of a list: the list's key, the level from 0, and what stands before the
            item; None for a further paragraph of the last one.
        """
        said, self._picture = self._picture, ""
        text = "".join(map(str, paragraph.itertext())).strip()
        if len(paragraph) == 1 and not text and paragraph[0].tag == "img":
            self._picture = paragraph[0].get("alt", "")
        if not level and item is None and (text == said if text else not len(paragraph)):
            return
        into = self.into
        names = frozenset(style.name for style in styles)
        if item is not None and not level:
            into = self._item(*item)
        else:
            self._items = []
        if level:
            paragraph.tag = f"h{min(level, 6)}"
        elif item is None and not _QUOTES.isdisjoint(names):
            last = last_of(into)
            is_same = last is not None and last.tag == "blockquote"
            into = last if last is not None and is_same else put(into, "blockquote")
        elif item is None and not _CODES.isdisjoint(names):
            paragraph.tag = "pre"
        if level or into.tag == "blockquote":
            _make_plain(paragraph)
        into.append(paragraph)

    def _item(self, key: str, at: int, marker: str | None) -> Element:
        """Begin an item of a list, or go on with the last one."""
        if marker is None:
            return self._items[min(at, len(self._items) - 1)] if self._items else self.into
        listed = self._items[at].getparent() if at < len(self._items) else None
        del self._items[at:]
        while len(self._items) < at:  # levels that are left out
            self._items.append(self._items[-1] if self._items else self.into)
        if listed is None or listed.get("class") != key:
            listed = put(self._items[-1] if self._items else self.into, "ul", class_=key)
        self._items.append(put(listed, "li", data_marker=marker))
        return self._items[-1]

    def add_table(self, table: OfficeTable) -> None:
        """Add a table that has been read."""
        self._items = []
        self.into.append(table.finish())


class Draft:
    """The tree that a document becomes, and what can be said of it only when all is read.

    Attributes
    ----------
    html, body : Element
        Root of the tree, and the element for the text.
    """

    def __init__(self) -> None:
        self.html = etree.Element("html")
        self.body = put(self.html, "body")
        self._counted = Counter[str]()  # characters of each language
        self._notes: dict[str, str] = {}  # numbers, by the notes' keys

    def say(self, into: Element, text: str | None, look: Look) -> None:
        """Put text of a look at the end of an element; what ends right before goes on."""
        if not text or HIDDEN in look.tags:
            return
        self._counted[look.language] += len(text)
        named = [("span", {"lang": look.language})] if look.language else []
        for name, attributes in [*named, *((tag, {}) for tag in sorted(look.tags))]:
            last = last_of(into)
            goes_on = (
                last is not None
                and last.tag == name
                and not last.tail
                and dict(last.attrib) == attributes
            )
            into = last if last is not None and goes_on else put(into, name, **attributes)
        put_text(into, text)

    def refer(self, into: Element, key: str) -> None:
        """Put a reference to a note; notes are numbered by their first references."""
        number = self._notes.setdefault(key, str(len(self._notes) + 1))
        put(into, "a", number, role="doc-noteref", href=f"#{key}")

    def notes(self) -> Iterator[tuple[str, Element]]:
        """Put a section of all notes at the end; give the key and the element of each."""
        if not self._notes:
            return
        listed = put(put(self.body, "section", role="doc-endnotes"), "ol")
        done = 0
        while done < len(self._notes):  # a note may refer to others
            key = list(self._notes)[done]
            yield key, put(listed, "li", id=key, role="doc-endnote")
            done += 1

    def finish(self, usual: str) -> str:
        """Finish the tree when all text is in it; give the tag of the language of most of it.

        Parameters
        ----------
        usual
            Tag that the document gives, for one without text.
        """
        found = self._counted.most_common(1)
        most = found[0][0] if found else usual
        for span in self.html.iter("span"):
            tag = span.get("lang")
            if tag and _primary(tag) == _primary(most):
                del span.attrib["lang"]
        for link in self.html.iter("a"):
            for line in link.iter("u"):
                line.tag = "span"
        return most


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
    if what in _UNSHOWN:
        put(parent, _UNSHOWN[what])
    else:
        put(parent, "canvas", aria_label=what)


def put_picture(parent: Element, described: str, what: str = "picture") -> None:
    """Put the text that describes a picture; without one, say what cannot be shown here."""
    if described.strip():
        put(parent, "img", alt=described.strip())
    else:
        put_unshown(parent, what)


def put_ruby(parent: Element, base: str, above: str) -> None:
    """Put a text with small signs above it, which say how it is spoken."""
    put(put(parent, "ruby", base), "rt", above)


def put_page_break(parent: Element) -> None:
    """End a line, and say that a page begins after it."""
    put(parent, "br")
    put_page(parent)


def within(
    holder: Element, names: Collection[str], skipped: Collection[str] = ()
) -> Iterator[Element]:
    """Go through the elements of some names in another, whatever holds them there."""
    for element in holder:
        if element.tag in names:
            yield element
        elif element.tag not in skipped:
            yield from within(element, names, skipped)


def _widen(cell: Element, attribute: str, more: int) -> None:
    if more > 0:
        cell.set(attribute, str(int(cell.get(attribute, "1")) + more))


def _unwrap(cell: Element) -> None:
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


def _make_plain(element: Element) -> None:
    """Take out emphasis that all the text has: it is that of a heading or of a quotation."""
    text = _solid(element)
    for tag in ("b", "i", "u"):
        found = list(element.iter(tag))
        if text and "".join(map(_solid, found)) == text:
            for inner in found:
                inner.tag = "span"


def _solid(element: Element) -> str:
    """Text of an element without blanks."""
    return "".join("".join(map(str, element.itertext())).split())


def tag_of(language: str | None, country: str | None = None) -> str:
    """Tag of a language as a word processor has it; empty if that is no language."""
    language = (language or "").strip()
    if language.lower() in _NO_LANGUAGE:
        return ""
    country = (country or "").strip()
    return f"{language}-{country}" if country.lower() not in _NO_LANGUAGE else language


def _primary(tag: str) -> str:
    """First part of a tag: the language without its country."""
    return tag.replace("_", "-").partition("-")[0].lower()


def dublin_core(about: Element, name: str) -> str:
    """Value of the first of Dublin Core's elements with a name; empty if there is none."""
    found = next(about.iter(name), about)
    return " ".join("".join(map(str, found.itertext())).split()) if found is not about else ""


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
