"""The device that is read on, as one thing: its engine, and the simulated hand if it has one."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Self

from vbraille.devices.base import Device, Placing
from vbraille.devices.events import HandDone, HandHeld, NotInTime, told
from vbraille.devices.registry import find_driver
from vbraille.display import Pose
from vbraille.engine.engine import placing_of
from vbraille.engine.host import Host
from vbraille.errors import DeviceError
from vbraille.simulation.specs import is_simulated

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.engine.clock import Clock
    from vbraille.engine.record import Tally
    from vbraille.render import Model
    from vbraille.render.program import Program
    from vbraille.simulation.steering import HandOrder

HAND = "sweep:60"
POLL_S = 0.02
_STALE_NS = 30_000_000  # a hand that is done sooner was done with the order before


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

    Raises
    ------
    InputError
        If there is no such device.

    Attributes
    ----------
    engine : Engine
        Engine that drives the device.
    placing : Placing
        What the device waits for before it knows where its carriage is; see `set_zero`.
    held : bool
        Whether a person holds the simulated hand.
    hand_done : bool
        Whether a simulated hand has followed its last order; False for a person's.
    once : bool
        Whether a simulated hand is recorded, and reads no more than it has recorded.
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
    ) -> None:
        self.placing = Placing.DONE
        self.held = self.hand_done = self._simulated = False
        self.once = hand.startswith("recorded:")
        self.starts = self._given_ns = 0
        self._wanted = wanted
        self._model: Model | None = None
        self._given = device if isinstance(device, Device) else None
        if isinstance(device, Device):
            # A host process loads the compiled code by itself.
            from vbraille.engine.clock import RealClock
            from vbraille.engine.loop import LocalEngine

            rate_hz = min(wanted.rate_hz, device.display.rate_hz)
            how = {"rate_hz": rate_hz, "poll_ticks": max(1, round(POLL_S * rate_hz))}
            self.engine: Any = LocalEngine(device, clock or RealClock(), **how)
        else:
            find_driver(device)  # refused before a process is begun
            self._simulated = is_simulated(device)
            self.engine = Host(device, wanted, hand=hand, seed=seed, fits=False, often=often)

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
        return self._wanted if self._simulated else self.engine.start()

    def start(self, model: Model) -> None:
        """Drive the device, or drive it again after a `HostDiedError`.

        Lines are shown in the style of the model.

        Raises
        ------
        VbrailleError
            If the device cannot be opened.
        """
        self.placing = Placing.DONE
        self._model = replace(model, display=self.engine.start())
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
        tick = self.engine.newest
        if tick is None or self.engine.x_mm is None:
            return None
        x_mm, y_mm, theta_rad = (float(tick[name]) for name in ("x_mm", "y_mm", "theta_rad"))
        return Pose(int(tick["device_ns"]), x_mm, y_mm, theta_rad)

    @property
    def frame(self) -> NDArray[np.float32] | None:
        """Frame sent last, float32[rows, columns], 0 to 1; None before the first poll."""
        newest = self.engine.newest
        return None if newest is None else newest["frame"].copy()

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
        return self.engine.steered

    def put(self, program: Program, number: int) -> None:
        """Put a picture under the hand; what it replaces fades. Ticks have its number."""
        self.engine.show(program, number)

    def give(self, order: HandOrder) -> None:
        """Tell a simulated hand what to do; a person's hand does as it likes."""
        newest = self.engine.newest
        self._given_ns = 0 if newest is None else int(newest["device_ns"])
        self.hand_done = False
        self.engine.give(order)

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
        if wait_s and self._given is None:
            time.sleep(wait_s)
        ticks = self.engine.poll()
        events = list(self.engine.take_events())
        for event in events:
            if isinstance(event, HandHeld):
                self.held = event.held
            elif isinstance(event, HandDone):
                self.hand_done = event.at_ns > self._given_ns + _STALE_NS
        # That its ticks may come late does not matter to a device that is not there.
        said = told([one for one in events if not (self.steered and isinstance(one, NotInTime))])
        if ticks.size:
            self.placing = placing_of(ticks[-1])
        return ticks, events, said

    def close(self) -> None:
        """Bring the array to rest, then let the device go. Further calls do nothing."""
        given, self._given = self._given, None
        try:
            self.engine.close()
        finally:
            if given is not None:
                given.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
