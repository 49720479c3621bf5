"""Trials in which the participant did not feel what the plan says, and engines that die."""

import re

import pytest

from tests.sessions.sittings import MINI, made
from vbraille.engine.batch import BatchEngine
from vbraille.engine.host import HostDiedError
from vbraille.engine.record import Flag
from vbraille.sessions.running import device

KEPT = MINI + "[faults]\nrepeat = false\n"
CAUSES = {
    Flag.SILENT: "silent",
    Flag.STOP: "where its carriage",
    Flag.RESTED: "rest by itself",
    Flag.TURNED: "turned too far",
}


@pytest.fixture
def driven(monkeypatch):
    """Function that has the next session driven by an engine of a kind, polled every 100 ticks."""

    def drive(kind):
        monkeypatch.setattr(device, "BatchEngine", lambda *how: kind(*how, 100))

    return drive


def flagged(flag, first, stop):
    """What makes an engine some ticks of which could not be felt."""

    class Faulty(BatchEngine):
        def watch(self, ticks, display):
            at = (ticks["tick"] >= first) & (ticks["tick"] < stop)
            ticks["flags"][at] |= int(flag | Flag.UNFELT)
            super().watch(ticks, display)

    return Faulty


@pytest.mark.parametrize(("flag", "what"), CAUSES.items())
@pytest.mark.parametrize("repeats", [True, False])
def test_one_tick_that_was_not_felt_marks_its_trial(tmp_path, driven, flag, what, repeats):
    sat = made(tmp_path, MINI if repeats else KEPT)
    driven(flagged(flag, 850, 851))
    sat.sit(answers="simulated", hand="sweep:60")
    (fault,) = sat.of("fault")
    assert fault.trial == 1
    assert fault.data["tick"] == 850
    assert len(sat.of("cue")) == (4 if repeats else 3)
    assert bool(sat.session.trials[0]["faults"]) is not repeats
    assert any(re.search(what, sentence) for sentence in sat.said)


def test_an_engine_that_dies_is_started_again_and_its_trial_shown_again(tmp_path, driven):
    class Dying(BatchEngine):
        deaths = 0

        def poll(self):
            ticks = super().poll()
            if ticks.size and ticks["tick"][-1] > 500 and not Dying.deaths:
                Dying.deaths += 1
                raise HostDiedError("the process that drives the device has ended (exit code 3)")
            return ticks

    sat = made(tmp_path)
    driven(Dying)
    sat.sit(answers="simulated", hand="sweep:60")
    assert sat.of("end")
    assert [event.data.get("why") for event in sat.of("run")] == [None, "fault"]
    assert [event.attempt for event in sat.of("cue") if event.trial == 1] == [1, 2]
    told = {(row["answers_from"], row["moved_by"]) for row in sat.session.trials}
    assert told == {("simulated:0", "simulated:sweep:60")}


def test_no_trial_begins_while_the_device_takes_no_frames(tmp_path, driven):
    driven(flagged(Flag.HELD, 0, 2500))
    sat = made(tmp_path).sit(answers="simulated")
    assert sat.of("cue")[0].t_s >= 2.4


def test_the_array_rests_whatever_ends_the_session(tmp_path, driven):
    rested = []

    class Watched(BatchEngine):
        def close(self):
            rested.append(self.paused)
            super().close()

    def answer(_trial):
        raise KeyboardInterrupt

    sat = made(tmp_path)
    driven(Watched)
    with pytest.raises(KeyboardInterrupt):
        sat.sit(answers=answer)
    assert rested
    assert not sat.of("end")
    sat.sit(answers="simulated")
    assert sat.of("end")
