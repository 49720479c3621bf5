"""Recordings made from Python: what is written is what is read and what is played."""

import numpy as np
import pytest

import vbraille
from vbraille.errors import InputError
from vbraille.playback.rendered import open_recording

PAGE = "one\ntwo"


def page_recording():
    page = vbraille.render_page(PAGE, vbraille.STRESS2_8X8)
    x_mm = np.linspace(-4.0, 40.0, 300)
    y_mm = np.linspace(2.0, 2.0 * page.style.geometry.line_pitch_mm - 1.0, 300)
    return page, page.recording(x_mm, y_mm, 0.1, rate_hz=500.0)


@pytest.mark.parametrize("what", ["line", "page", "scene"])
def test_what_is_written_is_read_and_played(tmp_path, what):
    if what == "line":
        made = vbraille.render_text("abc", grade=1).recording(120.0)
    elif what == "page":
        made = page_recording()[1]
    else:
        canvas = vbraille.Canvas(width_mm=50, height_mm=30)
        opened = vbraille.open_scene(vbraille.Scene(title="Nothing", canvas=canvas))
        made = opened.recording([(x, 15.0, 0.2) for x in range(40)], rate_hz=50.0)
    made.write(tmp_path / "made.h5")
    again = vbraille.Recording.open(tmp_path / "made.h5")
    for name in ("t_s", "x_mm", "y_mm", "theta_rad", "line", "part", "frames"):
        assert np.array_equal(getattr(again, name), getattr(made, name)), name
    assert [row.tolist() for row in again.cells] == [row.tolist() for row in made.cells]
    assert (again.model.name, again.model.display.rate_hz) == (
        made.model.name, pytest.approx(made.model.display.rate_hz),
    )  # fmt: skip
    assert (again.scene is None) == (what != "scene")
    again.write(tmp_path / "again.h5")
    assert open_recording(tmp_path / "again.h5").length_s == pytest.approx(made.t_s[-1])


def test_a_path_over_a_page_has_its_frames_and_lines():
    page, made = page_recording()
    assert np.array_equal(made.frames, page.frames(made.x_mm, made.y_mm, 0.1).astype(np.float32))
    assert made.t_s[-1] == pytest.approx(299 / 500.0)
    assert set(made.line.tolist()) == {0, 1}
    assert [row.tolist() for row in made.cells] == [line.masks.tolist() for line in page.lines]


def test_a_recording_checks_itself(tmp_path):
    made = vbraille.render_text("a", grade=1).recording()

    def changed(**fields):
        given = {name: getattr(made, name) for name in made.__slots__}
        return vbraille.Recording(**given | fields)

    for fields, said in (
        ({"x_mm": made.x_mm[1:]}, "one place, line and part"),
        ({"frames": made.frames[:, 1:]}, "× 6 × 10"),
        ({"frames": made.frames + 1.5}, "from 0 to 1"),
        ({"frames": made.frames * np.nan}, "from 0 to 1"),
        ({"t_s": made.t_s[::-1]}, "must increase"),
    ):
        with pytest.raises(InputError, match=said):
            changed(**fields)
    with pytest.raises(InputError, match="above 0"):
        vbraille.render_text("a").recording(0.0)
    (tmp_path / "text.h5").write_text("no")
    for name, said in (("text.h5", "is no recording"), ("none.h5", "there is no file")):
        with pytest.raises(InputError, match=said):
            vbraille.Recording.open(tmp_path / name)
    made.write(tmp_path / "made.h5")
    with pytest.raises(InputError, match=r"made\.h5"):
        made.write(tmp_path / "made.h5")
    made.write(tmp_path / "made.h5", replace=True)


def test_a_line_is_drawn_with_its_units():
    pytest.importorskip("matplotlib").use("agg")
    made = vbraille.render_text("ab", grade=1)
    axes = made.plot()
    (image,) = axes.images
    assert np.array_equal(image.get_array(), made.frames.reshape(len(made), -1).T)
    assert (axes.get_title(), axes.get_xlabel()) == ("ab", "centre of the array (mm)")
    assert made._repr_html_() == "<p>ab<br>⠁⠃</p>"
    assert made.plot(axes) is axes
