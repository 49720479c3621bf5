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

DETECTING = MINI + '[question]\nkind = "detect"\nask = "Anything?"\n'
STAIRS = """
[procedure]
kind = "staircase"
parameter = "contrast"
least = 0.1
most = 1.0
start = [0.9, 0.5]
steps = [0.2, 0.1]
right = 2
reversals = 3
trials = 4
"""
FACTORS = (
    '[[factors]]\nname = "t"\nlevels = [{ name = "a", texture = 0.0 }, '
    '{ name = "b", texture = 1.0 }]\n'
    '[[factors]]\nname = "w"\nlevels = [{ name = "c", dot_width_mm = 1.0 }, '
    '{ name = "d", dot_width_mm = 1.5 }]\n'
    '[[factors]]\nname = "g"\nbetween = true\nlevels = [{ name = "near", cell_gap_mm = 6.0 }, '
    '{ name = "far", cell_gap_mm = 7.0 }]\n'
)
CROSSED = 'cross = [["a", "c"], ["a", "d"], ["b", "c"]]\n'
# What a paragraph says of each kind of question, design and procedure.
KINDS = {
    "which": (
        COMPARED + '[question]\nkind = "which"\nright = "more"\n',
        ["Of each pair one was chosen; the one with more dot width was right."],
    ),
    "nearest": (
        COMPARED + '[question]\nkind = "which"\nright = "nearest"\nreference = 1.5\n',
        ["chosen; the one nearest to 1.5 mm was right."],
    ),
    "same": (
        COMPARED.replace("string", "same = 1\nstring") + '[question]\nkind = "same-different"\n',
        [
            "compared 4 pairs of 2 values of the dot width, 1 to 2 mm",
            "whether the two were the same or different; 2 of 4 pairs differed.",
            "condition: all (texture 0, contrast 1, 4 trials)",
        ],
    ),
    "detect": (
        DETECTING + 'confidence = { least = 1, most = 4 }\n',
        [
            "felt 4 strings of 1 cell each",
            "They were asked: “Anything?”.",
            "there was something in 3 of 4 trials.",
            "After all 4 answers they said how sure they were, from 1 to 4.",
        ],
    ),
    "rating": (
        MINI + '[question]\nkind = "rating"\nscale = "roughness"\nleast = 1\nmost = 7\n'
        'labels = ["smooth", "rough"]\n',
        ["They rated roughness in whole numbers, from 1 (smooth) to 7 (rough)."],
    ),
    "magnitude": (
        MINI + '[question]\nkind = "magnitude"\nmodulus = 10\n',
        ["estimated a magnitude, as a number above 0; the standard was 10."],
    ),
    "stairs": (
        DETECTING + STAIRS,
        [
            "by 2 interleaved staircases, which began at 0.9, 0.5 with steps of 0.2, then 0.1, "
            "within 0.1 to 1.",
            "made harder after 2 “yes” answers running, and easier after 1 “no” answer.",
            "A condition was to end by 4 trials, or by 3 reversals of each staircase.",
        ],
    ),
    "quest": (
        COMPARED.replace("2.0]", "2.0]\nrepeats = 3")
        + '[procedure]\nkind = "quest"\nstep = 0.25\nspread = [0.3]\nwidth = 0.5\ntrials = 3\n'
        "at_least = 2\n",
        [
            "The dot width of each trial was chosen by the answers before it, by QUEST+ (Watson "
            "2017) from 5 values, 1 to 2 mm.",
            "end by 3 trials, or by an interval of 95 % that was 0.5 mm wide (after 2 trials or "
            "more).",
        ],
    ),
    "catch": (
        MINI.replace("length", "catch = { every = 3 }\nlength"),
        [
            "read 4 strings of 1 cell each",
            "Beside these there were 2 catch trials that showed no dots; all 2 were answered "
            "right.",
            "All was of one condition: all (texture 0, contrast 1, 4 trials)",
        ],
    ),
    "factors": (
        CROSSED + MINI + FACTORS,
        [
            "Participants were in 1 group: near (1 participant).",
            "Within participants varied t (a, b) and w (c, d), 3 of the 4 combinations of them.",
            "a-d (texture 0, contrast 1, dot width 1.5 mm, 4 trials)",
            "Each condition had blocks of its own, 3 blocks in a session, balanced by Williams "
            "squares (of 6 orders: 1)",
        ],
    ),
    "order": (
        CONDITIONS.replace("length", 'order = "listed"\nlength')
        + "[rules]\nnever_twice_running = true\nat_most_running = { condition = 4 }\n",
        [
            "2 blocks in a session, always in the same order;",
            "No two neighbouring trials showed the same; at most 4 neighbouring trials had the "
            "same condition.",
        ],
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", by_tier(["catch"], [*KINDS], [*KINDS]))
def test_each_kind_is_told(tmp_path, kind):
    toml, said = KINDS[kind]
    Session(tmp_path / "s", toml).sit()
    text = told(tmp_path / "s")
    for sentence in said:
        assert sentence in text


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
    assert "6.48 mm from a cell's last dot column to the next cell's first" in text
    assert "There was no practice. There were no breaks." in text
    assert "Nothing was left out of the analysis." in text
    assert text.endswith(f"vbraille {__version__}.")


@pytest.mark.parametrize("change", by_tier([*CHANGES][-1:], [*CHANGES], [*CHANGES]))
def test_a_number_follows_the_record(plain, tmp_path, change):
    how, said = CHANGES[change]
    Session(tmp_path / "s", **how).sit()
    assert said in told(tmp_path / "s")
    assert said not in plain[1]


def test_one_trial_is_not_all_of_them(tmp_path):
    one = MINI.replace('["a", "c", "4", "0"]', '["a"]')
    Session(tmp_path / "s", one).sit()
    text = told(tmp_path / "s")
    assert "A simulated reader gave the only answer. " in text
    assert "A simulated hand moved the array in the only trial. " in text
    assert "ll 1 " not in text


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


def test_limits_of_trials_and_what_came_late_are_told(tmp_path):
    limits = "[trial]\nexposure_s = 0.3\nanswer_s = 0.3\n"
    Session(tmp_path / "s", MINI + limits, hand="sweep:60").sit(
        ("ended: .* by exposure", "c"), ("answer: trial 1", "note in between"),
        ("late: trial 2", "c"), ("answer: trial 2", "stop"),
    )  # fmt: skip
    text = told(tmp_path / "s")
    assert "felt for 0.3 s from the start signal, which were over before the answer in all 2 t" in (
        text
    )
    assert (
        "Answers were to come within 0.3 s of the end of the exposure; 1 of 2 answers came later "
        "(late answers were kept)." in text
    )
    Session(tmp_path / "t", MINI + limits + 'late = "missed"\n', hand="sweep:60").sit(
        ("missed: trial 1", "note slow"), ("ended: .* by exposure", "c"), ("answer: tr", "stop")
    )
    assert "without one the trial then ended, as in 1 of 2 trials." in told(tmp_path / "t")


def test_a_questionnaire_and_a_participant_who_stopped_are_told(tmp_path):
    toml = MINI + (
        '[[questionnaire]]\nkind = "text"\nname = "age"\nwhen = "begin"\nask = "How old?"\n'
        '[[questionnaire]]\nkind = "text"\nname = "so"\nwhen = "trial"\nask = "How so?"\n'
        '[[questionnaire]]\nkind = "text"\nname = "end"\nwhen = "end"\nask = "And now?"\n'
    )
    Session(tmp_path / "s", toml).sit(
        ("asked: How old", "30"), ("^read:", "c"), ("asked: How so", "well"), ("^read:", "c"),
        ("asked: How so", "ill"), ("cue: trial 3", "quit feels ill"),
    )  # fmt: skip
    text = told(tmp_path / "s")
    assert (
        "A questionnaire asked “How old?” at the beginning (1 answer), and “How so?” after the "
        "answer to a trial (2 answers)." in text
    )
    assert "1 participant stopped for good, before all trials were done." in text
    assert "feels ill" not in text


@heavy  # three sessions
def test_groups_are_told_with_what_they_differ_in(tmp_path):
    for who in ("P01", "P02", "P04"):
        Session(tmp_path / who, CROSSED + MINI + FACTORS, participant=who).sit()
    text = told(*(tmp_path / who for who in ("P01", "P02", "P04")))
    assert (
        "Participants were in 2 groups: far (2 participants, cell gap 7 mm), near (1 participant, "
        "cell gap 6 mm)." in text
    )
    assert "from a cell's last dot column" not in text


def test_the_participants_key_practice_and_what_is_compared(tmp_path):
    toml = COMPARED.replace("dot_width_mm", "texture").replace("2.0", "0.5")
    toml += '[trial]\nend = "key:enter"\n[practice]\ntrials = 1\nvalues = [0.1, 0.2]\n'
    toml += "feedback = false\n"
    Session(tmp_path / "s", toml).sit(
        ("cue: practice", ""), ("cue: .*second", ""), ("ended: .* s", "1"),
        ("cue: trial 1 of 2$", ""), ("cue: .*second", ""), ("ended: .* s", "1"),
        ("cue: trial 2 of 2$", ""), ("cue: .*second", "2"), ("no answer", "2"), ("last", ""),
    )  # fmt: skip
    text = told(tmp_path / "s")
    assert "compared 2 pairs of 2 values of the texture, 0.5 to 1, in" in text
    assert "Of each pair one was chosen, and neither was right or wrong." in text
    assert "ended by key enter in 1 of 2 trials, by their answer in 1 of 2 trials" in text
    assert "Before them came 1 trial of practice, without feedback." in text


def test_a_reference_that_nobody_had_beside_is_not_told(tmp_path):
    Session(tmp_path / "s", COMPARED + '[conventional]\nreference = "a"\n').sit()
    assert "conventional" not in told(tmp_path / "s")


def test_words_are_told_to_be_scored_by_nobody(tmp_path):
    session = Session(tmp_path / "s", MINI + '[question]\nkind = "free"\n')
    session.sit(*[("read:", "sand")] * 4, ("last", ""))
    assert "They answered in words of their own, which were not scored." in told(tmp_path / "s")


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
