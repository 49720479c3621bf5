"""Markers for other recorders, such as EEG: what happened in a session, sent by a thread.

Whatever becomes of the recorder, the session neither waits for it nor ends by it: markers stand in
a queue of bounded length, and those that cannot be sent are counted as lost.
"""

from __future__ import annotations

import csv
import re
import time
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from queue import Empty, Full, Queue
from threading import Thread
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.errors import InputError
from vbraille.sessions.record.events import AnyTime, JournalEvent, Presented
from vbraille.wording import count, setting

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from io import TextIOWrapper
    from pathlib import Path


STREAM = "vbraille"
BAUD = 115_200
_WRITE_S = 1.0  # a port that takes no byte for so long is taken for one that is gone
_SERIAL = re.compile(r"serial:(.+?)(?::([1-9][0-9]{0,7}))?")


@dataclass(frozen=True, slots=True)
class Marker:
    """Message about an event to a recorder.

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
        Which stimulus of the trial it was, from 0.
    code
        Byte of the event's kind, from 1 to 255; of what is presented, that of its condition.
    happened_ns
        When it happened, by `time.monotonic_ns`.
    condition
        Condition of the trial; empty if it is in none.
    """

    n: int
    kind: str
    trial: int
    practice: bool
    stimulus: int
    code: int
    happened_ns: int
    condition: str = ""

    @property
    def text(self) -> str:
        """Words for the event, without what was answered.

        >>> Marker(9, "presented", 3, False, 1, 101, 0, "flat").text
        'presented trial 3 stimulus 2 condition flat'
        """
        condition = f" condition {self.condition}" if self.condition else ""
        where = f" {'practice' if self.practice else 'trial'} {self.trial}" if self.trial else ""
        which = f" stimulus {self.stimulus + 1}" if self.stimulus else ""
        return f"{self.kind}{where}{which}{condition}"


@dataclass(frozen=True, slots=True)
class MarkerSpec:
    """A recorder that is sent markers, by its name.

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

    def open(self) -> _LslStream | _SerialPort:
        """Open it.

        Raises
        ------
        InputError
            If it cannot be opened, or what it needs is not installed.
        """
        return _LslStream(self.name) if self.kind == "lsl" else _SerialPort(self.name, self.baud)


def parse_markers(text: str) -> MarkerSpec:
    """Read the name of a recorder.

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
            # Not a dependency, so it is looked for only where it is asked for.
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
    """Say in a few words why a port fails."""
    number = getattr(error, "errno", None)
    if isinstance(number, int):
        import os

        return os.strerror(number)
    return str(error).split("\n")[0]


HEAD = "n,event,trial,practice,condition,byte,late_ms,recorder\n"
_ROOM = 1000  # markers that may wait
_AGAIN_S = 1.0  # a recorder that is gone is looked for so often
_LEAVE_S = 2.0  # how long the end of a session waits for markers that are still on their way


class Markers:
    """Sender of a session's markers, which has a thread of its own from `begin` to `close`.

    Parameters
    ----------
    spec
        What the markers are sent to; it is opened at once.
    codes
        Byte of each condition, by its name.
    now_ns
        Clock by which lateness is measured.
    room
        Number of markers that may wait.

    Raises
    ------
    InputError
        If it cannot be opened.
    """

    def __init__(
        self,
        spec: MarkerSpec,
        codes: Mapping[str, int] | None = None,
        now_ns: Callable[[], int] = time.monotonic_ns,
        room: int = _ROOM,
    ) -> None:
        self._spec = spec
        self._codes = codes or {}
        self._now_ns = now_ns
        self._port: _LslStream | _SerialPort | None = spec.open()
        self._again_ns = 0
        self._queue: Queue[Marker | None] = Queue(room)
        self._thread: Thread | None = None
        self._list: TextIOWrapper | None = None
        self._marked = 0
        self._late_ms: list[float] = []

    def begin(self, folder: Path) -> None:
        """Begin to send, and to list what is sent in a new file of a session's directory.

        Parameters
        ----------
        folder
            The session's directory, where the file is ``markers-001.csv``, or the next number.
        """
        names = (path.stem.removeprefix("markers-") for path in folder.glob("markers-*.csv"))
        number = max((int(name) for name in names if name.isdecimal()), default=0) + 1
        with suppress(OSError):  # the list is no part of the record: a session needs it not
            path = folder / f"markers-{number:03}.csv"
            path.touch(0o600, exist_ok=False)
            self._list = path.open("w", encoding="utf-8")
            self._list.write(HEAD)
        self._thread = Thread(target=self._send_all, name="markers", daemon=True)
        self._thread.start()

    def mark(self, event: JournalEvent, ago_ns: int, condition: str = "") -> None:
        """Have an event's marker sent; this never waits.

        Parameters
        ----------
        event
            Event that is in the journal.
        ago_ns
            How long ago it happened.
        condition
            Condition of the trial that it happened in; empty if it was in none.
        """
        code = self._codes.get(condition) if isinstance(event, Presented) else None
        told = event if isinstance(event, AnyTime) else None
        marker = Marker(
            event.n,
            event.kind,
            told.trial if told else 0,
            told.practice if told else False,
            getattr(event, "stimulus", 0) or 0,
            code or event.code,
            self._now_ns() - ago_ns,
            condition if len(self._codes) > 1 else "",  # a name that tells something
        )
        self._marked += 1
        with suppress(Full):
            self._queue.put_nowait(marker)

    def close(self) -> list[str]:
        """End the sending, and give sentences that tell how it went."""
        if self._thread is None:
            self._let_go()
            return []
        # A full queue belongs to a recorder that takes nothing: what waits in it is lost.
        while self._thread.is_alive():
            try:
                self._queue.put_nowait(None)
                break
            except Full:
                with suppress(Empty):
                    self._queue.get_nowait()
        self._thread.join(_LEAVE_S)
        late_ms = self._late_ms[:]
        said = f"markers: {len(late_ms)} sent to {self._spec}"
        if late_ms:
            said += f", late by {np.median(late_ms):.1f} ms, at most {max(late_ms):.1f} ms"
        lost = self._marked - len(late_ms)
        told = [said]
        if lost:
            told.append(f"markers: {count(lost, 'marker')} lost, since {self._spec} took none then")
        return told

    def _send_all(self) -> None:
        """Send what stands in the queue until there is a None in it."""
        while (marker := self._queue.get()) is not None:
            if not self._sent(marker):
                self._keep(marker, None)
                continue
            late_ms = (self._now_ns() - marker.happened_ns) / 1e6
            self._late_ms.append(late_ms)
            self._keep(marker, late_ms)
        self._let_go()

    def _sent(self, marker: Marker) -> bool:
        """True if a marker could be sent; a recorder that is gone is looked for again by and by."""
        try:
            if self._port is None:
                if self._now_ns() < self._again_ns:
                    return False
                self._port = self._spec.open()
            self._port.send(marker)
        except (OSError, RuntimeError, InputError):
            self._again_ns = self._now_ns() + round(_AGAIN_S * 1e9)
            self._drop()
            return False
        return True

    def _keep(self, marker: Marker, late_ms: float | None) -> None:
        """List a marker with its lateness, or without one if it could not be sent."""
        if self._list is None:
            return
        trial, late = marker.trial or "", "" if late_ms is None else f"{late_ms:.3f}"
        row = (
            marker.n, marker.kind, trial, int(marker.practice), marker.condition, marker.code, late,
            str(self._spec),
        )  # fmt: skip
        try:
            csv.writer(self._list, lineterminator="\n").writerow(row)
            self._list.flush()
        except (OSError, ValueError):
            self._list = None

    def _drop(self) -> None:
        port, self._port = self._port, None
        if port is not None:
            with suppress(OSError, RuntimeError):
                port.close()

    def _let_go(self) -> None:
        self._drop()
        if self._list is not None:
            with suppress(OSError):
                self._list.close()
