"""What is typed as a note reaches every table, between the trials where it was typed."""

import csv
import json

import pytest

from tests.cli.test_session import WHO, words
from tests.sessions.sittings import MINI

ANSWERS = """note before the first
note in it
l
note in the second
c
?
l
note after the last
"""
PRACTISED = MINI + "[practice]\ntrials = 1\n"


@pytest.fixture
def noted(call, tmp_path):
    """A session of the program's, with notes in and after trials; its directory."""
    (tmp_path / "answers").write_text(ANSWERS)
    said = call(*words(tmp_path), "--answers", tmp_path / "answers")
    assert (said.code, said.err) == (0, "")
    return tmp_path / "s"


def table(path, delimiter=","):
    return list(csv.DictReader(path.read_text().splitlines(), delimiter=delimiter))


def test_notes_are_in_the_table_in_and_around_trials(call, noted, tmp_path):
    assert call("session", "export", noted, "--out", tmp_path / "t.csv").code == 0
    rows = table(tmp_path / "t.csv")
    assert [row["notes"] for row in rows] == [
        "before the first; in it", "in the second", "", "",
    ]  # fmt: skip
    assert [row["notes_after"] for row in rows] == ["", "", "", "after the last"]


def test_notes_are_among_the_events_of_bids_with_their_trials(call, noted, tmp_path):
    assert call("session", "export", noted, "--bids", "--out", tmp_path / "set").code == 0
    (path,) = (tmp_path / "set").rglob("*_events.tsv")
    events = table(path, "\t")
    notes = [
        (e["trial"], e["trial_before"], e["trial_after"], e["value"])
        for e in events if e["trial_type"] == "note"
    ]  # fmt: skip
    assert notes == [
        ("1", "1", "1", "before the first"), ("1", "1", "1", "in it"),
        ("2", "2", "2", "in the second"), ("n/a", "4", "n/a", "after the last"),
    ]  # fmt: skip
    onsets = [float(event["onset"]) for event in events]
    assert onsets == sorted(onsets)
    assert onsets[0] >= 0
    columns = json.loads(path.with_suffix(".json").read_text())
    assert list(columns) == list(events[0])
    # A contact's onset is the moment of its tick in the recording.
    contacts = [e for e in events if e["trial_type"] == "contact"]
    journal = [json.loads(line) for line in (noted / "journal.jsonl").read_text().splitlines()]
    ticks = [event["tick"] for event in journal if event["event"] == "contact"]
    assert [round(float(e["onset"]) * 1000) for e in contacts] == ticks


def test_notes_are_in_the_report(call, noted, tmp_path):
    said = call("analyse", noted, "--out", tmp_path / "report")
    assert said.code == 0, said.err
    rows = table(tmp_path / "report" / "tables" / "notes.csv")
    assert [row["text"] for row in rows] == [
        "before the first", "in it", "in the second", "after the last",
    ]  # fmt: skip
    assert [(row["trial_before"], row["trial"], row["trial_after"]) for row in rows] == [
        ("1", "1", "1"), ("1", "1", "1"), ("2", "2", "2"), ("4", "none", "none"),
    ]  # fmt: skip
    assert 'href="tables/notes.csv"' in (tmp_path / "report" / "report.html").read_text()


def test_a_note_between_trials_and_in_practice_is_tied_to_what_is_beside_it():
    from vbraille.sessions.record import events
    from vbraille.sessions.record.export import read_notes

    def shown(trial, **more):
        return events.Presented(t_s=0.0, trial=trial, attempt=1, stimulus=0, shown={}, **more)

    def note(text, trial=0, **more):
        return events.Note(t_s=0.0, text=text, trial=trial, **more)

    happened = [
        note("first"), shown(1, practice=True), note("practice", 1, practice=True), shown(1),
        note("between"), note("too"), shown(2), events.Stop(t_s=0.0), note("shown again"),
        shown(2), note("in", 2), note("last"),
    ]  # fmt: skip
    notes = read_notes(happened)
    told = [(note.text, note.before, note.trial, note.after, note.practice) for note in notes]
    assert told == [
        ("first", 0, 0, 1, False), ("practice", 0, 0, 1, True), ("between", 1, 0, 2, False),
        ("too", 1, 0, 2, False), ("shown again", 2, 2, 2, False), ("in", 2, 2, 2, False),
        ("last", 2, 0, 0, False),
    ]  # fmt: skip


def test_anonymous_tables_tell_no_time_of_day_no_path_and_no_note(call, noted, tmp_path):
    said = call("session", "export", noted, "--anonymous", "--out", tmp_path / "t.csv")
    assert said.code == 0
    assert said.err == "left out: 4 notes, since they may hold anything\n"
    text = (tmp_path / "t.csv").read_text()
    day = json.loads((noted / "journal.jsonl").read_text().splitlines()[0])["wall"][:10]
    for told in (day, str(tmp_path), "answers\n", "trace-", "after the last", "cue_time"):
        assert told not in text
    rows = table(tmp_path / "t.csv")
    assert {row["answers_from"] for row in rows} == {"file"}
    assert {len(row["session"]) for row in rows} == {8}
    assert all(row["response_s"] for row in rows)
    assert call("analyse", tmp_path / "t.csv").code == 0


def test_mapping_geometry_and_tuning_are_columns(call, tmp_path):
    said = call(
        "session", "run", "words", *WHO, "--seed", "1", "--texture", "0.5", "--contrast", "0.75",
        "--answers", "simulated", "--fast", "--hand", "sweep:400", "--out", tmp_path / "s",
    )  # fmt: skip
    assert said.code == 0, said.err
    call("session", "export", tmp_path / "s", "--out", tmp_path / "t.csv")
    row = table(tmp_path / "t.csv")[0]
    columns = (
        "model", "mapping", "texture", "contrast", "texture_cycles", "dot_width_mm",
        "dot_spacing_mm", "cell_gap_mm", "row_spacing_mm", "line_pitch_mm", "travel_mm",
    )  # fmt: skip
    assert [row[name] for name in columns[:5]] == ["stress2", "alternate", "0.5", "0.75", "7"]
    assert all(float(row[name]) > 0 for name in columns[5:])
