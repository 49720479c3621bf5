"""``vbraille read``."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from typing import TYPE_CHECKING

from vbraille.caching import compiling_note
from vbraille.cli.build import (
    build_book,
    build_lengths,
    build_show,
    lay_out,
    note_unseen_dots,
)
from vbraille.cli.stopping import EAR
from vbraille.devices.base import Placing
from vbraille.devices.registry import check_actuators, check_travel
from vbraille.devices.saying import told
from vbraille.display import check_rate
from vbraille.engine.engine import placing_of
from vbraille.engine.host import Host, HostDiedError
from vbraille.engine.record import Flag
from vbraille.engine.suspending import Suspension
from vbraille.errors import DeviceError, InputError
from vbraille.reading.keyboard import Keyboard
from vbraille.reading.keys import PASTE
from vbraille.reading.reader import Echo, Reader
from vbraille.render import MODELS, model_of
from vbraille.simulation.recorded import Recorded
from vbraille.simulation.specs import (
    device_spec,
    is_simulated,
    parse_hand,
    refuse_hand,
    steering_of,
)
from vbraille.wording import printable

if TYPE_CHECKING:
    import argparse

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.cli.build import Page
    from vbraille.engine.tally import Tally

_HAND = "sweep:60"
_POLL_S = 0.02
_PLACES = {
    Placing.MARK: "place: move the carriage over its mark",
    Placing.STOP: "place: move left to the stop, then press a key",
}


def run(arguments: argparse.Namespace) -> int:
    """Read until the text ends, a key says so, or something goes wrong."""
    rate_hz = check_rate(arguments.rate)
    refuse_hand(arguments.device, hand=arguments.hand, seed=arguments.seed)
    hand = _HAND if arguments.hand is None else arguments.hand
    seed = 1 if arguments.seed is None else arguments.seed
    once = isinstance(parse_hand(hand, seed), Recorded)
    # What the options ask for: a simulated device is just so, a real one is what it is.
    asked = build_lengths(arguments, MODELS[arguments.model or "stress2"])
    wanted = asked.on(asked.style.geometry, rate_hz)
    if arguments.model is not None or is_simulated(arguments.device):
        build_show(arguments, asked)
    steering = steering_of(arguments.device)
    if (note := compiling_note()) is not None:
        print(note, file=sys.stderr, flush=True)
    host = Host(
        device_spec(arguments.device, hand, seed, steering),
        wanted,
        pass_fds=() if steering is None else (steering.descriptor,),
    )
    with ExitStack() as listening, Keyboard(beside=arguments.file == "-") as keyboard:
        if arguments.advance == "key" and not keyboard.attached:
            raise InputError("--advance key needs a terminal to type at; leave it out without one")
        try:
            book = build_book(arguments)
            display = wanted if is_simulated(arguments.device) else host.open()
            if arguments.model is not None:
                check_actuators(display, wanted)
            model = build_show(arguments, model_of(display))
            if arguments.travel is not None:
                check_travel(display, arguments.travel)
            model = build_lengths(arguments, model, display.travel_mm)
            page = lay_out(arguments, book, model)
            note_unseen_dots(page)
            host.fit(display, model.style.room(display, page.layout.width))
            host.start()
            reader = Reader(
                page.layout,
                host,
                model=page.model,
                say=_say,
                first=page.first,
                last=page.last,
                advance=arguments.advance == "return",
                stay=keyboard.attached,
                echo=_echo(arguments.echo),
                steering=steering,
            )
            # Till now Ctrl-Z may do what it does elsewhere.
            suspension = listening.enter_context(Suspension())
            keyboard.take()
            _Reading(page, reader, host, keyboard, suspension, once=once).run()
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
        self,
        page: Page,
        reader: Reader,
        host: Host,
        keyboard: Keyboard,
        suspension: Suspension,
        *,
        once: bool,
    ) -> None:
        self._page = page
        self._reader = reader
        self._host = host
        self._keyboard = keyboard
        self._suspension = suspension
        self._once = once  # the hand reads no more than it has recorded
        self._placing = Placing.DONE

    def run(self) -> None:
        """Read to the end."""
        self._reader.start()
        self._page.say_note()
        if self._keyboard.attached:
            _say("h says the keys")
        while not self._reader.done:
            for key in self._pressed():
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
        for sentence in told(self._host.take_events()):
            _say(sentence)
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
        felt = not int(ticks["flags"][-1]) & Flag.HELD
        done = felt and self._reader.steered_till(ticks[-1]) and not self._keyboard.attached
        if done and self._reader.lines == line and not self._reader.done:
            # The hand was at the end of the line between two ticks, or its recording is over.
            if self._once:
                self._reader.quit()
            elif ticks["line"][-1] == self._reader.line_number:
                self._reader.go_on()
        if self._reader.hopeless is not None and not self._keyboard.attached:
            raise DeviceError(self._reader.hopeless)

    def _pressed(self) -> list[str]:
        """Keys typed; before that, the process stops for a while if it is told to."""
        if self._suspension.asked:
            self._suspend()
        elif self._suspension.continued:
            self._suspension.continued = False
            self._keyboard.take()  # the shell has had the terminal
        return self._keyboard.pressed(_POLL_S)

    def _suspend(self) -> None:
        """Stop, with the array at rest, until the shell says to go on."""
        host = self._host
        paused, host.paused = host.paused, True
        _say("stopped: the array rests; fg goes on")
        self._keyboard.release()
        self._suspension.stop()
        self._keyboard.take()
        host.paused = paused
        _say("paused" if paused else "reading")

    def _press(self, key: str) -> None:
        if self._placing is Placing.STOP and key not in ("q", PASTE):
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
            keys = self._pressed()
            if "q" in keys:
                self._reader.quit()
                return
            if " " in keys:
                break
            if keys:
                _say("fault: nothing drives the device; space begins again, q stops")
        self._placing = Placing.DONE
        self._host.start()
        self._reader.steer()
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
