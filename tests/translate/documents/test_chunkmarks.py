"""An index of a text: a later opening goes deep into the file and reads only what is there."""

import io
import random

import msgspec
import pytest

from tests.conftest import SEED
from tests.tiers import heavy
from vbraille.translate import Document
from vbraille.translate.documents.document import CHUNK_BYTES
from vbraille.translate.source import Index

# An encoding without states and one with some are tried in every run.
ENCODINGS = [
    "utf-8",
    "iso2022_jp",
    *(pytest.param(name, marks=heavy) for name in ("utf-16", "utf-32", "cp1252")),
]


class Traced(io.BytesIO):
    """A file that tells which of its bytes were read."""

    def __init__(self, content: bytes) -> None:
        super().__init__(content)
        self.read_at: list[tuple[int, int]] = []

    def read(self, size=-1):
        start = self.tell()
        got = super().read(size)
        self.read_at.append((start, self.tell()))
        return got


def many_paragraphs(size: int) -> str:
    """Paragraphs of about so many characters, no two alike; one of them is very long."""
    draw = random.Random(SEED)
    parts, length = ["lang " * 30_000], 150_000
    while length < size:
        words = draw.choices(("mot", "word", "été", "zwölf", "12,5"), k=draw.randint(5, 150))
        parts.append(f"{len(parts)} {' '.join(words)}")
        length += len(parts[-1]) + 2
    return "\n\n".join(parts)


TEXT = many_paragraphs(550_000)


def kept(index: Index) -> Index:
    """Give an index as it comes back from where it was kept."""
    return msgspec.json.decode(msgspec.json.encode(index), type=Index)


def read_through(document: Document) -> int:
    number = 0
    while document.block(number) is not None:
        number += 1
    return number


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_from_an_index_the_blocks_are_the_same(encoding):
    raw = TEXT.replace("é", "e").replace("ö", "o").encode(encoding)
    first = Document(io.BytesIO(raw), encoding=encoding)
    count = read_through(first)
    later = Document(io.BytesIO(raw), encoding=encoding)
    later.adopt(kept(first.index()))
    assert later.complete
    draw = random.Random(SEED)
    for number in (count - 1, 0, 1, 2, *draw.sample(range(count), 12)):
        one, other = first.block(number), later.block(number)
        assert one is not None
        assert other is not None
        assert str(one.text) == str(other.text)
        assert one.text.places.tolist() == other.text.places.tolist()
        assert one.continues == other.continues
        assert later.block_at(one.text.end - 1) == number
        assert later.progress(number) == first.progress(number)
    assert later.block(count) is None


def test_only_what_is_near_is_read():
    raw = TEXT.encode()
    first = Document(io.BytesIO(raw))
    count = read_through(first)
    index = kept(first.index())
    stream = Traced(raw)
    later = Document(stream)
    later.adopt(index)
    stream.read_at.clear()
    deep = first.block(count * 7 // 10)
    assert deep is not None
    number = later.block_at(deep.text.end - 1)
    assert number is not None
    for near in (number, number + 1, number - 1):
        assert later.block(near) is not None
    assert later.title == later.language == ""
    taken = [(start, stop) for start, stop in stream.read_at if start < stop]
    byte = 0.7 * len(raw)
    assert all(byte - 4 * CHUNK_BYTES < start < byte + 4 * CHUNK_BYTES for start, _ in taken)
    assert sum(stop - start for start, stop in taken) <= 3 * CHUNK_BYTES


def test_a_part_of_an_index_is_enough_to_go_on_from():
    raw = TEXT.encode()
    first = Document(io.BytesIO(raw))
    count = read_through(first)
    half = Document(io.BytesIO(raw))
    half.block(count // 2)
    later = Document(io.BytesIO(raw))
    later.adopt(kept(half.index()))
    assert not later.complete
    assert read_through(later) == count
    later.adopt(half.index())  # it knows less
    assert later.complete


@pytest.mark.parametrize(
    "other",
    [
        TEXT[:-200],
        TEXT + "more",
        TEXT[:250_000].replace("mot", "tom") + TEXT[250_000:],
        TEXT[1:] + TEXT[:1],
    ],
)
def test_of_another_file_it_is_not_taken(other):
    first = Document(io.BytesIO(TEXT.encode()))
    read_through(first)
    document = Document(io.BytesIO(other.encode()))
    document.adopt(first.index())
    assert not document.complete
    assert len(document.index().rows) == 1


def test_of_the_same_file_read_otherwise_it_is_not_taken():
    first = Document(io.BytesIO(TEXT.encode()))
    read_through(first)
    for how in ({"keep_lines": True}, {"encoding": "cp1252"}):
        document = Document(io.BytesIO(TEXT.encode()), **how)
        document.adopt(first.index())
        assert not document.complete


def test_opening_a_file_reads_its_beginning_and_no_more():
    stream = Traced(TEXT.encode())
    document = Document(stream)
    assert document.title == document.language == ""
    assert not document.in_cells
    assert not document.complete
    assert document.anchor("x") is None
    assert max(stop for _, stop in stream.read_at) <= CHUNK_BYTES


@heavy
def test_the_index_of_a_large_text_is_small():
    raw = ("\n\n".join(many_paragraphs(400_000).split("\n\n")[1:]) + "\n\n").encode()
    document = Document(io.BytesIO(raw * 120))
    read_through(document)
    assert len(msgspec.json.encode(document.index())) < 80_000
