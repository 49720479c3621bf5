"""Where answers come from: files, and the simulated reader as a proof of the whole chain."""

import numpy as np
import pytest

from tests.sessions.sittings import MINI, Session, of
from tests.tiers import by_tier, heavy
from vbraille.errors import InputError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import builtin_text, parse_protocol
from vbraille.sessions.running.reader import Simulated
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
        reader = Simulated(protocol, plan, noise=3.0)
        frames = np.full((500, 1, 12), 0.5, np.float32)
        frames[:, :, ::2] = 0.0
        felt = [FeltFrames(frames, np.linspace(-8, 45, 500), np.arange(500) / 100)]
        read.append(tuple(reader.next(plan.trials[0], n, felt)[0] for n in range(1, 20)))
    assert len(set(read)) == 4


def test_a_repeated_trial_has_noise_of_its_own(tmp_path):
    protocol = parse_protocol(MINI, "test")
    session = Session(tmp_path / "s", hand="sweep:150")
    session.sit(("cue", "stop"))
    reader = Simulated(protocol, session.plan, noise=3.0)
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


@pytest.mark.parametrize("spec", ["simulated:x", "simulated:-1", "simulated:nan", "simulated:1e9"])
def test_a_noise_that_is_none_is_one_sentence(spec):
    protocol = parse_protocol(MINI, "test")
    plan = make_plan(protocol, "P1", 1)
    with pytest.raises(InputError, match="noise is"):
        parse_responses(spec, protocol, plan)


def test_paper_cannot_be_felt():
    paper = parse_protocol(builtin_text("control"), "test")
    plan = make_plan(paper, "P1", 1)
    with pytest.raises(InputError, match="control is read on paper"):
        parse_responses("simulated", paper, plan)
