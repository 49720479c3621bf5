"""Texts: starting, paging, translating."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from tests.benchmarks.big_texts import big_text
from tests.benchmarks.timing import Result, process_ratio, ratio, vbraille

if TYPE_CHECKING:
    from collections.abc import Iterator

FIRST_PAGE = ("--lines", "1-25")

_PAGE_THROUGH = """
import resource, sys
from vbraille.layout.pages import Layout
from vbraille.translate import Book, BrailleTable, Document
layout = Layout(Book(Document.open(sys.argv[1]), BrailleTable("en-ueb-g2.ctb")), 26)
lines = sum(1 for _ in layout.lines())
print(lines, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024)
"""


def run() -> Iterator[Result]:
    share = process_ratio(vbraille("--help"), [sys.executable, "-c", "pass"])
    yield Result(
        "`vbraille --help`, against `python -c pass`", "≤ 3 ×", f"{share:.1f} ×", share <= 3
    )
    with tempfile.TemporaryDirectory() as folder:
        yield from _texts(Path(folder))


def _texts(folder: Path) -> Iterator[Result]:
    large, small = big_text(folder / "4mb", 4_000_000), big_text(folder / "40kb", 40_000)
    share = process_ratio(
        vbraille("page", str(large), *FIRST_PAGE), vbraille("page", str(small), *FIRST_PAGE)
    )
    yield Result(
        "`vbraille page` of the first page of 4 MB, against 40 kB",
        "≤ 1.3 ×",
        f"{share:.2f} ×",
        share <= 1.3,
    )

    import louis

    from vbraille.layout.pages import Layout
    from vbraille.translate import Book, BrailleTable, Document

    table = BrailleTable("en-ueb-g2.ctb")
    path = big_text(folder / "1mb", 1_000_000)
    document = Document.open(path)
    texts = []
    while (paragraph := document.paragraph(len(texts))) is not None:
        texts.append(paragraph.text)

    def bare() -> None:
        for text in texts:
            louis.translate([table.name], text, mode=louis.dotsIO | louis.ucBrl)

    share, _ = ratio(lambda: Layout(Book(Document.open(path), table), 26).count(), bare, pairs=7)
    yield Result(
        "translating and laying out 1 MB, against bare `louis.translate` of its paragraphs",
        "≤ 1.1 ×",
        f"{share:.2f} ×",
        share <= 1.1,
    )

    huge = big_text(folder / "50mb", 50_000_000)
    done = subprocess.run(
        [sys.executable, "-c", _PAGE_THROUGH, str(huge)], check=True, capture_output=True, text=True
    )
    lines, megabytes = map(int, done.stdout.split())
    yield Result(
        f"memory while paging through 50 MB ({lines:,} lines)",
        "≤ 200 MB",
        f"{megabytes} MB",
        megabytes <= 200,
    )
