"""Being told by a signal to stop: heard once, at any moment, and then no more."""

from __future__ import annotations

import signal
import sys
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_AGAIN_S = 0.001


class Stopped(BaseException):
    """Somebody ended the program by a signal."""


class Ear:
    """Raises `Stopped` when a signal says so, wherever the program then is.

    Attributes
    ----------
    heard : bool
        Whether one did: what fails from then on fails because of it.
    """

    def __init__(self) -> None:
        self.heard = False
        self._say_unraisable = sys.unraisablehook

    def listen(self) -> None:
        """Begin; signals that our parent has us ignore (nohup) stay ignored."""
        sys.unraisablehook = self._take_unraisable
        for number in SIGNALS:
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._stop)

    def _stop(self, _signal: int, _frame: FrameType | None) -> NoReturn:
        self.heard = True
        ignore_signals()
        raise Stopped

    def _take_unraisable(self, unraisable: sys.UnraisableHookArgs) -> None:
        # Python cannot stop within a destructor or a callback: try again a moment later.
        if isinstance(unraisable.exc_value, Stopped):
            signal.signal(signal.SIGALRM, self._stop)
            signal.setitimer(signal.ITIMER_REAL, _AGAIN_S)
        elif not self.heard:
            self._say_unraisable(unraisable)


def ignore_signals() -> None:
    """Let nothing disturb what has to be done before the end."""
    for number in (*SIGNALS, signal.SIGALRM):
        signal.signal(number, signal.SIG_IGN)
