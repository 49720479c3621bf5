"""Where the answers of a session come from: a spec, the lines themselves, or a function."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.sessions.running.answers import Answers, ScriptedAnswers, Typed, parse_answers
from vbraille.sessions.running.given import GivenAnswers, check_script
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.progress import Progress

    # What answers may be taken from: a spec as in `Conditions`, a source that is made already, a
    # line for each trial, or a function that gives the line for a trial.
    Source = str | Answers | Iterable[str] | Callable[[Trial], str | None]


def answers_from(
    source: Source, protocol: Protocol, plan: Plan, progress: Progress, *, fast: bool
) -> Answers:
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
        answers = parse_answers(source, protocol, plan, used)
    elif isinstance(source, Answers):
        answers = source
    else:
        answers = GivenAnswers(protocol, source)
    if fast and isinstance(answers, Typed):
        raise InputError(
            f"{setting('fast')} is for answers that are not typed; "
            f"give {setting('answers')} simulated"
        )
    if isinstance(answers, ScriptedAnswers):
        check_script(answers, protocol, progress)
    return answers
