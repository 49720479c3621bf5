"""A conventional display as a program has it: driven by another process, and never waited for."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final, Self

from vbraille.conventional.brlapi import (
    CellsWanted,
    DisplayAway,
    DisplayStands,
    FromDisplay,
    host_of,
)
from vbraille.workers import Worker

if TYPE_CHECKING:
    from collections.abc import Callable

_MODULE: Final = "vbraille.conventional.driving"
# The other process says twice a second that the display is there. If it says nothing for so long,
# what drives the display has stopped answering.
SILENT_S: Final = 3.0
_STILL: Final = "what drives the display does not answer; start it again, or give its address"


class ConventionalDisplay:
    """A conventional display. A context manager; at the end the display is given back.

    A process of its own drives it, so that no reading and no trial waits for it.

    Parameters
    ----------
    spec
        Which display: "brlapi", or "brlapi:HOST:N" for BRLTTY at another address.
    now_s
        Clock in seconds that does not go back.

    Attributes
    ----------
    standing : DisplayStands or None
        What display it is; None as long as it is not there.
    away : str
        Why it is not there, in words for people; empty if it is, or nothing is known yet.

    Raises
    ------
    InputError
        If the text is no spec, or BRLTTY's library is not installed.
    """

    def __init__(self, spec: str, now_s: Callable[[], float] = time.monotonic) -> None:
        self._host = host_of(spec)
        self.standing: DisplayStands | None = None
        self.away = ""
        self._now_s = now_s
        self._heard_s = now_s()
        self._number = 0
        self._given_back = self._closed = False
        self._newest: CellsWanted | None = None  # what should stand on the display
        self._worker = self._launch()

    def _launch(self) -> Worker[FromDisplay]:
        """Begin the process, and tell it what should stand on the display."""
        worker: Worker[FromDisplay] = Worker(_MODULE, self._host, tells=FromDisplay)
        self._heard_s = self._now_s()
        if self._newest is not None:
            worker.send(self._newest)
        return worker

    def show(self, cells: bytes) -> int:
        """Have cells stand on the display, from its left; this never waits.

        Parameters
        ----------
        cells
            Dot masks of the cells; those for which there is no room are left out.

        Returns
        -------
        int
            Number by which `CellsTaken` names what is shown.
        """
        self._given_back = False
        return self._want(cells)

    def rest(self) -> None:
        """Give the display back to other programs until `show` is called."""
        self._given_back = True
        self.standing = None
        self._want(None)

    def _want(self, cells: bytes | None) -> int:
        self._number += 1
        self._newest = CellsWanted(self._number, cells)
        # Of several that wait only the newest is worth to be shown.
        self._worker.send(self._newest, alone=True)
        return self._number

    def poll(self) -> list[FromDisplay]:
        """Take what has happened since the last call: keys, cells taken, that it came or went.

        That the display is there, or is not, is given when it changes.
        """
        messages = self._worker.receive()
        if messages or self._given_back:
            self._heard_s = self._now_s()
        changes = [each for message in messages for each in self._take(message)]
        if not self._closed and self._now_s() - self._heard_s > SILENT_S:
            changes += self._take(DisplayAway(_STILL))
            if self._worker.ended:
                self._worker.close()
                self._worker = self._launch()
        return changes

    def close(self) -> None:
        """Give the display back, and end the process; further calls do nothing."""
        self._closed = True
        self._worker.close()

    def _take(self, message: FromDisplay) -> list[FromDisplay]:
        """Take a message, and give it unless it says what is known."""
        if isinstance(message, DisplayStands):
            known = message == self.standing
            self.standing, self.away = message, ""
        elif isinstance(message, DisplayAway):
            known = message.why == self.away
            self.standing, self.away = None, message.why
        else:
            known = False
        return [] if known else [message]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
