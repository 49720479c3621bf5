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

from vbraille.errors import InputError, VbrailleError
from vbraille.wording import nearest

_HERE = Path(__file__).parent
# A table of one rule: what liblouis does not know is a cell of all dots that no braille has.
_UNDEFINED = str(_HERE / "undefined.utb")
_UNDEFINED_CELL = 0xFF00
_LONGEST_NAME = 1_000  # liblouis puts a name into 2 kB without checking that it fits


class UnendingError(Exception):
    """A translation takes too long, or liblouis crashes on it."""


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
        """Translate a text.

        Parameters
        ----------
        table
            File name or path of a table.
        text
            Text without control characters.
        forms
            Bits of the classes of emphasis that each character is in.

        Raises
        ------
        InputError
            If the table cannot be used.
        UnendingError
            If liblouis does not come to an end, or crashes.
        """
        if "\0" in table or not 0 < len(table) <= _LONGEST_NAME:
            raise InputError(f"unknown braille table {table!r:.40}")
        try:
            cells, places = self.ask("translate", table, _UNDEFINED, text, forms)
        except RuntimeError:
            names = [each["name"] for each in list_tables()]
            raise InputError(
                f"unknown braille table {table!r}"
                f"{nearest(table, names, 3)} (vbraille tables lists all)"
            ) from None
        undefined = [number for number, cell in enumerate(cells) if cell == _UNDEFINED_CELL]
        return Answer(bytes(cell & 0xFF for cell in cells), places, undefined)

    def ask(self, *question: Any) -> Any:
        """Ask one of the child's functions.

        Raises
        ------
        RuntimeError
            If liblouis refuses.
        UnendingError
            If it takes too long.
        """
        with self._asking:  # once more if a child was ended from outside
            answered = self._exchange(question) or self._exchange(question)
        if answered is None:
            raise UnendingError
        if isinstance(answered[0], Exception):
            raise answered[0]
        return answered[0]

    def stop(self) -> None:
        """End the child."""
        child, self._child = self._child, None
        if child is not None:
            child.kill()
            child.wait()
            for stream in (child.stdin, child.stdout):
                with suppress(OSError):  # what was not sent yet
                    stream.close()  # type: ignore[union-attr]

    def _exchange(self, question: tuple[Any, ...]) -> tuple[Any] | None:
        """Ask the child; None if it has ended otherwise than by its limit of time."""
        child = self._child or self._start()
        assert child.stdin is not None
        assert child.stdout is not None
        try:
            child.stdin.write(pickle.dumps(question))
            child.stdin.flush()
            return (pickle.load(child.stdout),)
        except (EOFError, OSError, pickle.UnpicklingError):
            code = child.wait()
            self.stop()
        if code == 1:
            raise VbrailleError(
                "liblouis's own Python binding is not installed; install python3-louis of "
                "your system (the package louis of PyPI is something else)"
            )
        if code == -signal.SIGPROF:
            raise UnendingError
        return None

    def _start(self) -> subprocess.Popen[bytes]:
        self._child = subprocess.Popen(
            [sys.executable, "-P", str(_HERE / "louischild.py")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        return self._child


LOUIS = Louis()
atexit.register(LOUIS.stop)
os.register_at_fork(after_in_child=LOUIS.forget)


@cache
def list_tables() -> tuple[dict[str, str], ...]:
    """File name and metadata of each table of liblouis that has some."""
    return tuple(LOUIS.ask("list_tables"))


@cache
def liblouis_version() -> str:
    """Version of liblouis, such as 3.24.0."""
    return LOUIS.ask("version")


@cache
def emphasis_bit(table: str, name: str) -> int:
    """Bit that a table has for a class of emphasis, such as "italic"; 0 without the class."""
    return LOUIS.ask("emphasis_bit", table, name)


def display_dots(table: str, characters: str) -> list[int]:
    """Dot masks that a display table, such as ``de-eurobrl6.dis``, has for characters.

    Raises
    ------
    InputError
        If there is no such table.
    """
    try:
        return LOUIS.ask("display_dots", table, characters)
    except RuntimeError:
        raise InputError(f"liblouis has no display table {table!r}") from None
