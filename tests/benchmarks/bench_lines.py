"""Lines and their texts: languages read back, random texts, and no cut inside a character."""

from __future__ import annotations

import random
import tempfile
from functools import cache
from pathlib import Path
from subprocess import run as run_program
from typing import TYPE_CHECKING

from tests.benchmarks.timing import Result, vbraille
from tests.conftest import SEED, TEXTS
from tests.laid import cuts_inside, laid_out, rebuilt
from vbraille.layout.pages import Layout
from vbraille.translate import Book, BrailleTable, Cells, Document, find_table

if TYPE_CHECKING:
    from collections.abc import Iterator

RANDOM_TEXTS = 10_000
WIDTHS = (8, 26, 28, 40)
TABLES = (
    "en-ueb-g2.ctb",
    "en-ueb-g1.ctb",
    "de-g2.ctb",
    "fr-bfu-comp6.utb",
    "fr-bfu-g2.ctb",
    "ru-litbrl.ctb",
    "zh-tw.ctb",
    "ko-g2.ctb",
    "el.ctb",
    "hi.tbl",
    "nl-NL-g0.utb",
    "fr-bfu-comp8.utb",
)
_PIECES = (
    "/",
    "\u2014",
    " -- ",
    "\xc4",
    "\xc9",
    "ABC",
    "12,5",
    "3/4",
    "\u4e2d\u6587",
    "\u0434\u0430",
    "\U0001f600",
    "\xa0",
    "\u2800",
    "\u200b",
    "e\u0301",
    "\n",
    "\n\n",
    "\t",
    "-\n",
    "\xad",
    "\ufeff",
    "\f",
    "_\bx",
    "https://a.org/b",
    "McDonald",
    "...",
    "(",
    '"',
    "\0",
    " ",
    " ",
    " ",
    " the ",
    " and ",
    "ing",
    "\u0928\u092e\u0938\u094d\u0924\u0947",
    "\uc548\ub155",
)


@cache
def _table(name: str) -> BrailleTable:
    return BrailleTable(name)


def run() -> Iterator[Result]:
    yield from _languages()
    yield _random_texts()
    cuts = lines = 0
    for name, language in (("english.txt", "en"), ("francais.txt", "fr"), ("deutsch.txt", "de")):
        text = (TEXTS / name).read_text()
        for width in WIDTHS:
            layout = Layout(Book(Document.from_text(text), _table(find_table(language))), width)
            cuts, lines = cuts + cuts_inside(layout), lines + layout.count()
    yield Result(
        f"cuts inside a symbol in {lines:,} lines of English, French and German of 8 to 40 cells",
        "0", str(cuts), cuts == 0,
    )  # fmt: skip


def _languages() -> Iterator[Result]:
    """Every language's paragraphs by the program, as text and as cells."""
    right, files, cuts, unknown, lines = 0, 0, 0, [], 0
    with tempfile.TemporaryDirectory() as folder:
        for path in sorted((TEXTS / "declaration").glob("*.txt")):
            files += 1
            source = Path(folder) / path.name
            source.write_text(path.read_text())
            page = vbraille("page", str(source), "--language", path.stem)
            said = run_program([*page, "--format", "text"], capture_output=True, text=True)
            cells = run_program(page, capture_output=True, text=True)
            document = Document.open(source)
            layout = Layout(Book(document, _table(find_table(path.stem))), 26)
            printed = [line.printed.masks.tobytes() for line in layout.lines()]
            same = said.stdout.replace("\n", "") == laid_out(layout)
            again = [Cells.from_unicode(line).masks.tobytes() for line in cells.stdout.splitlines()]
            right += same and again == printed and said.returncode == 0
            if "does not know" in said.stderr:
                unknown.append(path.stem)
            for width in WIDTHS:
                layout = Layout(Book(document, layout.book.table), width)
                cuts, lines = cuts + cuts_inside(layout), lines + layout.count()
                right -= rebuilt(layout) != laid_out(layout)
    yield Result(
        "languages of which two articles of the Declaration read back exactly",
        "≥ 40, all", f"{right} of {files}", right == files >= 40,
    )  # fmt: skip
    yield Result(
        f"cuts inside a symbol in their {lines:,} lines of 8 to 40 cells", "0", str(cuts), cuts == 0
    )
    yield Result(
        "languages whose text has characters that their table does not know",
        "reported", ", ".join(unknown) or "none", True,
    )  # fmt: skip


def _random_texts() -> Result:
    draw = random.Random(SEED)
    wrong = 0
    for _ in range(RANDOM_TEXTS):
        text = "".join(draw.choices(_PIECES, k=draw.randint(1, 40)))
        keep_lines, width = draw.random() < 0.5, draw.randint(1, 40)
        document = Document.from_text(text, keep_lines=keep_lines)
        layout = Layout(Book(document, _table(draw.choice(TABLES))), width)
        wrong += rebuilt(layout) != laid_out(layout) or cuts_inside(layout) > 0
    return Result(
        f"of {RANDOM_TEXTS:,} random texts: lines that are not the text, or that cut a symbol",
        "0", str(wrong), not wrong,
    )  # fmt: skip
