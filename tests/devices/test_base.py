import numpy as np
import pytest

from tests.engine.test_loop import info
from vbraille.errors import DeviceError
from vbraille.simulation.simulated import SimulatedDevice


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("levels", 1),
        ("rest_side", "up"),
        ("rows", 0),
        ("columns", 0),
        ("column_pitch_mm", 0.0),
        ("travel_mm", float("nan")),
        ("counts_per_mm", -1.0),
        ("rate_hz", 0.0),
    ],
)
def test_info_checks_itself(field, value):
    with pytest.raises(ValueError, match=field.split("_")[0]):
        info(**{field: value})


def test_span():
    assert info().span_mm == pytest.approx(10.8)


@pytest.mark.parametrize("kind", [np.float64, np.float32, np.float16])
@pytest.mark.parametrize("bad", [1.001, 1.8, -0.001, -0.0001, np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("order", ["C", "F"])
def test_no_kind_of_frame_takes_a_bad_deflection_to_the_actuators(kind, bad, order):
    device = SimulatedDevice(info())
    good = np.full((6, 10), 0.5, kind, order)
    good[0, 0], good[5, 9], good[3, 3] = 0.0, 1.0, -0.0
    device.write(good)
    for at in np.ndindex(good.shape):
        frame = good.copy(order)
        frame[at] = bad
        with pytest.raises(DeviceError, match="not in"):
            device.write(frame)
    assert device.frames == 1
