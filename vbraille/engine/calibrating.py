"""Gains of actuators as a person finds them: each swings in turn, and keys set its gain."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.devices.calibration import Calibration
from vbraille.engine.constants import FADE_S, NS_PER_S

if TYPE_CHECKING:
    from vbraille.devices.base import Device
    from vbraille.engine.clock import Clock

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
_SWINGS_S = 4.0  # a second each


class CalibrationRound:
    """A round through the actuators of a device, which swing one after the other, from the first.

    Parameters
    ----------
    device
        Open device.
    clock
        Clock by which frames are due.
    found
        Calibration that the round changes.

    Attributes
    ----------
    left : bool
        Whether the round is over.
    """

    def __init__(self, device: Device, clock: Clock, found: Calibration) -> None:
        self._device, self._clock, self._rate_hz = device, clock, device.display.rate_hz
        self._name, self._gains = found.device, found.gains
        self._number, self.left = 0, False
        self._frame = np.zeros(device.display.shape)
        self._left_s, self._due_ns = 0.0, clock.now_ns()
        self._was = device.rested, device.taking

    @property
    def found(self) -> Calibration:
        """Calibration as it is now."""
        return Calibration(self._name, self._gains.tolist())

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
        steps = {"p": -1, "left": -1, "i": 0, "+": 0, "=": 0, "-": 0}.get(key, 1)
        match key:
            case " " | "space":
                return []
            case "s":
                return gains_said(self.found)
            case "h" | "?":
                return [f"{keys}: {does}" for keys, does in KEYS.items()]
            case "q" | "escape":
                self.left = True
                return []
            case "y" | "\n" | "\r" | "enter":
                gain = gain or 1.0
            case "d":
                gain = 0.0
            case "i":
                gain = -gain or 1.0
            case "+" | "=" | "-":
                size = round(abs(gain) + (-_STEP if key == "-" else _STEP), 2)
                gain = math.copysign(min(max(size, _LEAST), 1.0), gain)
            case "n" | "right" | "p" | "left":
                pass
            case _:
                return ["press h for the keys"]
        self._gains[self.place] = gain
        self._number = (self._number + steps) % self._gains.size
        return [self.said() if steps else _said(gain)]

    def swing(self) -> None:
        """Have the actuator in turn swing out and back for some seconds, once all rest.

        Raises
        ------
        DeviceError
            If the device is gone for good.
        """
        self.rest()
        shown = self._gains.copy()
        shown[self.place] = shown[self.place] or 1.0  # one that was found to be dead, too
        self._device.calibrate(Calibration(self._name, shown.tolist()))
        self._left_s = _SWINGS_S

    def tick(self) -> None:
        """Wait for the next frame's time, read the device, and send the frame.

        Raises
        ------
        DeviceError
            If the device is gone for good.
        """
        now = self._device.rested, self._device.taking
        if now != self._was:  # it has gone to rest by itself, or leaves it: begin again from there
            self._was, self._left_s = now, _SWINGS_S if self._left_s else 0.0
        self._left_s = max(self._left_s - 1 / self._rate_hz, 0.0)
        self._frame[self.place] = math.sin(math.pi * self._left_s) ** 2
        self._send()

    def rest(self) -> None:
        """Fade to rest.

        Raises
        ------
        DeviceError
            If the device is gone for good.
        """
        self._left_s = 0.0
        step = 1 / max(FADE_S * self._rate_hz, 1)
        while self._frame.any() or self._device.moving:
            self._frame[:] = np.maximum(self._frame - step, 0.0)
            self._send()

    def _send(self) -> None:
        period_ns = round(NS_PER_S / self._rate_hz)
        self._due_ns = max(self._due_ns + period_ns, self._clock.now_ns() - period_ns)
        self._clock.sleep_until_ns(self._due_ns)
        self._device.read()
        self._device.write(self._frame)


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
