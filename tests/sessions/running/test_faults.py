"""Trials in which the participant did not feel what the plan says, for whatever part of them."""

import numpy as np
import pytest

from tests.sessions.sittings import COMPARED, MINI, Session, of
from vbraille.engine.batch import BatchEngine
from vbraille.engine.clock import ManualClock
from vbraille.engine.loop import LocalEngine
from vbraille.engine.record import Flag
from vbraille.simulation.simulated import SimulatedDevice

KEPT = MINI + "[faults]\nrepeat = false\n"
CAUSES = {
    Flag.SILENT: "the device is silent",
    Flag.MARK: "the device does not know where its carriage is",
    Flag.STOP: "the device does not know where its carriage is",
    Flag.RESTED: "the array went to rest by itself",
    Flag.HELD: "the array went to rest by itself",
    Flag.TURNED: "the array was turned too far",
}


def flagged(flag, *spans):
    """An engine some ticks of which have a flag: from each first tick, up to each last."""

    class Flagged(BatchEngine):
        def poll(self):
            ticks = super().poll()
            for first, stop in spans:
                ticks["flags"][(ticks["tick"] >= first) & (ticks["tick"] < stop)] |= int(flag)
            return ticks

    return Flagged


@pytest.mark.parametrize(("flag", "what"), CAUSES.items())
@pytest.mark.parametrize("repeats", [True, False])
def test_one_tick_within_a_poll_marks_its_trial(tmp_path, flag, what, repeats):
    # A poll has the ticks from 800 to 899: neither its first nor its last tick tells.
    sat = Session(tmp_path / "s", MINI if repeats else KEPT, hand="sweep:60").sit(
        engine=flagged(flag, (850, 851))
    )
    assert sat.progress.ended
    assert [told.faults for told in sat.progress.trials.values()] == [[what], [], [], []]
    attempts = [told.attempts for told in sat.progress.trials.values()]
    assert attempts == ([2, 1, 1, 1] if repeats else [1, 1, 1, 1])
    (fault,) = of(sat.events, "fault")
    assert fault["tick"] == 850
    assert any(line.startswith(f"fault: {what}; trial 1 of 4 ") for line in sat.said)
    wells = of(sat.events, "well")
    assert [well["tick"] for well in wells] == ([] if repeats else [851])


def test_it_is_said_what_a_trial_waits_for_while_the_array_is_turned_too_far(tmp_path):
    sat = Session(tmp_path / "s").sit(engine=flagged(Flag.TURNED, (0, 500)))
    assert sat.progress.ended
    said = [event["what"] for event in of(sat.events, "device")]
    assert [each.partition(":")[0] for each in said] == ["turned", "upright"]
    assert not of(sat.events, "fault")
    assert min(event["tick"] for event in of(sat.events, "contact")) >= 500


@pytest.mark.parametrize("poll_ticks", [7, 100])
@pytest.mark.parametrize(("held", "marked"), [(25, False), (99, False), (120, True)])
def test_a_device_that_wakes_after_the_hand_stood_still_is_no_fault(
    tmp_path, held, marked, poll_ticks
):
    class Waking(BatchEngine):
        def __init__(self, device, **_):
            super().__init__(device, 1000.0, poll_ticks)

        def poll(self):
            ticks = super().poll()
            at, flags = ticks["tick"], ticks["flags"]
            flags[(at >= 800) & (at < 850)] |= int(Flag.RESTING)
            flags[(at >= 850) & (at < 850 + held)] |= int(Flag.HELD)
            return ticks

    sat = Session(tmp_path / "s", hand="sweep:60").sit(engine=Waking)
    faults = [told.faults for told in sat.progress.trials.values()]
    assert faults == [["the array went to rest by itself"] if marked else [], [], [], []]


def test_the_size_of_a_poll_does_not_matter(tmp_path):
    told = []
    for size in (9, 100, 1000):

        class Sized(flagged(Flag.RESTED, (2100, 2101), (2500, 2503), (4000, 4001))):
            def __init__(self, device, size=size, **_):
                super().__init__(device, poll_ticks=size)

        sat = Session(tmp_path / str(size), KEPT, hand="sweep:10").sit(
            ("fault", "note x"), ("fault", "stop"), engine=Sized
        )
        told.append([(e["trial"], e["tick"], e["what"]) for e in of(sat.events, "fault")])
    assert told[0] == told[1] == told[2]
    assert [tick for _, tick, _ in told[0]] == [2100, 4000]


def test_rest_for_want_of_motion_marks_nothing(tmp_path):
    class Still(BatchEngine):
        """A hand that stands still, and an array that therefore rests."""

        def poll(self):
            ticks = super().poll()
            ticks["flags"][(ticks["tick"] >= 820) & (ticks["tick"] < 880)] |= int(Flag.RESTING)
            return ticks

    sat = Session(tmp_path / "s", hand="sweep:60").sit(engine=Still)
    assert not of(sat.events, "fault")


def test_what_happens_while_the_trial_is_paused_is_not_felt_and_marks_nothing(tmp_path):
    class RestedInPauses(BatchEngine):
        def poll(self):
            ticks = super().poll()
            paused = ticks["flags"] & Flag.PAUSED != 0
            ticks["flags"][paused] |= int(Flag.RESTED)
            return ticks

    sat = Session(tmp_path / "s").sit(
        ("cue: trial 1", "pause"), ("pause", ""), ("go", "note x"), ("read", "c"), ("cue", "stop"),
        engine=RestedInPauses,
    )  # fmt: skip
    assert not of(sat.events, "fault")
    assert sat.progress.done == 1


def test_a_device_that_comes_and_goes_is_told_of_once_a_second(tmp_path):
    class Flapping(BatchEngine):
        def poll(self):
            ticks = super().poll()
            ticks["flags"][ticks["tick"] % 7 == 0] |= int(Flag.RESTED)
            return ticks

    sat = Session(tmp_path / "s", KEPT, hand="sweep:20").sit(
        ("read:", "c"), ("read:", "stop"), engine=Flapping
    )
    faults = of(sat.events, "fault")
    for trial in (1, 2):
        times = [fault["t_s"] for fault in faults if fault["trial"] == trial]
        assert len(times) > 1
        assert (np.diff(times) >= 1).all()


def test_no_trial_begins_while_the_device_takes_no_frames(tmp_path):
    sat = Session(tmp_path / "s").sit(engine=flagged(Flag.HELD, (0, 2500)))
    first = of(sat.events, "presented")[0]
    assert first["t_s"] >= 2.4
    assert not of(sat.events, "fault")


def test_both_stimuli_of_a_comparison_are_looked_at(tmp_path):
    session = Session(tmp_path / "s", COMPARED + "[faults]\nrepeat = false\n", hand="sweep:60")
    at = of(session.sit(("read:", "stop")).events, "contact")[1]["tick"] + 5
    other = Session(tmp_path / "t", COMPARED + "[faults]\nrepeat = false\n", hand="sweep:60")
    sat = other.sit(engine=flagged(Flag.RESTED, (at, at + 1)))
    fault = of(sat.events, "fault")[0]
    assert (fault["trial"], fault["stimulus"], fault["tick"]) == (1, 1, at)


def test_ticks_just_before_another_contrast_are_looked_at(tmp_path):
    class Rested(BatchEngine):
        """The array rests just before what is shown is shown otherwise."""

        def show(self, picture, line):
            if line == 2:
                self.after = super().poll()
                self.after["flags"][-1] |= int(Flag.RESTED)
            super().show(picture, line)

        def poll(self):
            late, self.after = getattr(self, "after", None), None
            ticks = super().poll()
            return ticks if late is None else np.concatenate((late, ticks))

    sat = Session(tmp_path / "s", KEPT, hand="sweep:30").sit(
        ("cue", "contrast 0.5"), ("fault", "stop"), engine=Rested
    )
    assert sat.progress.trials[1].faults == ["the array went to rest by itself"]


def test_ticks_that_were_lost_are_not_taken_for_felt(tmp_path):
    class Lossy(BatchEngine):
        def poll(self):
            ticks = super().poll()
            return ticks[(ticks["tick"] < 830) | (ticks["tick"] >= 870)]

    sat = Session(tmp_path / "s", KEPT, hand="sweep:60").sit(engine=Lossy)
    assert [told.faults for told in sat.progress.trials.values()] == [
        ["ticks of it were lost"], [], [], [],
    ]  # fmt: skip


@pytest.mark.parametrize("repeats", [True, False])
def test_what_happened_up_to_the_answer_is_looked_at_before_it_is_taken(tmp_path, repeats):
    class RestsAtLast(BatchEngine):
        """The array rests just before the answer, which has been typed when it is seen."""

        def poll(self):
            ticks = super().poll()
            if typed.script == [("answer: trial 2|no answer", "stop")]:
                ticks["flags"][50] |= int(Flag.RESTED)
            return ticks

    session = Session(tmp_path / "s", MINI if repeats else KEPT, hand="sweep:60")
    typed = session.person(("read:", "c"), ("read:", "l"), ("answer: trial 2|no answer", "stop"))
    sat = session.sit(typed, engine=RestsAtLast)
    answers = of(sat.events, "answer")
    assert sat.progress.trials[2].faults == ["the array went to rest by itself"]
    assert [(e["trial"], e["answer"]) for e in answers] == (
        [(1, "⠉")] if repeats else [(1, "⠉"), (2, "⠁")]
    )
    assert ("no answer is waited for now; help says what there is to type" in sat.said) == repeats


class InMemory(LocalEngine):
    """The loop itself, tick by tick, with a device that goes to rest by itself for 40 ms."""

    def __init__(self, device, poll_ticks):
        clock = ManualClock()
        device.go_by(clock.now_ns)
        super().__init__(device, clock, poll_ticks=poll_ticks)

    def start(self):
        """Nothing: its ticks are the polls."""

    def close(self):
        """Nothing: the one who opened the device closes it."""


@pytest.mark.no_cover
@pytest.mark.parametrize("engine", [InMemory, BatchEngine])
def test_a_device_that_goes_to_rest_by_itself(tmp_path, engine):
    class Rests(engine):
        def poll(self):
            device = self.device
            assert isinstance(device, SimulatedDevice)
            if self.tally.ticks == 800:
                device.rested += 1
            return super().poll()

    sat = Session(tmp_path / "s", hand="sweep:60").sit(engine=Rests)
    assert [told.attempts for told in sat.progress.trials.values()] == [2, 1, 1, 1]
    (fault,) = of(sat.events, "fault")
    assert (fault["tick"], fault["what"]) == (800, "the array went to rest by itself")
