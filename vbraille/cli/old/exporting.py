"""``vbraille session export``: tables of sessions, or a dataset of them."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError, VbrailleError
from vbraille.files import write_file
from vbraille.sessions.record import journal
from vbraille.sessions.record.bids import write
from vbraille.sessions.record.codebook import asked_in, entry_of, to_codebook
from vbraille.sessions.record.export import (
    ROWS_NEED,
    Traces,
    anonymous,
    encode,
    read_notes,
    rows,
    spans,
    to_csv,
)
from vbraille.sessions.record.folder import load, whole_lines
from vbraille.wording import count

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Sequence

    from vbraille.sessions.record.folder import Record

_TRIALS = "trials"  # name of the table in a codebook, if the table is printed


def export(arguments: argparse.Namespace, say: Callable[[str], None]) -> int:
    """Export sessions as the options ask for.

    Raises
    ------
    InputError
        If the options or the sessions do not go together.
    VbrailleError
        If a session is damaged; what is whole of it was exported.
    """
    _check(arguments)
    given = _load(arguments)
    if arguments.bids:
        faults = _to_dataset(given, arguments, say)
    else:
        faults = _to_table(given, arguments, say)
    notes = sum(len(read_notes(one.journal.events)) for one in given)
    if arguments.anonymous and notes:
        told = f"left out: {count(notes, 'note')}, since they may hold anything"
        print(told, file=sys.stderr)
    # Where the table is printed, nothing else may be between it and who reads it.
    told = sys.stdout if arguments.out else sys.stderr
    for one in given:
        which = f" of {one.folder}" if len(given) > 1 else ""
        sums = journal.sum_of(whole_lines(one.folder))
        print(f"record{which}: {sums}", file=told, flush=True)
        faults += [f"{one.folder}: {fault}" if which else fault for fault in _bad(one)]
    if faults:
        raise VbrailleError(f"exported is what is whole; {'; '.join(faults)}")
    return 0


def _check(arguments: argparse.Namespace) -> None:
    """Raise InputError if options do not go together."""
    if arguments.bids and not arguments.out:
        raise InputError("--bids needs a directory; give one with --out")
    if arguments.bids and arguments.codebook:
        raise InputError("--bids describes each column in a file beside it; leave out --codebook")
    if arguments.session_by is not None and not arguments.bids:
        raise InputError("--session-by names sessions of a dataset; add --bids, or leave it out")


def _load(arguments: argparse.Namespace) -> list[Record]:
    """Sessions in the order of participants and of time, none of them twice."""
    paths = [Path(name) for name in arguments.paths]
    twice = [path for path, often in Counter(p.resolve() for p in paths).items() if often > 1]
    if twice:
        raise InputError(f"{twice[0]} is there twice; give it once")
    given = [load(path, salvaged=arguments.salvage) for path in paths]
    return sorted(given, key=lambda record: (record.plan.participant, _begun(record)))


def _begun(record: Record) -> str:
    return record.journal.events[0].wall


def _to_dataset(
    given: Sequence[Record], arguments: argparse.Namespace, say: Callable[[str], None]
) -> list[str]:
    """Add sessions to a dataset, one by one, and return what is damaged of them."""
    faults: list[str] = []
    field = arguments.session_by
    labels = [None if field is None else _answer(one, field) for one in given]
    doubled = Counter(zip((one.plan.participant for one in given), labels, strict=True))
    for (who, label), often in doubled.items():
        if label is not None and often > 1:
            raise InputError(
                f"{count(often, 'session')} of {who} have {label!r} as {field}; leave out "
                f"--session-by"
            )
    for one, label in zip(given, labels, strict=True):
        traces = Traces(one, salvaged=arguments.salvage)
        written = write(
            one,
            Path(arguments.out),
            traces,
            without_times=arguments.anonymous,
            session=label,
        )
        for path in written:
            say(f"written: {path}")
        faults += traces.faults
    return faults


def _answer(record: Record, field: str) -> str:
    """Give the answer to a question about the participant."""
    fields = record.head["fields"]
    if field not in fields:
        known = ", ".join(fields) or "none"
        raise InputError(f"{record.folder} has no field {field!r}; its fields are: {known}")
    return fields[field]


def _to_table(
    given: Sequence[Record], arguments: argparse.Namespace, say: Callable[[str], None]
) -> list[str]:
    """Write or print one table of all sessions, and return what is damaged of them."""
    faults: list[str] = []
    table: list[dict[str, Any]] = []
    asked: dict[str, str] = {}
    for one in given:
        traces = Traces(one, salvaged=arguments.salvage, upto=ROWS_NEED)
        exported = rows(one, traces)
        if arguments.anonymous:
            exported = anonymous(one, exported)
        table += exported
        asked |= asked_in(one.protocol)
        faults += traces.faults
    columns = dict.fromkeys(name for row in table for name in row)
    text = to_csv([{name: row.get(name, "") for name in columns} for row in table])
    if arguments.out is None:
        sys.stdout.write(text)
    else:
        write_file(Path(arguments.out), encode(text), replace=arguments.force)
        say(f"written: {arguments.out}, {len(table)} rows")
    if arguments.codebook is not None:
        name = _TRIALS if arguments.out is None else Path(arguments.out).name
        book = to_codebook({name: [entry_of(column, asked) for column in columns]})
        write_file(Path(arguments.codebook), encode(book), replace=arguments.force)
        if arguments.out is not None:
            say(f"written: {arguments.codebook}, {len(columns)} rows")
    return faults


def _bad(one: Record) -> list[str]:
    """List the damage of a session's journal."""
    told = one.journal
    if told.bad:
        single = len(told.bad) == 1
        lines = f"{'line' if single else 'lines'} {spans(told.bad)}"
        return [f"of {journal.NAME}, {lines} {'is' if single else 'are'} not whole"]
    if told.damage is not None:
        return [f"{journal.NAME} is damaged, {told.damage}"]
    return []
