"""The experiments of chapter 6, each planned, run, killed, resumed, exported and analysed."""

import re

import pytest

from tests.sessions.bidsvalid import complaints
from tests.sessions.sittings import crash
from tests.tiers import by_tier
from vbraille.analysis import analyse
from vbraille.sessions.conditions import Conditions
from vbraille.sessions.planning.protocolfiles import (
    builtin_text,
    load_protocol,
    parse_protocol,
    shipped_text,
)
from vbraille.sessions.record import bids
from vbraille.sessions.record.folder import check_folder
from vbraille.sessions.session import Session, plan_session

# Trials, seconds that a picture is felt, trials from break to break, and names of each choice.
EXPERIMENTS = {
    "shapes": (144, 20, 24, (6,)),
    "spatial-frequency": (110, 10, None, (2,)),
    "orientation-fine": (90, 10, 45, (6,)),
    "orientation-coarse": (40, 15, None, (4,)),
    "icons": (48, 40, 16, (4, 2, 2)),
}
FAST = Conditions(hand="wide", fast=True)
_ROWS = 6  # pictures of a test


def shortened(name):
    """An experiment with a few of its pictures, each once, and one condition after the other."""
    text = re.sub(r"(?m)^repeats = \d+$", "repeats = 1", builtin_text(name))
    text = re.sub(r"(?m)^break_every = \d+$", "break_every = 4", text)

    def beside(file):
        whole = shipped_text(file)
        if not file.endswith(".csv"):
            return whole
        head, *rows = whole.splitlines()
        step = len(rows) // _ROWS | 1  # odd, so that each thing that is named varies
        return "\n".join([head, *rows[::step]])

    return parse_protocol(text, f"{name}.toml", beside=beside)


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_it_has_the_numbers_of_the_source(name):
    trials, exposure_s, break_every, names = EXPERIMENTS[name]
    protocol, plan = plan_session(name, "P01", 1)
    assert len(plan.trials) == trials
    assert protocol.trial.exposure_s == exposure_s
    assert protocol.session.break_every == break_every
    assert tuple(len(choice.names) for choice in protocol.asks.choices) == names
    assert len(protocol.asks.keys) <= 8  # a button each
    assert protocol.model.name == "pantograph"
    assert len({trial.stimuli[0].picture for trial in plan.practice}) > 1
    for trial in plan.trials:
        (stimulus,) = trial.stimuli
        assert len(stimulus.answer.split()) == len(names)


def test_pairs_of_wavelengths_are_as_often_as_in_the_source():
    protocol = load_protocol("spatial-frequency")
    _, plan = plan_session(protocol, "P01", 1)
    differences = [float(protocol.columns_of(t.item)["difference_mm"]) for t in plan.trials]
    counts = {d: differences.count(d) for d in set(differences)}
    assert counts == {n / 2: 22 - 2 * n for n in range(1, 11)}


# These two protocols differ in choices, breaks, keys and limits of time.
@pytest.mark.parametrize(
    "name", by_tier(["orientation-coarse", "icons"], [*EXPERIMENTS], [*EXPERIMENTS])
)
def test_a_session_of_it_loses_nothing(name, tmp_path):
    protocol = shortened(name)
    folder = tmp_path / "s"
    session = Session.create(protocol, "P01", folder=folder, seed=1, conditions=FAST)
    session.run("simulated:0.4")
    whole = [(row["presented"], row["answered"], row["picture"]) for row in session.trials]
    assert all(answered for _, answered, _ in whole)
    crash(folder, len((folder / "journal.jsonl").read_bytes()) // 2)
    again = Session.resume(folder, fast=True)
    kept = again.progress.done
    assert 0 < kept < len(whole)
    again.run("simulated:0.4")
    rows = [(row["presented"], row["answered"], row["picture"]) for row in again.trials]
    assert rows[:kept] == whole[:kept]  # the trial that was cut has another attempt
    assert [row[::2] for row in rows] == [row[::2] for row in whole]
    assert all(answered for _, answered, _ in rows)
    assert all(finding.good for finding in check_folder(folder, None))
    bids.write(again.record, tmp_path / "set")
    assert not complaints(tmp_path / "set")
    results = analyse([folder])
    cells = {row["cell"]: row for row in results.table("names").to_dict("records")}
    right = sum(presented == answered for presented, answered, _ in rows)
    everything = ", ".join(["all"] * len(protocol.planned_analysis.factors))
    assert (cells[everything]["trials"], cells[everything]["right"]) == (len(whole), right)
    confused = results.table("names_confusion")
    assert confused["trials"].sum() == len(whole) * len(EXPERIMENTS[name][3])
    assert "Planned: right answers by" in results.question[0]
