"""Devices made of software, ready to be opened by a test."""

from __future__ import annotations

from contextlib import contextmanager
from threading import Event, Thread
from typing import TYPE_CHECKING

from vbraille.engine.clock import RealClock
from vbraille.render.braille.models import STRESS2, Model, check_shown, model_of
from vbraille.simulation.carriage import area_of
from vbraille.simulation.controls import Controls, parse_moves
from vbraille.simulation.pty import Port
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.simulation.simulator import Simulator
from vbraille.simulation.specs import parse_hand

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
    """Make a device in memory, whose hand reads what is shown on it.

    Its `press` and `turn` are what a finger does to buttons and knobs.

    Parameters
    ----------
    display
        Display of the device.
    hand, seed
        Hand that moves the carriage, and its seed, as in `parse_hand`.
    clock
        Clock of the device; None for the machine's.

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
    check_shown(display)
    info = display.display if isinstance(display, Model) else display
    now_ns = (RealClock() if clock is None else clock).now_ns
    return SimulatedDevice(info, now_ns, parse_hand(hand, seed, pointed=True))


@contextmanager
def simulated_controller(
    display: Model | Display = STRESS2,
    *,
    hand: str = "sweep:60",
    seed: int = 1,
    placed: bool = True,
    faults: Faults | None = None,
    press: str = "",
    say: Callable[[str], None] = lambda _: None,
) -> Iterator[str]:
    """Run a controller at a port, in a thread, in real time; give the spec that opens it.

    Parameters
    ----------
    display
        Display of the device; its rate must divide 1000 and be 50 Hz or more.
    hand, seed
        Hand that moves the carriage, and its seed, as in `parse_hand`.
    placed
        Whether its encoders know where the carriage is; otherwise it waits for ZERO.
    faults
        Ways in which the controller misbehaves; None for none.
    press
        Moves of its buttons and knobs after the first greeting, such as
        "1@2.5s-4s, knob 1 0.8@4s".
    say
        Function that is told what happens, a sentence at a time.

    Raises
    ------
    InputError
        If there is no such hand, or a move is none.
    ValueError
        If the protocol has no room for the display.

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
        simulator = Simulator(
            info,
            parse_hand(hand, seed),
            port,
            say=say,
            faults=faults,
            placed=placed,
            area=area_of(info, model_of(info).style.geometry.line_pitch_mm),
            controls=Controls(parse_moves(press)),
        )
        thread = Thread(target=simulator.run, args=(stopped.is_set,), daemon=True)
        thread.start()
        try:
            yield f"serial:{port.path}"
        finally:
            stopped.set()
            thread.join()
    finally:
        port.unplug()
