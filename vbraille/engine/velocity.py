"""How fast the hand moves, and which way, smoothly: Lévesque 2009, 9.4.1."""

from __future__ import annotations

DIFFERENCE = 10  # samples, N
MEAN = 50  # velocities, M
_NS_PER_S = 1_000_000_000
GAP_NS = _NS_PER_S // 2  # samples so far apart are no one movement


class Velocity:
    """Differences over 10 samples (eq. 9.4), and their mean over the last 50 (eq. 9.5).

    So the 59 samples before the newest are remembered. Components are averaged, never the angle.
    Times are the device's. Before the first sample, and before a gap or a step back in time, the
    hand is taken to have stood still.

    Attributes
    ----------
    x_mm_s, y_mm_s : float
        Positive to the right, and towards the reader.
    """

    def __init__(self) -> None:
        self._samples_seen = 0
        self._last_ns = 0
        # Rings: the newest sample or difference takes the place of the oldest.
        self._samples = [(0, 0.0, 0.0)] * DIFFERENCE
        self._x_mm_s = [0.0] * MEAN
        self._y_mm_s = [0.0] * MEAN
        self.x_mm_s = self.y_mm_s = 0.0

    def reset(self) -> None:
        """Forget what was."""
        self.x_mm_s = self.y_mm_s = 0.0
        self._samples_seen = 0
        self._last_ns = 0
        for n in range(MEAN):
            self._x_mm_s[n] = self._y_mm_s[n] = 0.0

    def add(self, time_ns: int, x_mm: float, y_mm: float) -> None:
        """Take one more sample."""
        if self._samples_seen and not 0 < time_ns - self._last_ns < GAP_NS:
            if time_ns == self._last_ns:
                return
            self.reset()
        oldest = self._samples_seen % DIFFERENCE
        if self._samples_seen >= DIFFERENCE:
            before_ns, before_x_mm, before_y_mm = self._samples[oldest]
            newest, taken_ns = self._samples_seen % MEAN, time_ns - before_ns
            self._x_mm_s[newest] = (x_mm - before_x_mm) / taken_ns * _NS_PER_S
            self._y_mm_s[newest] = (y_mm - before_y_mm) / taken_ns * _NS_PER_S
            self.x_mm_s, self.y_mm_s = sum(self._x_mm_s) / MEAN, sum(self._y_mm_s) / MEAN
        self._samples[oldest] = time_ns, x_mm, y_mm
        self._last_ns = time_ns
        self._samples_seen += 1
