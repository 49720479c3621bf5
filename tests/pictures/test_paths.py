"""The paths over a picture: where they go, how fast, and what is refused."""

import numpy as np
import pytest

from vbraille.errors import InputError
from vbraille.pictures.paths import path_of
from vbraille.scene.scene import Canvas
from vbraille.simulation.exploring import Wide, spiral
from vbraille.simulation.specs import parse_hand
from vbraille.simulation.steering import Area

CANVAS = Canvas(width_mm=100, height_mm=60)


def lengths(course):
    return np.hypot(np.diff(course.x_mm), np.diff(course.y_mm))


@pytest.mark.parametrize("size", [(100, 60), (60, 100), (60, 60), (97, 55), (30, 8)])
def test_the_wide_path_goes_round_and_then_inward_and_leaves_no_place_out(size):
    width, height = size
    x, y = spiral(*size, 10)
    assert list(zip(x[:4], y[:4], strict=True)) == [(0, 0), (width, 0), size, (0, height)]
    assert (x.min(), x.max(), y.min(), y.max()) == (0, width, 0, height)
    course = Wide(10).read_page(Area(1, height, width))
    t_s = np.arange(0, course.duration_s, 0.005)
    gone = np.interp(t_s, course.t_s, course.x_mm), np.interp(t_s, course.t_s, course.y_mm)
    for place in np.random.default_rng(1).uniform((0, 0), size, (200, 2)):
        assert np.hypot(gone[0] - place[0], gone[1] - place[1]).min() <= 10 / np.sqrt(2) + 0.2
    np.testing.assert_allclose(lengths(course) / np.diff(course.t_s), 60)


def path(spec, rate_hz=500.0):
    return path_of(parse_hand(spec), CANVAS, 8.4, rate_hz)


def test_poses_are_those_of_the_path_at_even_times(tmp_path):
    wide = path("wide:20")
    np.testing.assert_allclose(np.diff(wide.t_s), 1 / 500)
    assert (wide.x_mm[0], wide.y_mm[0]) == pytest.approx((0, 0))
    assert wide.x_mm.max() == pytest.approx(100, abs=0.2)
    csv = tmp_path / "hand.csv"
    csv.write_text("t_s,x_mm,y_mm,theta_deg\n0,0,5,0\n0.4,40,9,90\n")
    recorded = path(f"recorded:{csv}", 100.0)
    assert recorded.x_mm[[0, -1]].tolist() == pytest.approx([4.2, 44.2])
    assert recorded.y_mm[[0, -1]].tolist() == pytest.approx([5, 9])
    assert recorded.theta_rad[-1] == pytest.approx(np.pi / 2)
    csv.write_text("0,0\n0.4,40\n")
    assert set(path(f"recorded:{csv}", 100.0).y_mm) == {30.0}


@pytest.mark.parametrize(
    ("spec", "said"),
    [
        ("round", "round"),
        ("sweep:60", "does not go over a picture"),
        ("spot:3;4", "spot:3;4"),
        ("spot:3", "spot:X,Y"),
        ("spot:3,nan", "place is nan mm"),
        ("wide:0.1", "spacing is 0.1 mm; it must be 0.5 to 1000 mm"),
        ("recorded:none.csv", "there is no file none.csv"),
    ],
)
def test_what_is_no_path_is_refused(spec, said):
    with pytest.raises(InputError, match=said):
        path(spec)
