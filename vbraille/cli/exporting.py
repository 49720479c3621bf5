"""``vbraille session export``: tables of sessions, or a dataset of them."""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError, VbrailleError
from vbraille.files import write_file
from vbraille.sessions.record import journal
from vbraille.sessions.record.anonymous import anonymous
from vbraille.sessions.record.codebook import entry_of, to_codebook
from vbraille.sessions.record.codes import KeyFile, renamed
from vbraille.sessions.record.dataset import write
from vbraille.sessions.record.export import Traces, encode, rows, spans, to_csv
from vbraille.sessions.record.folder import load, whole_lines
from vbraille.sessions.record.notes import read_notes
from vbraille.sessions.record.participants import label_of
from vbraille.wording import count

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Sequence

    from vbraille.sessions.record.folder import Record

_TRIALS = "trials"  # name of the table in a codebook, if the table is printed


@dataclass(frozen=True, slots=True)
class _Given:
    """A session to be exported, with the site that it is of; empty if sites do not count."""

    record: Record
    site: str


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
    out = None if arguments.out is None else Path(arguments.out)
    if arguments.key is not None:
        given = _coded(given, KeyFile.read(Path(arguments.key), out if arguments.bids else None))
    if arguments.bids:
        faults = _to_dataset(given, arguments, say)
    else:
        faults = _to_table(given, arguments, say)
    notes = sum(len(read_notes(one.record.told.events)) for one in given)
    if arguments.anonymous and notes:
        told = f"left out: {count(notes, 'note')}, since nobody knows what is in them"
        print(told, file=sys.stderr)
    # Where the table is printed, nothing else may be between it and who reads it.
    told = sys.stdout if arguments.out else sys.stderr
    for one in given:
        which = f" of {one.record.folder}" if len(given) > 1 else ""
        sums = journal.sum_of(whole_lines(one.record.folder))
        print(f"record{which}: {sums}", file=told, flush=True)
        faults += [f"{one.record.folder}: {fault}" if which else fault for fault in _bad(one)]
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
    if arguments.key is not None and not arguments.anonymous:
        raise InputError("--key keeps codes of what is anonymous; add --anonymous, or leave it out")


def _load(arguments: argparse.Namespace) -> list[_Given]:
    """Sessions in the order of participants and of time, none of them twice."""
    paths = [Path(name) for name in arguments.paths]
    twice = [path for path, often in Counter(p.resolve() for p in paths).items() if often > 1]
    if twice:
        raise InputError(f"{twice[0]} is there twice; give it once")
    sites = _sites(paths) if arguments.sites else [""] * len(paths)
    given = [
        _Given(load(path, salvaged=arguments.salvage), site)
        for path, site in zip(paths, sites, strict=True)
    ]
    given.sort(key=lambda one: (one.site, one.record.plan.participant, _begun(one.record)))
    return given


def _begun(record: Record) -> str:
    return record.told.events[0].wall


def _sites(paths: Sequence[Path]) -> list[str]:
    """Name of the folder that each session stands in, by which sites are told apart."""
    homes = [path.resolve().parent for path in paths]
    named: dict[str, Path] = {}
    for home in homes:
        other = named.setdefault(label_of(home.name).lower(), home)
        if other != home or not label_of(home.name):
            raise InputError(
                f"--sites cannot tell {other} and {home} apart by their names; rename a folder"
                if other != home
                else f"{home} is no name for a site; put the sessions into a folder of its name"
            )
    return [home.name for home in homes]


def _coded(given: Sequence[_Given], key: KeyFile) -> list[_Given]:
    """Sessions with codes in place of pseudonyms; the key is on the disk when this returns."""
    names = [_name(one) for one in given]
    key = key.with_codes(names)
    key.write()
    return [
        _Given(renamed(one.record, key.codes[name]), one.site)
        for one, name in zip(given, names, strict=True)
    ]


def _name(one: _Given) -> str:
    """Name of a participant, after the site if sites count."""
    who = one.record.plan.participant
    return f"{one.site}/{who}" if one.site else who


def _to_dataset(
    given: Sequence[_Given], arguments: argparse.Namespace, say: Callable[[str], None]
) -> list[str]:
    """Add sessions to a dataset, one by one, and return what is damaged of them."""
    faults: list[str] = []
    field = arguments.session_by
    labels = [None if field is None else _answer(one.record, field) for one in given]
    doubled = Counter(zip(map(_name, given), labels, strict=True))
    for (who, label), often in doubled.items():
        if label is not None and often > 1:
            raise InputError(
                f"{count(often, 'session')} of {who} have {label!r} as {field}; leave out "
                f"--session-by"
            )
    for one, label in zip(given, labels, strict=True):
        traces = Traces(one.record, salvaged=arguments.salvage)
        written = write(
            one.record,
            Path(arguments.out),
            traces,
            without_times=arguments.anonymous,
            site=one.site,
            session=label,
        )
        for path in written:
            say(f"written: {path}")
        faults += traces.faults
    return faults


def _answer(record: Record, field: str) -> str:
    """What was answered to a question about the participant."""
    fields = record.head["fields"]
    if field not in fields:
        known = ", ".join(fields) or "none"
        raise InputError(f"{record.folder} has no field {field!r}; its fields are: {known}")
    return fields[field]


def _to_table(
    given: Sequence[_Given], arguments: argparse.Namespace, say: Callable[[str], None]
) -> list[str]:
    """Write or print one table of all sessions, and return what is damaged of them."""
    faults: list[str] = []
    table: list[dict[str, Any]] = []
    asked: dict[str, str] = {}
    for one in given:
        traces = Traces(one.record, salvaged=arguments.salvage)
        exported = rows(one.record, traces)
        if arguments.anonymous:
            exported = anonymous(one.record, exported)
        table += [row | {"participant": _name(one)} for row in exported]
        asked |= {field.name: field.ask for field in one.record.protocol.fields}
        faults += traces.faults
    columns = dict.fromkeys(name for row in table for name in row)
    text = to_csv([{name: row.get(name, "") for name in columns} for row in table])
    if arguments.out is None:
        sys.stdout.write(text)
    else:
        write_file(Path(arguments.out), encode(text))
        say(f"written: {arguments.out}, {len(table)} rows")
    if arguments.codebook is not None:
        name = _TRIALS if arguments.out is None else Path(arguments.out).name
        book = to_codebook({name: [entry_of(column, asked) for column in columns]})
        write_file(Path(arguments.codebook), encode(book))
        if arguments.out is not None:
            say(f"written: {arguments.codebook}, {len(columns)} rows")
    return faults


def _bad(one: _Given) -> list[str]:
    """What is damaged in a session's journal."""
    told = one.record.told
    if told.bad:
        single = len(told.bad) == 1
        lines = f"{'line' if single else 'lines'} {spans(told.bad)}"
        return [f"of {journal.NAME}, {lines} {'is' if single else 'are'} not whole"]
    if told.damage is not None:
        return [f"{journal.NAME} is damaged, {told.damage}"]
    return []
