"""PEF: what is written is valid, what others write is read, and what is hostile is refused."""

import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from tests.tiers import examples
from vbraille.errors import InputError
from vbraille.layout.braillepages import Imprint, kept_pages, pef
from vbraille.translate import BlockKind, Book
from vbraille.translate.braillefiles.pef import PefBook

SAMPLES = Path(__file__).parent / "samples"
SCHEMA = etree.RelaxNG(file=str(SAMPLES / "pef-2008-1-full.rng"))
IMPRINT = Imprint('The "Night" & <Train>\x07', "en-GB", "urn:uuid:1")
NAMESPACES = {"p": "http://www.daisy.org/ns/2008/pef", "dc": "http://purl.org/dc/elements/1.1/"}
ROWS = st.lists(st.integers(0, 255), max_size=8).map(lambda masks: np.array(masks, np.uint8))
PAGES = st.lists(st.lists(ROWS, max_size=4), min_size=1, max_size=80)


def opened(content):
    return PefBook.open(io.BytesIO(content), "book.pef")


def pages_of(content):
    return list(kept_pages(Book(opened(content))))


def whole(body, before=""):
    return f'{before}<pef version="2008-1" xmlns="{NAMESPACES["p"]}"><head/>{body}</pef>'.encode()


@examples(60)
@given(PAGES)
def test_what_is_written_is_valid_and_comes_back(pages):
    content = b"".join(pef(pages, IMPRINT, 8, 4))
    SCHEMA.assertValid(etree.fromstring(content))
    found = pages_of(content)
    assert b"".join(pef(found, IMPRINT, 8, 4)) == content
    strip = [[np.trim_zeros(row, "b").tolist() for row in page] for page in pages]
    assert [[row.tolist() for row in page] for page in found] == strip


def test_what_a_file_says_of_itself():
    content = b"".join(pef([[np.array([1], np.uint8)]], IMPRINT, 40, 25, rowgap=1))
    root = etree.fromstring(content)
    SCHEMA.assertValid(root)
    (volume,) = root.iterfind(".//p:volume", NAMESPACES)
    assert dict(volume.attrib) == {"cols": "40", "rows": "25", "rowgap": "1", "duplex": "false"}
    source = opened(content)
    assert (source.title, source.language) == ('The "Night" & <Train><bell>', "en-GB")
    assert source.in_cells
    assert source.anchor("x") is None
    one, other = (Imprint.of_file("", "", "0" * 64, width) for width in (40, 32))
    assert one.identifier != other.identifier
    assert one == Imprint.of_file("", "", "0" * 64, 40)
    SCHEMA.assertValid(etree.fromstring(b"".join(pef([[]], one, 1, 1))))


def test_a_file_by_another_writer():
    content = (SAMPLES / "brailleutils.pef").read_bytes()
    tree = etree.fromstring(content)
    SCHEMA.assertValid(tree)
    source = opened(content)
    assert source.title == "Generated document"
    found = pages_of(content)
    rows = [
        [row.text or "" for row in page.iterfind("p:row", NAMESPACES)]
        for page in tree.iterfind(".//p:page", NAMESPACES)
    ]
    assert len(found) == 4
    assert [[to_pattern(row) for row in page] for page in found] == [
        [row.rstrip("\u2800") for row in page] for page in rows
    ]
    assert source.block(0).kind is BlockKind.PAGE
    assert str(source.block(1).text) == rows[0][0].rstrip("\u2800")


def to_pattern(row):
    return "".join(chr(0x2800 + mask) for mask in row.tolist())


BOMB = "".join(f'<!ENTITY a{n} "{f"&a{n - 1};" * 10 if n else "⠁"}">' for n in range(10))


@pytest.mark.parametrize(
    ("content", "wanted"),
    [
        (b"", "is empty"),
        (b"<pef", "is damaged XML"),
        (b"<html/>", "is no PEF file: it begins with html"),
        (whole("<body/>"), "has no page in it"),
        (whole("<page><row>⠁x</row></page>"), r"has 'x' in a row \(line 1\), where"),
        (whole("<page><row>⠁<b/></row></page>"), r"has an element in a row \(line 1\)"),
        (
            whole("<page><row>&a9;</row></page>", f"<!DOCTYPE pef [{BOMB}]>"),
            "is damaged XML: Maximum",
        ),
        (
            whole(
                "<page><row>&x;</row></page>",
                '<!DOCTYPE pef [<!ENTITY x SYSTEM "file:///etc/passwd">]>',
            ),
            "declares entities",
        ),
        (whole("<page><row>&x;</row></page>"), "is damaged XML: Entity 'x' not defined"),
        (whole("<page>" * 300 + "</page>" * 300), "is damaged XML: .*depth"),
    ],
)
def test_what_is_hostile_or_damaged_is_one_sentence(content, wanted):
    with pytest.raises(InputError, match=wanted) as caught:
        opened(content)
    assert str(caught.value).startswith("book.pef ")
    assert "\n" not in str(caught.value)


@examples(60)
@given(st.data())
def test_a_damaged_file_is_read_or_refused_in_one_sentence(data):
    content = bytearray((SAMPLES / "brailleutils.pef").read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(content)))
        content[start : start + data.draw(st.integers(0, 9))] = data.draw(st.binary(max_size=9))
    try:
        pages = pages_of(bytes(content))
    except InputError as error:
        refused = str(error)
    else:
        assert pages
        return
    assert refused.startswith("book.pef ")
    assert "\n" not in refused


def test_a_file_that_is_too_large_is_not_read():
    class Endless(io.RawIOBase):
        def seek(self, *_):
            return 0

        def read(self, size=-1):
            return bytes(size)

    with pytest.raises(InputError, match="is larger than 200 MB"):
        PefBook.open(Endless(), "book.pef")


def test_comments_and_blanks_are_no_cells():
    body = "<page><!-- x --><row> ⠁<!-- ⠃ -->⠉\n</row><row/></page><page/>"
    found = pages_of(whole(body))
    assert [[to_pattern(row) for row in page] for page in found] == [["⠁⠉", ""], []]
