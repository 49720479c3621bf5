"""How far a session is, from its events alone."""

import pytest

from tests.sessions.sittings import COMPARED, MINI, Session
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record import events
from vbraille.sessions.record.progress import Progress

PLAN = make_plan(parse_protocol(MINI, "test"), "P1", 1)


def told(*happened, plan=PLAN):
    """Progress after events, a second apart."""
    return Progress(
        plan,
        [kind(t_s=float(n), wall=f"at {n}", **more) for n, (kind, more) in enumerate(happened)],
    )


RUN = (events.Run, {"why": "start", "trace": "trace-001.gz"})


def shown(trial, attempt=1, line=1, stimulus=0, **more):
    return events.Presented, {
        "trial": trial, "attempt": attempt, "stimulus": stimulus, "line": line, "shown": {},
        **more,
    }  # fmt: skip


def answered(trial, answer="⠁", **more):
    return events.Answer, {"trial": trial, "attempt": 1, "answer": answer, **more}


def test_nothing_has_happened_before_the_first_event():
    progress = told()
    assert (progress.done, progress.ended, progress.line, progress.runs) == (0, False, 0, [])
    assert progress.next_trial is PLAN.trials[0]
    assert progress.last_answered is None


def test_answers_go_from_trial_to_trial_until_there_is_none():
    happened = [RUN]
    for trial in PLAN.trials:
        happened += [shown(trial.number, line=trial.number), answered(trial.number)]
        progress = told(*happened)
        assert progress.done == trial.number
        assert progress.last_answered is trial
    assert progress.next_trial is None
    assert progress.line == len(PLAN.trials)
    assert not progress.ended
    assert told(*happened, (events.End, {"why": "all trials are done"})).ended


def test_an_attempt_that_was_not_answered_is_the_next_trial_again():
    cue = (events.Cue, {"trial": 1})
    progress = told(
        RUN, shown(1), cue, (events.Warning, {"trial": 1}),
        (events.Run, {"why": "resume", "trace": "trace-002.gz"}), shown(1, 2, 2), cue,
    )  # fmt: skip
    trial = progress.trials[1]
    assert progress.next_trial is PLAN.trials[0]
    assert (trial.attempts, len(trial.showings)) == (2, 2)
    assert [s.line for s in trial.last_attempt] == [2]
    assert trial.trace == "trace-002.gz"
    assert trial.t_s == {"presented": 5.0, "cue": 6.0}  # the warning was of the first


def test_an_undo_keeps_both_answers_and_the_times_of_both():
    taken_back = [RUN, shown(1), answered(1, "⠁"), shown(2, line=2), (events.Undo, {"trial": 1})]
    progress = told(*taken_back)
    assert progress.correcting is PLAN.trials[0]
    assert (progress.trials[1].answer, progress.trials[1].first_answer) == (None, "⠁")
    assert progress.done == 1
    progress = told(*taken_back, answered(1, "⠉", corrects=True))
    assert progress.correcting is None
    assert (progress.trials[1].answer, progress.trials[1].first_answer) == ("⠉", "⠁")
    assert (progress.trials[1].t_s["answer"], progress.trials[1].t_s["corrected"]) == (2.0, 5.0)
    assert progress.done == 1
    assert progress.next_trial is PLAN.trials[1]


def test_pauses_of_a_trial_are_added_up_and_end_with_their_run():
    pause, go = (events.Pause, {"trial": 1}), (events.Go, {"trial": 1})
    progress = told(RUN, shown(1), pause, go, (events.Note, {"text": "x"}), pause, go)
    assert progress.trials[1].paused_s == 2.0
    progress = told(RUN, shown(1), pause, RUN, shown(1, 2, 2), go)
    assert progress.trials[1].paused_s == 0.0


def test_what_the_experimenter_sets_is_of_the_trials_that_follow():
    tuned = (events.Tuning, {"trial": 1, "tuning": {"texture": 0.5}, "line": 2})
    progress = told(RUN, shown(1), tuned)
    assert progress.trials[1].tuning == progress.tuning == {"texture": 0.5}
    assert [s.line for s in progress.trials[1].last_attempt] == [1, 2]
    assert progress.line == 2


def test_faults_are_of_the_trial_that_was_open():
    fault = (events.Fault, {"trial": 1, "attempt": 1, "what": "silent"})
    progress = told(RUN, shown(1), fault)
    assert progress.trials[1].faults == ["silent"]


def test_practice_counts_on_its_own_and_ends_when_it_is_over():
    plan = make_plan(
        parse_protocol(MINI + '[practice]\ntrials = 2\nstrings = ["aa"]\n', "test"), "P1", 1
    )
    practised = [RUN, shown(1, practice=True), answered(1, practice=True)]
    progress = told(*practised, plan=plan)
    assert (progress.done, progress.begun) == (0, False)
    assert progress.next_trial is plan.practice[1]
    for ended in ([(events.Begin, {})], [shown(1, line=2)]):
        progress = told(*practised, *ended, plan=plan)
        assert progress.begun
        assert progress.next_trial is plan.trials[0]


@pytest.mark.parametrize("toml", [MINI, COMPARED])
def test_every_beginning_of_a_session_is_a_state_to_go_on_from(tmp_path, toml):
    session = Session(tmp_path / "s", toml)
    happened = session.sit().events
    done = []
    for count in range(len(happened) + 1):
        progress = Progress(session.plan, happened[:count])
        done.append(progress.done)
        answers = sum(event.kind == "answer" for event in happened[:count])
        assert progress.done == answers
        assert (progress.next_trial is None) == (answers == len(session.plan.trials))
    assert done == sorted(done)
