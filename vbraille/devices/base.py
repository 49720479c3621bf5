"""A device: a place read, a frame written, rest on close."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Self

import numpy as np

from vbraille.devices.calibration import correction_for
from vbraille.devices.events import Placing
from vbraille.errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from vbraille.devices.calibration import Calibration, Correction
    from vbraille.devices.events import Event
    from vbraille.display import Display, Pose

_DOUBLE = np.dtype(np.float64)


@dataclass(frozen=True, slots=True)
class Particulars:
    """Facts of a device that only its builder asks for, and reading does not.

    Parameters
    ----------
    firmware
        Version of the device's firmware.
    encoder
        What the encoder knows of its place, in words.
    largest_slew_per_s
        Fastest that an actuator may be moved, in full swings a second; 0 for no limit.
    disabled, inverted
        Row and column, from 0, of each actuator that is broken, not fitted or without a swing,
        and of each whose rest is the highest level.
    protocol
        What the device speaks, with the version; empty if it does not say.
    buttons, knobs
        Number of buttons and of knobs that it has; None if it does not say.
    """

    firmware: str
    encoder: str
    largest_slew_per_s: float
    disabled: tuple[tuple[int, int], ...]
    inverted: tuple[tuple[int, int], ...]
    protocol: str = ""
    buttons: int | None = None
    knobs: int | None = None


class Device(ABC):
    """A device: `read`, `write`, `close`, and `info`. A context manager.

    A driver gives `info`, `read`, `_send` and `_release`; what it inherits
    keeps a bad frame from the actuators and brings them to rest before the
    device is let go. The rest is for devices that can do more, or fail.

    A device that can be lost and found (unplugged, silent) goes on by itself: as long as it is
    away `read` gives None, frames are dropped, and `take_events` tells what has happened.

    Attributes
    ----------
    display : Display
        Display that the device is, which stays the same as long as it is open.
    rested : int
        How often the actuators went to rest otherwise than by a frame of 0, after which the next
        frames must fade in.
    placing : Placing
        What the device waits for before it can tell places; `read` gives None until then.
    taking : bool
        Whether frames reach the actuators. It is False while they rest by themselves; after that
        frames fade in.
    acknowledges : bool
        Whether the device tells which frames it has received.
    acknowledged_ns : int or None
        How long after the last frame was written the device told that it had received it; None as
        long as it did not.
    watchdog_trips : int or None
        How often the device's watchdog brought the actuators to rest, by the device's own count;
        None if it does not tell.
    particulars : Particulars or None
        What else the device says of itself.
    serial_number : str
        Number of this very device, which tells it from others of its name; empty if none is known.
    calibration : Calibration or None
        What `correct` was told last, and makes up for.
    ahead_ns : int
        How long before each tick `ask` is called; 0 if it never is.
    """

    display: Display
    rested = 0
    placing = Placing.DONE
    taking = True
    acknowledges = False
    acknowledged_ns: int | None = None
    watchdog_trips: int | None = None
    particulars: Particulars | None = None
    serial_number = ""
    calibration: Calibration | None = None
    ahead_ns = 0
    _closed = False
    _correction: Correction | None = None

    @abstractmethod
    def read(self) -> Pose | None:
        """Newest sample since the last call, or None; this never waits.

        Raises
        ------
        DeviceError
            If the device is gone.
        """

    @abstractmethod
    def _send(self, frame: NDArray[np.float64]) -> None:
        """Send a checked frame; this never waits. The array is the caller's: copy what is kept."""

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

    @property
    def has_own_gains(self) -> bool:
        """Tell whether the device itself makes up for unequal actuators, so that no host must."""
        told = self.particulars
        return told is not None and bool(told.disabled or told.inverted)

    def correct(self, calibration: Calibration | None) -> None:
        """Make up for what was found of the actuators, from the next frame on, without a jump.

        What a frame asks for and what is recorded of it stays as it is: only what goes to the
        actuators differs.

        Parameters
        ----------
        calibration
            What was found, for an array of this shape; None to send deflections as they are.

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
            self._correction = correction_for(self._shape, self.display.rate_hz)
        self._correction.aim(calibration)
        self.calibration = calibration

    def uncorrect(self) -> bool:
        """Have inverted actuators go to where the device itself rests, by the next frames of rest.

        Returns
        -------
        bool
            Whether they are still on their way, and want another frame.
        """
        if self._correction is None:
            return False
        self._correction.leave()
        return self._correction.moving

    def write(self, frame: NDArray[np.float64]) -> None:
        """Send a frame.

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
        if not self._allows(frame):
            raise DeviceError("a deflection is not in [0, 1]; the frame was not sent")
        correction = self._correction
        self._send(frame if correction is None else correction.of(frame, self.rested))

    @cached_property
    def _allows(self) -> Callable[[NDArray[np.float64]], bool]:
        """Tell whether all deflections of a frame are in [0, 1]."""
        # numba is heavy, and those who only know of devices need none.
        from vbraille.devices.framekernels import in_range

        def allows(frame: NDArray[np.float64]) -> bool:
            if frame.dtype is _DOUBLE and frame.flags.carray:  # for others nothing is compiled
                return in_range(frame)
            return bool(frame.min() >= 0.0 and frame.max() <= 1.0)

        return allows

    @cached_property
    def _shape(self) -> tuple[int, int]:
        return self.display.rows, self.display.columns

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
