"""Sessions whose trials follow from the answers: run, killed, resumed, checked and exported."""

import shutil
from copy import copy
from dataclasses import replace

import pytest
from msgspec import structs

from tests.sessions.sittings import COMPARED, MINI, Session, crash, of
from tests.tiers import by_tier
from vbraille.errors import VbrailleError
from vbraille.sessions.planning.plan import stimulus_to_json
from vbraille.sessions.planning.protocolfiles import load_protocol
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
    """A session that nobody disturbed, and the sitting that it was run in."""
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
