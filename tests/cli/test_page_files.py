"""``vbraille page`` for embossers: files whole or not at all, BRF and PEF."""

from pathlib import Path

import pytest
from lxml import etree

from tests.cli import program

SAMPLES = Path(__file__).parents[1] / "translate/braillefiles/samples"
SCHEMA = SAMPLES / "pef-2008-1-full.rng"


def test_the_same_book_in_brf_pef_and_unicode_and_back(call, texts, tmp_path):
    book, brf, pef = texts / "english.txt", tmp_path / "book.brf", tmp_path / "book.pef"
    for path, how in ((brf, "brf"), (pef, "pef")):
        said = call("page", book, "--cells", "40", "--format", how, "--out", path)
        assert (said.code, said.out) == (0, "")
        printed = call("page", book, "--cells", "40", "--format", how).out
        assert printed == path.read_text(encoding="utf-8")
    etree.RelaxNG(file=str(SCHEMA)).assertValid(etree.parse(pef))
    pages = call("page", pef, "--format", "brf", "--cells", "40").out
    assert pages.replace("\f", "") == brf.read_text()
    assert {page.count("\n") for page in pages.split("\f")[:-2]} == {25}
    paged, again = tmp_path / "paged.brf", tmp_path / "again.pef"
    paged.write_text(pages)
    assert call("page", paged, "--format", "brf", "--cells", "40").out == pages
    said = call("page", paged, "--format", "pef", "--out", again)
    made = pages.count("\f")
    assert said.err == f"pages: {made} pages of 25 lines, 40 cells each\n"
    rows = [etree.parse(path).xpath("//*[local-name()='row']/text()") for path in (pef, again)]
    assert rows[0] == rows[1]
    patterns = call("page", book, "--cells", "40").out
    assert "".join(patterns.split("\n")) == "".join(rows[0])
    assert call("page", pef, "--lines", "2").out == "⠀⠀⠠⠮⠀⠼⠃⠁⠒⠼⠙⠛⠀⠇⠂⠧⠑⠎⠀⠋\n"


def test_lines_without_pages(call, text, tmp_path):
    said = call("page", text, "--cells", "9", "--format", "brf")
    assert said.out.splitlines()[:2] == ['  "O TWO', "?REE"]
    assert said.err == program.line_width(9)
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


@pytest.mark.parametrize(
    ("options", "wanted"),
    [
        (("--format", "pef", "--model", "vbd"), "as many cells as --cells says; leave out"),
        (("--cells", "40", "--model", "vbd"), "leave out --model"),
        (("--cells", "0"), "0 is not 1 to 200"),
        (("--format", "brf", "--out", "."), ". is a directory"),
        (
            ("--format", "brf", "--out", "no/such/dir"),
            "there is no directory no/such; make it",
        ),
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
    for options in (("--format", "brf"), ("--format", "pef")):
        said = call("page", text, *options, "--out", out)
        assert (said.code, out.read_text()) == (2, "precious")
        assert "already exists" in said.err
    eight = tmp_path / "eight.brf"
    eight.write_text("⠁\n⣿\n")
    said = call("page", eight, "--format", "brf", "--out", out, "--force")
    assert (said.code, out.read_text()) == (2, "precious")
    assert "BRF has six dots and cannot write the cell with dots 1-2-3-4-5-6-7-8; give" in said.err
    assert call("page", text, "--format", "brf", "--out", out, "--force").code == 0
    assert out.read_text().startswith('  "O TWO')
    assert sorted(path.name for path in tmp_path.iterdir()) == ["book.brf", "eight.brf", "text.txt"]


def test_a_book_that_is_not_there(call, tmp_path):
    said = call("page", tmp_path / "no.brf")
    assert (said.code, said.err) == (
        2,
        f"vbraille: there is no file {tmp_path / 'no.brf'}; check the name\n",
    )
