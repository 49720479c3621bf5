"""Markers for other recorders, such as EEG: what happened in a session, sent by a thread.

Whatever becomes of the recorder, the session neither waits for it nor ends by it: markers stand in
a queue of bounded length, and those that cannot be sent are counted as lost.
"""

from __future__ import annotations

import csv
import time
from contextlib import suppress
from queue import Empty, Full, Queue
from statistics import median
from threading import Thread
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.sessions.record.eventbase import AnyTime
from vbraille.sessions.running.markerports import Marker
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable
    from io import TextIOWrapper
    from pathlib import Path

    from vbraille.sessions.record.eventbase import JournalEvent
    from vbraille.sessions.running.markerports import MarkerPort, MarkerSpec

HEAD = "n,event,trial,practice,byte,late_ms,recorder\n"
_ROOM = 1000  # markers that may wait
_AGAIN_S = 1.0  # a recorder that is gone is looked for so often
_LEAVE_S = 2.0  # how long the end of a session waits for markers that are still on their way


class Markers:
    """Sender of a session's markers, which has a thread of its own from `begin` to `close`.

    Parameters
    ----------
    spec
        What the markers are sent to; it is opened at once.
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
        self, spec: MarkerSpec, now_ns: Callable[[], int] = time.monotonic_ns, room: int = _ROOM
    ) -> None:
        self._spec = spec
        self._now_ns = now_ns
        self._port: MarkerPort | None = spec.open()
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

    def mark(self, event: JournalEvent, ago_ns: int) -> None:
        """Have an event's marker sent; this never waits.

        Parameters
        ----------
        event
            Event that is in the journal.
        ago_ns
            How long ago it happened.
        """
        told = event if isinstance(event, AnyTime) else None
        marker = Marker(
            event.n,
            event.kind,
            told.trial if told else 0,
            told.practice if told else False,
            getattr(event, "stimulus", 0) or 0,
            self._now_ns() - ago_ns,
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
            said += f", late by {median(late_ms):.1f} ms, at most {max(late_ms):.1f} ms"
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
        """Whether a marker could be sent; a recorder that is gone is looked for again by and by."""
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
            marker.n, marker.kind, trial, int(marker.practice), marker.code, late, str(self._spec)
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
