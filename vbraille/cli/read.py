"""``vbraille read``."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from vbraille.cli.build import (
    build_page,
    build_show,
    note_unseen_dots,
)
from vbraille.cli.printable import printable
from vbraille.cli.stopping import EAR
from vbraille.cli.wanted import check_rate, device_info, device_spec
from vbraille.devices.base import Placing
from vbraille.devices.hand import parse_hand
from vbraille.devices.recorded import Recorded
from vbraille.engine.engine import placing_of
from vbraille.engine.host import Host, HostDiedError
from vbraille.engine.ring import Flag
from vbraille.errors import InputError
from vbraille.reading import Echo, Reader
from vbraille.reading.keyboard import Keyboard
from vbraille.render import MODELS

if TYPE_CHECKING:
    import argparse

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.cli.build import Page
    from vbraille.engine.tally import Tally

_POLL_S = 0.02
_PLACES = {
    Placing.MARK: "place: move the carriage over its mark",
    Placing.STOP: "place: move left to the stop, then press a key",
}


def run(arguments: argparse.Namespace) -> int:
    """Read until the text ends, a key says so, or something goes wrong."""
    mapping, tuning = build_show(arguments, MODELS[arguments.model])
    rate_hz = check_rate(arguments.rate)
    once = isinstance(parse_hand(arguments.hand, arguments.seed), Recorded)
    if arguments.advance == "key" and not (sys.stdin and sys.stdin.isatty()):
        raise InputError("--advance key needs a terminal to type at; leave it out without one")
    page = build_page(arguments)
    wanted = device_info(page.model, page.geometry, rate_hz)
    note_unseen_dots(page, mapping)
    host = Host(
        device_spec(arguments.device, arguments.hand, arguments.seed), wanted, page.layout.width
    )
    with Keyboard() as keyboard:
        reader = Reader(
            page.layout,
            host,
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
        )
        try:
            host.start()
            _Reading(page, reader, host, keyboard, once=once).run()
        finally:
            EAR.close()  # so that the array goes to rest
            host.close()
    faults = ", ".join(f"{name} {count}" for name, count in host.counts.items() if count)
    if faults:
        _say(f"device: {faults}")
    page.say_unknown()
    _say(_summary(reader.lines, host.tally, rate_hz))
    return 0


class _Reading:
    """One reading: what happens between a reader, its keyboard and its host."""

    def __init__(
        self, page: Page, reader: Reader, host: Host, keyboard: Keyboard, *, once: bool
    ) -> None:
        self._page = page
        self._reader = reader
        self._host = host
        self._keyboard = keyboard
        self._once = once  # the hand reads no more than it has recorded
        self._placing = Placing.DONE

    def run(self) -> None:
        """Read to the end."""
        self._reader.start()
        self._page.say_note()
        if self._keyboard.attached:
            _say("h says the keys")
        while not self._reader.done:
            for key in self._keyboard.pressed(_POLL_S):
                self._press(key)
            try:
                ticks = self._host.poll()
            except HostDiedError as fault:
                self._start_again(fault)
                continue
            self._step(ticks)
            self._page.see(self._reader.line_number)
            self._page.say_note()

    def _step(self, ticks: NDArray[np.void]) -> None:
        for note in self._host.take_notes():
            _say(note)
        if not ticks.size:
            return
        placing = placing_of(ticks[-1])
        if placing is not self._placing:
            self._placing = placing
            if placing is Placing.STOP and not self._keyboard.attached:
                raise InputError(
                    "the device must be told where its left stop is; read at a terminal"
                )
            _say(_PLACES.get(placing, "place: known"))
        line = self._reader.lines
        self._reader.step(ticks)
        done = ticks["flags"][-1] & Flag.FOLLOWED and not self._keyboard.attached
        if done and self._reader.lines == line and not self._reader.done:
            # The hand was at the end of the line between two ticks, or its recording is over.
            if self._once:
                self._reader.quit()
            elif ticks["line"][-1] == self._reader.line_number:
                self._reader.go_on()

    def _press(self, key: str) -> None:
        if self._placing is Placing.STOP and key != "q":
            self._host.set_zero()
        else:
            self._reader.press(key)

    def _start_again(self, fault: HostDiedError) -> None:
        """Say that the host is gone, and begin another when asked to.

        Raises
        ------
        HostDiedError
            If there is nobody to ask.
        """
        if not self._keyboard.attached:
            raise fault
        _say(f"fault: {fault}; space begins again, q stops")
        while True:
            keys = self._keyboard.pressed(_POLL_S)
            if "q" in keys:
                self._reader.quit()
                return
            if " " in keys:
                break
        self._placing = Placing.DONE
        self._host.start()
        _say("reading")


def _echo(chosen: str | None) -> Echo:
    """What to say of each line; at a terminal, speech must not read the book aloud."""
    if chosen is not None:
        return Echo(chosen)
    return Echo.NONE if sys.stdout.isatty() else Echo.BOTH


def _say(sentence: str) -> None:
    print(printable(sentence), flush=True)


def _summary(lines: int, tally: Tally, rate_hz: float) -> str:
    seconds = (tally.ticks + tally.late) / rate_hz
    return (
        f"summary: lines {lines}, seconds {seconds:.1f}, "
        f"mean scanning speed {tally.scanning_mm_s:.1f} mm/s, "
        f"ticks {tally.ticks}, late ticks {tally.late}"
    )
