"""A conventional display, which BRLTTY drives, by the system's python3-brlapi.

A thread of its own speaks with BRLTTY, so that no trial waits for it; the display may come and go.
"""

from __future__ import annotations

import importlib
import queue
import re
import sys
import threading
import time
from collections import deque
from contextlib import suppress
from typing import Any, Final, NamedTuple

from vbraille.errors import InputError
from vbraille.wording import setting

_SPEC: Final = re.compile(r"brlapi(?::(|[^\s:]*:[0-9]{1,5}|/\S+))?")
_PACKAGES: Final = "/usr/lib/python3/dist-packages"
_RETRY_S: Final = 0.5
_LOOK_S: Final = 0.02  # between looks at what is to be shown
_CHECK_S: Final = 0.5  # writing to a display that was unplugged succeeds: it is asked for
_END_S: Final = 2.0
_SILENT_S: Final = 3.0  # after which what drives the display has stopped answering
_KEPT_KEYS: Final = 100  # key presses that wait to be taken
_STILL: Final = "what drives the display does not answer; start it again, or give its address"


class DisplayStands(NamedTuple):
    """The display is there: name of its driver, its model, and its cells in a row, and rows."""

    driver: str
    model: str
    columns: int
    rows: int = 1

    @property
    def title(self) -> str:
        """Name of the display for people."""
        return f"{self.driver} {self.model}".strip()


class DisplayAway(NamedTuple):
    """The display is not there, or takes no cells: why, and what helps, in words for people."""

    why: str


class CellsTaken(NamedTuple):
    """Cells stand on the display: number of what was shown, and when, by the monotonic clock."""

    number: int
    at_ns: int


def load_brlapi() -> Any:
    """Load python3-brlapi, which the system brings and no registry has.

    Raises
    ------
    InputError
        If it is not installed, or is for another Python.
    """
    sys.path.append(_PACKAGES)
    try:
        return importlib.import_module("brlapi")
    except ImportError:
        raise InputError(
            f"{setting('also')} brlapi needs BRLTTY's module for the system's Python; install "
            f"Debian's packages brltty and python3-brlapi, or leave it out"
        ) from None
    finally:
        sys.path.remove(_PACKAGES)


class ConventionalDisplay:
    """A conventional display, until `close`; then it is given back.

    Parameters
    ----------
    spec
        Which display: "brlapi", or "brlapi:HOST:N" for BRLTTY at another address.

    Attributes
    ----------
    standing : DisplayStands or None
        What display it is; None as long as it is not there.
    away : str
        Why it is not there, in words for people; empty if it is, or nothing is known yet.
    keys : deque[int]
        Codes of the keys that were pressed on it, which `brlapi` expands and describes.
    brlapi
        The module python3-brlapi.

    Raises
    ------
    InputError
        If the text is no spec, or python3-brlapi is not installed.
    """

    def __init__(self, spec: str) -> None:
        found = _SPEC.fullmatch(spec)
        if found is None:
            raise InputError(
                f"{setting('also')} is {spec!r}; give brlapi for the display of BRLTTY on this "
                f"machine, or brlapi:HOST:N, as in brlapi:127.0.0.1:0, for one elsewhere"
            )
        self.standing: DisplayStands | None = None
        self.away = ""
        self.keys: deque[int] = deque(maxlen=_KEPT_KEYS)
        self.brlapi = load_brlapi()
        self._host = found[1] or ""
        self._told: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._wanted: tuple[int, bytes | None] = 0, b""
        self._wakes = threading.Event()
        self._ended = self._is_lost = False
        self._beat_s = time.monotonic()  # when the thread last came round
        self._thread = threading.Thread(target=self._run, name="brlapi", daemon=True)
        self._thread.start()

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
        self._wanted = self._wanted[0] + 1, bytes(cells)
        self._wakes.set()
        return self._wanted[0]

    def rest(self) -> None:
        """Give the display back to other programs until `show` is called."""
        self._wanted = self._wanted[0] + 1, None
        self._wakes.set()

    def poll(self) -> list[Any]:
        """Take what has happened since the last call: cells taken, that it came or went.

        That the display is there, or is not, is given when it changes.
        """
        changes: list[Any] = []
        if self.standing and time.monotonic() - self._beat_s > _SILENT_S:
            self._is_lost = True  # the thread tells it again once it comes back
            self._told.put(DisplayAway(_STILL))
        while not self._told.empty():
            message = self._told.get()
            if isinstance(message, DisplayStands):
                self.standing, self.away = message, ""
            elif isinstance(message, DisplayAway):
                if message.why == self.away:
                    continue
                self.standing, self.away = None, message.why
            changes.append(message)
        return changes

    def close(self) -> None:
        """Give the display back; further calls do nothing."""
        self._ended = True
        self._wakes.set()
        self._thread.join(_END_S)

    def _run(self) -> None:
        """Drive the display whenever it is there."""
        while not self._ended:
            try:
                why = self._drive(self.brlapi.Connection(host=self._host.encode() or None))
            except Exception as error:  # brlapi's own are no subclass of one another
                why = self._explained(error)
            if why and not self._ended:
                self._told.put(DisplayAway(why))
                self._wakes.wait(_RETRY_S)

    def _explained(self, error: Exception) -> str:
        where = f"at {self._host}" if self._host else "on this machine"
        words = " ".join(str(error).split())
        if "authentic" in words.lower():
            return (
                f"BRLTTY {where} does not let you in; join the group that may read /etc/brlapi.key"
            )
        return f"no BRLTTY answers {where} ({words}); start it, or give its address"

    def _drive(self, connection: Any) -> str:
        """Show what is wanted as long as there is a display; a sentence on why there is none."""
        columns, rows = connection.displaySize
        driver, model = _text(connection.driverName), _text(connection.modelIdentifier)
        shown: int | None = None
        try:
            # Without a display BRLTTY says that it has one of one cell, or of none.
            if driver == "NoBraille" or columns * rows <= 1:
                return "BRLTTY drives no display; plug one in"
            gone = f"the {driver} display is not there; plug it in, or switch it on"
            if not self._online(connection):
                return gone
            self._beat_s, self._is_lost = time.monotonic(), True
            due_s = time.monotonic() + _CHECK_S
            while not self._ended:
                self._beat_s = time.monotonic()
                if self._is_lost:
                    self._is_lost = False
                    self._told.put(DisplayStands(driver, model, columns, rows))
                number, cells = self._wanted
                if cells is None and shown is not None:
                    connection.writeDots(bytes(columns * rows))
                    connection.leaveTtyMode()
                    shown = None
                elif cells is not None and number != shown:
                    if shown is None:
                        _enter(connection)
                    connection.writeDots(cells[: columns * rows].ljust(columns * rows, b"\0"))
                    self._told.put(CellsTaken(number, time.monotonic_ns()))
                    shown = number
                while shown is not None and (code := connection.readKey(0)):
                    self.keys.append(code)
                if time.monotonic() >= due_s:
                    due_s = time.monotonic() + _CHECK_S
                    if not self._online(connection) or connection.displaySize != (columns, rows):
                        return gone
                self._wakes.wait(_LOOK_S)
                self._wakes.clear()
        finally:
            with suppress(Exception):
                connection.writeDots(bytes(columns * rows))
                connection.leaveTtyMode()
                connection.closeConnection()
        return ""

    def _online(self, connection: Any) -> bool:
        """Tell whether the display is plugged in, as far as its driver can tell."""
        brlapi = self.brlapi
        try:
            return bool(
                connection.getParameter(brlapi.PARAM_DEVICE_ONLINE, 0, brlapi.PARAMF_GLOBAL)
            )
        except brlapi.OperationError:
            return True


def _enter(connection: Any) -> None:
    """Ask for the display at this program's terminal, or everywhere if that is unknown."""
    try:
        connection.enterTtyMode()
    except Exception:  # of brlapi
        connection.enterTtyModeWithPath([])


def _text(name: Any) -> str:
    return name.decode("utf-8", "replace") if isinstance(name, bytes) else str(name)
