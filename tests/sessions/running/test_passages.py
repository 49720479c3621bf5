"""Passages: broken into lines, read one after the other, timed, and asked about."""

import numpy as np
import pytest

from tests.sessions.sittings import MINI, Session, kill_often, of
from vbraille.analysis.chapters import Options, analyse_study
from vbraille.analysis.input.study import load_study
from vbraille.analysis.measures.passages import reading_speed, timed
from vbraille.errors import InputError
from vbraille.sessions.planning.making import check_plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.planning.stimuli import broken, joined
from vbraille.sessions.record import bids
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.folder import check_folder
from vbraille.sessions.record.passages import went_back

TEXTS = [
    "The ferry leaves the harbour at seven every morning, and nobody is late.",
    "Her brother keeps bees behind the old house, where the lime trees are.",
]
PASSAGES = f"""
format = 1
name = "passages"
title = "Two passages"
source = "ours"
model = "stress2"
[display]
table = "en-ueb-g1.ctb"
[design]
kind = "list"
strings = {TEXTS}
passage = true
[[questionnaire]]
kind = "choice"
name = "clear"
when = "trial"
ask = "Was it clear?"
choices = ["yes", "no"]
right = "yes"
"""
SIZES = """
[[factors]]
name = "width"
levels = [{ name = "narrow", dot_width_mm = 1.0 }, { name = "wide", dot_width_mm = 1.5 }]
"""


def test_a_passage_is_broken_where_words_end(tmp_path):
    session = Session(tmp_path / "s", PASSAGES)
    check_plan(session.protocol, session.plan)
    room = session.protocol.geometry.cells_per_line(session.protocol.model.display.span_mm)
    for trial in session.plan.trials:
        lines = [stimulus.masks for stimulus in trial.stimuli]
        assert len(lines) > 1
        assert max(map(len, lines)) + session.protocol.lead_cells <= room
        assert all(line[0] and line[-1] for line in lines)
        assert broken(joined(trial.stimuli), room - session.protocol.lead_cells) == lines
        assert trial.stimuli[0].text in TEXTS


def test_it_is_read_line_by_line_and_timed(tmp_path):
    session = Session(tmp_path / "s", PASSAGES, hand="sweep:100")
    sat = session.sit()
    assert sat.progress.ended
    table = rows(sat.record)
    for row, trial in zip(table, sat.record.plan.trials, strict=True):
        assert (row["lines"], row["answered"]) == (len(trial.stimuli), "read")
        assert row["words"] == len(trial.stimuli[0].text.split())
        # The simulated hand sweeps each line at 100 mm/s, there and back, and never stands still.
        lines = [s.geometry.extent_mm(len(s.masks) + 1) for s in trial.stimuli]
        least_s = (sum(lines) + sum(lines[:-1])) / 100
        assert row["words_per_minute"] == pytest.approx(60 * row["words"] / least_s, rel=0.4)
        assert (row["hand_pauses"], row["regressions"]) == (0, 0)
        assert row["asked_clear_correct"] == 1
    assert all(finding.good for finding in check_folder(session.folder))
    assert bids.files(sat.record)
    kill_often(session, tmp_path / "killed", cuts=4)


def test_at_the_console_the_next_line_comes_and_a_question_follows(tmp_path):
    sat = Session(tmp_path / "s", PASSAGES).sit(
        ("cue: trial 1 of 2$", "r"), ("the second has not been felt", "note x"),
        ("^read: type read, or broken off", "perhaps"), ("no answer", "R"),
        ("asked: Was it clear", "2"), ("cue: trial 2", "stop"),
    )  # fmt: skip
    assert [e["answer"] for e in of(sat.events, "answer")] == ["read"]
    assert rows(sat.record)[0]["asked_clear"] == "no"


def test_the_speed_of_each_participant_is_found_again(tmp_path):
    folders = []
    for number, hand in enumerate(("sweep:100", "sweep:150", "sweep:200"), 1):
        session = Session(tmp_path / f"{number}", PASSAGES, participant=f"P{number}", hand=hand)
        session.sit()
        folders.append(session.folder)
    study = load_study(folders)
    *own, whole = reading_speed(study.judgements).records()
    speeds = [row["speed"] for row in own]
    assert speeds == sorted(speeds)
    assert whole["speed"] == pytest.approx(np.mean(speeds))
    assert whole["low"] < whole["speed"] < whole["high"]


def test_words_a_minute_are_the_primary_measure(tmp_path):
    toml = PASSAGES.replace("[[questionnaire]]", SIZES + "[[questionnaire]]", 1)
    folders = []
    for number, hand in enumerate(("sweep:100", "sweep:150", "sweep:200"), 1):
        session = Session(tmp_path / f"{number}", toml, participant=f"P{number}", hand=hand)
        session.sit()
        folders.append(session.folder)
    assert session.protocol.planned_analysis.measure == "reading_speed"
    study = load_study(folders)
    results = analyse_study(study, Options())
    assert results.title == "Reading speed by width"
    rows = [row for row in results.table("primary").to_dict("records") if row["kind"] == "mean"]
    own = timed(study.judgements).groupby(["factor_width", "participant"], observed=True)
    means = own["words_per_minute"].mean().groupby("factor_width").mean()
    assert {row["of"]: row["value"] for row in rows} == pytest.approx(means.to_dict())
    assert all(0 <= row["low"] < row["value"] < row["high"] for row in rows)
    assert "words a minute" in results.findings[0]
    assert "reading speed" in results.methods


def test_ways_back_are_counted_from_half_a_cell():
    there = np.linspace(0, 30, 31)
    back = np.linspace(30, 24, 7)
    assert went_back(there, 3.0) == 0
    assert went_back(np.concatenate((there, back, there + 24)), 3.0) == 1
    assert went_back(np.concatenate((there, back[:2], there + 29)), 3.0) == 0
    assert went_back(np.concatenate((there, back, np.linspace(24, 28, 5), back - 2)), 3.0) == 2


@pytest.mark.parametrize(
    ("toml", "says"),
    [
        (PASSAGES.replace('table = "en-ueb-g1.ctb"', ""), "lank"),
        (MINI + '[question]\nkind = "read"\n', "which is asked of passages"),
        (PASSAGES + '[analysis]\nmodel = "trials"\n', "shares of right answers, not of reading_s"),
        (PASSAGES + '[question]\nkind = "identify"\n', "which is asked of strings"),
        (PASSAGES.replace("passage = true", "passage = true\ncatch = { every = 2 }"), "neither"),
        (PASSAGES.replace('"stress2"', '"stress2"\nmedium = "paper"'), "line by line on a device"),
    ],
)
def test_passages_that_cannot_be_are_refused(toml, says):
    with pytest.raises(InputError) as refused:
        parse_protocol(toml, "page.toml")
    assert says in str(refused.value)
