"""Keys of a terminal, one at a time; while they are taken the process may be stopped."""

from __future__ import annotations

import errno
import os
import select
import sys
import termios
import time
import tty
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Final, Self

from vbraille.cli.old.reading.keys import PASTE_OFF, PASTE_ON, Keys
from vbraille.signals import Suspension

if TYPE_CHECKING:
    from collections.abc import Iterator

_TERMINAL = "/dev/tty"  # the terminal at which a process was started, wherever its input comes from


POLL_S: Final = 0.02  # for which a loop waits for a key
STOPPED: Final = "stopped: the array rests; fg goes on"


class Keyboard:
    """The terminal on standard input; a context manager that leaves it as it was.

    Keys come one at a time between `take` and `release`; `pressed` gives what was typed
    since the last call. Where standard input is no terminal there are no keys. A loop that may be
    stopped for a while takes them by `taken`, and looks at `must_stop` before it takes keys: if
    that is true, it brings the array to rest, and then calls `stop`.

    Parameters
    ----------
    beside
        Whether standard input is read by others: keys then come from the terminal at which the
        program was started, if there is one.
    """

    def __init__(self, *, beside: bool = False) -> None:
        self._descriptor: int | None = None
        self._own: int | None = None  # a descriptor that is opened here
        self._before: list | None = None
        self._keys = Keys()
        self._suspension = Suspension()
        if sys.stdin and sys.stdin.isatty():
            self._descriptor = sys.stdin.fileno()
        elif beside:
            with suppress(OSError):  # there is no terminal
                self._own = os.open(_TERMINAL, os.O_RDWR | os.O_NOCTTY | os.O_CLOEXEC)
            self._descriptor = self._own

    @property
    def attached(self) -> bool:
        """Tell whether there is a terminal to type at."""
        return self._descriptor is not None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.release()
        if self._own is not None:
            os.close(self._own)
            self._own = self._descriptor = None

    @property
    def must_stop(self) -> bool:
        """Tell whether the process is to stop for a while."""
        return self._suspension.asked

    @contextmanager
    def taken(self) -> Iterator[Self]:
        """Take the keys, and hear of signals that have the process stop."""
        with self._suspension:
            self.take()
            yield self

    def stop(self) -> None:
        """Give the terminal back and stop the process; this returns when both are to go on."""
        self.release()
        self._suspension.stop()
        self.take()

    def take(self) -> None:
        """Read keys one at a time from now on, with pasted text marked as such.

        In the background this stops the process until it is in the foreground.
        """
        if self._descriptor is None:
            return
        while True:
            try:
                if self._before is None:
                    self._before = termios.tcgetattr(self._descriptor)
                tty.setcbreak(self._descriptor, termios.TCSANOW)
                break
            except termios.error as error:
                if error.args[0] != errno.EINTR:  # by what brought us to the foreground
                    return  # the terminal is gone, as reading it will say
        self._mark_pastes(PASTE_ON)

    def release(self) -> None:
        """Leave the terminal as it was before the first `take`."""
        if self._descriptor is not None and self._before is not None:
            self._mark_pastes(PASTE_OFF)
            # At once: output that the terminal holds back (Ctrl-S) must not hold up the end.
            with suppress(termios.error):  # the terminal is gone
                termios.tcsetattr(self._descriptor, termios.TCSANOW, self._before)

    def _mark_pastes(self, how: bytes) -> None:
        if self._descriptor is not None and os.environ.get("TERM", "dumb") != "dumb":
            with suppress(OSError):
                os.write(self._descriptor, how)

    def pressed(self, wait_s: float = 0.0) -> list[str]:
        """Keys typed since the last call, as `vbraille.cli.old.reading.keys` names them.

        If there are none, this waits for one, ``wait_s`` at most.
        """
        if self._suspension.continued:  # the shell has had the terminal
            self._suspension.continued = False
            self.take()
        watched = [] if self._descriptor is None else [self._descriptor]
        if not select.select(watched, [], [], wait_s)[0] or self._descriptor is None:
            return self._keys.wait(time.monotonic())
        try:
            typed = os.read(self._descriptor, 4096)
        except OSError:
            typed = b""
        if not typed:  # the terminal is gone
            self._descriptor = None
            return ["q"]
        return self._keys.feed(typed, time.monotonic())
