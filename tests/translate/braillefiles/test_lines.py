"""BRF and Unicode braille: read tolerantly, in any order, and written back byte for byte."""

import hashlib
import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples
from vbraille.errors import InputError, VbrailleError
from vbraille.layout.braillepages import brf_lines, brf_pages, kept_pages
from vbraille.translate import BlockKind, Book, Cells
from vbraille.translate.braillefiles.lines import (
    PART_BYTES,
    BrailleLines,
    open_brf,
    open_unicode_braille,
)

SAMPLES = Path(__file__).parent / "samples"
ASCII = " A1B'K2L@CIF/MSP\"E3H9O6R^DJG>NTQ,*5<-U8V.%[$+X!&;:4\\0Z7(_?W]#Y)="
PAGE = "page"
# Lines as the strict form has them: without a blank at the end.
LINES = st.text(st.sampled_from(ASCII), max_size=12).map(lambda line: line.rstrip(" "))
PAGES = st.lists(st.lists(LINES, max_size=5), min_size=1, max_size=5)


def opened(content, **options):
    return open_brf(io.BytesIO(content), "book.brf", **options)


def blocks(source):
    found = []
    while (block := source.block(len(found))) is not None:
        found.append(block)
    return found


def said(source):
    """Lines as BRF, or the word page."""
    return [
        PAGE if block.kind is BlockKind.PAGE else block.cells.to_brf() for block in blocks(source)
    ]


@pytest.mark.parametrize(
    ("content", "wanted"),
    [
        (b"A\nB\n", ["A", "B"]),
        (b"A\r\nB\r\n", ["A", "B"]),
        (b"A\rB\r", ["A", "B"]),
        (b"A\nB", ["A", "B"]),
        (b"A\n\n\nB\n", ["A", "", "", "B"]),
        (b"A\r\n\r\nB", ["A", "", "B"]),
        (b"A\n\fB\n\f", [PAGE, "A", PAGE, "B"]),
        (b"A\r\n\fB\r\n", [PAGE, "A", PAGE, "B"]),
        (b"A\fB\f", [PAGE, "A", PAGE, "B"]),
        (b"A\r\fB", [PAGE, "A", PAGE, "B"]),
        (b"A\n\f\r\nB\n", [PAGE, "A", PAGE, "", "B"]),
        (b"A\n\f\f\fB\n", [PAGE, "A", PAGE, PAGE, PAGE, "B"]),
        (b"\fA", [PAGE, PAGE, "A"]),
        (b"A \t \n   \nB\tC\n  ", ["A", "", "B C"]),
        (b"\xef\xbb\xbfA\nB\n\x1a", ["A", "B"]),
        (b" a`{|}~z\n", [" A@[\\]^Z"]),
    ],
)
def test_whatever_ends_lines_and_pages(content, wanted):
    assert said(opened(content)) == wanted


def test_a_cell_knows_its_byte():
    content = b" ab\r\n\r\n\fc d\r\n"
    for block in blocks(opened(content)):
        for place, mask in zip(block.text.places, block.cells.masks, strict=True):
            assert Cells.from_brf(chr(content[place])).masks[0] == mask
        assert block.cells.starts.tolist() == block.text.places.tolist()
    source = opened(content)
    ends = [block.text.end for block in blocks(opened(content))]
    assert ends == sorted(ends)
    assert [source.block_at(at) for at in (0, 1, 4, 5, 8, 9, 99)] == [1, 1, 1, 2, 4, 4, None]


@pytest.mark.parametrize(
    ("content", "wanted"),
    [
        (b"A\x01", r"byte 0x01 is no ASCII braille \(line 1, byte 2 of the file\); give"),
        (b"A\r\nB\fC\n,\xe9", r"byte 0xE9 is no ASCII braille \(line 4, byte 9 of"),
        (b"A\n" * 40_000 + b"\x7f", r"0x7F .*\(line 40001, byte 80001 of"),
        ("⠁\n⠃é".encode(), r"'é' is neither ASCII braille nor .* \(line 2, byte 8 of"),
        ("⠁\n⠃".encode() + b"\xff", r"byte 0xFF is no UTF-8 \(line 2, byte 8 of"),
        (b"", "is empty; give a file of braille"),
        (b"PK\x03\x04AAAA", "is a zip archive"),
        (b"A\x00\x00\x01\x02\x03" * 9, "is binary data, not braille"),
    ],
)  # fmt: skip
def test_what_is_no_braille_is_named_with_its_place(content, wanted):
    with pytest.raises(InputError, match=wanted) as caught:
        blocks(opened(content))
    assert str(caught.value).startswith("book.brf ")


def test_a_dialect_is_what_a_display_table_says():
    assert said(opened(b"abc ABC", brf_table="en-us-brf.dis")) == ["ABC ABC"]
    (german,) = blocks(opened(b"aB~`%", brf_table="de-eurobrl6.dis"))
    assert german.cells.to_dots() == "1 1-2 2-3-4-6 3-4-5 1-2-3-4-5-6"
    (spanish,) = blocks(opened(b"aZ\xe9@", brf_table="es-new.dis"))
    assert spanish.cells.to_dots() == "1 1-3-5-6 2-3-4-6 5"
    assert said(opened(b"@`A", brf_table="text_nabcc.dis")) == ["@@A"]
    with pytest.raises(InputError, match=r"display table 'de-eurobrl7.dis'; the nearest are de-"):
        opened(b"a", brf_table="de-eurobrl7.dis")
    with pytest.raises(InputError, match="byte 0x80 is no ASCII braille"):
        blocks(opened(b"\x80", brf_table="de-eurobrl6.dis"))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le"])
def test_unicode_braille_in_other_encodings(encoding):
    text = "⠠⠁⠀⠃\n\n⣿ A\u00a0B\n"
    named = encoding if encoding == "utf-16-le" else None
    source = open_unicode_braille(io.BytesIO(text.encode(encoding)), "x", named)
    assert [block.cells.to_unicode() for block in blocks(source)] == ["⠠⠁⠀⠃", "", "⣿⠀⠁⠀⠃"]
    if encoding != "utf-16-le":
        assert str(opened(text.encode(encoding)).block(0).text) == "⠠⠁⠀⠃"


def test_an_encoding_that_is_none_or_does_not_fit():
    with pytest.raises(InputError, match="there is no text encoding 'braille'"):
        open_unicode_braille(io.BytesIO(b"a"), "x", "braille")
    with pytest.raises(InputError, match="x is not utf-32-le at byte 0; give its text enc"):
        open_unicode_braille(io.BytesIO("a⠁".encode("utf-16-le")), "x", "utf-32")  # fmt: skip
    with pytest.raises(InputError, match="x is empty"):
        open_unicode_braille(io.BytesIO(b""), "x")


@examples(100)
@given(PAGES)
def test_the_strict_form_comes_back_byte_for_byte(pages):
    content = "".join("".join(f"{line}\n" for line in page) + "\f" for page in pages).encode()
    written = b"".join(brf_pages(kept_pages(Book(opened(content)))))
    assert written == content
    flat = "".join(f"{line}\n" for page in pages for line in page).encode()
    if flat:
        (rows,) = kept_pages(Book(opened(flat)))
        assert brf_lines(rows) == flat


@examples(60)
@given(st.lists(st.text(st.integers(0x2800, 0x28FF).map(chr), max_size=9), min_size=1, max_size=9))
def test_unicode_braille_comes_back_byte_for_byte(lines):
    content = "".join(line.rstrip("\u2800") + "\n" for line in lines).encode()
    (rows,) = kept_pages(Book(open_unicode_braille(io.BytesIO(content), "x")))
    written = "".join(f"{Cells.bare(row).to_unicode()}\n" for row in rows)
    assert written.encode() == content


@examples(100)
@given(st.binary(max_size=200) | st.text(max_size=60).map(str.encode), st.booleans())
def test_any_bytes_are_read_or_refused_in_one_sentence(content, dialect):
    table = "de-eurobrl6.dis" if dialect else None
    try:
        found = blocks(opened(content, brf_table=table))
    except InputError as error:
        refused = str(error)
    else:
        assert all(len(block.cells) == len(block.text) for block in found)
        return
    assert refused.startswith("book.brf ")
    assert "\n" not in refused


def made(seed):
    """A file of three parts, whose ends are where they hurt."""
    rng = np.random.default_rng(seed)
    pieces, ends = [], [b"\r\n", b"\n", b"\r", b"\f", b"\r\n\f", b"\n\f"]
    while sum(map(len, pieces)) < 2.5 * PART_BYTES:
        length = int(
            rng.choice([0, 3, 40, 40, 40, 3_000, 100_000], p=[0.2, 0.2, *[0.19] * 3, 0.02, 0.01])
        )
        line = rng.choice(np.frombuffer(ASCII.encode(), np.uint8), length).tobytes()
        pieces += [line, ends[int(rng.integers(len(ends)))]]
    return b"".join(pieces)  # fmt: skip


@pytest.mark.parametrize("seed", range(4))
def test_parts_are_read_in_any_order_and_nothing_is_lost(seed):
    content = made(seed)
    expected = blocks(opened(content))
    together, lines = "", []
    for block in expected:
        together += block.cells.to_brf()
        if not block.continues:
            lines.append(block.kind)
    text = content.decode().replace("\r\n", "\n").replace("\r", "\n")
    assert together.replace(" ", "") == "".join(text.split()).upper()
    assert max(len(block.text) for block in expected) <= 8_192
    source = opened(content)
    source.adopt(opened(content).index())
    later = opened(content)
    whole = opened(content)
    blocks(whole)
    later.adopt(whole.index())
    assert later.complete
    for number in np.random.default_rng(seed).permutation(len(expected))[:200].tolist():
        for found in (source.block(number), later.block(number)):
            assert found.text.places.tolist() == expected[number].text.places.tolist()
            assert found.cells.masks.tolist() == expected[number].cells.masks.tolist()
            assert found.continues == expected[number].continues
    assert source.block(len(expected)) is None
    shares = [whole.progress(number) for number in range(0, len(expected), 50)]
    assert shares == sorted(shares)


def test_what_stands_at_the_edge_of_a_part():
    for gap in range(-3, 4):
        for end in (b"\r\n", b"\r\n\r\n", b"\n\f", b"\r\f", b"\r\r", b"  \n"):
            content = b"\f" + b"A" * (PART_BYTES + gap) + end + b"B\n"
            lines = "".join(
                "|" * (not b.continues) + b.cells.to_brf() for b in blocks(opened(content))
            )
            few = opened(b"\fA" + end + b"B\n")
            wanted = "".join("|" + block.cells.to_brf() for block in blocks(few))
            assert lines == wanted.replace("A", "A" * (PART_BYTES + gap)), (gap, end)
    patterns = ("⠁" * (PART_BYTES // 3 + 5) + " ⠃\n⠉").encode()
    text = "".join(block.cells.to_unicode() for block in blocks(opened(patterns)))
    assert text == "⠁" * (PART_BYTES // 3 + 5) + "⠀⠃⠉"


def test_another_file_or_dialect_takes_no_index():
    first, other = opened(b"A\nB\n"), opened(b"A\nB\n", brf_table="en-us-brf.dis")
    blocks(first)
    other.adopt(first.index())
    assert not other.complete
    assert (first.anchor("x"), first.note(), first.in_cells) == (None, None, True)
    assert first.sha256() == hashlib.sha256(b"A\nB\n").hexdigest()


def test_a_file_that_has_become_shorter(tmp_path):
    path = tmp_path / "book.brf"
    path.write_bytes(b"A\n" * PART_BYTES)
    source = open_brf(path.open("rb"), "book.brf")
    with path.open("r+b") as file:
        file.truncate(10)
    with pytest.raises(VbrailleError, match="has become shorter since it was opened"):
        source.block(0)
    source.close()
    with pytest.raises(ValueError, match="closed file"):
        source.block(0)


def test_a_file_in_the_wild():
    source: BrailleLines = open_brf((SAMPLES / "file2brl.brf").open("rb"), "file2brl.brf")
    assert said(source) == [
        *(PAGE, "", "           ,NI<T TRA9", "", "         ,! ,NI<T ,TRA9", ""),
        *("  ,! #BA3DG L1VES F PLAT=M  #A", PAGE, "", "#I1 ! ONLY PLAT=M )\\T A RO(2"),
        *("8,I H \"W$ X0 = #BB YE>S4", "", "    ,BO>D+", ",DOORS" + " " * 22 + "#B", PAGE, ""),
        *(",LAMPS", "  ,SECOND PAGE ;7) BRACES72 &", ";E-MAIL _+A@B.ORG_^X._:", ""),
        " " * 28 + "#C",
    ]  # fmt: skip
