"""A hand that does not finish its line, and one that is too fast: what is said of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.engine.engine import HOME_MM
from vbraille.engine.record import Flag
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.render import BrailleStyle

_STILL_S = 10.0
_STILL_MM = 0.5  # a hand that moves less is still
_REFUSED_S, _HOPELESS_S = 1.0, 10.0  # without a frame taken
_TURNS, _SAME_MM = 3, 1.0  # so many turns at the same place are an obstacle
_LEAST_WAY_MM = 20.0  # a hand that has gone less waits at the left
_FILTER_HZ = 200.0  # above this the devices' filters take texture away (Lévesque 2009, 6.2)
# Plain numbers: with an enumeration numpy asks for attributes, and may lose a signal meanwhile.
_PLACING, HELD = int(Flag.MARK | Flag.STOP), int(Flag.HELD)


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
        self._home_mm, self._end_mm = HOME_MM - span_mm / 2, end_mm
        self._line, self._by_hand, self._otherwise = line, by_hand, otherwise
        self._said: set[str] = set()
        self._since_s = self._refused_s = -1.0  # below 0: not now
        self._at_mm = np.nan
        self._farthest_mm = self._edge_mm = -np.inf
        self._rightwards = True
        self._turns_mm: list[float] = []
        self._backs_mm: list[float] = []

    def rest(self) -> None:
        """Note that the array is to rest: what went before does not count."""
        self._since_s = self._refused_s = -1.0

    def watch(self, ticks: NDArray[np.void], *, reached: bool, patient: bool) -> Iterator[str]:
        """Sentences to be said after these ticks of the line.

        Parameters
        ----------
        reached
            Whether the hand has been at the end of the line.
        patient
            Whether the hand may do as it likes, so that only the device is watched.
        """
        now_s = int(ticks["time_ns"][-1]) / 1e9
        yield from self._watch_device(bool(int(ticks["flags"][-1]) & HELD), now_s)
        if patient or not self._by_hand or self._refused_s >= 0:
            self._since_s = -1.0
            return
        x_mm = ticks["x_mm"]
        if self._since_s < 0 or not (np.abs(x_mm - self._at_mm) <= _STILL_MM).all():
            self._at_mm = float(x_mm[-1])
            if self._since_s < 0 or not np.isnan(x_mm).all():
                self._since_s = now_s
        if now_s - self._since_s > _STILL_S and not int(ticks["flags"][-1]) & _PLACING:
            yield from self._once("still", self._still(reached=reached))
        if reached:
            yield from self._watch_return(x_mm)
        else:
            yield from self._watch_turns(x_mm)

    def _watch_device(self, held: bool, now_s: float) -> Iterator[str]:
        if not held:
            self._refused_s = -1.0
            if "refused" in self._said:
                self._said.remove("refused")
                yield f"device: takes frames again; {self._line} is felt from here on"
            return
        if self._refused_s < 0:
            self._refused_s = now_s
        if now_s - self._refused_s >= _REFUSED_S:
            yield from self._once(
                "refused",
                f"waiting: the device takes no frames, so that nothing is felt; switch it off and "
                f"on, and {self._line} goes on",
            )
        if now_s - self._refused_s >= _HOPELESS_S:
            self.hopeless = (
                f"the device has taken no frames for {_HOPELESS_S:g} s, and {self._line} was not "
                f"felt to its end; switch it off and on, and read on from there"
            )

    def _watch_turns(self, x_mm: NDArray[np.float64]) -> Iterator[str]:
        """Note where the hand has turned back, each time that it is at the left again."""
        self._farthest_mm = float(np.fmax(self._farthest_mm, np.fmax.reduce(x_mm)))
        if not (x_mm <= self._home_mm).any():
            return
        if self._home_mm + _LEAST_WAY_MM < self._farthest_mm < self._end_mm:
            self._turns_mm.append(self._farthest_mm)
        self._farthest_mm = -np.inf
        if len(self._turns_mm) < _TURNS:
            return
        at_mm = self._turns_mm[-1]
        yield from self._once(
            "turned",
            f"waiting: the finger turns back at {at_mm:.0f} mm, and {self._line} ends at "
            f"{self._end_mm:.0f} mm; read to its end and move back to the left, or "
            f"{self._otherwise}",
        )
        if _same(self._turns_mm):
            self.hopeless = (
                f"{self._line} cannot be read to its end: the finger turns back at {at_mm:.0f} mm "
                f"each time, and the line ends at {self._end_mm:.0f} mm; see what is in the "
                f"carriage's way, or give a shorter {setting('travel')}"
            )

    def _watch_return(self, x_mm: NDArray[np.float64]) -> Iterator[str]:
        """Note where a hand that has read the line turns right before it is at the left stop."""
        last_mm = float(x_mm[-1])
        if self._rightwards:
            self._edge_mm = float(np.fmax(self._edge_mm, np.fmax.reduce(x_mm)))
            if last_mm < self._edge_mm - _LEAST_WAY_MM:
                self._rightwards, self._edge_mm = False, last_mm
            return
        self._edge_mm = float(np.fmin(self._edge_mm, np.fmin.reduce(x_mm)))
        if not last_mm > self._edge_mm + _LEAST_WAY_MM:
            return
        at_mm, self._edge_mm, self._rightwards = self._edge_mm, last_mm, True
        if at_mm < self._end_mm / 2:
            self._backs_mm.append(at_mm)
        if not self._backs_mm:
            return
        stop_mm = self._home_mm - HOME_MM
        yield from self._once(
            "back",
            f"waiting: {self._line} is read, and the finger turns right again at {at_mm:.1f} mm; "
            f"the next line comes at the left stop, which is at {stop_mm:.1f} mm, or "
            f"{self._otherwise}",
        )
        if _same(self._backs_mm):
            self.hopeless = (
                f"{self._line} is read and never done: the finger turns at {at_mm:.1f} mm each "
                f"time, and the left stop is at {stop_mm:.1f} mm; see what is in the carriage's "
                f"way, or that its driver says -span_mm / 2 at its left stop"
            )

    def _once(self, what: str, sentence: str) -> Iterator[str]:
        if what not in self._said:
            self._said.add(what)
            yield sentence

    def _still(self, *, reached: bool) -> str:
        if np.isnan(self._at_mm):
            return (
                f"waiting: the device has not said for {_STILL_S:g} s where its carriage is; see "
                f"that it is on and plugged in, or {self._otherwise}"
            )
        if reached:
            return (
                f"waiting: {self._line} is read; move back to the left and the next line comes, "
                f"or {self._otherwise}"
            )
        return (
            f"waiting: the finger is still at {max(self._at_mm, 0):.0f} mm, and {self._line} ends "
            f"at {self._end_mm:.0f} mm; read to its end and move back to the left, or "
            f"{self._otherwise}"
        )


def _same(turns_mm: list[float]) -> bool:
    """Tell whether the last turns were at one place."""
    last = turns_mm[-_TURNS:]
    return len(last) == _TURNS and max(last) - min(last) <= _SAME_MM


def too_fast_note(speed_mm_s: float, style: BrailleStyle) -> str | None:
    """Note on a hand so fast that the filters take texture away; None if it is not."""
    if not style.tuning.texture:
        return None
    period_mm = style.profile.texture_period_mm(style.geometry.dot_width_mm, style.tuning.cycles)
    if speed_mm_s / period_mm <= _FILTER_HZ:
        return None
    return (
        f"speed: {speed_mm_s:.0f} mm/s, at which texture passes {_FILTER_HZ:g} Hz and fades; "
        f"below {_FILTER_HZ * period_mm:.0f} mm/s it is felt"
    )
