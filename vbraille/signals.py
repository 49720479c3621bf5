"""Signals: to end the program, heard once and then no more; or to suspend it.

A signal to end raises `Stopped` wherever the program then is, so that what it is about is left in
order. Where an exception would do harm, in code that is called back from C, it waits for `heed`.

Ctrl-Z only asks: the program's loop suspends it, at a moment that suits. The process that drives a
device goes on meanwhile, and keeps the array at rest.
"""

from __future__ import annotations

import os
import signal
import sys
from contextlib import contextmanager

TYPE_CHECKING = False
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
        self.heard = self._deferred = False
        self._say_unraisable = sys.unraisablehook

    def listen(self) -> None:
        """Begin; signals that our parent has us ignore (nohup) stay ignored."""
        self.heard = self._deferred = False
        if sys.unraisablehook != self._take_unraisable:
            self._say_unraisable = sys.unraisablehook
            sys.unraisablehook = self._take_unraisable
        for number in SIGNALS:
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._stop)

    def close(self) -> None:
        """Ignore signals from now on, so that nothing disturbs the end."""
        for number in (*SIGNALS, getattr(signal, "SIGALRM", SIGNALS[0])):
            signal.signal(number, signal.SIG_IGN)

    @contextmanager
    def deferred(self) -> Iterator[None]:
        """Let only `heed` raise `Stopped` in a block."""
        self._deferred = True
        try:
            yield
        finally:
            self._deferred = False

    def heed(self) -> None:
        """Raise `Stopped` if a signal came."""
        if self.heard:
            self.close()
            raise Stopped

    def _stop(self, _signal: int, _frame: FrameType | None) -> None:
        self.heard = True
        if not self._deferred:
            self.heed()

    def _take_unraisable(self, unraisable: sys.UnraisableHookArgs) -> None:
        # Python cannot stop within a destructor or a callback: try again a moment later.
        if isinstance(unraisable.exc_value, Stopped) and hasattr(signal, "SIGALRM"):
            signal.signal(signal.SIGALRM, self._stop)
            signal.setitimer(signal.ITIMER_REAL, _AGAIN_S)
        elif not self.heard:
            self._say_unraisable(unraisable)


EAR = _Ear()


class Suspension:
    """Hears SIGTSTP and SIGCONT; a context manager that leaves them as they were.

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
        # Without job control the process that started us may have us ignore it.
        has = hasattr(signal, "SIGTSTP")
        if has and signal.getsignal(signal.SIGTSTP) is not signal.SIG_IGN:
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
