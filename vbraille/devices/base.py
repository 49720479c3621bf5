"""A device: a place read, a frame written, rest on close."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Self

import numpy as np

from vbraille.devices.calibration import Correction
from vbraille.devices.events import Placing
from vbraille.errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from vbraille.devices.calibration import Calibration
    from vbraille.devices.events import Event
    from vbraille.display import Display, Pose

__all__ = ["Device", "Particulars", "Placing"]


@dataclass(frozen=True, slots=True)
class Particulars:
    """Facts of a device that only its builder asks for, and reading does not.

    Parameters
    ----------
    protocol
        What the device speaks, with the version.
    fastest
        Share of the full swing that an actuator goes in a millisecond; 0 if that is not known.
    buttons, knobs
        Number of buttons and of knobs.
    analog
        Names of its analog inputs.
    """

    protocol: str
    fastest: float = 0.0
    buttons: int = 0
    knobs: int = 0
    analog: tuple[str, ...] = ()


class Device(ABC):
    """A device: `read`, `write`, `close`, and `display`. A context manager.

    A driver gives `display`, `read`, `_send` and `_release`; what it inherits keeps a bad frame
    from the actuators and brings them to rest before the device is let go. The rest is for devices
    that can do more, or fail.

    A device that can be lost and found (unplugged, silent) goes on by itself: as long as it is
    away `read` gives None, frames are dropped, and `take_events` tells what has happened.

    Attributes
    ----------
    display : Display
        Display that the device is, which stays the same as long as it is open.
    descriptor : int or None
        File descriptor that becomes readable when there may be a new pose, which then begins a
        tick; None for ticks at even times.
    rested : int
        How often the actuators went to rest otherwise than by a frame of 0, after which the next
        frames must fade in.
    taking : bool
        Whether frames reach the actuators. It is False while they rest by themselves.
    placing : Placing
        What the device waits for before it can tell places; `read` gives None until then.
    acknowledges : bool
        Whether the device tells which frames it has received.
    acknowledged_ns : int or None
        How long after a frame was written the device told that it had received it, of the last
        frame of which that is known; None before.
    watchdog_trips : int or None
        How often the device's watchdog brought the actuators to rest; None if it does not tell.
    tripped_ms : float or None
        How long after the last frame reached it the watchdog last tripped, by the device's clock.
    particulars : Particulars or None
        What else the device says of itself.
    serial_number : str
        Number of this very device, which tells it from others of its name; empty if none is known.
    calibration : Calibration or None
        What `calibrate` was told last, and makes up for.
    ahead_ns : int
        How long before each tick `ask` is called; 0 if it never is.
    """

    display: Display
    descriptor: int | None = None
    rested = 0
    taking = True
    placing = Placing.DONE
    acknowledges = False
    acknowledged_ns: int | None = None
    watchdog_trips: int | None = None
    tripped_ms: float | None = None
    particulars: Particulars | None = None
    serial_number = ""
    calibration: Calibration | None = None
    ahead_ns = 0
    _closed = False
    _correction: Correction | None = None

    @abstractmethod
    def read(self) -> Pose | None:
        """Newest pose since the last call, or None; this never waits.

        Raises
        ------
        DeviceError
            If the device is gone for good.
        """

    @abstractmethod
    def _send(self, frame: NDArray[np.float64]) -> bool | None:
        """Send a checked frame; this never waits. The array is the caller's: copy what is kept.

        Returns
        -------
        bool or None
            False if the frame was not sent, and the actuators stay as they are.
        """

    @abstractmethod
    def _release(self) -> None:
        """Let the device go; this is called once, after rest was sent."""

    def set_zero(self) -> None:
        """Take the carriage's place for the left stop: the reader says that it is there."""

    def take_events(self) -> Sequence[Event]:
        """Events since the last call, of the kinds of `vbraille.devices.events`."""
        return ()

    def ask(self) -> None:
        """Ask the device where it is, for the next tick to read; this never waits."""

    def counts(self) -> Mapping[str, int]:
        """Counts of what went wrong, by name: frames not sent, samples missed, corrupt messages."""
        return {}

    def calibrate(self, calibration: Calibration | None) -> None:
        """Make up for what was found of the actuators, from the next frame on, without a jump.

        What a frame asks for and what is recorded of it stays as it is: only what goes to the
        actuators differs. None sends deflections as they are.

        Raises
        ------
        DeviceError
            If the driver has a ``write`` of its own, which corrects nothing.
        """
        if type(self).write is not Device.write:
            raise DeviceError(
                f"the driver of {self.display.name} has a write of its own, which no calibration "
                f"reaches; tell its author to have _send only"
            )
        if self._correction is None:
            self._correction = Correction(self._shape, self.display.rate_hz)
        self._correction.aim(None if calibration is None else calibration.gains)
        self.calibration = calibration

    @property
    def moving(self) -> bool:
        """Tell whether actuators are on their way to what `calibrate` was told last."""
        return self._correction is not None and self._correction.moving

    def write(self, frame: NDArray[np.float64]) -> bool:
        """Send a frame; tell whether it was sent.

        Parameters
        ----------
        frame : float64[rows, columns]
            Deflections, each in [0, 1]; 0 is rest.

        Raises
        ------
        DeviceError
            If a deflection is not in [0, 1] or not a number, the frame is of
            another shape, or the device is closed or gone. Nothing is sent then.
        """
        if self._closed:
            raise DeviceError(f"{self.display.name} is closed")
        if frame.shape != self._shape:
            raise DeviceError(
                f"{self.display.name} has {self.display.rows} × {self.display.columns} actuators; "
                f"the frame has shape {frame.shape}"
            )
        if not self._in_range(np.ascontiguousarray(frame, np.float64)):
            raise DeviceError("a deflection is not in [0, 1]; the frame was not sent")
        if self._correction is not None:
            frame = self._correction.of(frame, self.rested)
        return self._send(frame) is not False

    @cached_property
    def _in_range(self) -> Callable[[NDArray[np.float64]], bool]:
        # numba is heavy, and those who only know of devices need none. numpy's `min` and `max` take
        # 20 µs of a tick of the host process, whose caches are cold.
        from vbraille.devices.levels import in_range

        return in_range

    @cached_property
    def _shape(self) -> tuple[int, int]:
        return self.display.shape

    def rest(self) -> None:
        """Send every actuator to rest at once."""
        self.write(np.zeros(self._shape))

    def close(self) -> None:
        """Bring every actuator to rest, then let the device go. Further calls do nothing."""
        if self._closed:
            return
        try:
            self.rest()
        finally:
            self._closed = True
            self._release()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
