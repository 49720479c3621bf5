"""``vbraille device``."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import asdict
from typing import TYPE_CHECKING

import click

from vbraille.cli import options
from vbraille.cli.printing import print_json, say, show

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.devices import Device
    from vbraille.devices.calibration import Calibration

_spec = click.argument("spec")
_model = options.model(group=options.FIRST, help="Display model that the device must be.")


@click.group(cls=options.Group)
def command() -> None:
    """A device is named by its spec, such as serial:/dev/ttyACM0 or latero:HOST."""


@command.action("device list", options.json, name="list")
def list_ports(json: bool) -> None:
    """List the serial ports, and the kinds of devices that drivers are installed for."""
    from serial.tools import list_ports as ports

    from vbraille.devices.registry import drivers

    rows = [
        {
            "device": f"serial:{port.device}",
            "name": None if port.description == "n/a" else port.description,
            "id": None if port.vid is None else f"{port.vid:04x}:{port.pid:04x}",
            "serial_number": port.serial_number,
        }
        for port in sorted(ports.comports())
    ]
    kinds = [{"kind": kind, "module": module} for kind, module in drivers()]
    lines = [] if rows else ["port: none; plug the device in"]
    for row in rows:
        named = f"port: {row['device']}, {row['name'] or 'no name'}"
        named += f", id {row['id']}" if row["id"] else ""
        number = row["serial_number"]
        lines.append(f"{named}, serial number {number}" if number else named)
    lines += [f"driver: {kind['kind']}, of {kind['module']}" for kind in kinds]
    show(lines, {"ports": rows, "drivers": kinds}, as_json=json)


@command.action("device info serial:/dev/ttyACM0", _spec, _model, options.json)
def info(spec: str, model: str | None, json: bool) -> None:
    """Describe a device."""
    with _opened(spec, model) as device:
        if json:
            told = device.particulars
            display = asdict(device.display)
            print_json({"display": display, "particulars": told and asdict(told)})
            return
        for label, value in _described(device).items():
            say(f"{label}: {value}")
        _say_calibration(device)


@command.action("device check serial:/dev/ttyACM0 --model stress2", _spec, _model, options.json)
def check(spec: str, model: str | None, json: bool) -> int:
    """Measure whether a person can read on a device.

    Each actuator swings; the rate, the clock, the round trip and the watchdog are measured.
    """
    from vbraille.engine.checkup import Checkup
    from vbraille.engine.clock import RealClock
    from vbraille.engine.realtime import go_real_time
    from vbraille.signals import EAR

    def tell(sentence: str) -> None:
        say(sentence, aside=json)

    with _opened(spec, model) as device:
        for label, value in _described(device).items():
            tell(f"{label}: {value}")
        try:
            if refused := go_real_time():
                tell(refused.say())
            found = Checkup(device, RealClock(), tell)
            fit = found.run()
        finally:
            EAR.close()  # so that the array goes to rest
    if json:
        print_json(found.to_json())
    return 0 if fit else 1


@command.action(
    "device calibrate serial:/dev/ttyACM0",
    _spec, _model,
    options.option("--show", is_flag=True, help="Print the calibration, and do nothing else."),
    options.option("--forget", is_flag=True, help="Delete the calibration."),
    options.json(help="With --show: print JSON."),
)  # fmt: skip
def calibrate(spec: str, model: str | None, show: bool, forget: bool, json: bool) -> None:
    """Swing each actuator in turn, and set its gain by keys."""
    from vbraille.devices.calibration import even_gains, load, name_of, path_of
    from vbraille.files import settings_path

    if json and not show:
        raise click.UsageError("--json needs --show")
    with _opened(spec, model) as device:
        path = path_of(settings_path(), name_of(device))
        if forget:
            there = path.exists()
            path.unlink(missing_ok=True)
            say(f"calibration: {'deleted' if there else 'none'}")
            return
        found = load(settings_path(), device)
        if show and json:
            print_json({"device": name_of(device), "calibration": found and found.to_json()})
        elif show:
            _say_calibration(device)
        else:
            _lead(device, found or even_gains(device))


def _lead(device: Device, found: Calibration) -> None:
    """Lead a person through the actuators by keys; each finding is kept at once."""
    from vbraille.devices.calibration import save
    from vbraille.devices.events import told
    from vbraille.engine.calibrating import CalibrationRound
    from vbraille.engine.clock import RealClock
    from vbraille.errors import InputError
    from vbraille.files import settings_path
    from vbraille.reading.keys import Keyboard
    from vbraille.signals import EAR

    turn = CalibrationRound(device, RealClock(), found)
    with Keyboard() as keyboard:
        if not keyboard.attached:
            raise InputError("device calibrate is led by keys; start it at a terminal")
        say(f"device: {found.device}")
        say("press h for the keys")
        say(turn.said())
        try:
            turn.swing()
            while not turn.left:
                turn.tick()
                for sentence in told(device.take_events()):
                    say(sentence)
                if keyboard.must_stop:
                    turn.rest()
                    keyboard.stop()
                for key in keyboard.pressed(0.0):
                    before = turn.found
                    lines = turn.press(key)
                    if turn.found != before:
                        save(settings_path(), turn.found)
                    for line in lines:
                        say(line)
                    turn.swing()
        finally:
            EAR.close()  # so that the array goes to rest


@contextmanager
def _opened(spec: str, model: str | None) -> Iterator[Device]:
    """Open a device, which must be a display model if one is given."""
    from vbraille.devices.registry import opened_device
    from vbraille.render import MODELS

    with opened_device(spec, None if model is None else MODELS[model].display) as device:
        yield device


def _described(device: Device) -> dict[str, object]:
    """Labels and values of what a device says of itself."""
    info, told = device.display, device.particulars
    axes = "along the line" + (f" and across, {info.height_mm:g} mm" if info.height_mm else "")
    rows: dict[str, object] = {
        "name": info.name,
        "actuators": f"{info.rows} row{'s' * (info.rows > 1)} of {info.columns}",
        "pitch": f"{info.column_pitch_mm:g} mm along the line, {info.row_pitch_mm:g} mm across",
        "levels": info.levels,
        "rest side": info.rest_side,
        "travel": f"{info.travel_mm:g} mm",
        "axes": f"{axes}{', and the angle' * info.turns}",
        "encoder": f"{info.counts_per_mm:g} counts a mm",
        "rate": f"{info.rate_hz:g} Hz",
    }
    if info.contactor_mm is not None:
        rows["contactor"] = f"{info.contactor_mm[0]:g} × {info.contactor_mm[1]:g} mm"
    for name, value in asdict(told).items() if told else ():
        if value:
            said = ", ".join(value) if isinstance(value, tuple) else value
            rows[name.replace("_", " ")] = said
    return rows


def _say_calibration(device: Device) -> None:
    """Print what is kept of a device's actuators."""
    from vbraille.devices.calibration import load, path_of
    from vbraille.engine.calibrating import gains_said
    from vbraille.files import settings_path

    found = load(settings_path(), device)
    if found is None:
        say("calibration: none; vbraille device calibrate makes one")
        return
    for line in gains_said(found):
        say(line)
    say(f"calibration: {path_of(settings_path(), found.device)}")
