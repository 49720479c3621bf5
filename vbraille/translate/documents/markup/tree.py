"""Markup as a tree: its encoding, its entities, and what no tree is made of."""

from __future__ import annotations

import re
from html.entities import html5
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.translate.documents.encodings import (
    SAMPLE_BYTES,
    Encoding,
    TextDecoder,
    find_encoding,
    named_encoding,
)
from vbraille.wording import printable, setting

if TYPE_CHECKING:
    from lxml.etree import _Element as Element

MOST_BYTES = 100_000_000
# A tree takes some 120 bytes for each element and for each text in it.
_MOST_TAGS = 5_000_000
_LONGEST_BEGINNING = 1_048_576  # characters before the first element
_DECLARED = re.compile(
    rb"""(?:<\?xml[^>]*?encoding|<meta[^>]*?charset)\s*=\s*["']?\s*([\w.:-]+)""", re.I
)
_ENTITY = re.compile(r"&([A-Za-z_][\w.-]{0,40});")
_PLAIN = frozenset(("amp", "lt", "gt", "quot", "apos"))
_DECLARATION = re.compile(
    r"<!ENTITY\s+(?P<name>[\w.:-]+)\s+(?:(?P<outside>SYSTEM|PUBLIC)|(?P<quote>[\"'])"
    r"(?P<value>.*?)(?P=quote))",
    re.S,
)
_BEFORE_ROOT = re.compile(r"(?:[\s\ufeff]|<\?.*?\?>|<!--.*?-->)*+", re.S)
_STRING = re.compile(r"\"[^\"]*\"|'[^']*'|<!--.*?-->|[\[\]>]", re.S)
_NUMBER = re.compile(r"&#(?:x([0-9a-fA-F]{1,6})|([0-9]{1,7}));")
_SURROGATE = re.compile(rb"\xed[\xa0-\xbf][\x80-\xbf]")  # as UTF-8 would write one
_ENDS = re.compile(rb"</(?:html|body)\s*>", re.I)
# The tree of an element with so many attributes would take minutes.
_MANY_ATTRIBUTES = re.compile(
    rb"<[A-Za-z][^\s/>]*+(?:[\s/]*+[^\s/>=][^\s/>=]*+"
    rb"(?:\s*+=\s*+(?:\"[^\"]*+\"|'[^']*+'|[^\s>\"'][^\s>]*+))?+){10000}"
)


def read_tree(
    content: bytes, name: str, *, xml: bool, encoding: str | None = None
) -> tuple[Element, str | None]:
    """Read markup; what is not well-formed XML is read as HTML, whose mistakes are mended.

    Parameters
    ----------
    content
        Bytes of the markup.
    name
        Name of the markup in messages.
    xml
        Whether it is to be read as XML, as long as it is well formed.
    encoding
        Name of the encoding, if the user gives one.

    Returns
    -------
    root
        Root of the tree, without comments.
    note
        Note on bytes that are not of the encoding; None if there are none.

    Raises
    ------
    InputError
        If the encoding is unknown, or no tree should be made of it.
    """
    from lxml import etree

    if len(content) > MOST_BYTES or content.count(b"<") > _MOST_TAGS:
        raise InputError(
            f"{name} has more markup than any book: more than {MOST_BYTES // 1_000_000} MB, or "
            f"than {_MOST_TAGS // 1_000_000} million tags; split it, or save it as plain text"
        )
    found = markup_encoding(content[:SAMPLE_BYTES], encoding)
    decoder = TextDecoder(found.name)
    text = decoder.decode(content[found.skip :], found.skip, final=True)
    note = None
    if decoder.first_bad is not None:
        note = (
            f"{name} is not {found.name} at byte {decoder.first_bad}; such bytes are read as "
            f"windows-1252, {setting('encoding')} NAME says otherwise"
        )
    if xml:
        text = without_entities(text, name)
    markup = text.encode("utf-8", "surrogatepass")
    if len(text) < len(markup):  # else there are no characters but ASCII
        markup = _SURROGATE.sub("\ufffd".encode(), markup)
    del text
    if xml:
        try:
            parser = etree.XMLParser(
                resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False,
                remove_comments=True, remove_pis=True, encoding="utf-8",
            )  # fmt: skip
            return etree.fromstring(markup, parser), note
        except etree.XMLSyntaxError:
            pass
    if _MANY_ATTRIBUTES.search(markup):
        raise InputError(
            f"{name} has an element of thousands of attributes, which no book has; give another "
            f"copy of it"
        )
    # What stands after the end that some pages have in their middle would have no place in a tree.
    markup = _ENDS.sub(b"", markup)
    parser = etree.HTMLParser(
        huge_tree=True, encoding="utf-8", remove_comments=True, remove_pis=True
    )
    try:
        root = etree.fromstring(markup, parser)
    except etree.XMLSyntaxError:  # there is nothing in it
        root = None
    if any(entry.type == etree.ErrorTypes.ERR_RESOURCE_LIMIT for entry in parser.error_log):
        raise InputError(
            f"{name} has thousands of elements within each other, which no book has; give another "
            f"copy of it"
        )
    return etree.Element("html") if root is None else root, note


def markup_encoding(sample: bytes, named: str | None = None) -> Encoding:
    """Encoding of markup that begins with these bytes.

    A name that is given decides, then a byte-order mark, then what the markup declares, then what
    a plain text with these bytes would be in.

    Raises
    ------
    InputError
        If the name that is given is of no encoding.
    """
    if named is not None:
        encoding = named_encoding(named, sample)
        if encoding is None:
            raise InputError(
                f"there is no text encoding {printable(named)!r}; try windows-1252, latin-1 or "
                f"utf-16"
            )
        return encoding
    found = find_encoding(sample)
    declared = _DECLARED.search(sample[:4096])
    if found.skip or found.name.startswith(("utf-16", "utf-32")) or declared is None:
        return found
    encoding = named_encoding(declared[1].decode("ascii", "replace"), sample)
    if encoding is None or encoding.name.startswith(("utf-16", "utf-32")):
        return found  # the bytes could be read so far, which that encoding would not allow
    # The two names mean the larger one in every browser.
    return Encoding("cp1252") if encoding.name in {"iso8859-1", "ascii"} else encoding


def without_entities(text: str, name: str) -> str:
    """XML without its declarations, and with characters in the place of entities.

    A parser then has no entities to expand and nothing to look up elsewhere. An entity that is
    declared nowhere is left as it is written.

    Raises
    ------
    InputError
        If entities are declared by others.
    """
    start, after = _doctype(text)
    if after - start > _LONGEST_BEGINNING:
        raise InputError(f"{name} declares too much before it begins; give another copy of it")
    entities = _declared(text[start:after], name)

    def put(found: re.Match[str]) -> str:
        name = found[1]
        if name in _PLAIN:
            return found[0]
        value = entities.get(name) or html5.get(f"{name};")
        if value is None:
            return f"&amp;{name};"
        return "".join(f"&#{ord(c)};" for c in value)

    return _ENTITY.sub(put, text[after:])


def _doctype(text: str) -> tuple[int, int]:
    """Start and end of the document type, after which there is the first element."""
    found = _BEFORE_ROOT.match(text)
    at = found.end() if found else 0
    if text[at : at + 9].upper() != "<!DOCTYPE":
        return at, at
    depth = 0
    for found in _STRING.finditer(text, at):
        depth += {"[": 1, "]": -1}.get(found[0], 0)
        if found[0] == ">" and depth <= 0:
            return at, found.end()
    return at, at


def _declared(doctype: str, name: str) -> dict[str, str]:
    """Characters of the entities that a document type declares."""
    entities: dict[str, str] = {}
    for found in _DECLARATION.finditer(doctype):
        if found["outside"]:
            continue  # it stays as it is written
        value = _NUMBER.sub(
            lambda number: _character(int(number[1] or number[2], 16 if number[1] else 10)),
            found["value"],
        )
        if re.search(r"[&%]\w+;", value) or len(value) > 256:
            raise InputError(
                f"{name} defines entities by other entities, which could fill the memory; "
                f"give a copy of the book without them"
            )
        entities.setdefault(found["name"], value)
    return entities


def _character(code: int) -> str:
    return chr(code) if code < 0x110000 and not 0xD800 <= code < 0xE000 else "\ufffd"
