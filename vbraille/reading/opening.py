"""Open a device for a program: found, checked against what is asked for, and driven."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.devices.base import Device
from vbraille.devices.registry import check_actuators, check_travel
from vbraille.display import check_rate
from vbraille.errors import InputError
from vbraille.reading.asked import check_asked
from vbraille.reading.opened import HAND, OpenDevice
from vbraille.render.braille.models import STRESS2, Model, model_of
from vbraille.simulation.specs import refuse_hand

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.display import Display
    from vbraille.engine.clock import Clock
    from vbraille.render.braille.style import BrailleStyle


def open_to_read(
    device: str | Device,
    display: Model | Display | None = None,
    *,
    style: BrailleStyle | None = None,
    hand: str | None = None,
    seed: int | None = None,
    rate_hz: float = 1000.0,
    clock: Clock | None = None,
    say: Callable[[str], None] = lambda _: None,
) -> OpenDevice:
    """Open a device to be read on; use it in a ``with`` block, which brings it to rest at the end.

    Parameters
    ----------
    device
        Spec of the device: "sim" for a simulated one, "serial:/dev/ttyACM0", or a kind of a
        driver that is installed. A process of its own then drives it. Or a `Device` itself,
        which is driven by this process, as long as the program polls it.
    display
        Display that the device must have; None for whatever it has. A simulated device has this
        display, or a STReSS².
    style
        How braille is shown; None for how the display is read unless told otherwise.
    hand, seed
        Hand that moves the simulated device, "sweep:60" if not given, and seed of what is random
        in it.
    rate_hz
        Frames a second, 1 to 10,000.
    clock
        Clock for a `Device` that is given itself; None for the machine's. A clock of
        `vbraille.testing` is turned by hand, and lets a text be read as fast as the machine can.
    say
        Function that is called with each thing that the reader should hear.

    Raises
    ------
    InputError
        If an argument cannot be used.
    DeviceError
        If the device cannot be opened.

    Examples
    --------
    >>> import vbraille
    >>> from vbraille.testing import ManualClock, simulated_device
    >>> clock = ManualClock()
    >>> device = simulated_device(vbraille.STRESS2, hand="sweep:150", clock=clock)
    >>> with vbraille.open(device, clock=clock) as opened:
    ...     for line in opened.read("Two lines of braille, read by a hand that sweeps over them"):
    ...         print(line.number, line.text.strip())
    1 Two lines of braille, read by
    2 a hand that sweeps over them
    """
    if not isinstance(device, str | Device):
        if isinstance(device, type):
            name = device.__name__
            raise InputError(f"{name} is a class; give a device of it, as in open({name}())")
        raise InputError(f"device is {device!r}; give a spec such as 'sim', or a vbraille.Device")
    check_asked(display, style)
    if isinstance(device, str):
        refuse_hand(device, hand=hand, seed=seed)
    check_rate(rate_hz)
    asked = display.display if isinstance(display, Model) else display
    opened = OpenDevice(
        device,
        replace(STRESS2.display if asked is None else asked, rate_hz=rate_hz),
        hand=HAND if hand is None else hand,
        seed=1 if seed is None else seed,
        clock=clock,
        say=say,
    )
    try:
        found = opened.find()
        if asked is not None:
            check_actuators(found, asked)
        model = replace(display, display=found) if isinstance(display, Model) else model_of(found)
        if style is not None:
            check_travel(found, style.geometry.travel_mm)
            model = replace(model, style=style)
        else:
            geometry = replace(model.style.geometry, travel_mm=found.travel_mm)
            model = replace(model, style=model.style.replace(geometry=geometry))
        opened.start(model)
    except BaseException:  # a signal's exception, too
        opened.close()
        raise
    return opened
