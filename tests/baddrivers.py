"""Drivers that do what none may, each in one way, and words that a check must say of it."""

import math

from tests.engine.test_loop import info
from vbraille.engine.clock import RealClock
from vbraille.simulation.hand import Sweep
from vbraille.simulation.simulated import SimulatedDevice

SOON_S, LATER_S = 0.05, 0.2


class Good(SimulatedDevice):
    """A driver that is right; those below are wrong."""

    def __init__(self, wanted=None, clock=None):
        self.clock = clock or RealClock()
        super().__init__(wanted or info(), self.clock.now_ns, hand=Sweep(60.0))
        self.begun_ns = self.clock.now_ns()

    def since_s(self):
        return (self.clock.now_ns() - self.begun_ns) / 1e9

    def wait(self, seconds):
        self.clock.sleep_until_ns(self.clock.now_ns() + round(seconds * 1e9))


class SlowToRead(Good):
    def read(self):
        self.wait(0.0015)
        return super().read()


class SlowToSend(Good):
    def _send(self, frame):
        self.wait(0.0015)
        super()._send(frame)


class BlocksOnce(Good):
    blocked = False

    def read(self):
        if self.since_s() > LATER_S and not self.blocked:
            self.blocked = True
            self.wait(0.15)
        return super().read()


class NotANumber(Good):
    def read(self):
        sample = super().read()
        return sample._replace(x_mm=math.nan) if self.since_s() > SOON_S else sample


class Jumps(Good):
    def read(self):
        sample = super().read()
        away = LATER_S < self.since_s() < 2 * LATER_S
        return sample._replace(x_mm=sample.x_mm + 150.0 * away)


class ClockGoesBack(Good):
    def read(self):
        sample = super().read()
        return sample._replace(time_ns=sample.time_ns - 10**9 * (self.since_s() > LATER_S))


class TurnsWithoutSaying(Good):
    def read(self):
        return super().read()._replace(theta_rad=0.3)


class NoPose(Good):
    def read(self):
        return (0, 0.0)


class FailsToLetGo(Good):
    def _release(self):
        raise OSError("the lock is jammed")


BAD = {
    SlowToRead: "its read takes 1.",
    SlowToSend: "its write takes 1.",
    BlocksOnce: "its read took ",  # 150 ms or more, as busy as the machine is
    NotANumber: "a place that is no number",
    Jumps: "its carriage jumps, once by 1",  # and by what the hand went where the machine stood
    ClockGoesBack: "its clock goes back, once by ",
    TurnsWithoutSaying: "an angle of 0.3 rad, and its Display has no turns=True",
    NoPose: "where it must give a Pose or None",
    FailsToLetGo: "the lock is jammed",
}
