"""Markers for other recorders, and where they go: a stream of a network, or a serial port."""

from __future__ import annotations

import re
import time
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Protocol

from vbraille.errors import InputError
from vbraille.wording import setting

# The byte of each kind of event; an event of another kind has that of OTHER.
CODES = {
    "run": 1, "presented": 2, "cue": 3, "contact": 4, "read": 5, "warning": 6, "answer": 7,
    "undo": 8, "repeat": 9, "fault": 10, "well": 11, "pause": 12, "go": 13, "break": 14,
    "begin": 15, "note": 16, "tuning": 17, "device": 18, "stop": 19, "end": 20, "closed": 21,
    "ended": 22, "hand_taken": 23, "hand_given_back": 24, "break_wanted": 25, "stood": 26,
    "display_beside": 27,
}  # fmt: skip
OTHER = 255
STREAM = "vbraille"
BAUD = 115_200
_WRITE_S = 1.0  # a port that takes no byte for so long is taken for one that is gone
_SERIAL = re.compile(r"serial:(.+?)(?::([1-9][0-9]{0,7}))?")


@dataclass(frozen=True, slots=True)
class Marker:
    """What a recorder is told of an event.

    Parameters
    ----------
    n
        Number of the event in the journal.
    kind
        Kind of the event, as the journal has it.
    trial
        Number of the trial that it happened in; 0 if in none.
    practice
        Whether that trial is practice.
    stimulus
        Which stimulus of the trial it was: 0, or 1 for the second of two.
    happened_ns
        When it happened, by `time.monotonic_ns`.
    """

    n: int
    kind: str
    trial: int
    practice: bool
    stimulus: int
    happened_ns: int

    @property
    def code(self) -> int:
        """Byte of the event's kind, from 1 to 255."""
        return CODES.get(self.kind, OTHER)

    @property
    def text(self) -> str:
        """Words for the event, without what was shown or answered.

        >>> Marker(9, "presented", 3, False, 1, 0).text
        'presented trial 3 stimulus 2'
        """
        where = f" {'practice' if self.practice else 'trial'} {self.trial}" if self.trial else ""
        return f"{self.kind}{where}{' stimulus 2' if self.stimulus else ''}"


class MarkerPort(Protocol):
    """Something that markers are sent to."""

    def send(self, marker: Marker) -> None:
        """Send a marker; an OSError or a RuntimeError says that it was not taken."""

    def close(self) -> None:
        """Let the recorder go."""


@dataclass(frozen=True, slots=True)
class MarkerSpec:
    """A recorder that is sent markers, as somebody names it.

    Parameters
    ----------
    kind
        "lsl" or "serial".
    name
        Name of the stream, or path of the port.
    baud
        Bits a second of the port.
    """

    kind: str
    name: str
    baud: int = BAUD

    def __str__(self) -> str:
        baud = f":{self.baud}" if self.kind == "serial" and self.baud != BAUD else ""
        return f"{self.kind}:{self.name}{baud}"

    def open(self) -> MarkerPort:
        """Open it.

        Raises
        ------
        InputError
            If it cannot be opened, or what it needs is not installed.
        """
        return _LslStream(self.name) if self.kind == "lsl" else _SerialPort(self.name, self.baud)


def parse_markers(text: str) -> MarkerSpec:
    """Read how somebody names a recorder.

    Raises
    ------
    InputError
        If it is neither a stream nor a port.

    >>> parse_markers("serial:/dev/ttyUSB0:9600")
    MarkerSpec(kind='serial', name='/dev/ttyUSB0', baud=9600)
    """
    kind, _, name = text.partition(":")
    if kind == "lsl":
        return MarkerSpec("lsl", name.strip() or STREAM)
    found = _SERIAL.fullmatch(text)
    if found is None:
        raise InputError(
            f"{setting('markers')} is {text!r}; give lsl, lsl:NAME, serial:PORT or serial:PORT:BAUD"
        )
    return MarkerSpec("serial", found[1], int(found[2] or BAUD))


class _LslStream:
    """Stream of the Lab Streaming Layer, of type Markers, with one text a marker."""

    def __init__(self, name: str) -> None:
        try:
            # Not a dependency, so it is looked for only where somebody asks for it.
            self._lsl: Any = import_module("pylsl")
            info = self._lsl.StreamInfo(name, "Markers", 1, 0, "string", f"vbraille-{name}")
            self._outlet = self._lsl.StreamOutlet(info)
        except ModuleNotFoundError:
            raise InputError(
                "markers by the Lab Streaming Layer need pylsl, which is not installed: "
                "pip install pylsl"
            ) from None
        except (ImportError, OSError, RuntimeError) as error:
            told = str(error).strip().split("\n")[0]
            raise InputError(f"the Lab Streaming Layer does not work here: {told}") from None

    def send(self, marker: Marker) -> None:
        """Send the marker's text, with the time at which the event happened."""
        ago_s = (time.monotonic_ns() - marker.happened_ns) / 1e9
        self._outlet.push_sample([marker.text], self._lsl.local_clock() - ago_s)

    def close(self) -> None:
        """End the stream."""
        del self._outlet


class _SerialPort:
    """Serial port, with one byte a marker."""

    def __init__(self, path: str, baud: int) -> None:
        from serial import Serial, SerialException

        try:
            self._port = Serial(path, baud, write_timeout=_WRITE_S, exclusive=True)
        except (SerialException, OSError, ValueError) as error:
            raise InputError(
                f"markers cannot be sent to {path}: {_reason(error)}; give a port that is there "
                f"and free with {setting('markers')}"
            ) from None

    def send(self, marker: Marker) -> None:
        """Send the marker's byte."""
        self._port.write(bytes((marker.code,)))  # a SerialException is an OSError

    def close(self) -> None:
        """Close the port."""
        self._port.close()


def _reason(error: Exception) -> str:
    """What is wrong with a port, in a few words."""
    number = getattr(error, "errno", None)
    if isinstance(number, int):
        import os

        return os.strerror(number)
    return str(error).split("\n")[0]
