"""Answers that are given beforehand, by a program or in a file, and their check."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.sessions.running.answers import PROGRAM, ScriptedAnswers
from vbraille.sessions.running.console import find_order
from vbraille.sessions.running.inquiry import read_line

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.progress import Progress
    from vbraille.sessions.simulated.skin import Exploration


class GivenAnswers:
    """Source of answers that asks a program for a line whenever a trial has been read.

    Parameters
    ----------
    protocol
        Protocol that the answers are checked against.
    given
        The lines, one for each trial, or a function that gives the line for a trial. If the
        lines end, or the function gives None, the session stops and can be resumed.
    """

    name = PROGRAM
    typed = False
    felt = False

    def __init__(
        self, protocol: Protocol, given: Iterable[str] | Callable[[Trial], str | None]
    ) -> None:
        self._protocol = protocol
        if callable(given):
            self._give = given
        else:
            lines = iter(given)
            self._give = lambda _trial: next(lines, None)
        self._answered: tuple[bool, int, int] | None = None

    def lines(self, wait_s: float) -> list[str]:
        """Wait, and return no lines: the lines of the program are given to trials."""
        time.sleep(wait_s)
        return []

    def next(
        self, trial: Trial, attempt: int, _felt: list[Exploration], /
    ) -> tuple[str, int] | None:
        """Line of the program for a trial; None if there is none, or the trial was answered.

        Raises
        ------
        InputError
            If the line is no text, or neither an answer to the trial nor an order.
        """
        asked = trial.practice, trial.number, attempt
        line = None if asked == self._answered else self._give(trial)
        if line is None:
            return None
        if not isinstance(line, str):
            raise InputError(
                f"the answer to trial {trial.number} is {line!r}; it must be a line of text, such "
                f"as 'a', or None to stop"
            )
        try:
            self._answered = asked if _is_answer(self._protocol, trial, line) else None
        except ValueError as error:
            raise InputError(f"{line!r} for trial {trial.number}: {error}") from None
        return line, 0


def check_script(script: ScriptedAnswers, protocol: Protocol, progress: Progress) -> None:
    """Raise InputError if a line of an answers file does not answer its trial."""
    planned = progress.procedure.trials
    if planned is None:  # it is not known yet which trials will come
        return
    trials = iter(planned[progress.done :])
    correcting, answered = progress.correcting, progress.last_answered
    half = again = None  # a trial without a confidence yet, and one whose answer was dropped so
    for line, number in script.left:
        found = find_order(line)
        word = "answer" if found is None else found[0].word
        if word in ("undo", "repeat") and half is not None:
            half, again = None, half
        elif word == "undo":
            correcting = correcting or answered
        if word != "answer":
            continue
        trial = half or again or correcting or next(trials, None)
        if trial is None:
            raise InputError(f"{script.path} line {number}: there is no trial left to answer")
        try:
            whole = half is not None or _is_whole(protocol, trial, line)
            if half is not None and protocol.asks.confidence is not None:
                protocol.asks.confidence.parse(line if found is None else found[1])
        except ValueError as error:
            raise InputError(f"{script.path} line {number}: {error}") from None
        again = None
        if not whole:
            half = trial
            continue
        half = None
        correcting, answered = None, trial if correcting is None else answered


def _is_whole(protocol: Protocol, trial: Trial, line: str) -> bool:
    """Whether a line has all that is asked; ValueError if it does not suit its trial."""
    found = find_order(line)
    _, confidence = read_line(protocol, trial, line if found is None else found[1])
    return confidence is not None or protocol.asks.confidence is None


def _is_answer(protocol: Protocol, trial: Trial, line: str) -> bool:
    """Whether a line is an answer and no order; ValueError if it does not suit its trial."""
    found = find_order(line)
    if found is not None and found[0].word != "answer":
        return False
    scale = protocol.asks.confidence
    if not _is_whole(protocol, trial, line) and scale is not None:
        raise ValueError(
            f"it has no confidence; give one after a semicolon, such as '{line}; {scale.most}'"
        )
    return True
