"""Which trial comes next: by the plan, or by the answers, whatever happens to the session."""

import shutil
from copy import copy
from dataclasses import dataclass, replace

import pytest
from msgspec import structs

from tests.sessions.sittings import MINI, Person, Played, Session, crash, of
from vbraille.devices import open_device
from vbraille.engine.batch import BatchEngine
from vbraille.sessions.planning.nexttrial import Answered, FixedOrder
from vbraille.sessions.planning.plan import stimulus_to_json
from vbraille.sessions.planning.stimuli import Stimuli, Trial
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.folder import Record, load
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.replay import frames
from vbraille.sessions.running.apparatus import Apparatus
from vbraille.simulation.specs import device_spec, steering_of

PRACTICE = MINI + '[practice]\ntrials = 1\nstrings = ["ca"]\n'
STEP = 0.125
WRONG = {1: "?", 2: "⠉", 3: "?", 4: "?", 5: "⠉"}  # in trials of which it is not the string
COUNT = 5
TYPED = {"⠁": "a", "⠉": "c", "⠈": "4", "⠀": "0"}


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
        return structs.replace(self.first, number=len(history) + 1, stimuli=Stimuli((shown,)))

    def found(self, history):
        return (f"answers: {len(history)}",)


class Reader:
    """Answers by the number of the trial alone, so that it says the same after a crash."""

    name = "right or wrong"
    typed = felt = False

    def lines(self, _wait_s):
        return []

    last = 0

    def next(self, trial, *_):
        if self.last == COUNT:
            return None
        self.last = trial.number
        return WRONG[trial.number], 0


@dataclass
class Sat:
    """A session that went by a staircase, after it was run."""

    session: Session
    record: Record
    said: list

    @property
    def events(self):
        return self.record.journal.events

    def progress(self, count=None):
        """How far it is after some of its events."""
        return Progress(self.record.plan, self.events[:count], self.record.procedure)


def staircase(session):
    """Session as it is on the disk, that goes by a staircase."""
    record = load(session.folder)
    return replace(record, procedure=Staircase(record.plan.trials[0]))


def sit(session, answers=None):
    """Run a session by a staircase, as it goes by a plan elsewhere."""
    said, steering = [], steering_of("sim")
    spec = device_spec("sim", "sweep:300", 1, steering)
    engine = BatchEngine(
        open_device(spec, session.protocol.model.on(session.protocol.geometry)), poll_ticks=100
    )
    sitting = Apparatus(
        engine, Reader() if answers is None else answers, steering, sound=Played, real=False,
        say=said.append if answers is None else answers.said.append, warn=said.append,
        before_rest=lambda: None,
    )  # fmt: skip
    try:
        sitting.run(staircase(session), why="test", spec="sim", hand="sweep:300")
    finally:
        engine.close()
    return Sat(session, staircase(session), said)


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
    """A session that was not disturbed; its practice is left out."""
    return sit(Session(tmp_path_factory.mktemp("procedure") / "s", PRACTICE))


def test_a_fixed_order_gives_the_plan_whatever_is_answered(tmp_path):
    trials = Session(tmp_path / "s").plan.trials
    order = FixedOrder(trials)
    for answer in "?⠁":
        history = [Answered(trial, answer) for trial in trials]
        given = [order.next(history[:done]) for done in range(len(trials) + 1)]
        assert given == [*trials, None]


def test_a_staircase_goes_by_the_answers_and_ends_when_it_says_so(whole):
    (shown,) = whole.session.plan.trials[0].stimuli
    right = [answer == whole.session.plan.trials[0].presented for answer in WRONG.values()]
    steps = [0.5 + STEP * (n - 2 * sum(right[:n])) for n in range(COUNT)]
    assert [asked(whole.events)[n] for n in range(1, COUNT + 1)] == steps
    assert len(set(steps)) > 1
    first = of(whole.events, "presented")[0]
    assert first["shown"] == stimulus_to_json(
        replace(shown, tuning=replace(shown.tuning, texture=0.5))
    )
    assert "ready: trial 3" in whole.said
    at = whole.said.index(f"end: all trials are done; {COUNT} have answers")
    assert whole.said[at + 1] == f"answers: {COUNT}"
    progress = whole.progress()
    assert (progress.done, progress.planned, progress.ended) == (COUNT, None, True)


def test_every_beginning_of_it_asks_for_the_trial_that_came_next(whole):
    textures = asked(whole.events)
    for count in range(len(whole.events) + 1):
        progress = whole.progress(count)
        trial = progress.next_trial
        if trial is None:
            assert progress.done == COUNT
        elif not trial.practice:
            assert trial.number == progress.done + 1
            assert trial.stimuli[0].tuning.texture == textures[trial.number]


def test_killed_between_any_two_events_it_goes_on_with_the_same_questions(whole, tmp_path):
    lines = (whole.record.folder / "journal.jsonl").read_bytes().splitlines(keepends=True)
    session = copy(whole.session)
    kinds = [event.kind for event in whole.events]
    for count in range(1, kinds.index("end") + 1):
        session.folder = shutil.copytree(whole.record.folder, tmp_path / f"{count}")
        crash(session.folder, sum(map(len, lines[:count])))
        again = sit(session)
        assert again.events[:count] == whole.events[:count]
        assert asked(again.events) == asked(whole.events), count
        assert again.progress().ended


def test_an_answer_that_is_corrected_changes_what_comes_next_unless_that_was_shown(tmp_path):
    for said, texture in (("answer: trial 1", 0.5 - STEP), ("cue: trial 2", 0.5 + STEP)):
        session = Session(tmp_path / said[:3])
        right = TYPED[session.plan.trials[0].presented]
        sat = sit(session, Person([
            ("read:", "?"), (said, "undo"), ("undo: trial 1", right),
            ("read:|cue: trial 2", "stop"),
        ]))  # fmt: skip
        assert of(sat.events, "answer")[0]["answer"] == "?"
        assert sat.progress().trials[1].answer == session.plan.trials[0].presented
        assert asked(sat.events)[2] == texture


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
