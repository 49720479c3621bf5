"""Bytes to characters: the right encoding, and never a byte lost."""

import bz2
import codecs
import encodings.aliases
import gzip
import io
import lzma
import random
import zipfile

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conftest import SEED
from tests.tiers import examples
from vbraille.translate.documents.encodings import (
    SAMPLE_BYTES,
    Encoding,
    TextDecoder,
    binary_kind,
    find_encoding,
    first_not_utf8,
    named_encoding,
)

MARKS = {
    "utf-8": codecs.BOM_UTF8,
    "utf-16-le": codecs.BOM_UTF16_LE,
    "utf-16-be": codecs.BOM_UTF16_BE,
    "utf-32-le": codecs.BOM_UTF32_LE,
    "utf-32-be": codecs.BOM_UTF32_BE,
}
SIZES = (200, 300, 500, 1_000, 4_000, 16_000, 65_536)
ESCAPED = "".join(map(chr, range(0xDC80, 0xDD00)))
OPEN_IN_1252 = b"\x81\x8d\x8f\x90\x9d"
FOUND = (
    named_encoding(name, b"")
    for name in {*encodings.aliases.aliases.values(), "utf-8-sig", "koi8-u", "cp856"}
)
CODECS = sorted({encoding.name for encoding in FOUND if encoding is not None})


@pytest.fixture
def chance() -> random.Random:
    return random.Random(SEED)


def windows(text: bytes, size: int, unit: int, chance: random.Random) -> list[bytes]:
    """Stretches of a text from anywhere in it, fewer of the long ones."""
    count = 60 if size < 500 else 10 if size < 4_000 else 3
    repeated = text * (2 + size // len(text))
    starts = [chance.randrange(len(text) // unit) * unit for _ in range(count)]
    return [repeated[start : start + size] for start in (0, *starts)]


def decode(encoding: str, pieces: list[bytes]) -> tuple[str, int | None]:
    decoder, text, offset = TextDecoder(encoding), "", 0
    for n, piece in enumerate(pieces):
        text += decoder.decode(piece, offset, final=n == len(pieces) - 1)
        offset += len(piece)
    return text, decoder.first_bad


def as_1252(byte: int) -> str:
    return chr(byte) if byte in OPEN_IN_1252 else bytes([byte]).decode("cp1252")


def utf8_else_1252(text: bytes) -> str:
    escaped = text.decode("utf-8", "surrogateescape")
    return "".join(as_1252(ord(c) - 0xDC00) if c in ESCAPED else c for c in escaped)


class TestFindEncoding:
    @pytest.mark.parametrize(("name", "mark"), MARKS.items())
    def test_a_mark_decides(self, name, mark, texts):
        text = (texts / "english.txt").read_text()
        assert find_encoding(mark + text.encode(name)) == Encoding(name, skip=len(mark))
        assert find_encoding(mark) == Encoding(name, skip=len(mark))

    @pytest.mark.no_cover
    @pytest.mark.parametrize("size", SIZES)
    @pytest.mark.parametrize("file", ["francais.txt", "deutsch.txt"])
    def test_windows_1252(self, file, size, texts, chance):
        text = (texts / file).read_text().encode("cp1252")
        for sample in windows(text, size, 1, chance):
            assert sample.decode(find_encoding(sample).name) == sample.decode("cp1252")

    @pytest.mark.parametrize("size", [8, *SIZES])
    @pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be", "utf-32-le", "utf-32-be"])
    @pytest.mark.parametrize("file", ["english.txt", "francais.txt", "deutsch.txt"])
    def test_wide_without_a_mark(self, file, encoding, size, texts, chance):
        unit = len("a".encode(encoding))
        text = (texts / file).read_text().encode(encoding)
        for sample in windows(text, size * unit // 2, unit, chance):
            assert find_encoding(sample[:SAMPLE_BYTES]) == Encoding(encoding)
            assert binary_kind(sample[:SAMPLE_BYTES]) is None

    @pytest.mark.parametrize("shift", range(4))
    def test_a_sample_that_ends_within_a_character_is_utf8(self, shift):
        sample = (b"a" * shift + "€😀".encode() * 20_000)[:SAMPLE_BYTES]
        assert find_encoding(sample) == Encoding("utf-8")

    def test_a_whole_text_that_ends_within_a_character_is_not(self):
        assert find_encoding("Ruelle du caf\N{LATIN SMALL LETTER E WITH ACUTE}".encode()[:-1]) != (
            Encoding("utf-8")
        )

    def test_a_damaged_byte_does_not_make_utf8_another(self, texts):
        sample = bytearray((texts / "francais.txt").read_bytes())
        sample[500] = 0xFF
        assert find_encoding(bytes(sample)) == Encoding("utf-8")

    @pytest.mark.parametrize("text", ["café été ", "é", "Größe. "])
    def test_nor_does_it_in_a_short_text(self, text):
        assert find_encoding(text.encode() + b"\xff") == Encoding("utf-8")

    @pytest.mark.parametrize(
        ("text", "encoding"),
        [
            ("½ Tasse Öl", "latin-1"),
            ("Größe 50 µm, 20 °C, § 3", "latin-1"),
            ("“Hello,” he said, don’t – “now”", "cp1252"),
            ("don’t " * 200, "cp1252"),
            ("5 €", "cp1252"),
            ("le cœur et l'œuvre d'été", "iso8859-15"),
            ("Zażółć gęślą jaźń i pięć żółtych łódek", "iso8859-2"),
            ("Zażółć gęślą jaźń i pięć żółtych łódek", "cp1250"),
            ("Příliš žluťoučký kůň úpěl ďábelské ódy", "cp1250"),
            ("Все счастливые семьи похожи друг на друга", "koi8_r"),
            ("Все счастливые семьи похожи друг на друга", "cp1251"),
            ("Όλοι οι άνθρωποι γεννιούνται ελεύθεροι και ίσοι", "cp1253"),
            ("すべての人間は、生まれながらにして自由であり", "cp932"),
            ("人人生而自由,在尊严和权利上一律平等。他们赋有理性和良心", "gb18030"),
            ("L'été dernier, à la fenêtre, où le château français brûlait. " * 10, "cp850"),
            ("L'été dernier, à la fenêtre, où le château français brûlait. " * 10, "mac-roman"),
        ],
    )
    def test_others(self, text, encoding):
        raw = text.encode(encoding)
        assert raw.decode(find_encoding(raw).name) == text

    @examples(150)
    @given(st.binary(min_size=1, max_size=60))
    def test_always_one_that_exists(self, sample):
        encoding = find_encoding(sample)
        assert named_encoding(encoding.name, b"") is not None
        assert encoding.skip <= len(sample)

    def test_ascii_with_zeros_after_it_is_not_wide(self):
        assert find_encoding(b"ab\0").name == "utf-8"
        assert find_encoding(b"A plain text" + b"\0" * 9).name == "utf-8"


class TestBinaryKind:
    def test_what_people_mistake_for_text(self, chance):
        archive = io.BytesIO()
        with zipfile.ZipFile(archive, "w") as file:
            file.writestr("word/document.xml", "<w:t>Text</w:t>")
        kinds = {
            b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR": "a PNG image",
            archive.getvalue(): "a zip archive (a .docx, .odt or .epub is one too)",
            b"%PDF-1.7\n%\xe2\xe3\xcf\xd3": "a PDF document",
            gzip.compress(b"text"): "a gzip archive",
            bz2.compress(b"text"): "a bzip2 archive",
            lzma.compress(b"text"): "an xz archive",
            b"GIF89a\x01\0\x01\0": "a GIF image",
            b"ID3\x03\0\0\0\0\0\0": "an MP3 file",
            b"RIFF\x24\x08\0\0WAVEfmt \x10\0\0\0\1\0\2\0": "binary data",
            chance.randbytes(2_000): "binary data",
            bytes(range(256)) * 20: "binary data",
            bytes(500): "binary data",
            b"Some text with a tail of nothing" + bytes(100): "binary data",
        }
        assert {sample: binary_kind(sample) for sample in kinds} == kinds

    @pytest.mark.parametrize(
        "beginning",
        ["ID3 tags", "RIFF raff", "GIF8 is no", "BZh, he said", "OggS", "SQLite format 3"],
    )
    def test_texts_may_begin_like_that(self, beginning):
        assert binary_kind(f"{beginning} and so on.\n".encode()) is None

    @pytest.mark.parametrize("length", [1, 2, 3, 10, 19, 100, 1_000])
    def test_a_stray_zero_is_text(self, length):
        for at in {0, length // 2, length - 1}:
            sample = bytearray(b"e" * length)
            sample[at] = 0
            assert binary_kind(bytes(sample)) is None
            assert find_encoding(bytes(sample)).name == "utf-8"

    def test_a_few_controls_are_text(self, texts, chance):
        sample = bytearray((texts / "english.txt").read_bytes())
        for _ in range(60):
            sample[chance.randrange(len(sample))] = chance.randrange(32)
        assert binary_kind(bytes(sample)) is None

    @pytest.mark.parametrize("encoding", ["utf-8", "cp1252", "cp850", "mac-roman", "utf-16"])
    @pytest.mark.parametrize("file", ["english.txt", "francais.txt", "deutsch.txt", "mots.txt"])
    def test_the_texts_are_text(self, file, encoding, texts):
        text = (texts / file).read_text().encode(encoding, "replace")
        assert binary_kind(text[:SAMPLE_BYTES]) is None

    def test_nothing_is_no_kind(self):
        assert binary_kind(b"") is None


class TestNamedEncoding:
    @pytest.mark.parametrize(
        "name",
        [
            "", " ", "base64", "rot13", "hex", "zlib", "bz2", "uu", "quopri", "idna", "punycode",
            "unicode_escape", "raw_unicode_escape", "undefined", "mbcs", "nonsense", "é", "\udcff",
            "utf\0-8", "../utf_8", "x" * 10_000,
        ],
    )  # fmt: skip
    def test_what_no_text_file_is_in(self, name):
        assert named_encoding(name, b"text") is None

    @pytest.mark.parametrize(
        ("name", "sample", "encoding"),
        [
            ("UTF8", b"text", Encoding("utf-8")),
            ("utf-8", codecs.BOM_UTF8 + b"text", Encoding("utf-8", skip=3)),
            ("utf-8-sig", codecs.BOM_UTF8 + b"text", Encoding("utf-8", skip=3)),
            ("latin-1", b"text", Encoding("iso8859-1")),
            ("windows-1252", b"\xff\xfetext", Encoding("cp1252")),
            ("utf-16", b"t\0", Encoding("utf-16-le")),
            ("utf_16", codecs.BOM_UTF16_BE + b"\0t", Encoding("utf-16-be", skip=2)),
            ("U16", codecs.BOM_UTF16_LE + b"t\0", Encoding("utf-16-le", skip=2)),
            ("utf-16-be", b"\0t", Encoding("utf-16-be")),
            ("utf-32", b"t\0\0\0", Encoding("utf-32-le")),
            ("utf-32", codecs.BOM_UTF32_BE + b"\0\0\0t", Encoding("utf-32-be", skip=4)),
            ("utf-16", codecs.BOM_UTF32_LE, Encoding("utf-16-le", skip=2)),
        ],
    )
    def test_names(self, name, sample, encoding):
        assert named_encoding(name, sample) == encoding


class TestDecoder:
    @given(st.lists(st.binary(max_size=12), min_size=1, max_size=8))
    def test_utf8_keeps_every_byte(self, pieces):
        whole = b"".join(pieces)
        text, first_bad = decode("utf-8", pieces)
        assert text == utf8_else_1252(whole)
        bad = [n for n, c in enumerate(whole.decode("utf-8", "surrogateescape")) if c in ESCAPED]
        before = whole.decode("utf-8", "surrogateescape")[: bad[0]] if bad else ""
        assert first_bad == (len(before.encode()) if bad else None)

    def test_a_good_piece_after_a_bad_one_is_read_strictly_again(self):
        text, first_bad = decode("utf-8", [b"a\xe9", b"b", "é".encode()[:1], "é".encode()[1:]])
        assert (text, first_bad) == ("aébé", 1)

    def test_what_windows_1252_leaves_open_stays(self):
        text, first_bad = decode("cp1252", [bytes(range(256))])
        assert text == "".join(map(as_1252, range(256)))
        assert first_bad == 0x81

    @pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be", "utf-32-le", "utf-32-be"])
    def test_lone_surrogates_stay(self, encoding):
        for text in ("a\udc80b\ud800", "\ud83d", "\udfff😀\ud800x"):
            raw = text.encode(encoding, "surrogatepass")
            assert decode(encoding, [raw]) == (text, None)
            assert decode(encoding, [raw[n : n + 1] for n in range(len(raw))]) == (text, None)

    def test_half_a_unit_at_the_end_is_kept(self):
        assert decode("utf-16-le", [b"a\0\xe9"]) == ("aé", 2)
        assert decode("utf-32-be", [b"\0\0\0a\0\0a"]) == ("a\0\0a", 4)

    def test_what_utf32_has_not_is_kept(self):
        assert decode("utf-32-le", [b"a\0\0\0\xe9\xe8\xe7\xe6b\0\0\0"]) == ("aéèçæb", 4)

    @pytest.mark.no_cover
    @pytest.mark.parametrize("encoding", CODECS)
    def test_no_bytes_are_too_bad(self, encoding, chance):
        for _ in range(30):
            raw = chance.randbytes(200) + bytes(chance.choices(b"\x1b$(BJ~{}+-\x0e\x0f a", k=60))
            pieces = [raw[n : n + 50] for n in range(0, len(raw), 50)]
            text, _first_bad = decode(encoding, pieces)
            assert isinstance(text, str)

    def test_an_escape_that_never_ends(self):
        raw = b"\x1b((" + b"a" * 25
        pieces = [raw[n : n + 12] for n in range(0, len(raw), 12)]
        assert decode("iso2022_jp", pieces)[0] == raw.decode()

    @pytest.mark.parametrize("encoding", CODECS)
    def test_good_text_is_the_same_in_any_pieces(self, encoding, chance):
        characters = "ab ~+é日本한국ж漢字€\n"
        raw = "".join(chance.choices(characters, k=200)).encode(encoding, "ignore")
        text = raw.decode(encoding)
        for size in (1, 2, 3, 7, 64):
            pieces = [raw[n : n + size] for n in range(0, len(raw), size)]
            assert decode(encoding, pieces) == (text, None)

    def test_going_back_to_a_state(self):
        decoder = TextDecoder("utf-8")
        first = decoder.decode("aé".encode()[:2], 0, final=False)
        state = decoder.state()
        assert first == "a"
        assert decoder.decode(b"\xa9b", 2, final=True) == "éb"
        decoder.restore(state)
        assert decoder.decode(b"\xa9b", 2, final=True) == "éb"
        assert decoder.first_bad is None


@pytest.mark.parametrize(
    ("sample", "offset"),
    [(b"caf\xe9", 3), (b"a\0b\0", 1), ("é".encode(), 0), (b"\xff\xfea\0", 0)],
)
def test_first_not_utf8(sample, offset):
    assert first_not_utf8(sample) == offset
