"""Labels of pictures as cells, and what is said of those that cannot be read."""

import pytest

from vbraille.errors import InputError
from vbraille.labelling import label_warnings, write_label, write_labels
from vbraille.render import STRESS2_8X8
from vbraille.scene.patterns import Circle, Fill, Group, Label, Tile
from vbraille.scene.scene import Canvas, Scene

STYLE = STRESS2_8X8.style
GEOMETRY = STYLE.geometry


def label(text, **more):
    return Label(text=text, **{"place_mm": (5.0, 5.0), **more})


def scene(*elements, **more):
    return Scene(canvas=Canvas(width_mm=200, height_mm=100), elements=elements, **more)


def braille(written):
    return ["".join(chr(0x2800 + int(mask)) for mask in masks) for masks in written.lines]


def warned(*elements, **more):
    picture = scene(*elements, **more)
    return label_warnings(picture, write_labels(picture, STYLE))


def test_a_label_is_translated_as_a_book_is():
    written = write_label(label("the 3 houses", table="en-ueb-g2.ctb"), STYLE)
    assert braille(written) == ["⠮⠀⠼⠉⠀⠓⠳⠎⠑⠎"]
    assert written.style is STYLE


@pytest.mark.parametrize(
    ("own", "of_scene", "cells"),
    [
        ("", "en", "⠮"),
        ("", "en-ueb-g1.ctb", "⠞⠓⠑"),
        ("en-ueb-g1.ctb", "en", "⠞⠓⠑"),
        ("fr", "en", "⠞⠓⠑"),
    ],
)
def test_its_language_or_table_is_its_own_or_else_the_scenes(own, of_scene, cells):
    found = write_labels(scene(label("the", table=own), language=of_scene), STYLE)
    assert [braille(written) for written in found.values()] == [[cells]]


def test_lines_are_broken_at_the_width_and_where_the_text_has_them():
    three_mm = GEOMETRY.extent_mm(3)
    grade = {"table": "en-ueb-g1.ctb"}
    assert braille(write_label(label("ab cd e", width_mm=three_mm, **grade), STYLE)) == [
        "⠁⠃",
        "⠉⠙",
        "⠑",
    ]
    assert braille(write_label(label("a b cd", width_mm=three_mm - 0.1, **grade), STYLE)) == [
        "⠁",
        "⠃",
        "⠉⠙",
    ]
    assert braille(write_label(label("a  b\n\ncd\n", **grade), STYLE)) == ["⠁⠀⠃", "", "⠉⠙"]
    assert braille(write_label(label("abcd", width_mm=three_mm, **grade), STYLE)) == ["⠁⠃⠉", "⠙"]


def test_labels_are_found_wherever_they_stand():
    inner, masked = label("in", id="a"), label("of", id="b")
    texture = Group(operation="multiply", parts=(masked,))
    circle = Circle(center_mm=(9, 9), radius_mm=9, fill=Fill(texture=texture))
    found = write_labels(scene(Group(parts=(circle, inner)), inner), STYLE)
    assert set(found) == {inner, masked}


@pytest.mark.parametrize(
    ("element", "why"),
    [
        (label("x", table="enn.ctb"), r"unknown braille table 'enn\.ctb'"),
        (label("x", table="xx"), "no braille table for language 'xx'"),
        (label("x", width_mm=2.0), "width is 2 mm; a cell takes 6.3 mm, so make it wider"),
        (label("\u200b"), "text holds nothing that braille can show"),
    ],
)
def test_a_sentence_names_the_element_that_cannot_be_written(element, why):
    picture = scene(label("a"), Group(parts=(element,)))
    with pytest.raises(InputError, match=f"^elements, number 2, label '.*': {why}"):
        write_labels(picture, STYLE)
    with pytest.raises(InputError, match=r"^house\.scene line 12, label "):
        write_labels(picture, STYLE, ["house.scene line 3", "house.scene line 12"])


def test_what_stands_well_is_not_warned_of():
    below = label("two", place_mm=(5.0, 5.0 + GEOMETRY.line_pitch_mm))
    assert warned(label("one"), below, label("three", place_mm=(100, 20), angle_deg=45)) == []


def test_a_label_beyond_the_canvas_is_said():
    for place, angle, far in (((-2.0, 5.0), 0, 2), ((5.0, 95.0), 0, 3.2), ((3.2, 50.0), 90, 5)):
        (sentence,) = warned(label("ab", place_mm=place, angle_deg=angle, id="pen"))
        assert sentence.startswith(f"elements, number 1, label 'pen' reaches {far:.1f} mm beyond")


def test_labels_that_stand_on_each_other_are_said():
    first = label("one", id="a")
    for place, angle in (((5.0, 10.0), 0), ((14.0, 4.0), 60), ((30.0, 12.0), 180)):
        (sentence,) = warned(first, label("x", place_mm=place, angle_deg=angle, id="b"))
        assert sentence == (
            "elements, number 2, label 'b' stands on elements, number 1, label 'a'; "
            "move one of them"
        )


def test_a_label_that_is_tiled_has_no_place_of_its_own():
    part = label("far", place_mm=(500.0, 500.0))
    assert warned(Tile(width_mm=30, height_mm=30, part=part)) == []


def test_characters_that_a_table_does_not_know_are_said():
    (sentence,) = warned(label("日 1 月"))
    assert "has 2 characters that its table does not know: 日 月" in sentence
