"""``vbraille simulate``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

from vbraille.cli.old.controlkeys import ControlKeys
from vbraille.cli.old.terminal import say_line
from vbraille.config.options import LATERO
from vbraille.devices.serial.wire import Encoder
from vbraille.engine.realtime import come_first
from vbraille.errors import InputError
from vbraille.render.braille.models import MODELS
from vbraille.signals import EAR
from vbraille.simulation.carriage import area_of
from vbraille.simulation.controls import Controls, load_script, parse_presses
from vbraille.simulation.firmware import describe
from vbraille.simulation.pty import Link, Port
from vbraille.simulation.simulator import Defect, Faults, Simulator
from vbraille.simulation.specs import parse_hand

if TYPE_CHECKING:
    import argparse
    from collections.abc import Mapping

    from vbraille.devices.serial.wire import Info
    from vbraille.display import Display

# Options that only one kind of device has, and what they are when they are not given.
LATERO_ONLY: Final[Mapping[str, object]] = dict.fromkeys(LATERO)
SERIAL_ONLY: Final[dict[str, object]] = {
    "model": "stress2",
    "rate": 1000,
    "link": None,
    "encoder": "absolute",
    "travel": None,
    "axes": "x",
    "height": None,
    "corrupt": 0.0,
    "stall": 0.0,
    "unplug_every": 0.0,
    "defect": None,
}
# Above the engine's 40: a real controller has a processor of its own.
PRIORITY = 41
# Way of a carriage of two axes across the lines, for which there is no option.
HEIGHT_MM = 200.0
KEYS = "1 to 8 press a button, a to d turn a knob up, A to D turn it down"


def run(arguments: argparse.Namespace) -> int:
    """Be a device until a signal says to stop."""
    if arguments.what == "latero":
        from vbraille.cli.old.commands import simulate_latero

        _refuse(arguments, SERIAL_ONLY)
        return simulate_latero.run(arguments, PRIORITY)
    _refuse(arguments, LATERO_ONLY)
    display = _display(arguments)
    info = _info(arguments, display)
    hand = parse_hand(arguments.hand, arguments.seed)
    script = () if arguments.script is None else load_script(arguments.script)
    controls = Controls((*script, *parse_presses(arguments.press)))
    area = area_of(display, MODELS[arguments.model].style.geometry.line_pitch_mm)
    if arguments.unplug_every and arguments.link is None:
        raise InputError("--unplug-every needs --link, for the port has a new name each time")
    try:
        faults = Faults(
            drop=arguments.drop,
            corrupt=arguments.corrupt,
            stall_s=arguments.stall,
            unplug_every_s=arguments.unplug_every,
            defect=None if arguments.defect is None else Defect(arguments.defect),
            seed=arguments.seed,
        )
    except ValueError as error:
        raise InputError(str(error)) from None
    with EAR.deferred(), ControlKeys() as keys:
        port = Port(Link(arguments.link) if arguments.link is not None else None)
        try:
            simulator = Simulator(
                info,
                hand,
                port,
                say=say_line,
                faults=faults,
                area=area,
                controls=controls,
                keys=keys.pressed,
            )
            say_line(f"port: {port.path}")
            if arguments.link is not None:
                say_line(f"link: {arguments.link}")
            if keys.attached:
                say_line(f"keys: {KEYS}")
            come_first(PRIORITY)
            simulator.run(stopped=lambda: EAR.heard)
        finally:
            port.unplug()
    say_line(_summary(simulator))
    return 0


def _refuse(arguments: argparse.Namespace, others: Mapping[str, object]) -> None:
    """Raise InputError if an option is given that another kind of device has."""
    for name, left_out in others.items():
        if getattr(arguments, name) != left_out:
            raise InputError(
                f"--{name.replace('_', '-')} is not for a simulated {arguments.what} device; leave "
                f"it out"
            )


def _display(arguments: argparse.Namespace) -> Display:
    """Display that it is to be, with the axes that are asked for."""
    model = MODELS[arguments.model]
    geometry = model.style.geometry
    if not (50 <= arguments.rate <= 10_000 and arguments.rate == int(arguments.rate)):
        raise InputError(f"rate is {arguments.rate:g} Hz; it must be 50 to 10000 Hz, and whole")
    try:
        if arguments.travel is not None:
            geometry = replace(geometry, travel_mm=arguments.travel)
        device = model.on(geometry, arguments.rate)
        return replace(device, height_mm=_height_mm(arguments), turns="θ" in arguments.axes)
    except ValueError as error:
        raise InputError(str(error)) from None


def _height_mm(arguments: argparse.Namespace) -> float:
    """Give the way of the carriage across the lines in mm; 0 for one axis."""
    if "y" in arguments.axes:
        own_mm = MODELS[arguments.model].display.height_mm or HEIGHT_MM
        height_mm = own_mm if arguments.height is None else arguments.height
        if not height_mm > 0:
            raise InputError(f"height is {height_mm:g} mm; it must be above 0")
        return height_mm
    if arguments.height is not None:
        raise InputError("--height is for a carriage of two axes; add --axes xy or --axes xyθ")
    return 0.0


def _info(arguments: argparse.Namespace, display: Display) -> Info:
    try:
        return describe(display, Encoder[arguments.encoder.upper()])
    except ValueError as error:
        raise InputError(str(error)) from None


def _summary(simulator: Simulator) -> str:
    controller = simulator.controller
    return (
        f"summary: seconds {simulator.now_us / 1e6:.1f}, frames {controller.frames}, "
        f"dropped {controller.dropped}, trips {controller.trips}, "
        f"states sent {simulator.states_sent}, states dropped {simulator.states_dropped}"
    )
