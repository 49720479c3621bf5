"""``vbraille scene convert``: the new file, what is said, and what is left alone."""

import pytest

from tests.scene.openlatero.files import circle, grating, scene, stroke, swings
from vbraille.scene.reading import open_scene


@pytest.fixture
def old(tmp_path):
    path = tmp_path / "old.gen"
    path.write_text(scene(circle(stroke() + "<colour/>"), grating(inside=swings(mode="low"))))
    return path


def test_the_new_file_is_written_and_what_differs_is_said_line_by_line(call, old, tmp_path):
    new = tmp_path / "new.scene"
    done = call("scene", "convert", old, "--out", new)
    assert done.code == 0
    assert done.out.splitlines() == [
        f"differs: {old} line 6, Circle: colour is not known here, and ignored",
        f"differs: {old} line 8, LinearGrating: what is down vibrates, as the file says; "
        "OpenLatero ignores blend_mode low",
        "elements: 2",
        "differences: 2",
        f"written: {new}",
    ]
    assert open_scene(new).written.elements[1].vibration.of == "low"


def test_as_openlatero_shows_it(call, old, tmp_path):
    new = tmp_path / "new.scene"
    assert call("scene", "convert", old, "--out", new, "--as-shown").code == 0
    assert open_scene(new).written.elements[1].vibration.of == "high"


def test_a_file_is_replaced_only_if_that_is_asked_for(call, old, tmp_path):
    new = tmp_path / "new.scene"
    new.write_text("mine")
    done = call("scene", "convert", old, "--out", new)
    assert done.code == 2
    assert "already exists" in done.err
    assert new.read_text() == "mine"
    assert call("scene", "convert", old, "--out", new, "--force").code == 0
    assert new.read_text() != "mine"


@pytest.mark.parametrize(
    ("name", "message"),
    [("no.gen", "there is no file"), (".", "give a .gen, .tx or .svg file")],
)
def test_what_cannot_be_converted_leaves_nothing_behind(call, tmp_path, name, message):
    done = call("scene", "convert", tmp_path / name, "--out", tmp_path / "new.scene")
    assert done.code == 2
    assert message in done.err
    assert not (tmp_path / "new.scene").exists()
