"""Files in braille: BRF, Unicode braille and PEF as lines of cells, which are never translated."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells
from vbraille.errors import InputError
from vbraille.translate.blocks import Block, BlockKind
from vbraille.translate.encodings import decode
from vbraille.translate.liblouis import display_dots
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.source import Source

# White space of files, and the no-break space that some programs write for a blank cell.
_BLANKS = str.maketrans("\t\u00a0", "  ")
_PATTERN = re.compile(b"\xe2[\xa0-\xa3][\x80-\xbf]")  # of dots, in UTF-8
_BRAILLE = re.compile("[!-~⠁-⣿]")
_ASCII = "".join(map(chr, range(0x20, 0x7F)))
PEF_NAMESPACE = "http://www.daisy.org/ns/2008/pef"
DUBLIN_CORE = "http://purl.org/dc/elements/1.1/"


_NO_CELLS = Cells.bare(np.empty(0, np.uint8))


def _page(number: int) -> Block:
    """A page begins that the file counts without writing its number."""
    return Block("", BlockKind.PAGE, cells=_NO_CELLS, group=number)


class _Stray:
    """Counts what is no braille and passed over."""

    def __init__(self, source: Source) -> None:
        self._source, self._first, self._number = source, "", 0

    def see(self, character: str, where: str) -> None:
        if not self._number:
            self._first = f"U+{ord(character):04X} in {where}"
        self._number += 1

    def say(self) -> None:
        if self._number:
            self._source.note(
                f"{self._source.name} has {count(self._number, 'character')} that are no braille, "
                f"passed over; the first is {self._first}"
            )


def read_brf(
    source: Source, encoding: str | None = None, brf_table: str | None = None
) -> Iterator[Block]:
    """Read ASCII braille or Unicode braille, with its lines and its pages by form feed."""
    content = source.stream.read()
    is_text = encoding or content[:3] == b"\xef\xbb\xbf" or _PATTERN.search(content)
    wide = content[:2] in (b"\xff\xfe", b"\xfe\xff")
    text = decode(content, encoding)[0] if is_text or wide else content.decode("latin-1")
    dialect = {} if brf_table is None else _dialect(brf_table)
    if not _BRAILLE.search(text):
        raise InputError(f"{source.name} has no braille in it; give a file of braille")
    source.in_cells = True
    source.expected = len(text)
    return _lines(source, text.rstrip("\x1a\0 \n\r\t"), dialect)


def _lines(source: Source, text: str, dialect: dict[str, str]) -> Iterator[Block]:
    stray = _Stray(source)
    text = text.replace("\r\n", "\n").replace("\r", "\n").translate(_BLANKS)
    pages = text.rstrip("\f").split("\f")
    for number, sheet in enumerate(pages, 1):
        if "\f" in text:
            yield _page(number)
        for place, line in enumerate(sheet.removesuffix("\n").split("\n"), 1):
            where = f"line {place}" + (f" of page {number}" if len(pages) > 1 else "")
            kept = []
            for character in line.rstrip():
                character = dialect.get(character, character)
                if 0x20 <= ord(character) < 0x7F or 0 <= ord(character) - UNICODE_BLANK < 0x100:
                    kept.append(character)
                else:
                    stray.see(character, where)
            yield _line("".join(kept))
    stray.say()


def _line(text: str) -> Block:
    return Block(text, BlockKind.LINE, cells=Cells.from_file(text))


def _dialect(table: str) -> dict[str, str]:
    """Cells of each ASCII character by a display table of liblouis; capitals as small letters."""
    dots = display_dots(table, _ASCII)
    found = {}
    for character, mask in zip(_ASCII, dots, strict=True):
        small = ord(character.lower()) - 0x20
        mask = dots[small] & 0x3F if character.isupper() else mask & 0x3F
        if mask or character == " ":
            found[character] = chr(UNICODE_BLANK + mask)
    return found


def read_pef(source: Source) -> Iterator[Block]:
    """Read PEF: pages and rows through all volumes.

    Raises
    ------
    InputError
        If it is no whole XML, or larger than a book.
    """
    from lxml import etree

    parser: Any = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
    try:
        root = etree.fromstring(source.stream.read(), parser)
    except (etree.XMLSyntaxError, ValueError) as error:
        said = " ".join(str(error).split())
        raise InputError(f"{source.name} is a damaged PEF file ({said}); get it again") from None
    if root.getroottree().docinfo.internalDTD is not None:
        raise InputError(f"{source.name} declares entities, which a PEF file must not; get another")
    for name in ("title", "language"):
        said = root.findtext(f".//{{{DUBLIN_CORE}}}{name}") or ""
        setattr(source, name, " ".join(said.split()))
    source.in_cells = True
    return _rows(source, root)


def _rows(source: Source, root: Any) -> Iterator[Block]:
    stray = _Stray(source)
    for number, sheet in enumerate(root.iter(f"{{{PEF_NAMESPACE}}}page"), 1):
        yield _page(number)
        for place, row in enumerate(sheet.iter(f"{{{PEF_NAMESPACE}}}row"), 1):
            kept = []
            for character in "".join(row.itertext()).strip("\n\r").translate(_BLANKS):
                if character in " \n\r":
                    kept.append(chr(UNICODE_BLANK))
                elif 0 <= ord(character) - UNICODE_BLANK < 0x100:
                    kept.append(character)
                else:
                    stray.see(character, f"row {place} of page {number}")
            yield _line("".join(kept).rstrip(chr(UNICODE_BLANK)))
    stray.say()
