"""A text is found where the blocks have it, however the file writes it."""

import io
import unicodedata
from itertools import count, takewhile

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.tiers import by_tier, examples
from vbraille.reading.search.questions import FindText, Found, NotFound, Searched
from vbraille.reading.search.seeker import Answering, steps
from vbraille.reading.search.text import Sieve, ahead, fold, needle_of, unfolded
from vbraille.translate import Book, Document
from vbraille.translate.documents.chapters import ChapterSource, Passage
from vbraille.translate.documents.encodings import Encoding
from vbraille.translate.formats import open_source

PIECES = (
    "one two", "well-", "known", "Straße", "STRASSE", "ﬁne", "fine", "café", "cafe\u0301", "CAFÉ",
    " ", " ", " ", "\n", "\n", "\n\n", "\r\n", "\xad\n", "\xad", "\xa0", "\t  ", "\f", "\u2028",
    "’", '"', "«", "–", "-", "\u2009", "\u202f", "ï",
    "\ufeff", "_\bx", "e\bé", "x", "s", "ſ", "Σς", "  " * 40, "\n   \n", "1. ", "- ", "e", "́", "и́",
)  # fmt: skip
texts = st.lists(st.sampled_from(PIECES), min_size=1, max_size=30).map("".join)


class Chapters(ChapterSource):
    """Chapters of one paragraph each."""

    def __init__(self, *chapters):
        super().__init__("book", [1] * len(chapters), "0" * 64)
        self._chapters = chapters

    def passages(self, part):
        return [Passage(self._chapters[part])]


def blocks(source):
    return takewhile(lambda block: block is not None, map(source.block, count()))


QUOTES = "\"'`´‘’‚‛“”„‟′″‹›«»ʼ"
DASHES = "-‐‑‒–—―−"


def folded(character, accents):
    """A character as it is compared; this is the plain twin of what is done at once for many."""
    character = "'" if character in QUOTES else "-" if character in DASHES else character
    character = character.casefold()
    if accents:
        decomposed = unicodedata.normalize("NFD", character)
        character = "".join(c for c in decomposed if not unicodedata.combining(c))
    return " " if character.isspace() else character


def hits(source, text, accents):
    """Places of all hits, by the blocks' own texts, one character after the other."""
    read = []
    for block in blocks(source):
        if read and not block.continues:
            read.append((" ", -1))
        read += zip(str(block.text), block.text.places.tolist(), strict=True)
    needle = needle_of(text, accents=accents)
    # Accents that did not become one letter with what they stand on, but would here.
    joined = []
    for character, place in read:
        together = unicodedata.normalize("NFC", joined[-1][0] + character) if joined else ""
        if len(together) == 1 and unicodedata.combining(character):
            joined[-1] = (together, joined[-1][1])
        else:
            joined.append((character, place))
    seen, owners = "", []
    for character, place in joined:
        for letter in folded(character, accents):
            if letter == " " and seen.endswith(" "):
                continue
            seen += letter
            owners.append(place)
    found, at = [], seen.find(needle) if needle else -1
    while at >= 0:
        found.append(owners[at])
        at = seen.find(needle, at + 1)
    return sorted(set(found))


def ask(source, *question, **how):
    *before, last = Answering(Book(source)).answer(FindText(*question, **how))
    assert all(isinstance(step, Searched) for step in before)
    return last.character if isinstance(last, Found) else None


def all_hits(source, text, accents):
    found, place = [], ask(source, text, 0, fold_accents=accents)
    while place is not None:
        found.append(place)
        place = ask(source, text, place + 1, fold_accents=accents)
    return found


def all_hits_back(source, text, accents):
    how = {"backward": True, "fold_accents": accents}
    found, place = [], ask(source, text, 10**6, **how)
    while place is not None:
        found.append(place)
        place = ask(source, text, place, **how)
    return found[::-1]


NEEDLES = st.one_of(
    texts.filter(lambda text: len(text) < 60),
    st.sampled_from(
        (
            "one two",
            "well-known",
            "x’s",
            "-",
            '"x',
            "strasse",
            "fine",
            "cafe",
            "café",
            "s",
            "x",
            "xs",
            "e",
        )
    ),
)


class TestLaw:
    @examples(150)
    @given(text=texts, needle=NEEDLES, accents=st.booleans(), keep_lines=st.booleans())
    @example("one\n  two", "ONE TWO", False, False)
    @example("Stra\xadße", "strasse", False, False)
    @example("well-\nknown", "well-known", False, False)
    @example("a fi\xad\nne b", "fine", False, False)
    def test_the_hits_are_those_in_the_blocks(self, text, needle, accents, keep_lines):
        wanted = hits(Document.from_text(text, keep_lines=keep_lines), needle, accents)
        for encoding in ("utf-8", "utf-32-le"):
            raw = text.encode(encoding)
            if not raw:
                continue
            document = Document(io.BytesIO(raw), "a", Encoding(encoding), keep_lines=keep_lines)
            assert all_hits(document, needle, accents) == wanted
            assert all_hits_back(document, needle, accents) == wanted

    @examples(100)
    @given(text=texts, needle=NEEDLES, accents=st.booleans(), size=st.integers(1, 40))
    def test_no_hit_falls_through_the_sieve_wherever_it_is_cut(self, text, needle, accents, size):
        folded_needle = needle_of(needle, accents=accents)
        if not folded_needle:
            return
        document = Document(io.BytesIO(text.encode()), "a", Encoding("utf-8"))
        row = document.index().rows[0]
        suspects = list(ahead(document, row, Sieve(folded_needle, accents=accents), size))
        for place in hits(document, needle, accents):
            assert any(s.hit and s.start <= place < s.end for s in suspects), place

    @examples(60)
    @given(
        chapters=st.lists(st.sampled_from(("one two one", "Two  three", "café", "x" * 9000, "")),
                          min_size=1, max_size=6),
        needle=st.sampled_from(("one", "two one two", "CAFE", "xx", "three café")),
        accents=st.booleans(),
    )  # fmt: skip
    def test_in_other_sources(self, chapters, needle, accents):
        source = Chapters(*chapters)
        wanted = hits(source, needle, accents)
        if len(wanted) > 20:  # each is one answer: the first and the last say enough
            assert ask(source, needle, 0, fold_accents=accents) == wanted[0]
            last = ask(source, needle, 10**6, backward=True, fold_accents=accents)
            assert last == wanted[-1]
        else:
            assert all_hits(source, needle, accents) == wanted
            assert all_hits_back(source, needle, accents) == wanted


class TestLong:
    """Texts of several pieces, whose borders must not show."""

    @pytest.mark.parametrize("blanks", [1, 300_000])
    def test_a_phrase_across_borders(self, blanks):
        filler = "nothing to see here " * 100 + "\n\n"
        for shift in by_tier((5,), range(0, 25, 5), range(25)):
            before = filler * (262_144 // len(filler))
            before += "z" * (262_144 - 30 - len(before) + shift)
            text = f"{before} first word{' ' * blanks}and the\nlast. {filler * 20}"
            document = Document(io.BytesIO(text.encode()), "a", "utf-8")
            place = text.index("word")
            assert ask(document, "WORD and the last", 0) == place
            assert ask(document, "WORD and the last", len(text), backward=True) == place
            assert ask(document, "WORD and the last", place + 1) is None

    def test_the_index_reaches_the_hit(self):
        text = "nothing to see here\n\n" * 20_000 + "needle\n\n" + "nothing more\n\n" * 20_000
        document = Document(io.BytesIO(text.encode()), "a", "utf-8")
        *progress, found = Answering(Book(document)).answer(FindText("Needle", 0))
        assert isinstance(found, Found)
        assert found.character == text.index("needle")
        assert progress
        again = Document(io.BytesIO(text.encode()), "a", "utf-8")
        again.adopt(found.index)
        assert not again.complete
        number = again.block_at(found.character)
        assert number == 20_000
        assert str(again.block(number).text) == "needle"

    def test_what_is_not_there_needs_no_blocks(self):
        document = Document(io.BytesIO(b"nothing to see here\n\n" * 20_000), "a", "utf-8")
        *_, last = Answering(Book(document)).answer(FindText("needle", 0))
        assert isinstance(last, NotFound)
        assert len(document.index().rows) == 1


PARTS = st.sampled_from(["word ", "Ab", "ß", "İ", "e\u0301", "\u0301", "  \n", "ﬃ", "é", "x"])


@examples(40)
@given(st.lists(PARTS, min_size=1, max_size=30), st.integers(200, 600), st.booleans(), st.data())
def test_a_place_in_a_folded_text_is_that_of_its_character(parts, times, accents, data):
    text = "".join(parts) * times
    folded = fold(text, accents=accents)
    if not folded:
        return
    at = data.draw(st.integers(0, len(folded) - 1))
    index = unfolded(text, at, accents=accents)
    assert len(fold(text[:index], accents=accents)) <= at
    assert len(fold(text[: index + 1], accents=accents)) > at


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16-le", "cp1252"])
@pytest.mark.parametrize(
    ("needle", "text"),
    [
        ("I've", "so I’ve gone"),
        ("I’ve", "so I've gone"),
        ('"quote"', "a “quote” here"),
        ("«quote»", 'a "quote" here'),
        ("end - so", "the end – so it is"),
        ("well-known", "a well‑known one".replace("‑", "–")),
        ("naive cafe", "a naïve  café\xa0there"),
        ("CAFE there", "a naïve  café\xa0there"),
        ("café", "a cafe"),
    ],
)
def test_kinds_of_signs_blanks_and_accents_make_no_difference(needle, text, encoding):
    document = Document(io.BytesIO(text.encode(encoding)), "a", Encoding(encoding))
    first = needle.split()[0]
    for near in (True, False):
        *_, found = steps(document, FindText(needle, 0), near=near)
        assert isinstance(found, int)
        *_, back = steps(document, FindText(needle, 10**6, backward=True), near=near)
        assert back == found
    *_, word = steps(document, FindText(first, 0))
    assert word == found


def test_a_row_of_a_table_is_found_with_one_blank(tmp_path):
    (tmp_path / "a.html").write_text("<table><tr><td>alpha one<td>beta<td>12</tr></table>")
    source = open_source(str(tmp_path / "a.html"))
    for needle in ("one beta", "one  beta 12"):
        assert ask(source, needle, 0) == ask(source, "one", 0) is not None


def test_nothing_is_found_for_nothing():
    document = Document.from_text("a b")
    assert ask(document, "  \xad", 0) is None
    assert ask(Chapters("a b"), "", 0) is None


def test_bad_bytes_are_searched_as_they_are_read():
    document = Document(io.BytesIO(b"caf\xe9 ol\xe9 \xe2\x82 caf\xc3\xa9"), "a", "utf-8")
    assert all_hits(document, "café", False) == hits(document, "café", False) != []


@pytest.mark.parametrize("accents", [False, True])
@pytest.mark.parametrize("opened", [Document.from_text, Chapters])
def test_small_numbers_are_found_as_they_are_typed(opened, accents):
    source = opened("Of H₂O there are 10⁶ m³, or 10⁻³.")
    for needle, place in (("h2o", 3), ("106 M3", 17), ("10-3", 28), ("H₂O", 3)):
        assert ask(source, needle, 0, fold_accents=accents) == place
