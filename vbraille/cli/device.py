"""``vbraille device``: which there are, what one is, and whether it is fit to be read on."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np

from vbraille.cli.stopping import EAR
from vbraille.cli.wanted import device_info
from vbraille.devices import open_device
from vbraille.devices.base import Placing
from vbraille.engine.checkup import hold_rate, round_trips_ms, swing_each, warm_up
from vbraille.engine.clock import RealClock
from vbraille.engine.realtime import go_real_time
from vbraille.errors import DeviceError
from vbraille.render import MODELS
from vbraille.wording import printable

if TYPE_CHECKING:
    import argparse

    from vbraille.devices import Device, DeviceInfo

_RATE_S = 3.0
_ROUND_TRIPS = 500
# More is felt: a hand at 70 mm/s goes a tenth of a dot in 4 ms.
_MOST_ROUND_TRIP_MS = 4.0
_MOST_LATE = 0.01  # of all ticks
_MOST_FAULTS = 50  # of a kind: 1 % of some 5000 ticks
_MARK_S = 60.0


def run(arguments: argparse.Namespace) -> int:
    """List, describe or check."""
    if arguments.action == "list":
        return _list()
    if arguments.action == "check":
        with EAR.at_once():
            warm_up()
    with open_device(arguments.spec, _wanted(arguments)) as device:
        _describe(device.info)
        if arguments.action == "info":
            return 0
        try:
            return _check(device)
        finally:
            EAR.close()  # so that the array goes to rest


def _list() -> int:
    from serial.tools import list_ports

    ports = sorted(list_ports.comports())
    for port in ports:
        ids = "" if port.vid is None else f", id {port.vid:04x}:{port.pid:04x}"
        number = f", serial number {port.serial_number}" if port.serial_number else ""
        name = port.description if port.description != "n/a" else "no name"
        _say(f"port: serial:{port.device}, {name}{ids}{number}")
    if not ports:
        _say("port: none; plug the device in")
    return 0


def _wanted(arguments: argparse.Namespace) -> DeviceInfo | None:
    if arguments.model is None:
        return None
    model = MODELS[arguments.model]
    return device_info(model, model.geometry, 1000.0)


def _describe(info: DeviceInfo) -> None:
    _say(f"name: {info.name}")
    _say(f"actuators: {info.rows} row{'s' * (info.rows > 1)} of {info.columns}")
    _say(f"pitch: {info.column_pitch_mm:g} mm along the line, {info.row_pitch_mm:g} mm across")
    _say(f"levels: {info.levels}")
    _say(f"rest side: {info.rest_side}")
    _say(f"travel: {info.travel_mm:g} mm")
    _say(f"encoder: {info.counts_per_mm:g} counts a mm")
    _say(f"rate: {info.rate_hz:g} Hz")


def _check(device: Device) -> int:
    note = go_real_time()
    if note is not None:
        _say(note)
    clock = RealClock()
    _wait_for_place(device)
    for row, column in swing_each(device, clock):
        _say(f"actuator: row {row + 1}, column {column + 1}")
    wrong = [*_rate(device, clock), *_round_trips(device, clock), *_faults(device)]
    for sentence in device.take_notes():
        _say(sentence)
    _say(f"verdict: {'; '.join(wrong)}" if wrong else "verdict: fit to be read on")
    return 1 if wrong else 0


def _wait_for_place(device: Device) -> None:
    """Have a place, whichever: frames are not taken without one."""
    end_s = time.monotonic() + _MARK_S
    while device.read() is None:
        if device.placing is Placing.STOP:
            device.set_zero()
        elif device.placing is Placing.MARK and time.monotonic() > end_s - _MARK_S + 0.5:
            _say("place: move the carriage over its mark")
            end_s += _MARK_S
        if time.monotonic() > end_s:
            raise DeviceError(f"{device.info.name} gives no place; look at its encoder")
        time.sleep(0.001)


def _rate(device: Device, clock: RealClock) -> list[str]:
    rate = hold_rate(device, clock, _RATE_S)
    share = rate.late / (rate.ticks + rate.late)
    _say(f"rate: {device.info.rate_hz:g} Hz, {rate.late} of {rate.ticks + rate.late} ticks late")
    _say(f"work: median {rate.work_us[0]:.0f} µs, 99 % under {rate.work_us[1]:.0f} µs")
    return [f"{share:.1%} of the ticks come late"] if share > _MOST_LATE else []


def _round_trips(device: Device, clock: RealClock) -> list[str]:
    taken = round_trips_ms(device, clock, _ROUND_TRIPS)
    if not taken.size:
        _say("round trip: this device does not say what it has taken")
        return []
    low, median, high = np.percentile(taken, (1, 50, 99))
    _say(f"round trip: median {median:.2f} ms, 98 % within {low:.2f} to {high:.2f} ms")
    if taken.size < _ROUND_TRIPS:
        return [f"only {taken.size} frames were acknowledged before one was not"]
    if median <= _MOST_ROUND_TRIP_MS:
        return []
    return [f"a round trip takes {median:.1f} ms; have the port's latency set to 1 ms"]


def _faults(device: Device) -> list[str]:
    counts = device.counts()
    for name, count in counts.items():
        _say(f"{name}: {count}")
    return [f"{name}: {count}" for name, count in counts.items() if count > _MOST_FAULTS]


def _say(sentence: str) -> None:
    print(printable(sentence), flush=True)
