"""Tables of other programs, read by a mapping file into sheets like those of our own."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from decimal import Decimal
from typing import TYPE_CHECKING, Any

import pandas as pd

from vbraille.analysis.input.mapping import spelling
from vbraille.analysis.input.sheets import Sheet, read_csv
from vbraille.analysis.input.trials import LeftOut
from vbraille.errors import InputError
from vbraille.wording import count, nearest

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from vbraille.analysis.input.mapping import ColumnSource, TrialMapping


def read_mapped(path: Path, mapping: TrialMapping) -> tuple[Sheet, list[LeftOut]]:
    """Read a table of another program.

    Parameters
    ----------
    path
        CSV or JSON file, as the mapping or the file's name says.
    mapping
        Where the table has each of our columns.

    Returns
    -------
    sheet : Sheet
        Sheet with our columns.
    left_out : list[LeftOut]
        Rows that the mapping's rules left out.

    Raises
    ------
    InputError
        If the file cannot be read, or lacks a column that the mapping names.
    """
    kind = mapping.kind or ("json" if path.suffix.lower() == ".json" else "csv")
    if kind == "json":
        given = _read_json(path, mapping.encoding or "utf-8-sig")
    else:
        given = read_csv(
            path, encoding=mapping.encoding, delimiter=mapping.delimiter, escape=mapping.escape
        )
    frame, left_out = given.frame, []
    for number, rule in enumerate(mapping.rules):
        values = _column(given, mapping, rule.column, number, "a rule of rows to leave out")
        out = values[frame.index].str.strip().map(rule.leaves_out).astype(bool)
        if out.any():
            what = f"{count(int(out.sum()), 'row')} of {given.name}"
            left_out.append(LeftOut(what, rule.reason))
            frame = frame[~out]
    kept = replace(given, frame=frame)
    columns = {name: _made(kept, mapping, name) for name in mapping.columns}
    return replace(given, frame=pd.DataFrame(columns, frame.index, dtype=object)), left_out


def _made(sheet: Sheet, mapping: TrialMapping, name: str) -> pd.Series | str:
    """Values of one of our columns."""
    source = mapping.columns[name]
    if source.always is not None:
        return spelling(source.always)
    parts = [_column(sheet, mapping, column, name, name) for column in source.columns]
    picked = {
        spelling(value): _column(sheet, mapping, column, name, name)
        for value, column in source.pick.items()
    }
    made: list[str] = []
    for row, values in zip(sheet.frame.index, zip(*parts, strict=True), strict=True):
        try:
            value = _value(source, values)
            if value in picked:
                value = str(picked[value][row]).strip()
            made.append(_changed(source, value))
        except ValueError as error:
            raise InputError(f"{sheet.place(row)}: {name} {error}") from None
    return pd.Series(made, sheet.frame.index, dtype=object)


def _column(
    sheet: Sheet, mapping: TrialMapping, column: str, what: str | int, whose: str
) -> pd.Series:
    """Column of the other program, or an InputError that names the nearest one."""
    if column not in sheet.frame:
        others = [str(name) for name in sheet.frame if name]
        near = nearest(column, others)
        raise InputError(
            f"{sheet.name} has no column {column!r}, which {mapping.place(what)} names for "
            f"{whose}{near}"
        )
    return sheet.frame[column]


def _value(source: ColumnSource, values: Iterable[str]) -> str:
    """Value of a row before it is replaced: joined, taken out of JSON, matched."""
    absent = [spelling(value) for value in source.missing]
    parts = [value.strip() for value in values]
    text = " ".join(part for part in parts if part and part not in absent)
    if source.key is not None and text:
        text = _keyed(text, source.key)
    if source.pattern is not None:
        found = re.search(source.pattern, text)
        text = (found[1] or "").strip() if found else ""
    return "" if text in absent else text


def _keyed(text: str, key: str) -> str:
    try:
        told = json.loads(text)
    except (ValueError, RecursionError):
        told = None
    if not isinstance(told, dict):
        raise ValueError(f"is {text!r}, which is no object of JSON to take {key!r} from")
    if key not in told:
        near = nearest(key, told)
        raise ValueError(f"is {text!r}, which has no key {key!r}{near}")
    return _text(told[key])


def _changed(source: ColumnSource, value: str) -> str:
    """Value as it is replaced, multiplied and added to."""
    for theirs, ours in source.replace.items():
        if value == theirs.strip():
            value = spelling(ours)
            break
    if not value or (source.times is None and source.plus is None):
        return value
    try:
        number = Decimal(value)
        # Decimals, as 1234 ms times 0.001 is 1.234 s and not 1.2340000000000002 s.
        number = number * Decimal(str(1 if source.times is None else source.times))
        number += Decimal(str(source.plus or 0))
    except ArithmeticError:  # no number, or one beyond the largest exponent
        number = Decimal("NaN")
    if not number.is_finite():
        raise ValueError(f"is {value!r}, and no number that times or plus could change")
    return f"{number.normalize():f}"


def _read_json(path: Path, encoding: str) -> Sheet:
    """Table of a JSON file: a list of objects, or such lists, one a line."""
    try:
        text = path.read_bytes().decode(encoding)
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError(f"{path} is not {encoding}; name its encoding in the mapping") from None
    try:
        told = [json.loads(text)]
    except (ValueError, RecursionError) as whole:
        try:
            told = [json.loads(line) for line in text.splitlines() if line.strip()]
        except (ValueError, RecursionError):
            raise InputError(f"{path.name} is no JSON: {whole}") from None
    rows = [row for part in told for row in (part if isinstance(part, list) else [part])]
    wrong = next((number for number, row in enumerate(rows, 1) if not isinstance(row, dict)), None)
    if wrong is not None or not rows:
        which = "it is empty" if wrong is None else f"its item {wrong} is none"
        raise InputError(f"{path.name} must be a list of objects, one for each trial; {which}")
    rows = [{name.strip(): value for name, value in row.items()} for row in rows]
    names = dict.fromkeys(name for row in rows for name in row)
    columns = {name: [_text(row.get(name)) for row in rows] for name in names}
    return Sheet(path.name, pd.DataFrame(columns, range(1, len(rows) + 1), dtype=object), "item")


def _text(value: Any) -> str:
    """Text of a value of JSON, as a CSV file would have it."""
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    return json.dumps(value, ensure_ascii=False)
