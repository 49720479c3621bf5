"""Recordings of `vbraille render`, played back: a frame at any time, with the line under it."""

import json
import signal
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import h5py
import numpy as np
import pytest

import vbraille
from tests.cli import program
from tests.live.showing import Client, parts
from vbraille.errors import InputError
from vbraille.live.messages import Next, Turn
from vbraille.playback.rendered import open_recording
from vbraille.recording import Print
from vbraille.render import STRESS2

LINES = [[1, 3, 9, 0], [63, 17, 25, 11]]
TEXTS = ["abc", "=efd"]
X_MM = np.concatenate([np.linspace(-6, 60, 2000), np.linspace(60, -6, 500)])


@cache
def recorded():
    """Give a recording of two lines that are read one after the other; no test may change it."""
    masks = [np.array(line, np.uint8) for line in LINES]
    style, display = STRESS2.style, STRESS2.display
    sources = np.array([(0, 1), (1, 2), (2, 3), (3, 3)], np.int32)
    recording = vbraille.Recording(
        t_s=np.arange(2 * X_MM.size) / 1000,
        x_mm=np.tile(X_MM, 2),
        y_mm=np.zeros(2 * X_MM.size),
        theta_rad=np.zeros(2 * X_MM.size),
        frames=np.concatenate([style.render(line, display).path(X_MM) for line in masks]),
        model=STRESS2,
        cells=masks,
        line=np.repeat([0, 1], X_MM.size),
        part=np.zeros(2 * X_MM.size, np.int64),
        prints=[Print(text, sources) for text in TEXTS],
    )
    path = Path(mkdtemp(prefix="vbraille-recording-")) / "a.h5"
    recording.write(path)
    return path


def damaged(tmp_path, chunk):
    """Give the recording with a chunk of its frames overwritten."""
    with h5py.File(recorded()) as file:
        at = file["frames"].id.get_chunk_info(chunk).byte_offset
    content = bytearray(recorded().read_bytes())
    content[at : at + 64] = bytes(64)
    path = tmp_path / "damaged.h5"
    path.write_bytes(content)
    return path


def look(viewer, at_s):
    """State, header and deflections at a time."""
    _, state, frame = viewer.look(Next(at_s=at_s), None)
    return json.loads(state), *parts(frame)


def test_each_frame_is_the_recorded_one_forwards_and_backwards():
    with h5py.File(recorded()) as file:
        frames, t_s, x_mm, rows = (file[name][:] for name in ("frames", "t_s", "x_mm", "line"))
    source = open_recording(recorded())
    viewer = source.viewer()
    assert source.playback
    assert source.length_s == t_s[-1]
    count = len(frames)
    for n in [*range(0, count, 301), *range(count - 1, 0, -407), 0]:
        state, header, frame = look(viewer, float(t_s[n]))
        assert frame.tobytes() == frames[n].tobytes()
        assert (header["tick"], header["time_s"]) == (n, t_s[n])
        assert header["x_mm"] == np.float32(x_mm[n])
        (under,) = [line for line in state["lines"] if line["under"]]
        assert under["number"] == header["line"] == rows[n] + 1
    changes = t_s[np.flatnonzero(np.diff(rows, prepend=-1))]
    assert [moment.at_s for moment in source.moments] == changes.tolist()


def test_lines_have_their_print_and_the_place_of_each():
    state = look(open_recording(recorded()).viewer(), 0.0)[0]
    first, second = state["lines"]
    assert [first["text"], second["text"]] == TEXTS
    assert [first["cells"], second["cells"]] == LINES
    assert first["text"][slice(*first["sources"][1])] == "b"
    assert second["top_mm"] - first["top_mm"] == state["geometry"]["line_pitch_mm"]
    assert state["array"]["rows"] == 6


def test_times_beyond_the_recording_are_its_ends():
    source = open_recording(recorded())
    viewer = source.viewer()
    assert look(viewer, -5.0)[1]["tick"] == 0
    for at_s in (1e300, float("nan"), None):  # no time is the one before
        assert look(viewer, at_s)[1]["time_s"] == source.length_s
    with pytest.raises(InputError):
        source.ask(Turn("texture", 0.5))


def test_a_damaged_chunk_is_passed_over(tmp_path):
    viewer = open_recording(damaged(tmp_path, 2)).viewer()
    assert look(viewer, 2.1)[1]["tick"] == 2047
    assert look(viewer, 4.0)[1]["tick"] == 4000


def test_a_page_sees_a_recording_until_ctrl_c():
    process = program.start("monitor", str(recorded()))
    try:
        said = process.stdout.readline().decode()
        with Client(said.removeprefix("live view: ").strip()) as page:
            assert page.welcome["playback"]
            assert not page.welcome["steers"]
            assert page.welcome["moments"][0]["kind"] == "line"
            header, deflections = page.frame(at_s=0.2)
            assert header["time_s"] == pytest.approx(0.2, abs=1e-3)
            assert deflections.shape == (6, 10)
            page.ask(ask="press", command="LNDN")
            assert "recording" in page.hear()["why"]
        process.send_signal(signal.SIGINT)
        assert process.wait(program.PATIENCE_S) == 0
    finally:
        process.kill()
        process.communicate()


def test_what_cannot_be_played_is_one_sentence(tmp_path):
    (tmp_path / "empty").touch()
    (tmp_path / "cut.h5").write_bytes(recorded().read_bytes()[:9000])
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["t_s"] = [1.0]
    for name in ("none.h5", "empty", "cut.h5", "other.h5"):
        with pytest.raises(InputError, match=name):
            open_recording(tmp_path / name)
    done = program.run("monitor", tmp_path / "cut.h5")
    assert done.returncode == 2
    assert "cut.h5" in done.stderr
    assert done.stderr.count("\n") == 1


def test_one_that_is_being_written_or_whose_times_go_back_is_said_to_be(tmp_path):
    path = tmp_path / "changed.h5"
    path.write_bytes(recorded().read_bytes())
    with h5py.File(path, "r+") as file:
        done = program.run("monitor", path)
        assert done.returncode == 2
        assert "open in another program" in done.stderr
        file["t_s"][len(file["t_s"]) // 2 :] -= 1.0
    for open_it in (open_recording, vbraille.Recording.open):
        with pytest.raises(InputError, match="times of a recording must increase"):
            open_it(path)
