"""The array on a Latero's tray, and the hand that moves it over a page when it is asked to."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.carriers import latero
from vbraille.simulation.paging import area_on
from vbraille.simulation.recorded import Recorded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.simulation.hand import Hand
    from vbraille.simulation.motion import Motion

# Speed of a hand that moves without reading.
_APPROACH_MM_S: Final = 250.0
# Counts of encoders 0, 1 and 2 at angle 0: any, and none of them 0, for clients must mind them.
OFFSETS: Final = (4452, 4_294_960_000, 120_034)


class Tray:
    """An array at the lower left, with the third arm straight up, and a hand.

    Parameters
    ----------
    hand
        Hand that reads a page again and again; a recorded hand reads once.
    span_mm
        Distance between the array's outer columns.
    lines, pitch_mm
        Lines of the page, and how far apart they are; the first begins at the top.
    """

    def __init__(
        self, hand: Hand | Recorded, span_mm: float, lines: int = 1, pitch_mm: float = 10.0
    ) -> None:
        self._hand = hand
        self._span_mm = span_mm
        self._area = area_on(latero.HEIGHT_MM, lines, pitch_mm, -span_mm, latero.WIDTH_MM - span_mm)
        self._t_s = np.zeros(1)
        self._way = tuple(np.full(1, place) for place in (-span_mm, *latero.RESET[1:]))
        self._begun_us = 0
        self._reads = False

    @property
    def reads(self) -> bool:
        """Whether the hand has set out."""
        return self._reads

    def pose(self, now_us: int) -> tuple[float, float, float]:
        """Place of the array's centre on the tray, in mm, and its angle; time must not go back."""
        if self._reads and (now_us - self._begun_us) / 1e6 >= self._t_s[-1]:
            self._go(self._read(), now_us)
        t_s = (now_us - self._begun_us) / 1e6
        x_mm, y_mm, theta_rad = (float(np.interp(t_s, self._t_s, way)) for way in self._way)
        x_mm = min(max(x_mm + self._span_mm, 0.0), latero.WIDTH_MM)
        return x_mm, min(max(y_mm, 0.0), latero.HEIGHT_MM), theta_rad

    def encoders(self, now_us: int) -> tuple[int, int, int, int]:
        """Counts of the four encoders; the last stands still."""
        joints = latero.joints_at(*self.pose(now_us))
        return *latero.encoders_of(joints, OFFSETS), 0

    def set_out(self, now_us: int) -> None:
        """Have the hand read; it may be reading already."""
        if not self._reads:
            self._reads = True
            self._go(self._read(), now_us)

    def go_back(self, now_us: int) -> None:
        """Move to the lower left, and wait there."""
        self._reads = False
        home = np.full(1, -self._span_mm), np.full(1, latero.HEIGHT_MM), np.zeros(1)
        self._approach(np.zeros(1), home, now_us)

    def _read(self) -> Motion:
        if isinstance(self._hand, Recorded):
            return self._hand.motion()
        return self._hand.read_page(self._area)

    def _go(self, motion: Motion, now_us: int) -> None:
        y_mm, theta_rad = motion.y_mm, motion.theta_rad
        if y_mm is None:
            y_mm = np.full(motion.t_s.size, self._area.middle_mm(0))
        if theta_rad is None:
            theta_rad = np.zeros(motion.t_s.size)
        self._approach(motion.t_s, (motion.x_mm, y_mm, theta_rad), now_us)

    def _approach(self, t_s: np.ndarray, way: Sequence[np.ndarray], now_us: int) -> None:
        """Move along a way, after the way to its beginning."""
        x_mm, y_mm, theta_rad = self._now(now_us)
        far_mm = math.hypot(float(way[0][0]) - x_mm, float(way[1][0]) - y_mm)
        approach_s = max(far_mm / _APPROACH_MM_S, 0.001)
        here = (x_mm, y_mm, theta_rad)
        self._t_s = np.concatenate(([0.0], t_s + approach_s))
        self._way = tuple(
            np.concatenate(([begun], places)) for begun, places in zip(here, way, strict=True)
        )
        self._begun_us = now_us

    def _now(self, now_us: int) -> tuple[float, float, float]:
        t_s = (now_us - self._begun_us) / 1e6
        x_mm, y_mm, theta_rad = (float(np.interp(t_s, self._t_s, way)) for way in self._way)
        return x_mm, y_mm, theta_rad
