"""Files in braille: BRF, Unicode braille and PEF as lines of cells, which are never translated."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from vbraille.braille.cells import UNICODE_BLANK, Cells
from vbraille.errors import InputError
from vbraille.translate.blocks import Block, BlockKind
from vbraille.translate.encodings import decode
from vbraille.translate.liblouis import LOUIS
from vbraille.translate.trees import parse_xml
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from vbraille.translate.source import Source

# White space of files, and the no-break space that some programs write for a blank cell.
_BLANKS = str.maketrans("\t\u00a0", "  ")
_PATTERN = re.compile(b"\xe2[\xa0-\xa3][\x80-\xbf]")  # of dots, in UTF-8
_ASCII = "".join(map(chr, range(0x20, 0x7F)))
PEF_NAMESPACE = "http://www.daisy.org/ns/2008/pef"
DUBLIN_CORE = "http://purl.org/dc/elements/1.1/"


def read_brf(
    source: Source, encoding: str | None = None, brf_table: str | None = None
) -> Iterator[Block]:
    """Read ASCII braille or Unicode braille, with its lines and its pages by form feed."""
    content = source.stream.read()
    is_text = encoding or content[:3] == b"\xef\xbb\xbf" or _PATTERN.search(content)
    wide = content[:2] in (b"\xff\xfe", b"\xfe\xff")
    text = decode(content, encoding)[0] if is_text or wide else content.decode("latin-1")
    if not re.search("[!-~⠁-⣿]", text):
        raise InputError(f"{source.name} has no braille in it; give a file of braille")
    source.in_cells = True
    source.expected = len(text)
    text = text.rstrip("\x1a\0 \n\r\t").replace("\r\n", "\n").replace("\r", "\n")
    dialect = {} if brf_table is None else _dialect(brf_table)
    sheets = text.rstrip("\f").split("\f")
    pages = (
        [line.translate(_BLANKS).rstrip().translate(dialect) for line in lines]
        for lines in (sheet.removesuffix("\n").split("\n") for sheet in sheets)
    )
    strange = re.compile("[^ -~⠀-⣿]")
    return _blocks(source, pages, strange, "line", numbered="\f" in text)


def _blocks(
    source: Source,
    pages: Iterable[list[str]],
    strange: re.Pattern[str],
    what: str,
    *,
    numbered: bool = True,
) -> Iterator[Block]:
    """Lines of cells by pages, without what is no braille, which is counted."""
    passed, first = 0, ""
    for number, rows in enumerate(pages, 1):
        if numbered:  # by the file, which does not write the number
            yield Block("", BlockKind.PAGE, cells=Cells.from_brf(""), group=number)
        for place, row in enumerate(rows, 1):
            wrong = strange.findall(row)
            if wrong and not passed:
                page = f" of page {number}" if numbered else ""
                first = f"U+{ord(wrong[0]):04X} in {what} {place}{page}"
            passed += len(wrong)
            text = strange.sub("", row)
            yield Block(text, BlockKind.LINE, cells=Cells.from_brf(text))
    if passed:
        source.note(
            f"{source.name} has {count(passed, 'character')} that are no braille, passed over; "
            f"the first is {first}"
        )


def _dialect(table: str) -> dict[int, str]:
    """Cells of each ASCII character by a display table of liblouis; capitals as small letters."""
    try:
        dots = LOUIS.ask("display_dots", table, _ASCII)
    except RuntimeError:
        raise InputError(f"liblouis has no display table {table!r}") from None
    found = {}
    for character in _ASCII:
        mask = dots[ord(character.lower()) - 0x20] & 0x3F
        if mask or character == " ":
            found[ord(character)] = chr(UNICODE_BLANK + mask)
    return found


def read_pef(source: Source) -> Iterator[Block]:
    """Read PEF: pages and rows through all volumes.

    Raises
    ------
    InputError
        If it is no whole XML, or larger than a book.
    """
    root = parse_xml(source.stream.read(), source.name)
    source.title, source.language = root.said("title"), root.said("language")
    source.in_cells = True
    blank = chr(UNICODE_BLANK)
    blanks = _BLANKS | str.maketrans(" \n\r", 3 * blank)
    pages = (
        [row.text.strip("\n\r").translate(blanks).rstrip(blank) for row in page.iter("row")]
        for page in root.iter("page")
    )
    return _blocks(source, pages, re.compile("[^⠀-⣿]"), "row")
