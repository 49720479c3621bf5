"""Trees of elements, as markup is read into and word processors' files are made into.

HTML and XML come by lxml's parser events, for libxml2's own tree loses the rest of a book silently
beyond 255 open elements. What is nested deeper than `DEEPEST` stands flat in the last element.
"""

from __future__ import annotations

import html
import posixpath
import re
import tomllib
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from vbraille.errors import InputError
from vbraille.translate.encodings import decode

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

DEEPEST = 200
MOST_ELEMENTS = 2_000_000
_ENTITY = re.compile(r"&(?!(?:amp|lt|gt|quot|apos);)([A-Za-z]\w*);")
_DECLARED = re.compile(rb"""(?:encoding|charset)\s*=\s*["']?\s*([\w.:-]+)""")
_XML_HEAD = re.compile(r"^\s*<\?xml.*?\?>|<!DOCTYPE\s[^>\[]*(?:\[.*?\]\s*)?>", re.S | re.I)
# What is called so is windows-1252, by the standard of HTML.
_VAGUE = {"iso-8859-1": "cp1252", "latin1": "cp1252", "us-ascii": "cp1252"}


def names(form: str) -> dict[str, Any]:
    """Names of a format's elements by what they are to a reader, as `names.toml` has them."""
    told = tomllib.loads(Path(__file__).with_name("names.toml").read_text("utf-8"))[form]
    return {
        what: frozenset(row.split()) if isinstance(row, str) else row for what, row in told.items()
    }


def inside(member: str, address: str) -> str:
    """Name of the file in a book, or of the anchor, that an address in a file of it means."""
    path, hash_, anchor = address.strip().partition("#")
    path = unquote(path.partition("?")[0])
    if path:
        member = posixpath.normpath(posixpath.join(posixpath.dirname(member), path))
    return f"{member}{hash_}{unquote(anchor)}"


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
        child.say(text)
        self.children.append(child)
        return child

    def say(self, text: str) -> None:
        """Add text."""
        if text:
            self.children.append(text)

    @property
    def words(self) -> set[str]:
        """Words of its class, type and role."""
        told = (self.get("class"), self.get("type"), self.get("role"))
        return set(" ".join(told).split())

    @property
    def elements(self) -> list[Element]:
        """Elements in it, without those within them."""
        return [child for child in self.children if not isinstance(child, str)]

    @property
    def text(self) -> str:
        """All text in it."""
        return "".join(child if isinstance(child, str) else child.text for child in self.children)

    def said(self, *names: str) -> str:
        """Text of the first element of some names in it that has a text, with blanks folded."""
        texts = (" ".join(element.text.split()) for element in self.iter(*names))
        return next(filter(None, texts), "")

    def iter(self, *names: str) -> Iterator[Element]:
        """Elements of some names in it, in order, itself among them."""
        if self.name in names:
            yield self
        for child in self.children:
            if isinstance(child, Element):
                yield from child.iter(*names)


class _DamagedError(InputError):
    """A file is not the markup that it should be."""


class _Tree:
    """Tree of a file that is not too deep, built as a target of lxml's parsers.

    Raises
    ------
    InputError
        If the file is not what is parsed, or has more elements than a book has.
    """

    def __init__(self, content: bytes, name: str, *, xml: bool) -> None:
        from lxml import etree

        self.root = Element("root")
        self.flattened = self._count = 0
        self._name = name
        self._open = [self.root]
        self._text: list[str] = []  # in parts, as the parser cuts it
        target: Any = self
        if xml:
            parser = etree.XMLParser(
                target=target, resolve_entities=False, no_network=True, load_dtd=False
            )
        else:
            parser = etree.HTMLParser(
                target=target, huge_tree=True, no_network=True, encoding="utf-8"
            )
        try:
            for start in range(0, len(content) or 1, 1 << 20):
                parser.feed(content[start : start + (1 << 20)])
            parser.close()
        except (etree.LxmlError, AssertionError, ValueError) as error:
            said = " ".join(str(error).split())
            raise _DamagedError(f"{name} is damaged ({said}); get the book again") from None

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self.close()
        self._count += 1
        if self._count > MOST_ELEMENTS:
            raise InputError(
                f"{self._name} cannot be read: it has more than {MOST_ELEMENTS:,} elements"
            )
        child = self._open[-1]
        if len(self._open) > DEEPEST:
            self.flattened += 1
        else:
            named = {_local(key): value for key, value in attributes.items()}
            child = Element(_local(tag), named)
            self._open[-1].children.append(child)
        self._open.append(child)

    def end(self, _tag: str) -> None:
        self.close()
        self._open.pop()

    def data(self, text: str) -> None:
        self._text.append(text)

    def close(self) -> None:
        self._open[-1].say("".join(self._text))
        self._text = []


def _local(name: str) -> str:
    return name.rpartition("}")[2].rpartition(":")[2].lower()


def parse_xml(content: bytes, name: str) -> Element:
    """Root of a file that must be XML.

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
    if b"<!ENTITY" in content[:65_536]:
        raise InputError(f"{name} declares entities, which no book needs; get another copy")
    return _Tree(content, name, xml=True).root.elements[0]


def read_tree(
    content: bytes,
    name: str,
    note: Callable[[str], object],
    encoding: str | None = None,
) -> Element:
    """Tree of a file of markup, as XML if it is that, and otherwise as HTML.

    Parameters
    ----------
    content
        Bytes of the file.
    name
        Name of the file in messages.
    note
        Function that is given sentences on what was read otherwise than it says.
    encoding
        Encoding that overrides what the bytes say.

    Raises
    ------
    InputError
        If it has more elements than a book has.
    """
    text, wrong = decode(content, encoding)
    declared = _DECLARED.search(content[:2048])
    if wrong and declared is not None:
        said = declared[1].decode("ascii", "replace").lower()
        with suppress(LookupError, UnicodeDecodeError):
            text, wrong = content.decode(_VAGUE.get(said, said)), ""
    if wrong:
        note(f"{name} {wrong}")
    text = _XML_HEAD.sub("", text[:4096]) + text[4096:]
    try:
        unfolded = _ENTITY.sub(lambda found: html.unescape(found[0]), text)
        tree = _Tree(unfolded.encode("utf-8", "replace"), name, xml=True)
    except _DamagedError:
        tree = _Tree(text.encode("utf-8", "replace") or b" ", name, xml=False)
    if tree.flattened:
        note(
            f"{name} nests elements more than {DEEPEST} deep; {tree.flattened} are read as if "
            f"they were not nested"
        )
    return tree.root
