"""Signals: to stop for good, heard once, at any moment, and then no more; or to stop for a while.

A signal to end raises `Stopped` wherever the program then is, so that what it is about
is left in order. Where an exception out of nowhere would do harm it waits for a
better place (HDF5), or ends the program at once, if nothing is open that has to
be left in order (imports, numba's compiler).

Ctrl-Z and its kin only ask; the program's loop stops it, at a moment that suits. The
host process goes on meanwhile: it takes no such signals, and keeps the array at rest.
"""

from __future__ import annotations

import os
import signal
import sys
from contextlib import contextmanager, suppress

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import FrameType
    from typing import Self

# A system other than Linux may not have all of them.
_NAMES = ("SIGINT", "SIGTERM", "SIGHUP")
SIGNALS = tuple(getattr(signal, name) for name in _NAMES if hasattr(signal, name))
SAID = "stopped"
EXIT_CODE = 1
_AGAIN_S = 0.001


class Stopped(BaseException):
    """A signal ended the program."""


class _Ear:
    """Listens to the process's signals; there is one such object, as there is one set of signals.

    Attributes
    ----------
    heard : bool
        Whether a signal came: what fails from then on fails because of it.
    """

    def __init__(self) -> None:
        self.heard = False
        self._at_once = self._deferred = False
        self._say_unraisable = sys.unraisablehook

    def listen(self) -> None:
        """Begin; signals that our parent has us ignore (nohup) stay ignored."""
        self.heard = self._at_once = self._deferred = False
        if sys.unraisablehook != self._take_unraisable:
            self._say_unraisable = sys.unraisablehook
            sys.unraisablehook = self._take_unraisable
        for number in SIGNALS:
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._stop)

    def close(self) -> None:
        """Let nothing disturb what has to be done before the end."""
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)
        if hasattr(signal, "SIGALRM"):
            signal.signal(signal.SIGALRM, signal.SIG_IGN)

    @contextmanager
    def at_once(self) -> Iterator[None]:
        """Nothing is open here that would have to be left in order."""
        self._at_once = True
        try:
            yield
        finally:
            self._at_once = False

    @contextmanager
    def deferred(self) -> Iterator[None]:
        """Let only `heed` stop here: code that is called back from C must not meet an exception."""
        self._deferred = True
        try:
            yield
        finally:
            self._deferred = False

    def heed(self) -> None:
        """Stop here if a signal came."""
        if self.heard:
            self.close()
            raise Stopped

    def _stop(self, _signal: int, _frame: FrameType | None) -> None:
        self.heard = True
        if self._deferred:
            return
        self.close()
        if self._at_once:
            with suppress(OSError):
                os.write(2, f"vbraille: {SAID}\n".encode())
            os._exit(EXIT_CODE)
        raise Stopped

    def _take_unraisable(self, unraisable: sys.UnraisableHookArgs) -> None:
        # Python cannot stop within a destructor or a callback: try again a moment later.
        if isinstance(unraisable.exc_value, Stopped) and hasattr(signal, "SIGALRM"):
            signal.signal(signal.SIGALRM, self._stop)
            signal.setitimer(signal.ITIMER_REAL, _AGAIN_S)
        elif not self.heard:
            self._say_unraisable(unraisable)


EAR = _Ear()


class Suspension:
    """Hear SIGTSTP and SIGCONT; a context manager that leaves them as they were.

    Attributes
    ----------
    asked : bool
        Whether the process is to stop, which `stop` does.
    continued : bool
        Whether it was continued after a stop that it did not hear of (SIGSTOP); reset by the caller
        that has looked.
    """

    def __init__(self) -> None:
        self.asked = self.continued = False
        self._before = {}

    def __enter__(self) -> Self:
        # Without job control the process that started us may have us ignore it: so be it.
        if signal.getsignal(signal.SIGTSTP) is not signal.SIG_IGN:
            self._before = {
                signal.SIGTSTP: signal.signal(signal.SIGTSTP, self._ask),
                signal.SIGCONT: signal.signal(signal.SIGCONT, self._go_on),
            }
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def stop(self) -> None:
        """Stop the process as its signal does; this returns when it is continued."""
        signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGTSTP)
        self.asked = self.continued = False
        signal.signal(signal.SIGTSTP, self._ask)

    def _ask(self, _signal: int, _frame: FrameType | None) -> None:
        self.asked = True

    def _go_on(self, _signal: int, _frame: FrameType | None) -> None:
        self.continued = True
