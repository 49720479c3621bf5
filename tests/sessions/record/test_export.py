"""Tables of a session, from its record alone."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest

from tests.sessions.sittings import COMPARED, MINI, Session, of
from vbraille.analysis.input.sheets import read_csv
from vbraille.sessions.record.codebook import COLUMNS
from vbraille.sessions.record.export import Traces, rows, to_csv
from vbraille.sessions.record.folder import load
from vbraille.sessions.record.traces import read_trace

PAPER = MINI.replace('model = "vbd"', 'model = "vbd"\nmedium = "paper"')
ASKS = MINI + '[[fields]]\nname = "hand"\nask = "Reading hand"\n'


@pytest.fixture(scope="module")
def sat(tmp_path_factory):
    """A session read by a simulated reader."""
    return Session(tmp_path_factory.mktemp("export") / "s").sit()


def test_a_row_tells_what_was_shown_and_what_was_answered(sat):
    table = rows(sat.record)
    assert [list(row) for row in table] == [list(COLUMNS)] * 4
    for row, trial in zip(table, sat.record.plan.trials, strict=True):
        assert (row["session"], row["participant"], row["protocol"]) == ("s", "P1", "mini")
        assert (row["trial"], row["block"], row["attempt"]) == (trial.number, 1, 1)
        assert row["presented"] == trial.presented == row["answered"]
        assert (row["correct"], row["trace"], row["first_answer"]) == (1, "trace-001.gz", "")
        assert (row["texture"], row["contrast"], row["returned"]) == (0.0, 1.0, 1)
        assert row["answers_from"] == "simulated:0"


def test_durations_are_those_of_the_trace(sat):
    ticks = read_trace(sat.record.folder / "trace-001.gz").ticks
    protocol = sat.record.protocol
    # Whatever is shown begins with c, after a blank cell; S is 11 pitches of 0.7 mm.
    edge_mm = protocol.geometry.cell_pitch_mm - 11 * 0.7 / 2
    for row in rows(sat.record):
        x_mm = ticks["x_mm"][ticks["line"] == row["trial"]]
        t_s = ticks["time_ns"][ticks["line"] == row["trial"]] / 1e9
        on = np.flatnonzero(x_mm >= edge_mm)
        assert row["duration_s"] == pytest.approx(t_s[on[-1] + 1] - t_s[on[0]])
        assert 0 < row["contact_s"] < row["contact_s"] + row["duration_s"] <= row["response_s"]


def test_times_are_those_of_the_journal(sat):
    for row, cue, answer in zip(
        rows(sat.record), of(sat.events, "cue"), of(sat.events, "answer"), strict=True
    ):
        assert row["response_s"] == pytest.approx(answer["t_s"] - cue["t_s"])
        assert (row["cue_time"], row["answer_time"]) == (cue["wall"], answer["wall"])


def test_the_hand_that_goes_back_after_the_answer_is_of_no_trial(sat):
    # All ticks from the furthest place on are of an array at rest: the answer came there.
    record = sat.record
    traces = Traces(record)
    ticks = traces.read("trace-001.gz").ticks.copy()
    first = np.flatnonzero(ticks["line"] == 1)
    furthest = first[np.argmax(ticks["x_mm"][first])]
    ticks["flags"][furthest : first[-1] + 1] |= 1
    before = rows(record)[0]["duration_s"]
    traces._traces["trace-001.gz"] = replace(traces.read("trace-001.gz"), ticks=ticks)
    row = rows(record, traces)[0]
    assert (row["returned"], row["duration_s"] < 0.7 * before) == (0, True)


def test_what_is_not_answered_is_a_row_with_nothing_in_it(sat):
    for name, done in (("presented", 1), ("answer", 2)):
        second = [n for n, event in enumerate(sat.events) if event.kind == name][1]
        told = replace(sat.record.journal, events=sat.events[: second + 1])
        table = rows(replace(sat.record, journal=told))
        assert len(table) == 4
        assert [row["answered"] != "" for row in table] == [n < done for n in range(4)]
        for row in table[done:]:
            assert [row[c] for c in ("correct", "duration_s", "response_s")] == ["", "", ""]
    text = to_csv(table)
    assert len(text.splitlines()) == 5


def test_a_session_that_has_only_been_planned_has_its_rows(tmp_path):
    table = rows(load(Session(tmp_path / "s").folder))
    assert [row["attempt"] for row in table] == [0] * 4
    assert {row["trace"] for row in table} == {""}


def test_an_undone_answer_is_beside_the_one_that_counts(tmp_path):
    session = Session(tmp_path / "s")
    sat = session.sit(
        ("read:", "c"), ("cue: trial 2", "undo"), ("undo: trial 1", "?"), ("read:", "c"),
        ("read:", "note \tso, \"so\""), ("is in", "c"), ("read:", "c"), ("last:", ""),
    )  # fmt: skip
    table = rows(sat.record)
    assert (table[0]["answered"], table[0]["first_answer"]) == ("?", "⠉")
    assert table[2]["notes"] == 'so, "so"'
    read = list(csv.DictReader(io.StringIO(to_csv(table))))
    assert [row["notes"] for row in read] == ["", "", 'so, "so"', ""]


def test_a_note_that_begins_like_a_formula_is_none_and_is_read_again_as_it_was(tmp_path):
    table = rows(Session(tmp_path / "s").sit().record)[:1]
    plain = ("-2.5", "-", "'tis", "a=1")
    for note in ("=HYPERLINK(1)", "-2+3", "- tired", "@x", "'=1", "\t=1", *plain):
        sheet = tmp_path / "sheet.csv"
        sheet.write_text(to_csv([table[0] | {"notes": note}]))
        written = next(csv.DictReader(io.StringIO(sheet.read_text())))["notes"]
        assert written == (note if note in plain else f"'{note}")
        assert read_csv(sheet).frame["notes"].to_list() == [note]


def test_comparisons_have_two_values_and_no_duration(tmp_path):
    sat = Session(tmp_path / "s", COMPARED).sit()
    for row, trial in zip(rows(sat.record), sat.record.plan.trials, strict=True):
        assert row["parameter"] == "dot_width_mm"
        assert row["presented"] == " ".join(f"{s.value:g}" for s in trial.stimuli)
        assert row["answered"] in row["presented"].split()
        assert (row["correct"], row["duration_s"], row["trace"]) == ("", "", "trace-001.gz")


def test_on_paper_the_key_tells_the_duration(tmp_path):
    session = Session(tmp_path / "s", PAPER)
    turn = [("ready:|read:", ""), ("cue:", ""), ("read:", "c")]
    sat = session.sit(*turn * 4, ("last:", ""))
    for row, cue, read in zip(
        rows(sat.record), of(sat.events, "cue"), of(sat.events, "read"), strict=True
    ):
        assert row["duration_s"] == pytest.approx(read["t_s"] - cue["t_s"], abs=2e-6)
        assert row["trace"] == ""


def test_fields_are_columns(tmp_path):
    session = Session(tmp_path / "s", ASKS)
    record = replace(load(session.folder), head={"fields": {"hand": "left"}})
    assert [row["field_hand"] for row in rows(record)] == ["left"] * 4


def test_of_a_damaged_trace_no_trial_that_it_cuts_has_a_duration(tmp_path, rng):
    sat = Session(tmp_path / "s", hand="sweep:30").sit()  # several chunks a trial
    path = sat.record.folder / "trace-001.gz"
    whole = path.read_bytes()
    before = rows(sat.record)
    shorter = 0
    for bit in rng.integers(0, 8 * len(whole), 20).tolist():
        flipped = bytearray(whole)
        flipped[bit // 8] ^= 1 << bit % 8
        path.write_bytes(flipped)
        traces = Traces(sat.record)
        table = rows(sat.record, traces)
        assert [fault.split(",")[0] for fault in traces.faults] == ["trace-001.gz is damaged"]
        for row, full in zip(table, before, strict=True):
            assert row["duration_s"] in ("", full["duration_s"])
            shorter += row["duration_s"] == ""
            assert row["answered"] == full["answered"]
    path.unlink()
    traces = Traces(sat.record)
    assert {row["duration_s"] for row in rows(sat.record, traces)} == {""}
    assert traces.faults == ["trace-001.gz is damaged, it is gone"]
    assert 20 < shorter < 80
