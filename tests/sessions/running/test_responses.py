"""Where answers come from: files, and the simulated reader as a proof of the whole chain."""

from collections import Counter

import numpy as np
import pytest

from tests.sessions.sittings import MINI, Session, of
from tests.tiers import by_tier, heavy
from vbraille.errors import InputError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import builtin_text, load_protocol, parse_protocol
from vbraille.sessions.running.reader import ReaderHabits, Simulated
from vbraille.sessions.running.responses import Scripted
from vbraille.sessions.running.sources import parse_responses
from vbraille.sessions.simulated.skin import FeltFrames

# Coverage would double their time, and others cover what these do.
pytestmark = pytest.mark.no_cover


@pytest.mark.parametrize(
    "name", [pytest.param("legibility", marks=heavy), pytest.param("letters", marks=heavy), "words"]
)
def test_without_noise_every_string_of_every_protocol_is_read_right(tmp_path, name):
    sat = Session(tmp_path / "s", builtin_text(name), hand="sweep:400").sit()
    for trial in sat.record.plan.trials:
        assert sat.progress.trials[trial.number].answer == trial.presented, trial
    assert sat.progress.ended


@pytest.mark.parametrize("name", ["tuning-width", pytest.param("tuning-spacing", marks=heavy)])
def test_without_noise_the_nearer_to_nominal_is_chosen_of_every_pair(tmp_path, name):
    sat = Session(tmp_path / "s", builtin_text(name), hand="sweep:400").sit()
    for trial in sat.record.plan.trials:
        off = [abs(stimulus.value - 2.0) for stimulus in trial.stimuli]
        if abs(off[0] - off[1]) > 0.1:
            nearer = "1" if off[0] < off[1] else "2"
            assert sat.progress.trials[trial.number].answer == nearer, off
    assert sat.progress.ended


def test_with_noise_it_errs_and_the_same_seed_errs_in_the_same_way(tmp_path):
    answers = []
    for n, noise in enumerate((0.4, 0.4, 0.0)):
        session = Session(
            tmp_path / str(n), MINI + f"repeats = {by_tier(5, 10, 100)}\n", hand="sweep:150"
        )
        sat = session.sit(noise=noise)
        answers.append([event["answer"] for event in of(sat.events, "answer")])
        right = [trial.presented for trial in session.plan.trials]
    assert answers[0] == answers[1]
    assert answers[2] == right
    wrong = np.mean([a != b for a, b in zip(answers[0], right, strict=True)])
    assert 0.05 < wrong < 0.9


def test_participants_err_each_in_their_own_way_and_so_do_protocols():
    other = MINI.replace('"mini"', '"maxi"')
    read = []
    for toml, who in ((MINI, "P01"), (MINI, "P02"), (MINI, "p01"), (other, "P01")):
        protocol = parse_protocol(toml, "test")
        plan = make_plan(protocol, who, 1)
        reader = Simulated(protocol, plan, ReaderHabits(3.0))
        frames = np.full((500, 1, 12), 0.5, np.float32)
        frames[:, :, ::2] = 0.0
        felt = [FeltFrames(frames, np.linspace(-8, 45, 500), np.arange(500) / 100)]
        read.append(tuple(reader.next(plan.trials[0], n, felt)[0] for n in range(1, 20)))
    assert len(set(read)) == 4


def test_a_repeated_trial_has_noise_of_its_own(tmp_path):
    protocol = parse_protocol(MINI, "test")
    session = Session(tmp_path / "s", hand="sweep:150")
    session.sit(("cue", "stop"))
    reader = Simulated(protocol, session.plan, ReaderHabits(3.0))
    frames = np.full((500, 1, 12), 0.5, np.float32)
    frames[:, :, ::2] = 0.0
    felt = [FeltFrames(frames, np.linspace(-8, 45, 500), np.arange(500) / 100)]
    trial = session.plan.trials[0]
    answers = [reader.next(trial, attempt, felt)[0] for attempt in range(1, 20)]
    assert len(set(answers)) > 1
    assert answers == [reader.next(trial, attempt, felt)[0] for attempt in range(1, 20)]


def test_a_file_gives_its_lines_in_order_without_comments(tmp_path):
    path = tmp_path / "answers"
    path.write_text("# of P07\nab\n\n  cd \nundo\n", "utf-8-sig")
    script = Scripted(path)
    assert [script.next(None, 1, []) for _ in range(4)] == [("ab", 2), ("cd", 4), ("undo", 5), None]
    assert Scripted(path, after=2).left == [("cd", 4), ("undo", 5)]


@pytest.mark.parametrize(
    ("spec", "said"),
    [
        ("simulated:x", "'x' is no habit"),
        ("simulated:0.2,naps=0.1", "'naps=0.1' is no habit"),
        ("simulated:-1", "noise is -1"),
        ("simulated:nan", "noise is nan"),
        ("simulated:1e9", "noise is 1e"),
        ("simulated:lapses=1.1", "lapses are 1.1; it must be 0 to 1"),
        ("simulated:0.2,false-alarms=0.1", "false alarms are of the questions"),
    ],
)
def test_a_habit_that_is_none_is_one_sentence(spec, said):
    protocol = parse_protocol(MINI, "test")
    plan = make_plan(protocol, "P1", 1)
    with pytest.raises(InputError, match=said):
        parse_responses(spec, protocol, plan)


def test_habits_are_named_by_the_source_of_answers():
    for spec in ("simulated:0.4", "simulated:0.2,lapses=0.05,false-alarms=0.1"):
        assert ReaderHabits.parse(spec.removeprefix("simulated:")).spec == spec
    assert ReaderHabits.parse("lapses=0.1") == ReaderHabits(0.0, 0.1)


def answers_of(name, habits, attempts, swing=0.0):
    """Answers of a simulated reader to each trial of a protocol, without how sure they are."""
    protocol = load_protocol(name)
    plan = make_plan(protocol, "P01", 1)
    reader = Simulated(protocol, plan, habits)
    frames = np.zeros((500, *protocol.model.display.shape), np.float32)
    frames[:, :, ::2] = swing
    felt = FeltFrames(frames, np.linspace(-8, 45, 500), np.arange(500) / 100)
    for trial in plan.trials:
        for attempt in range(1, attempts + 1):
            yield reader.next(trial, attempt, [felt] * len(trial.stimuli))[0].partition(";")[0]


@pytest.mark.parametrize(
    ("name", "answers"),
    [
        ("detection", {"yes", "no"}),
        ("same-different", {"same", "different"}),
        ("tuning-width", {"1", "2"}),
        ("rating", {str(n) for n in range(1, 8)}),
        ("letters", {"?"}),
    ],
)
def test_a_lapse_is_answered_by_chance_alone(name, answers):
    told = list(answers_of(name, ReaderHabits(0.0, 1.0), 4))
    often = Counter(each[0] for each in told) if name == "letters" else Counter(told)
    assert set(often) == answers
    expected = len(told) / len(answers)
    assert all(abs(many - expected) < 5 * expected**0.5 for many in often.values())


def test_false_alarms_are_as_many_as_were_given():
    felt_nothing = list(answers_of("detection", ReaderHabits(0.0, 0.0, 0.25), 10))
    assert felt_nothing.count("yes") / len(felt_nothing) == pytest.approx(0.25, abs=0.08)
    assert set(answers_of("detection", ReaderHabits(0.0), 1)) == {"no"}


def test_a_share_of_trials_lapses_and_all_else_is_as_without():
    with_lapses = list(answers_of("rating", ReaderHabits(0.3, 0.2), 4, swing=0.5))
    without = list(answers_of("rating", ReaderHabits(0.3), 4, swing=0.5))
    changed = np.mean([one != other for one, other in zip(with_lapses, without, strict=True)])
    assert 0.1 < changed < 0.3


def test_a_sure_answer_would_be_given_again():
    protocol = parse_protocol(
        MINI + '[question]\nkind = "identify"\n[question.confidence]\nleast = 1\nmost = 5\n',
        "test",
    )
    plan = make_plan(protocol, "P1", 1)
    frames = np.full((500, 1, 12), 0.5, np.float32)
    frames[:, :, ::2] = 0.0
    felt = [FeltFrames(frames, np.linspace(-8, 45, 500), np.arange(500) / 100)]
    sure = {}
    for name, habits in (
        ("still", ReaderHabits()), ("loud", ReaderHabits(3.0)), ("absent", ReaderHabits(0.0, 1.0)),
    ):  # fmt: skip
        reader = Simulated(protocol, plan, habits)
        told = [reader.next(plan.trials[0], n, felt)[0] for n in range(1, 20)]
        sure[name] = {line.partition("; ")[2] for line in told}
    assert sure == {"still": {"4"}, "loud": {"2", "4"}, "absent": {"1"}}


def test_paper_cannot_be_felt():
    paper = parse_protocol(builtin_text("control"), "test")
    plan = make_plan(paper, "P1", 1)
    with pytest.raises(InputError, match="control is read on paper"):
        parse_responses("simulated", paper, plan)
