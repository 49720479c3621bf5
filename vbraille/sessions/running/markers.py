"""Markers for other recorders, such as EEG: each event is told as it happens.

Nothing here waits: the Lab Streaming Layer keeps a stream of its own, and a serial port takes a
byte at once or loses it.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping
from typing import Any

from vbraille.errors import InputError
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.record.record import KINDS

BAUD = 115_200


class Markers:
    """Sends a marker of each event.

    Parameters
    ----------
    spec
        Recorder: "lsl", "lsl:NAME", "serial:PORT" or "serial:PORT:BAUD"; empty for none.
    codes
        Byte of each condition, by its name.
    say
        Function that is called with sentences for the experimenter.

    Raises
    ------
    InputError
        If the recorder cannot be opened, or what it needs is not installed.
    """

    def __init__(self, spec: str, codes: Mapping[str, int], say: Callable[[str], None]) -> None:
        self._spec, self._codes, self._say = spec, codes, say
        self._sent = self._lost = 0
        self._send: Callable[[str, int, float], None] | None = None
        kind, _, where = spec.partition(":")
        if kind == "lsl":
            self._send = _open_stream(where or "vbraille")
        elif kind == "serial" and where:
            self._send = _open_port(where)
        elif spec:
            raise InputError(
                f"markers are {spec!r}; give lsl, lsl:NAME, serial:PORT or serial:PORT:BAUD"
            )

    def mark(self, kind: str, at_s: float, trial: Trial | None, stimulus: int) -> None:
        """Send the marker of an event; what was answered is not in it.

        Parameters
        ----------
        kind
            Kind of the event.
        at_s
            When it happened, by the machine's monotonic clock.
        trial, stimulus
            Trial that it happened in, or None, and which of its stimuli it was, from 0.
        """
        if self._send is None:
            return
        code, words = KINDS[kind].byte, [kind]
        if trial is not None:
            words += [trial.name, f"condition {trial.condition}"]
            words += [f"stimulus {stimulus + 1}"] if stimulus else []
            if kind == "cue":
                code = self._codes.get(trial.condition, code)
        try:
            self._send(" ".join(words), code, at_s)
            self._sent += 1
        except (OSError, RuntimeError) as error:
            self._lost += 1
            if self._lost == 1:
                self._say(f"markers: {self._spec} takes none ({error}); the session goes on")

    def close(self) -> None:
        """Say how many markers were sent."""
        if self._send is not None:
            self._say(f"markers: {self._sent} sent to {self._spec}, {self._lost} lost")


def _open_stream(name: str) -> Callable[[str, int, float], None]:
    """Return what sends a text to a stream of the Lab Streaming Layer, of the type Markers."""
    try:
        import pylsl

        form: Any = "string"  # whose stub has numbers alone
        info = pylsl.StreamInfo(name, "Markers", 1, 0, form, f"vbraille-{name}")
        outlet = pylsl.StreamOutlet(info)
    except (ImportError, OSError, RuntimeError) as error:
        told = str(error).strip().partition("\n")[0]
        hint = "pip install 'vbraille[markers]'"
        raise InputError(
            f"markers lsl need pylsl, the Lab Streaming Layer: {told}; {hint}"
        ) from None

    def send(text: str, _code: int, at_s: float) -> None:
        outlet.push_sample([text], pylsl.local_clock() - (time.monotonic() - at_s))

    return send


def _open_port(where: str) -> Callable[[str, int, float], None]:
    """Return what writes a byte to a serial port, without waiting."""
    import serial

    path, baud = where, BAUD
    if (found := re.fullmatch(r"(.+):(\d+)", where)) is not None:
        path, baud = found[1], int(found[2])
    try:
        port: Any = serial.Serial(path, baud, write_timeout=0, exclusive=True)
    except (OSError, ValueError) as error:
        raise InputError(f"markers cannot be sent to {path}: {error}") from None

    def send(_text: str, code: int, _at_s: float) -> None:
        if not port.write(bytes([code])):
            raise OSError("it is full")

    return send
