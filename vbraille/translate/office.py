"""A word processor's document as a tree of HTML: looks, styles, lists and notes of all formats."""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING, Any, BinaryIO

from vbraille.translate.archive import Archive
from vbraille.translate.html import tree_blocks
from vbraille.translate.trees import Element

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.blocks import Block
    from vbraille.translate.numbering import Numbering
    from vbraille.translate.source import Source

# What a style, a paragraph or a run says of its text: "lang"; "font" if that is one of signs;
# "hidden" and the names of emphases, with nothing where it does not look so; the "role" of
# paragraphs, as the name of an element of HTML; the list that they are items of; and the name of
# the style that all this is "based" on.
Look = dict[str, str]

_EMPHASES = ("b", "i", "s", "sub", "sup", "u")
_NO_LANGUAGE = frozenset(("", "none", "zxx", "und", "x-none", "mul"))
_ROLES = re.compile(
    "heading (?P<h>[1-9])|(?P<h1>title|titel|titre)"
    "|(?P<blockquote>(?:intense |block )?quote|block text|quotations)"
    "|(?P<pre>source code|html preformatted|preformatted text|plain text|code)"
    "|(?P<th>table heading.*)"
)
_LONGEST_CHAIN = 20  # styles that are based on each other
_PRIVATE = re.compile("[\uf000-\uf0ff]")  # where fonts of signs have theirs
# Characters of the font Symbol from 0x20 on, and from 0xA0 on; some of Wingdings.
_SYMBOL = (
    " !∀#∃%&∋()∗+,−./0123456789:;<=>?≅ΑΒΧΔΕΦΓΗΙϑΚΛΜΝΟΠΘΡΣΤΥςΩΞΨΖ[∴]⊥_"
    "‾αβχδεφγηιϕκλμνοπθρστυϖωξψζ{|}∼",
    "€ϒ′≤⁄∞ƒ♣♦♥♠↔←↑→↓°±″≥×∝∂•÷≠≡≈…⏐⎯↵ℵℑℜ℘⊗⊕∅∩∪⊃⊇⊄⊂⊆∈∉∠∇®©™∏√⋅¬∧∨⇔⇐⇑⇒⇓◊〈®©™∑⎛⎜⎝⎡⎢⎣⎧⎨⎩⎪€〉∫",
)
_WINGDINGS = b"oq\xa8\xfe\xfd\xfc\xfbJLln\x9f\xa7\xdf\xe0\xe8(*\xd8", "☐☐☐☑☒✔✘☺☹●■•▪←→→☎✉➢"
_FONTS = {
    "symbol": dict(enumerate(_SYMBOL[0], 0x20)) | dict(enumerate(_SYMBOL[1], 0xA0)),
    "wingdings": dict(zip(*_WINGDINGS, strict=True)),
}


def font_of(name: str) -> Look:
    """Look of text in a font of signs; nothing for other fonts."""
    font = name.lower().split(" ")[0]
    return {"font": font} if font in _FONTS else {}


def role_of(name: str) -> Look:
    """Role of the paragraphs of a style by the name that people know; nothing for other names."""
    found = _ROLES.fullmatch(name.lower())
    if found is None or found.lastgroup is None:
        return {}
    return heading(int(found["h"])) if found["h"] else {"role": found.lastgroup}


def heading(level: int) -> Look:
    """Role of a heading of a level; that of plain paragraphs for 0."""
    return {"role": f"h{min(level, 6)}" if level else ""}


def tag_of(tag: str) -> Look:
    """Look of text in a language as a word processor has it; nothing if that is none."""
    tag = re.sub("-(none)?$", "", tag.strip())
    return {"lang": tag} if tag.lower() not in _NO_LANGUAGE else {}


class Document:
    """A document that becomes a tree, with what can be said of it only when all is read.

    Attributes
    ----------
    names : dict
        Names of its format's elements, as `names` has them.
    archive : Archive
        Parts of its file.
    body : Element
        Element for the text.
    styles : dict
        Looks of styles by their keys.
    lists : dict
        Lists by their keys.
    usual : dict
        Look of all text.
    bodies : dict
        Elements of the notes by their keys.
    """

    names: dict[str, Any]

    def __init__(self, source: Source, stream: BinaryIO | None = None) -> None:
        self.archive = Archive(stream or source.stream, source.name)
        self.body = Element("body")
        self.styles: dict[str, Look] = {}
        self.lists: dict[str, Numbering] = {}
        self.usual: Look = {}
        self.bodies: dict[str, Element] = {}
        self._notes: dict[str, str] = {}  # numbers by keys
        self._spoken: Counter[str] = Counter()  # characters of each language

    def inner(self, holder: Element, into: Element, look: Look) -> None:
        """Read the text of an element and what stands in it."""
        for child in holder.children:
            if not isinstance(child, str):
                self.read(child, into, look)
            elif holder.name in self.names["speaking"] or not self.names["speaking"]:
                self.say(into, child, look)

    def read(self, element: Element, into: Element, look: Look) -> None:
        """Read an element that is one of HTML by another name, or one of the format's own."""
        if element.name in self.names["html"]:
            same = into.add(self.names["html"][element.name], id=element.get("name"))
            self.inner(element, same, look)
        elif element.name in self.names["texts"]:
            self.say(into, self.names["texts"][element.name], look)
        elif element.name not in self.names["skipped"]:
            self.read_own(element, into, look)

    def read_own(self, element: Element, into: Element, look: Look) -> None:
        """Read an element of the format's own, all of whose kinds are known here."""
        raise NotImplementedError

    def look_of(self, own: Look, most: int = _LONGEST_CHAIN) -> Look:
        """A look, with all that the styles say that it is based on."""
        style = self.styles.get(own.get("based", ""))
        return own if style is None or not most else self.look_of(style, most - 1) | own

    def say(self, into: Element, text: str, look: Look) -> None:
        """Put text of a look at the end of an element; what ends right before goes on."""
        if not text or look.get("hidden"):
            return
        language = look.get("lang", "")
        self._spoken[language] += len(text)
        around = [(name, {}) for name in _EMPHASES if look.get(name)]
        for name, attributes in [("span", {"lang": language})] * bool(language) + around:
            last = into.children[-1] if into.children else ""
            if isinstance(last, Element) and (last.name, last.attributes) == (name, attributes):
                into = last
            else:
                into = into.add(name, **attributes)
        known = _FONTS.get(look.get("font", ""), {})
        into.say(_PRIVATE.sub(lambda found: known.get(ord(found[0]) & 0xFF, found[0]), text))

    def refer(self, into: Element, key: str) -> None:
        """Put a reference to a note; notes are numbered by their first references."""
        number = self._notes.setdefault(key, str(len(self._notes) + 1))
        into.add("a", number, role="doc-noteref", href=f"#{key}")

    def blocks(self, source: Source, about: Element) -> Iterator[Block]:
        """Blocks of the document and its notes; its language is that of most of its text."""
        listed = self.body.add("section", role="doc-endnotes").add("ol")
        keys = list(self._notes)
        for key in keys:
            item = listed.add("li", id=key, role="doc-endnote")
            self.inner(self.bodies.get(key, Element("")), item, self.usual)
            keys += list(self._notes)[len(keys) :]  # one may refer to others
        source.title = about.said("title")
        most = max(self._spoken, key=self._spoken.__getitem__, default="")
        source.language = most or self.usual.get("lang") or about.said("language")
        return tree_blocks(source, self.body)
