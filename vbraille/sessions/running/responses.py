"""Responses: lines typed by an experimenter, or a file; `Simulated` is another source."""

from __future__ import annotations

import os
import select
import sys
import termios
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from vbraille.sessions.planning.questionnaire import AnyItem
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.simulated.skin import FeltFrames


_OFF = b"\0"  # the sign for none


def takes_lines(descriptor: int) -> bool:
    """True if a descriptor is that of a terminal which gives what is typed line by line."""
    try:
        return os.isatty(descriptor) and bool(termios.tcgetattr(descriptor)[3] & termios.ICANON)
    except termios.error:
        return False


class KeyPress(str):
    """The participant's key, where a line might have come."""

    __slots__ = ()


class TerminalKey:
    """A key of a terminal.

    Parameters
    ----------
    descriptor
        Descriptor of the terminal.
    key
        Character that the key types.
    """

    def __init__(self, descriptor: int, key: str) -> None:
        self._descriptor = descriptor
        self._key = key.encode("ascii")
        self._told = False

    @classmethod
    def at(cls, descriptor: int | None, key: str) -> TerminalKey | None:
        """Make it if the descriptor is that of a terminal which takes lines; else None."""
        if descriptor is None or not takes_lines(descriptor):
            return None
        return cls(descriptor, key)

    def tell(self, at_once: bool) -> None:
        """Have the key told at once, or be typed into lines like all others."""
        if at_once is self._told:
            return
        with suppress(termios.error):  # the terminal is gone, which reading from it tells
            attributes = termios.tcgetattr(self._descriptor)
            attributes[6][termios.VEOL] = self._key if at_once else _OFF
            termios.tcsetattr(self._descriptor, termios.TCSANOW, attributes)
            self._told = at_once

    def pressed(self, said: bytes) -> bool:
        """True if bytes that came at the beginning of a line are presses of the key alone."""
        return self._told and not said.strip(self._key)


PROGRAM = "program"  # name that the record has for answers given by a program
_WAIT_S = 1.0


@runtime_checkable
class Responses(Protocol):
    """A source of lines for the console.

    Attributes
    ----------
    name : str
        Name of the source in the record.
    typed : bool
        Whether a person types the answers. The session waits for a person at breaks, and gives
        practice.
    felt : bool
        Whether the answers come from what is felt of a device.
    """

    name: str
    typed: bool
    felt: bool

    def lines(self, wait_s: float) -> list[str] | None:
        """Lines given since the last call, waiting a while for one; None if no more will come."""
        ...

    def next(self, trial: Trial, attempt: int, felt: list[FeltFrames], /) -> tuple[str, int] | None:
        """Answer to a trial that has been read: a line, and its number in a file, or 0.

        None if there are no more lines.
        """
        ...

    def reply(self, item: AnyItem, columns: Mapping[str, str], /) -> tuple[str, int] | None:
        """Answer to a question of the questionnaire, as `next` gives one.

        Parameters
        ----------
        item
            The question.
        columns
            Columns of the item of the trial that it is asked beside; empty at other times.
        """
        ...


class Typed:
    """Source of answers that reads lines from standard input, which may be a terminal."""

    name = "typed"
    typed = True
    felt = False

    def __init__(self) -> None:
        self._descriptor = sys.stdin.fileno() if sys.stdin else None
        self._partial = b""
        self._waiting: list[str] = []
        self._key: TerminalKey | None = None
        self._awaited = False

    def watch(self, key: str) -> bool:
        """Look out for a key, whose presses `lines` gives as a `KeyPress`; False if it cannot be.

        Parameters
        ----------
        key
            Character that the key types.
        """
        self._key = TerminalKey.at(self._descriptor, key)
        return self._key is not None

    def await_key(self, awaited: bool) -> None:
        """Have the key that is looked out for told at once, or typed like all others."""
        self._awaited = awaited
        if self._key is not None:
            # In a line that was begun the key is a character like any other.
            self._key.tell(awaited and not self._partial)

    def take(self) -> None:
        """Have the terminal give what is typed as this reads it."""

    def release(self) -> None:
        """Leave the terminal to another program, until it is taken again."""
        self.await_key(False)

    def lines(self, wait_s: float) -> list[str] | None:
        """Lines typed since the last call; see `Responses`."""
        if self._waiting:
            lines, self._waiting = self._waiting, []
            return lines
        if self._descriptor is None:
            return None
        if not select.select([self._descriptor], [], [], wait_s)[0]:
            return []
        try:
            said = os.read(self._descriptor, 1 << 16)
        except OSError:  # the terminal was closed
            said = b""
        if not said:
            self._descriptor = None
            last, self._partial = self._partial, b""
            return [last.decode("utf-8", "replace")] if last else None
        if self._key is not None and not self._partial and self._key.pressed(said):
            return [KeyPress()]
        *lines, self._partial = (self._partial + said).split(b"\n")
        self.await_key(self._awaited)
        return [line.decode("utf-8", "replace") for line in lines]

    def line(self) -> str | None:
        """Wait for the next line; None if no more will come."""
        lines = self.lines(_WAIT_S)
        while lines == []:
            lines = self.lines(_WAIT_S)
        if lines is None:
            return None
        line, *self._waiting = lines
        return line

    def next(
        self, _trial: Trial, _attempt: int, _felt: list[FeltFrames], /
    ) -> tuple[str, int] | None:
        """Return None: a person answers at any time, and is not asked."""
        return None

    def reply(self, _item: AnyItem, _columns: Mapping[str, str], /) -> tuple[str, int] | None:
        """Return None, too."""
        return None


class TrialResponses:
    """A source that answers a trial once it has been read, and says nothing else."""

    typed = False
    felt = False

    def lines(self, wait_s: float) -> list[str]:
        """Wait, and return no lines."""
        time.sleep(wait_s)
        return []


class Scripted(TrialResponses):
    """Source of answers that takes the next line of a file whenever a trial has been read.

    Empty lines, and lines that begin with #, are left out.

    Parameters
    ----------
    path
        Path of the file, which is UTF-8.
    after
        Number of the last line that was used in earlier runs.

    Raises
    ------
    InputError
        If the file cannot be read.
    """

    def __init__(self, path: Path, after: int = 0) -> None:
        try:
            text = path.read_text("utf-8-sig")
        except OSError as error:
            raise InputError(f"{path} cannot be read: {error.strerror}") from None
        except UnicodeDecodeError:
            raise InputError(f"{path} is not UTF-8; save it as that") from None
        numbered = enumerate(text.splitlines(), 1)
        self.left = [
            (line.strip(), n)
            for n, line in numbered
            if n > after and line.strip() and not line.lstrip().startswith("#")
        ]
        self.path = path
        self.name = str(path)
        self._given = 0

    def next(
        self, _trial: Trial, _attempt: int, _felt: list[FeltFrames], /
    ) -> tuple[str, int] | None:
        """Give the next line of the file."""
        if self._given == len(self.left):
            return None
        self._given += 1
        return self.left[self._given - 1]

    def reply(self, _item: AnyItem, _columns: Mapping[str, str], /) -> tuple[str, int] | None:
        """Give the next line of the file."""
        if self._given == len(self.left):
            return None
        self._given += 1
        return self.left[self._given - 1]
