"""``vbraille read``."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import numpy as np

from vbraille.cli.build import (
    build_page,
    build_show,
    check_rate,
    device_info,
    note_unseen_dots,
)
from vbraille.cli.printable import printable
from vbraille.cli.renderers import build_renderer
from vbraille.cli.stopping import EAR
from vbraille.devices import open_device
from vbraille.devices.hand import Recorded, parse_hand
from vbraille.devices.simulated import SimulatedDevice
from vbraille.engine import Loop, RealClock
from vbraille.errors import InputError
from vbraille.reading import Echo, Reader
from vbraille.reading.keyboard import Keyboard
from vbraille.render import MODELS

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from vbraille.cli.build import Page
    from vbraille.devices import Device, DeviceInfo
    from vbraille.devices.hand import Hand
    from vbraille.page import Line
    from vbraille.render import Mapping, Tuning

_KEYS_HZ = 50


def run(arguments: argparse.Namespace) -> int:
    """Read until the text ends, a key says so, or something goes wrong."""
    mapping, tuning = build_show(arguments, MODELS[arguments.model])
    rate_hz = check_rate(arguments.rate)
    hand = parse_hand(arguments.hand, arguments.seed)
    if arguments.advance == "key" and not (sys.stdin and sys.stdin.isatty()):
        raise InputError("--advance key needs a terminal to type at; leave it out without one")
    page = build_page(arguments)
    wanted = device_info(page.model, page.geometry, rate_hz)
    note_unseen_dots(page, mapping)
    with EAR.at_once():
        _warm_up(page, mapping, tuning, wanted)
    with Keyboard() as keyboard, open_device(arguments.device, wanted) as device:
        loop = Loop(device, RealClock(), rate_hz=rate_hz)
        reader = Reader(
            page.layout,
            loop,
            model=page.model,
            geometry=page.geometry,
            mapping=mapping,
            tuning=tuning,
            say=_say,
            first=page.first,
            last=page.last,
            advance=arguments.advance == "return",
            stay=keyboard.attached,
            echo=_echo(arguments.echo),
            on_line=_mover(device, hand),
        )
        try:
            _read(page, reader, keyboard, hand)
        finally:
            EAR.close()  # so that the array goes to rest
            loop.fade_to_rest()
    _say(_summary(reader, loop))
    return 0


def _read(page: Page, reader: Reader, keyboard: Keyboard, hand: Hand | Recorded) -> None:
    loop = reader.loop
    reader.start()
    page.say_note()
    if keyboard.attached:
        _say("h says the keys")
    loop.restart_clock()
    while not reader.done:
        stopped = _stopped(loop.device)  # asked before the tick, which sees where it stopped
        loop.tick()
        reader.step()
        if loop.tally.ticks % max(1, round(loop.rate_hz / _KEYS_HZ)) == 0:
            for key in keyboard.pressed():
                reader.press(key)
            page.say_note()
        if stopped and _stopped(loop.device) and not keyboard.attached:
            _go_on(reader, hand)


def _warm_up(page: Page, mapping: Mapping, tuning: Tuning, wanted: DeviceInfo) -> None:
    """Compile the kernels before the hand sets out, not under it."""
    loop = Loop(SimulatedDevice(wanted), RealClock())
    loop.show(build_renderer(np.zeros(1, np.uint8), page, mapping, tuning))
    loop.warm_up()


def _stopped(device: Device) -> bool:
    """Whether a simulated hand has come to the end of its motion."""
    return isinstance(device, SimulatedDevice) and not device.moving


def _go_on(reader: Reader, hand: Hand | Recorded) -> None:
    """Go on though the hand was not seen to be done.

    It was at the end of the line between two ticks, or its recording is over.
    """
    if isinstance(hand, Recorded):
        reader.quit()
    else:
        reader.go_on()


def _mover(device: Device, hand: Hand | Recorded) -> Callable[[Line, float], None] | None:
    """Have the simulated hand read each line; a real one needs no telling."""
    if not isinstance(device, SimulatedDevice):
        return None
    if isinstance(hand, Recorded):
        device.move(hand.motion())
        return None
    start_mm = -device.info.span_mm
    return lambda _line, end_mm: device.move(hand.read_line(start_mm, end_mm))


def _echo(chosen: str | None) -> Echo:
    """What to say of each line; at a terminal, speech must not read the book aloud."""
    if chosen is not None:
        return Echo(chosen)
    return Echo.NONE if sys.stdout.isatty() else Echo.BOTH


def _say(sentence: str) -> None:
    print(printable(sentence), flush=True)


def _summary(reader: Reader, loop: Loop) -> str:
    tally = loop.tally
    seconds = (tally.ticks + tally.late) / loop.rate_hz
    return (
        f"summary: lines {reader.lines}, seconds {seconds:.1f}, "
        f"mean scanning speed {tally.scanning_mm_s:.1f} mm/s, "
        f"ticks {tally.ticks}, late ticks {tally.late}"
    )
