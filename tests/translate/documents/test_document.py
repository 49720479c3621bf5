"""Documents: no character lost, and every fault in one sentence."""

import codecs
import gc
import os
import random
import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conftest import SEED
from tests.tiers import by_tier, examples
from tests.translate.documents.pieces import ENDS, GAPS, STRAYS, blocks, document, pieces
from tests.translate.model import Piece, pieces_of
from vbraille.errors import InputError, VbrailleError
from vbraille.translate import BlockKind, Document


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

    @pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-32"])
    def test_nothing_is_said_of_what_has_a_mark(self, texts, encoding):
        assert document((texts / "english.txt").read_text().encode(encoding)).note() is None

    @pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
    def test_utf16_without_one_is_said_too(self, texts, encoding):
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
