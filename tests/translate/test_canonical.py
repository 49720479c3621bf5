"""What is canonically equal gives the same cells, in every language."""

import unicodedata
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conftest import SEED
from tests.tiers import by_tier, examples
from vbraille.errors import InputError
from vbraille.translate import BrailleTable, find_table, list_tables
from vbraille.translate.source import Text, to_codes

FORMS = ("NFC", "NFD")


@cache
def tables() -> tuple[str, ...]:
    """The usual table of every language."""
    names = set()
    for language in {table.language for table in list_tables() if table.language}:
        try:
            names.add(find_table(language))
        except InputError:
            continue
    return tuple(sorted(names))


cached_table = cache(BrailleTable)


@cache
def letters() -> str:
    """Letters that have another form, and the signs that stand on letters."""
    codes = (
        *range(0xC0, 0x3100),
        *range(0xAC00, 0xAC80),
        *range(0xF900, 0xF910),
        *range(0xFB1D, 0xFB50),
    )
    found = [
        c
        for c in map(chr, codes)
        if unicodedata.normalize("NFD", c) != c or unicodedata.category(c)[0] == "M"
    ]
    return "".join(found[SEED % 4 :: by_tier(4, 2, 1)])


def cells(table: BrailleTable, text: str):
    codes = to_codes(text)
    return table.translate(
        Text(codes, np.arange(codes.size), codes.size, frozenset(codes.tolist()))
    )


def test_letters_with_a_dot_below_are_written():
    for language, letters_of_it in (("hi", "ड़ढ़क़ज़फ़"), ("bn", "ড়ঢ়য়"), ("pa", "ਸ਼ਖ਼ਗ਼ਜ਼ਫ਼")):
        table = BrailleTable(find_table(language))
        for form in FORMS:
            text = unicodedata.normalize(form, letters_of_it)
            found = cells(table, text)
            assert table.undefined == set(), (language, form)
            assert found.masks.all()


def test_hangul_is_the_same_in_both_forms():
    text = "한국어를 읽는 값"
    for name in ("ko-g1.ctb", "ko-g2.ctb"):
        table = BrailleTable(name)
        one, other = (cells(table, unicodedata.normalize(form, text)) for form in FORMS)
        assert one.to_unicode() == other.to_unicode() == cells(table, text).to_unicode()


class TestLaw:
    @examples(400)
    @given(st.data())
    def test_all_forms_of_a_text_give_the_same_cells(self, data):
        name = data.draw(st.sampled_from(tables()))
        table = cached_table(name)
        text = data.draw(st.text(st.sampled_from(letters() + "aeo ka한"), min_size=1, max_size=8))
        found = [cells(table, unicodedata.normalize(form, text)) for form in FORMS]
        found.append(cells(table, text))
        assert len({one.masks.tobytes() for one in found}) == 1
        for one, its in zip(
            found, (*(unicodedata.normalize(f, text) for f in FORMS), text), strict=True
        ):
            # Every cell knows characters of its own text, and in order.
            assert (np.diff(one.starts) >= 0).all()
            assert one.end == len(its)
            assert not len(one) or (one.starts[0] >= 0 and one.starts[-1] < one.end)

    @pytest.mark.parametrize("name", tables()[:: by_tier(12, 1, 1)])  # the law above is of all
    def test_each_letter_of_each_language(self, name):
        own, composed, decomposed = (
            " ".join(f"a{unicodedata.normalize(form, c) if form else c}b" for c in letters())
            for form in ("", *FORMS)
        )
        assert len({own, composed, decomposed}) == 3
        table = cached_table(name)
        found = [cells(table, text).to_unicode() for text in (own, composed, decomposed)]
        assert found[0] == found[1] == found[2]
