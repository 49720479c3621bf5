"""A device in memory, whose carriage a simulated hand moves."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING
from urllib.parse import parse_qsl

import numpy as np

from vbraille.devices.base import Device
from vbraille.devices.hand import parse_hand
from vbraille.devices.recorded import Recorded
from vbraille.errors import InputError
from vbraille.pose import Pose
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vbraille.devices.hand import Hand
    from vbraille.devices.motion import Motion
    from vbraille.display import Display

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
    ) -> None:
        self._info = info
        self._hand = hand
        self._following = False
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

    def follow(self, end_mm: float) -> None:
        """Have the hand read a new line; a recorded one sets out with the first, and goes on."""
        if isinstance(self._hand, Recorded):
            if not self._following:
                self.move(self._hand.motion())
        elif self._hand is not None:
            self.move(self._hand.read_line(-self._info.span_mm, end_mm))
        self._following = self._hand is not None

    @property
    def followed(self) -> bool:
        """Whether the hand has come to its end."""
        return self._following and not self.moving

    def followed_at(self, times_ns: NDArray[np.int64]) -> NDArray[np.bool_]:
        """What `followed` is at times of its clock, if nothing else comes between; bool[n]."""
        moving = (times_ns - self._begun_ns) / NS_PER_S < self._t_s[-1]
        return ~moving & self._following

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
        now_ns = self._now_ns()
        info = self._info
        way = min(max(self._hand_mm(now_ns) + info.span_mm, 0.0), info.travel_mm)
        counts = round(way * info.counts_per_mm)
        return Pose(now_ns, counts / info.counts_per_mm - info.span_mm)

    def places_mm(self, times_ns: NDArray[np.int64]) -> NDArray[np.float64]:
        """Where `read` finds it at times of its clock if nothing comes between; float64[n]."""
        # Said twice: for the one place of a `read`, arrays would take several times as long.
        info = self._info
        hand_mm = np.interp((times_ns - self._begun_ns) / NS_PER_S, self._t_s, self._x_mm)
        way = np.clip(hand_mm + info.span_mm, 0.0, info.travel_mm)
        return np.rint(way * info.counts_per_mm) / info.counts_per_mm - info.span_mm

    def _hand_mm(self, now_ns: int) -> float:
        return float(np.interp((now_ns - self._begun_ns) / NS_PER_S, self._t_s, self._x_mm))

    def _send(self, frame: NDArray[np.float64]) -> None:
        np.rint(frame * (self._info.levels - 1), out=self.levels, casting="unsafe")
        self.frames += 1

    def _release(self) -> None:
        """Nothing to let go."""


def open_simulated(address: str, wanted: Display | None) -> SimulatedDevice:
    """Open ``sim:?hand=HAND&seed=N``: a device as the page wants it.

    Raises
    ------
    InputError
        If the address says anything else, or no device is wanted.
    """
    if wanted is None:
        raise InputError(
            f"a simulated device is made for a model; say which, with {setting('model')}"
        )
    if not address:
        return SimulatedDevice(wanted)
    given = dict(parse_qsl(address.removeprefix("?"), keep_blank_values=True))
    seed = given.pop("seed", "1")
    hand = given.pop("hand", None)
    if given or not address.startswith("?") or hand is None or not seed.isdecimal():
        raise InputError(f"there is no device sim:{address}; give sim:?hand=HAND&seed=N, or sim")
    return SimulatedDevice(wanted, hand=parse_hand(hand, int(seed)))
