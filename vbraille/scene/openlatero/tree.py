"""The XML of OpenLatero's files, read safely, and leniently where it is broken."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.scene.openlatero.elements import GenElement
from vbraille.wording import count, printable

if TYPE_CHECKING:
    from typing import Any

    from vbraille.scene.openlatero.remarks import Remarks

MOST_BYTES = 20_000_000
MOST_ELEMENTS = 200_000
DEEPEST = 100
_MOST_FAULTS = 5  # of broken XML that are said one by one


def read_tree(content: bytes, name: str, remarks: Remarks) -> GenElement:
    """Read a text of XML as elements.

    Nothing is looked up elsewhere, and no entity is expanded.

    Parameters
    ----------
    content
        The text.
    name
        Name of its file, for messages.
    remarks
        Where it is said what was broken.

    Returns
    -------
    GenElement
        The root.

    Raises
    ------
    InputError
        If it is no XML, declares entities, or is far too large or deep.
    """
    from lxml import etree

    if b"<!ENTITY" in content:
        raise _entities(name)
    # Broken files are read as far as they can be; what was broken is said.
    parser = etree.XMLParser(
        recover=True, resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False,
        remove_comments=True, remove_pis=True,
    )  # fmt: skip
    try:
        root: Any = etree.fromstring(content, parser)
    except (etree.XMLSyntaxError, ValueError):
        root = None
    if root is None:
        raise InputError(f"{name} is no XML; give a file that OpenLatero wrote")
    declared: Any = root.getroottree().docinfo.internalDTD
    if declared is not None and any(True for _ in declared.iterentities()):
        raise _entities(name)
    if root.xpath("count(//*)") > MOST_ELEMENTS:
        raise InputError(f"{name} has more than {MOST_ELEMENTS} elements; split the picture in two")
    _say_faults(parser, remarks)
    return _elements(root, name, remarks)


def _entities(name: str) -> InputError:
    return InputError(f"{name} declares entities, which OpenLatero's files have none of; remove it")


def _say_faults(parser: Any, remarks: Remarks) -> None:
    """Say where the XML is broken."""
    faults: dict[int, str] = {}
    for entry in parser.error_log:
        faults.setdefault(entry.line, printable(str(entry.message)))
    for line, message in sorted(faults.items())[:_MOST_FAULTS]:
        remarks.add(line, "XML", f"it is broken here, and read as far as it can be: {message}")
    if len(faults) > _MOST_FAULTS:
        more = count(len(faults) - _MOST_FAULTS, "more line")
        remarks.add(sorted(faults)[_MOST_FAULTS], "XML", f"it is broken here and in {more}")


def _elements(root: Any, name: str, remarks: Remarks) -> GenElement:
    """Elements for those of the library, without going through them by recursion."""
    top = _element(root, None, remarks)
    left: list[tuple[Any, GenElement, int]] = [(root, top, 1)]
    while left:
        xml, element, depth = left.pop()
        for inner in xml:
            if not isinstance(inner.tag, str):  # an entity that is declared nowhere
                element.say(f"the entity {printable(inner.text or '')} is ignored")
                continue
            if depth >= DEEPEST:
                raise InputError(f"{name} line {inner.sourceline}: its elements nest too deep")
            child = _element(inner, element, remarks)
            element.children.append(child)
            left.append((inner, child, depth + 1))
        _say_stray(xml, element)
    return top


def _element(xml: Any, above: GenElement | None, remarks: Remarks) -> GenElement:
    name = printable(xml.tag.rpartition("}")[2])
    attributes = {key: printable(value) for key, value in xml.attrib.items()}
    owner, path = (above.owner, f"{above.path} {name}".strip()) if above else (name, "")
    if name in ("Pattern", "Generator"):
        owner, path = attributes.get("subtype") or attributes.get("type") or name, ""
    line = xml.sourceline or 1
    return GenElement(name, line, attributes, xml.text or "", remarks, owner, path)


def _say_stray(xml: Any, element: GenElement) -> None:
    """Say so if there is text where only elements have a meaning."""
    if not len(xml):
        return
    stray = "".join([xml.text or "", *(inner.tail or "" for inner in xml)])
    if stray.strip():
        said = printable(" ".join(stray.split()))[:40]
        element.say(f'the stray text "{said}" is ignored')
