"""Signs for the next line: a hand at the end of its line or below its page, or time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.engine.engine import HOME_MM
from vbraille.engine.record import Flag
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.render import BrailleStyle

STILL_S = 10.0
REFUSED_S = 1.0  # time without a frame taken, after which it is said
HOPELESS_S = 10.0  # time without a frame taken, after which waiting ends
# A hand that moves less than this is still.
STILL_MM = 0.5
# If a hand turns back so often at the same place, to a millimetre, there is an obstacle.
TURNS = 3
SAME_MM = 1.0
LEAST_WAY_MM = 20.0  # a hand that has gone less waits at the left
_NS_PER_S = 1_000_000_000
# Plain numbers: with an enumeration numpy asks for attributes, and may lose a signal meanwhile.
_PLACING, _HELD = int(Flag.MARK | Flag.STOP), int(Flag.HELD)


class LineWatch:
    """Watch a hand that does not finish its line.

    Parameters
    ----------
    span_mm
        Width of the array, from its left column to its right one, in mm.
    end_mm
        Right edge of the line's last dot.
    line
        What the line is called, such as "line 12".
    by_hand
        Whether the next line comes when the hand returns; otherwise a key brings it.
    key
        Key that brings the next line; empty if no reader is at a keyboard.

    Attributes
    ----------
    hopeless : str or None
        Reason why the line will not come to its end unless a person sees to the device: it takes
        no frames, or the hand turned back at the same place again and again, before the end.
    """

    def __init__(
        self, span_mm: float, end_mm: float, line: str, *, by_hand: bool, key: str
    ) -> None:
        self.hopeless: str | None = None
        self._home_mm = HOME_MM - span_mm / 2
        self._end_mm = end_mm
        self._line = line
        self._by_hand = by_hand
        self._otherwise = f"{key} brings the next line" if key else "Ctrl-C stops"
        self._said: set[str] = set()
        self._since_ns: int | None = None  # when the hand began to be still, or the device silent
        self._refused_ns: int | None = None  # since when the device takes nothing
        self._at_mm = np.nan  # place where the hand is still
        self._farthest_mm = -np.inf  # farthest place since the hand was at the left
        self._turns_mm: list[float] = []
        self._leftwards = False  # which way it goes once it has been at the end, how far that way
        self._edge_mm = -np.inf
        self._backs_mm: list[float] = []

    def rest(self) -> None:
        """Note that the reader wants the array to rest: what went before does not count."""
        self._since_ns = self._refused_ns = None

    def watch(
        self, ticks: NDArray[np.void], *, reached: bool, patient: bool = False
    ) -> Iterator[str]:
        """Sentences to be said after these ticks, which are all of the line, oldest first.

        Parameters
        ----------
        reached
            Whether the hand has been at the end of the line.
        patient
            Whether the hand may do as it likes, so that only the device is watched.
        """
        yield from self._watch_device(ticks)
        if patient:
            self._since_ns = None
        elif self._by_hand and self._refused_ns is None:
            yield from self._watch_hand(ticks, reached)

    def _watch_hand(self, ticks: NDArray[np.void], reached: bool) -> Iterator[str]:
        """Sentences on a hand that is not on its way through the line."""
        x_mm = ticks["x_mm"]
        moved = (np.abs(x_mm - self._at_mm) > STILL_MM).any()
        found = np.isnan(self._at_mm) != np.isnan(x_mm[-1])
        if self._since_ns is None or moved or found:
            self._since_ns, self._at_mm = int(ticks["time_ns"][-1]), float(x_mm[-1])
        elif ticks["time_ns"][-1] - self._since_ns > STILL_S * _NS_PER_S:
            yield from self._once("still", self._still(int(ticks["flags"][-1]), reached=reached))
        if reached:
            self._count_backs(x_mm)
            if self._backs_mm:
                yield from self._once("back", self._turned_back())
        else:
            self._count_turns(x_mm)
            if len(self._turns_mm) >= TURNS:
                yield from self._once("turned", self._turned())

    def _watch_device(self, ticks: NDArray[np.void]) -> Iterator[str]:
        """Sentences on a device that does not take what it is sent."""
        if not ticks["flags"][-1] & _HELD:
            if "refused" in self._said:
                self._said.remove("refused")
                yield f"device: takes frames again; {self._line} is felt from here on"
            self._refused_ns = None
            return
        now_ns = int(ticks["time_ns"][-1])
        if self._refused_ns is None:
            self._refused_ns = now_ns
        for_s = (now_ns - self._refused_ns) / _NS_PER_S
        if for_s >= REFUSED_S:
            yield from self._once(
                "refused",
                f"waiting: the device takes no frames, so that nothing is felt; switch it off and "
                f"on, and {self._line} goes on",
            )
        if for_s >= HOPELESS_S:
            self.hopeless = (
                f"the device has taken no frames for {HOPELESS_S:g} s, and {self._line} "
                f"was not felt to its end; switch it off and on, and read on from there"
            )

    def _once(self, what: str, sentence: str) -> Iterator[str]:
        if sentence and what not in self._said:
            self._said.add(what)
            yield sentence

    def _still(self, flags: int, *, reached: bool) -> str:
        if flags & _PLACING:
            return ""  # what to do was said already
        if flags & Flag.SILENT or np.isnan(self._at_mm):
            return (
                f"waiting: the device has not said for {STILL_S:g} s where its carriage is; "
                f"see that it is on and plugged in, or {self._otherwise}"
            )
        if reached:
            return (
                f"waiting: {self._line} is read; move back to the left and the next line "
                f"comes, or {self._otherwise}"
            )
        return (
            f"waiting: the finger is still at {max(self._at_mm, 0):.0f} mm, and "
            f"{self._line} ends at {self._end_mm:.0f} mm; read to its end and move back to "
            f"the left, or {self._otherwise}"
        )

    def _turned(self) -> str:
        return (
            f"waiting: the finger turns back at {self._turns_mm[-1]:.0f} mm, and "
            f"{self._line} ends at {self._end_mm:.0f} mm; read to its end and move back to the "
            f"left, or {self._otherwise}"
        )

    def _turned_back(self) -> str:
        return (
            f"waiting: {self._line} is read, and the finger turns right again at "
            f"{self._backs_mm[-1]:.1f} mm; the next line comes at the left stop, which is at "
            f"{self._home_mm - HOME_MM:.1f} mm, or {self._otherwise}"
        )

    def _count_backs(self, x_mm: NDArray[np.float64]) -> None:
        """Keep where a hand turned that has read the line, and does not come to the left stop."""
        for x in x_mm[~np.isnan(x_mm)].tolist():
            way_mm = self._edge_mm - x if self._leftwards else x - self._edge_mm
            if way_mm >= 0:
                self._edge_mm = x
            elif way_mm < -LEAST_WAY_MM:
                if self._leftwards and self._edge_mm < self._end_mm / 2:
                    self._backs_mm.append(self._edge_mm)
                self._leftwards, self._edge_mm = not self._leftwards, x
        last = self._backs_mm[-TURNS:]
        if len(last) == TURNS and max(last) - min(last) <= SAME_MM:
            self.hopeless = (
                f"{self._line} is read and never done: the finger turns at {last[-1]:.1f} "
                f"mm each time, and the left stop is at {self._home_mm - HOME_MM:.1f} mm; see what "
                f"is in the carriage's way, or that its driver says -span_mm / 2 at its left stop"
            )

    def _count_turns(self, x_mm: NDArray[np.float64]) -> None:
        """Keep how far the hand has come, each time that it is back at the left."""
        home = np.flatnonzero(x_mm <= self._home_mm)
        away = x_mm[: home[0]] if home.size else x_mm
        if away.size:
            self._farthest_mm = max(self._farthest_mm, float(np.fmax.reduce(away)))
        if not home.size:
            return
        if self._home_mm + LEAST_WAY_MM < self._farthest_mm < self._end_mm:
            self._turns_mm.append(self._farthest_mm)
            last = self._turns_mm[-TURNS:]
            if len(last) == TURNS and max(last) - min(last) <= SAME_MM:
                self.hopeless = (
                    f"{self._line} cannot be read to its end: the finger turns back at "
                    f"{last[-1]:.0f} mm each time, and the line ends at {self._end_mm:.0f} mm; see "
                    f"what is in the carriage's way, or give a shorter {setting('travel')}"
                )
        self._farthest_mm = float(np.fmax.reduce(x_mm[home[-1] :]))


# Ours: longer than a finger that strays off the last line takes to come back, shorter than one
# that waits for something to happen.
STAY_S: Final = 0.5
_STAY_NS: Final = round(STAY_S * 1e9)
# A plain number, as in `vbraille.cli.old.reading.lineviews`.
_UNFELT: Final = int(Flag.SILENT | Flag.MARK | Flag.STOP | Flag.HELD | Flag.TURNED)


class PageFoot:
    """Watches for a finger that has been on a page and stays below its last line.

    Parameters
    ----------
    rows
        Number of rows of the page.
    """

    def __init__(self, rows: int) -> None:
        self._rows = rows
        self._begun = False  # whether the finger was on the page since that came
        self._since_ns: int | None = None

    def rest(self) -> None:
        """Take the time below the page to begin anew, since nothing was felt meanwhile."""
        self._since_ns = None

    def stays(self, ticks: NDArray[np.void]) -> bool:
        """Look at ticks, which are all since the last call: whether it has stayed long enough.

        Time in which the device was away, or at rest by itself, does not count.
        """
        felt = ticks["flags"] & _UNFELT == 0
        on = felt & (ticks["part"] < self._rows)
        self._begun = self._begun or bool(on.any())
        elsewhere = np.flatnonzero(on | ~felt)
        if elsewhere.size:
            self.rest()
            ticks = ticks[elsewhere[-1] + 1 :]
        if not ticks.size or not self._begun:
            return False
        if self._since_ns is None:
            self._since_ns = int(ticks["time_ns"][0])
        return int(ticks["time_ns"][-1]) - self._since_ns >= _STAY_NS


# Above this the devices' reconstruction filters take texture away (Lévesque 2009, 6.2).
FILTER_HZ = 200.0


def too_fast_note(speed_mm_s: float, style: BrailleStyle) -> str | None:
    """Note on a hand so fast that the filters take texture away; None if it is not."""
    if not style.tuning.texture:
        return None
    period_mm = style.profile.texture_period_mm(style.geometry.dot_width_mm, style.tuning.cycles)
    if speed_mm_s / period_mm <= FILTER_HZ:
        return None
    return (
        f"speed: {speed_mm_s:.0f} mm/s, at which texture passes {FILTER_HZ:g} Hz and fades; "
        f"below {FILTER_HZ * period_mm:.0f} mm/s it is felt"
    )


USUAL_CELLS_S: Final = 8.0
SLOWEST_CELLS_S: Final = 1.0
FASTEST_CELLS_S: Final = 30.0
STEP: Final = 1.2  # from a speed to the next faster one


# Time between two looks that counts; a longer one was a pause, in which nothing was read.
_MOST_S: Final = 0.25


class Scroll:
    """Time that a line is given by its number of cells, whatever the hand does."""

    def __init__(self) -> None:
        self._steps = 0  # from the usual speed: counted, so that as many back lead to the same
        self._on = False
        self._passed = 0.0  # cells of the line for which the time is over
        self._till_s: float | None = None  # when that was so

    @property
    def on(self) -> bool:
        """True if lines come by themselves; the present line has all its time once that is set."""
        return self._on

    @on.setter
    def on(self, on: bool) -> None:
        if on and not self._on:
            self._passed, self._till_s = 0.0, None
        self._on = on

    @property
    def speed_cells_s(self) -> float:
        """Speed in cells a second, 1 to 30."""
        speed = USUAL_CELLS_S * STEP**self._steps
        return round(min(max(speed, SLOWEST_CELLS_S), FASTEST_CELLS_S), 1)

    @property
    def words(self) -> str:
        """Words for the speed."""
        speed = self.speed_cells_s
        return f"{speed:g} {'cell' if speed == 1 else 'cells'} a second"

    def turn(self, step: int) -> bool:
        """Turn the speed up by a fifth, or down by as much if -1; False if that is no change."""
        before = self.speed_cells_s
        self._steps += step
        if self.speed_cells_s == before:
            self._steps -= step
            return False
        return True

    def begin(self, now_s: float) -> None:
        """Note that a line has come under the hand, by a clock in seconds that does not go back."""
        self._passed = 0.0
        self._till_s = now_s

    def due(self, line_cells: int, now_s: float) -> bool:
        """Tell whether the time of the line is over; if so, that of the next line begins.

        Call it again and again, as the speed may change: that counts at once for the present line.
        Time in which it is not called, as in a pause, does not count.

        Parameters
        ----------
        line_cells
            Number of cells in the line; an empty line has the time of one cell.
        now_s
            Time by the same clock as in `begin`.
        """
        if not self._on:
            return False
        since_s = 0.0 if self._till_s is None else now_s - self._till_s
        self._till_s = now_s
        if since_s <= _MOST_S:
            self._passed += since_s * self.speed_cells_s
        if self._passed < max(line_cells, 1):
            return False
        self.begin(now_s)
        return True
