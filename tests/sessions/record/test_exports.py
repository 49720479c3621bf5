"""What is made of records: rows, frames, datasets, and what is removed of a person."""

import csv
import io
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.sessions.bidsvalid import complaints
from tests.sessions.sittings import HEAD, MINI, SURE, WIDTHS, made
from vbraille.errors import InputError
from vbraille.sessions.record.bids import export_bids
from vbraille.sessions.record.record import read
from vbraille.sessions.record.replay import Replay
from vbraille.sessions.record.trials import best_level, codebook, protocol_of, rows, to_csv
from vbraille.sessions.record.withdraw import Withdrawal
from vbraille.sessions.running.device import SessionDevice

ASKED = """
[[questionnaire]]
kind = "choice"
name = "sure"
when = "trial"
ask = "Sure?"
choices = ["yes", "no"]
right = "yes"
[[fields]]
name = "hand"
ask = "Reading hand"
choices = ["right", "left"]
"""
KINDS = {
    "identify": MINI + SURE + ASKED,
    "which": WIDTHS + '[question]\nkind = "which"\nright = "more"\n',
    "same-different": WIDTHS + 'same = 1\n[question]\nkind = "same-different"\n',
    "odd": WIDTHS + 'reference = 1.5\nform = "triangle"\n[question]\nkind = "odd"\n',
    "match": WIDTHS + 'reference = 1.5\nform = "abx"\n[question]\nkind = "match"\n',
    "detect": MINI + '[question]\nkind = "detect"\n',
    "rating": MINI + '[question]\nkind = "rating"\nscale = "x"\nleast = 1\nmost = 5\n',
    "magnitude": MINI + '[question]\nkind = "magnitude"\n',
    "adjust": WIDTHS + 'reference = 1.5\nform = "standard"\n[question]\nkind = "adjust"\n'
    "step = 0.1\nleast = 0.5\nmost = 3.0\n",
}


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """A session of each kind of question that a simulated reader answers, by the kind."""
    found = {}
    for number, (kind, text) in enumerate(KINDS.items(), 1):
        folder = tmp_path_factory.mktemp(kind)
        found[kind] = made(folder, text, f"P{number:02}").sit(answers="simulated").session.path
    return found


def test_a_row_has_what_was_planned_answered_and_felt(sessions):
    table = rows(sessions["identify"])
    assert [row["trial"] for row in table] == [1, 2, 3]
    for row in table:
        assert row["answered"] == row["presented"]
        assert (row["correct"], row["outcome"], row["analysed"]) == (1, "right", 1)
        assert 0 < row["duration_s"] < row["response_s"]
        assert row["confidence"] in range(1, 5)
        assert (row["asked_sure"], row["asked_sure_correct"]) == ("yes", 1)
        assert row["moved_by"].startswith("simulated")
    anonymous = rows(sessions["identify"], anonymous=True)
    assert {row["cue_time"] + row["notes"] for row in anonymous} == {""}


def test_all_kinds_have_rows_that_the_codebook_describes(sessions):
    for kind, path in sessions.items():
        table = rows(path)
        assert {row["question"] for row in table} == {kind}
        assert all(row["answered"] for row in table)
        told = codebook(table[0], protocol_of(read(path)))
        assert list(told) == list(table[0])
        assert all(column.meaning for column in told.values())
        (head, *_) = csv.reader(io.StringIO(to_csv(table)))
        assert head == list(table[0])


def test_a_cell_that_looks_like_a_formula_is_text():
    assert to_csv([{"answered": "=1+1", "number": -2.5}]) == "answered,number\n'=1+1,-2.5\n"


def test_frames_are_made_again_bit_for_bit(tmp_path, monkeypatch):
    felt, poll = {}, SessionDevice.poll

    def watched(device):
        ticks, happened = poll(device)
        for tick in ticks:
            felt.setdefault(int(tick["line"]), []).append(tick["frame"].copy())
        return ticks, happened

    monkeypatch.setattr(SessionDevice, "poll", watched)
    sat = made(tmp_path, MINI + "repeats = 2\n").sit(answers="simulated")
    replay = Replay(sat.session.path)
    assert len(replay.showings) == 6
    for line in replay.showings:
        _, frames = replay.frames(line)
        played = np.array(felt[line])
        np.testing.assert_array_equal(frames.astype(played.dtype), played)


def test_a_dataset_of_all_kinds_has_nothing_against_it(sessions, tmp_path):
    export_bids(list(sessions.values()), tmp_path / "set")
    assert complaints(tmp_path / "set") == ""
    (events,) = (tmp_path / "set" / "sub-P01").rglob("*_events.tsv")
    table = list(csv.DictReader(events.read_text("utf-8").splitlines(), delimiter="\t"))
    onsets = [float(row["onset"]) for row in table]
    assert onsets == sorted(onsets)
    assert sum(row["trial_type"] == "answer" for row in table) == 3
    with pytest.raises(InputError, match="already"):
        export_bids([sessions["detect"]], tmp_path / "set")


def test_pseudonyms_that_are_alike_are_refused(tmp_path):
    paths = [
        made(tmp_path, MINI, who).sit(answers="simulated").session.path for who in ("P1", "p01")
    ]
    export_bids(paths[:1], tmp_path / "set", anonymous=True)
    with pytest.raises(InputError, match="p01"):
        export_bids(paths[1:], tmp_path / "set")


def test_all_of_a_person_is_found_and_removed(sessions, tmp_path):
    mine, other = tmp_path / "P01-mini.session", tmp_path / "P02-mini.session"
    mine.write_bytes(sessions["identify"].read_bytes())
    other.write_bytes(sessions["which"].read_bytes())
    export_bids([mine, other], tmp_path / "set")
    (tmp_path / "trials.csv").write_text(to_csv(rows(mine) + rows(other)), "utf-8")
    (tmp_path / "letter.txt").write_text("Dear P01", "utf-8")
    found = Withdrawal([tmp_path], "P01")
    assert mine in found.whole
    assert found.rows[tmp_path / "trials.csv"] == 3
    assert found.left == [tmp_path / "letter.txt"]
    found.remove()
    assert not mine.exists()
    assert other.exists()
    kept = list(csv.DictReader((tmp_path / "trials.csv").read_text("utf-8").splitlines()))
    assert {row["participant"] for row in kept} == {"P02"}
    assert not (tmp_path / "set" / "sub-P01").exists()
    assert "P01" not in (tmp_path / "set" / "participants.tsv").read_text()
    assert Withdrawal([tmp_path], "P01").lines == []


def test_the_best_texture_of_a_session_is_known(tmp_path):
    conditions = "".join(
        f'[[conditions]]\nname = "T{level}"\ntexture = {level}.0\n' for level in (0, 1)
    )
    sat = made(tmp_path, f'{HEAD}[design]\nkind = "list"\nstrings = ["ac", "ca"]\n{conditions}')
    trials = sat.session.content.plan.trials
    sat.sit(answers=["??" if trial.condition == "T0" else trial.cells for trial in trials])
    assert best_level(sat.session.path, "texture") == 1.0


def test_the_command_withdraws_after_it_has_asked(sessions, tmp_path):
    mine = tmp_path / "P01-mini.session"
    mine.write_bytes(sessions["identify"].read_bytes())
    for lines, code, left in (("no\n", 2, True), ("yes\n", 0, False)):
        done = subprocess.run(
            [Path(sys.executable).with_name("vbraille"), "session", "withdraw", "P01", tmp_path],
            input=lines, check=False, capture_output=True, text=True,
        )  # fmt: skip
        assert (done.returncode, mine.exists()) == (code, left), done.stderr
        assert "Traceback" not in done.stderr
