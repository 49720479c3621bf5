"""Which trial comes next: by the plan, or by the answers, whatever happens to the session."""

import shutil
from dataclasses import replace

import pytest

from tests.sessions.sittings import MINI, Session, crash, of
from vbraille.sessions.planning.planfile import stimulus_to_json
from vbraille.sessions.planning.procedure import Answered, FixedOrder
from vbraille.sessions.planning.stimuli import Trial
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.folder import load
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.replay import frames

PRACTICE = MINI + '[practice]\ntrials = 1\nstrings = ["ca"]\n'
STEP = 0.125
WRONG = {1: "?", 2: "⠉", 3: "?", 4: "?", 5: "⠉"}  # in trials of which it is not the string
COUNT = 5


class Staircase:
    """One up, one down on texture: less of it after a right answer, more after a wrong one."""

    trials = None

    def __init__(self, first: Trial):
        self.first = first

    def next(self, history):
        if len(history) == COUNT:
            return None
        right = sum(past.answer == past.trial.presented for past in history)
        texture = 0.5 + STEP * (len(history) - 2 * right)
        (stimulus,) = self.first.stimuli
        shown = replace(stimulus, tuning=replace(stimulus.tuning, texture=texture))
        return replace(self.first, number=len(history) + 1, stimuli=(shown,))


class Reader:
    """Answers by the number of the trial alone, so that it says the same after a crash."""

    typed = felt = False

    def __init__(self):
        self.said = []

    def lines(self, _wait_s):
        return []

    def next(self, trial, *_):
        return WRONG[trial.number] if not trial.practice else "ca", 0


def session(folder, toml=MINI):
    sitting = Session(folder, toml, hand="sweep:300")
    sitting.procedure = Staircase(sitting.plan.trials[0])
    return sitting


def asked(events):
    """Texture of each trial as the journal has it, by its number; all attempts have the same."""
    textures = {}
    for event in of(events, "presented"):
        if not event.get("practice"):
            textures.setdefault(event["trial"], set()).add(event["shown"]["texture"])
    assert all(len(each) == 1 for each in textures.values()), textures
    return {trial: each.pop() for trial, each in textures.items()}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A session that nobody disturbed, with a trial of practice."""
    sitting = session(tmp_path_factory.mktemp("procedure") / "s", PRACTICE)
    return sitting, sitting.sit(Reader())


def test_a_fixed_order_gives_the_plan_whatever_is_answered(tmp_path):
    trials = Session(tmp_path / "s").plan.trials
    order = FixedOrder(trials)
    for answer in "?⠁":
        history = [Answered(trial, answer) for trial in trials]
        given = [order.next(history[:done]) for done in range(len(trials) + 1)]
        assert given == [*trials, None]


def test_a_staircase_goes_by_the_answers_and_ends_when_it_says_so(whole):
    sitting, sat = whole
    (first,) = sitting.plan.trials[0].stimuli
    right = [answer == sitting.plan.trials[0].presented for answer in WRONG.values()]
    steps = [0.5 + STEP * (n - 2 * sum(right[:n])) for n in range(COUNT)]
    assert [asked(sat.events)[n] for n in range(1, COUNT + 1)] == steps
    assert len(set(steps)) > 1
    assert stimulus_to_json(first).keys() == of(sat.events, "presented")[0]["shown"].keys()
    assert "ready: trial 3" in sat.said
    assert f"end: all trials are done; {COUNT} have answers" in sat.said
    assert (sat.progress.done, sat.progress.planned, sat.progress.ended) == (COUNT, None, True)


def test_every_beginning_of_it_asks_for_the_trial_that_came_next(whole):
    sitting, sat = whole
    textures = asked(sat.events)
    for count in range(len(sat.events) + 1):
        progress = Progress(sitting.plan, sat.events[:count], sitting.procedure)
        trial = progress.next_trial
        if trial is None:
            assert progress.done == COUNT
        elif not trial.practice:
            assert trial.number == progress.done + 1
            assert trial.stimuli[0].tuning.texture == textures[trial.number]


def test_killed_between_any_two_events_it_goes_on_with_the_same_questions(whole, tmp_path):
    sitting, sat = whole
    lines = (sitting.folder / "journal.jsonl").read_bytes().splitlines(keepends=True)
    for count in range(2, len(lines)):
        copy = session(tmp_path / "new", PRACTICE)
        shutil.rmtree(copy.folder)
        copy.folder = shutil.copytree(sitting.folder, tmp_path / f"{count}")
        crash(copy.folder, sum(map(len, lines[:count])))
        again = copy.sit(Reader())
        assert again.events[:count] == sat.events[:count]
        assert asked(again.events) == asked(sat.events), count
        assert again.progress.ended


def test_an_answer_that_is_corrected_changes_what_comes_next_unless_that_was_shown(tmp_path):
    right = session(tmp_path / "r").plan.trials[0].presented
    for n, (said, first) in enumerate((("answer: trial 1", 0.375), ("cue: trial 2", 0.625))):
        sitting = session(tmp_path / f"{n}")
        typed = "?" if right == "⠉" else "c"
        sat = sitting.sit(
            ("read:", typed), (said, "undo"), ("undo: trial 1", "1" if right == "⠁" else "0"),
            ("read:", "stop"),
        )  # fmt: skip
        corrected = of(sat.events, "answer")[1]["answer"] == right
        assert asked(sat.events)[2] == (first if corrected else 0.625)


def test_what_was_shown_is_replayed_and_exported_from_the_journal_alone(tmp_path):
    sitting = Session(tmp_path / "s")
    sat = sitting.sit()
    shown = [event["shown"]["cells"] for event in of(sat.events, "presented")]
    assert [row["presented"] for row in rows(sat.record)] == [cells[1:-1] for cells in shown]
    made = [part.tobytes() for _, _, part in frames(sat.record)]
    # Another plan of the same length: nothing of it is shown.
    other = Session(tmp_path / "t", seed=2).plan
    assert other.trials != sitting.plan.trials
    record = replace(load(sitting.folder), plan=other)
    assert [part.tobytes() for _, _, part in frames(record)] == made
    assert [row["presented"] for row in rows(record)] == [cells[1:-1] for cells in shown]
