"""Sittings: from a session's directory to its rows and readings."""

import re

import numpy as np
import pytest

from tests.sessions.sittings import COMPARED, MINI, Session
from vbraille.analysis.input.sessions import (
    IN_PART,
    MOST_PICKED,
    ONE_PASS,
    PATTERNS,
    Example,
    Reading,
    _examples,
    pick,
    read_session,
)
from vbraille.errors import InputError
from vbraille.sessions.record import journal
from vbraille.sessions.record.events import Run
from vbraille.sessions.record.export import NEVER_CAME, rows
from vbraille.sessions.record.folder import load, versions
from vbraille.sessions.record.journal import Journal, Tie
from vbraille.sessions.record.traces import TRACE, TraceWriter, read_trace

PAPER = MINI.replace('model = "vbd"', 'model = "vbd"\nmedium = "paper"')


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A session read by a hand that goes over each string once, by a simulated reader."""
    session = Session(tmp_path_factory.mktemp("sittings") / "s", hand="sweep:60")
    session.sit()
    return session.folder


def cut(folder, to, name, number):
    """Copy a session as it was after the so-manieth event of a name, killed then."""
    to.mkdir()
    for path in folder.iterdir():
        (to / path.name).write_bytes(path.read_bytes())
    lines = (folder / journal.NAME).read_bytes().splitlines(keepends=True)
    last = [n for n, line in enumerate(lines) if b'"event":"%s"' % name.encode() in line][number]
    (to / journal.NAME).write_bytes(b"".join(lines[: last + 1]))
    return to


def test_a_sitting_is_its_rows_and_how_each_string_was_read(folder):
    sitting = read_session(folder)
    record = load(folder)
    assert sitting.rows == rows(record)
    assert (sitting.folder, sitting.head, sitting.protocol) == (
        folder,
        record.head,
        record.protocol,
    )
    assert (sitting.state, sitting.faults) == ("ended", [])
    assert sitting.versions == versions()
    assert list(sitting.readings) == [1, 2, 3, 4]
    for row in sitting.rows:
        reading = sitting.readings[row["trial"]]
        assert isinstance(reading, Reading)
        assert (reading.pattern, reading.passes, reading.rescans) == (ONE_PASS, 1, 0)
        assert reading.speed_right_mm_s == pytest.approx(60, rel=0.01)
        assert reading.speed_left_mm_s == pytest.approx(250, rel=0.01)
        assert (round(reading.duration_s, 6), reading.returned) == (row["duration_s"], True)


def test_a_pattern_has_an_example_to_draw(folder):
    sitting = read_session(folder)
    (example,) = sitting.examples
    durations = {row["trial"]: row["duration_s"] for row in sitting.rows}
    # Of 4, the second.
    assert durations[example.trial] == sorted(durations.values())[1]
    row = sitting.rows[example.trial - 1]
    assert (example.participant, example.condition, example.presented) == (
        row["participant"],
        row["condition"],
        row["presented"],
    )
    assert example.pattern == ONE_PASS
    assert example.end_s - example.start_s == pytest.approx(row["duration_s"])
    assert {example.start_s, example.end_s} <= set(example.time_s.tolist())
    assert example.time_s[0] == 0.0
    assert (np.diff(example.time_s) > 0).all()
    assert example.time_s.size == example.left_mm.size <= MOST_PICKED
    ticks = read_trace(folder / "trace-001.gz").ticks
    ticks = ticks[ticks["line"] == example.trial]
    at = np.searchsorted(ticks["time_ns"], ticks["time_ns"][0] + example.time_s * 1e9 - 0.5)
    half_mm = sitting.protocol.model.display.span_mm / 2
    assert (ticks["x_mm"][at] - half_mm == example.left_mm).all()
    # A blank cell, c, what was asked for, c; of a dot 2 mm wide.
    geometry = sitting.protocol.geometry
    pitch_mm, spacing_mm = geometry.cell_pitch_mm, geometry.dot_spacing_mm
    asked = [2 * pitch_mm + 1] * (example.presented in "⠁⠉")
    asked += [2 * pitch_mm + spacing_mm + 1] * (example.presented in "⠈⠉")
    beside = [cell * pitch_mm + side * spacing_mm + 1 for cell in (1, 3) for side in (0, 1)]
    assert example.dots_mm == pytest.approx([*beside[:2], *asked, *beside[2:]])
    assert example.span_mm == pytest.approx(7.7)


def test_the_example_is_the_trial_in_the_middle():
    def told(duration_s, trial, pattern):
        none = np.zeros(0)
        example = Example(trial, "P1", "", "", pattern, none, none, 0.0, 0.0, 7.7, ())
        return duration_s, example

    def chosen(*examples):
        return [(example.pattern, example.trial) for example in _examples(examples)]

    assert chosen() == []
    four = [told(3.0, 1, ONE_PASS), told(1.0, 2, ONE_PASS), told(2.0, 3, ONE_PASS)]
    assert chosen(*four) == [(ONE_PASS, 3)]
    four.append(told(9.0, 4, ONE_PASS))
    assert chosen(*four) == [(ONE_PASS, 3)]
    same = [told(1.0, 6, IN_PART), told(1.0, 5, IN_PART)]
    assert chosen(*same, *four) == [(ONE_PASS, 3), (IN_PART, 5)]


def test_a_way_is_picked_evenly_with_the_ticks_that_are_kept():
    x_mm = np.arange(12_000.0)
    x_mm[:100] = np.nan
    picked = pick(x_mm, (777, 11_003))
    assert MOST_PICKED - 3 < picked.size <= MOST_PICKED
    assert {100, 777, 11_003, 11_999} <= set(picked.tolist())
    assert np.isfinite(x_mm[picked]).all()
    assert np.diff(picked).max() < 1.1 * x_mm.size / MOST_PICKED
    assert pick(x_mm[:300], (150, 299)).tolist() == list(range(100, 300))


@pytest.mark.no_cover
def test_a_slow_hand_reads_in_all_kinds_of_ways(tmp_path):
    session = Session(tmp_path / "s", hand="device")
    session.sit()
    sitting = read_session(session.folder)
    for reading in sitting.readings.values():
        assert isinstance(reading, Reading)
        assert 3 < reading.speed_right_mm_s < 21
    patterns = {reading.pattern for reading in sitting.readings.values()}
    assert patterns <= set(PATTERNS[1:4])
    assert [example.pattern for example in sitting.examples] == [
        pattern for pattern in PATTERNS if pattern in patterns
    ]


def test_a_session_broken_off_says_where(folder, tmp_path):
    sitting = read_session(cut(folder, tmp_path / "open", "cue", 2))
    assert (sitting.state, list(sitting.readings)) == ("broken off in trial 3", [1, 2])
    sitting = read_session(cut(folder, tmp_path / "between", "answer", 2))
    assert sitting.state == "not ended: 3 of 4 trials answered"
    assert list(sitting.readings) == [1, 2, 3]
    assert [row["answered"] != "" for row in sitting.rows] == [True, True, True, False]
    assert sitting.faults == []
    planned = read_session(Session(tmp_path / "planned").folder)
    assert planned.state == "not ended: 0 of 4 trials answered"
    assert (planned.readings, planned.examples) == ({}, ())
    practised = Session(tmp_path / "practice", MINI + '[practice]\ntrials = 1\nstrings = ["aa"]\n')
    practised.sit(("cue: practice 1", "stop"))
    assert read_session(practised.folder).state == "broken off in practice trial 1"


def test_an_answer_taken_back_is_of_a_trial_that_was_read(tmp_path):
    session = Session(tmp_path / "s")
    session.sit(("read:", "c"), ("cue: trial 2", "undo"), ("undo: trial 1", "stop"))
    sitting = read_session(session.folder)
    assert (sitting.state, sitting.readings) == ("not ended: 0 of 4 trials answered", {})


def test_of_a_damaged_trace_the_trials_before_the_damage_are_read(folder, tmp_path):
    copy = cut(folder, tmp_path / "s", "end", 0)
    path = copy / "trace-001.gz"
    whole = bytearray(path.read_bytes())
    whole[len(whole) // 2] ^= 1
    path.write_bytes(whole)
    sitting = read_session(copy)
    (fault,) = sitting.faults
    assert re.fullmatch(
        r"trace-001\.gz is damaged, chunk \d of trace-001\.gz does not match its checksum", fault
    )
    known = [isinstance(reading, Reading) for reading in sitting.readings.values()]
    assert known == [True, False, False, False]
    assert sitting.readings[4] == "trace-001.gz is damaged before the end of it"
    assert [row["duration_s"] != "" for row in sitting.rows] == known
    path.unlink()
    sitting = read_session(copy)
    assert sitting.faults == ["trace-001.gz is damaged, it is gone"]
    assert sitting.examples == ()


def test_of_a_damaged_journal_what_comes_before_is_read(folder, tmp_path):
    copy = cut(folder, tmp_path / "s", "end", 0)
    lines = (copy / journal.NAME).read_bytes().splitlines(keepends=True)
    lines[12] = lines[12].replace(b"t_s", b"t_S")
    (copy / journal.NAME).write_bytes(b"".join(lines))
    sitting = read_session(copy)
    assert sitting.faults == ["journal.jsonl is damaged, line 13 does not match its checksum"]
    assert 0 < len(sitting.readings) < 4


def test_a_hand_that_never_came_to_the_string_has_not_read(folder, tmp_path):
    copy = cut(folder, tmp_path / "s", "end", 0)
    ticks = read_trace(copy / "trace-001.gz").ticks
    ticks["x_mm"][ticks["line"] == 2] = -7.7 / 2
    (copy / "trace-001.gz").unlink()
    trace = TraceWriter(copy / "trace-001.gz", lambda: Tie(0, 0))
    trace.add(ticks)
    trace.close()
    sitting = read_session(copy)
    assert sitting.readings[2] == NEVER_CAME == "the hand never came to the first dot"
    assert (sitting.rows[1]["duration_s"], sitting.rows[1]["correct"]) == ("", 1)
    assert isinstance(sitting.readings[3], Reading)


def test_comparisons_and_paper_have_no_readings(tmp_path):
    session = Session(tmp_path / "choice", COMPARED)
    session.sit()
    sitting = read_session(session.folder)
    assert (sitting.readings, sitting.examples, sitting.state) == ({}, (), "ended")
    assert sitting.rows == rows(load(session.folder))
    session = Session(tmp_path / "paper", PAPER)
    turn = [("ready:|read:", ""), ("cue:", ""), ("read:", "c")]
    session.sit(*turn * 4, ("last:", ""))
    sitting = read_session(session.folder)
    assert (sitting.readings, sitting.examples, sitting.state) == ({}, (), "ended")
    assert all(row["duration_s"] != "" for row in sitting.rows)


def test_runs_by_different_programs_are_all_told(folder, tmp_path):
    copy = cut(folder, tmp_path / "s", "answer", 1)
    with Journal(copy) as opened:
        for number in ("9.9", "9.9", "9.10"):
            opened.append(Run(why="resume", versions=versions() | {"numpy": number}, t_s=9.0))
    told = read_session(copy).versions
    assert told["numpy"] == f"{versions()['numpy']}, 9.9, 9.10"
    assert told["python"] == versions()["python"]


def test_what_is_no_session_is_said_so(tmp_path):
    with pytest.raises(InputError, match="there is no directory"):
        read_session(tmp_path / "none")
    with pytest.raises(InputError, match="is not the directory of a session"):
        read_session(tmp_path)


def test_only_the_last_attempt_up_to_its_answer_is_read(folder, tmp_path):
    # The first trial was shown before, and the hand went elsewhere after its answer.
    copy = cut(folder, tmp_path / "s", "end", 0)
    plain = read_session(copy).readings[1]
    ticks = read_trace(copy / "trace-001.gz").ticks
    first = ticks[ticks["line"] == 1]
    after = np.zeros(3000, TRACE)
    after["line"], after["flags"] = 1, 1
    after["x_mm"] = 20 * np.sin(np.arange(3000) / 100)
    after["time_ns"] = first["time_ns"][-1] + np.arange(1, 3001) * 1_000_000
    until = int(np.flatnonzero(ticks["line"] == 1)[-1]) + 1
    (copy / "trace-001.gz").unlink()
    trace = TraceWriter(copy / "trace-001.gz", lambda: Tie(0, 0))
    trace.add(np.concatenate([ticks[:until], after, ticks[until:]]))
    trace.close()
    assert read_session(copy).readings[1] == plain
