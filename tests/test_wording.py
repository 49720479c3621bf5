import doctest

import pytest

from vbraille import wording
from vbraille.wording import printable


def test_the_examples():
    failed, attempted = doctest.testmod(wording)
    assert failed == 0
    assert attempted > 2


@pytest.mark.parametrize(
    ("code", "name"),
    [(0, "null"), (1, "control A"), (9, "tab"), (10, "line feed"), (26, "control Z"), (0x9B, "9b")],
)
def test_control_characters_are_named(code, name):
    assert printable(f"a{chr(code)}b") == f"a<{name}>b"


def test_every_other_character_stays():
    text = "".join(map(chr, (*range(0x20, 0x7F), *range(0xA0, 0x3000))))
    assert printable(text) == text
