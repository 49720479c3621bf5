"""How the actuators of a device are gone through: which is next, what was found, and undo."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final, Self

from vbraille.devices.calibration import LEAST_GAIN, Tried

if TYPE_CHECKING:
    from vbraille.devices.calibration import Calibration, State

GAIN_STEP: Final = 0.05


@dataclass(frozen=True, slots=True)
class Round:
    """Where somebody is who goes through the actuators.

    Parameters
    ----------
    found
        What was found so far.
    now
        The actuator in turn, with what was set of it and is not found yet.
    before
        The round before the last finding, for undo; None if there was none since it began.
    """

    found: Calibration
    now: Tried
    before: Round | None = None

    @classmethod
    def of(cls, found: Calibration) -> Self:
        """Begin at the first actuator that was not tried, or at the first of all."""
        return cls(found, _usual(found, _untried_from(found, (0, 0)) or (0, 0)))

    @property
    def shown(self) -> Calibration:
        """Calibration by which the actuator in turn swings as it is set; it is never dead there."""
        return self.found.with_tried(replace(self.now, state="ok"))

    def is_(self, state: State) -> Round:
        """Find the actuator to be in a state, and go to the next that was not tried."""
        found = self.found.with_tried(replace(self.now, state=state))
        place = _untried_from(found, self.now.place) or _step(found, self.now.place, 1)
        return Round(found, _usual(found, place), self)

    def undo(self) -> Round | None:
        """Take the last finding back, and go to its actuator; None if there is none."""
        if self.before is not None:
            return self.before
        if not self.found.tried:
            return None
        last = self.found.tried[-1]
        return Round(self.found.without_last(), replace(last, state="ok"))

    def go(self, steps: int) -> Round:
        """Go to another actuator without finding anything."""
        place = _step(self.found, self.now.place, steps)
        return replace(self, now=_usual(self.found, place))

    def inverted(self) -> Round:
        """Set the actuator to be inverted, or not to be."""
        return replace(self, now=replace(self.now, inverted=not self.now.inverted))

    def louder(self, steps: int) -> Round:
        """Set the actuator's gain some steps higher, or lower."""
        gain = round(self.now.gain + steps * GAIN_STEP, 2)
        return replace(self, now=replace(self.now, gain=min(max(gain, LEAST_GAIN), 1.0)))

    @property
    def reference(self) -> tuple[int, int] | None:
        """Row and column, from 0, of the last other actuator found to be ok; None if none was."""
        others = (one for one in reversed(self.found.tried) if one.place != self.now.place)
        return next((one.place for one in others if one.state == "ok"), None)


def _usual(found: Calibration, place: tuple[int, int]) -> Tried:
    """What is set of an actuator as it comes in turn: what was found of it, or the usual."""
    before = found.of(place)
    return Tried(*place) if before is None else replace(before, state="ok")


def _step(found: Calibration, place: tuple[int, int], steps: int) -> tuple[int, int]:
    """Place of an actuator some steps further in reading order; the first follows the last."""
    count = found.rows * found.columns
    row, column = place
    return divmod((row * found.columns + column + steps) % count, found.columns)


def _untried_from(found: Calibration, place: tuple[int, int]) -> tuple[int, int] | None:
    """Place of the first actuator from here on that was not tried; None if all were."""
    tried = {one.place for one in found.tried}
    around = (_step(found, place, steps) for steps in range(found.rows * found.columns))
    return next((place for place in around if place not in tried), None)
