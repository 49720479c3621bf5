"""Devices made of software, ready to be opened by a test."""

from __future__ import annotations

from contextlib import contextmanager
from threading import Event, Thread
from typing import TYPE_CHECKING

from vbraille.devices.wire.messages import Encoder
from vbraille.engine.clock import RealClock
from vbraille.render.braille.models import STRESS2, Model
from vbraille.simulation.firmware import describe
from vbraille.simulation.pty import Port
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.simulation.simulator import Simulator
from vbraille.simulation.specs import parse_hand
from vbraille.simulation.steering import Steering

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.display import Display
    from vbraille.engine.clock import Clock
    from vbraille.simulation.simulator import Faults


def simulated_device(
    display: Model | Display = STRESS2,
    *,
    hand: str = "sweep:60",
    seed: int = 1,
    clock: Clock | None = None,
) -> SimulatedDevice:
    """A device in memory, whose hand reads what is shown on it.

    Parameters
    ----------
    display
        What it is.
    hand, seed
        What moves its carriage, as of `parse_hand`.
    clock
        What it lives by; None for the machine's.

    Raises
    ------
    InputError
        If there is no such hand.

    Examples
    --------
    >>> from vbraille.testing import simulated_device
    >>> with simulated_device() as device:
    ...     round(device.read().x_mm, 3)
    -5.4
    """
    info = display.display if isinstance(display, Model) else display
    now_ns = (RealClock() if clock is None else clock).now_ns
    return SimulatedDevice(info, now_ns, parse_hand(hand, seed), Steering())


@contextmanager
def simulated_controller(
    display: Model | Display = STRESS2,
    *,
    hand: str = "sweep:60",
    seed: int = 1,
    encoder: str = "absolute",
    faults: Faults | None = None,
    say: Callable[[str], None] = lambda _: None,
) -> Iterator[str]:
    """Run a controller at a port, in a thread, in real time; give the spec that opens it.

    Parameters
    ----------
    display
        What it is; its rate is 50 Hz or more, and whole.
    hand, seed
        What moves its carriage, as of `parse_hand`.
    encoder
        What it knows of its place when it starts: "absolute", "index" or "incremental".
    faults
        How it misbehaves.
    say
        Is told what happens, a sentence each.

    Raises
    ------
    InputError
        If there is no such hand.
    ValueError
        If the wire has no room for a number of the display.

    Examples
    --------
    >>> from vbraille.devices import open_device
    >>> from vbraille.testing import simulated_controller
    >>> with simulated_controller() as spec, open_device(spec, None) as device:
    ...     device.display.name
    'simulated STReSS²'
    """
    info = display.display if isinstance(display, Model) else display
    port, stopped = Port(), Event()
    try:
        described = describe(info, Encoder[encoder.upper()])
        simulator = Simulator(described, parse_hand(hand, seed), port, say=say, faults=faults)
        thread = Thread(target=simulator.run, args=(stopped.is_set,), daemon=True)
        thread.start()
        try:
            yield f"serial:{port.path}"
        finally:
            stopped.set()
            thread.join()
    finally:
        port.unplug()
