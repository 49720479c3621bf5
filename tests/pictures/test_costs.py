"""Maps of what frames cost."""

import numpy as np
import pytest
from PIL import Image

from vbraille.errors import InputError
from vbraille.feeling.costs import CostMap
from vbraille.pictures.drawings import costs_figure, costs_words, draw_costs

PLACES = CostMap(np.array([[10.0, 20.0, np.nan], [10.0, 10.0, 30.0]]), 2.0)
NONE = CostMap(np.full((3, 3), np.nan), 20.0)
# A hand that goes down at 20 mm/s costs more than one that rests.
VELOCITIES = CostMap(
    np.where(np.arange(9) == 7, 40.0, np.where(np.arange(9) == 4, 8, np.nan)).reshape(3, 3), 20.0
)
FRAME_US = np.array([1.0, 1.0, 1.0, 5.0])


def test_darker_squares_cost_more_and_white_ones_are_not_known():
    figure = costs_figure(PLACES, VELOCITIES, "house", FRAME_US)
    (image,) = figure.axes[0].images
    (velocities,) = figure.axes[1].images
    assert velocities.get_extent() == [-30, 30, 30, -30]
    grays = image.cmap(image.norm(image.get_array()))[..., 0]
    assert grays[0, 0] == pytest.approx(0.9)
    assert grays[1, 2] == 0
    assert 0 < grays[0, 1] < 0.9
    assert image.get_array().mask[0, 2]
    assert image.get_extent() == [0, 6, 4, 0]


def test_the_histogram_counts_frames():
    bars = costs_figure(PLACES, VELOCITIES, "house", FRAME_US).axes[2].patches
    assert sorted(bar.get_height() for bar in bars if bar.get_height()) == [25, 75]


def test_words_say_where_it_costs_most():
    words = costs_words(PLACES, VELOCITIES)
    assert "most: 30.00 µs, around (5, 3) mm" in words
    assert "median: 10.00 µs" in words
    assert words[-2:] == [
        "cheapest velocity: 8.00 µs, around 0 mm/s to the right and 0 mm/s down",
        "dearest velocity: 40.00 µs, around 0 mm/s to the right and 20 mm/s down",
    ]


@pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
def test_files(tmp_path, suffix):
    path = tmp_path / f"costs.{suffix}"
    draw_costs(PLACES, VELOCITIES, path, title="house", frame_us=FRAME_US)
    assert path.stat().st_size > 500
    if suffix == "png":
        with Image.open(path) as image:
            assert image.text["Title"] == "house: time of a frame"
            assert "most: 30.00 µs" in image.text["Description"]


def test_what_cannot_be_drawn_is_refused(tmp_path):
    with pytest.raises(InputError, match="end its name in"):
        draw_costs(PLACES, VELOCITIES, tmp_path / "a.gif", title="house", frame_us=FRAME_US)
    with pytest.raises(InputError, match="no frame was on the canvas"):
        draw_costs(NONE, NONE, tmp_path / "a.png", title="house", frame_us=FRAME_US)
    assert not list(tmp_path.iterdir())
