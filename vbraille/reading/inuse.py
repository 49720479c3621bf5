"""A device that somebody reads on, as it is at the moment: what is under the hand, and where."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.errors import DeviceError
from vbraille.pose import Pose

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.engine.engine import Engine
    from vbraille.engine.host import Host
    from vbraille.engine.local import LocalEngine
    from vbraille.engine.tally import Tally
    from vbraille.layout.pages import Line
    from vbraille.reading.openhand import OpenHand
    from vbraille.reading.reader import Reader
    from vbraille.render.braille.models import Model
    from vbraille.render.braille.style import BrailleStyle
    from vbraille.simulation.pointing import Pointer
    from vbraille.simulation.steering import Steering


class DeviceInUse:
    """State of a device that somebody reads on; `vbraille.reading.opened` changes it."""

    _engine: Host | LocalEngine
    _hand: OpenHand
    _reader: Reader | None = None
    _newest: np.void | None = None
    _model: Model | None = None

    @property
    def has_hand(self) -> bool:
        """Tell if a simulated hand moves the device, which is then simulated itself."""
        return self._hand.steering is not None

    @property
    def pointer(self) -> Pointer | None:
        """Where somebody may hold the simulated hand; None also if a person moves the device."""
        return self._hand.pointer

    @property
    def held(self) -> bool:
        """Whether somebody holds the simulated hand."""
        return self._hand.held

    @property
    def engine(self) -> Engine:
        """Engine that drives the device, for whoever shows pictures that are no lines."""
        return self._engine

    @property
    def steering(self) -> Steering | None:
        """Channel of orders to the simulated hand; None if a person moves the device."""
        return self._hand.steering

    @property
    def display(self) -> Display:
        """Display of the device."""
        return self.model.display

    @property
    def model(self) -> Model:
        """Display and style that lines are shown in."""
        if self._model is None:
            raise DeviceError("the device is not open; start it first")
        return self._model if self._reader is None else replace(self._model, style=self.style)

    @property
    def style(self) -> BrailleStyle:
        """Style that lines are shown in; `tune` changes it."""
        if self._reader is not None:
            return self._reader.style
        return self.model.style

    @property
    def reader(self) -> Reader:
        """Reader of what is shown, who takes the commands of `vbraille read`."""
        if self._reader is None:
            raise DeviceError("nothing is shown; show a text first")
        return self._reader

    @property
    def line(self) -> Line | None:
        """Line under the hand; None before the first."""
        return None if self._reader is None else self._reader.line

    @property
    def done(self) -> bool:
        """Whether all that was shown has been read."""
        return self._reader is None or self._reader.done

    @property
    def x_mm(self) -> float | None:
        """Place of the array's centre along the line at the last poll; None if not known."""
        return self._engine.x_mm

    @property
    def pose(self) -> Pose | None:
        """Pose of the array at the last poll, by the device's clock; None if not known."""
        tick = self._newest
        if tick is None or self._engine.x_mm is None:
            return None
        x_mm, y_mm, theta_rad = (float(tick[name]) for name in ("x_mm", "y_mm", "theta_rad"))
        return Pose(int(tick["device_ns"]), x_mm, y_mm, theta_rad)

    @property
    def frame(self) -> NDArray[np.float32] | None:
        """Frame sent last, float32[rows, columns], 0 to 1; None before the first poll."""
        return None if self._newest is None else self._newest["frame"].copy()

    @property
    def paused(self) -> bool:
        """Whether the array rests; setting it has the array rest at once, or go on."""
        return self._engine.paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self._engine.paused = paused

    @property
    def tally(self) -> Tally:
        """Counts of what the loop has done so far, such as ticks and late ticks."""
        return self._engine.tally

    @property
    def counts(self) -> Mapping[str, int]:
        """Counts of what went wrong with the device, by name; known after `close`."""
        return self._engine.counts
