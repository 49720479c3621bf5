"""The page for the device that is there."""

import pytest

from tests.engine.test_loop import info
from vbraille.cli.wanted import check_travel, model_of
from vbraille.errors import InputError
from vbraille.render import STRESS2, VBD


def test_a_known_array_is_a_model_with_the_device_s_own_pitches():
    model = model_of(info(column_pitch_mm=1.205, row_pitch_mm=1.79), None)
    assert model.name == "stress2"
    assert (model.display.column_pitch_mm, model.display.row_pitch_mm) == (1.205, 1.79)
    assert model_of(info(), None) == STRESS2
    assert model_of(info(rows=1, columns=12, column_pitch_mm=0.7, row_pitch_mm=0.7), "vbd") == VBD


@pytest.mark.parametrize(
    ("changes", "name", "sentence"),
    [
        (
            {"rows": 8, "columns": 8},
            None,
            "test has 8 × 8 actuators 1.2 mm apart, and pages are laid out for 6 × 10 1.2 mm apart "
            "(STReSS²) and 1 × 12 0.7 mm apart (VBD) only; choose another --device",
        ),
        (
            {},
            "vbd",
            "test has 6 × 10 actuators and the page is for 1 × 12; choose another --model or "
            "--device",
        ),
    ],
)
def test_another_array_is_one_sentence(changes, name, sentence):
    with pytest.raises(InputError) as caught:
        model_of(info(**changes), name)
    assert str(caught.value) == sentence


def test_a_page_may_be_narrower_than_the_travel_and_not_wider():
    check_travel(info(travel_mm=200.0), 150.0)
    check_travel(info(travel_mm=200.0), 200.0)
    with pytest.raises(InputError, match="goes 200 mm and --travel asks for 201 mm"):
        check_travel(info(travel_mm=200.0), 201.0)
