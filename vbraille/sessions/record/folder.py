"""A session's directory: its files, whose they are, and a check whether they are whole and agree.

`docs/session-format.md` describes the files.
"""

from __future__ import annotations

import gzip
import json
import platform
import re
import sys
import zlib
from dataclasses import dataclass, replace
from hashlib import sha256
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.errors import InputError, VbrailleError
from vbraille.files import write_folder
from vbraille.sessions.planning.making import check_plan
from vbraille.sessions.planning.nexttrial import Procedure, procedure_of
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record.events import Closed, Lost, Run, Session
from vbraille.sessions.record.journal import NAME as JOURNAL
from vbraille.sessions.record.journal import (
    TORN,
    JournalContents,
    Tie,
    decode,
    first_lines,
    salvage,
    sum_of,
    sum_of_torn,
)
from vbraille.sessions.record.progress import Progress, stimulus_of
from vbraille.sessions.record.traces import LAST_FIELD, NO_TRACE, ChunkedTrace, Trace, read_last_tie
from vbraille.version import __version__
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from vbraille.sessions.planning.protocol import Protocol

FORMAT = 8
HEAD, PLAN, PROTOCOL = "session.json", "plan.json", "protocol.toml"
FILES = (HEAD, PLAN, PROTOCOL)
_TOLD_VERSIONS = ("numpy", "numba", "pyserial", "cobs", "h5py")


@dataclass(frozen=True, slots=True)
class Record:
    """Content of a session's directory.

    Parameters
    ----------
    folder
        The directory.
    head
        Content of session.json: who takes part, what is shown, and with which equipment.
    protocol, plan
        What the session shows, and in which order.
    journal
        Content of the journal at the time when it was read.
    procedure
        Rule that chooses the next trial.
    """

    folder: Path
    head: dict[str, Any]
    protocol: Protocol
    plan: Plan
    journal: JournalContents
    procedure: Procedure

    def progress(self) -> Progress:
        """Progress of the session by then."""
        return Progress(self.plan, self.journal.events, self.procedure)


def create(folder: Path, protocol: Protocol, plan: Plan, head: dict[str, Any]) -> None:
    """Put a new session on the disk, either whole or not at all.

    Raises
    ------
    InputError
        If the path exists already, or no directory can be made there.
    VbrailleError
        If the disk does not take the session.
    """
    files = {
        PROTOCOL: protocol.text.encode(),
        PLAN: plan.to_json().encode(),
        # A lone surrogate, which a file's name may have, becomes an escape of JSON.
        **{name: text.encode() for name, text in protocol.files.items()},
        HEAD: (json.dumps(head, ensure_ascii=False, indent=2) + "\n").encode(
            "utf-8", "backslashreplace"
        ),
    }
    sums = {name: sha256(content).hexdigest() for name, content in files.items()}
    # The others' checksums are in the journal, as its first event.
    files[JOURNAL] = first_lines(Session(format=FORMAT, sha256=sums, t_s=0.0))
    write_folder(
        folder, files, durable=True, private=True, clear=lambda partial: _clear(partial, files)
    )


def read_journal(folder: Path, *, salvaged: bool = False) -> JournalContents:
    """Read the journal of a session, up to a damage or a torn end.

    If it is salvaged, the events after a damage are read as well.

    Raises
    ------
    InputError
        If the directory holds no session, or one of another format.
    VbrailleError
        If the journal cannot be read, or its first line is damaged.
    """
    path, content = folder / JOURNAL, _journal_bytes(folder)
    contents = salvage(content) if salvaged else decode(content)
    if not contents.events:
        raise VbrailleError(f"{path} is damaged in its first line; there is nothing to go by")
    first = contents.events[0]
    if 1 in contents.bad and not (
        isinstance(first, Session) and first.sha256.keys() >= set(FILES) and first.format == FORMAT
    ):
        raise VbrailleError(f"{path} is damaged in its first line; there is nothing to go by")
    if not isinstance(first, Session):
        raise InputError(f"{path} is not the journal of a session")
    if first.format != FORMAT:
        raise InputError(
            f"{folder} is a session of format {first.format}, and this vbraille knows format "
            f"{FORMAT}; use the vbraille that made it"
        )
    return contents


def whole_lines(folder: Path) -> bytes:
    """Bytes of the journal of a session, without a torn end.

    Raises
    ------
    VbrailleError
        If the journal cannot be read.
    """
    content = _journal_bytes(folder)
    return content[: content.rfind(b"\n") + 1]


def read_file(folder: Path, name: str, contents: JournalContents) -> bytes:
    """Read one of `FILES`, and check that it is as it was when the session began.

    Raises
    ------
    VbrailleError
        If the file is missing or was changed.
    """
    path = folder / name
    try:
        content = path.read_bytes()
    except OSError as error:
        raise VbrailleError(f"{path} cannot be read: {error.strerror}") from None
    if sha256(content).hexdigest() != contents.session.sha256[name]:
        raise VbrailleError(
            f"{path} is not what it was when the session began; "
            f"put it back as it was, nothing else was changed"
        )
    return content


def load(folder: Path, *, salvaged: bool = False) -> Record:
    """Read a session's directory; `read_journal` says what is read of a damaged journal.

    Raises
    ------
    InputError
        If the directory holds no session, or one of another format.
    VbrailleError
        If the journal cannot be used, or another file is missing or was changed.
    """
    contents = read_journal(folder, salvaged=salvaged)
    texts = {name: read_file(folder, name, contents).decode() for name in FILES}
    plan = Plan.from_json(texts[PLAN])

    def beside(name: str) -> str:
        if name not in contents.session.sha256:
            raise VbrailleError(f"{folder} has lost {name} of its protocol; nothing was changed")
        return read_file(folder, name, contents).decode()

    where = str(folder / PROTOCOL)
    whole = parse_protocol(texts[PROTOCOL], where, planned=True, beside=beside)
    try:
        protocol = whole.assigned(plan.group)
    except ValueError as error:
        raise VbrailleError(f"{folder / PLAN} is damaged: {error}; put it back") from None
    head = json.loads(texts[HEAD])
    return Record(folder, head, protocol, plan, contents, procedure_of(protocol, plan))


def open_told_trace(
    folder: Path, name: str, contents: JournalContents
) -> tuple[ChunkedTrace | None, str | None]:
    """Open a trace of a session; give it, if it can be read, and what is damaged of it, if any is.

    A trace also counts as damaged if it is missing, or does not have the length that the journal
    tells.
    """
    path = folder / name
    try:
        chunks = ChunkedTrace(path, checked=True)
    except VbrailleError:
        return None, "it cannot be read" if path.exists() else "it is gone"
    closed = {
        event.trace: event.trace_bytes for event in contents.events if isinstance(event, Closed)
    }
    damage = chunks.fault()
    if damage is None and name in closed and chunks.size_bytes != closed[name]:
        damage = f"it has {chunks.size_bytes} bytes, and had {closed[name]} when it was closed"
    elif damage is None and chunks.torn_bytes and (name in closed or _is_member(path, chunks)):
        damage = "its last chunk has a wrong length"
    return chunks, damage


def read_told_trace(
    folder: Path, name: str, contents: JournalContents, upto: str = LAST_FIELD
) -> Trace:
    """Read a trace of a session, up to its last whole chunk and to a field of `TRACE`."""
    chunks, damage = open_told_trace(folder, name, contents)
    trace = NO_TRACE if chunks is None else chunks.whole(upto)
    return replace(trace, damage=damage)


def missed_tie(ties: Iterable[Tie], contents: JournalContents) -> str | None:
    """Say which events the journal has lost since a trace was written; None if it has all."""
    for number, crc in ties:
        if number > len(contents.events):
            return (
                f"it was written when {JOURNAL} had {number} events, and it has "
                f"{len(contents.events)}: events were lost or taken off its end"
            )
        if number and contents.crcs[number - 1] != crc:
            return (
                f"it was written when event {number} of {JOURNAL} was another: events were "
                f"taken off its end and replaced"
            )
    return None


def check_end(folder: Path, contents: JournalContents) -> None:
    """Check that a journal has all events that it had when its traces were written.

    Raises
    ------
    VbrailleError
        If some are missing: nothing may be added to the journal then.
    """
    for path in sorted(folder.glob("trace-*.gz")):
        tie = read_last_tie(path)
        fault = None if tie is None else missed_tie([tie], contents)
        if fault is not None:
            raise VbrailleError(
                f"{folder} is not whole: of {path.name}, {fault}; nothing was changed"
            )


def versions() -> dict[str, str]:
    """Versions of all programs that affect what the actuators do."""
    return {
        "vbraille": __version__,
        "python": sys.version.split()[0],
        **{name: version(name) for name in _TOLD_VERSIONS},
        "system": platform.platform(),
    }


def _journal_bytes(folder: Path) -> bytes:
    try:
        return (folder / JOURNAL).read_bytes()
    except OSError as error:
        raise _no_journal(folder, error) from None


def _no_journal(folder: Path, error: OSError) -> VbrailleError:
    """Make the error that says why there is no journal to be read."""
    try:
        names = {path.name for path in folder.iterdir()}
    except FileNotFoundError:
        return InputError(f"there is no directory {folder}; give that of a session")
    except OSError as fault:
        return InputError(f"{folder} cannot be read: {fault.strerror}; give a session's directory")
    if JOURNAL in names:
        return VbrailleError(f"{folder / JOURNAL} cannot be read: {error.strerror}")
    if names.issuperset(FILES):
        return VbrailleError(f"{folder} has lost its {JOURNAL}; there is nothing to go by")
    return InputError(f"{folder} is not the directory of a session: it has no {JOURNAL}")


def _is_member(path: Path, trace: ChunkedTrace) -> bool:
    """True if the torn end of a trace is a whole chunk, which only states a wrong length."""
    try:
        gzip.decompress(path.read_bytes()[-trace.torn_bytes :])
    except (OSError, EOFError, zlib.error):
        return False
    return True


def _clear(partial: Path, names: Iterable[str]) -> None:
    """Remove the files of a session whose creation was interrupted, and nothing else."""
    for name in names:
        (partial / name).unlink(missing_ok=True)
    partial.rmdir()


def label_of(pseudonym: str) -> str:
    """Label that BIDS takes for a pseudonym or other name: its letters and digits alone."""
    return re.sub(r"[^A-Za-z0-9]", "", pseudonym)


def alike(one: str, other: str) -> bool:
    """True if two pseudonyms differ only in case, leading zeros, or signs that labels lack."""
    return _plain(one) == _plain(other) or label_of(one).lower() == label_of(other).lower()


def participants_in(room: Path) -> dict[str, str]:
    """Participants whose sessions are in a directory, each with the name of one session."""
    found: dict[str, str] = {}
    try:
        heads = sorted(room.glob(f"*/{HEAD}"))
    except OSError:
        return {}
    for head in heads:
        try:
            content = json.loads(head.read_text("utf-8"))
            found.setdefault(str(content["participant"]), head.parent.name)
        except (OSError, ValueError, KeyError, TypeError):
            continue  # this is no readable session; using it says so
    return found


def nearly_same(room: Path, participant: str) -> tuple[str, str] | None:
    """Another participant in a directory whose pseudonym is similar to a new one.

    Returns
    -------
    tuple[str, str] or None
        Pseudonym of the other participant, and the name of one of their sessions. None if there
        is no such participant, or the new pseudonym is already in the directory itself.
    """
    known = participants_in(room)
    if participant in known:
        return None
    return next(((other, known[other]) for other in known if alike(other, participant)), None)


def _plain(pseudonym: str) -> str:
    return label_of(re.sub(r"(?<![0-9])0+(?=[0-9])", "", pseudonym)).lower()


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
        SHA-256 of the journal, or its first digits, as a stop, the end or an export tells it.

    Raises
    ------
    InputError
        If the directory holds no session, or one of another format.
    VbrailleError
        If there is no journal that can be used.
    """
    contents = read_journal(folder, salvaged=True)
    faults: list[Finding] = []
    for name in contents.session.sha256:
        try:
            read_file(folder, name, contents)
        except VbrailleError as error:
            faults.append(Finding(str(error), good=False))
    if not faults:
        yield from check(load(folder, salvaged=True))
        yield from _check_sum(folder, expected)
        return
    yield from faults
    yield from _check_journal(contents)
    yield from _check_torn(folder, contents)
    yield from _check_sum(folder, expected)
    runs = [event for event in contents.events if isinstance(event, Run)]
    for name in _trace_names(folder, runs):
        yield _describe(name, read_told_trace(folder, name, contents))


def check(record: Record) -> Iterator[Finding]:
    """Check every file of a session whose first three files are whole."""
    contents = record.journal
    names = ", ".join([*FILES, *record.protocol.files])
    yield Finding(f"{names}: as they were when the session began")
    try:
        check_plan(record.protocol, record.plan)
        deck = " to choose the values of" if record.protocol.adaptive else ""
        yield Finding(f"plan: {len(record.plan.trials)} trials{deck}, as the seed makes them")
    except VbrailleError as error:
        yield Finding(f"plan: {error}", good=False)
    yield from _check_journal(contents)
    yield from _check_torn(record.folder, contents)
    yield from _check_watched(record)
    progress = record.progress()
    yield from _check_traces(record, progress)
    yield from _check_choices(record, progress)
    why = f", {progress.why}" if progress.why else ""
    state = f"ended{why}" if progress.ended else "not ended, session resume goes on"
    yield Finding(f"answers: {progress.of_all(progress.done)}; the session is {state}")


def _check_choices(record: Record, progress: Progress) -> Iterator[Finding]:
    """Check that each trial was shown as the procedure chooses it after the answers before it."""
    if not record.protocol.adaptive or record.journal.bad:
        return
    asked = 0
    for state in progress.trials.values():
        for showing in state.showings:
            if stimulus_of(showing) != state.trial.stimuli[showing.stimulus]:
                what = "was shown with other values than the answers before it ask for"
                yield Finding(f"procedure: trial {state.trial.number} {what}", good=False)
                break
        asked += bool(state.showings)
    yield Finding(f"procedure: {asked} trials compared with what the answers before them ask for")


def _check_journal(contents: JournalContents) -> Iterator[Finding]:
    if contents.damage is not None:
        before = len(contents.crcs)
        whole = f"the {before} events before it are whole"
        after = sum(not isinstance(event, Lost) for event in contents.events[before:])
        if after:
            whole += f", and {after} after it, which session export {setting('salvage')} has too"
        yield Finding(f"{JOURNAL}: damaged, {contents.damage}; {whole}", good=False)
        for line, previous in zip(contents.bad[1:], contents.bad, strict=False):
            if line != previous + 1:
                what = f"line {line} does not match its checksum either"
                yield Finding(f"{JOURNAL}: damaged, {what}", good=False)
    else:
        yield Finding(f"{JOURNAL}: {len(contents.events)} events, whole")
        runs = [event for event in contents.events if isinstance(event, Run)]
        if runs and runs[-1].trace and not isinstance(contents.events[-1], Closed):
            yield Finding(
                f"{JOURNAL}: its last run was not closed; it goes on, or was cut short, or "
                f"lines were taken off its end"
            )
    if contents.torn:
        yield Finding(
            f"{JOURNAL}: its last line was cut short, {len(contents.torn)} bytes; "
            f"session resume sets them aside"
        )


def _check_sum(folder: Path, expected: str | None) -> Iterator[Finding]:
    """Tell the journal's checksum, and compare it with one that was kept elsewhere."""
    content = whole_lines(folder)
    yield Finding(f"record: {sum_of(content)}")
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


def _check_torn(folder: Path, contents: JournalContents) -> Iterator[Finding]:
    """Check that `journal.torn` begins with everything that the journal says was set aside."""
    try:
        torn = (folder / TORN).read_bytes()
    except FileNotFoundError:
        torn = b""
    except OSError as error:
        yield Finding(f"{TORN} cannot be read: {error.strerror}", good=False)
        return
    sums = [run.torn_file for run in contents.events if isinstance(run, Run) and run.torn_file]
    good = all(sum_of_torn(torn[: known["bytes"]]) == known for known in sums)
    if not good:
        yield Finding(f"{TORN}: {len(torn)} bytes, and not those set aside", good=False)
    elif torn:  # if a crash came at once, the journal may not tell of the last bytes
        yield Finding(f"{TORN}: {len(torn)} bytes set aside by session resume")


def _check_watched(record: Record) -> Iterator[Finding]:
    """Check that the live view has hidden stimuli in every run if the protocol says so."""
    runs = [event for event in record.journal.events if isinstance(event, Run)]
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
    contents = record.journal
    expected = {run.trace for run in progress.runs if run.trace}
    answered, known = _answered_lines(progress), _known_lines(progress)
    # After a crash, a trace may go on where the journal has lost its end.
    open_end = (
        bool(contents.torn) or not contents.events or not isinstance(contents.events[-1], Closed)
    )
    for name in _trace_names(record.folder, progress.runs):
        trace = read_told_trace(record.folder, name, contents)
        yield _describe(name, trace)
        if name not in expected and not contents.bad:
            yield Finding(f"{name}: of a run that the journal does not tell of")
        # A damage is told once: a file that is not whole is compared with no other.
        if trace.damage is None and not contents.bad:
            yield from _check_tie(record.folder / name, trace, contents)
            lines = set(np.unique(trace.ticks["line"]).tolist())
            yield from _compare(name, lines, answered.get(name, set()), known | {0}, open_end)


def _check_tie(path: Path, trace: Trace, contents: JournalContents) -> Iterator[Finding]:
    """Check that the journal has all lines that it had when a trace was written."""
    if (fault := missed_tie(trace.ties, contents)) is not None:
        yield Finding(f"{path.name}: {fault}", good=False)
    closed = [event for event in contents.events if isinstance(event, Closed)]
    sums = [event.trace_sha256 for event in closed if event.trace == path.name]
    if sums and sums[-1] != sha256(path.read_bytes()).hexdigest():
        yield Finding(f"{path.name}: it is not what it was when it was closed", good=False)


def _trace_names(folder: Path, runs: list[Run]) -> list[str]:
    """Names of all traces that exist or should exist."""
    expected = {run.trace for run in runs if run.trace}
    return sorted(expected | {path.name for path in folder.glob("trace-*.gz")})


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
    for state in progress.trials.values():
        if state.answer is None and state.first_answer is None:
            continue
        if state.trace is not None:
            # What was turned at once to another value was perhaps never felt.
            last = {each.stimulus: each.line for each in state.last_attempt}
            lines.setdefault(state.trace, set()).update(last.values())
    return lines


def _known_lines(progress: Progress) -> set[int]:
    trials = (*progress.trials.values(), *progress.practice.values())
    return {showing.line for state in trials for showing in state.showings}
