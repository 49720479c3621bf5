import re
from pathlib import Path

import pytest

import vbraille
from vbraille.wording import count, printable, setting, spelled


@pytest.mark.parametrize(
    ("code", "name"),
    [(0, "null"), (1, "control A"), (9, "tab"), (10, "line feed"), (26, "control Z"), (0x9B, "9b")],
)
def test_control_characters_are_named(code, name):
    assert printable(f"a{chr(code)}b") == f"a<{name}>b"


def test_every_other_character_stays():
    text = "".join(map(chr, (*range(0x20, 0x7F), *range(0xA0, 0x3000))))
    assert printable(text) == text


ROOMS = ("devices", "engine", "render", "reading", "sessions")
SOURCES = Path(vbraille.__file__).parent


def test_a_setting_is_spelled_as_an_option_by_the_command_line_alone():
    message = f"choose another {setting('model')}, or {setting('rate')} 40 or less"
    assert message == "choose another ‹model›, or ‹rate› 40 or less"
    assert spelled(message) == "choose another --model, or --rate 40 or less"
    assert spelled(f"give a new directory with {setting('folder')}").endswith("with --out")
    assert spelled("a name of ‹two words›") == "a name of ‹two words›"


@pytest.mark.parametrize("room", ROOMS)
def test_nothing_below_the_command_line_names_an_option(room):
    files = sorted((SOURCES / room).rglob("*.py"))
    assert files
    option = re.compile(r"""["'][^"']*--[a-z]""")
    for path in files:
        for number, line in enumerate(path.read_text().splitlines(), 1):
            assert not option.search(line), f"{path}, line {number}"


def test_things_are_counted_in_words():
    assert [count(n, "trial") for n in (0, 1, 2)] == ["0 trials", "1 trial", "2 trials"]
