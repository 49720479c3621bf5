"""Sources of responses: made of a spec, lines or a function, and checked beforehand."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.sessions.running.console import find_command, read_line
from vbraille.sessions.running.reader import ReaderHabits, Simulated, SimulatedNaming
from vbraille.sessions.running.responses import (
    PROGRAM,
    Responses,
    Scripted,
    TrialResponses,
    Typed,
)
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.questionnaire import AnyItem
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.progress import Progress
    from vbraille.sessions.simulated.skin import FeltFrames

    # What answers may be taken from: a spec as in `Conditions`, a source that is made already, a
    # line for each trial and each question, or a function that gives the line for one of them.
    Source = str | Responses | Iterable[str] | Callable[[Any], str | None]


class ProgramResponses(TrialResponses):
    """Source of answers that asks a program for a line whenever a trial has been read.

    Parameters
    ----------
    protocol
        Protocol that the answers are checked against.
    given
        The lines, one for each trial and each question of the questionnaire, or a function that
        gives the line for a trial or a question. If the lines end, or the function gives None, the
        session stops and can be resumed.
    """

    name = PROGRAM

    def __init__(
        self, protocol: Protocol, given: Iterable[str] | Callable[[Any], str | None]
    ) -> None:
        self._protocol = protocol
        if callable(given):
            self._give = given
        else:
            lines = iter(given)
            self._give = lambda _trial: next(lines, None)
        self._answered: tuple[bool, int, int] | None = None

    def next(
        self, trial: Trial, attempt: int, _felt: list[FeltFrames], /
    ) -> tuple[str, int] | None:
        """Line of the program for a trial; None if there is none, or the trial was answered.

        Raises
        ------
        InputError
            If the line is no text, or neither an answer to the trial nor a command.
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

    def reply(self, item: AnyItem, _columns: Mapping[str, str], /) -> tuple[str, int] | None:
        """Line of the program for a question of the questionnaire; None if there is none."""
        line = self._give(item)
        return None if line is None else (line, 0)


def _expected(
    protocol: Protocol, progress: Progress, trials: tuple[Trial, ...]
) -> Iterator[Trial | tuple[AnyItem, Trial | None]]:
    """Trials and questions that are to be answered from here on, in order."""
    items, done = protocol.questionnaire, progress.done

    def asked(when: str, number: int, trial: Trial | None = None) -> Iterator[Any]:
        for item in items:
            if item.when == when and (item.name, number) not in progress.replies:
                yield item, trial

    yield from asked("begin", 0)
    for place, trial in enumerate(trials):
        if place >= done:
            yield trial
        if place >= done - 1:
            if not trial.catch:
                yield from asked("trial", trial.number, trial)
            if place + 1 == len(trials) or trials[place + 1].block != trial.block:
                yield from asked("block", trial.block)
    yield from asked("end", 0)


def check_script(script: Scripted, protocol: Protocol, progress: Progress) -> None:
    """Raise InputError if a line of an answers file does not answer its trial."""
    planned = progress.procedure.trials
    if planned is None:  # it is not known yet which trials will come
        return
    trials = _expected(protocol, progress, planned)
    correcting, answered = progress.correcting, progress.last_answered
    half = again = None  # a trial without a confidence yet, and one whose answer was dropped so
    for line, number in script.left:
        found = find_command(line)
        word = "answer" if found is None else found[0].word
        if word in ("undo", "repeat") and half is not None:
            half, again = None, half
        elif word == "undo":
            correcting = correcting or answered
        if word != "answer" or protocol.asks.steps(line) is not None:
            continue
        trial = half or again or correcting or next(trials, None)
        if trial is None:
            raise InputError(f"{script.path} line {number}: there is no trial left to answer")
        try:
            if isinstance(trial, tuple):
                item, beside = trial
                columns = protocol.columns_of(beside.item) if beside else {}
                item.parse(line if found is None else found[1], columns)
                continue
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
    """True if a line has all that is asked; ValueError if it does not suit its trial."""
    found = find_command(line)
    _, confidence = read_line(protocol, trial, line if found is None else found[1])
    return confidence is not None or protocol.asks.confidence is None


def _is_answer(protocol: Protocol, trial: Trial, line: str) -> bool:
    """True if a line is an answer and no command; ValueError if it does not suit its trial."""
    found = find_command(line)
    turns = protocol.asks.steps(line) is not None
    if (found is not None and found[0].word != "answer") or turns:
        return False
    scale = protocol.asks.confidence
    if not _is_whole(protocol, trial, line) and scale is not None:
        raise ValueError(
            f"it has no confidence; give one after a semicolon, such as '{line}; {scale.most}'"
        )
    return True


def parse_responses(spec: str, protocol: Protocol, plan: Plan, after: int = 0) -> Responses:
    """Make the source of answers for a spec.

    That is ``typed``, ``simulated[:NOISE][,lapses=SHARE][,false-alarms=SHARE]``, or a file's name.

    Raises
    ------
    InputError
        If the spec, or the file that it names, cannot be used.
    """
    kind, _, habits = spec.partition(":")
    if kind == "typed" and not habits:
        return Typed()
    if spec == PROGRAM:
        raise InputError(f"the answers came from a program; give {setting('answers')} typed")
    if kind == "simulated":
        person = SimulatedNaming if protocol.pictures else Simulated
        answers = person(protocol, plan, ReaderHabits.parse(habits))
    else:
        from difflib import get_close_matches  # takes long to load

        if not Path(spec).exists() and get_close_matches(kind, ("typed", "simulated")):
            raise InputError(
                f"{spec} is no file; give typed, simulated:NOISE such as simulated:0.2, or the "
                f"name of a file"
            )
        answers = Scripted(Path(spec), after)
    answers.name = spec
    return answers


def responses_of(
    source: Source, protocol: Protocol, plan: Plan, progress: Progress, *, fast: bool
) -> Responses:
    """Make the source of a session's answers, and check it.

    Parameters
    ----------
    source
        What the answers are taken from.
    protocol, plan, progress
        What the session shows, in which order, and how far it has come.
    fast
        Whether the session runs as fast as the machine can.

    Raises
    ------
    InputError
        If the answers cannot be used with this session.
    """
    if isinstance(source, str):
        used = progress.script_lines.get(source, 0)
        answers = parse_responses(source, protocol, plan, used)
    elif isinstance(source, Responses):
        answers = source
    else:
        answers = ProgramResponses(protocol, source)
    if fast and isinstance(answers, Typed):
        raise InputError(
            f"{setting('fast')} is for answers that are not typed; "
            f"give {setting('answers')} simulated"
        )
    if isinstance(answers, Scripted):
        check_script(answers, protocol, progress)
    return answers
