"""Somebody at a device: the loop of ``vbraille read`` and ``vbraille feel``."""

from __future__ import annotations

import signal
import sys
from abc import ABC, abstractmethod
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.caching import compiling_note
from vbraille.cli.stopping import EAR
from vbraille.cli.terminal import say_line
from vbraille.devices.base import Placing
from vbraille.devices.registry import opened_device
from vbraille.devices.sentences import placing_sentence
from vbraille.engine.host import OPEN_S, OPENING, HostDiedError, too_slow
from vbraille.errors import InputError
from vbraille.reading.commands.table import press
from vbraille.reading.cues import Cues, choose_cues
from vbraille.reading.device import OpenDevice
from vbraille.reading.keyboard import POLL_S, STOPPED, StoppableKeyboard
from vbraille.reading.keys import Context, spoken
from vbraille.reading.outputs import Echo, Outputs
from vbraille.simulation.specs import has_hand

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable, Iterator

    from vbraille.devices.base import Device
    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.reading.activity import Activity
    from vbraille.reading.keyboard import Keyboard
    from vbraille.reading.liveview import LiveView


@contextmanager
def opened_in_time(spec: str, wanted: Display | None) -> Iterator[Device]:
    """Open a device in this process as `opened_device` does, unless its driver takes too long.

    Raises
    ------
    InputError, DeviceError
        In the cases of `opened_device`; `DeviceError` also for a driver that takes too long.
    """

    def late(*_: object) -> None:
        raise too_slow(spec, OPENING)

    before = signal.signal(signal.SIGALRM, late)
    try:
        signal.setitimer(signal.ITIMER_REAL, OPEN_S)
        with opened_device(spec, wanted) as device:
            signal.setitimer(signal.ITIMER_REAL, 0)
            yield device
    finally:
        if signal.getsignal(signal.SIGALRM) is late:  # a signal that was heard has a timer, too
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)


@dataclass(frozen=True, slots=True)
class Surroundings:
    """A device with all that somebody at it hears, presses and shows.

    Parameters
    ----------
    device
        The device, which is not driven yet.
    outputs
        Sentences, speech and cues.
    live
        Live view; None if there is none.
    keyboard
        Keyboard of the terminal.
    closing
        Stack of what is closed once the device is.
    """

    device: OpenDevice
    outputs: Outputs
    live: LiveView | None
    keyboard: Keyboard
    closing: ExitStack

    def keys(self) -> StoppableKeyboard:
        """Take the keys; till now Ctrl-Z may do what it does elsewhere."""
        return self.closing.enter_context(StoppableKeyboard(self.keyboard))


@contextmanager
def surrounded(
    arguments: argparse.Namespace,
    keyboard: Keyboard,
    wanted: Display,
    hand: str,
    language: str,
    *,
    echo: Echo = Echo.NONE,
    often: bool = True,
) -> Iterator[Surroundings]:
    """Set up a device with speech, cues and live view; at the end it goes to rest.

    Parameters
    ----------
    arguments
        Options of the command.
    keyboard
        Keyboard of the terminal.
    wanted, hand, often
        As for an `OpenDevice`.
    language
        Language that is spoken if speech was asked for.
    echo
        How much is said of each line.
    """
    with ExitStack() as closing:
        if (note := compiling_note()) is not None:
            print(note, file=sys.stderr, flush=True)
        live = None
        pointer = arguments.pointer if has_hand(arguments.device) else None
        if arguments.monitor:
            # Only who has a live view waits for what it needs.
            from vbraille.reading.liveview import LiveView

            live = closing.enter_context(
                LiveView(arguments.host, arguments.port, pointer, say_line)
            )
        cues = Cues(choose_cues(arguments.cues, attended=keyboard.attached))
        say = say_line if live is None else live.say
        outputs = closing.enter_context(Outputs(say, cues, echo=echo))
        if arguments.speech:
            outputs.speak(language)
        device = OpenDevice(
            arguments.device,
            wanted,
            often=often,
            hand=hand,
            seed=1 if arguments.seed is None else arguments.seed,
            say=outputs.say,
            attended=keyboard.attached,
            begun=arguments.begun,
            pointer=pointer,
            on_share=None if live is None else live.monitor.share,
        )
        try:
            yield Surroundings(device, outputs, live, keyboard, closing)
        finally:
            EAR.close()  # so that the array goes to rest
            device.close()
    faults = ", ".join(f"{name} {count}" for name, count in device.counts.items() if count)
    if faults:
        say_line(f"device: {faults}")


def say_summary(device: OpenDevice, *parts: str, rate_hz: float, speed: str = "") -> None:
    """Say how long a device was driven at a rate, and what else is told at the end.

    Parameters
    ----------
    device
        The device, which is closed.
    parts
        Words that come first.
    rate_hz
        Frames a second.
    speed
        Words on the speed of the hand; empty for none.
    """
    tally = device.tally
    seconds = f"seconds {(tally.ticks + tally.late) / rate_hz:.1f}"
    # That ticks come late does not matter to a device that is not there.
    ticks = (f"ticks {tally.ticks}", f"late ticks {tally.late}") if device.steering is None else ()
    said = (*parts, seconds, *((speed,) if speed else ()), *ticks)
    say_line(f"summary: {', '.join(said)}")


class AtDevice(ABC):
    """Somebody at a device, who tells it by keys what to do until there is no more to do.

    The process can be stopped meanwhile, and a host that dies can be begun again.

    Parameters
    ----------
    around
        Surroundings of the device, which has something under the hand.
    who
        Reader or feeler, who is told what to do.
    keys
        Keyboard, whose keys are taken.
    """

    def __init__(self, around: Surroundings, who: Activity, keys: StoppableKeyboard) -> None:
        self._device = around.device
        self._outputs = around.outputs
        self._who = who
        self._keys = keys
        self._live = around.live

    def run(self) -> None:
        """Go on until there is no more to do.

        Raises
        ------
        HostDiedError
            If the host is gone, and nobody is there who could begin another.
        VbrailleError
            If something else goes wrong with the device.
        """
        try:
            if self._keys.attached:
                self._who.say(f"{self._who.key('HELP', 'h')} says the keys")
            while not self._who.done:
                self._step()
        finally:
            self._tell()

    def _step(self) -> None:
        """Do what keys and pages ask for, then see what the device has to tell."""
        for key in self._pressed():
            self._press(key)
        self._obey()
        self._show()  # what a key has brought is shown at once
        placing = self._device.placing
        try:
            events = self._device.poll(0.0)
        except HostDiedError as fault:
            self._start_again(fault)
            return
        if self._device.placing is not placing:
            self._say_place()
        self._show()
        self._see(events)
        self._tell(events)

    @property
    def _keyed(self) -> Activity:
        """Whoever keys are for at the moment."""
        return self._who

    def _press(self, key: str) -> None:
        self._set_context()
        press(self._keyed, key)

    @abstractmethod
    def _see(self, events: Iterable[Event]) -> None:
        """Do what is to be done when the device was polled, with the events it has told."""

    def _show(self) -> None:
        """Show what is under the hand on whatever else shows it."""

    def _rest(self) -> None:
        """Bring to rest whatever else shows what is under the hand."""

    def _obey(self) -> None:
        """Do what pages of the live view have asked for."""
        if self._live is None:
            return
        for asked in self._live.monitor.take():
            self._set_context()
            self._live.obey(asked)

    def _tell(self, events: Iterable[Event] = (), standing: str | None = None) -> None:
        """Tell the live view what has changed; see `LiveView.tell`."""
        if self._live is not None:
            self._live.tell(events, standing)

    def _pressed(self) -> list[str]:
        """Keys typed; before that, the process stops for a while if it is told to."""
        if self._keys.asked:
            self._suspend()
        there = self._keys.attached
        keys = self._keys.pressed(POLL_S)
        if there and not self._keys.attached:  # whatever its keys meant
            self._who.quit()
            return []
        return keys

    def _suspend(self) -> None:
        """Stop, with the array at rest, until the shell says to go on."""
        device = self._device
        paused, device.paused = device.paused, True
        self._who.say(STOPPED)
        self._tell(standing="stopped: the array rests")
        self._rest()
        self._keys.stop()
        device.paused = paused
        self._who.say("paused" if paused else self._who.doing)
        self._tell(standing="")

    def _set_context(self) -> None:
        """Have keys mean that the carriage is at its place while the device waits for that."""
        keyed = self._keyed
        if self._device.placing is Placing.STOP:
            keyed.context = Context.PLACING
        elif keyed.context is Context.PLACING:
            keyed.context = Context.READING

    def _say_place(self) -> None:
        if self._device.placing is Placing.STOP and not self._keys.attached:
            raise InputError(
                "the device must be shown its place, such as its left stop; "
                f"{self._who.does} at a terminal"
            )
        self._who.say(placing_sentence(self._device.placing, self._device.engine.display))

    def _start_again(self, fault: HostDiedError) -> None:
        """Say that the host is gone, and begin another when asked to.

        Raises
        ------
        HostDiedError
            If there is nobody to ask.
        """
        self._tell(standing=f"fault: {fault}")
        if not self._keys.attached:
            raise fault
        again, stop = self._who.key("PAUSE", " "), self._who.key("QUIT", "q")
        self._who.say(f"fault: {fault}; {again} begins again, {stop} stops")
        while not self._who.done:
            keys = [spoken(key) for key in self._pressed()]
            if self._live is not None:
                self._live.monitor.take()  # which nobody can do now
            self._tell()
            if stop in keys:
                self._who.quit()
            elif again in keys:
                break
            elif keys:
                said = f"{again} begins again, {stop} stops"
                self._who.say(f"fault: nothing drives the device; {said}")
        if self._who.done:
            return
        self._device.start_again()
        self._who.say(self._who.doing)
        self._tell(standing="")
