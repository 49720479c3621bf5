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


def hear_signals() -> None:
    """Raise `Stopped` wherever the program then is.

    What our parent has us ignore (nohup, a shell's background) stays ignored.
    """
    before = sys.unraisablehook

    def swallowed(unraisable: sys.UnraisableHookArgs) -> None:
        # Python cannot stop within a destructor or a callback: try again a moment later.
        if isinstance(unraisable.exc_value, Stopped):
            signal.signal(signal.SIGALRM, _stop)
            signal.setitimer(signal.ITIMER_REAL, _AGAIN_S)
        else:
            before(unraisable)

    sys.unraisablehook = swallowed
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _stop)


def ignore_signals() -> None:
    """Let nothing disturb what has to be done before the end."""
    for number in (*SIGNALS, signal.SIGALRM):
        signal.signal(number, signal.SIG_IGN)


def _stop(_signal: int, _frame: FrameType | None) -> NoReturn:
    ignore_signals()
    raise Stopped
