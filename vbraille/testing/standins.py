"""Devices made of software, ready to be opened by a test."""

from __future__ import annotations

from contextlib import contextmanager
from threading import Event, Thread
from typing import TYPE_CHECKING

from vbraille.devices.serial.wire import Encoder
from vbraille.engine.clock import RealClock
from vbraille.render.braille.models import STRESS2, Model, check_shown, model_of
from vbraille.simulation.carriage import area_of
from vbraille.simulation.controls import Controls, parse_presses, parse_script
from vbraille.simulation.firmware import describe
from vbraille.simulation.pty import Port
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.simulation.simulator import Simulator
from vbraille.simulation.specs import parse_hand
from vbraille.simulation.steering import Steering

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from vbraille.display import Display
    from vbraille.engine.clock import Clock
    from vbraille.simulation.simulator import Faults
    from vbraille.simulation.steering import Pointer


def simulated_device(
    display: Model | Display = STRESS2,
    *,
    hand: str = "sweep:60",
    seed: int = 1,
    clock: Clock | None = None,
    pointer: Pointer | None = None,
) -> SimulatedDevice:
    """Make a device in memory, whose hand reads what is shown on it.

    Its `press`, `let_go` and `turn` are what a finger does to buttons and knobs.

    Parameters
    ----------
    display
        Display of the device.
    hand, seed
        Hand that moves the carriage, and its seed, as in `parse_hand`.
    clock
        Clock of the device; None for the machine's.
    pointer
        Where a person may hold the hand; None if no person can.

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
    moved = parse_hand(hand, seed, pointed=pointer is not None)
    return SimulatedDevice(info, now_ns, moved, Steering(), pointer=pointer)


@contextmanager
def simulated_controller(
    display: Model | Display = STRESS2,
    *,
    hand: str = "sweep:60",
    seed: int = 1,
    encoder: str = "absolute",
    faults: Faults | None = None,
    presses: Sequence[str] = (),
    script: str = "",
    say: Callable[[str], None] = lambda _: None,
) -> Iterator[str]:
    """Run a controller at a port, in a thread, in real time; give the spec that opens it.

    Parameters
    ----------
    display
        Display of the device; its rate must be 50 Hz or more, and whole.
    hand, seed
        Hand that moves the carriage, and its seed, as in `parse_hand`.
    encoder
        What the encoder knows of its place at the start: "absolute", "index" or "incremental".
    faults
        Ways in which the controller misbehaves; None for none.
    presses
        Presses of its buttons after the first greeting, such as "1@2.5s", or "1@2.5s-4s" for a
        button that is held.
    script
        Lines of times and what is then done to buttons and knobs, such as "2.5s press 1",
        "3s release 1" and "4s knob 1 0.8".
    say
        Function that is told what happens, a sentence at a time.

    Raises
    ------
    InputError
        If there is no such hand, or a press or a line of the script is none.
    ValueError
        If a number of the display does not fit into its field on the wire.

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
        simulator = Simulator(
            described,
            parse_hand(hand, seed),
            port,
            say=say,
            faults=faults,
            area=area_of(info, model_of(info).style.geometry.line_pitch_mm),
            controls=Controls(
                (*parse_script(script, "the script"), *parse_presses(",".join(presses)))
            ),
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
