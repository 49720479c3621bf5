"""Sessions of designs with groups, items and catch trials: whole, exported, and gone on with."""

from dataclasses import dataclass, field

import pandas as pd
import pytest

from vbraille.analysis.input.study import load_study
from vbraille.errors import VbrailleError
from vbraille.sessions.conditions import Conditions
from vbraille.sessions.record.folder import check_folder
from vbraille.sessions.session import Session

PROTOCOL = """
format = 1
name = "mini"
title = "Items of a file in two groups"
source = "ours"
model = "vbd"
[design]
kind = "items"
catch = { every = 3 }
[items]
file = "items.csv"
[[factors]]
name = "width"
levels = [{ name = "narrow", dot_width_mm = 1.5 }, { name = "wide", dot_width_mm = 2.0 }]
[[factors]]
name = "gap"
between = true
levels = [{ name = "near", cell_gap_mm = 6.0 }, { name = "far", cell_gap_mm = 7.0 }]
"""
FAST = Conditions(fast=True, hand="sweep:150")


@dataclass
class Few:
    """Answers so many trials as asked for, and then none."""

    left: int
    shown: list = field(default_factory=list)

    def __call__(self, trial):
        if not self.left:
            return None
        self.left -= 1
        self.shown.append((trial.number, trial.condition, trial.presented))
        return "?" if trial.catch else trial.presented


def begin(folder, who="P02"):
    (folder / "mini.toml").write_text(PROTOCOL)
    (folder / "items.csv").write_text("string,kind\nca,word\nac,non\n")
    return Session.create(folder / "mini.toml", who, folder=folder / who, seed=1, conditions=FAST)


def test_columns_of_the_design(tmp_path):
    session = begin(tmp_path).run(Few(6))
    rows = session.trials
    assert {row["group"] for row in rows} == {row["factor_gap"] for row in rows} == {"far"}
    assert {row["cell_gap_mm"] for row in rows} == {"7"}
    for row in rows:
        assert row["factor_width"] == row["condition"]
        assert row["dot_width_mm"] == {"narrow": "1.5", "wide": "2"}[row["condition"]]
        kind = {"⠉⠁": "word", "⠁⠉": "non", "⠀⠀": ""}[row["presented"]]
        assert row["item_kind"] == kind
        assert row["catch"] == ("" if kind else "blank")
    assert [row["correct"] for row in rows] == [1] * 6
    assert all(finding.good for finding in check_folder(session.folder))


def test_catch_trials_are_left_out_and_counted(tmp_path):
    session = begin(tmp_path).run(Few(6))
    study = load_study([session.folder])
    assert len(study.trials) == 4
    (left,) = study.left_out
    assert left.what == "2 catch trials of P02"
    assert left.reason.endswith("2 answered right")
    assert set(study.trials["factor_gap"]) == {"far"}
    # The column of the table tells the same, of a session that was not ended, too.
    some = begin(tmp_path, "P03").run(Few(4))
    table = pd.DataFrame(some.trials)
    used = table[table.analysed == 1]
    assert set(used.trial) == set(load_study([some.folder]).trials["trial"])
    assert 0 < len(used) < 4 < len(table)


def test_a_session_goes_on_with_the_same_trials_though_the_files_beside_are_gone(tmp_path):
    whole = Few(6)
    begin(tmp_path, "P04").run(whole)
    first, second = Few(2), Few(4)
    other = tmp_path / "other"
    other.mkdir()
    begin(other, "P04").run(first)
    (other / "items.csv").unlink()
    (other / "mini.toml").unlink()
    Session.resume(other / "P04", fast=True).run(second)
    assert first.shown + second.shown == whole.shown


def test_a_file_that_was_changed_is_refused(tmp_path):
    session = begin(tmp_path).run(Few(1))
    (session.folder / "items.csv").write_text("string,kind\nca,non\nac,non\n")
    with pytest.raises(VbrailleError, match=r"items\.csv is not what it was when the session"):
        Session.resume(session.folder)
    assert not all(finding.good for finding in check_folder(session.folder))
