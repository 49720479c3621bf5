import numpy as np
import pytest

from tests.pictures.tables import TABLES
from vbraille.carriers import tactograph
from vbraille.pictures import draw, resolution_words

TABLE = TABLES[-1]


def test_the_map_has_the_span_that_the_source_says_of_the_page_and_of_the_canvas():
    places = TABLE.where("what", "place")
    assert (places["x_mm"].min(), places["x_mm"].max()) == pytest.approx((-139.7, 139.7))
    assert (places["y_mm"].min(), places["y_mm"].max()) == pytest.approx((120.0, 335.9))
    assert round(places["resolution_um"].min(), 1) == 20.2
    assert round(places["resolution_um"].max(), 1) == 50.6
    inside = places.where("on_canvas", 1)
    assert np.ptp(inside["x_mm"]) <= tactograph.WIDTH_MM
    assert 23.6 <= inside["resolution_um"].min() <= inside["resolution_um"].max() <= 45.2


def test_the_ratios_have_their_best_where_the_source_has_it():
    ratios = TABLE.where("what", "ratio")
    at = np.argmin(ratios["worst_um"])
    assert ratios["ratio"][at] == pytest.approx(0.57, abs=0.011)
    assert ratios["first_arm_mm"][at] == pytest.approx(234.23, abs=1.5)
    assert ratios["worst_um"][at] == pytest.approx(47.6, abs=0.1)
    at = np.argmin(ratios["best_um"])
    assert ratios["ratio"][at] == pytest.approx(0.81)
    assert round(ratios["best_um"][at], 1) == 19.6


def test_the_words_say_what_the_map_shows():
    words = resolution_words()
    assert "20.2 µm" in words[0]
    assert "50.6 µm" in words[0]
    assert words[1] == "over the canvas of 220 × 150 mm: 23.6 to 45.2 µm"
    assert "19.6 µm" in words[3]
    assert "204.16 mm" in words[3]
    assert "47.6 µm" in words[4]
    assert "234.23 mm" in words[4]


@pytest.mark.no_cover
def test_the_drawing_has_the_map_and_the_ratios():
    tray, arms = draw.draw(TABLE).axes
    assert tray.get_ylim() == (335.9, 120.0)  # the reader sits below
    coarsest, finest = arms.get_lines()[:2]
    assert np.min(coarsest.get_ydata()) > np.max(np.asarray(finest.get_ydata()))
