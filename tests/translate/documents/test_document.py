"""Documents: the same paragraphs however the file is read, and every fault in one sentence."""

import codecs
import gc
import io
import itertools
import os
import random
import threading
import tracemalloc
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conftest import SEED
from tests.tiers import by_tier, examples, heavy
from tests.translate.model import Piece, pieces_of
from vbraille.errors import InputError, VbrailleError
from vbraille.translate import Block, BlockKind, Document
from vbraille.translate.documents.document import CHUNK_BYTES

GAPS = [" "] * 40 + ["\n"] * 8 + ["\r\n", "\r", "  ", "\t", "-\n", "\xad\n", "\x85", "\u2028"]
ENDS = ["\n\n", "\r\n\r\n", "\n \n", "\f", "\u2029", "\n\n\n\n\n"]
STRAYS = ["\xa0", "\xad", "\ufeff", "\0", "\x1b", "e\u0301", "😀", "漢字", "и", "\u202f"]


class Repeated(io.RawIOBase):
    """A file in which one text stands again and again, of any size; counts what is read."""

    def __init__(self, text: bytes, size: int) -> None:
        super().__init__()
        self.text, self.size, self.at, self.taken = text, size, 0, 0

    def seekable(self) -> bool:
        return True

    def seek(self, offset, whence=io.SEEK_SET):
        self.at = offset if whence == io.SEEK_SET else self.size + offset
        return self.at

    def read(self, size=-1):
        size = min(size, self.size - self.at)
        start = self.at % len(self.text)
        self.at += size
        self.taken += size
        return (self.text * (1 + (start + size) // len(self.text)))[start : start + size]


def document(raw: bytes, encoding: str | None = None, *, keep_lines: bool = False) -> Document:
    return Document(io.BytesIO(raw), "a.txt", encoding, keep_lines=keep_lines)


def blocks(document: Document) -> list[Block]:
    return list(iter_blocks(document))


def iter_blocks(document: Document):
    found = map(document.block, itertools.count())
    return itertools.takewhile(lambda block: block is not None, found)


def pieces(document: Document) -> list[Piece]:
    return [piece(p) for p in iter_blocks(document)]


def piece(block: Block) -> Piece:
    return Piece(str(block.text), block.text.places.tolist(), block.continues)


@cache
def made_text(words: tuple[str, ...], length: int, *, ends: bool) -> str:
    """Words and what may stand between them, drawn by chance, and the same every time."""
    chance = random.Random(SEED)
    text, size = [], 0
    while size < length:
        word = chance.choice(words)
        if chance.random() < 0.1:
            word += chance.choice(STRAYS) + chance.choice(words)
        gap = chance.choice(ENDS if ends and chance.random() < 0.02 else GAPS)
        text.append(word + gap)
        size += len(text[-1])
    return "".join(text)


@pytest.fixture(scope="module")
def words(texts) -> tuple[str, ...]:
    text = (texts / "francais.txt").read_text() + (texts / "deutsch.txt").read_text()
    return tuple(sorted(set(text.split())))


@pytest.mark.no_cover
class TestChunks:
    """Where the file's chunks end must not show."""

    @pytest.mark.parametrize(
        ("encoding", "length", "keep_lines"),
        [
            ("utf-8", 135_000, False),
            ("utf-16-be", 67_500, True),
            ("utf-32", 35_000, False),
            # What is found is the same text, decoded from other bytes.
            pytest.param("utf-8", 135_000, True, marks=heavy),
            pytest.param("utf-16", 67_500, False, marks=heavy),
            pytest.param("gb18030", 135_000, False, marks=heavy),
        ],
    )
    def test_as_the_model(self, words, encoding, length, keep_lines):
        text = made_text(words, length, ends=True)
        raw = text.encode(encoding)
        assert len(raw) > 2 * CHUNK_BYTES
        named = encoding if encoding == "gb18030" else None
        found = pieces(document(raw, named, keep_lines=keep_lines))
        assert found == pieces_of(text, keep_lines=keep_lines)

    def test_a_paragraph_longer_than_many_blocks(self, words):
        no_items = tuple(word for word in words if word[0].isalpha() and word[-1] not in ").")
        text = made_text(no_items, 140_000, ends=False)
        found = pieces(document(text.encode()))
        assert found == pieces_of(text)
        assert len(found) > 16
        assert {p.continues for p in found[1:]} == {True}

    def test_a_run_of_blanks_of_any_length_takes_no_memory_and_keeps_the_places(self):
        blanks = 2_000_000
        raw = b"x" + b" " * blanks + b"y\nz"
        for keep_lines in (False, True):
            gc.collect()
            tracemalloc.start()
            found = pieces(document(raw, keep_lines=keep_lines))
            _, peak = tracemalloc.get_traced_memory()
            tracemalloc.stop()
            assert peak < 12 * CHUNK_BYTES * 8
            shown = "".join(piece.text for piece in found)
            places = [place for piece in found for place in piece.source]
            assert shown.split() == (["x", "yz"] if keep_lines else ["x", "y", "z"])
            letters = [place for place, c in zip(places, shown, strict=True) if c != " "]
            assert letters == [0, blanks + 1, blanks + 3]

    @pytest.mark.parametrize(
        "unit",
        [
            "€",
            "\r\n\r\n",
            "x\xad\n",
            "e\u0301 ",
            *(pytest.param(u, marks=heavy) for u in ("é", "😀", "\r\n")),
        ],
    )
    def test_what_straddles_a_boundary(self, unit):
        line, size = b"a" * 62 + b"\n\n", len(unit.encode())
        for shift in range(size + 1):
            before = (line * 1_024)[2 * size - shift :]
            tail = f"{unit * 4}end of it"
            after = f"\n\n{tail}"
            expected = [
                p._replace(source=[len(before) + at for at in p.source]) for p in pieces_of(tail)
            ]
            for whole in (tail, tail + after):
                found = pieces(document(before + whole.encode()))
                assert found[1_024:][: len(expected)] == expected

    @pytest.mark.parametrize("shift", [3, CHUNK_BYTES - 1])
    def test_blanks_in_front_move_the_places_and_nothing_else(self, words, shift):
        text = made_text(words, 135_000, ends=True)
        plain = blocks(document(text.encode()))
        moved = blocks(document(b" " * shift + text.encode()))
        assert [str(p.text) for p in moved] == [str(p.text) for p in plain]
        assert np.array_equal(
            np.concatenate([p.text.places for p in moved]),
            np.concatenate([p.text.places for p in plain]) + shift,
        )

    @pytest.mark.parametrize(
        ("blank", "keep_lines"),
        [
            *((blank, False) for blank in ("\n", " ", "\r\n", " \t\n", "\f", "\ufeff", "\xad")),
            *((blank, True) for blank in ("\n", "\ufeff", "\xad")),
            # Kept lines of these take as long as that of "\n", which ends lines as they do.
            *(pytest.param(blank, True, marks=heavy) for blank in (" ", "\r\n", " \t\n", "\f")),
        ],
    )
    def test_long_stretches_of_nothing(self, blank, keep_lines):
        nothing = blank * (CHUNK_BYTES // len(blank.encode()) + 1)
        text = f"\n{nothing}  one{nothing}  two  {nothing}"
        found = pieces(document(text.encode(), keep_lines=keep_lines))
        assert found == pieces_of(text, keep_lines=keep_lines)

    def test_nothing_but_blanks(self):
        blank = document(b" \n" * 100_000)
        assert blank.block(0) is None
        assert blank.block_at(0) is None
        assert document(b"\n").block(0) is None

    @pytest.mark.parametrize("damage", [70_000, 131_071])
    def test_a_later_bad_byte_is_windows_1252(self, damage):
        raw = bytearray("aé€ ".encode() * 20_000)
        raw[damage] = 0x92
        text = bytes(raw).decode("utf-8", "surrogateescape")
        whole = "".join(
            bytes([ord(c) - 0xDC00]).decode("cp1252") if "\udc80" <= c <= "\udcff" else c
            for c in text
        )
        found = document(bytes(raw))
        assert pieces(found) == pieces_of(whole)
        assert found.encoding.name == "utf-8"


@pytest.mark.no_cover
class TestRandomAccess:
    @pytest.mark.parametrize("keep_lines", [False, True])
    def test_blocks_in_any_order(self, words, keep_lines):
        text = made_text(words, 80_000, ends=True)
        one = document(text.encode(), keep_lines=keep_lines)
        expected = pieces(one)
        order = list(range(len(expected))) * 2
        random.Random(SEED).shuffle(order)
        other = document(text.encode(), keep_lines=keep_lines)
        for n in order[:25]:
            assert piece(other.block(n)) == expected[n]
            assert piece(one.block(n)) == expected[n]
        assert other.block(len(expected)) is None
        assert other.block(-1) is None

    def test_pieces_of_a_long_paragraph_in_any_order(self, words):
        text = made_text(words, 140_000, ends=False)
        expected = pieces(document(text.encode()))
        other = document(text.encode())
        for n in (13, 3, 16, 0, 11, 12, 10):
            assert piece(other.block(n)) == expected[n]

    def test_an_encoding_with_a_state(self):
        text = "日本語の文章。\n\n" * 5_000
        raw = text.encode("iso2022_jp")
        other = document(raw, "iso2022_jp")
        assert pieces(other) == pieces_of(text)
        for n in (4_999, 5, 3_789):
            assert str(other.block(n).text) == "日本語の文章。"

    @pytest.mark.parametrize("keep_lines", [False, True])
    def test_block_at(self, words, keep_lines):
        text = made_text(words, 80_000, ends=True)
        found = blocks(document(text.encode(), keep_lines=keep_lines))
        chance = random.Random(SEED)
        other = document(text.encode(), keep_lines=keep_lines)
        for n in chance.sample(range(len(found)), 15):
            text = found[n].text
            if len(text):
                assert other.block_at(int(text.places[0])) == n
                assert other.block_at(int(text.places[-1])) == n
                assert other.block_at(text.end) != n
        assert other.block_at(0) == 0
        assert other.block_at(found[-1].text.end) is None
        assert other.block_at(10**12) is None

    def test_blanks_belong_to_what_follows(self):
        found = document(b"  one\n\n\ntwo\n\n")
        assert [found.block_at(c) for c in range(14)] == [0] * 5 + [1] * 6 + [None] * 3

    def test_progress_grows_from_0_to_1(self, words):
        found = document(made_text(words, 80_000, ends=True).encode())
        count = len(blocks(found))
        shares = [found.progress(n) for n in range(count + 1)]
        assert shares == sorted(shares)
        assert shares[0] == 0
        assert shares[-1] == 1
        assert abs(shares[count // 2] - 0.5) < 0.1


@pytest.mark.no_cover
class TestLazy:
    def test_only_what_is_asked_for_is_read(self):
        stream = Repeated(b"A short paragraph.\n\n", 10**9)
        found = Document(stream)
        assert str(found.block(100).text) == "A short paragraph."
        assert found.block_at(1_000) == 50
        assert stream.taken <= 4 * CHUNK_BYTES

    @pytest.mark.parametrize(
        ("text", "size"),
        [
            (b"Some words in a line.\nAnd some more words. " * 40 + b"\n\n", 1_200_000),
            (b"word and no end ", 1_200_000),
            (b"abcdefghij", 1_200_000),
            (b"\n", 10_000_000),
            (b"\n \r\n", 1_500_000),
        ],
    )
    def test_a_big_text_takes_little_memory(self, text, size):
        gc.collect()
        tracemalloc.start()
        try:
            count = sum(1 for _ in iter_blocks(Document(Repeated(text, size))))
            _, peak = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
        assert count >= (0 if text.isspace() else size / 8_193)
        assert peak < 8_000_000


class TestSource:
    def test_its_blocks_are_paragraphs_or_the_lines_that_are_kept(self):
        for keep_lines, kind in ((False, BlockKind.PARAGRAPH), (True, BlockKind.LINE)):
            found = blocks(document(b"one\n\ntwo\nthree", keep_lines=keep_lines))
            assert {(block.kind, block.level, block.cells) for block in found} == {(kind, 0, None)}

    def test_from_text_counts_the_characters_of_the_string(self):
        text = "\ufeffone \ud800 😀\n\ntwo"
        found = Document.from_text(text)
        assert pieces(found) == pieces_of(text)
        assert pieces(found)[0].source[0] == 1
        assert found.note() is None

    def test_a_mark_is_no_character(self):
        for encoding in ("utf-8-sig", "utf-16", "utf-32"):
            assert pieces(document("one".encode(encoding))) == [Piece("one", [0, 1, 2], False)]

    @examples(120)
    @given(st.binary(min_size=1, max_size=120), st.booleans())
    def test_any_bytes_are_a_text_or_refused(self, raw, keep_lines):
        try:
            found = document(raw, keep_lines=keep_lines)
        except InputError:
            return
        check_nothing_lost(found, raw)

    @pytest.mark.no_cover
    def test_thousands_of_byte_strings(self):
        chance = random.Random(SEED)
        tokens = [bytes([b]) for b in range(256)]
        tokens += [s.encode() for s in (*GAPS, *ENDS, *STRAYS, "word", "Wort", "é", "€")] * 6
        for n in range(by_tier(300, 1_500, 15_000)):
            raw = b"".join(chance.choices(tokens, k=chance.randrange(1, 40)))
            encoding = ("utf-8", "cp1252", "utf-16", "utf-32-be", "shift_jis", "utf-7")[n % 6]
            check_nothing_lost(document(raw, encoding, keep_lines=n % 4 == 0), raw)


def check_nothing_lost(found: Document, raw: bytes) -> None:
    """Every character but for white space is in a paragraph, and each knows its place."""
    text = raw[found.encoding.skip :].decode(found.encoding.name, "vbraille-keep")
    kept = pieces(found)
    assert kept == pieces_of(text, keep_lines=found.keep_lines)
    dropped = "\ufeff\xad"
    printed = [c for c in text if not c.isspace() and c not in dropped]
    shown = [c for p in kept for c in p.text if not c.isspace()]
    if not any("\u0300" <= c <= "\u309f" for c in text):
        assert shown == printed
    for p in kept:
        for c, at in zip(p.text, p.source, strict=True):
            assert c == text[at] or c.isspace() or text[at + 1] >= "\u0300"


class TestNote:
    def test_utf8_needs_none(self):
        for raw in (b"plain", "café".encode(), "café".encode("utf-8-sig")):
            found = document(raw)
            blocks(found)
            assert found.note() is None

    def test_a_guess_is_said_once(self, texts):
        text = (texts / "francais.txt").read_text()
        found = document(text.encode("cp1252"))
        offset = next(n for n, c in enumerate(text) if c > "\x7f")
        assert found.note() == (
            f"a.txt is not UTF-8 (byte {offset}); it is read as cp1252, "
            f"‹encoding› NAME says otherwise"
        )
        assert found.note() is None
        assert str(found.block(3).text) == str(document(text.encode()).block(3).text)

    @pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-32"])
    def test_utf16_is_said_too(self, texts, encoding):
        found = document((texts / "english.txt").read_text().encode(encoding))
        note = found.note()
        assert note is not None
        assert "is not UTF-8 (byte " in note
        assert f"read as {found.encoding.name}, ‹encoding›" in note

    def test_a_later_byte_is_said_when_it_is_found(self):
        raw = b"plain text\n\n" * 12_000 + b"caf\xe9\n"
        found = document(raw)
        assert found.block(0) is not None
        assert found.note() is None
        assert str(blocks(found)[-1].text) == "café"
        assert found.note() == (
            f"a.txt is not utf-8 at byte {len(raw) - 2}; such bytes are read as windows-1252, "
            f"‹encoding› NAME says otherwise"
        )
        assert found.note() is None

    def test_the_first_of_many_after_a_mark(self):
        found = document(codecs.BOM_UTF8 + "é".encode() + b"\xff x" + b"\xe9")
        assert [str(p.text) for p in blocks(found)] == ["éÿ xé"]
        assert "at byte 5;" in found.note()

    def test_a_named_encoding_overrides_and_needs_none(self, texts):
        raw = (texts / "deutsch.txt").read_text().encode("cp1252")
        found = document(raw, "cp850")
        assert found.encoding.name == "cp850"
        assert str(blocks(found)[0].text) == raw.decode("cp850").split("\n")[0]
        assert found.note() is None
        assert document("text".encode("utf-16"), "utf-16").note() is None


class TestRefused:
    @pytest.mark.parametrize("name", ["", "base64", "rot13", "idna", "hex", "é\0", "\ud800"])
    def test_encodings_that_are_none(self, name):
        with pytest.raises(InputError, match=r"there is no text encoding .*try windows-1252"):
            document(b"text", name)

    @pytest.mark.parametrize("raw", [b"", codecs.BOM_UTF8, codecs.BOM_UTF16_BE])
    def test_nothing(self, raw):
        with pytest.raises(InputError, match=r"a\.txt is empty; give a text file"):
            document(raw)
        with pytest.raises(InputError, match="text is empty"):
            Document.from_text("")

    def test_a_picture_unless_an_encoding_says_that_it_is_text(self):
        raw = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"
        with pytest.raises(InputError, match=r"a\.txt is a PNG image, not text"):
            document(raw)
        assert str(blocks(document(raw, "latin-1"))[0].text) == "\x89PNG \x1a \0\0\0 IHDR"

    @pytest.mark.no_cover
    @pytest.mark.parametrize(
        ("name", "message"),
        [
            ("missing.txt", r"there is no file .*missing\.txt; check the name"),
            ("", "is a directory; give a text file in it"),
            ("a\0b", "cannot be read: embedded null byte"),
            ("x" * 300, "cannot be read: File name too long"),
            ("empty.txt", "is empty"),
            ("picture.txt", "is a GIF image, not text"),
            ("full.txt/part.txt", "cannot be read: Not a directory"),
        ],
    )
    def test_files(self, tmp_path, name, message):
        (tmp_path / "empty.txt").touch()
        (tmp_path / "full.txt").write_text("text")
        (tmp_path / "picture.txt").write_bytes(b"GIF89a\0\0")
        with pytest.raises(InputError, match=message):
            Document.open(tmp_path / name)
        gc.collect()  # a file left open would be a warning, and so an error

    def test_a_file_that_became_shorter(self, tmp_path):
        path = tmp_path / "book.txt"
        path.write_text("A paragraph.\n\n" * 30_000)
        found = Document.open(path)
        assert len(blocks(found)) == 30_000
        path.write_text("A paragraph.\n\n" * 100)
        with pytest.raises(VbrailleError, match="has become shorter since it was opened; open it"):
            found.block(10_000)
        found.close()

    def test_a_file_that_becomes_shorter_before_its_end_is_read(self, tmp_path):
        path = tmp_path / "book.txt"
        path.write_text("A paragraph.\n\n" * 12_000)
        found = Document.open(path)
        assert str(found.block(10).text) == "A paragraph."
        path.write_text("A paragraph.\n\n" * 6_000)
        with pytest.raises(VbrailleError, match="has become shorter since it was opened; open it"):
            blocks(found)
        found.close()

    def test_a_file_that_grows_is_read_as_far_as_it_was_and_it_is_said_once(self, tmp_path):
        path = tmp_path / "book.txt"
        path.write_text("A paragraph.\n\n" * 12_000)
        found = Document.open(path)
        assert str(found.block(10).text) == "A paragraph."
        with path.open("a") as file:
            file.write("More.\n\n" * 100)
        assert found.note() is None
        assert {str(block.text) for block in blocks(found)} == {"A paragraph."}
        assert found.note() == (
            f"{path} has grown since it was opened; open it again to read what was added"
        )
        assert found.note() is None
        found.close()


class TestOpen:
    def test_a_file(self, texts):
        path = texts / "english.txt"
        found = Document.open(str(path))
        assert pieces(found) == pieces_of(path.read_text())
        assert found.name == str(path)
        assert found.size == path.stat().st_size
        found.close()

    def test_a_pipe(self, tmp_path):
        pipe = tmp_path / "pipe"
        os.mkfifo(pipe)
        text = "A paragraph.\n\n" * 10_000
        writer = threading.Thread(target=pipe.write_text, args=(text,))
        writer.start()
        found = Document.open(pipe)
        writer.join()
        assert len(blocks(found)) == 10_000
        assert str(found.block(0).text) == "A paragraph."

    def test_a_file_that_says_it_has_no_size(self):
        found = Document.open("/proc/self/status", keep_lines=True)
        assert found.size > 0
        assert str(found.block(0).text).startswith("Name:")


@pytest.mark.parametrize("keep_lines", [False, True])
def test_chunks_whose_blocks_nobody_wants_are_passed_and_end_where_they_would(keep_lines):
    text = "".join(f"Paragraph {n}\n" + "\n" * (n % 3 == 0) for n in range(20_000))
    text += "a long one " * 20_000 + "\n\n- an item\n\n\n"
    read, passed, sought = (
        Document(io.BytesIO(text.encode()), "a", "utf-8", keep_lines=keep_lines) for _ in range(3)
    )
    number = 0
    while read.block(number) is not None:
        number += 1
    while passed.extend():
        assert passed.index().rows == read.index().rows[: len(passed.index().rows)]
    assert passed.index() == read.index()
    assert passed.complete
    assert sought.block(number) is None
    assert sought.index() == read.index()
    assert str(passed.block(number - 1).text) == str(read.block(number - 1).text)
    assert not passed.extend()
