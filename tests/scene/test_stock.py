"""The bank of textures that comes with the program can be used in any scene."""

import hashlib
import json
import tomllib

from vbraille.scene.patterns import Use
from vbraille.scene.reading import resolve
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.stock import STOCK, stock_text, stock_textures


def test_every_texture_has_a_title_and_a_description():
    assert all(one.title and one.description for one in stock_textures().values())


def test_the_numbers_are_those_that_the_sources_author_published():
    """All of them by their digest, since they are data; words may change."""
    textures = tomllib.loads(stock_text())["textures"]
    for one in textures.values():
        del one["title"], one["description"]
    assert (textures["grid"]["parts"][0]["ridge_mm"], textures["axial"]["ridge_deg"]) == (2, 36)
    text = json.dumps(textures, sort_keys=True)
    assert hashlib.sha256(text.encode()).hexdigest()[:16] == "0f274d2cf214cc57"


def test_every_texture_can_be_used_and_moved_without_an_include():
    uses = tuple(Use(name=f"{STOCK}{name}", move_mm=(50, 40)) for name in stock_textures())
    shown = resolve(Scene(canvas=Canvas(width_mm=200, height_mm=100), elements=uses)).elements
    assert len(shown) == len(uses)
    assert not any(isinstance(one, Use) for one in shown)
    rings = shown[list(stock_textures()).index("radial")]
    assert rings.center_mm == (50, 40)


def test_the_bank_says_how_it_is_used_and_where_it_is_from():
    text = stock_text()
    assert 'texture = {kind = "use", name = "stock:grid"}' in text
    assert "MIT" in text
