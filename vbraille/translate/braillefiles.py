"""Files in braille: BRF, Unicode braille and PEF as lines of cells, which are never translated."""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING

from vbraille.braille.cells import UNICODE_BLANK, Cells
from vbraille.errors import InputError
from vbraille.translate.blocks import Block, BlockKind
from vbraille.translate.encodings import decode
from vbraille.translate.trees import parse_xml
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from vbraille.translate.source import Source

# White space of files, and the no-break space that some programs write for a blank cell.
_BLANKS = str.maketrans("\t\u00a0", "  ")
PEF_NAMESPACE = "http://www.daisy.org/ns/2008/pef"
DUBLIN_CORE = "http://purl.org/dc/elements/1.1/"


def read_brf(source: Source, encoding: str | None = None) -> Iterator[Block]:
    """Read ASCII braille or Unicode braille, with its lines and its pages by form feed."""
    text, _ = decode(source.stream.read(), encoding)
    if not re.search("[!-~⠁-⣿]", text):
        raise InputError(f"{source.name} has no braille in it; give a file of braille")
    source.expected = len(text)
    text = text.rstrip("\x1a\0 \n\r\t").replace("\r\n", "\n").replace("\r", "\n")
    pages = [
        [line.translate(_BLANKS).rstrip() for line in sheet.removesuffix("\n").split("\n")]
        for sheet in text.rstrip("\f").split("\f")
    ]
    return _blocks(source, pages, "[^ -~⠀-⣿]", numbered="\f" in text)


def _blocks(
    source: Source, pages: Iterable[list[str]], strange: str, *, numbered: bool = True
) -> Iterator[Block]:
    """Lines of cells by pages, without what is no braille, which is counted."""
    source.in_cells = True
    passed: Counter[str] = Counter()
    for number, rows in enumerate(pages, 1):
        if numbered:  # by the file, which does not write the number
            yield Block("", BlockKind.PAGE, cells=Cells.from_brf(""), group=number)
        for row in rows:
            passed.update(re.findall(strange, row))
            text = re.sub(strange, "", row)
            yield Block(text, BlockKind.LINE, cells=Cells.from_brf(text))
    if passed:
        codes = ", ".join(f"U+{ord(sign):04X}" for sign in list(passed)[:5])
        source.note(
            f"{source.name} has {count(passed.total(), 'character')} that are no braille, passed "
            f"over: {codes}"
        )


def read_pef(source: Source) -> Iterator[Block]:
    """Read PEF: pages and rows through all volumes.

    Raises
    ------
    InputError
        If it is no whole XML, or larger than a book.
    """
    root = parse_xml(source.stream.read(), source.name)
    source.title, source.language = root.said("title"), root.said("language")
    blank = chr(UNICODE_BLANK)
    blanks = str.maketrans(dict.fromkeys("\t\u00a0 \n\r", blank))
    pages = (
        [row.text.strip("\n\r").translate(blanks).rstrip(blank) for row in page.iter("row")]
        for page in root.iter("page")
    )
    return _blocks(source, pages, "[^⠀-⣿]")
