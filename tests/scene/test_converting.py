"""Files of other programs made into scene files: names of pictures, comments, what is refused."""

import pytest
from PIL import Image as Pillow

from tests.scene.openlatero.files import circle, scene, stroke, texture
from vbraille.errors import InputError
from vbraille.scene.converting import convert_scene
from vbraille.scene.images import load_bitmaps
from vbraille.scene.openlatero import read_gen
from vbraille.scene.reading import open_scene


def masked(name):
    return (
        f'<Pattern type="Image">{texture("Plain")}<mask><imgfile>{name}</imgfile>'
        "<blur>yes</blur></mask></Pattern>"
    )


@pytest.fixture
def old(tmp_path):
    """A scene with pictures beside it, in a folder below it, and by its whole path."""
    folder = tmp_path / "old"
    (folder / "masks").mkdir(parents=True)
    for place in (folder / "a.png", folder / "masks" / "b.png", tmp_path / "c.png"):
        Pillow.new("L", (40, 30), 200).save(place)
    path = folder / "picture.gen"
    names = ("a.png", "masks/b.png", tmp_path / "c.png")
    path.write_text(scene(*(masked(name) for name in names), circle(stroke() + "<colour/>")))
    return path


def test_a_converted_scene_is_the_one_that_was_read(old):
    new = old.parent / "picture.scene"
    made = convert_scene(old, new.parent)
    new.write_text(made.text)
    assert open_scene(new).written == read_gen(old).scene
    assert made.elements == 4
    assert made.differences == read_gen(old).warnings


@pytest.mark.parametrize("where", [".", "..", "masks", "../elsewhere/deep"])
def test_pictures_are_named_as_they_are_seen_from_the_new_file(old, where):
    folder = old.parent / where
    folder.mkdir(parents=True, exist_ok=True)
    new = folder / "picture.scene"
    new.write_text(convert_scene(old, folder).text)
    opened = open_scene(new)
    assert len(load_bitmaps(opened.resolved, opened.folder)) == 3
    names = [element.file for element in opened.written.elements[:3]]
    if where != ".":
        assert not any(name.startswith("/") for name in names)
    if where == "..":
        assert names == ["old/a.png", "old/masks/b.png", "c.png"]


def test_comments_say_what_differs_and_where_an_element_comes_from(old):
    text = convert_scene(old, old.parent).text
    top, _, _ = text.partition("\n\ntitle = ")
    assert top.startswith("# Converted from picture.gen.\n# line ")
    assert "colour is not known here" in top
    above, _, _ = text.partition('\n[[elements]]\nkind = "circle"')
    assert above.rpartition("\n")[2].startswith("# From line ")
    assert all(len(line) <= 72 for line in text.splitlines() if line.startswith("#"))


def test_what_is_a_scene_file_already_is_refused(tmp_path):
    path = tmp_path / "mine.scene"
    path.write_text("[canvas]\nwidth_mm = 9\nheight_mm = 9\n")
    with pytest.raises(InputError, match=r"give a \.gen, \.tx or \.svg file"):
        convert_scene(path, tmp_path)


def test_only_openlateros_scenes_can_be_as_shown(tmp_path):
    with pytest.raises(InputError, match="is not OpenLatero's"):
        convert_scene(tmp_path / "drawing.svg", tmp_path, as_shown=True)


def test_a_drawing_is_converted_too(tmp_path):
    drawing = tmp_path / "drawing.svg"
    drawing.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="50mm" height="40mm" viewBox="0 0 50 40">\n'
        "<title>Sun</title>\n"
        '<circle id="sun" cx="20" cy="15" r="8" fill="none" stroke="black" stroke-width="2"/>\n'
        "</svg>"
    )
    new = tmp_path / "drawing.scene"
    new.write_text(convert_scene(drawing, tmp_path).text)
    opened = open_scene(new)
    assert opened.written.title == "Sun"
    assert opened.written.elements[0].radius_mm == 8
    assert "# From line 3." in new.read_text()
    assert opened.resolved == open_scene(drawing).resolved
