"""Books opened where they were left: from the command to the first line under the hand."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import zipfile
from html import escape
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from tests.benchmarks.big_texts import big_text
from tests.benchmarks.timing import Result
from vbraille.reading.library import KeptPlaces, book_options, resume
from vbraille.translate.formats import open_source

if TYPE_CHECKING:
    from collections.abc import Iterator

ROUNDS = 7
PLACE = 0.7  # share of each book that was read
CHAPTERS, CHAPTER_BYTES = 188, 11_000
BAR_S = 1.5

_CONTAINER = """<container xmlns="urn:oasis:names:tc:opendocument:xmlns:container" version="1.0">
<rootfiles><rootfile full-path="package.opf"
media-type="application/oebps-package+xml"/></rootfiles></container>"""
_PACKAGE = """<package xmlns="http://www.idpf.org/2007/opf" version="3.0" unique-identifier="id">
<metadata xmlns:dc="http://purl.org/dc/elements/1.1/"><dc:identifier id="id">made</dc:identifier>
<dc:title>A made book</dc:title><dc:language>en</dc:language></metadata>
<manifest>{items}</manifest><spine>{spine}</spine></package>"""
_CHAPTER = """<html xmlns="http://www.w3.org/1999/xhtml"><head><title>{n}</title></head><body>
<h1>Chapter {n}</h1>{paragraphs}</body></html>"""


def run() -> Iterator[Result]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        os.environ["VBRAILLE_PLACES"] = str(folder / "places.sqlite")
        books = {
            "short": big_text(folder / "short.txt", 50_000),
            "long": big_text(folder / "long.txt", 50_000_000),
            "epub": _epub(folder),
        }
        for book in books.values():
            _leave(book)
        for book in books.values():
            _open(book)  # so that all of them are warm
        taken = {what: [] for what in books}
        for _ in range(ROUNDS):  # in turn, since machines change their speed
            for what, book in books.items():
                taken[what].append(_open(book))
    least = min(taken["long"])
    what = "from the command to the first line under the hand, 50 MB of text at 70 %"
    yield Result(what, f"≤ {BAR_S} s", f"{least:.2f} s at best", least <= BAR_S)
    for name, what, bar in (
        ("long", "the same against a text of 50 kB", 1.5),
        ("epub", "an EPUB of 2 MB, 188 chapters, at 70 %, against that text", 1.2),
    ):
        ratio = statistics.median(a / b for a, b in zip(taken[name], taken["short"], strict=True))
        yield Result(what, f"≤ {bar} ×", f"{ratio:.2f} ×", ratio <= bar)


def _epub(folder: Path) -> Path:
    """Make an EPUB of so many chapters."""
    text = big_text(folder / "source.txt", CHAPTERS * CHAPTER_BYTES).read_text().split("\n\n")
    size = -(-len(text) // CHAPTERS)
    path = folder / "book.epub"
    numbers = range(CHAPTERS)
    items = "".join(
        f'<item id="c{n}" href="c{n}.xhtml" media-type="application/xhtml+xml"/>' for n in numbers
    )
    spine = "".join(f'<itemref idref="c{n}"/>' for n in numbers)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as book:
        book.writestr("mimetype", "application/epub+zip", zipfile.ZIP_STORED)
        book.writestr("META-INF/container.xml", _CONTAINER)
        book.writestr("package.opf", _PACKAGE.format(items=items, spine=spine))
        for n in numbers:
            paragraphs = "".join(f"<p>{escape(p)}</p>" for p in text[n * size : (n + 1) * size])
            book.writestr(f"c{n}.xhtml", _CHAPTER.format(n=n + 1, paragraphs=paragraphs))
    return path


def _leave(path: Path) -> None:
    """Keep a place deep in a book, as a reading does that ends there."""
    source = open_source(str(path))
    last = 0
    while source.block(last + 1) is not None:
        last += 1
    deep = next(n for n in range(last + 1) if source.progress(n) >= PLACE)
    block = source.block(deep)
    assert block is not None
    with KeptPlaces.open() as places:
        kept = places.book(path)
        resume(source, kept, book_options({}))
        kept.keep_at(source, int(block.text.places[0]))
        kept.keep_index(source.index())
        kept.close()
    source.close()


def _open(path: Path) -> float:
    """Seconds from the command until it says the line that is under the hand."""
    begun = perf_counter()
    command = [sys.executable, "-m", "vbraille", "read", str(path), "--echo", "text"]
    with subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    ) as reading:
        assert reading.stdout is not None
        said = reading.stdout.readline()
        passed = perf_counter() - begun
        reading.kill()
    assert said.startswith((b"line: ", b"place: ")), said
    return passed
