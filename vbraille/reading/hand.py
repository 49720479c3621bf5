"""A hand that does not finish its line: what is said of it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.engine.record import Flag
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

_STILL_S = 10.0
_STILL_MM = 0.5  # a hand that moves less is still
_REFUSED_S, _HOPELESS_S = 1.0, 10.0  # without a frame taken
_TURNS, _SAME_MM = 3, 1.0  # three turns within 1 mm are an obstacle
_LEAST_WAY_MM = 20.0  # a hand that has gone less waits at the left
# Plain numbers: with an enumeration numpy asks for attributes, and may lose a signal meanwhile.
_PLACING, HELD = int(Flag.STOP), int(Flag.HELD)


class HandWatch:
    """Watch a hand that does not finish its line.

    Parameters
    ----------
    span_mm
        Width of the array, from its left column to its right one.
    end_mm
        Right edge of the line's last dot.
    line
        What the line is called, such as "line 12".
    by_hand
        Whether the next line comes when the hand returns; otherwise only the device is watched.
    otherwise
        What else brings the next line, such as "n brings the next line".

    Attributes
    ----------
    hopeless : str or None
        Reason why the line will not come to its end unless a person sees to the device.
    """

    def __init__(
        self, span_mm: float, end_mm: float, line: str, *, by_hand: bool, otherwise: str
    ) -> None:
        self.hopeless: str | None = None
        self._stop_mm = -span_mm / 2
        self._end_mm, self._line = end_mm, line
        self._by_hand, self._otherwise = by_hand, otherwise
        self._said: set[str] = set()
        self._moved_s = self._taken_s = math.nan  # when it last moved, and took a frame
        self._at_mm = self._edge_mm = math.nan
        self._way = 1  # to the right, -1 to the left
        self._turns_mm: list[float] = []  # away from the end that the hand is to come to

    def rest(self) -> None:
        """Note that the array is to rest: what went before does not count."""
        self._moved_s = self._taken_s = math.nan

    def watch(self, ticks: NDArray[np.void], *, reached: bool, patient: bool) -> Iterator[str]:
        """Sentences to be said after these ticks of the line.

        Parameters
        ----------
        reached
            Whether the hand has been at the end of the line.
        patient
            Whether the hand may do as it likes, so that only the device is watched.
        """
        now_s, flags = int(ticks["time_ns"][-1]) / 1e9, int(ticks["flags"][-1])
        if not flags & HELD or math.isnan(self._taken_s):
            self._taken_s = now_s
        if now_s - self._taken_s >= _REFUSED_S:
            yield from self._once(
                f"the device takes no frames, so that nothing is felt; switch it off and on, "
                f"and {self._line} goes on"
            )
        if now_s - self._taken_s >= _HOPELESS_S:
            self.hopeless = f"the device took no frames for {_HOPELESS_S:g} s; switch it off and on"
        if patient or not self._by_hand or flags & (HELD | _PLACING):
            self._moved_s = math.nan
            return
        if reached:
            goal = f"{self._line} is read; move back to the left stop, at {self._stop_mm:.1f} mm"
        else:
            goal = f"{self._line} ends at {self._end_mm:.0f} mm; read to its end and move back"
        x_mm = ticks["x_mm"]
        if math.isnan(self._moved_s) or (np.abs(x_mm - self._at_mm) > _STILL_MM).any():
            self._moved_s, self._at_mm = now_s, float(x_mm[-1])
        if now_s - self._moved_s > _STILL_S and math.isnan(self._at_mm):
            yield from self._once("the device has not told its place; see that it is on")
        elif now_s - self._moved_s > _STILL_S:
            still = f"the finger is still at {max(self._at_mm, 0):.0f} mm, and {goal}"
            yield from self._once(f"{still}, or {self._otherwise}")
        self._turn(float(x_mm[-1]), reached=reached)
        last = self._turns_mm[-_TURNS:]
        if len(last) == _TURNS and max(last) - min(last) <= _SAME_MM:
            said = f"the finger turns at {last[-1]:.0f} mm each time, and {goal}"
            yield from self._once(f"{said}, or {self._otherwise}")
            self.hopeless = (
                f"{said}; see what is in the carriage's way, or give a shorter {setting('travel')}"
            )

    def _turn(self, x_mm: float, *, reached: bool) -> None:
        """Note where a hand turns before it is where it has to come to."""
        if not self._way * (x_mm - self._edge_mm) < 0:  # on, or the first place
            self._edge_mm = x_mm
        elif abs(x_mm - self._edge_mm) > _LEAST_WAY_MM:
            short = self._edge_mm < self._end_mm / 2 if reached else self._edge_mm < self._end_mm
            if short and self._way == (-1 if reached else 1):
                self._turns_mm.append(self._edge_mm)
            self._way, self._edge_mm = -self._way, x_mm

    def _once(self, sentence: str) -> Iterator[str]:
        kind = " ".join(sentence.split()[:4])
        if kind not in self._said:
            self._said.add(kind)
            yield f"waiting: {sentence}"
