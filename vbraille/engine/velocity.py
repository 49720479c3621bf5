"""How fast the hand moves, smoothly: Lévesque 2009, 9.4.1."""

from __future__ import annotations

DIFFERENCE = 10  # samples, N
MEAN = 50  # velocities, M
_NS_PER_S = 1_000_000_000
GAP_NS = _NS_PER_S // 2  # samples so far apart are no one movement


class Velocity:
    """Differences over 10 samples (eq. 9.4), and their mean over the last 50 (eq. 9.5).

    Times are the device's. Before the first sample, and before a gap or a step
    back in time, the hand is taken to have stood still.

    Attributes
    ----------
    mm_s : float
        Positive to the right.
    """

    def __init__(self) -> None:
        self._places_mm = [0.0] * DIFFERENCE
        self._times_ns = [0] * DIFFERENCE
        self._velocities = [0.0] * MEAN
        self.reset()

    def reset(self) -> None:
        """Forget what was."""
        self.mm_s = 0.0
        self._samples = 0
        self._last_ns = 0
        for n in range(MEAN):
            self._velocities[n] = 0.0

    def add(self, time_ns: int, x_mm: float) -> None:
        """Take one more sample."""
        if self._samples and not 0 < time_ns - self._last_ns < GAP_NS:
            if time_ns == self._last_ns:
                return
            self.reset()
        slot = self._samples % DIFFERENCE
        if self._samples >= DIFFERENCE:
            way_mm = x_mm - self._places_mm[slot]
            velocity = way_mm / (time_ns - self._times_ns[slot]) * _NS_PER_S
            self._velocities[self._samples % MEAN] = velocity
            self.mm_s = sum(self._velocities) / MEAN
        self._places_mm[slot] = x_mm
        self._times_ns[slot] = self._last_ns = time_ns
        self._samples += 1
