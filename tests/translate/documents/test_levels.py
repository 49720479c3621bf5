"""One text with superscripts, subscripts and notes reads the same in every form that has them."""

from pathlib import Path

import pytest

from vbraille.translate import Book, BrailleTable
from vbraille.translate.formats import open_source
from vbraille.translate.source import MarkKind

FILES = Path(__file__).parent / "files" / "levels"
FORMS = (
    "epub2.epub",
    "epub3.epub",
    "pandoc.docx",
    "pandoc.odt",
    "pandoc.rtf",
    "pandoc.html",
    "html4.html",
)
READ = [
    ("heading", "Powers of 10⁶"),
    ("paragraph", "It began in 1931[1] and grew by 10⁶ to 3.5[2] times as much H₂O."),
    ("paragraph", "The 19th century knew xⁿ⁺¹ and 10⁻³; f[3] is 5²3."),
    ("row", "year  m³"),
    ("row", "1931[4]  10⁶"),
    ("note", "1. In the spring, 4² days late."),
    ("note", "2. Or 3.6."),
    ("note", "3. A force."),
    ("note", "4. About."),
]
SMALL = (MarkKind.SUPERSCRIPT, MarkKind.SUBSCRIPT)


def read(name: str):
    """Kind, text, small parts and cells of each block from the first heading on."""
    book = Book(open_source(str(FILES / name)), BrailleTable("en-ueb-g2.ctb"))
    found, number = [], 0
    while (pair := book.block(number)) is not None:
        block, cells = pair
        text = str(block.text)
        small = [
            (mark.kind, text[block.text.index(mark.start) : block.text.index(mark.end)])
            for mark in block.marks
            if mark.kind in SMALL
        ]
        found.append(((block.kind.value, text), small, cells.to_unicode()))
        number += 1
    first = next(n for n, block in enumerate(found) if block[0] == READ[0])
    return found[first:]


@pytest.mark.parametrize("name", FORMS)
def test_a_text_by_pandoc_reads_the_same_in_every_form(name):
    found = read(name)
    assert [block for block, _, _ in found] == READ
    assert found == read("levels.md")


def test_the_cells_of_english():
    cells = " ".join(cells for _, _, cells in read("levels.md"))
    for written in (
        "⠼⠁⠊⠉⠁⠨⠣⠼⠁⠨⠜",
        "⠼⠁⠚⠰⠔⠼⠋",
        "⠼⠉⠲⠑⠨⠣⠼⠃⠨⠜",
        "⠠⠓⠰⠢⠼⠃⠠⠕⠲",
        "⠭⠰⠔⠣⠝⠐⠖⠼⠁⠜",
        "⠼⠑⠰⠔⠣⠼⠃⠜⠼⠉",
    ):
        assert written in cells
