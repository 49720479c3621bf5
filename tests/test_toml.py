"""TOML into structs: an error names the file, the line and the key."""

from typing import Annotated, Literal

import msgspec
import pytest

from vbraille.errors import InputError
from vbraille.toml import Table, TomlFile, WrongValue, lines_of, located, read_toml, which


class Circle(Table, tag="circle", tag_field="kind", frozen=True):
    radius_mm: Annotated[float, msgspec.Meta(gt=0)]


class Line(Table, tag="line", tag_field="kind", frozen=True):
    length_mm: float
    parts: tuple["Line | Circle", ...] = ()

    def __post_init__(self):
        if self.length_mm > 100:
            raise ValueError(f"length is {self.length_mm:g} mm; it must be at most 100 mm")


class Drawing(Table, frozen=True):
    title: str
    pens: Literal[1, 2] = 1
    shapes: tuple[Line | Circle, ...] = ()
    colors: dict[str, int] = {}  # noqa: RUF012


TEXT = """title = "A" # remark
colors = { red = 1 }

[[shapes]]
kind = "line"
length_mm = 3

  [[shapes.parts]]
  kind = "circle"
  radius_mm = 1

[[shapes]]
kind = "circle"
radius_mm = 2
"""


def test_what_is_right_is_read():
    drawing = read_toml(TEXT, Drawing, "a.toml")
    assert drawing.shapes == (Line(3, (Circle(1),)), Circle(2))
    assert TomlFile(TEXT, "a.toml").read(int, ("colors", "red")) == 1
    assert TomlFile(TEXT, "a.toml").names("colors") == ("red",)
    assert TomlFile(TEXT, "a.toml").names("none") == ()


def test_each_table_item_and_key_has_its_line():
    lines = lines_of(TEXT)
    assert lines["title",] == 1
    assert lines["shapes", 0, "length_mm"] == 6
    assert lines["shapes", 0, "parts", 0, "radius_mm"] == 10
    assert lines["shapes", 1] == 12
    assert lines_of('[a."b c".d]\n"e f" = 1\ng.h = 2') == {
        ("a", "b c", "d"): 1,
        ("a", "b c", "d", "e f"): 2,
        ("a", "b c", "d", "g", "h"): 3,
    }


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("radius_mm = 1", "radius_mm = 0", "line 10: radius_mm"),
        ("radius_mm = 1", 'radius_mm = "1"', "line 10: radius_mm: must be a number"),
        ("radius_mm = 1", "radius = 1", "line 10: radius: unknown key; did you mean rad"),
        ("radius_mm = 1", "", "line 8: parts 1: radius_mm is missing"),
        ("radius_mm = 2", "radius_mm = nan", "line 14: radius_mm: is nan"),
        ("radius_mm = 2", "length_mm = 2", "line 14: length_mm: unknown key; known: kin"),
        ('"circle"', '"circel"', "kind: is 'circel'; did you mean circle?"),
        ("length_mm = 3", "length_mm = 300", "line 6: length is 300 mm"),
        ('title = "A"', 'title = "A\\u001b"', "line 1: title: has control characters"),
        ('title = "A"', "pens = 3", "line 1: pens: is 3; known: 1, 2"),
        ("red = 1", f"red = 1{'0' * 30}", "line 2: red"),
        ('title = "A"', "title = ", "is not TOML"),
        ('title = "A"', f"{'a.' * 200}b = 1", "too deep"),
        ('title = "A"', f"a = {'[' * 5000}{']' * 5000}", "is not TOML"),
    ],
)
def test_what_is_wrong_is_a_sentence_with_its_line(old, new, said):
    text = TEXT.replace(old, new, 1)
    if new == "pens = 3":
        text = f"{new}\n{TEXT}"
    with pytest.raises(InputError) as refused:
        read_toml(text, Drawing, "a.toml")
    assert str(refused.value).startswith("a.toml ")
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def test_values_that_contradict_each_other_are_found():
    error = located(TEXT, "a.toml", WrongValue("shapes.1.radius_mm", "is too large"))
    assert str(error) == "a.toml line 14: radius_mm: is too large"


def test_an_unknown_name_is_told_the_nearest_or_all():
    assert which("lenght", ["length", "title"]) == "; did you mean length?"
    assert which("x", ["title", "length"]) == "; known: length, title"
