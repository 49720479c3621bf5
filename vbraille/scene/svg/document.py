"""SVG files as trees of elements, read within limits; no other file is looked up."""

from __future__ import annotations

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
MOST_DEPTH = 100
_PIECE = 1 << 16
_LONGEST_NAME = 60


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
        elements more than 100 deep, or is larger than 50 MB.
    """
    from lxml import etree

    content = read_bytes(path, MOST_BYTES)
    if content.startswith(b"\x1f\x8b"):
        raise InputError(f"{path} is a compressed SVG; save it as a plain one")
    parser = etree.XMLPullParser(
        ("start", "end"),
        resolve_entities="internal",  # pyright: ignore[reportArgumentType] - since lxml 5
        no_network=True,
        load_dtd=False,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
    )
    too_deep = f"{path} has elements more than {MOST_DEPTH} deep; ungroup some of them"
    count = depth = 0
    try:
        for start in range(0, len(content), _PIECE):
            parser.feed(content[start : start + _PIECE])
            for event, _ in parser.read_events():
                depth += 1 if event == "start" else -1
                count += event == "start"
                if count > MOST_ELEMENTS:
                    raise InputError(
                        f"{path} has more than {MOST_ELEMENTS} elements; draw it with fewer"
                    )
                if depth > MOST_DEPTH:
                    raise InputError(too_deep)
        root = parser.close()
    except etree.XMLSyntaxError as error:
        problem = error.msg or "it ends too soon"
        if "depth" in problem.lower():
            raise InputError(too_deep) from None
        if "entity" in problem.lower():
            raise InputError(
                f"{path} has entities that cannot be replaced: {short(problem, 150)}; "
                "save it without them"
            ) from None
        raise InputError(f"{path} is not well-formed XML: {short(problem, 150)}") from None
    if root.tag not in (f"{SVG}svg", "svg"):
        raise InputError(f"{path} is not SVG: it is a document of {short(str(root.tag))}")
    return root


def name_of(element: Element) -> str:
    """Name of an element without its namespace; empty if it is none of SVG's."""
    tag = element.tag
    if not isinstance(tag, str):  # an entity that nothing declares
        return ""
    if tag.startswith(SVG):
        return tag[len(SVG) :]
    return "" if tag.startswith("{") else tag


def called(element: Element) -> str:
    """Element in a message: its name and its id."""
    own = element.get("id")
    name = name_of(element) or "element"
    return f"{name} {short(own)}" if own else name


def text_of(element: Element) -> str:
    """All characters within an element."""
    return "".join(map(str, element.itertext()))


def link_of(element: Element) -> str:
    """Reference of an element, such as ``#lake``; empty for none."""
    return (element.get("href") or element.get(_XLINK_HREF) or "").strip()


def target_of(reference: str | None) -> str:
    """Id in a reference ``url(#id)``; empty if it is another.

    >>> target_of("url( '#lake' ) red"), target_of("url(http://a.b/c)")
    ('lake', '')
    """
    text = (reference or "").strip()
    if not text.startswith("url("):
        return ""
    inside = text[4:].partition(")")[0].strip().strip("\"'").strip()
    return inside[1:] if inside.startswith("#") else ""


def ids_of(root: Element) -> dict[str, Element]:
    """Elements by their ids, the first of each."""
    ids: dict[str, Element] = {}
    for element in root.iter():
        if own := element.get("id"):
            ids.setdefault(own, element)
    return ids


def short(text: str, most: int = _LONGEST_NAME) -> str:
    """Text for a message: printable, on one line and not long."""
    plain = "".join(char if char.isprintable() else " " for char in text)
    return plain if len(plain) <= most else f"{plain[:most]}…"
