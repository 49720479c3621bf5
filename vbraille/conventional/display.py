"""A conventional display as a program has it: driven by another process, and never waited for."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Final, Self

from vbraille.conventional.brlapi import host_of
from vbraille.conventional.messages import (
    TO_JSON,
    TOLD_FROM_JSON,
    CellsWanted,
    DisplayAway,
    DisplayStands,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.conventional.messages import FromDisplay

_MODULE: Final = "vbraille.conventional.driving"
_PIPE_BYTES: Final = 1 << 16
# The other process says twice a second that the display is there. If it says nothing for so long,
# what drives the display has stopped answering.
SILENT_S: Final = 3.0
_END_S: Final = 2.0
_STILL: Final = "what drives the display does not answer; start it again, or give its address"


class ConventionalDisplay:
    """A conventional display. A context manager; at the end the display is given back.

    A process of its own drives it, so that no reading and no trial waits for it. It has a session
    of its own, so that keys of the terminal do not end it, and it ends with its pipe.

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
        self._given_back = False
        self._newest: bytes | None = None  # what should stand on the display, as a line of JSON
        self._left: bytes | None = None  # what of that waits for room in the pipe
        self._begun = b""
        self._process: subprocess.Popen[bytes] | None = None
        self._launch()

    def _launch(self) -> None:
        """Begin the process, which is told again what should stand on the display."""
        self._process = process = subprocess.Popen(
            [sys.executable, "-m", _MODULE, self._host],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            bufsize=0,
            start_new_session=True,
        )
        assert process.stdin is not None
        assert process.stdout is not None
        self._orders, self._told = process.stdin, process.stdout
        os.set_blocking(self._orders.fileno(), False)
        os.set_blocking(self._told.fileno(), False)
        self._heard_s = self._now_s()
        self._begun = b""
        self._left = self._newest

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
        """Give the display back to whoever else shows something on it, until `show` is called."""
        self._given_back = True
        self.standing = None
        self._want(None)

    def _want(self, cells: bytes | None) -> int:
        self._number += 1
        # Of several that wait only the newest is worth to be shown.
        self._left = self._newest = TO_JSON.encode(CellsWanted(self._number, cells)) + b"\n"
        self._send()
        return self._number

    def poll(self) -> list[FromDisplay]:
        """Take what has happened since the last call: keys, cells taken, that it came or went.

        That the display is there, or is not, is given when it changes.
        """
        self._send()
        happened: list[FromDisplay] = []
        with suppress(OSError, ValueError):  # nothing has come, or the process has ended
            while chunk := os.read(self._told.fileno(), _PIPE_BYTES):
                self._heard_s = self._now_s()
                *lines, self._begun = (self._begun + chunk).split(b"\n")
                for line in lines:
                    happened += self._take(TOLD_FROM_JSON.decode(line))
        if self._given_back:
            self._heard_s = self._now_s()
        elif self._now_s() - self._heard_s > SILENT_S:
            happened += self._take(DisplayAway(_STILL))
            if self._process is not None and self._process.poll() is not None:
                self._close_pipes()
                self._launch()
        return happened

    def close(self) -> None:
        """Give the display back, and end the process; further calls do nothing."""
        process, self._process = self._process, None
        if process is None:
            return
        self._close_pipes()
        try:
            process.wait(_END_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def _close_pipes(self) -> None:
        for pipe in (self._orders, self._told):
            with suppress(OSError):
                pipe.close()

    def _send(self) -> None:
        if self._left is None:
            return
        try:
            # A pipe takes so little whole, or not at all.
            os.write(self._orders.fileno(), self._left)
        except BlockingIOError:
            return
        except (OSError, ValueError):
            pass  # it has ended, which `poll` finds by its silence
        self._left = None

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
