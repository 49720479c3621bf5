"""Codes in place of pseudonyms, and the key that tells whose they are."""

import pytest

from vbraille.errors import InputError
from vbraille.sessions.record.codes import KeyFile


def test_codes_stay_and_new_participants_get_new_ones(tmp_path):
    path = tmp_path / "key.csv"
    first = KeyFile.read(path).with_codes(["P01", "P02"])
    first.write()
    assert path.stat().st_mode & 0o777 == 0o600
    again = KeyFile.read(path).with_codes(["P02", "P03"])
    assert {name: again.codes[name] for name in first.codes} == first.codes
    assert len(set(again.codes.values())) == 3
    assert all(len(code) == 6 and code.isalnum() for code in again.codes.values())
    assert list(again.codes.values()) == sorted(again.codes.values())


def test_codes_are_not_made_from_pseudonyms(tmp_path):
    one, other = (KeyFile.read(tmp_path / "none.csv").with_codes(["P01"]).codes for _ in range(2))
    assert one != other


def test_a_key_is_not_given_away(tmp_path):
    with pytest.raises(InputError, match=r"the key .* would be in .*, which is given away; keep"):
        KeyFile.read(tmp_path / "set" / "key.csv", tmp_path / "set")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is no key: it must have the columns participant and code"),
        ("a,b\nP01,x\n", "is no key"),
        ("participant,code\nP01,x\nP01,y\n", "is no key"),
        ("participant,code\nP01\n", "is no key"),
        ("participant,code\nP01,\n", "is no key"),
        ("participant,code\n,x\n", "is no key"),
        (f"participant,code\n{'P' * 200_000},x\n", "cannot be read: it is no table"),
        ("participant,code\nP01,x\nP02,x\n", "has one code for two participants; mend it"),
    ],
)
def test_what_is_no_key_is_refused(tmp_path, text, said):
    (tmp_path / "key.csv").write_text(text)
    with pytest.raises(InputError, match=said):
        KeyFile.read(tmp_path / "key.csv")
