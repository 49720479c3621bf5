"""liblouis in a child process, which ends where a translation does not end or crashes.

The child is asked one thing at a time, under a limit of its own processor time, so that a busy
computer does not shorten it. When it has ended, the next question starts a new one.
"""

from __future__ import annotations

import atexit
import os
import pickle
import signal
import subprocess
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path
from threading import Lock
from typing import Any, NamedTuple

from vbraille.errors import VbrailleError

_HERE = Path(__file__).parent
# A table of one rule: what liblouis does not know is a cell of all dots that no braille has.
_UNDEFINED = str(_HERE / "undefined.utb")


class UnendingError(Exception):
    """A translation takes too long, or liblouis crashes on it."""


class _EndedError(UnendingError):
    """The child has ended before its time was over."""


class Answer(NamedTuple):
    """Cells that liblouis writes for a text.

    Attributes
    ----------
    masks : bytes
        Dots of each cell; bit 0 is dot 1.
    places : list of int
        Character that each cell stands for.
    undefined : list of int
        Cells that stand for a character that the table leaves undefined where it is.
    """

    masks: bytes
    places: list[int]
    undefined: list[int]


class Louis:
    """Ask liblouis, in a child that is started anew when it has ended."""

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        """Leave the child to the process that started it, as in a fork of that."""
        self._child: subprocess.Popen[bytes] | None = None
        self._asking = Lock()

    def translate(self, table: str, text: str, forms: list[int] | None = None) -> Answer:
        """Translate a text without control characters.

        Parameters
        ----------
        table, text
            File name or path of a table, and the text.
        forms
            Bits of the classes of emphasis that each character is in.

        Raises
        ------
        RuntimeError
            If the table cannot be used.
        UnendingError
            If liblouis does not come to an end, or crashes.
        """
        return Answer(*self.ask("translate", table, _UNDEFINED, text, forms))

    def ask(self, *question: Any) -> Any:
        """Ask one of the child's functions.

        Raises
        ------
        RuntimeError
            If liblouis refuses.
        UnendingError
            If it takes too long.
        """
        with self._asking:
            try:
                answer = self._exchange(question)
            except _EndedError:  # perhaps from outside
                answer = self._exchange(question)
        if isinstance(answer, Exception):
            raise answer
        return answer

    def stop(self) -> None:
        """End the child."""
        child, self._child = self._child, None
        if child is not None:
            child.kill()
            with suppress(OSError), child:  # what was not sent yet
                pass

    def _exchange(self, question: tuple[Any, ...]) -> Any:
        if self._child is None:
            command = [sys.executable, "-P", str(_HERE / "louischild.py")]
            pipe = subprocess.PIPE
            self._child = subprocess.Popen(
                command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL
            )
        child: Any = self._child
        try:
            pickle.dump(question, child.stdin)
            child.stdin.flush()
            return pickle.load(child.stdout)
        except (EOFError, OSError, pickle.UnpicklingError):
            code = child.wait()
            self.stop()
        if code == 1:
            raise VbrailleError(
                "liblouis's own Python binding is not installed; install python3-louis of "
                "your system (the package louis of PyPI is something else)"
            )
        raise UnendingError if code == -signal.SIGPROF else _EndedError


LOUIS = Louis()
atexit.register(LOUIS.stop)
os.register_at_fork(after_in_child=LOUIS.forget)


@cache
def cells_of(table: str, text: str) -> bytes:
    """Dot masks of a short text by a table; none if it leaves some of it undefined."""
    answer = LOUIS.translate(table, text)
    return b"" if answer.undefined else answer.masks
