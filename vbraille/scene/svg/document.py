"""SVG files as trees of elements, read within limits, and the words and references in them."""

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
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
_XLINK_HREF = "{http://www.w3.org/1999/xlink}href"
MOST_BYTES = 50 << 20
MOST_ELEMENTS = 50_000
_PIECE = 1 << 16
_LONGEST_NAME, LONGEST_TEXT = 200, 2000
# Ids that programs give by themselves say nothing, and are the same in many drawings.
_GIVEN = re.compile(
    r"(?:svg|g|layer|path|rect|circle|ellipse|line|poly(?:gon|line)|text|tspan|use|image|symbol"
    r"|XMLID|SVGID|Layer|Ebene|Calque|Capa|Livello|Laag)?[-_]?\d[\d_-]*",
)


def read_tree(path: Path) -> Element:
    """Read an SVG file.

    Entities that the file itself declares are replaced; nothing else is fetched.

    Returns
    -------
    lxml element
        The element ``svg``. Elements know their lines.

    Raises
    ------
    InputError
        If the file cannot be read, is not SVG, is not well formed, has more than 50,000 elements,
        elements more than 256 deep, or is larger than 50 MB.
    """
    from lxml import etree

    content = read_bytes(path, MOST_BYTES)
    if content.startswith(b"\x1f\x8b"):
        raise InputError(f"{path} is a compressed SVG; save it as a plain one")
    parser = etree.XMLPullParser(
        ("start",),
        resolve_entities="internal",  # pyright: ignore[reportArgumentType] - since lxml 5
        no_network=True,
        load_dtd=False,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
    )
    count = 0
    try:
        for start in range(0, len(content), _PIECE):
            parser.feed(content[start : start + _PIECE])
            count += sum(1 for _ in parser.read_events())
            if count > MOST_ELEMENTS:
                raise InputError(
                    f"{path} has more than {MOST_ELEMENTS} elements; draw it with fewer"
                )
        root = parser.close()
    except etree.XMLSyntaxError as error:
        problem = short(error.msg or "it ends too soon", 150)
        if "depth" in problem.lower():
            raise InputError(f"{path} has elements far too deep; ungroup some of them") from None
        if "entity" in problem.lower():
            raise InputError(
                f"{path} has entities that cannot be replaced: {problem}; save it without them"
            ) from None
        raise InputError(f"{path} is not well-formed XML: {problem}") from None
    if root.tag not in (f"{SVG}svg", "svg"):
        raise InputError(f"{path} is not SVG: it is a document of {short(str(root.tag))}")
    return root


def name_of(element: Element) -> str:
    """Name of an element without its namespace; empty if it is none of SVG's."""
    tag = element.tag
    if not isinstance(tag, str):  # an entity that nothing declares
        return ""
    name = tag.removeprefix(SVG)
    return "" if name.startswith("{") else name


def text_of(element: Element) -> str:
    """All characters within an element."""
    return "".join(map(str, element.itertext()))


def link_of(element: Element) -> str:
    """Reference of an element, such as ``#lake``; empty for none."""
    return (element.get("href") or element.get(_XLINK_HREF) or "").strip()


def target_of(reference: str) -> str:
    """Id in a reference ``url(#id)``; empty if it is another.

    >>> target_of("url( '#lake' ) red"), target_of("url(http://a.b/c)")
    ('lake', '')
    """
    found = re.match(r"""\s*url\(\s*["']?\s*#([^"')]*)""", reference)
    return found[1].strip() if found else ""


def short(text: str, most: int = 60) -> str:
    """Text for a message: printable, on one line and not long."""
    plain = "".join(char if char.isprintable() else " " for char in text)
    return plain if len(plain) <= most else f"{plain[:most]}…"


def plain(text: str, most: int = _LONGEST_NAME) -> str:
    """Text with single spaces, without control characters, and not too long."""
    return short(" ".join(short(text, len(text)).split()), most)


def title_of(element: Element) -> str:
    """Title of an element: its own, or the label that Inkscape gives it; empty for none."""
    label = element.get(f"{INKSCAPE}label") or element.get("aria-label") or ""
    return _said(element, "title", _LONGEST_NAME) or ("" if label[:1] == "#" else plain(label))


def description_of(element: Element) -> str:
    """Description of an element; empty for none."""
    return _said(element, "desc", LONGEST_TEXT)


def _said(element: Element, name: str, most: int) -> str:
    return next((plain(text_of(child), most) for child in element if name_of(child) == name), "")


def id_of(element: Element) -> str:
    """Id that an author gave an element; empty if a program did, or it has none."""
    own = element.get("id") or ""
    return "" if _GIVEN.fullmatch(own) or not own.isprintable() else own[:_LONGEST_NAME]
