"""The paragraph on methods: every number of it is of the record, and follows it."""

import re

import pytest

from tests.sessions.sittings import COMPARED, MINI, Session
from tests.tiers import by_tier, heavy
from vbraille.analysis import analyse
from vbraille.analysis.input.study import load_study
from vbraille.analysis.methods import methods
from vbraille.sessions.record.export import rows
from vbraille.version import __version__

CONDITIONS = (
    MINI
    + """
[[conditions]]
name = "T0"
texture = 0.0
[[conditions]]
name = "T100"
texture = 1.0
"""
)
PRACTISED = MINI.replace('["a", "c", "4", "0"]', '["a", "c"]')
PRACTISED += '[practice]\ntrials = 2\nstrings = ["⠈"]\n'
# How a paragraph differs if the session does: what is read there then.
CHANGES = {
    "fewer items": ({"toml": MINI.replace('["a", "c", "4", "0"]', '["a", "c"]')}, "read 2 strings"),
    "longer items": (
        {"toml": MINI.replace("length = 1", "length = 2").replace('["a", "c", "4", "0"]',
                                                                  '["a", "c"]')},
        "read 4 strings of 2 cells each",
    ),
    "another title": ({"toml": MINI.replace("Four characters", "Signs")}, "(Signs between"),
    "conditions": (
        {"toml": CONDITIONS},
        "There were 2 conditions: T0 (texture 0, contrast 1, 4 trials), "
        "T100 (texture 1, contrast 1, 4 trials)",
    ),
    "another seed": ({"seed": 77}, "drawn with seed 77"),
    "another display": (
        {"toml": MINI.replace('"vbd"', '"stress2"')}, "the STReSS² (6 × 10 actuators"),
    "other distances": (
        {"toml": MINI + "[display]\ndot_width_mm = 2.5\n"}, "dots 2.5 mm wide"),
    "comparisons": (
        {"toml": COMPARED}, "compared 2 pairs of 2 values of the dot width, 1 to 2 mm"),
}  # fmt: skip


def told(*folders, **options):
    return methods(load_study(folders, **options))


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """Paragraph on a session of four strings by the simulated reader."""
    folder = tmp_path_factory.mktemp("methods") / "s"
    Session(folder).sit()
    return folder, told(folder)


def test_what_was_done_is_told_in_sentences(plain):
    _, text = plain
    assert text.split(". They were shown")[0] == (
        "1 simulated participant read 4 strings of 1 cell each, in 1 session of the protocol mini "
        "(Four characters between delimiters; ours). A simulated reader gave all 4 of the answers. "
        "A simulated hand moved the array in all 4 of the trials"
    )
    assert "All was of one condition: all (texture 0, contrast 1, 4 trials)" in text
    assert "Trials came in 1 block; orders were drawn with seed 1." in text
    assert "There was no practice. There were no breaks." in text
    assert "Nothing was left out of the analysis." in text
    assert text.endswith(f"vbraille {__version__}.")


@pytest.mark.parametrize("change", by_tier([*CHANGES][-3:], [*CHANGES], [*CHANGES]))
def test_a_number_follows_the_record(plain, tmp_path, change):
    how, said = CHANGES[change]
    Session(tmp_path / "s", **how).sit()
    assert said in told(tmp_path / "s")
    assert said not in plain[1]


def test_several_sessions_are_counted_together(plain, tmp_path):
    Session(tmp_path / "t", participant="P2", seed=2).sit()
    Session(tmp_path / "u", participant="P2", seed=3).sit()
    text = told(plain[0], tmp_path / "t", tmp_path / "u")
    assert text.startswith("2 simulated participants read 4 strings of 1 cell each, in 3 sessions")
    assert "gave all 12 of the answers" in text
    assert "drawn with seeds 1, 2, 3" in text
    without = told(plain[0], tmp_path / "t", tmp_path / "u", exclude={"P1": "slept"})
    assert "in 2 sessions of" in without
    assert "Left out of the analysis: participant P1 (slept)." in without


def test_people_practice_repeats_breaks_and_what_is_missing(tmp_path):
    session = Session(tmp_path / "s", PRACTISED)
    sat = session.sit(
        ("read:", "c"), ("read:", "c"), ("read:", "repeat"), ("read:", "c"),
        ("cue: trial 2", "stop"),
    )  # fmt: skip
    text = told(tmp_path / "s")
    (row,) = [row for row in rows(sat.record) if row["answered"]]
    assert text.startswith("1 participant read 1 string of 1 cell, in 1 session of")
    assert "simulated reader" not in text
    assert "Before them came 2 trials of practice." in text
    assert row["attempt"] == 2
    assert "1 trial had to be shown again." in text
    assert "1 planned trial had no answer. 1 session did not come to the end." in text
    assert "1 trial of s (no answer)" in text


def test_protocols_are_told_one_after_the_other(plain, tmp_path):
    Session(tmp_path / "t", COMPARED).sit()
    text = told(plain[0], tmp_path / "t")
    assert text.index("read 4 strings") < text.index("compared 2 pairs")
    assert len(re.findall("Sessions were run with", text)) == 1


def test_tables_alone_tell_nothing_of_what_was_done(tmp_path):
    path = tmp_path / "trials.csv"
    path.write_text("participant,condition,presented,answered\nA,x,ab,ab\n")
    assert told(path) == ""


@heavy  # a whole analysis
def test_a_report_has_the_paragraph(plain):
    folder, text = plain
    assert dict(analyse(folder).about)["Methods"] == text
