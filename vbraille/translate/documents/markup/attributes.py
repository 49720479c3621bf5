"""Attributes of an element, and their meaning, whatever markup it is of."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_XML = "{http://www.w3.org/XML/1998/namespace}"
_OPS = "{http://www.idpf.org/2007/ops}"
_KNOWN_NAMES = (
    "alt alttext aria-hidden aria-label aria-level class colspan data-latex data-marker display "
    "enum epub:type hidden href id idref lang list-style name page render reversed role rowspan "
    "span src start style summary title type value xlink:href xml:lang content http-equiv"
)
_KNOWN = frozenset(_KNOWN_NAMES.split())
# Words of `epub:type`, `role` and `class`, and what is made of them.
_TYPES = {
    "pagebreak": "page",
    "doc-pagebreak": "page",
    "noteref": "noteref",
    "doc-noteref": "noteref",
    "footnote": "note",
    "endnote": "note",
    "rearnote": "note",
    "doc-footnote": "note",
    "doc-endnote": "note",
    "footnotes": "notes",
    "endnotes": "notes",
    "rearnotes": "notes",
    "doc-endnotes": "notes",
    "backlink": "back",
    "doc-backlink": "back",
    "heading": "heading",
    "presentation": "presentation",
    "none": "presentation",
    "img": "img",
}
_CLASSES = {
    "footnote-ref": "noteref",
    "footnoteRef": "noteref",
    "footnote-back": "back",
    "footnote-backref": "back",
    "footnotes": "notes",
    **dict.fromkeys(("sdfootnoteanc", "sdendnoteanc"), "noteref"),  # LibreOffice's
    **dict.fromkeys(("sdfootnote", "sdendnote"), "note"),
    **dict.fromkeys(("sdfootnotesym", "sdendnotesym"), "number"),
    **dict.fromkeys(("MsoFootnoteText", "MsoEndnoteText"), "note"),  # Word's
    **dict.fromkeys(("sup", "super", "superscript"), "superscript"),  # what a style sheet says
    **dict.fromkeys(("sub", "subscript"), "subscript"),
    "pagebreak": "page?",  # only of an element without text: some books call any break so
}
# Word's links between a note and what refers to it: "#_ftn1" there, and "#_ftnref1" back.
_WORDS = re.compile(r"#_(?:ftn|edn)(ref)?\d+$")
_FIGURES = frozenset((".scene", ".svg"))
_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")
_STYLES = re.compile(r"(display|visibility)\s*:\s*(none|hidden)")


def figure_address(found: Mapping[str, str]) -> str:
    """Address of the tactile picture that an image shows; empty if it is none.

    Such a picture stands in a file of its own beside the text: nothing is fetched from elsewhere.
    An empty alternative text says of a drawing that it is there for its looks.

    >>> figure_address({"src": "water.scene"}), figure_address({"src": "logo.svg", "alt": ""})
    ('water.scene', '')
    >>> figure_address({"src": "https://example.org/water.scene"})
    ''
    """
    address = found.get("src", "").strip()
    path = address.partition("#")[0].partition("?")[0]
    ending = path[path.rfind(".") :].lower()
    if ending not in _FIGURES or path.startswith(("/", "\\")) or _SCHEME.match(path):
        return ""
    decorates = not (found.get("title") or found.get("aria-label") or found.get("alt", " "))
    return "" if ending == ".svg" and decorates else path


@lru_cache(1_000)
def named(tag: str) -> str:
    """Local name of a tag, in lower case, without its namespace."""
    return tag.rpartition("}")[2].rpartition(":")[2].lower()


def known(attributes: Iterable[tuple[Any, Any]]) -> dict[str, str]:
    """Attributes that a caller asks for, with the usual prefixes of XML and EPUB."""
    found: dict[str, str] = {}
    for name, value in attributes:
        if name[:1] == "{":
            prefix = "xml:" if name.startswith(_XML) else "epub:" if name.startswith(_OPS) else ""
            name = prefix + name.rpartition("}")[2]
        elif not name.islower():
            name = name.lower()
        if name in _KNOWN:
            found.setdefault(name, value)
    return found


def roles(attributes: Mapping[str, str]) -> frozenset[str]:
    """Roles that an element's attributes give it, by names of our own such as "noteref"."""
    found = set()
    for attribute, names in (("epub:type", _TYPES), ("role", _TYPES), ("class", _CLASSES)):
        value = attributes.get(attribute)
        if value:
            found.update(names[word] for word in value.split() if word in names)
    link = _WORDS.match(attributes.get("href", ""))
    if link is not None:
        found.add("number" if link[1] else "noteref")
    return frozenset(found)


def is_hidden(attributes: Mapping[str, str]) -> bool:
    """Tell whether an element is not to be shown, going by its own attributes."""
    style = attributes.get("style")
    return (
        attributes.get("aria-hidden", "").strip().lower() == "true"
        or ("hidden" in attributes and attributes["hidden"].lower() != "until-found")
        or (style is not None and _STYLES.search(style.lower()) is not None)
    )


def language(attributes: Mapping[str, str]) -> str | None:
    """Tag of the language that an element says it is in; None if it says nothing."""
    tag = attributes.get("xml:lang", attributes.get("lang"))
    return None if tag is None else tag.strip()


def target(attributes: Mapping[str, str]) -> str:
    """Address that a link leads to; empty if it leads nowhere."""
    identity = attributes.get("idref", "").strip()
    address = attributes.get("href", "").strip() or (identity and f"#{identity.lstrip('#')}")
    return "" if address.lower().startswith(("javascript:", "data:")) else address
