"""A device that is explored, with its console, speech, cues and live view, as options ask for."""

from __future__ import annotations

import signal
import sys
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.caching import compiling_note
from vbraille.cli.old.reading.device import OpenDevice
from vbraille.cli.old.reading.outputs import (
    ConsoleOutput,
    Cues,
    Echo,
    Outputs,
    SpeechOutput,
    choose_cues,
)
from vbraille.cli.old.terminal import say_line
from vbraille.devices.registry import opened_device
from vbraille.engine.host import OPEN_S, too_slow
from vbraille.signals import EAR
from vbraille.simulation.specs import has_hand

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from vbraille.cli.old.reading.keyboard import Keyboard
    from vbraille.cli.old.reading.liveview import LiveView
    from vbraille.devices.base import Device
    from vbraille.display import Display


@contextmanager
def opened_in_time(spec: str, wanted: Display | None) -> Iterator[Device]:
    """Open a device in this process as `opened_device` does, unless its driver takes too long.

    Raises
    ------
    InputError, DeviceError
        In the cases of `opened_device`; `DeviceError` also for a driver that takes too long.
    """

    def late(*_: object) -> None:
        raise too_slow(spec)

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
class Around:
    """A device with all by which it is told what to do, heard and seen.

    Parameters
    ----------
    device
        The device, which is not driven yet.
    outputs
        ConsoleOutput, speech, cues, and whatever else shows what is explored.
    live
        Live view, which is among the outputs; None if there is none.
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

    def keys(self) -> Keyboard:
        """Take the keys; till now Ctrl-Z may do what it does elsewhere."""
        return self.closing.enter_context(self.keyboard.taken())


@contextmanager
def around_device(
    arguments: argparse.Namespace,
    keyboard: Keyboard,
    wanted: Display,
    hand: str,
    language: str,
    *,
    echo: Echo = Echo.NONE,
    often: bool = True,
) -> Iterator[Around]:
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
        outputs = closing.enter_context(Outputs(ConsoleOutput(say_line)))
        if arguments.monitor:
            # Only who has a live view waits for what it needs.
            from vbraille.cli.old.reading.liveview import LiveView

            live = LiveView(arguments.host, arguments.port, pointer, say_line)
            closing.enter_context(live)
            outputs.add(live)
        outputs.add(Cues(choose_cues(arguments.cues, attended=keyboard.attached)))
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
        if arguments.speech:
            from vbraille.cli.old.reading.speech import Speech

            outputs.add(SpeechOutput(Speech(language), lambda: device.line, echo=echo))
        try:
            yield Around(device, outputs, live, keyboard, closing)
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
