"""eBraille 1.0: a book as a zip of pages of Unicode braille, which is an EPUB, too."""

from __future__ import annotations

import zipfile
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.translate.braillefiles.writing import escaped
from vbraille.translate.source import BlockKind
from vbraille.translate.text import Text, to_codes, to_text

if TYPE_CHECKING:
    from collections.abc import Iterable
    from datetime import datetime
    from typing import BinaryIO

    from vbraille.translate.braillefiles.writing import Imprint
    from vbraille.translate.liblouis import BrailleTable
    from vbraille.translate.source import Block

_PART_CHARACTERS = 200_000
_BLANK = "\u2800"
_SYSTEMS = {
    "en-ueb-g1.ctb": "UEB grade1",
    "en-ueb-g2.ctb": "UEB grade2",
    "en-us-g1.ctb": "EBAE grade1",
    "en-us-g2.ctb": "EBAE grade2",
}
_CONTAINER = """\
<?xml version="1.0" encoding="UTF-8"?>
<container version="1.0" xmlns="urn:oasis:names:tc:opendocument:xmlns:container"><rootfiles>
<rootfile full-path="package.opf" media-type="application/oebps-package+xml"/>
</rootfiles></container>
"""
_LIST = '<ul style="list-style-type: none">'  # an item's own cells begin with its mark
# One ch is a cell, and one em the distance of lines.
_STYLE = """\
h1 { text-align: center; margin: 1em 3ch; font-size: 1em; font-weight: normal }
h2 { margin: 1em 0 0 4ch; font-size: 1em; font-weight: normal }
h3, h4, h5, h6 { margin: 1em 0 0 6ch; font-size: 1em; font-weight: normal }
p { margin: 0; text-indent: 2ch }
pre { margin: 0 0 0 2ch; text-indent: -2ch; white-space: pre-wrap; font: inherit }
th, td { padding: 0 2ch 0 0; font-weight: normal; text-align: left }
aside p { margin-left: 4ch }
blockquote { margin: 1em 0 1em 2ch }
ul { margin: 0; padding: 0 }
li { margin-left: 2ch; text-indent: -2ch }
"""


@dataclass(frozen=True, slots=True)
class Edition:
    """What an eBraille file says of itself beside its imprint, and how it says it in braille.

    Parameters
    ----------
    table
        Table that the book was translated by; None for a book that was in braille.
    modified
        Time of the writing, in UTC.
    complete
        Whether this is the whole book.
    """

    table: BrailleTable | None
    modified: datetime
    complete: bool = True

    @property
    def system(self) -> str:
        """Name of the braille code, with its grade, in the form of eBraille's registry."""
        if self.table is None:
            return "unknown no-grade"
        if self.table.name in _SYSTEMS:
            return _SYSTEMS[self.table.name]
        info = self.table.info
        if info is None:
            return f"{self.table.name} no-grade"
        grade = f"grade{min(int(info.grade), 2)}" if info.grade.isdecimal() else "no-grade"
        return f"{info.title} {grade}"

    def braille(self, text: str) -> str:
        """A few words in braille: by the table, otherwise the cells of their letters alone."""
        if self.table is None:
            plain = "".join(c if c.isascii() and c.isalpha() else " " for c in text)
            return _words(Cells.from_brf(" ".join(plain.split())))
        codes = to_codes(" ".join(text.split()))
        whole = Text(codes, np.arange(codes.size), codes.size, frozenset(codes.tolist()))
        return _words(self.table.translate(whole))


@dataclass(slots=True)
class _Entry:
    """Entry of the table of contents."""

    level: int
    target: str
    name: str


@dataclass(slots=True)
class _Written:
    """What is known of the book once its pages are written."""

    parts: list[str] = field(default_factory=list)
    contents: list[_Entry] = field(default_factory=list)
    pages: list[tuple[str, str, str]] = field(default_factory=list)  # target, print, braille
    six: int = 0
    eight: int = 0


def write_ebraille(
    file: BinaryIO, blocks: Iterable[tuple[Block, Cells]], imprint: Imprint, edition: Edition
) -> None:
    """Write a book as eBraille 1.0; its creator is "unknown", its copyright this year's.

    Parameters
    ----------
    file
        File to write to, which can seek.
    blocks
        Blocks of the book, with their cells.
    imprint, edition
        What the file says of itself.

    Raises
    ------
    OSError
        If the disk cannot take it.
    """
    stamp = edition.modified.timetuple()[:6]

    def put(archive: zipfile.ZipFile, name: str, content: str, how: int) -> None:
        entry = zipfile.ZipInfo(name, stamp)
        entry.compress_type = how
        archive.writestr(entry, content.encode())

    with zipfile.ZipFile(file, "w") as archive:
        put(archive, "mimetype", "application/epub+zip", zipfile.ZIP_STORED)
        put(archive, "META-INF/container.xml", _CONTAINER, zipfile.ZIP_DEFLATED)
        language = _braille_tag(imprint.language)
        title = edition.braille(imprint.title) or _BLANK
        body = _Body(language)
        for name, content in body.parts(blocks):
            put(archive, name, _html(language, title, content), zipfile.ZIP_DEFLATED)
        put(archive, "style.css", _STYLE, zipfile.ZIP_DEFLATED)
        written = body.written
        nav = _navigation(written, title, edition)
        put(archive, "index.html", _html(language, title, nav, primary=True), zipfile.ZIP_DEFLATED)
        package = _package(written, imprint, edition, language)
        put(archive, "package.opf", package, zipfile.ZIP_DEFLATED)


class _Body:
    """Blocks as XHTML, in parts of which each is a file."""

    def __init__(self, language: str) -> None:
        self.written = _Written()
        self._language = language
        self._out: list[str] = []
        self._size = 0
        self._levels = 0  # lists that are open
        self._group = 0  # the list that they are
        self._ids = 0
        self._rows: list[tuple[Block, Cells]] = []  # of the table that is being written
        self._table = 0  # and its group

    def parts(self, blocks: Iterable[tuple[Block, Cells]]) -> Iterable[tuple[str, str]]:
        """Name and content of each part; a part begins at a heading, or where one is full."""
        self._next()
        whole: tuple[Block, list[Cells]] | None = None
        for block, cells in blocks:
            if block.continues and whole is not None:
                whole[1].append(cells)
                continue
            if whole is not None:
                self._add(*whole)
            whole = block, [cells]
            heading = block.kind is BlockKind.HEADING and block.level == 1
            if self._out and (heading or self._size > _PART_CHARACTERS):
                yield self.written.parts[-1], self._end()
                self._next()
        if whole is not None:
            self._add(*whole)
        yield self.written.parts[-1], self._end()

    def _next(self) -> None:
        self.written.parts.append(f"part{len(self.written.parts) + 1:04}.html")

    def _end(self) -> str:
        self._close_table()
        self._close_lists(0)
        content = "".join(self._out)
        self._out.clear()
        self._size = 0
        return content or "<p></p>\n"

    def _put(self, text: str) -> None:
        self._out.append(text)
        self._size += len(text)

    def _add(self, block: Block, pieces: list[Cells]) -> None:
        masks = np.concatenate([cells.masks for cells in pieces])
        high = int((masks > 0x3F).sum())
        self.written.eight += high
        self.written.six += masks.size - high
        cells = Cells.bare(masks)
        if block.kind is not BlockKind.ITEM or block.group != self._group:
            self._close_lists(0)
        self._group = block.group
        text = _words(cells)
        kind = block.kind
        if kind is not BlockKind.ROW or block.group != self._table:
            self._close_table()
        if kind is BlockKind.ROW:
            self._table = block.group
            self._rows.append((block, cells))
            return
        if kind is BlockKind.PAGE:
            self._page(to_text(block.text.codes).strip(), text)
            return
        tag = self._tag(block)
        match kind:
            case BlockKind.HEADING:
                level = min(block.level, 6)
                target = self._id("h")
                place = f"{self.written.parts[-1]}#{target}"
                if text:
                    self.written.contents.append(_Entry(block.level, place, text))
                self._put(f'<h{level} id="{target}"{tag}>{text}</h{level}>\n')
            case BlockKind.ITEM:
                self._item(block.level, f"{tag}>{text}")
            case BlockKind.QUOTE:
                self._put(f"<blockquote><p{tag}>{text}</p></blockquote>\n")
            case BlockKind.NOTE:
                self._put(f'<aside role="doc-footnote"><p{tag}>{text}</p></aside>\n')
            case BlockKind.LINE:
                line = cells.to_unicode().replace(_BLANK, " ").rstrip()
                self._put(f"<pre{tag}>{line}</pre>\n")
            case BlockKind.PARAGRAPH:
                self._put(f"<p{tag}>{text}</p>\n")

    def _close_table(self) -> None:
        """Write the table whose rows are at their end; two blanks or more part their cells."""
        headed = any(block.headers for block, _ in self._rows[1:])
        lines = []
        for number, (block, cells) in enumerate(self._rows):
            name = "th" if headed and not number else "td"
            row = cells.to_unicode().strip(_BLANK)
            parts = (part.strip(_BLANK).replace(_BLANK, " ") for part in row.split(2 * _BLANK))
            inner = "".join(f"<{name}>{part}</{name}>" for part in parts if part)
            lines.append(f"<tr{self._tag(block)}>{inner or '<td></td>'}</tr>\n")
        if lines:
            self._put(f"<table>\n{''.join(lines)}</table>\n")
        self._rows.clear()

    def _tag(self, block: Block) -> str:
        """Attribute that says the language of a block, where it is not the book's."""
        tag = _braille_tag(block.language) if block.language else self._language
        return "" if tag == self._language else f' xml:lang="{tag}" lang="{tag}"'

    def _page(self, printed: str, text: str) -> None:
        if not text:  # a page of braille, which a file of lines has
            return
        target = self._id("page")
        self.written.pages.append((f"{self.written.parts[-1]}#{target}", printed or text, text))
        self._put(
            f'<div id="{target}" role="doc-pagebreak" epub:type="pagebreak" '
            f'aria-label="{text}"></div>\n'
        )

    def _item(self, level: int, opened: str) -> None:
        self._close_lists(level)
        if self._levels == level:
            self._put("</li>\n")
        while self._levels < level:
            self._levels += 1
            # A list within a list stands in an item, one of its own if a level was left out.
            self._put(_LIST + ("" if self._levels == level else "<li>"))
        self._put(f"<li{opened}")

    def _close_lists(self, level: int) -> None:
        """Close the lists that are deeper than a level."""
        while self._levels > level:
            self._put("</li></ul>\n")
            self._levels -= 1

    def _id(self, what: str) -> str:
        self._ids += 1
        return f"{what}-{self._ids}"


def _words(cells: Cells) -> str:
    """Cells in Unicode, with white space for blanks, so that a reading system can wrap lines."""
    return " ".join(cells.to_unicode().replace(_BLANK, " ").split())


def _braille_tag(language: str) -> str:
    """Language tag with the script of braille, such as en-Brai-US; "und-Brai" if unknown."""
    first, *rest = (language or "und").split("-")
    return "-".join((first, "Brai", *(part for part in rest if len(part) != 4)))


def _html(language: str, title: str, body: str, *, primary: bool = False) -> str:
    link = '<link rel="publication" href="package.opf" type="application/oebps-package+xml"/>\n'
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<!DOCTYPE html>\n'
        f'<html xmlns="http://www.w3.org/1999/xhtml" xmlns:epub="http://www.idpf.org/2007/ops" '
        f'xml:lang="{language}" lang="{language}">\n<head>\n<meta charset="utf-8"/>\n'
        f"<title>{title}</title>\n{link if primary else ''}"
        f'<link rel="stylesheet" type="text/css" href="style.css"/>\n</head>\n<body>\n'
        f"{body}</body>\n</html>\n"
    )


def _navigation(written: _Written, title: str, edition: Edition) -> str:
    """Table of contents and list of pages."""
    entries = written.contents or [_Entry(1, written.parts[0], title)]
    contents = _nested(entries)
    nav = (
        f'<nav epub:type="toc" role="doc-toc" aria-label="Table of Contents">\n'
        f"<h2>{edition.braille('Contents')}</h2>\n{contents}\n</nav>\n"
    )
    if written.pages:
        items = "".join(
            f'<li><a href="{target}" title="{escaped(printed)}">{text}</a></li>\n'
            for target, printed, text in written.pages
        )
        nav += (
            f'<nav epub:type="page-list" role="doc-pagelist" aria-label="Page List">\n'
            f"<h2>{edition.braille('Page list')}</h2>\n<ol>\n{items}</ol>\n</nav>\n"
        )
    return nav


def _nested(entries: list[_Entry]) -> str:
    """Lists within lists, by the levels of the entries."""
    out: list[str] = []
    levels: list[int] = []  # of the items that are open, each in the one before
    for entry in entries:
        if not levels or entry.level > levels[-1]:
            out.append("<ol>")
            levels.append(entry.level)
        else:
            while len(levels) > 1 and entry.level <= levels[-2]:
                out.append("</li></ol>")
                levels.pop()
            out.append("</li>")
            levels[-1] = entry.level
        out.append(f'<li><a href="{entry.target}">{entry.name}</a>')
    return "\n".join((*out, *("</li></ol>" for _ in levels)))


def _package(written: _Written, imprint: Imprint, edition: Edition, language: str) -> str:
    kinds = [kind for kind, n in (("6", written.six), ("8", written.eight)) if n] or ["6"]
    if edition.table is not None and edition.table.eight_dots:
        kinds = ["8"]
    elif written.eight > written.six:
        kinds.reverse()
    modified = f"{edition.modified:%Y-%m-%dT%H:%M:%SZ}"
    core = (
        ("dc:format", "eBraille 1.0"),
        ("dc:title", imprint.title),
        ("dc:creator", "unknown"),
        ("dc:language", language),
        ("dc:date", modified[:10]),
    )
    properties = (
        ("dcterms:dateCopyrighted", modified[:4]),
        ("dcterms:modified", modified),
        ("a11y:brailleCellType", ", ".join(kinds)),
        ("a11y:brailleSystem", edition.system),
        ("a11y:completeTranscription", "true" if edition.complete else "false"),
        ("a11y:producer", "vbraille"),
        ("a11y:tactileGraphics", "none"),
    )
    meta = "".join(f"    <{name}>{escaped(value)}</{name}>\n" for name, value in core)
    meta += "".join(
        f'    <meta property="{name}">{escaped(value)}</meta>\n' for name, value in properties
    )
    items = "".join(
        f'    <item id="part{n}" href="{name}" media-type="application/xhtml+xml"/>\n'
        for n, name in enumerate(written.parts, 1)
    )
    spine = "".join(f'    <itemref idref="part{n}"/>\n' for n in range(1, len(written.parts) + 1))
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<package xmlns="http://www.idpf.org/2007/opf" '
        f'version="3.0" unique-identifier="book" xml:lang="{language}">\n'
        f'  <metadata xmlns:dc="http://purl.org/dc/elements/1.1/">\n'
        f'    <dc:identifier id="book">{imprint.identifier}</dc:identifier>\n{meta}'
        f"  </metadata>\n  <manifest>\n"
        f'    <item id="nav" href="index.html" media-type="application/xhtml+xml" '
        f'properties="nav"/>\n'
        f'    <item id="style" href="style.css" media-type="text/css"/>\n{items}'
        f"  </manifest>\n  <spine>\n{spine}  </spine>\n</package>\n"
    )
