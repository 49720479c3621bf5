"""Sessions whose trials follow from the answers: run, killed, resumed, checked and exported."""

import shutil
from copy import copy
from dataclasses import replace

import numpy as np
import pytest
from msgspec import structs

from tests.sessions.sittings import COMPARED, MINI, Session, crash, kill_often, of
from tests.tiers import by_tier
from vbraille.analysis.input.study import load_study
from vbraille.analysis.measures.discrimination import thresholds
from vbraille.errors import InputError, VbrailleError
from vbraille.sessions.planning.plan import stimulus_to_json
from vbraille.sessions.planning.protocolfiles import load_protocol, parse_protocol
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.folder import check, load
from vbraille.sessions.record.progress import Progress

WIDTHS = COMPARED.replace("[1.0, 2.0]", "[1.0, 3.0]") + (
    'repeats = 3\n[procedure]\nkind = "quest"\nstep = 0.1\nfurthest = 0.8\nspread = [0.1, 0.3]\n'
)
STAIRS = MINI + (
    '[procedure]\nkind = "staircase"\nparameter = "contrast"\nleast = 0.1\nmost = 1.0\n'
    "start = [0.9, 0.3]\nsteps = [0.2, 0.1]\nright = 1\n"
)
KINDS = {"quest": WIDTHS, "staircase": STAIRS}


@pytest.fixture(scope="module", params=KINDS)
def whole(request, tmp_path_factory):
    """A session that was not disturbed, and the sitting that it was run in."""
    session = Session(tmp_path_factory.mktemp("adaptive") / "s", KINDS[request.param])
    return session, session.sit(noise=0.1)


def shown(events):
    """Values, or contrast, of each showing as the journal has it, by trial and attempt."""
    return [
        (e["trial"], e.get("stimulus", 0), e["shown"]["value_mm"], e["shown"]["contrast"])
        for e in of(events, "presented")
        if e["attempt"] == 1
    ]


def test_it_ends_and_says_what_it_found(whole):
    session, sat = whole
    trials = len(session.plan.trials)
    end = next(n for n, line in enumerate(sat.said) if line.startswith("end: "))
    assert sat.said[end] == f"end: all trials are done; {trials} have answers"
    first, second = sat.said[end + 1 : end + 3]
    if session.protocol.task == "choice":
        assert first.startswith("preferred dot width: ")
        assert second.startswith("95 % interval: ")
        assert 1 < float(first.split()[3]) < 3
    else:
        assert first.startswith("threshold contrast: ")
    assert len({told[2:] for told in shown(sat.events)}) > 2


def test_killed_between_any_two_events_it_asks_the_same(whole, tmp_path):
    session, sat = whole
    path = sat.record.folder / "journal.jsonl"
    lines = path.read_bytes().splitlines(keepends=True)
    kinds = [event.kind for event in sat.events]
    for count in range(2, kinds.index("end") + 1, by_tier(7, 1, 1)):
        again = copy(session)
        again.folder = shutil.copytree(sat.record.folder, tmp_path / f"{count}")
        crash(again.folder, sum(map(len, lines[:count])))
        # The hand, and so the noise of an answer, depends on the attempt: the answers are kept.
        resumed = again.sit(noise=0.1)
        before = shown(sat.events[:count])
        assert shown(resumed.events)[: len(before)] == before
        assert all(finding.good for finding in check(resumed.record)), count
        assert resumed.progress.ended


def test_each_beginning_asks_what_came_next(whole):
    session, sat = whole
    trials = {t.number: told.trial for t, told in
              ((told.trial, told) for told in sat.progress.trials.values())}  # fmt: skip
    for count in range(len(sat.events)):
        progress = Progress(session.plan, sat.events[:count], load(session.folder).procedure)
        if progress.next_trial is not None:
            assert progress.next_trial == trials[progress.next_trial.number]


def test_it_is_exported_as_it_was_shown(whole):
    session, sat = whole
    table = rows(sat.record)
    assert len(table) == len(session.plan.trials)
    for row, trial in zip(table, sat.progress.trials.values(), strict=True):
        if session.protocol.task == "choice":
            values = " ".join(f"{s.value:g}" for s in trial.trial.stimuli)
            assert (row["presented"], row["parameter"]) == (values, "dot_width_mm")
            assert row["dot_width_mm"] == values
            assert row["answered"] in values.split()
        else:
            assert row["contrast"] == trial.trial.stimuli[0].tuning.contrast


def test_check_sees_a_trial_that_the_procedure_would_not_have_shown(whole):
    session, sat = whole
    found = [finding for finding in check(sat.record) if "procedure: " in finding.text]
    trials = len(session.plan.trials)
    says = f"procedure: {trials} trials compared with what the answers before them ask for"
    assert [(finding.text, finding.good) for finding in found] == [(says, True)]
    places = [n for n, event in enumerate(sat.events) if event.kind == "presented"]
    at = next(n for n in places if sat.events[n].trial == 3)
    last = sat.record.procedure.next([])  # the first trial's is not what is asked in the third
    events = list(sat.events)
    events[at] = structs.replace(events[at], shown=stimulus_to_json(last.stimuli[0]))
    record = replace(sat.record, journal=replace(sat.record.journal, events=events))
    bad = [finding.text for finding in check(record) if not finding.good]
    what = "was shown with other values than the answers before it ask for"
    assert f"procedure: trial 3 {what}" in bad


def test_values_that_no_question_has_are_damage(tmp_path):
    session = Session(tmp_path / "s", WIDTHS)
    sat = session.sit()
    at = next(n for n, event in enumerate(sat.events) if event.kind == "presented")
    other = sat.events[at].shown | {"value_mm": 1.2345, "dot_width_mm": 1.2345}
    events = list(sat.events)
    events[at] = structs.replace(events[at], shown=other)
    with pytest.raises(VbrailleError, match=r"^the journal is damaged: it has shown .*1\.23"):
        Progress(session.plan, events, sat.record.procedure)


def test_the_shipped_ones_ask_thirty_questions_in_either_order():
    for name in ("tuning-width", "tuning-spacing"):
        usual, ours = load_protocol(name), load_protocol(f"{name}-adaptive")
        assert (usual.trials, ours.trials) == (90, 30)
        assert ours.parameter == usual.parameter
        assert set(ours.design.values) == {min(usual.design.values), max(usual.design.values)}
        for part in ("display", "trial", "faults", "fields", "practice"):
            assert getattr(usual, part) == getattr(ours, part)


WIDE = COMPARED.replace("[1.0, 2.0]", "[2.05, 3.05]") + "reference = 2.0\nrepeats = {}\n"
DIFFERENCE = (
    '[procedure]\nkind = "quest"\nstep = 0.05\nshape = "weibull"\nspread = [0.8, 1.3, 2.0]\n'
    "trials = {}\n"
)
DOWN = '[procedure]\nkind = "staircase"\nstart = [0.8]\nsteps = [0.2, 0.1, 0.05]\ntrials = {}\n'
MORE, ODD, MATCH = 'kind = "which"\nright = "more"\n', 'kind = "odd"\n', 'kind = "match"\n'
# Form of a trial, the question, repeats for 40 trials, the procedure, and a person who tells the
# right stimulus by what is felt of all, the first of which differs from the others.
FORMS = {
    "pairs": ('form = "pairs"', MORE, 10, DIFFERENCE, lambda felt: felt.argmax(axis=1) == 0),
    "of three": (
        'form = "one"\nintervals = 3', MORE, 7, DOWN, lambda felt: felt.argmax(axis=1) == 0,
    ),
    "odd": (
        'form = "one"\nintervals = 3', ODD, 7, DIFFERENCE,
        lambda felt: abs(felt - np.median(felt, axis=1)[:, None]).argmax(axis=1) == 0,
    ),
    "triangle": (
        'form = "triangle"', ODD, 4, DOWN,
        lambda felt: abs(felt - np.median(felt, axis=1)[:, None]).argmax(axis=1) == 0,
    ),
    "abx": (
        'form = "abx"', MATCH, 5, DIFFERENCE,
        lambda felt: abs(felt[:, 1] - felt[:, 2]) < abs(felt[:, 0] - felt[:, 2]),
    ),
}  # fmt: skip
NOISE, WIDTH = 0.1, 2.0  # of a width felt, as a share of the nominal one, in mm


def form_of(name, trials=40):
    form, question, repeats, procedure, _ = FORMS[name]
    return f"{WIDE.format(repeats)}{form}\n[question]\n{question}{procedure.format(trials)}"


def half_way(name):
    """Difference at which a person who feels widths with noise is right in half beyond guessing."""
    random = np.random.default_rng(1)
    differences = np.linspace(0.05, 1.05, 41)
    number, chance = (2, 2) if name == "pairs" else (3, 2 if name == "abx" else 3)
    noise = NOISE * WIDTH * random.standard_normal((20_000, number))
    place = np.arange(number) == 0
    right = [FORMS[name][-1](noise + d * place).mean() for d in differences]
    return float(np.interp((1 + 1 / chance) / 2, right, differences))


@pytest.mark.parametrize("name", FORMS)
def test_a_difference_from_the_standard_is_chosen_and_its_threshold_found(tmp_path, name):
    session = Session(tmp_path / "s", form_of(name))
    assert session.protocol.geometry.dot_width_mm == WIDTH
    sat = session.sit(noise=NOISE)
    assert sat.progress.ended
    shown = [sorted({s.value for s in told.trial.stimuli})
             for told in sat.progress.trials.values()]  # fmt: skip
    assert all(len(values) == 2 and values[0] == 2.0 for values in shown)
    assert len({values[1] for values in shown}) > 3
    (said,) = (line for line in sat.said if line.startswith("threshold difference of dot width:"))
    truth = half_way(name)
    assert truth / 2 < float(said.split()[5]) < 2.5 * truth
    assert all(finding.good for finding in check(sat.record))
    table, _ = thresholds(load_study([session.folder]).judgements)
    (row,) = table.records()
    assert (row["question"], row["trials"]) == (session.protocol.asks.name, 40)
    assert row["guesses"] == pytest.approx(1 / session.protocol.design.alternatives)
    assert row["low"] <= truth <= row["high"]
    assert session.protocol.planned_analysis.measure == "threshold"


@pytest.mark.parametrize("name", by_tier(["of three", "abx"], list(FORMS), list(FORMS)))
def test_killed_and_resumed_it_asks_for_the_same_difference(tmp_path, name):
    session = Session(tmp_path / "s", form_of(name, trials=6))
    session.sit(noise=NOISE)
    kill_often(session, tmp_path / "killed", cuts=3)


SEEN = (
    MINI.replace('after = "c"', 'after = "c"\nrepeats = 10\ncatch = { every = 4 }')
    + '[question]\nkind = "detect"\n[procedure]\nkind = "quest"\nparameter = "contrast"\n'
    "least = 0.05\nmost = 1.0\nstep = 0.05\nspread = [0.05, 0.1, 0.2]\n"
    "guess = [0.02, 0.1, 0.2, 0.3]\ntrials = 24\n"
).replace('characters = ["a", "c", "4", "0"]', 'characters = ["a", "c", "4"]')


def test_yes_and_no_by_the_answers_with_blank_trials_that_choose_nothing(tmp_path):
    session = Session(tmp_path / "s", SEEN)
    sat = session.sit(noise=0.2)
    assert sat.progress.ended
    trials = [told.trial for told in sat.progress.trials.values()]
    blanks = [trial for trial in trials if trial.catch]
    assert len(trials) - len(blanks) == 24
    assert len(blanks) == len(trials) // 4 == session.protocol.trials - 24
    assert all(not any(b.stimuli[0].masks[slice(*b.asked)]) for b in blanks)
    assert len({t.stimuli[0].tuning.contrast for t in trials if not t.catch}) > 3
    (table, _) = thresholds(load_study([session.folder]).judgements)
    (row,) = (r for r in table.records() if r["level"] == "contrast")
    assert (row["trials"], row["blanks"]) == (len(trials), len(blanks))
    (said,) = (line for line in sat.said if line.startswith("95 % interval: "))
    low, high = (float(said.split()[at]) for at in (3, 5))
    # A yes is said beyond one standard deviation of the noise; some are given at nothing. Full
    # contrast is felt as strong as about 1.
    assert low <= 0.22 <= high
    kill_often(session, tmp_path / "killed", cuts=2)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (form_of("pairs").replace("[2.05, 3.05]", "[1.0, 3.05]"), "both sides of reference 2"),
        (form_of("pairs").replace("[2.05, 3.05]", "[3.05]"), "give the one nearest to reference"),
        (form_of("pairs").replace('"pairs"', '"standard"'), "always be the right one"),
        (form_of("pairs").replace('right = "more"\n', ""), "must be 'more' or 'less'"),
        (form_of("of three").replace('"more"', '"less"'), "give 'more'"),
        (form_of("odd").replace("trials =", "guess = [0.1]\ntrials ="), "guess follows from"),
        (form_of("odd").replace("trials =", 'harder = "more"\ntrials ='), "harder is of strings"),
        (form_of("odd").replace("trials =", 'scale = "log"\ntrials ='), "scale is of two values"),
        (form_of("odd").replace("trials =", "least = 0.1\ntrials ="), "are those of [design]"),
        (WIDTHS + '[question]\nkind = "which"\nright = "more"\n', "leave right out"),
        (SEEN.replace("every = 4", 'every = 4, show = "repeat"'), "give show = 'blank'"),
        (
            form_of("pairs").replace(MORE, 'kind = "same-different"\n'),
            "whose answers cannot choose what is shown next",
        ),
    ],
)  # fmt: skip
def test_forms_in_which_nothing_can_be_chosen_are_refused(text, says):
    with pytest.raises(InputError) as refused:
        parse_protocol(text, "page.toml")
    assert says in str(refused.value)
