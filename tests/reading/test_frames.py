"""Lines and pages of text as frames, from Python."""

import numpy as np
import pytest

import vbraille


@pytest.mark.parametrize("model", [vbraille.STRESS2, vbraille.STRESS2_8X8], ids=lambda m: m.name)
def test_each_line_of_a_page_is_felt_as_it_is_alone(model):
    page = vbraille.render_page("one\ntwo", display=model, grade=1)
    pitch_mm = page.style.geometry.line_pitch_mm
    for number, line in enumerate(page.lines, 1):
        alone = vbraille.render_text(line.text.strip(), display=model, grade=1)
        way_mm = np.full(alone.positions_mm.size, (number - 0.5) * pitch_mm)
        assert alone.frames.any()
        np.testing.assert_array_equal(page.frames(alone.positions_mm, way_mm), alone.frames)


def test_lines_of_a_page_are_those_asked_for():
    text = "\n".join(["one", "two", "three"])
    assert [line.number for line in vbraille.render_page(text, first=2).lines] == [2, 3]
    assert [line.text for line in vbraille.render_page(text, first=2, last=2).lines] == ["two"]


def test_one_pose_is_one_frame():
    page = vbraille.render_page("one")
    assert page.frames(3.0, 7.0).shape == (1, 6, 10)


@pytest.mark.parametrize("places", [([np.nan], 0.0), ([[1.0]], 0.0), ([1.0, 2.0], [1.0, 2.0, 3.0])])
def test_places_that_are_none_are_refused(places):
    with pytest.raises(ValueError, match=r"places of a path|shape mismatch"):
        vbraille.render_page("one").frames(*places)


def test_a_frame_by_its_place():
    made = vbraille.render_text("abc")
    np.testing.assert_array_equal(made.at(made.positions_mm[40] + 0.01), made.frames[40])


def test_cells_and_characters_find_each_other():
    cells = vbraille.translate_text("the world", language="en", grade=2)
    for cell in range(len(cells)):
        first, after = cells.source(cell)
        for character in range(first, after):
            low, high = cells.of_source(character)
            assert low <= cell < high
