"""Texts: liblouis's own tests, the declaration of human rights, large and hostile books."""

from __future__ import annotations

import io
import json
import lzma
import os
import subprocess
import sys
import tempfile
import unicodedata
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING

from tests.benchmarks.timing import Result

if TYPE_CHECKING:
    from collections.abc import Iterator

TEXTS = Path(__file__).parents[2] / "texts"
# Forward tests of liblouis, as JSON in xz: table, text, expected, what lou_translate gives.
TESTS = os.environ.get("VBRAILLE_LIBLOUIS_TESTS", "")
BOOK_WORDS, LONG_CHARACTERS = 120_000, 5_000_000
_OPENED = """
import resource, sys
from time import process_time
from vbraille.layout import Layout
from vbraille.translate import Book, choose_table, open_source
from vbraille.errors import InputError
table = choose_table("en")
began = process_time()
try:
    source = open_source(sys.argv[1])
    Layout(Book(source, table), 30).line(1)
    first = process_time() - began
    source.gather(10**9)
    print(first, process_time() - began, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
except InputError:
    print(process_time() - began, process_time() - began, 0)
"""


def run() -> Iterator[Result]:
    """Rows of the table."""
    if TESTS:
        yield _liblouis_tests()
    yield _declaration()
    with tempfile.TemporaryDirectory() as folder:
        for what, make, bars in (
            (f"EPUB of {BOOK_WORDS:,} words", _epub, (0.1, 1.0, 150)),
            (f"DOCX of {BOOK_WORDS:,} words", _docx, (1.0, 1.0, 150)),
            (f"text of {LONG_CHARACTERS:,} characters", _text, (1.0, 3.0, 150)),
        ):
            path = Path(folder, "book")
            path.write_bytes(make())
            taken = _opened(path)
            within = all(value <= bar for value, bar in zip(taken, bars, strict=True))
            yield Result(
                f"{what}: first line, all blocks, memory",
                "≤ {} s, {} s, {} MB".format(*bars),
                "{:.2f} s, {:.2f} s, {:.0f} MB".format(*taken),
                within,
            )
        yield _hostile(Path(folder))


def _opened(path: Path) -> tuple[float, ...]:
    """Processor seconds to the first line and to all blocks, and memory in MB."""
    done = subprocess.run(
        [sys.executable, "-c", _OPENED, str(path)], check=True, capture_output=True, text=True
    )
    return tuple(map(float, done.stdout.split()))


def _liblouis_tests() -> Result:
    from vbraille.translate import BrailleTable

    tables: dict[str, BrailleTable] = {}
    right, differ = 0, []
    for case in json.loads(lzma.decompress(Path(TESTS).read_bytes())):
        if case.get("typeform") or case["liblouis"] != case["expected"]:
            continue
        if any(unicodedata.category(sign) in ("Cc", "Cf", "Zl", "Zp") for sign in case["text"]):
            continue  # left out by design
        name = case["table"]
        table = tables.get(name) or tables.setdefault(name, BrailleTable(name))
        mask = 0xFF if table.eight_dots else 0x3F
        wanted = bytes(ord(cell) & mask for cell in case["expected"].replace(" ", "\u2800"))
        right += 1
        if table.write(case["text"]).masks != wanted:
            differ.append(name)
    return Result(
        f"of {right:,} of liblouis's own tests: where it is right and we differ",
        "≤ 1 in 1,000", f"{len(differ)} ({', '.join(differ)})", len(differ) * 1_000 <= right,
    )  # fmt: skip


def _declaration() -> Result:
    from vbraille.layout import Layout
    from vbraille.translate import Book, choose_table, open_source

    files = sorted((TEXTS / "declaration").glob("*.txt"))
    right = 0
    for path in files:
        source = open_source(str(path))
        lines = list(Layout(Book(source, choose_table(path.stem)), 26).lines())
        same = "".join(line.text for line in lines) == source.text.replace("\n", "")
        right += same and all(len(line) <= 26 for line in lines)
    return Result(
        "languages of which two articles of the Declaration read back exactly",
        f"{len(files)} of {len(files)}", f"{right} of {len(files)}", right == len(files),
    )  # fmt: skip


def _paragraphs(words: int) -> list[str]:
    own = (TEXTS / "english.txt").read_text().replace("&", "and").replace("<", "").split()
    text = [own[number % len(own)] for number in range(words)]
    return [" ".join(text[start : start + 60]) for start in range(0, words, 60)]


def _zipped(members: dict[str, str]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return stream.getvalue()


def _epub() -> bytes:
    paragraphs = _paragraphs(BOOK_WORDS)
    names = [f"c{number}.xhtml" for number in range(40)]
    items = "".join(
        f'<item id="{n}" href="{n}" media-type="application/xhtml+xml"/>' for n in names
    )
    spine = "".join(f'<itemref idref="{name}"/>' for name in names)
    members = {
        "META-INF/container.xml": '<container><rootfile full-path="p.opf"/></container>',
        "p.opf": f"<package><manifest>{items}</manifest><spine>{spine}</spine></package>",
    }
    share = len(paragraphs) // len(names)
    for number, name in enumerate(names):
        body = "".join(f"<p>{text}</p>" for text in paragraphs[number * share :][:share])
        members[name] = f"<html><body><h1>{number}</h1>{body}</body></html>"
    return _zipped(members)


def _docx() -> bytes:
    body = "".join(
        f'<w:p><w:r><w:rPr><w:lang w:val="en"/></w:rPr><w:t>{text[:200]}</w:t></w:r>'
        f'<w:r><w:rPr><w:i/></w:rPr><w:t xml:space="preserve">{text[200:]}</w:t></w:r></w:p>'
        for text in _paragraphs(BOOK_WORDS)
    )
    space = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"
    document = f'<w:document xmlns:w="{space}"><w:body>{body}</w:body></w:document>'
    return _zipped({"[Content_Types].xml": "<Types/>", "word/document.xml": document})


def _text() -> bytes:
    paragraphs = _paragraphs(LONG_CHARACTERS // 6)
    return "\n\n".join(paragraphs)[:LONG_CHARACTERS].encode()


def _hostile(folder: Path) -> Result:
    """Slowest of the books that are made to be slow."""
    entities = "".join(f'<!ENTITY {chr(98 + n)} "{f"&{chr(97 + n)};" * 10}">' for n in range(9))
    bomb = f'<?xml version="1.0"?><!DOCTYPE html [<!ENTITY a "x">{entities}]><html><p>&j;</html>'
    books = {
        "nested.html": "<html>" + "<div>" * 1_000_000 + "x",
        "tables.html": "<html>" + "<table><tr><td>" * 1_000_000 + "x",
        "emphasis.html": "<html>" + "<b><i>" * 500_000 + "x",
        "attributes.html": f"<html><p {' '.join(f'a{n}=1' for n in range(300_000))}>x",
        "bomb.xhtml": bomb,
        "quotes.md": ">" * 20_000 + " x",
    }
    for name, content in books.items():
        (folder / name).write_text(content)
    whole = _epub()
    (folder / "cut.epub").write_bytes(whole[: len(whole) // 2])
    taken = {name: _opened(folder / name)[0] for name in [*books, "cut.epub"]}
    slowest = max(taken, key=lambda name: taken[name])
    return Result(
        f"slowest of {len(taken)} hostile books to be read or refused ({slowest})",
        "≤ 2 s", f"{taken[slowest]:.2f} s", taken[slowest] <= 2,
    )  # fmt: skip
