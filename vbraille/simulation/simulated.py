"""A device in memory, whose carriage a simulated hand moves."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING
from urllib.parse import parse_qsl

import numpy as np

from vbraille.devices.base import Device
from vbraille.errors import InputError
from vbraille.pose import Pose
from vbraille.simulation.hand import parse_hand
from vbraille.simulation.recorded import Recorded
from vbraille.simulation.steering import Steering

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.simulation.hand import Hand
    from vbraille.simulation.motion import Motion

NS_PER_S = 1_000_000_000
# How a hand goes to where its next motion begins.
APPROACH_MM_S = 250.0


class SimulatedDevice(Device):
    """A device without hardware; a hand moves its carriage in the time of a clock.

    Its encoder counts, its levels are as coarse as it says, and it rests on
    close, as other devices do.

    Parameters
    ----------
    info
        What it is to be.
    now_ns
        Its clock.
    hand
        What moves its carriage; `move` does, too.
    steering
        Tells the hand what to do, one thing after the other. Without it the hand sets out with
        the first frame, and reads lines as wide as the travel, one after the other.

    Attributes
    ----------
    levels : int64[rows, columns]
        What the actuators were last sent, 0 … info.levels - 1.
    frames : int
        Frames received.
    """

    def __init__(
        self,
        info: Display,
        now_ns: Callable[[], int] = time.monotonic_ns,
        hand: Hand | Recorded | None = None,
        steering: Steering | None = None,
    ) -> None:
        self._info = info
        self._hand = hand
        self._steering = steering
        self._has_set_out = False
        self._ordered = False  # whether something is to be done that is not known to be done yet
        self._now_ns = now_ns
        self.levels = np.zeros((info.rows, info.columns), np.int64)
        self.frames = 0
        self._begun_ns = now_ns()
        home = -info.span_mm
        self._t_s: NDArray[np.float64] = np.zeros(1)
        self._x_mm: NDArray[np.float64] = np.full(1, home)

    @property
    def display(self) -> Display:
        """What the device says of itself."""
        return self._info

    @property
    def hand(self) -> Hand | Recorded | None:
        """What moves its carriage."""
        return self._hand

    def go_by(self, now_ns: Callable[[], int]) -> None:
        """Live by another clock from now on; a motion goes on from where it has come to."""
        self._begun_ns += now_ns() - self._now_ns()
        self._now_ns = now_ns

    @property
    def moving(self) -> bool:
        """Whether the hand is still on its way."""
        return (self._now_ns() - self._begun_ns) / NS_PER_S < self._t_s[-1]

    @property
    def steering(self) -> Steering | None:
        """What tells the hand what to do."""
        return self._steering

    def obey(self) -> None:
        """Have the hand do what it is told to, from now on; `read` does this."""
        steering = self._steering
        if steering is None:
            if self.frames and not self.moving:
                self._read_line(self._info.travel_mm - self._info.span_mm)
            return
        order = steering.take()
        if order is not None:
            self._ordered = True
            self._read_line(order.end_mm)
        if self._ordered and not self.moving:
            self._ordered = False
            steering.answer(self._now_ns())

    def until_done(self, times_ns: NDArray[np.int64]) -> int:
        """How many of these times of its clock come until the hand has done what it was told to.

        The one at which it has is counted. All do if nothing is under way, or it takes longer.
        """
        done = (times_ns - self._begun_ns) / NS_PER_S >= self._t_s[-1]
        if not self._ordered or not done.any():
            return times_ns.size
        return int(done.argmax()) + 1

    def _read_line(self, end_mm: float) -> None:
        """Have the hand read a line; a recorded one sets out with the first, and goes on."""
        if isinstance(self._hand, Recorded):
            if not self._has_set_out:
                self.move(self._hand.motion())
        elif self._hand is not None:
            self.move(self._hand.read_line(-self._info.span_mm, end_mm))
        self._has_set_out = True

    def move(self, motion: Motion) -> None:
        """Move the hand along a motion, from now on; first to where that begins."""
        here = self._hand_mm(self._now_ns())
        approach_s = abs(motion.x_mm[0] - here) / APPROACH_MM_S
        self._begun_ns = self._now_ns()
        if approach_s > 0:
            self._t_s = np.concatenate(([0.0], motion.t_s + approach_s))
            self._x_mm = np.concatenate(([here], motion.x_mm))
        else:
            self._t_s, self._x_mm = motion.t_s, motion.x_mm

    def read(self) -> Pose | None:
        """Pose of the carriage now, to the nearest count of the encoder."""
        self.obey()
        now_ns = self._now_ns()
        info = self._info
        way = min(max(self._hand_mm(now_ns) + info.span_mm, 0.0), info.travel_mm)
        counts = round(way * info.counts_per_mm)
        return Pose(now_ns, counts / info.counts_per_mm - info.span_mm / 2)

    def places_mm(self, times_ns: NDArray[np.int64]) -> NDArray[np.float64]:
        """Where `read` finds the centre at these times, if nothing comes between; float64[n]."""
        # Said twice: for the one place of a `read`, arrays would take several times as long.
        info = self._info
        hand_mm = np.interp((times_ns - self._begun_ns) / NS_PER_S, self._t_s, self._x_mm)
        way = np.clip(hand_mm + info.span_mm, 0.0, info.travel_mm)
        return np.rint(way * info.counts_per_mm) / info.counts_per_mm - info.span_mm / 2

    def _hand_mm(self, now_ns: int) -> float:
        return float(np.interp((now_ns - self._begun_ns) / NS_PER_S, self._t_s, self._x_mm))

    def _send(self, frame: NDArray[np.float64]) -> None:
        np.rint(frame * (self._info.levels - 1), out=self.levels, casting="unsafe")
        self.frames += 1

    def _release(self) -> None:
        """Nothing to let go."""


def open_simulated(address: str, wanted: Display | None) -> SimulatedDevice:
    """Open ``sim:?hand=HAND&seed=N&steering=DESCRIPTOR``: a device as the page wants it.

    Raises
    ------
    InputError
        If the address says anything else, or no device is wanted.
    """
    if wanted is None:
        raise InputError("a simulated device is made for a model; say which, with --model")
    if not address:
        return SimulatedDevice(wanted)
    given = dict(parse_qsl(address.removeprefix("?"), keep_blank_values=True))
    seed = given.pop("seed", "1")
    hand = given.pop("hand", None)
    descriptor = given.pop("steering", None)
    if given or not address.startswith("?") or hand is None or not seed.isdecimal():
        raise InputError(f"there is no device sim:{address}; give sim:?hand=HAND&seed=N, or sim")
    steering = None if descriptor is None else _steering(descriptor)
    return SimulatedDevice(wanted, hand=parse_hand(hand, int(seed)), steering=steering)


def _steering(descriptor: str) -> Steering:
    """What steers the hand, in memory that this process has made or inherited."""
    try:
        return Steering(int(descriptor))
    except (ValueError, OverflowError):
        raise InputError(
            f"nothing can steer a hand by steering={descriptor}; leave it out, for it is what a "
            f"program tells the process that it starts"
        ) from None
