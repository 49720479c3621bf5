import pytest

from vbraille import names
from vbraille.errors import InputError


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("P1", "p001"),
        ("P-1", "P1"),
        ("P 01", "P1"),
        ("1", "1.0"),
        ("Zoë", "Zoe\u0308"),
        ("P\u200b1", "P1"),
        ("Ｐ１", "P1"),
        ("P1\ufe0f", "P1"),
    ],
)
def test_spellings_of_one_person_are_refused(one, other):
    with pytest.raises(InputError, match="participant"):
        names.check_alike(["P7", one, other], "participant")


@pytest.mark.parametrize(("one", "other"), [("P1", "P10"), ("P0.5", "P0.05"), ("A1", "B1")])
def test_different_people_may_have_similar_names(one, other):
    names.check_alike([one, other], "participant")


def test_signs_count_in_conditions():
    names.check_alike(["-1", "1"], "condition")
    for one, other in (("T0.50", "t0,5"), (".5", "0.5"), ("5 %", "5%"), ("T–25", "T-25")):
        with pytest.raises(InputError, match="condition"):
            names.check_alike([one, other], "condition")


def test_what_is_not_seen_goes():
    assert names.visible(" a\u200b  b\u0308\u00a0c ") == "a b̈ c"
