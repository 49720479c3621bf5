"""Ctrl-Z and its kin: what has to be left in order before the process stops for a while.

The signal only asks; whoever runs the program's loop stops it, at a moment that suits. The host
process goes on meanwhile: it takes no such signals, and keeps the array at rest.
"""

from __future__ import annotations

import os
import signal
from typing import TYPE_CHECKING, Self

if TYPE_CHECKING:
    from types import FrameType


class Suspension:
    """Hear SIGTSTP and SIGCONT; a context manager that leaves them as they were.

    Attributes
    ----------
    asked : bool
        Whether the process is to stop, which `stop` does.
    continued : bool
        Whether it was continued after a stop that it did not hear of (SIGSTOP); reset by
        whoever has looked.
    """

    def __init__(self) -> None:
        self.asked = self.continued = False
        self._before = {}

    def __enter__(self) -> Self:
        # Without job control whoever started us may have us ignore it: so be it.
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
