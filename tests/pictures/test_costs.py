"""Maps of what frames cost."""

import numpy as np
import pytest
from PIL import Image

from vbraille.errors import InputError
from vbraille.pictures.costs import costs_drawing, costs_words, draw_costs
from vbraille.pictures.ink import InkArea, InkRaster, InkText

MEAN_US = np.array([[10.0, 20.0, np.nan], [10.0, 10.0, 30.0]])
FRAME_US = np.array([1.0, 1.0, 1.0, 5.0])


def test_darker_squares_cost_more_and_white_ones_are_not_known():
    drawing = costs_drawing(MEAN_US, 2.0, "house", FRAME_US)
    raster = next(mark for mark in drawing.marks if isinstance(mark, InkRaster))
    assert raster.pixels.tolist() == [[230, 115, 255], [230, 230, 0]]
    assert raster.width_mm / raster.height_mm == pytest.approx(1.5)


def test_the_histogram_counts_frames():
    drawing = costs_drawing(MEAN_US, 2.0, "house", FRAME_US)
    bars = next(mark for mark in drawing.marks if isinstance(mark, InkArea)).contours
    tall = [bar[:, 1].max() - bar[:, 1].min() for bar in bars]
    assert len(tall) == 2
    assert tall[0] == pytest.approx(3 * tall[1])
    texts = [mark.text for mark in drawing.marks if isinstance(mark, InkText)]
    assert "tallest bar: 75% of all" in texts


def test_words_say_where_it_costs_most():
    words = costs_words(MEAN_US, 2.0)
    assert "most: 30.00 µs, around (5, 3) mm" in words
    assert "median: 10.00 µs" in words


@pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
def test_files(tmp_path, suffix):
    path = tmp_path / f"costs.{suffix}"
    draw_costs(MEAN_US, 2.0, path, title="house", frame_us=FRAME_US)
    assert path.stat().st_size > 500
    if suffix == "png":
        with Image.open(path) as image:
            assert image.text["Title"] == "house: time of a frame"
            assert "most: 30.00 µs" in image.text["Description"]


def test_what_cannot_be_drawn_is_refused(tmp_path):
    with pytest.raises(InputError, match="end its name in"):
        draw_costs(MEAN_US, 2.0, tmp_path / "a.gif", title="house", frame_us=FRAME_US)
    with pytest.raises(InputError, match="no frame was on the canvas"):
        draw_costs(
            np.full((2, 2), np.nan), 2.0, tmp_path / "a.png", title="house", frame_us=FRAME_US
        )
    assert not list(tmp_path.iterdir())
