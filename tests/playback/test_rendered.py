"""What `vbraille render` wrote: any frame at any time, bit for bit, with the line under it."""

import io
import json

import h5py
import numpy as np
import pytest
from PIL import Image

import vbraille
from tests.playback.written import LINES, MODELS, asked, record, recorded
from vbraille.braille.geometry import Geometry
from vbraille.errors import InputError
from vbraille.live.messages import Map, Next
from vbraille.playback import open_recording
from vbraille.playback.rendered import Rendered
from vbraille.render import STRESS2


@pytest.mark.parametrize("name", MODELS)
def test_each_frame_is_the_recorded_one_forwards_and_backwards(name):
    path = recorded(name)
    with h5py.File(path) as file:
        frames, t_s, x_mm, rows = (file[n][:] for n in ("frames", "t_s", "x_mm", "line"))
    source = open_recording(path)
    viewer = source.viewer()
    assert source.playback
    assert source.length_s == t_s[-1]
    for n in [*range(0, len(frames), 3), *range(len(frames) - 1, 0, -5), 0]:
        request = Next(at_s=float(t_s[n]))
        number, state = viewer.state(request)
        header, frame, _ = asked(viewer, float(t_s[n]))
        assert frame.tobytes() == frames[n].tobytes()
        assert header["tick"] == n
        assert header["time_s"] == t_s[n]
        assert header["x_mm"] == np.float32(x_mm[n])
        assert header["state"] == number == json.loads(state)["number"]
        assert header["line"] == rows[n] + 7
        (under,) = [line for line in json.loads(state)["lines"] if line["under"]]
        assert under["number"] == rows[n] + 7
    assert [moment.kind for moment in source.moments] == ["line"] * (rows.max() + 1)
    for moment in source.moments:
        first = int(np.flatnonzero(t_s >= moment.at_s - 1e-9)[0])
        assert first == 0 or rows[first - 1] != rows[first]


def test_a_time_between_two_frames_has_the_earlier_one(tmp_path):
    path = record(tmp_path / "a.h5", LINES, np.linspace(-6, 60, 1500))
    viewer = open_recording(path).viewer()
    for at_s, tick in ((0.0, 0), (0.0104, 10), (2.9999, 2999), (-5.0, 0), (1e300, 5999)):
        assert asked(viewer, at_s)[0]["tick"] == tick
    assert np.frombuffer(viewer.frame(Next()), "<f8", 1, 24)[0] == 5999  # where it was


def test_the_lines_are_those_of_the_page(tmp_path):
    source = open_recording(record(tmp_path / "a.h5", LINES, np.linspace(-6, 60, 1500)))
    state = json.loads(source.viewer().state(Next(at_s=1.6))[1])
    assert [line["number"] for line in state["lines"]] == [7, 8, 9, 10]
    assert [line["cells"] for line in state["lines"]] == [line.tolist() for line in LINES]
    assert [line["top_mm"] for line in state["lines"]] == [-14.0, 0.0, 14.0, 28.0]
    assert [line["under"] for line in state["lines"]] == [False, True, False, False]
    assert state["title"] == "a.txt"
    assert state["place"] == "line 8"
    assert state["array"]["rows"] == 6
    assert state["array"]["row_pitch_mm"] == STRESS2.display.row_pitch_mm
    assert state["array"]["rest_right"]
    assert state["rows_shown"] == [[0, 0], [-1, -1], [1, 1], [-1, -1], [2, 2], [-1, -1]]
    assert state["knobs"] == []
    assert Geometry(**state["geometry"]) == STRESS2.style.geometry
    assert [moment.at_s for moment in source.moments] == [0, 1.5, 3, 4.5]


def test_a_page_of_lines_is_shown_as_one(tmp_path):
    source = open_recording(record(tmp_path / "a.h5", LINES, np.linspace(0, 40, 900), pages=True))
    seen = {}
    for at_s in np.arange(0, 1.8, 0.01):
        header, _, _ = asked(source.viewer(), at_s)
        state = json.loads(source.viewer().state(Next(at_s=at_s))[1])
        lines = [(line["number"], line["top_mm"]) for line in state["lines"]]
        assert lines == ([(7, 0), (8, 14)] if at_s < 0.9 else [(9, 0), (10, 14)])
        seen.setdefault(int(header["line"]), at_s)
    assert list(seen) == [7, 8, 9, 10]
    assert state["array"]["height_mm"] == 28
    image = Image.open(io.BytesIO(source.map(Map("png", 1.0))))
    assert image.size[1] == 280
    assert image.info["Title"] == "a.txt, line 9 to line 10"


def test_a_map_is_of_the_line_at_the_time(tmp_path):
    source = open_recording(record(tmp_path / "a.h5", LINES, np.linspace(-6, 60, 1500)))
    for form in ("png", "svg"):
        made = [source.map(Map(form, at_s)) for at_s in (0.2, 1.4, 1.6)]
        assert made[0] == made[1] != made[2]


def test_samples_are_the_ticks_since_the_frame_before(tmp_path):
    x_mm = np.linspace(-6, 60, 1500)
    viewer = open_recording(record(tmp_path / "a.h5", LINES, x_mm)).viewer()
    # Across the end of a piece, in which they stand in the file.
    header, frame, samples = asked(viewer, 1.040, 1.000, row=2, column=9)
    assert len(samples) == 40
    np.testing.assert_allclose(samples[:, 0], np.arange(39, -1, -1) / 1000, atol=1e-7)
    np.testing.assert_allclose(samples[:, 1], x_mm[1001:1041], atol=1e-5)
    assert samples[-1, 2] == frame[2, 9]
    before = asked(viewer, 1.010)[1][2, 9]
    assert samples[9, 2] == before
    _, _, thinned = asked(viewer, 3.0, 2.0)
    assert len(thinned) == 64
    assert thinned[-1, 0] == 0
    assert thinned[0, 0] > 0.95
    _, _, far = asked(viewer, 5.9, 0.0)
    assert 3.5 < far[0, 0] <= 4.0
    for since_s in (None, 1.040, 2.0):
        _, _, alone = asked(viewer, 1.040, since_s, row=-3, column=99)
        assert len(alone) == 1
        assert tuple(alone[0, :2]) == (0.0, header["x_mm"])


def test_a_recording_without_a_whole_frame_is_refused(tmp_path):
    path = record(tmp_path / "a.h5", LINES[:1], np.linspace(-6, 60, 500))
    with h5py.File(path) as file:
        at = file["frames"].id.get_chunk_info(0).byte_offset
    content = bytearray(path.read_bytes())
    content[at : at + 64] = bytes(64)
    path.write_bytes(content)
    with pytest.raises(InputError, match="no frame of the recording is whole"):
        open_recording(path)


def test_a_damaged_chunk_is_passed_over(tmp_path):
    path = record(tmp_path / "a.h5", LINES, np.linspace(-6, 60, 1500))
    with h5py.File(path) as file:
        at = file["frames"].id.get_chunk_info(2).byte_offset
    content = bytearray(path.read_bytes())
    content[at : at + 64] = bytes(64)
    path.write_bytes(content)
    viewer = open_recording(path).viewer()
    assert asked(viewer, 2.1)[0]["tick"] == 2047
    assert asked(viewer, 1.0)[0]["tick"] == 1000
    assert asked(viewer, 4.0, 1.9)[0]["tick"] == 4000


def test_a_line_has_its_print_and_what_each_cell_stands_for(tmp_path):
    made = vbraille.render_text("the day", grade=2).recording()
    made.write(tmp_path / "made.h5")
    again = vbraille.Recording.open(tmp_path / "made.h5")
    assert [one.text for one in again.prints] == [one.text for one in made.prints]
    again.write(tmp_path / "again.h5")
    played = Rendered(tmp_path / "again.h5")
    line = played.describe(1).lines[0]
    assert line.text == "the day"
    assert line.cells == made.cells[0].tolist()
    pieces = ["".join(line.text[begin:end]) for begin, end in line.sources]
    assert pieces[0] == "the"  # one cell, contracted
    assert "".join(dict.fromkeys(pieces)).replace(" ", "") == "theday"
    with pytest.raises(InputError, match="prints need one print"):
        vbraille.Recording(
            **{name: getattr(made, name) for name in made.__slots__} | {"prints": made.prints * 2}
        )


def test_a_recording_of_braille_alone_has_no_print():
    line = Rendered(recorded()).describe(1).lines[0]
    assert (line.text, line.sources) == ("", [(0, 0)] * len(line.cells))
