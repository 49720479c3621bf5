"""The page on converting: its tables are those of the program."""

import re
from pathlib import Path

from vbraille.scene.openlatero.elements import MOST_BYTES, MOST_ELEMENTS
from vbraille.scene.openlatero.making import OPERATIONS, PATTERNS, TEXTURES

PAGE = Path(__file__).parents[3] / "docs" / "converting.md"


def table(name):
    """Rows of the table whose first column has a name."""
    text = PAGE.read_text()
    rows = text.partition(f"| {name} |")[2].partition("\n\n")[0].splitlines()[2:]
    return {cells[1].strip(): cells[2].strip() for cells in (row.split("|") for row in rows)}


def test_every_type_texture_and_operation_is_in_its_table():
    assert set(table("OpenLatero")) == {*PATTERNS, "Texture"}
    assert set(table("texture")) == set(TEXTURES)
    assert set(table("operation")) == {*OPERATIONS, "reactive"}
    assert all(table("operation")[name] == here for name, here in OPERATIONS.items())


def test_the_limits_are_as_said():
    text = " ".join(PAGE.read_text().split())
    assert f"{MOST_BYTES // 1_000_000} MB or {MOST_ELEMENTS:,} elements" in text
    assert re.search(r"289\.9 by 230\.1875 mm", text)
