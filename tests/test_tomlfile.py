"""A text becomes the value that a type says, or a sentence says in which line it cannot."""

import subprocess
import sys
from typing import Literal

import pytest
from msgspec import field

from vbraille.errors import InputError
from vbraille.tomlfile import Table, TomlFile


class Point(Table, frozen=True, array_like=True):
    x_mm: float
    y_mm: float


class Hand(Table, frozen=True):
    speed_mm_s: float = field(name="speed")
    side: Literal["left", "right"] = "left"
    stops: tuple[Point, ...] = ()

    def __post_init__(self):
        if self.speed_mm_s < 0:
            raise ValueError(f"speed is {self.speed_mm_s:g}; it must be 0 or more")
        for number, stop in enumerate(self.stops, 1):
            if stop.x_mm < 0:
                raise ValueError(f"stops, number {number}, has a place before the line")


class Room(Table, frozen=True):
    door: Hand = Hand(1.0)
    hands: tuple[Hand, ...] = ()


LIST = """
[[hands]]
speed = 1  # speed = 2

[[hands]]
side = "right"
stops = [
    [1, 2.5],
    [%s],
]
speed = %s
"""


def says(text, sentence):
    with pytest.raises(InputError) as refused:
        TomlFile(text, "room.toml").read(Room)
    assert str(refused.value) == sentence


def test_what_a_text_has():
    room = TomlFile(LIST % ("3, 4", 5), "room.toml").read(Room)
    assert room.hands == (
        Hand(1.0),
        Hand(5.0, "right", (Point(1.0, 2.5), Point(3.0, 4.0))),
    )


@pytest.mark.parametrize(
    ("stop", "speed", "sentence"),
    [
        ("3, 4", "-1", " line 11: [[hands]] number 2 speed is -1; it must be 0 or more"),
        ("-3, 4", "1", " line 9: [[hands]] number 2 stops, number 2, has a place before the line"),
        ("3", "1", " line 9: [[hands]] number 2 stops, number 2, has 1 items; give 2: x_mm, y_mm"),
        ("3, true", "1", " line 9: [[hands]] number 2 stops, number 2, number 2, is True; "
         "it must be a number"),
        ('3, "\\u0007"', "1", " line 9: [[hands]] number 2 stops, number 2, number 2, is"),
        ("3, 4", "1\nsped = 2", " line 12: [[hands]] number 2 has no key 'sped'; the nearest is "
         "speed, and there is side, speed, stops"),
        ("3, 4", "1\ndoor.side = 2", " line 12: [[hands]] number 2 has no key 'door'; there "
         "is side, speed, stops"),
        ("3, 4", "1\n[door]\nside = 'up'\nspeed = 1", " line 13: [door] side is 'up'; there "
         "is left, right"),
    ],
)  # fmt: skip
def test_items_of_tables_that_come_again(stop, speed, sentence):
    with pytest.raises(InputError) as refused:
        TomlFile(LIST % (stop, speed), "room.toml").read(Room)
    assert str(refused.value).startswith(f"room.toml{sentence}")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("\ndoor.speed = 'x'", " line 2: [door] speed is 'x'; it must be a number"),
        ("door = { side = 'left' }", " line 1: [door] lacks speed; add it"),
        ("door = [\n1]", " line 1: door is [1]; it must be a table"),
        ("[hands]\n", " line 1: [hands] must be tables; write each under [[hands]]"),
        ("hands = [\n{ speed = 1 },\n3]", " line 3: hands, number 2, is 3; it must be a table"),
        (
            "hands = [\n{ speed = 1 },\n{ speed = 1, sid = 2 }]",
            " line 3: [[hands]] number 2 has no key 'sid'; the nearest is side, and there is "
            "side, speed, stops",
        ),
        (
            "[door]\nspeed = 1\nside = 2024-01-01",
            " line 3: [door] side is datetime.date(2024, 1, 1); it must be 'left' or 'right'",
        ),
    ],
)
def test_other_ways_to_write_a_table(text, sentence):
    says(text, f"room.toml{sentence}")


@pytest.mark.parametrize(
    "key", ['"a` - at `$.door"', '"door` - at `$.hands[3]"', '""', '"\\u0000"']
)
def test_keys_that_look_like_something_else(key):
    with pytest.raises(InputError, match=r"^room\.toml"):
        TomlFile(f"{key} = 1\n[door]\nspeed = 1", "room.toml").read(Room)


_MANY = 20_000
_DEEP = {
    "a key": "a" + ".a" * _MANY + " = 1",
    "a key with blanks": "a" + " . 'a'" * _MANY + " = 1",
    "the name of a table": "ok = 1\n[a" + ".a" * _MANY + "]",
    "a key in braces": "x = {ok = 1, a" + '."a"' * _MANY + " = 1}",
    "tables in tables": "\n".join(f"[{'a.' * n}a]" for n in range(99)) + "\n" + "b." * 99 + "b = 1",
    "lists in lists": "a = " + "[" * _MANY + "]" * _MANY,
    "few lists of many items": "a = " + "[" * 200 + "1," * 400_000 + "]" * 200,
    "tables in braces": "a = " + "{a = " * _MANY + "1" + "}" * _MANY,
    "brackets without an end": "a = " + "[" * 900_000,
    "braces without an end": "a = " + "{a=" * 300_000,
    "strings without an end": 'a = "' + ',"a.' * 200_000,
}


@pytest.mark.parametrize("text", _DEEP.values(), ids=_DEEP)
def test_what_nests_deep_is_refused_in_little_memory(text):
    script = (
        "import resource, sys\n"
        "from vbraille.errors import InputError\n"
        "from vbraille.tomlfile import TomlFile\n"
        "resource.setrlimit(resource.RLIMIT_AS, (500 << 20,) * 2)\n"
        "resource.setrlimit(resource.RLIMIT_CPU, (20,) * 2)\n"
        "try:\n    TomlFile(sys.stdin.read(), 'room.toml').lines()\n"
        "except InputError as error:\n    print(error)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], check=False, input=text, capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("room.toml ")
    assert done.stdout.count("\n") == 1


def test_dots_in_a_string_and_in_a_comment_are_no_parts_of_a_key():
    text = f'{"a." * 99}a = 1\ntext = "{"a." * 500}" # {"a." * 500}'
    assert TomlFile(text, "room.toml").names() == ("a", "text")
    TomlFile(f"list = [{'1.5, ' * 500}]", "room.toml")
