"""Sources of answers: an experimenter who types, a file, or a program."""

from __future__ import annotations

import os
import select
import sys
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Literal, NamedTuple

from vbraille.errors import InputError
from vbraille.files import read_text
from vbraille.sessions.planning.questionnaire import Item
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.simulated.observer import FeltFrames


class Asked(NamedTuple):
    """A question that waits for a line.

    Parameters
    ----------
    what
        The answer of a trial, how sure it is, a reply to the questionnaire, or Enter alone, such as
        after a break.
    trial, attempt
        The trial, and how often it was shown.
    felt
        Function that returns what was felt of each stimulus.
    item
        What is asked of the questionnaire.
    """

    what: Literal["answer", "rating", "reply", "Enter"]
    trial: Trial | None = None
    attempt: int = 0
    felt: Callable[[], list[FeltFrames]] = list
    item: Item | None = None


class Line(NamedTuple):
    """A line that was given, and its number in a file; 0 if it is in none."""

    text: str
    number: int = 0


class NoMoreAnswers(Exception):
    """There will be no more answers; the session stops, and can be resumed."""


class Answers:
    """A source of answers, which is asked for each one in turn.

    Attributes
    ----------
    name : str
        Name in the record.
    typed : bool
        Whether a person types, who is waited for at breaks and gives commands at any time.
    felt : bool
        Whether it needs what was felt.
    """

    name = "program"
    typed = felt = False

    def line(self, asked: Asked | None, wait_s: float) -> Line | None:
        """Return a line, or None if there is none within some time.

        A person's line may come at any time, others only if something is asked.

        Raises
        ------
        NoMoreAnswers
            If there will be none.
        """
        if asked is None:
            time.sleep(wait_s)
            return None
        return Line("") if asked.what == "Enter" else self.give(asked)

    def give(self, asked: Asked) -> Line:
        """Return the line for what is asked."""
        raise NotImplementedError

    def take(self) -> None:
        """Take the terminal."""

    def release(self) -> None:
        """Leave the terminal to another program."""


class Typed(Answers):
    """Lines from standard input."""

    name = "typed"
    typed = True

    def __init__(self) -> None:
        self._descriptor = sys.stdin.fileno() if sys.stdin else -1
        self._partial = b""
        self._given: list[Line] = []
        self._over = self._descriptor < 0

    def line(self, asked: Asked | None, wait_s: float) -> Line | None:
        """Return a line that was typed."""
        if not self._given and not self._over:
            self._read(wait_s)
        if self._given:
            return self._given.pop(0)
        if self._over:
            raise NoMoreAnswers
        return None

    def _read(self, wait_s: float) -> None:
        """Take what was typed within some time."""
        if not select.select([self._descriptor], [], [], wait_s)[0]:
            return
        try:
            said = os.read(self._descriptor, 1 << 16)
        except OSError:  # the terminal was closed
            said = b""
        self._over = not said
        *lines, self._partial = (self._partial + said).split(b"\n")
        if self._over and self._partial:
            lines.append(self._partial)
        self._given += [Line(line.decode("utf-8", "replace")) for line in lines]


class Scripted(Answers):
    """Lines of a file. Empty lines, and lines that begin with #, are left out.

    Parameters
    ----------
    path
        The file.
    after
        Number of the last line that was used in earlier runs.
    """

    def __init__(self, path: Path, after: int) -> None:
        lines = read_text(path, "file of answers").splitlines()
        self.name = str(path)
        self._left = [
            Line(line.strip(), number)
            for number, line in enumerate(lines, 1)
            if number > after and line.strip() and not line.lstrip().startswith("#")
        ]

    def give(self, asked: Asked) -> Line:
        """Return the next line."""
        if not self._left:
            raise NoMoreAnswers
        return self._left.pop(0)


class Programmed(Answers):
    """Answers of a program.

    Parameters
    ----------
    given
        The lines, or a function that returns the line for a `Trial` or for an `Item` of the
        questionnaire. The session stops if the lines end, or the function returns None.
    """

    def __init__(self, given: Iterable[str] | Callable[[Any], str | None]) -> None:
        if callable(given):
            self._give = given
        else:
            lines = iter(given)
            self._give = lambda _asked: next(lines, None)

    def give(self, asked: Asked) -> Line:
        """Return what the program says to a trial or a question."""
        line = self._give(asked.item or asked.trial)
        if line is None:
            raise NoMoreAnswers
        if not isinstance(line, str):
            raise InputError(f"an answer is {line!r}; give a line of text, or None to stop")
        return Line(line)
