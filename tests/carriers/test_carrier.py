"""What a display takes from the carrier that it stands on."""

from dataclasses import replace

from vbraille.carriers.carrier import PANTOGRAPH
from vbraille.render.braille.models import STRESS2


def test_on_the_pantograph_an_array_goes_along_and_across_and_is_not_turned():
    array = STRESS2.display
    found = PANTOGRAPH.under(array)
    assert found.name == f"{array.name} on the Pantograph"
    assert (found.travel_mm, found.height_mm, found.axes) == (113.0, 60.0, "xy")
    assert found == replace(
        array,
        name=found.name,
        travel_mm=113.0,
        height_mm=60.0,
        turns=False,
        counts_per_mm=1 / 0.013,
    )
