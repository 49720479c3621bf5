"""Check whether a session's directory is whole, and whether its files agree."""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import sha256
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import VbrailleError
from vbraille.sessions.planning.making import check_plan
from vbraille.sessions.record import journal
from vbraille.sessions.record.events import Closed, Lost, Run
from vbraille.sessions.record.folder import (
    FILES,
    Record,
    load,
    missed_tie,
    read_file,
    read_journal,
    read_told_trace,
    whole_lines,
)
from vbraille.sessions.record.progress import Progress
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from vbraille.sessions.record.journal import JournalContents
    from vbraille.sessions.record.traces import Trace


@dataclass(frozen=True, slots=True)
class Finding:
    """Result of one check.

    Parameters
    ----------
    text
        Sentence about what was found.
    good
        Whether all is as it should be.
    """

    text: str
    good: bool = True


def check_folder(folder: Path, expected: str | None = None) -> Iterator[Finding]:
    """Check every file of a session, even if some of them cannot be used.

    Parameters
    ----------
    folder
        Directory of the session.
    expected
        SHA-256 of the journal, or its first digits, as a stop, the end or an export told it.

    Raises
    ------
    InputError
        If the directory holds no session, or one of another format.
    VbrailleError
        If there is no journal that can be used.
    """
    told = read_journal(folder, salvaged=True)
    faults: list[Finding] = []
    for name in told.session.sha256:
        try:
            read_file(folder, name, told)
        except VbrailleError as error:
            faults.append(Finding(str(error), good=False))
    if not faults:
        yield from check(load(folder, salvaged=True))
        yield from _check_sum(folder, expected)
        return
    yield from faults
    yield from _check_journal(told)
    yield from _check_torn(folder, told)
    yield from _check_sum(folder, expected)
    runs = [event for event in told.events if isinstance(event, Run)]
    for name in _trace_names(folder, runs):
        yield _describe(name, read_told_trace(folder, name, told))


def check(record: Record) -> Iterator[Finding]:
    """Check every file of a session whose first three files are whole."""
    told = record.told
    names = ", ".join([*FILES, *record.protocol.files])
    yield Finding(f"{names}: as they were when the session began")
    try:
        check_plan(record.protocol, record.plan)
        deck = " to choose the values of" if record.protocol.adaptive else ""
        yield Finding(f"plan: {len(record.plan.trials)} trials{deck}, as the seed makes them")
    except VbrailleError as error:
        yield Finding(f"plan: {error}", good=False)
    yield from _check_journal(told)
    yield from _check_torn(record.folder, told)
    yield from _check_watched(record)
    progress = Progress(record.plan, told.events, record.procedure)
    yield from _check_traces(record, progress)
    yield from _check_choices(record, progress)
    state = "ended" if progress.ended else "not ended, session resume goes on"
    yield Finding(f"answers: {progress.of_all(progress.done)}; the session is {state}")


def _check_choices(record: Record, progress: Progress) -> Iterator[Finding]:
    """Check that each trial was shown as the procedure chooses it after the answers before it."""
    if not record.protocol.adaptive or record.told.bad:
        return
    asked = 0
    for told in progress.trials.values():
        for showing in told.showings:
            if showing.stimulus_of(told.trial) != told.trial.stimuli[showing.stimulus]:
                what = "was shown with other values than the answers before it ask for"
                yield Finding(f"procedure: trial {told.trial.number} {what}", good=False)
                break
        asked += bool(told.showings)
    yield Finding(f"procedure: {asked} trials compared with what the answers before them ask for")


def _check_journal(told: JournalContents) -> Iterator[Finding]:
    if told.damage is not None:
        before = len(told.crcs)
        whole = f"the {before} events before it are whole"
        after = sum(not isinstance(event, Lost) for event in told.events[before:])
        if after:
            whole += f", and {after} after it, which session export {setting('salvage')} has too"
        yield Finding(f"{journal.NAME}: damaged, {told.damage}; {whole}", good=False)
        for line, previous in zip(told.bad[1:], told.bad, strict=False):
            if line != previous + 1:
                what = f"line {line} does not match its checksum either"
                yield Finding(f"{journal.NAME}: damaged, {what}", good=False)
    else:
        yield Finding(f"{journal.NAME}: {len(told.events)} events, whole")
        runs = [event for event in told.events if isinstance(event, Run)]
        if runs and runs[-1].trace and not isinstance(told.events[-1], Closed):
            yield Finding(
                f"{journal.NAME}: its last run was not closed; it goes on, or was cut short, or "
                f"lines were taken off its end"
            )
    if told.torn:
        yield Finding(
            f"{journal.NAME}: its last line was cut short, {len(told.torn)} bytes; "
            f"session resume sets them aside"
        )


def _check_sum(folder: Path, expected: str | None) -> Iterator[Finding]:
    """Tell the journal's checksum, and compare it with one that was kept elsewhere."""
    content = whole_lines(folder)
    yield Finding(f"record: {journal.sum_of(content)}")
    if expected is None:
        return
    lines, so_far = content.split(b"\n")[:-1], sha256()
    for number, line in enumerate(lines, 1):
        so_far.update(line + b"\n")
        if so_far.hexdigest().startswith(expected):
            after = len(lines) - number
            more = f"; {after} events came after them" if after else ""
            yield Finding(f"expected: the sum is that of the first {number} events{more}")
            return
    what = "it was changed since, or the sum is another session's"
    yield Finding(f"expected: the sum is not that of this journal; {what}", good=False)


def _check_torn(folder: Path, told: JournalContents) -> Iterator[Finding]:
    """Check that `journal.torn` begins with everything that the journal says was set aside."""
    try:
        torn = (folder / journal.TORN).read_bytes()
    except FileNotFoundError:
        torn = b""
    except OSError as error:
        yield Finding(f"{journal.TORN} cannot be read: {error.strerror}", good=False)
        return
    sums = [run.torn_file for run in told.events if isinstance(run, Run) and run.torn_file]
    good = all(journal.sum_of_torn(torn[: known["bytes"]]) == known for known in sums)
    if not good:
        yield Finding(f"{journal.TORN}: {len(torn)} bytes, and not those set aside", good=False)
    elif torn:  # if a crash came at once, the journal may not tell of the last bytes
        yield Finding(f"{journal.TORN}: {len(torn)} bytes set aside by session resume")


def _check_watched(record: Record) -> Iterator[Finding]:
    """Check that the live view has hidden stimuli in every run if the protocol says so."""
    runs = [event for event in record.told.events if isinstance(event, Run)]
    blind = record.protocol.session.blind
    for number, run in enumerate(runs, 1):
        if run.monitor is None:
            continue
        shown = not run.monitor.blind
        said = f"live view: run {number} was shown at {run.monitor.host}"
        if shown and blind:
            text = f"{said} with its stimuli, and the protocol says blind"
            yield Finding(text, good=False)
        else:
            yield Finding(f"{said}, {'with its stimuli' if shown else 'blind'}")


def _check_traces(record: Record, progress: Progress) -> Iterator[Finding]:
    told = record.told
    expected = {run.trace for run in progress.runs if run.trace}
    answered, known = _answered_lines(progress), _known_lines(progress)
    # After a crash, a trace may go on where the journal has lost its end.
    open_end = bool(told.torn) or not told.events or not isinstance(told.events[-1], Closed)
    for name in _trace_names(record.folder, progress.runs):
        trace = read_told_trace(record.folder, name, told)
        yield _describe(name, trace)
        if name not in expected and not told.bad:
            yield Finding(f"{name}: of a run that the journal does not tell of")
        # A damage is told once: a file that is not whole is compared with no other.
        if trace.damage is None and not told.bad:
            yield from _check_tie(record.folder / name, trace, told)
            lines = set(np.unique(trace.ticks["line"]).tolist())
            yield from _compare(name, lines, answered.get(name, set()), known | {0}, open_end)


def _check_tie(path: Path, trace: Trace, told: JournalContents) -> Iterator[Finding]:
    """Check that the journal has all lines that it had when a trace was written."""
    if (fault := missed_tie(trace.ties, told)) is not None:
        yield Finding(f"{path.name}: {fault}", good=False)
    closed = [event for event in told.events if isinstance(event, Closed)]
    sums = [event.trace_sha256 for event in closed if event.trace == path.name]
    if sums and sums[-1] != sha256(path.read_bytes()).hexdigest():
        yield Finding(f"{path.name}: it is not what it was when it was closed", good=False)


def _trace_names(folder: Path, runs: list[Run]) -> list[str]:
    """Names of all traces that exist or should exist."""
    told = {run.trace for run in runs if run.trace}
    return sorted(told | {path.name for path in folder.glob("trace-*.gz")})


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


def _compare(
    name: str, lines: set[int], answered: set[int], known: set[int], open_end: bool
) -> Iterator[Finding]:
    """Compare the stimuli in a trace with those that the journal tells of."""
    for line in sorted(answered - lines):
        yield Finding(f"{name}: stimulus {line} was answered and is not in it", good=False)
    for line in sorted(lines - known):
        text = f"{name}: stimulus {line} is in it, and the journal does not tell of it"
        yield Finding(text, good=open_end)


def _answered_lines(progress: Progress) -> dict[str, set[int]]:
    """Line numbers of the showings that were answered, by the name of the trace."""
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
