"""The page for the device that is there."""

import pytest

from tests.engine.test_loop import info
from vbraille.devices.registry import check_actuators, check_travel
from vbraille.errors import InputError
from vbraille.render import VBD
from vbraille.wording import spelled


def test_a_device_that_is_not_the_model_asked_for_is_one_sentence():
    with pytest.raises(InputError) as caught:
        check_actuators(info(), VBD.on(VBD.style.geometry))
    assert spelled(str(caught.value)) == (
        "test has 6 × 10 actuators and the page is for 1 × 12; choose another --model or --device"
    )


def test_a_page_may_be_narrower_than_the_travel_and_not_wider():
    check_travel(info(travel_mm=200.0), 150.0)
    check_travel(info(travel_mm=200.0), 200.0)
    with pytest.raises(InputError, match="goes 200 mm and ‹travel› asks for 201 mm"):
        check_travel(info(travel_mm=200.0), 201.0)
