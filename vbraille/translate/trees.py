"""Trees of elements, as markup is read into and word processors' files are made into.

HTML and XML come by lxml's parser events, for libxml2's own tree loses the rest of a book silently
beyond 255 open elements. What is nested deeper than `DEEPEST` stands flat in the last element.
"""

from __future__ import annotations

import html
import re
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.translate.encodings import decode

if TYPE_CHECKING:
    from collections.abc import Iterator

DEEPEST = 200
MOST_ELEMENTS = 2_000_000
_ENTITY = re.compile(r"&(?!(?:amp|lt|gt|quot|apos);)([A-Za-z]\w*);")
_DECLARED = re.compile(rb"""(?:encoding|charset)\s*=\s*["']?\s*([\w.:-]+)""")
_XML_HEAD = re.compile(r"^\s*<\?xml.*?\?>|<!DOCTYPE\s[^>\[]*(?:\[.*?\]\s*)?>", re.S | re.I)


class Element:
    """An element of markup.

    Parameters
    ----------
    name
        Name in small letters, without a namespace.
    attributes
        Attributes by such names.

    Attributes
    ----------
    children : list of Element or str
        Elements and texts in it, in order.
    """

    __slots__ = ("attributes", "children", "name")

    def __init__(self, name: str, attributes: dict[str, str] | None = None) -> None:
        self.name = name
        self.attributes = attributes or {}
        self.children: list[Element | str] = []

    def get(self, name: str, otherwise: str = "") -> str:
        """Value of an attribute."""
        return self.attributes.get(name, otherwise)

    def add(self, name: str, text: str = "", **attributes: str) -> Element:
        """Add an element with a text; "_" in attributes' names stands for "-"."""
        named = {key.strip("_").replace("_", "-"): value for key, value in attributes.items()}
        child = Element(name, named)
        if text:
            child.children.append(text)
        self.children.append(child)
        return child

    def say(self, text: str) -> None:
        """Add text."""
        if text:
            self.children.append(text)

    @property
    def elements(self) -> list[Element]:
        """Elements in it, without those within them."""
        return [child for child in self.children if not isinstance(child, str)]

    @property
    def text(self) -> str:
        """All text in it."""
        return "".join(child if isinstance(child, str) else child.text for child in self.children)

    def iter(self, *names: str) -> Iterator[Element]:
        """Elements of some names in it, in order, itself among them; of all without a name."""
        if not names or self.name in names:
            yield self
        for child in self.children:
            if isinstance(child, Element):
                yield from child.iter(*names)


class _Builder:
    """Target of lxml's parsers: builds a tree that is not too deep."""

    def __init__(self, *, keep_case: bool = False) -> None:
        self.root = Element("root")
        self._keep_case = keep_case
        self.flattened = 0
        self._open = [self.root]
        self._count = 0

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self._count += 1
        if self._count > MOST_ELEMENTS:
            raise InputError(f"it has more than {MOST_ELEMENTS:,} elements")
        if len(self._open) > DEEPEST:
            self.flattened += 1
            self._open.append(self._open[-1])
            return
        name = self._name(tag)
        child = Element(name, {self._name(key): value for key, value in attributes.items()})
        self._open[-1].children.append(child)
        self._open.append(child)

    def end(self, _tag: str) -> None:
        self._open.pop()

    def data(self, text: str) -> None:
        self._open[-1].children.append(text)

    def close(self) -> _Builder:
        return self

    def _name(self, name: str) -> str:
        local = name.rpartition("}")[2].rpartition(":")[2]
        return local if self._keep_case else local.lower()


def parse_xml(content: bytes, name: str) -> Element:
    """Root of a file that must be XML; names keep their case.

    Parameters
    ----------
    content
        Bytes of the file.
    name
        Name of the file in messages.

    Raises
    ------
    InputError
        If it is no XML, or declares entities.
    """
    from lxml import etree

    if b"<!ENTITY" in content[:65_536]:
        raise InputError(f"{name} declares entities, which no book needs; get another copy")
    builder: Any = _Builder(keep_case=True)
    parser: Any = etree.XMLParser(
        target=builder, resolve_entities=False, no_network=True, load_dtd=False
    )
    try:
        parser.feed(content)
        return parser.close().root.elements[0]
    except (
        etree.XMLSyntaxError,
        etree.ParserError,
        ValueError,
        AssertionError,
        IndexError,
    ) as error:
        said = " ".join(str(error).split())
        raise InputError(f"{name} is damaged ({said}); get the book again") from None


def read_tree(
    content: bytes, name: str, *, xml: bool, encoding: str | None = None
) -> tuple[Element, list[str]]:
    """Tree of a file of markup, and sentences on what was read otherwise than it says.

    Parameters
    ----------
    content
        Bytes of the file.
    name
        Name of the file in messages.
    xml
        Whether it should be XML; what is none is read as HTML.
    encoding
        Encoding that overrides what the bytes say.

    Raises
    ------
    InputError
        If it has more elements than a book has.
    """
    from lxml import etree

    text, note = _decoded(content, encoding)
    notes = [f"{name} {note}"] if note else []
    text = _XML_HEAD.sub("", text[:4096]) + text[4096:]
    target: Any = _Builder
    options: dict[str, Any] = {"huge_tree": True, "no_network": True, "encoding": "utf-8"}
    built = None
    if xml:
        options_xml = {**options, "resolve_entities": False, "load_dtd": False, "huge_tree": False}
        whole = _ENTITY.sub(lambda found: html.unescape(found[0]), text)
        built = _parse(etree.XMLParser(target=target(), **options_xml), whole, name)
    if built is None:
        parser = etree.HTMLParser(target=target(), **options)
        built = _parse(parser, text, name) or _Builder()
    if built.flattened:
        notes.append(
            f"{name} nests elements more than {DEEPEST} deep; {built.flattened} are read as if "
            f"they were not nested"
        )
    return built.root, notes


def _parse(parser: Any, text: str, name: str) -> _Builder | None:
    """Feed a parser in pieces; None if the text is not what it parses."""
    from lxml import etree

    content = text.encode("utf-8", "replace")
    try:
        for start in range(0, len(content), 1 << 20):
            parser.feed(content[start : start + (1 << 20)])
        return parser.close()
    except InputError as error:
        raise InputError(f"{name} cannot be read: {error}") from None
    except (etree.ParserError, etree.XMLSyntaxError, AssertionError):
        return None


def _decoded(content: bytes, encoding: str | None) -> tuple[str, str]:
    """Text of markup, whatever it declares, and the end of a sentence if that is wrong."""
    declared = _DECLARED.search(content[:2048])
    try:
        if encoding is None:
            return content.decode("utf-8-sig"), ""
    except UnicodeDecodeError:
        said = declared[1].decode("ascii", "replace") if declared else ""
        if said and said.lower() not in ("utf-8", "utf8"):
            try:
                said = "cp1252" if said.lower() in ("iso-8859-1", "latin1", "us-ascii") else said
                return content.decode(said), ""
            except (LookupError, UnicodeDecodeError):
                pass
    text, _, note = decode(content, encoding)
    return text, note
