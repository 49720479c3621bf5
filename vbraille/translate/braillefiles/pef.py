"""PEF files (Portable Embosser Format 2008-1): pages of rows of ready cells."""

from __future__ import annotations

import hashlib
from array import array
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.errors import InputError
from vbraille.translate.documents.chapters import ChapterSource, Passage
from vbraille.translate.documents.html import read_whole
from vbraille.translate.source import BlockKind

if TYPE_CHECKING:
    from collections.abc import Iterable

    from lxml import etree

NAMESPACE = "http://www.daisy.org/ns/2008/pef"
DUBLIN_CORE = "http://purl.org/dc/elements/1.1/"
MOST_BYTES = 200_000_000
_CHAPTER_PAGES = 32
_BLANK = 0x2800
_NO_CELLS = Cells(np.empty(0, np.uint8), np.empty(0, np.int64), 0)


class PefBook(ChapterSource):
    """A PEF file as a source: each page a block of the kind PAGE without text, and its rows.

    Volumes and sections follow one another, and their pages are counted on; on which side of the
    paper a page stands and how far rows are apart is left to embossers.

    Parameters
    ----------
    name
        Name of the source in messages.
    digest
        SHA-256 of the file, in hexadecimal.
    pages
        Rows of each page as Unicode braille patterns, with a line feed between two.
    title, language
        As the file's metadata have them; empty if they do not.
    """

    def __init__(
        self, name: str, digest: str, pages: list[str | None], title: str = "", language: str = ""
    ) -> None:
        self._pages = pages
        groups = [
            pages[start : start + _CHAPTER_PAGES] for start in range(0, len(pages), _CHAPTER_PAGES)
        ]
        sizes = array("q", (sum(1 + len(page or "") for page in group) for group in groups))
        super().__init__(name, sizes, digest, title=title, language=language, in_cells=True)

    @classmethod
    def open(cls, stream: BinaryIO, name: str) -> PefBook:
        """Read a PEF file.

        Parameters
        ----------
        stream
            Bytes of the file, which is read from its start and closed.
        name
            Name of the file in messages.

        Raises
        ------
        InputError
            If it is no PEF file, is damaged, declares entities, or is larger than 200 MB.
        """
        content = read_whole(stream, name, MOST_BYTES)
        root = _parse(content, name)
        pages = [_rows(page, name) for page in root.iter(f"{{{NAMESPACE}}}page")]
        if not pages:
            raise InputError(f"{name} has no page in it; give a PEF file with pages")
        return cls(
            name,
            hashlib.sha256(content).hexdigest(),
            pages,
            _metadata(root, "title"),
            _metadata(root, "language"),
        )

    def passages(self, chapter: int) -> Iterable[Passage]:
        """Read the rows of some pages."""
        start = chapter * _CHAPTER_PAGES
        for number, page in enumerate(self._pages[start : start + _CHAPTER_PAGES], 1):
            yield Passage("", BlockKind.PAGE, group=number, cells=_NO_CELLS)
            for row in () if page is None else page.split("\n"):
                text = row.rstrip(chr(_BLANK))
                yield Passage(text, BlockKind.LINE, cells=Cells.from_unicode(text))

    def anchor(self, name: str) -> int | None:  # noqa: ARG002
        """Tell that such files have no anchors."""
        return None


def _parse(content: bytes, name: str) -> etree._Element:
    """Root element of a PEF file, in which nothing was fetched and no entity was put in."""
    from lxml import etree

    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False,
        remove_comments=True, remove_pis=True,
    )  # fmt: skip
    try:
        root = etree.fromstring(content, parser)
    except etree.XMLSyntaxError as error:
        reason = " ".join(str(error.msg).split())
        raise InputError(f"{name} is damaged XML: {reason}; get it anew") from None
    if root.tag != f"{{{NAMESPACE}}}pef":
        raise InputError(f"{name} is no PEF file: it begins with {root.tag}; give a PEF 2008-1")
    tree = root.getroottree()
    if tree.docinfo.internalDTD is not None and "<!ENTITY" in etree.tostring(tree, encoding=str):
        raise InputError(f"{name} declares entities, which no PEF file needs; it is not read")
    return root


def _rows(page: etree._Element, name: str) -> str | None:
    """Rows of a page, with a line feed between two; None if it has none."""
    rows = []
    for row in page.iter(f"{{{NAMESPACE}}}row"):
        text = "".join(map(str, row.itertext())).strip(" \t\r\n")
        if len(row) or not all(_BLANK <= ord(character) < _BLANK + 256 for character in text):
            wrong = next((c for c in text if not _BLANK <= ord(c) < _BLANK + 256), None)
            what = "an element" if wrong is None else repr(wrong)
            raise InputError(
                f"{name} has {what} in a row (line {row.sourceline}), where a PEF file has braille "
                f"patterns only; get it anew"
            )
        rows.append(text)
    return "\n".join(rows) if rows else None


def _metadata(root: etree._Element, what: str) -> str:
    """Value of the first such element of Dublin Core in the head; empty if there is none."""
    found = root.find(f".//{{{NAMESPACE}}}meta/{{{DUBLIN_CORE}}}{what}")
    return "" if found is None else " ".join("".join(map(str, found.itertext())).split())
