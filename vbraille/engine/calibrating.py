"""Gains of actuators as a person finds them: each swings in turn, and keys set its gain."""

from __future__ import annotations

import numpy as np

from vbraille.devices.calibration import Calibration

KEYS = {
    "y or Enter": "it is well; next actuator",
    "d": "it is dead; next actuator",
    "i": "it moves the other way",
    "plus or minus": "more gain, less gain",
    "n or p": "next actuator, previous actuator",
    "space": "swing again",
    "s": "say what was found",
    "h": "list the keys",
    "q": "leave",
}
_STEP = _LEAST = 0.05


class CalibrationRound:
    """A round through the actuators of a device, which begins at the first.

    Parameters
    ----------
    found
        Calibration that the round changes.

    Attributes
    ----------
    left : bool
        Whether the round is over.
    """

    def __init__(self, found: Calibration) -> None:
        self._device, self._gains = found.device, found.gains
        self._number = 0
        self.left = False

    @property
    def found(self) -> Calibration:
        """Calibration as it is now."""
        return Calibration(self._device, self._gains.tolist())

    @property
    def shown(self) -> Calibration:
        """Calibration by which the actuator in turn swings, even if it was found to be dead."""
        gains = self._gains.copy()
        gains[self.place] = gains[self.place] or 1.0
        return Calibration(self._device, gains.tolist())

    @property
    def place(self) -> tuple[int, int]:
        """Row and column, from 0, of the actuator in turn."""
        row, column = divmod(self._number, self._gains.shape[1])
        return row, column

    def said(self) -> str:
        """Line on the actuator in turn."""
        row, column = self.place
        number = f"actuator {self._number + 1} of {self._gains.size}"
        return f"{number}: row {row + 1}, column {column + 1}, {_said(self._gains[self.place])}"

    def press(self, key: str) -> list[str]:
        """Obey a key; lines on what happened."""
        gain = float(self._gains[self.place])
        match key:
            case "y" | "\n" | "\r" | "enter" | "n" | "right":
                self._gains[self.place] = gain or float(key not in ("n", "right"))
                return self._go(1)
            case "p" | "left":
                return self._go(-1)
            case "d":
                self._gains[self.place] = 0.0
                return self._go(1)
            case "i":
                self._gains[self.place] = -gain or 1.0
            case "+" | "=" | "-":
                size = round(abs(gain) + (-_STEP if key == "-" else _STEP), 2)
                self._gains[self.place] = np.copysign(min(max(size, _LEAST), 1.0), gain)
            case " " | "space":
                return []
            case "s":
                return gains_said(self.found)
            case "h" | "?":
                return [f"{keys}: {does}" for keys, does in KEYS.items()]
            case "q" | "escape":
                self.left = True
                return []
            case _:
                return ["press h for the keys"]
        return [_said(self._gains[self.place])]

    def _go(self, steps: int) -> list[str]:
        self._number = (self._number + steps) % self._gains.size
        return [self.said()]


def gains_said(calibration: Calibration) -> list[str]:
    """Lines on what was found of a device's actuators."""
    gains = calibration.gains
    lines = []
    for label, found in (("dead", gains == 0), ("inverted", gains < 0)):
        places = [f"row {row + 1}, column {column + 1}" for row, column in np.argwhere(found)]
        lines.append(f"{label}: {'; '.join(places) or 'none'}")
    for row, column in np.argwhere((np.abs(gains) < 1) & (gains != 0)):
        lines.append(f"row {row + 1}, column {column + 1}: {_said(float(gains[row, column]))}")
    return lines


def _said(gain: float) -> str:
    if gain == 0:
        return "dead"
    return f"gain {100 * abs(gain):.0f} %{', inverted' if gain < 0 else ''}"
