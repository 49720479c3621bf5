"""The device that is read on, as one thing: its engine, and the simulated hand if it has one."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Self

from vbraille.devices.base import Device, Placing
from vbraille.devices.events import NotInTime, told
from vbraille.devices.registry import check_actuators, find_driver
from vbraille.display import Pose
from vbraille.engine.engine import Upright, placing_of
from vbraille.engine.host import Host, HostDiedError
from vbraille.errors import DeviceError
from vbraille.render import model_of
from vbraille.simulation.specs import device_spec, has_hand, is_simulated, parse_hand, steering_of
from vbraille.simulation.steering import BeAt

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.engine.clock import Clock
    from vbraille.engine.record import Tally
    from vbraille.render import Model
    from vbraille.render.program import Program
    from vbraille.simulation.steering import HandOrder, Pointer

HAND = "sweep:60"
POLL_S = 0.02
_ROOM = 1 << 22  # bytes of a picture
_MOST_MM = 0.001

__all__ = ["HAND", "POLL_S", "HostDiedError", "ReadingDevice", "wanted_model"]


class ReadingDevice:
    """A device with the engine that drives it. A context manager; on exit it goes to rest.

    Parameters
    ----------
    device
        Spec of the device, such as "sim" or "serial:/dev/ttyACM0", which a process of its own
        drives; or a device itself, which is driven here, as long as it is polled.
    wanted
        Display and rate that are asked for: a simulated device is made like this, a real device is
        what it is.
    often
        Whether the device must take frames at that rate; otherwise it is sent them at its own rate
        where that is lower.
    hand, seed
        Hand that moves a simulated device, and seed of what is random in it.
    clock
        Clock for a device that was given itself; None for the machine's.
    pointer
        Where a person may hold the hand of a simulated device; None if no person can.

    Raises
    ------
    InputError
        If there is no such device or hand.

    Attributes
    ----------
    engine : Host or LocalEngine
        Engine that drives the device.
    placing : Placing
        What the device waits for before it knows where its carriage is; see `set_zero`.
    starts : int
        How often it was started.
    """

    def __init__(
        self,
        device: str | Device,
        wanted: Display,
        *,
        often: bool = True,
        hand: str = HAND,
        seed: int = 1,
        clock: Clock | None = None,
        pointer: Pointer | None = None,
    ) -> None:
        self.placing = Placing.DONE
        self.starts = 0
        self.pointer: Pointer | None = None
        self._wanted = wanted
        self._model: Model | None = None
        self._newest: np.void | None = None
        self._upright = Upright()
        self._steering = self._given = None
        self._simulated = False
        self.once = hand.startswith("recorded:")  # it reads no more than it has recorded
        if isinstance(device, Device):
            self._given = device
            self.engine: Any = self._local_engine(device, clock)
            return
        find_driver(device)  # refused before a process is begun
        self._simulated = is_simulated(device)
        # A hand that waits to be moved is right where a person moves the device itself.
        parse_hand(hand, seed, pointed=pointer is not None or not has_hand(device))
        self._steering = steering_of(device)
        self.once = self.once and self._steering is not None
        if self._steering is not None:
            self.pointer = pointer
        channels = [each for each in (self._steering, self.pointer) if each is not None]
        self.engine = Host(
            device_spec(device, hand, seed, self._steering, self.pointer),
            wanted,
            often=often,
            pass_fds=[each.descriptor for each in channels],
        )

    def _local_engine(self, device: Device, clock: Clock | None) -> Any:
        """Engine that drives a device in this process."""
        # A host process loads the compiled code by itself.
        from vbraille.engine.clock import RealClock
        from vbraille.engine.loop import LocalEngine
        from vbraille.simulation.recorded import Recorded

        self._steering = getattr(device, "steering", None)
        self.pointer = getattr(device, "pointer", None)
        self.once = isinstance(getattr(device, "hand", None), Recorded)
        rate_hz = min(self._wanted.rate_hz, device.display.rate_hz)
        return LocalEngine(
            device,
            RealClock() if clock is None else clock,
            rate_hz=rate_hz,
            poll_ticks=max(1, round(POLL_S * rate_hz)),
        )

    def launch(self) -> None:
        """Begin the process of a simulated device, which loads while a book is opened."""
        if self._simulated:
            self.engine.launch()

    def find(self) -> Display:
        """Find out what the device is; other devices than a simulated one are opened for that.

        Raises
        ------
        VbrailleError
            If the device cannot be opened.
        """
        if self._simulated:
            return self._wanted
        return self.engine.open() if isinstance(self.engine, Host) else self.engine.display

    def start(self, model: Model, room: int = _ROOM) -> None:
        """Drive the device; pictures have at most so many bytes.

        Raises
        ------
        VbrailleError
            If the device cannot be opened.
        """
        self._model = model
        if isinstance(self.engine, Host):
            self.engine.fit(model.display, room)
        self.engine.start()
        self.starts += 1

    def start_again(self) -> None:
        """Drive the device again, after a `HostDiedError`."""
        self.placing = Placing.DONE
        self.engine.start()
        self.starts += 1

    @property
    def model(self) -> Model:
        """Display, and the style in which it was started.

        Raises
        ------
        DeviceError
            If it was not started.
        """
        if self._model is None:
            raise DeviceError("the device is not open; start it first")
        return self._model

    @property
    def display(self) -> Display:
        """The actuators and the carriage."""
        return self.model.display

    @property
    def x_mm(self) -> float | None:
        """Place of the array's centre along the line at the last poll; None if not known."""
        return self.engine.x_mm

    @property
    def pose(self) -> Pose | None:
        """Pose of the array at the last poll, by the device's clock; None if not known."""
        tick = self._newest
        if tick is None or self.engine.x_mm is None:
            return None
        x_mm, y_mm, theta_rad = (float(tick[name]) for name in ("x_mm", "y_mm", "theta_rad"))
        return Pose(int(tick["device_ns"]), x_mm, y_mm, theta_rad)

    @property
    def frame(self) -> NDArray[np.float32] | None:
        """Frame sent last, float32[rows, columns], 0 to 1; None before the first poll."""
        return None if self._newest is None else self._newest["frame"].copy()

    @property
    def paused(self) -> bool:
        """Tell whether the array rests; setting it has the array rest at once, or go on."""
        return self.engine.paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self.engine.paused = paused

    @property
    def tally(self) -> Tally:
        """Counts of what the loop has done so far, such as ticks and late ticks."""
        return self.engine.tally

    @property
    def counts(self) -> dict[str, int]:
        """Counts of what went wrong with the device, by name; known after `close`."""
        return self.engine.counts

    @property
    def steered(self) -> bool:
        """Tell whether a simulated hand moves the device."""
        return self._steering is not None

    @property
    def held(self) -> bool:
        """Tell whether a person holds the simulated hand."""
        return self.pointer is not None and self.pointer.held

    def put(self, program: Program, number: int) -> None:
        """Put a picture under the hand; what it replaces fades. Ticks have its number."""
        self.engine.show(program, number)

    def give(self, order: HandOrder) -> None:
        """Tell a simulated hand what to do; a person's hand does as it likes."""
        if self._steering is not None:
            self._steering.give(order)

    def hold(self, x_mm: float, y_mm: float, theta_rad: float) -> None:
        """Hold a simulated hand at a pose, as a person on a page of the live view does."""
        if self.pointer is not None:
            self.pointer.hold(BeAt(x_mm, y_mm, theta_rad))

    def let_go(self) -> None:
        """Let a hand that is held go on by itself."""
        if self.pointer is not None:
            self.pointer.let_go()

    def ring(self) -> Any:
        """Reader of the records of ticks, for the live view; another after each start."""
        return self.engine._ring

    def hand_done(self) -> bool:
        """Tell whether a simulated hand has followed its last order; False for a person's."""
        newest = self._newest
        if self._steering is None or newest is None:
            return False
        return self._steering.done_at(int(newest["device_ns"]))

    def set_zero(self) -> None:
        """Say that the carriage is at its stop now, which `placing` may wait for."""
        self.engine.set_zero()

    def take(self, wait_s: float = 0.0) -> tuple[NDArray[np.void], list[Event], list[str]]:
        """Take the ticks and events since the last poll, and sentences on them.

        Raises
        ------
        VbrailleError
            If the device is gone: its fault, or `HostDiedError`, after which it can be started
            again.
        """
        if wait_s and isinstance(self.engine, Host):
            time.sleep(wait_s)
        ticks = self.engine.poll()
        events = list(self.engine.take_events())
        # That its ticks may come late does not matter to a device that is not there.
        said = told([one for one in events if not (self.steered and isinstance(one, NotInTime))])
        if ticks.size:
            self._newest = ticks[-1]
            self.placing = placing_of(ticks[-1])
            said.extend(self._upright.watch(ticks[-1]))
        return ticks, events, said

    def close(self) -> None:
        """Bring the array to rest, then let the device go. Further calls do nothing."""
        given, self._given = self._given, None
        if isinstance(self.engine, Host):
            self.engine.close()
        elif given is not None:
            try:
                self.engine.close()
            finally:
                given.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def wanted_model(
    device: ReadingDevice, asked: Model | None, *, geometry_given: bool = False
) -> Model:
    """Model of a device that was found: as it was asked for, on the display that there is.

    Raises
    ------
    VbrailleError
        If the device cannot be opened, or has other actuators than were asked for.
    """
    found = device.find()
    if asked is None:
        usual = model_of(found)
        return replace(usual, style=usual.style.replace(travel_mm=found.travel_mm))
    check_actuators(found, asked.display)
    if not geometry_given and abs(found.travel_mm - asked.style.geometry.travel_mm) > _MOST_MM:
        asked = replace(asked, style=asked.style.replace(travel_mm=found.travel_mm))
    return replace(asked, display=found)
