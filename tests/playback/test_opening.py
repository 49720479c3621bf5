"""What cannot be played is one sentence, whatever it is."""

import os
import shutil

import h5py
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.playback.written import asked, recorded
from tests.sessions.written import written
from tests.tiers import by_tier
from vbraille.errors import InputError, VbrailleError
from vbraille.live.messages import Map, Next, Turn
from vbraille.playback import open_recording

STOPPED = written("stopped")
_fuzzed = settings(
    max_examples=by_tier(25, 150, 5000),
    suppress_health_check=[HealthCheck.function_scoped_fixture],
    deadline=None,
)


def refused(path, match):
    with pytest.raises(InputError, match=match) as caught:
        open_recording(path)
    assert "\n" not in str(caught.value)


def test_what_is_not_there_or_something_else_is_refused(tmp_path):
    refused(tmp_path / "no.h5", "there is no file")
    refused(tmp_path, "not the directory of a session")
    for name, content, match in (
        ("empty.h5", b"", "is empty; give"),
        ("text.h5", b"no recording", "is no recording; give"),
        ("a.gz", b"\x1f\x8b\x08", "not the directory of a session"),
        ("cut.h5", recorded().read_bytes()[:9000], "was not written whole"),
        ("a\x1bb.txt", b"x", "a<escape>b.txt is no recording"),
    ):
        path = tmp_path / name
        path.write_bytes(content)
        refused(path, match)
    os.mkfifo(tmp_path / "pipe")
    refused(tmp_path / "pipe", "is no file")
    refused("n" * 300, "cannot be read: File name too long")
    refused("a\0b", "cannot be read: embedded null")


def test_a_trace_that_the_journal_does_not_name_is_refused(tmp_path):
    folder = shutil.copytree(STOPPED, tmp_path / "s")
    shutil.copy(folder / "trace-001.gz", folder / "trace-009.gz")
    refused(folder / "trace-009.gz", "no trace that the session's journal names")


def changed(path, change):
    with h5py.File(path, "r+") as file:
        change(file)


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (
            lambda f: f.attrs.__setitem__("format", 99),
            "of format 99, and .* reads format 3",
        ),
        (
            lambda f: f.attrs.__setitem__("format", 2),
            "of format 2, and .* reads format 3",
        ),
        (lambda f: f.attrs.__delitem__("format"), "HDF5 of something else"),
        (lambda f: f.attrs.__setitem__("format", "new"), "HDF5 of something else"),
        (lambda f: f.__delitem__("frames"), "HDF5 of something else"),
        (lambda f: f.move("frames", "page/frames"), "HDF5 of something else"),
        (lambda f: f.attrs.__delitem__("rate_hz"), "HDF5 of something else"),
        (lambda f: f.attrs.__setitem__("geometry", "[]"), "HDF5 of something else"),
        (lambda f: f.attrs.__setitem__("row_offset_mm", np.zeros(3)), "HDF5 of something else"),
        (lambda f: f["x_mm"].resize(3, 0), "HDF5 of something else"),
        (lambda f: [f[n].resize(0, 0) for n in f if n != "page"], "has no frame"),
    ],
)
def test_a_file_of_something_else_is_refused(tmp_path, change, match):
    path = shutil.copy(recorded(), tmp_path / "a.h5")
    changed(path, change)
    refused(path, match)


def test_hdf5_of_something_else_is_refused(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["x"] = [1, 2]
    refused(tmp_path / "a.h5", "HDF5 of something else")


def test_a_manner_that_is_not_known_leaves_frames_alone(tmp_path):
    path = shutil.copy(recorded(), tmp_path / "a.h5")
    changed(path, lambda f: f.attrs.__setitem__("mapping", "of-tomorrow"))
    source = open_recording(path)
    one, other = asked(source.viewer(), 0.3), asked(open_recording(recorded()).viewer(), 0.3)
    assert one[1].tobytes() == other[1].tobytes()
    assert one[1].any()
    with pytest.raises(InputError, match="there is no map"):
        source.map(Map("png", 0.3))


def test_nothing_in_a_recording_can_be_turned():
    with pytest.raises(InputError, match="nothing in it can be changed"):
        open_recording(recorded()).ask(Turn("texture", 0.5))


def played(path):
    """Play a file that may be damaged: it plays, or it is a sentence."""
    try:
        source = open_recording(path)
    except VbrailleError as error:
        said = str(error)
    else:
        said = ""
    assert "\n" not in said
    if said:
        return
    viewer = source.viewer()
    assert source.length_s >= 0
    for at_s in (0.0, source.length_s / 2, source.length_s, 0.1):
        viewer.state(Next(at_s=at_s))
        asked(viewer, at_s, at_s - 0.2)


@_fuzzed
@given(at=st.integers(0, 27_000), byte=st.integers(1, 255))
def test_a_damaged_recording_plays_or_is_refused(tmp_path, at, byte):
    content = bytearray(recorded().read_bytes())
    content[at % len(content)] ^= byte
    (tmp_path / "a.h5").write_bytes(content)
    played(tmp_path / "a.h5")


@_fuzzed
@given(
    name=st.sampled_from(["journal.jsonl", "trace-001.gz", "plan.json", "session.json"]),
    at=st.integers(0, 30_000),
    byte=st.integers(0, 255),
)
def test_a_damaged_session_plays_or_is_refused(tmp_path, name, at, byte):
    folder = tmp_path / "s"
    if not folder.exists():
        shutil.copytree(STOPPED, folder)
    content = bytearray((STOPPED / name).read_bytes())
    if byte:
        content[at % len(content)] ^= byte
    else:
        del content[at % len(content) :]
    (folder / name).write_bytes(content)
    try:
        played(folder)
    finally:
        shutil.copy(STOPPED / name, folder / name)
