"""The page on converting: its tables are those of the program."""

import re
from pathlib import Path
from typing import get_args

from tests.scene.openlatero.files import scene, texture
from vbraille.scene.openlatero import read_gen
from vbraille.scene.openlatero.elements import MOST_BYTES, MOST_ELEMENTS, PATTERNS, TEXTURES
from vbraille.scene.openlatero.textures import OPERATIONS
from vbraille.scene.patterns import AnyPattern

PAGE = Path(__file__).parents[3] / "docs" / "converting.md"
KINDS = {kind.__struct_config__.tag for kind in get_args(AnyPattern)}


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


def test_textures_become_what_the_table_says(tmp_path):
    path = tmp_path / "old.gen"
    for name, here in table("texture").items():
        kind = here.partition(" ")[0]
        if kind not in KINDS:
            continue
        inside = (texture("Plain") + texture("Vibration")) if name == "Combo" else ""
        path.write_text(scene(texture(name, inside)))
        found = read_gen(path).scene
        # A group alone is the scene itself.
        made = found.elements[0].__struct_config__.tag if len(found.elements) == 1 else "group"
        assert made == kind, name


def test_the_limits_are_as_said():
    text = " ".join(PAGE.read_text().split())
    assert f"{MOST_BYTES // 1_000_000} MB or {MOST_ELEMENTS:,} elements" in text
    assert re.search(r"289\.9 by 230\.1875 mm", text)
