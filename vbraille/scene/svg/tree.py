"""Elements of an SVG file, read so that no file costs much, and nothing else is looked up."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.scene.filebytes import read_bytes

if TYPE_CHECKING:
    from pathlib import Path

    from lxml.etree import _Element

    Element = _Element

SVG = "{http://www.w3.org/2000/svg}"
XLINK = "{http://www.w3.org/1999/xlink}"
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
MOST_BYTES = 50 << 20
MOST_ELEMENTS = 50_000
MOST_DEPTH = 100
_MOST_ENTITY = 256  # characters of an entity's text
_MOST_DECLARED = 20_000  # characters; those of Adobe Illustrator are 2,000
_PIECE = 1 << 16
# Encodings that people save drawings in, and no others: some of Python's take very long.
_ENCODING = re.compile(r"utf-?(?:8|16)|us-ascii|iso-8859-\d+|windows-125\d|latin-?1", re.IGNORECASE)
_DECLARATION = re.compile(rb"\s*<\?xml\b[^>]*?encoding\s*=\s*[\"']([^\"']+)[\"']")
_BEFORE_ROOT = re.compile(r"(?:\s+|<\?.*?\?>|<!--.*?-->)*", re.DOTALL)
_DOCTYPE = re.compile(
    r"<!DOCTYPE\s+[^\s\[>]+(?:\s+(?:PUBLIC|SYSTEM)(?:\s+(?:\"[^\"]*\"|'[^']*'))+)?"
    r"\s*(?:\[(?P<inside>(?:[^\]\"']|\"[^\"]*\"|'[^']*')*+)\])?\s*>"
)
_ENTITY = re.compile(r"<!ENTITY\s+([\w.-]+)\s+(?:\"([^\"]*)\"|'([^']*)')\s*>|<!--.*?-->", re.DOTALL)
_REFERENCE = re.compile(r"&([\w.-]+);")
_PLAIN = frozenset(("lt", "gt", "amp", "quot", "apos"))


def read_tree(path: Path) -> Element:
    """Read an SVG file.

    Its entities are replaced if they are plain text, as Adobe Illustrator writes them; those that
    name other entities or other files are refused. Its document type is not looked up.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    lxml element
        The element ``svg``. Elements know their lines.

    Raises
    ------
    InputError
        If the file cannot be read, is no SVG, is not well formed, has entities that are no plain
        text, more than 50,000 elements, elements more than 100 deep, or is larger than 50 MB.
    """
    content = read_bytes(path, MOST_BYTES)
    if content.startswith(b"\x1f\x8b"):
        raise InputError(f"{path} is a compressed SVG; save it as a plain one")
    root = _parsed(_plain(_decoded(content, path), path), path)
    if root.tag not in (f"{SVG}svg", "svg"):
        raise InputError(f"{path} is no SVG: it is a document of {_short(str(root.tag))}")
    return root


def _decoded(content: bytes, path: Path) -> str:
    """Characters of a file, in the encoding that it says."""
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        name = "utf-16"
    else:
        declared = _DECLARATION.match(content.removeprefix(b"\xef\xbb\xbf")[:1000])
        name = declared[1].decode("ascii", "replace") if declared else "utf-8"
        name = "utf-8-sig" if name.lower() in ("utf-8", "utf8", "utf-16", "utf16") else name
    try:
        if name != "utf-8-sig" and not _ENCODING.fullmatch(name):
            raise LookupError
        return content.decode(name)
    except LookupError:
        raise InputError(f"{path} is in the encoding {_short(name)}; save it in UTF-8") from None
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path} is not in the encoding {_short(error.encoding)} that it should have; "
            "save it in UTF-8"
        ) from None


def _plain(text: str, path: Path) -> str:
    """Text without a document type, with the same lines, and with its entities replaced."""
    before = _BEFORE_ROOT.match(text)
    start = before.end() if before else 0
    kept = "\n" * text.count("\n", 0, start)
    if not text.startswith("<!DOCTYPE", start):
        return kept + text[start:]
    found = _DOCTYPE.match(text, start)
    if found is None:
        raise InputError(f"{path} has a document type that is not understood; save it without one")
    kept += "\n" * found[0].count("\n")
    rest = text[found.end() :]
    entities = _entities(found["inside"] or "", path)
    return kept + (_replaced(rest, entities, path) if entities else rest)


def _entities(inside: str, path: Path) -> dict[str, str]:
    """Entities that a document type declares, all of them plain text."""
    if len(inside) > _MOST_DECLARED:
        raise InputError(f"{path} declares too much in its document type; save it without one")
    left = _ENTITY.sub("", inside)
    if "<!ENTITY" in left:
        raise InputError(
            f"{path} has entities that stand for other files; nothing is fetched, "
            "so save it without them"
        )
    entities = {found[1]: found[2] or found[3] or "" for found in _ENTITY.finditer(inside)}
    entities.pop("", None)
    for name, value in list(entities.items()):
        if name is None:  # a comment
            del entities[name]
        elif "&" in value or "<" in value or "%" in value or len(value) > _MOST_ENTITY:
            raise InputError(
                f"{path} has entities that could fill the memory, such as {_short(name)}; "
                "save it without them"
            )
    return entities


def _replaced(text: str, entities: dict[str, str], path: Path) -> str:
    """Text with its entities replaced, if it stays as small as a file may be."""
    room = MOST_BYTES

    def put(found: re.Match[str]) -> str:
        nonlocal room
        value = entities.get(found[1])
        if value is None or found[1] in _PLAIN:
            return found[0]
        room -= len(value)
        if room < 0:
            raise InputError(f"{path} has entities that could fill the memory; save it without")
        return value

    return _REFERENCE.sub(put, text)


def _parsed(text: str, path: Path) -> Element:
    """Elements of a text, counted while it is read, so that it is given up soon."""
    from lxml import etree

    parser = etree.XMLPullParser(
        ("start", "end"),
        encoding="utf-8",
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
    )
    count = depth = 0
    try:
        for start in range(0, len(text), _PIECE):
            parser.feed(text[start : start + _PIECE].encode("utf-8", "replace"))
            for event, _ in parser.read_events():
                depth += 1 if event == "start" else -1
                count += event == "start"
                if count > MOST_ELEMENTS:
                    raise InputError(
                        f"{path} has more than {MOST_ELEMENTS} elements; draw it with fewer"
                    )
                if depth > MOST_DEPTH:
                    raise InputError(
                        f"{path} has elements more than {MOST_DEPTH} deep; ungroup some of them"
                    )
        return parser.close()
    except etree.XMLSyntaxError as error:
        if "depth" in str(error).lower():
            raise InputError(
                f"{path} has elements more than {MOST_DEPTH} deep; ungroup some of them"
            ) from None
        said = _short(error.msg or "it ends too soon", 150)
        raise InputError(f"{path} is not well-formed XML: {said}") from None


def name_of(element: Element) -> str:
    """Name of an element without its namespace; empty if it is none of SVG's."""
    tag = element.tag
    if not isinstance(tag, str):  # an entity that nothing declares
        return ""
    if tag.startswith(SVG):
        return tag[len(SVG) :]
    return "" if tag.startswith("{") else tag


def called(element: Element) -> str:
    """Element in a message: what it is, and its id."""
    own = element.get("id")
    name = name_of(element) or "element"
    return f"{name} {_short(own)}" if own else name


def text_of(element: Element) -> str:
    """All characters within an element."""
    return "".join(map(str, element.itertext()))


def link_of(element: Element) -> str:
    """Tell what an element refers to; empty if to nothing."""
    return (element.get("href") or element.get(f"{XLINK}href") or "").strip()


def _short(text: str, most: int = 60) -> str:
    """Text for a message: printable, on one line and not long."""
    plain = "".join(char if char.isprintable() else " " for char in text)
    return plain if len(plain) <= most else f"{plain[:most]}…"
