"""Whether a session's directory is whole, and its files agree."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import VbrailleError
from vbraille.sessions import journal
from vbraille.sessions.plan import check_plan
from vbraille.sessions.progress import Progress
from vbraille.sessions.traces import read_trace

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from vbraille.sessions.record import Record
    from vbraille.sessions.traces import Trace


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was looked at.

    Parameters
    ----------
    text
        What there is to say of it.
    good
        Whether it is as it should be.
    """

    text: str
    good: bool = True


def check(record: Record) -> Iterator[Finding]:
    """Look at every file of a session."""
    told = record.told
    yield Finding("session.json, plan.json, protocol.toml: as they were when the session began")
    try:
        check_plan(record.protocol, record.plan)
        yield Finding(f"plan: {len(record.plan.trials)} trials, all design rules hold")
    except VbrailleError as error:
        yield Finding(f"plan: {error}", good=False)
    if told.damage is not None:
        before = f"the {len(told.events)} events before it are whole"
        yield Finding(f"{journal.NAME}: damaged, {told.damage}; {before}", good=False)
    else:
        yield Finding(f"{journal.NAME}: {len(told.events)} events, whole")
    if told.torn:
        yield Finding(
            f"{journal.NAME}: its last line was cut short, {len(told.torn)} bytes; "
            f"session resume sets them aside"
        )
    progress = Progress(record.plan, told.events)
    yield from _check_torn(record.folder / journal.TORN, progress)
    yield from _check_traces(record, progress)
    state = "ended" if progress.ended else "not ended, session resume goes on"
    yield Finding(f"answers: {progress.done} of {len(record.plan.trials)}; the session is {state}")


def _check_torn(path: Path, progress: Progress) -> Iterator[Finding]:
    """Bytes set aside must be those that the journal tells of; each tail has a line break after."""
    tails = [run["torn_bytes"] for run in progress.runs if run.get("torn_bytes")]
    length = path.stat().st_size if path.exists() else 0
    if not tails and not length:
        return
    agree = length == sum(tails) + len(tails)
    yield Finding(
        f"{path.name}: {sum(tails)} bytes set aside by session resume after a crash"
        if agree
        else f"{path.name}: {length} bytes, and the journal tells of {sum(tails)}",
        good=agree,
    )


def _check_traces(record: Record, progress: Progress) -> Iterator[Finding]:
    expected = {run["trace"] for run in progress.runs if "trace" in run}
    answered, known = _answered_lines(progress), _known_lines(progress)
    for path in sorted({*record.folder.glob("trace-*"), *map(record.folder.joinpath, expected)}):
        try:
            trace = read_trace(path)
        except VbrailleError as error:
            yield Finding(str(error), good=False)
            continue
        lines = set(np.unique(trace.ticks["line"]).tolist())
        if path.name not in expected:
            # A run that was killed before the journal told of it has shown nothing.
            yield Finding(f"{path.name}: the journal does not tell of it", good=lines <= {0})
            continue
        yield _describe(path.name, trace)
        if trace.damage is None:
            yield from _compare(path.name, lines, answered.get(path.name, set()), known | {0})


def _describe(name: str, trace: Trace) -> Finding:
    ticks = trace.ticks
    if trace.damage is not None:
        whole = f"the {ticks.size} ticks before it are whole"
        return Finding(f"{name}: damaged, {trace.damage}; {whole}", good=False)
    missing = int((np.diff(ticks["tick"]) - 1).sum()) if ticks.size else 0
    late = int(ticks["late"][-1]) if ticks.size else 0
    said = f"{name}: {ticks.size} ticks, {missing} missing, {late} deadlines late"
    if trace.torn_bytes:
        said += f"; its last chunk was cut short, {trace.torn_bytes} bytes"
    return Finding(said, good=not missing)


def _compare(name: str, lines: set[int], answered: set[int], known: set[int]) -> Iterator[Finding]:
    """What a trace and the journal tell of one another."""
    for which, what in (
        (answered - lines, "was answered and is not in it"),
        (lines - known, "is in it, and the journal does not tell of it"),
    ):
        for line in sorted(which):
            yield Finding(f"{name}: the stimulus with line {line} {what}", good=False)


def _answered_lines(progress: Progress) -> dict[str, set[int]]:
    """Lines of the showings that answers rest on, by trace."""
    lines: dict[str, set[int]] = {}
    for told in progress.trials.values():
        if told.answer is None and told.first_answer is None:
            continue
        for showing in told.last_attempt:
            if showing.trace is not None:
                lines.setdefault(showing.trace, set()).add(showing.line)
    return lines


def _known_lines(progress: Progress) -> set[int]:
    trials = (*progress.trials.values(), *progress.practice.values())
    return {showing.line for told in trials for showing in told.showings}
