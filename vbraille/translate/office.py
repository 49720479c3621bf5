"""A word processor's document as a tree of HTML: looks, styles, lists and notes of all formats."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from vbraille.translate.archive import Archive
from vbraille.translate.html import tree_blocks
from vbraille.translate.numbering import BULLET, numeral
from vbraille.translate.trees import Element

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from vbraille.translate.blocks import Block
    from vbraille.translate.source import Source

# What is known of a text: its "lang", its "font" if that is one of signs, and for names of HTML's
# elements whether it looks so: the name itself, or nothing where it does not.
Look = dict[str, str]
HIDDEN = "hidden"  # among the elements of a look: text that is not shown

_NO_LANGUAGE = frozenset(("", "none", "zxx", "und", "x-none", "mul"))
_HEADING = re.compile("heading ([1-9])|title|titel|titre")
_QUOTE = re.compile("(?:intense |block )?quote|block text|quotations")
_CODE = re.compile("source code|html preformatted|preformatted text|plain text|code")
_LONGEST_CHAIN = 20  # styles that are based on each other
_BOXES = frozenset("☐☑☒")  # bullets of lists of what is done
_PLACE = re.compile("%([1-9])")
_PRIVATE = re.compile("[\uf000-\uf0ff]")  # where fonts of signs have theirs
# Characters of the font Symbol from 0x20 on, and from 0xA0 on; some of Wingdings.
_SYMBOL = (
    " !∀#∃%&∋()∗+,−./0123456789:;<=>?≅ΑΒΧΔΕΦΓΗΙϑΚΛΜΝΟΠΘΡΣΤΥςΩΞΨΖ[∴]⊥_"
    "‾αβχδεφγηιϕκλμνοπθρστυϖωξψζ{|}∼",
    "€ϒ′≤⁄∞ƒ♣♦♥♠↔←↑→↓°±″≥×∝∂•÷≠≡≈…⏐⎯↵ℵℑℜ℘⊗⊕∅∩∪⊃⊇⊄⊂⊆∈∉∠∇®©™∏√⋅¬∧∨⇔⇐⇑⇒⇓◊〈®©™∑⎛⎜⎝⎡⎢⎣⎧⎨⎩⎪€〉∫",
)
_WINGDINGS = b"oq\xa8\xfe\xfd\xfc\xfbJLln\x9f\xa7\xdf\xe0\xe8(*\xd8", "☐☐☐☑☒✔✘☺☹●■•▪←→→☎✉➢"
FONTS = {
    "symbol": dict(enumerate(_SYMBOL[0], 0x20)) | dict(enumerate(_SYMBOL[1], 0xA0)),
    "wingdings": dict(zip(*_WINGDINGS, strict=True)),
}


def signs(text: str, font: str) -> str:
    """Text with the characters of a font of signs that stand in private places."""
    known = FONTS.get(font.lower().split(" ")[0], {})
    return _PRIVATE.sub(lambda found: known.get(ord(found[0]) & 0xFF, found[0]), text)


def symbol(code: int, font: str) -> str:
    """Character of a code of a font; empty if it is not known here."""
    sign = signs(chr(code if code > 0xFF else code | 0xF000), font)
    sign = chr(code) if _PRIVATE.match(sign) else sign
    return "" if _PRIVATE.match(sign) or not sign.isprintable() else sign


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
    look: Look = field(default_factory=dict)
    level: int | None = None
    listed: str | None = None
    at: int | None = None


def heading_level(styles: list[Style]) -> int:
    """Level of a heading by the styles of a paragraph, its own first; 0 if it is none."""
    for style in styles:
        if style.level is not None:
            return style.level
        found = _HEADING.fullmatch(style.name)
        if found is not None:
            return int(found[1] or 1)
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

    form: str = "bullet"
    text: str = "•"
    start: int = 1
    legal: bool = False


@dataclass(slots=True)
class Numbering:
    """Counts the items of a list.

    Parameters
    ----------
    levels
        Levels of the list.
    counts
        Numbers of the last items, by levels; lists that count on from each other share them.
    starts
        Numbers with which levels begin anew when they are first come to.
    """

    levels: dict[int, Level]
    counts: dict[int, int] = field(default_factory=dict)
    starts: dict[int, int] = field(default_factory=dict)

    def restart(self, at: int) -> None:
        """Begin a level anew, and those within it."""
        for level in [level for level in self.counts if level >= at]:
            del self.counts[level]

    def marker(self, at: int) -> str:
        """Count an item of a level, and give what stands before it."""
        level = self.levels.get(at, Level())
        number = self.starts.pop(at, self.counts.get(at, level.start - 1) + 1)
        self.restart(at)
        self.counts[at] = number
        if level.form == "bullet" and level.text.strip():
            return f"{level.text} " if level.text in _BOXES else BULLET
        if level.form in ("bullet", "none"):
            return ""

        def numbered(found: re.Match[str]) -> str:
            place = int(found[1]) - 1
            one = self.levels.get(place, level)
            form = "1" if level.legal else one.form
            return numeral(self.counts.get(place, one.start), form)

        label = _PLACE.sub(numbered, level.text).strip()
        return f"{label} " if label else ""


class Document:
    """A document that becomes a tree, with what can be said of it only when all is read.

    Attributes
    ----------
    archive : Archive
        Parts of its file.
    body : Element
        Element for the text.
    styles : dict
        Styles by their keys.
    usual : dict
        Look of all text.
    """

    def __init__(self, source: Source) -> None:
        self.archive = Archive(source.stream, source.name)
        self.body = Element("body")
        self.styles: dict[str, Style] = {}
        self.usual: Look = {}
        self._notes: dict[str, str] = {}  # numbers by keys
        self._spoken: Counter[str] = Counter()  # characters of each language

    def chain(self, key: str) -> list[Style]:
        """A style and those that it is based on; nothing for one that is not there."""
        found: list[Style] = []
        while key in self.styles and len(found) < _LONGEST_CHAIN:
            found.append(self.styles[key])
            key = found[-1].based
        return found

    def look_of(self, key: str) -> Look:
        """Look of a style, with those of the styles that it is based on."""
        look: Look = {}
        for style in reversed(self.chain(key)):
            look |= style.look
        return look

    def say(self, into: Element, text: str, look: Look) -> None:
        """Put text of a look at the end of an element; what ends right before goes on."""
        if not text or look.get(HIDDEN):
            return
        language = look.get("lang", "")
        self._spoken[language] += len(text)
        tags = sorted(value for name, value in look.items() if name not in ("lang", "font"))
        named = [("span", {"lang": language})] if language else []
        for name, attributes in [*named, *((tag, {}) for tag in tags if tag)]:
            last = into.children[-1] if into.children else ""
            if isinstance(last, Element) and (last.name, last.attributes) == (name, attributes):
                into = last
            else:
                into = into.add(name, **attributes)
        into.say(signs(text, look.get("font", "")))

    def refer(self, into: Element, key: str) -> None:
        """Put a reference to a note; notes are numbered by their first references."""
        number = self._notes.setdefault(key, str(len(self._notes) + 1))
        into.add("a", number, role="doc-noteref", href=f"#{key}")

    def note_items(self) -> Iterator[tuple[str, Element]]:
        """Put a list of all notes at the end; give the key and the element of each."""
        listed = self.body.add("section", role="doc-endnotes").add("ol")
        keys = list(self._notes)
        for key in keys:
            yield key, listed.add("li", id=key, role="doc-endnote")
            keys += list(self._notes)[len(keys) :]  # one may refer to others

    def blocks(self, source: Source, about: Element) -> Iterator[Block]:
        """Blocks of the document, whose language is that of most of its text."""
        source.title = about.said("title")
        most = self._spoken.most_common(1)
        usual = self.usual.get("lang") or about.said("language")
        source.language = (most[0][0] if most else "") or usual
        return tree_blocks(source, self.body)


def name_by_style(paragraph: Element, styles: list[Style], level: int = 0) -> None:
    """Make a paragraph a heading, a quotation or code, as its level or its styles say."""
    level = level or heading_level(styles)
    if level:
        paragraph.name = f"h{min(level, 6)}"
    elif any(_QUOTE.fullmatch(style.name) for style in styles):
        paragraph.name = "blockquote"
    elif any(_CODE.fullmatch(style.name) for style in styles):
        paragraph.name = "pre"


def within(holder: Element, names: Collection[str], skipped: Collection[str]) -> Iterator[Element]:
    """Elements of some names in another, whatever holds them there that is not skipped."""
    for element in holder.elements:
        if element.name in names:
            yield element
        elif element.name not in skipped:
            yield from within(element, names, skipped)


def put_picture(into: Element, described: list[str], what: str = "picture") -> None:
    """Put the first text that describes a picture; without one, say what cannot be shown here."""
    told = next((text.strip() for text in described if text.strip()), "")
    if told:
        into.add("img", alt=told)
    elif what == "picture":
        into.add("img")
    else:
        into.add("canvas", aria_label="" if what == "drawing" else what)


def tag_of(language: str, country: str = "") -> Look:
    """Look of text in a language as a word processor has it; nothing if that is none."""
    language, country = language.strip(), country.strip()
    if language.lower() in _NO_LANGUAGE:
        return {}
    return {"lang": f"{language}-{country}" if country.lower() not in _NO_LANGUAGE else language}
