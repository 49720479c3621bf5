"""Columns of text to trials."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.analysis.input.fieldvalues import (
    is_pair,
    parse_cells,
    parse_name,
    parse_pair,
    parse_presented,
    parse_seconds,
    parse_whole,
)
from vbraille.analysis.input.sets import string_sets, tell_sessions_apart
from vbraille.analysis.input.trials import (
    Comparisons,
    Factor,
    LeftOut,
    Trials,
    count,
    name_string,
    natural,
)
from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vbraille.analysis.input.sheets import Sheet

NEEDED = ("participant", "condition", "presented", "answered")
# What is understood beside these, all optional.
_KNOWN = {
    *NEEDED, "session", "protocol", "block", "trial", "duration_s", "parameter", "correct",
    "string_set",
}  # fmt: skip
_OPEN = {"", "n/a"}  # of a trial that was not answered
# Columns that say, if they are above 0, why a duration does not count.
_UNTIMED = {
    "paused_s": "the trial was paused meanwhile",
    "early": "it was answered before it was read to its end",
}
ALL = "all"  # the condition of a protocol that compares none


@dataclass(frozen=True, slots=True, eq=False)
class Parsed:
    """What sheets hold.

    Parameters
    ----------
    trials, comparisons
        None if there are none.
    left_out
        Rows that are in neither.
    warnings
        What does not agree.
    """

    trials: Trials | None
    comparisons: Comparisons | None
    left_out: tuple[LeftOut, ...]
    warnings: tuple[str, ...]


def parse(sheets: Sequence[Sheet]) -> Parsed:
    """Trials of some sheets together; comparisons are those that present two values.

    Raises
    ------
    InputError
        If columns are missing, something cannot be read, or a trial is there twice.
    """
    strings, pairs = _Columns(), _Columns()
    left_out: list[LeftOut] = []
    warnings: list[str] = []
    for sheet in sheets:
        sheet.need(NEEDED)
        before = strings.size
        unanswered = _take(sheet, strings, pairs)
        if unanswered:
            left_out.append(LeftOut(f"{count(unanswered, 'trial')} of {sheet.name}", "no answer"))
        warnings += _scored_otherwise(sheet, strings, before)
        for name, why in _UNTIMED.items():
            untimed = _forget_durations(strings, before, name)
            if untimed:
                left_out.append(LeftOut(f"{count(untimed, 'duration')} of {sheet.name}", why))
    for columns in (strings, pairs):
        warnings += tell_sessions_apart(columns.values)
        _check_once(columns)
    return Parsed(_trials(strings), _comparisons(pairs), tuple(left_out), tuple(warnings))


@dataclass(slots=True)
class _Columns:
    """Trials of one kind, column by column, as sheet after sheet brings them."""

    values: dict[str, list] = field(default_factory=dict)
    others: dict[str, list[str]] = field(default_factory=dict)
    size: int = 0

    def add(self, sheet: Sheet, rows: list[int], values: dict[str, list]) -> None:
        """Append rows of a sheet."""
        for name, column in (values | {"sheet": [sheet] * len(rows), "row": rows}).items():
            self.values.setdefault(name, []).extend(column)
        given = {name: values for name, values in sheet.columns.items() if name not in _KNOWN}
        for name in dict.fromkeys((*self.others, *given)):
            known = self.others.setdefault(name, [""] * self.size)
            column = given.get(name)
            known.extend([""] * len(rows) if column is None else [column[row] for row in rows])
        self.size += len(rows)


def _take(sheet: Sheet, strings: _Columns, pairs: _Columns) -> int:
    """Sort the rows of a sheet; how many of them have no answer."""
    columns, size = sheet.columns, len(sheet)
    answered = [row for row in range(size) if columns["answered"][row].strip().lower() not in _OPEN]
    parameters = columns.get("parameter", [""] * size)
    paired = {
        row for row in answered if parameters[row].strip() or is_pair(columns["presented"][row])
    }
    rows = [row for row in answered if row not in paired]
    if rows:
        places = {
            "presented": _each(sheet, "presented", rows, parse_presented),
            "answered": _each(sheet, "answered", rows, parse_cells),
            "string_set": _each(sheet, "string_set", rows, parse_cells, ""),
            "duration_s": _seconds(sheet, "duration_s", rows, np.nan),
            "paused_s": _seconds(sheet, "paused_s", rows, 0.0),
            "early": _each(sheet, "early", rows, parse_whole, 0),
        }
        _check_sets(sheet, rows, places)
        strings.add(sheet, rows, _who(sheet, rows) | places)
    rows = sorted(paired)
    if rows:
        first, second, chosen = map(list, zip(*(_pair(sheet, row) for row in rows), strict=True))
        compared = {
            "first": first,
            "second": second,
            "chosen": chosen,
            "parameter": [parameters[row].strip() or "value" for row in rows],
        }
        pairs.add(sheet, rows, _who(sheet, rows) | compared)
    return size - len(answered)


def _check_sets(sheet: Sheet, rows: list[int], places: dict[str, list]) -> None:
    """Raise InputError if a string is no order of the set that it is said to be of."""
    for row, cells, given in zip(rows, places["string_set"], places["presented"], strict=True):
        if cells and sorted(cells) != sorted(given):
            raise InputError(
                f"{sheet.place(row)}: string_set is {name_string(cells)!r}, and presented, "
                f"{name_string(given)!r}, is no order of its cells; leave string_set empty where "
                f"strings keep their order"
            )


def _who(sheet: Sheet, rows: list[int]) -> dict[str, list]:
    """Whose trials, and which ones."""
    told = "session" in sheet.columns and "trial" in sheet.columns
    return {
        "participant": _each(sheet, "participant", rows, parse_name),
        "session": _each(sheet, "session", rows, parse_name, sheet.name),
        "protocol": _each(sheet, "protocol", rows, str.strip, ""),
        "condition": _each(sheet, "condition", rows, parse_name),
        "block": _each(sheet, "block", rows, parse_whole, 0),
        "trial": _each(sheet, "trial", rows, parse_whole)
        if "trial" in sheet.columns
        else [row + 1 for row in rows],
        "told": [told] * len(rows),
    }


def _each(
    sheet: Sheet, column: str, rows: list[int], parse: Callable[[str], Any], absent: object = None
) -> list:
    """Values of some rows of a column; an InputError names the first that has none."""
    if column not in sheet.columns:
        return [absent] * len(rows)
    texts = sheet.columns[column]
    known: dict[str, Any] = {}
    for row in rows:
        if texts[row] not in known:
            try:
                known[texts[row]] = parse(texts[row])
            except ValueError as error:
                raise InputError(f"{sheet.place(row)}: {column} {error}") from None
    return [known[texts[row]] for row in rows]


def _seconds(sheet: Sheet, column: str, rows: list[int], absent: float) -> list[float]:
    return _each(sheet, column, rows, partial(parse_seconds, number=sheet.number), absent)


def _pair(sheet: Sheet, row: int) -> tuple[float, float, int]:
    presented, answered = (sheet.columns[name][row] for name in ("presented", "answered"))
    try:
        return parse_pair(presented, answered, number=sheet.number)
    except ValueError as error:
        raise InputError(f"{sheet.place(row)}: {error}") from None


def _scored_otherwise(sheet: Sheet, strings: _Columns, before: int) -> list[str]:
    """What to say of a column ``correct`` that does not agree with the answers."""
    if "correct" not in sheet.columns or strings.size == before:
        return []
    told = {"0": False, "1": True}
    names = ("presented", "answered", "row")
    rows = zip(*(strings.values[name][before:] for name in names), strict=True)
    wrong = [
        row
        for presented, answered, row in rows
        if told.get(sheet.columns["correct"][row].strip(), presented == answered)
        != (presented == answered)
    ]
    if not wrong:
        return []
    return [
        f"{sheet.name}: column correct says otherwise than the answers in "
        f"{count(len(wrong), 'trial')}, first in {sheet.place(wrong[0])}; the answers count."
    ]


def _forget_durations(strings: _Columns, before: int, column: str) -> int:
    """Take durations away for which a column says so; how many."""
    if strings.size == before:
        return 0
    durations, told = strings.values["duration_s"], strings.values[column]
    timed = [n for n in range(before, strings.size) if told[n] > 0 and not math.isnan(durations[n])]
    for n in timed:
        durations[n] = np.nan
    return len(timed)


def _check_once(columns: _Columns) -> None:
    """Raise InputError if a trial is there twice: it would count twice in every figure.

    Those whose number or session is not given are not known to be the same.
    """
    if not columns.size:
        return
    values = columns.values
    names = ("participant", "session", "protocol", "condition", "block", "trial")
    seen: set[tuple] = set()
    told, sheets, rows = values["told"], values["sheet"], values["row"]
    trials = zip(*(values[name] for name in names), told, sheets, rows, strict=True)
    for *key, told, sheet, row in trials:
        if told and key[5] and tuple(key) in seen:
            raise InputError(
                f"{sheet.place(row)}: trial {key[5]} of session {key[1]} is there a second time; "
                f"give every trial once"
            )
        seen.add(tuple(key))


def _order(columns: _Columns) -> list[int]:
    """Rows in the order of participants, sessions, blocks and trials."""
    values = columns.values
    ranks = [
        {name: rank for rank, name in enumerate(sorted(set(values[column]), key=natural))}
        for column in ("participant", "session")
    ]
    keys = list(
        zip(
            [ranks[0][name] for name in values["participant"]],
            [ranks[1][name] for name in values["session"]],
            values["block"],
            values["trial"],
            strict=True,
        )
    )
    return sorted(range(columns.size), key=keys.__getitem__)


def _conditions(columns: _Columns) -> list[str]:
    """Condition of each trial, told apart from another protocol's of the same name."""
    conditions, protocols = columns.values["condition"], columns.values["protocol"]
    if len(set(protocols)) < 2:
        return conditions
    homes: dict[str, set[str]] = {}
    for condition, protocol in zip(conditions, protocols, strict=True):
        homes.setdefault(condition, set()).add(protocol)
    return [
        protocol
        if condition == ALL and protocol
        else f"{protocol} {condition}".strip()
        if len(homes[condition]) > 1
        else condition
        for condition, protocol in zip(conditions, protocols, strict=True)
    ]


def _trials(columns: _Columns) -> Trials | None:
    if not columns.size:
        return None
    order = _order(columns)
    values = {name: [column[n] for n in order] for name, column in columns.values.items()}
    conditions = _conditions(columns)
    values["condition"] = [conditions[n] for n in order]
    pairs = zip(values["presented"], values["answered"], strict=True)
    return Trials(
        participant=Factor.of(values["participant"]),
        condition=Factor.of(values["condition"]),
        session=Factor.of(values["session"]),
        protocol=Factor.of(values["protocol"]),
        presented=Factor.of_strings(values["presented"]),
        answered=Factor.of_strings(values["answered"]),
        string_set=Factor.of_strings(string_sets(values)),
        correct=np.fromiter((p == a for p, a in pairs), bool, columns.size),
        block=np.array(values["block"], np.int64),
        trial=np.array(values["trial"], np.int64),
        duration_s=np.array(values["duration_s"], np.float64),
        others={name: [column[n] for n in order] for name, column in columns.others.items()},
    )


def _comparisons(columns: _Columns) -> Comparisons | None:
    if not columns.size:
        return None
    order = _order(columns)
    values = {name: [column[n] for n in order] for name, column in columns.values.items()}
    return Comparisons(
        participant=Factor.of(values["participant"]),
        session=Factor.of(values["session"]),
        protocol=Factor.of(values["protocol"]),
        parameter=Factor.of(values["parameter"]),
        first=np.array(values["first"], np.float64),
        second=np.array(values["second"], np.float64),
        chosen=np.array(values["chosen"], np.int64),
    )
