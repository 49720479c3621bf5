"""Keys of pictures: numbers for labels that do not fit, and the page that says what they are."""

import pytest

from vbraille.errors import InputError
from vbraille.pictures.checking import check_scene
from vbraille.pictures.index import SceneIndex
from vbraille.pictures.keys import crowded, keyed
from vbraille.pictures.loading import load_scene
from vbraille.render import STRESS2
from vbraille.scene.patterns import Fill, Label, Polygon

STYLE = STRESS2.style
LABEL = """
[[elements]]
kind = "label"
text = "{text}"
place_mm = [{x}, {y}]
"""
LAKE = """
[[elements]]
kind = "circle"
title = "Lake"
center_mm = [60, 60]
radius_mm = 9
fill = {{ texture = {{ kind = "linear-grating", ridge_mm = 3 }} }}
"""


def load(tmp_path, *elements):
    path = tmp_path / "cell.scene"
    path.write_text("canvas = { width_mm = 120, height_mm = 90 }\n" + "".join(elements))
    return load_scene(path, STYLE)


def test_a_label_that_does_not_fit_becomes_a_number_that_is_said_as_its_text(tmp_path):
    wall = LABEL.format(text="wall", x=10, y=10)
    long = LABEL.format(text="mitochondrion", x=80, y=40)
    loaded = load(tmp_path, wall, long, LAKE.format())
    assert [label.text for label in crowded(loaded)] == ["mitochondrion"]
    assert any("--key" in advice for advice in check_scene(loaded).advice)
    picture, key = keyed(loaded, STYLE)
    assert [one.text for one in picture.scene.elements[:2]] == ["wall", "1"]
    assert not crowded(picture)
    index = SceneIndex(picture.scene, picture.assets, picture.boxes())
    assert index.find("mitochondrion") is not None
    labels = [one.text for one in key.scene.elements if isinstance(one, Label)]
    assert labels == ["1 mitochondrion", "Lake"]
    (sample,) = (one for one in key.scene.elements if isinstance(one, Polygon))
    assert sample.fill == Fill(texture=loaded.scene.elements[2].fill.texture)
    assert not key.notes
    assert not crowded(key)


def test_a_label_on_another_becomes_a_number(tmp_path):
    both = LABEL.format(text="river", x=10, y=40), LABEL.format(text="bridge", x=25, y=42)
    assert [label.text for label in crowded(load(tmp_path, *both))] == ["bridge"]


def test_a_picture_whose_labels_fit_needs_no_key(tmp_path):
    with pytest.raises(InputError, match="needs no key"):
        keyed(load(tmp_path, LABEL.format(text="wall", x=10, y=10)), STYLE)
