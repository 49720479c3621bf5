"""``vbraille device``: which there are, what one is, and whether it is fit to be read on."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING

from vbraille.cli.old.commands.calibrate import calibrate, say_calibration
from vbraille.cli.old.exploring import opened_in_time
from vbraille.cli.old.terminal import print_json, say_line
from vbraille.devices.registry import find_driver
from vbraille.engine.checkup import check, warm_up
from vbraille.engine.clock import RealClock
from vbraille.engine.realtime import go_real_time
from vbraille.files import settings_path
from vbraille.render import MODELS
from vbraille.signals import EAR

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Sequence

    from vbraille.devices import Device
    from vbraille.display import Display


def run(arguments: argparse.Namespace) -> int:
    """List, describe or check."""
    if arguments.action == "list":
        return _list(as_json=arguments.json)
    if arguments.action == "calibrate":
        return calibrate(arguments, _wanted(arguments))
    if arguments.action == "check":
        find_driver(arguments.spec)
        with nullcontext():
            warm_up(_wanted(arguments) or MODELS["stress2"].display)
    with opened_in_time(arguments.spec, _wanted(arguments)) as device:
        if arguments.action == "info" and arguments.json:
            told = device.particulars
            print_json({"display": asdict(device.display), "particulars": told and asdict(told)})
            return 0
        say = partial(say_line, aside=arguments.json)
        _describe(device, say)
        if arguments.action == "info":
            say_calibration(device, settings_path())
            return 0
        try:
            return _check(device, say, as_json=arguments.json)
        finally:
            EAR.close()  # so that the array goes to rest


def _list(*, as_json: bool) -> int:
    from serial.tools import list_ports

    ports = sorted(list_ports.comports())
    if as_json:
        print_json(
            [
                {
                    "device": f"serial:{port.device}",
                    "name": None if port.description == "n/a" else port.description,
                    "id": None if port.vid is None else f"{port.vid:04x}:{port.pid:04x}",
                    "serial_number": port.serial_number,
                }
                for port in ports
            ]
        )
        return 0
    for port in ports:
        ids = "" if port.vid is None else f", id {port.vid:04x}:{port.pid:04x}"
        number = f", serial number {port.serial_number}" if port.serial_number else ""
        name = port.description if port.description != "n/a" else "no name"
        say_line(f"port: serial:{port.device}, {name}{ids}{number}")
    if not ports:
        say_line("port: none; plug the device in")
    return 0


def _wanted(arguments: argparse.Namespace) -> Display | None:
    if arguments.model is None:
        return None
    return MODELS[arguments.model].display


def _describe(device: Device, say: Callable[[str], None]) -> None:
    info, told = device.display, device.particulars
    say(f"name: {info.name}")
    say(f"actuators: {info.rows} row{'s' * (info.rows > 1)} of {info.columns}")
    say(f"pitch: {info.column_pitch_mm:g} mm along the line, {info.row_pitch_mm:g} mm across")
    say(f"levels: {info.levels}")
    say(f"rest side: {info.rest_side}")
    say(f"travel: {info.travel_mm:g} mm")
    say(f"axes: {_axes(info)}")
    if info.contactor_mm is not None:
        width_mm, height_mm = info.contactor_mm
        say(f"contactor: {width_mm:g} mm wide, {height_mm:g} mm high")
    say(f"encoder: {info.counts_per_mm:g} counts a mm{f', {told.encoder}' if told else ''}")
    say(f"rate: {info.rate_hz:g} Hz")
    if told is None:
        return
    slew = told.largest_slew_per_s
    if told.protocol:
        say(f"protocol: {told.protocol}")
    if told.buttons is not None and told.knobs is not None:
        say(f"buttons: {told.buttons}")
        say(f"knobs: {told.knobs}")
    say(f"firmware: {told.firmware or 'it does not say'}")
    say(f"slew: {f'at most {slew:g} full swings a second' if slew else 'without a limit'}")
    say(f"disabled actuators: {_places(told.disabled, info)}")
    say(f"inverted actuators: {_places(told.inverted, info)}")


def _axes(info: Display) -> str:
    """Axes along which the carriage is measured, in words."""
    across = f" and across, {info.height_mm:g} mm" if info.height_mm else ""
    return f"along the line{across}{', and the angle' * info.turns}"


def _places(actuators: Sequence[tuple[int, int]], info: Display) -> str:
    if not actuators:
        return "none"
    if len(actuators) == info.rows * info.columns:
        return f"all {len(actuators)}"
    return "; ".join(f"row {row + 1}, column {column + 1}" for row, column in actuators)


def _check(device: Device, say: Callable[[str], None], *, as_json: bool) -> int:
    refused = go_real_time()
    if refused is not None:
        say(refused.say())
    found = check(device, RealClock(), say)
    if as_json:
        print_json(found.to_json())
    return 0 if found.fit else 1
