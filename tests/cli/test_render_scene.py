"""``vbraille render`` of a tactile picture, and its recording played."""

import hashlib

import h5py
import numpy as np
import pytest

import vbraille
from tests.reading.felt import DISPLAY, SCENE
from tests.render.scene.twin import deflections
from vbraille.errors import InputError
from vbraille.playback.rendered import open_recording
from vbraille.recording import scene_of
from vbraille.render.labels import Assets
from vbraille.scene.reading import open_scene

MOVING = (
    SCENE
    + """
[[elements]]
kind = "vibration"
id = "air"
frequency_hz = 10
amplitude = 0.5
"""
)


@pytest.fixture
def scene(tmp_path):
    """A picture that vibrates, in a file."""
    path = tmp_path / "house.scene"
    path.write_text(MOVING)
    return path


def test_each_frame_is_what_the_twin_has_at_its_pose_and_time(call, scene, tmp_path):
    out = tmp_path / "house.h5"
    hand = tmp_path / "hand.csv"
    hand.write_text("t_s,x_mm,y_mm,theta_deg\n0,80,10,0\n0.3,90,30,20\n")
    done = call("render", scene, "--hand", f"recorded:{hand}", "--out", out)
    assert (done.code, done.err) == (0, "")
    assert done.out == "rendered: 301 frames, 0.3 s on the way\n"
    resolved = open_scene(scene).resolved
    with h5py.File(out) as file:
        assert file.attrs["format"] == 3
        assert file.attrs["model"] == "stress2-8x8"
        assert file.attrs["source_sha256"] == hashlib.sha256(MOVING.encode()).hexdigest()
        assert not file["line"][:].any()
        told = scene_of(file)
        assert told.text == MOVING.encode()
        assert (told.title, told.width_mm, told.height_mm) == ("A house", 120, 90)
        assert told.map_png.startswith(b"\x89PNG")
        t_s, theta_rad, frames = (file[n][:] for n in ("t_s", "theta_rad", "frames"))
        centre_mm = file["x_mm"][:], file["y_mm"][:]
    right, down = DISPLAY.column_offsets_mm(), DISPLAY.row_offsets_mm()
    right, down = np.meshgrid(right - right.mean(), down - down.mean())
    parity = np.add.outer(np.arange(8), np.arange(8)) % 2
    for n in range(0, 301, 23):
        cos, sin = np.cos(theta_rad[n]), np.sin(theta_rad[n])
        x_mm = centre_mm[0][n] + right * cos + down * sin
        y_mm = centre_mm[1][n] + down * cos - right * sin
        places = x_mm.ravel(), y_mm.ravel(), parity.ravel()
        wanted = deflections(resolved, Assets(), *places, time_s=float(t_s[n]))
        np.testing.assert_allclose(frames[n].ravel(), wanted, atol=1e-6)
    poses = np.column_stack((*centre_mm, theta_rad))
    opened = vbraille.open_scene(scene)
    np.testing.assert_array_equal(opened.frames(poses, t_s), frames)
    np.testing.assert_array_equal(opened.frames(poses, t_s, (60.0, 0.0)), frames)
    assert opened.frames(poses[:2, :2], display=vbraille.LATERO).shape == (2, 8, 8)
    for wrong in (poses[0], poses[:, :1], poses * np.nan):
        with pytest.raises(InputError, match="poses must be finite"):
            opened.frames(wrong)
    with pytest.raises(InputError, match="one for each pose"):
        opened.frames(poses, t_s[:7])


def test_a_recording_of_a_picture_is_played_with_the_picture(call, scene, tmp_path):
    out = tmp_path / "house.h5"
    assert call("render", scene, "--hand", "spot", "--seconds", "1", "--out", out).code == 0
    played = open_recording(out)
    state = played.describe(1)
    assert state.title == "A house"
    assert (state.scene.width_mm, state.scene.height_mm) == (120, 90)
    assert state.scene.image.startswith("data:image/png;base64,")
    assert (state.lines, state.place, played.moments) == ([], "", [])
    assert (state.array.travel_mm, state.array.height_mm) == (120, 90)
    assert played.piece(0).ticks["y_mm"][0] == 45


def test_what_cannot_be_read_as_it_stands_is_said(call, scene, tmp_path):
    scene.write_text(MOVING + '[[elements]]\nkind = "label"\ntext = "sea"\nplace_mm = [119, 20]\n')
    hand = tmp_path / "hand.csv"
    hand.write_text("t_s,x_mm,y_mm\n0,80,10\n0.01,81,10\n")
    done = call("render", scene, "--hand", f"recorded:{hand}", "--out", tmp_path / "house.h5")
    assert done.code == 0
    assert "beyond the canvas; move it" in done.err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("render {scene} --hand round --out {out}", "the hand 'round' does not go over"),
        ("render {scene} --radius 3 --out {out}", "--radius is not for the hand wide"),
        ("render {text} --radius 3 --out {out}", "ways over a picture"),
        ("render {none} --hand wide --out {out}", "No such file"),
    ],
)
def test_what_cannot_be_is_one_sentence(call, scene, tmp_path, text, arguments, said):
    names = {"scene": scene, "out": tmp_path / "o.h5", "text": text, "none": tmp_path / "n.scene"}
    done = call(*arguments.format(**names).split())
    assert done.code == 2
    assert said in done.err
    assert done.err.count("\n") == 1
    assert not (tmp_path / "o.h5").exists()
