"""Sessions played back: frames as the actuators had them, and the journal beside them."""

import json
import shutil

import numpy as np
import pytest

from tests.playback.written import asked
from tests.sessions.written import ON_DEVICE, written
from vbraille.errors import InputError, VbrailleError
from vbraille.live.messages import Map, Next
from vbraille.playback import open_recording
from vbraille.playback.sessiontrace import SessionRecording
from vbraille.sessions.record import replay
from vbraille.sessions.record.folder import load
from vbraille.sessions.record.journal import Journal

RESUMED, STOPPED = written("resumed"), written("stopped")


def sent(folder):
    """All ticks of a session with the frames that were sent, as `session check` has them."""
    record = load(folder)
    found = list(replay.frames(record))
    ticks = [
        (int(t["time_ns"]), int(t["tick"]), int(t["line"])) for _, part, _ in found for t in part
    ]
    return ticks, np.concatenate([frames for *_, frames in found]).astype(np.float32)


@pytest.mark.parametrize("name", ON_DEVICE)
def test_each_frame_is_what_the_actuators_had_forwards_and_backwards(name):
    path = written(name)
    ticks, frames = sent(path)
    source = SessionRecording(path)
    pieces = [source.piece(number).ticks for number in range(source.pieces)]
    times_s = np.concatenate([piece["time_s"] for piece in pieces]).tolist()
    assert len(times_s) == len(ticks)
    viewer = source.viewer()
    chosen = [*range(0, len(ticks), 7), *range(len(ticks) - 1, -1, -11)]
    for n in chosen:
        if times_s[n] in times_s[n + 1 : n + 2]:
            continue  # the next one is not later, and stands for both
        request = Next(at_s=times_s[n])
        number, state = viewer.state(request)
        header, frame, _ = asked(viewer, times_s[n])
        assert frame.tobytes() == frames[n].tobytes()
        assert header["tick"] == ticks[n][1]
        assert header["line"] == ticks[n][2]
        assert header["state"] == number == json.loads(state)["number"]


@pytest.mark.parametrize("name", ON_DEVICE)
def test_moments_are_the_journals_on_the_clock_of_the_traces(name):
    path = written(name)
    record = load(path)
    source = open_recording(path)
    viewer = source.viewer()
    assert [m.at_s for m in source.moments] == sorted(m.at_s for m in source.moments)
    assert source.moments[-1].at_s <= source.length_s
    counted = {
        "cue": ("cue", "warning"), "answer": ("answer", "undo"), "tuning": ("tuning",),
    }  # fmt: skip
    for kind, events in counted.items():
        told = [event for event in record.journal.events if event.kind in events]
        assert len([m for m in source.moments if m.kind == kind]) == len(told)
    ticked = [e for e in record.journal.events if getattr(e, "time_ns", None) is not None]
    assert ticked
    came = [e for e in ticked if e.kind == "contact"]
    said = [m for m in source.moments if "came to the first dot" in m.text]
    for event, moment in zip(came, said, strict=True):
        header, *_ = asked(viewer, moment.at_s + 1e-6)
        assert header["tick"] == event.tick
    # Time counts from the first tick if that was before the session's clock began; and a run is
    # moved on whose run before was recorded beyond its last event.
    moved_s = np.array([m.at_s for m in said]) - [e.t_s for e in came]
    assert moved_s.min() >= -1e-9
    assert np.unique(moved_s.round(5)).size <= len(list(path.glob("trace-*.gz")))


def test_a_state_tells_the_trial_its_condition_and_its_answer():
    record = load(RESUMED)
    source = open_recording(RESUMED)
    viewer = source.viewer()
    begun = [m for m in source.moments if m.kind == "trial"]
    told = [event for event in record.journal.events if event.kind == "presented"]
    answers = {e.trial: e.answer for e in record.journal.events if e.kind == "answer"}
    trials = {trial.number: trial for trial in record.plan.trials}
    for moment, event in zip(begun, told, strict=True):
        state = json.loads(viewer.state(Next(at_s=moment.at_s + 0.3))[1])
        facts = dict(state["facts"])
        trial = trials[event.trial]
        assert state["title"] == "P07: letters"
        assert state["place"] == facts["trial"] == f"trial {event.trial}"
        assert facts["condition"] == trial.condition
        assert facts["answer"] == answers.get(event.trial, "none")
        assert facts["shown"] == trial.presented
        (line,) = state["lines"]
        assert line["cells"][-len(trial.stimuli[0].masks) :] == list(trial.stimuli[0].masks)
        assert state["knobs"] == []
        drawn = source.map(Map("svg", moment.at_s + 0.3)).decode()
        assert f"letters, trial {event.trial}</title>" in drawn
    state = json.loads(viewer.state(Next(at_s=0.0))[1])
    assert state["lines"] == []
    with pytest.raises(InputError, match="there is no map"):
        source.map(Map("png", 0.0))


def test_a_trace_alone_begins_with_its_own_first_tick():
    whole, alone = open_recording(RESUMED), open_recording(RESUMED / "trace-002.gz")
    header, *_ = asked(alone.viewer(), 0.0)
    assert header["time_s"] == 0
    assert header["tick"] == 0
    assert alone.length_s < whole.length_s
    texts = [m.text for m in whole.moments]
    own = [m.text for m in alone.moments]
    assert texts[-len(own) :] == own
    shift = whole.moments[-1].at_s - alone.moments[-1].at_s
    for at_s in np.linspace(0, alone.length_s, 40):
        one, other = asked(alone.viewer(), at_s), asked(whole.viewer(), at_s + shift + 1e-7)
        if one[0]["time_s"] + shift == pytest.approx(other[0]["time_s"], abs=1e-6):
            assert one[1].tobytes() == other[1].tobytes()


def test_a_session_that_is_not_ended_is_played_with_a_warning():
    assert [note for note in open_recording(STOPPED).notes if "not ended" in note]
    assert open_recording(RESUMED).notes == []


def test_a_session_that_runs_is_refused(tmp_path):
    folder = shutil.copytree(STOPPED, tmp_path / "s")
    with Journal(folder), pytest.raises(InputError, match="runs in a console"):
        open_recording(folder)
    open_recording(folder)


def test_a_session_on_paper_has_nothing_to_play():
    with pytest.raises(InputError, match="read on paper"):
        open_recording(written("on-paper"))


def test_a_trace_that_was_cut_short_is_played_up_to_there(tmp_path):
    folder = shutil.copytree(STOPPED, tmp_path / "s")
    trace = folder / "trace-001.gz"
    trace.write_bytes(trace.read_bytes()[:-5])
    source = open_recording(folder)
    assert any("cut short" in note for note in source.notes)
    assert any(m.kind == "fault" and "cut short" in m.text for m in source.moments)
    whole = open_recording(STOPPED).viewer()
    for at_s in (0.3, 1.0, 2.0):
        assert asked(whole, at_s)[1].tobytes() == asked(source.viewer(), at_s)[1].tobytes()


def test_a_damaged_part_is_passed_over_and_told(tmp_path):
    folder = shutil.copytree(STOPPED, tmp_path / "s")
    trace = folder / "trace-001.gz"
    content = bytearray(trace.read_bytes())
    content[len(content) // 2] ^= 1
    trace.write_bytes(content)
    source = open_recording(folder)
    assert any("damaged" in note for note in source.notes)
    (told,) = [m for m in source.moments if "is damaged here" in m.text]
    whole = open_recording(STOPPED)
    for at_s in np.linspace(0, whole.length_s, 50):
        one, other = asked(source.viewer(), at_s), asked(whole.viewer(), at_s)
        if one[0]["time_s"] == other[0]["time_s"] and one[1].size:
            assert one[1].tobytes() == other[1].tobytes()
    assert asked(source.viewer(), told.at_s + 0.01)[0]["time_s"] >= told.at_s


def test_a_damaged_journal_is_salvaged(tmp_path):
    folder = shutil.copytree(RESUMED, tmp_path / "s")
    journal = folder / "journal.jsonl"
    lines = journal.read_bytes().split(b"\n")
    at = next(n for n, line in enumerate(lines) if b'"presented"' in line)
    lines[at] = lines[at].replace(b'"presented"', b'"presentes"')
    journal.write_bytes(b"\n".join(lines))
    source = open_recording(folder)
    assert any("journal.jsonl is damaged" in note for note in source.notes)
    assert any(m.kind == "fault" and "of the journal" in m.text for m in source.moments)
    # It is not known what was shown there, and so no frame is invented.
    at_s = next(m.at_s for m in open_recording(RESUMED).moments if m.kind == "trial") + 0.2
    assert asked(open_recording(RESUMED).viewer(), at_s)[1].any()
    header, frame, _ = asked(source.viewer(), at_s)
    assert header["line"] == 1
    assert frame.size == 0
    assert json.loads(source.viewer().state(Next(at_s=at_s))[1])["lines"] == []


def test_a_session_without_its_traces_has_nothing_to_play(tmp_path):
    folder = shutil.copytree(STOPPED, tmp_path / "s")
    (folder / "trace-001.gz").unlink()
    with pytest.raises(VbrailleError, match="no trace with a frame"):
        open_recording(folder)
