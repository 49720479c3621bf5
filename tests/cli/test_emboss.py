"""``vbraille page`` for embossers: files whole or not at all, BRF, PEF, eBraille, BANA's layout."""

import subprocess
import zipfile
from pathlib import Path

import pytest
from lxml import etree

from tests.cli import program
from tests.tiers import heavy

SAMPLES = Path(__file__).parents[1] / "translate/braillefiles/samples"
SCHEMA = SAMPLES / "pef-2008-1-full.rng"
PAGE = ("--layout", "bana", "--cells", "40", "--lines", "25")


def test_a_control_text_on_pages(call, texts):
    said = call("page", texts / "english.txt", *PAGE, "--format", "brf")
    assert (said.code, said.err) == (0, "pages: 8 pages of 25 lines, 40 cells each\n")
    pages = said.out.split("\f")
    assert len(pages) == 9
    assert pages.pop() == ""
    for number, page in enumerate(pages, 1):
        lines = page.split("\n")
        assert len(lines) == 26
        assert lines[24].endswith(f"  #{'ABCDEFGH'[number - 1]}")
        assert len(lines[24]) == 40
        assert all(len(line) <= 40 and line == line.rstrip() for line in lines)
    assert pages[0].startswith("  ,A ,H5 ON ! ,NI<T ,TRA9\n  ,! #BA3#DG L1VES F PLAT=M")


def test_the_same_book_in_brf_pef_and_unicode_and_back(call, texts, tmp_path):
    book = texts / "english.txt"
    for how in ("brf", "pef"):
        path = tmp_path / f"book.{how}"
        said = call("page", book, *PAGE, "--format", how, "--out", path)
        assert (said.code, said.out) == (0, "")
        assert call("page", book, *PAGE, "--format", how).out == path.read_text(encoding="utf-8")
    brf, pef = tmp_path / "book.brf", tmp_path / "book.pef"
    etree.RelaxNG(file=str(SCHEMA)).assertValid(etree.parse(pef))
    for source in (brf, pef):
        copy = call("page", source, "--format", "brf", "--cells", "40")
        assert (copy.code, copy.out, copy.err) == (0, brf.read_text(), "")
    again = tmp_path / "again.pef"
    said = call("page", brf, "--format", "pef", "--out", again)
    assert said.err == "pages: 8 pages of 25 lines, 40 cells each\n"
    rows = [etree.parse(path).xpath("//*[local-name()='row']/text()") for path in (pef, again)]
    assert rows[0] == rows[1]
    patterns = call("page", book, *PAGE).out
    assert "".join(patterns.replace("\f", "").split("\n")) == "".join(rows[0])
    assert call("page", pef, "--lines", "2").out == "⠀⠀⠠⠮⠀⠼⠃⠁⠒⠼⠙⠛⠀⠇⠂⠧⠑⠎⠀⠋\n"


def test_lines_without_pages(call, text, tmp_path):
    said = call("page", text, "--cells", "9", "--format", "brf")
    assert said.out.splitlines()[:2] == ['  "O TWO', "?REE"]
    assert said.err == "line width: 9 cells, table en-ueb-g2.ctb\n"
    out = tmp_path / "lines.txt"
    assert call("page", text, "--format", "text", "--out", out).out == ""
    assert out.read_text() == "one two three\nfour five six\nseven eight nine\n"
    pef = etree.fromstring(call("page", text, "--format", "pef").out.encode())
    etree.RelaxNG(file=str(SCHEMA)).assertValid(pef)
    assert len(pef.xpath("//*[local-name()='page']")) == 1
    flat = tmp_path / "flat.brf"
    flat.write_bytes(b"A\r\n\r\n  b  \r\n")
    assert call("page", flat, "--format", "brf", "--cells", "40").out == "A\n\n  B\n"
    assert call("page", flat, "--format", "brf", "--cells", "3").out == "A\n\n  B\n"


def test_ebraille_of_a_text(call, texts, tmp_path):
    out = tmp_path / "livre.ebrl"
    said = call(
        "page", texts / "francais.txt", "--language", "fr", "--format", "ebrl", "--out", out
    )
    assert said.code == 0
    assert said.err.startswith('eBraille: creator "unknown", copyright date 20')
    with zipfile.ZipFile(out) as archive:
        package = etree.fromstring(archive.read("package.opf"))
        found = [element.text for element in package.iter("{*}language", "{*}title")]
        assert found == ["francais", "fr-Brai"]
        text = etree.fromstring(archive.read("part0001.html"))
    paragraphs = ["".join(p.itertext()) for p in text.iter("{*}p")]
    lines = call("page", texts / "francais.txt", "--language", "fr").out
    assert "".join(paragraphs).replace(" ", "") == "".join(lines.replace("⠀", "").split())


def test_unknown_characters_are_counted_on_pages_too(call, text):
    text.write_text("hi \U0001f600\n\nthere \U0001f600\n")
    said = call("page", text, "--layout", "bana", "--format", "brf")
    assert "does not know 2 characters (2 of U+1F600 grinning face), emoji by" in said.err


@pytest.mark.parametrize(
    ("options", "wanted"),
    [
        (("--format", "ebrl"), "eBraille is no text to print; name a file with --out BOOK.ebrl"),
        (("--format", "ebrl", "--out", "x", "--layout", "bana"), "leave out --layout"),
        (("--format", "ebrl", "--out", "x", "--lines", "3"), "eBraille has no lines; leave out"),
        (("--layout", "bana", "--cells", "19"), "cells is 19; the layout needs at least 20"),
        (("--layout", "bana", "--lines", "5"), "lines is 5; the layout needs at least 6"),
        (("--layout", "bana", "--lines", "3-9"), "give one number, such as --lines 25"),
        (("--layout", "bana", "--format", "text"), "give --format brf, pef or unicode"),
        (
            ("--layout", "bana", "--model", "vbd"),
            "as many cells as --cells says; leave out --model",
        ),
        (("--cells", "40", "--model", "vbd"), "leave out --model"),
        (("--cells", "0"), "--cells is 0; it must be 1 to 200"),
        (("--format", "brf", "--out", "."), ". is there already"),
        (
            ("--format", "brf", "--out", "no/such/dir"),
            "there is no directory no/such; make it",
        ),
        (("--format", "brf", "--layout", "bana", "--language", "ja"), "eight dots and BRF has six"),
    ],
)
def test_what_cannot_be_is_one_sentence(call, text, options, wanted):
    said = call("page", text, *options)
    assert (said.code, said.out) == (2, "")
    assert wanted in said.err
    assert said.err.count("\n") == 1


def test_a_file_is_replaced_only_by_force_and_whole(call, text, tmp_path):
    out = tmp_path / "book.brf"
    out.write_text("precious")
    for options in (("--format", "brf"), (*PAGE, "--format", "pef"), ("--format", "ebrl")):
        said = call("page", text, *options, "--out", out)
        assert (said.code, out.read_text()) == (2, "precious")
        assert "is there already; choose another name, or replace it by --force" in said.err
    eight = tmp_path / "eight.brf"
    eight.write_text("⠁\n⣿\n")
    said = call("page", eight, "--format", "brf", "--out", out, "--force")
    assert (said.code, out.read_text()) == (2, "precious")
    assert "BRF has six dots and cannot write the cell with dots 1-2-3-4-5-6-7-8; give" in said.err
    assert call("page", text, "--format", "brf", "--out", out, "--force").code == 0
    assert out.read_text().startswith('  "O TWO')
    assert sorted(path.name for path in tmp_path.iterdir()) == ["book.brf", "eight.brf", "text.txt"]


def test_a_dialect_by_its_table(call, tmp_path):
    book = tmp_path / "buch.brl"
    book.write_bytes(b"aB~\n")
    said = call("page", book, "--brf-table", "de-eurobrl6.dis", "--format", "dots")
    assert said.out == "1 1-2 2-3-4-6\n"
    assert call("page", book, "--format", "dots").out == "1 1-2 4-5\n"
    said = call("page", book, "--brf-table", "de-eurobrl7.dis")
    assert (said.code, said.out) == (2, "")
    assert "no display table 'de-eurobrl7.dis'; the nearest are" in said.err
    said = call("page", tmp_path / "no.brf")
    assert (said.code, said.err) == (
        2,
        f"vbraille: there is no file {tmp_path / 'no.brf'}; check the name\n",
    )


@heavy  # a process of its own, for what no call shows: the disk's end
def test_a_full_disk_under_the_page(text):
    with Path("/dev/full").open("wb") as full:
        done = program.run(
            "page", text, *PAGE, "--format", "pef",
            capture_output=False, stdout=full, stderr=subprocess.PIPE,
        )  # fmt: skip
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == "vbraille: No space left on device"
