"""HTML, XHTML and DTBook."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.translate.archive import MOST_MARKUP
from vbraille.translate.markup import Walker
from vbraille.translate.trees import Element, read_tree

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.blocks import Block
    from vbraille.translate.source import Source


def read_html(source: Source, encoding: str | None = None, *, xml: bool = False) -> Iterator[Block]:
    """Read a page of HTML.

    Raises
    ------
    InputError
        If it is larger than any book.
    """
    content = source.stream.read(MOST_MARKUP + 1)
    if len(content) > MOST_MARKUP:
        raise InputError(f"{source.name} has more than {MOST_MARKUP / 1e6:.0f} MB of markup")
    xml = xml or content[:200].lstrip().startswith(b"<?xml")
    root, notes = read_tree(content, source.name, xml=xml, encoding=encoding)
    for note in notes:
        source.note(note)
    return tree_blocks(source, root)


def read_dtbook(source: Source) -> Iterator[Block]:
    """Read DTBook, the markup of DAISY 3."""
    return read_html(source, xml=True)


def tree_blocks(source: Source, root: Element) -> Iterator[Block]:
    """Blocks of a tree, which says the title and the language unless they are known."""
    source.language = source.language or language_of(root)
    source.title = source.title or title_of(root)
    return iter(Walker(source.language).read(root))


def title_of(root: Element) -> str:
    """Title of a page; empty if it has none."""
    for element in root.iter("title", "doctitle"):
        return " ".join(element.text.split())
    for element in root.iter("meta"):
        if element.get("name").lower() == "dc:title":
            return " ".join(element.get("content").split())
    return ""


def language_of(root: Element) -> str:
    """Tag of the language of a page; empty if it does not say."""
    for element in root.iter("html", "body", "dtbook", "book"):
        if element.get("lang").strip():
            return element.get("lang").strip().replace("_", "-")
    return ""
