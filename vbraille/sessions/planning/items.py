"""Files beside a protocol: its items, and the orders of its conditions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple
from unicodedata import normalize

from vbraille.csvfiles import parse_csv
from vbraille.errors import InputError
from vbraille.toml import which

STRING, PARTICIPANT, GROUP = "string", "participant", "group"


class OrderRow(NamedTuple):
    """Order of conditions, and the group, that a file gives a participant."""

    conditions: list[str]
    group: str


def read_items(content: bytes, name: str) -> dict[str, dict[str, str]]:
    """Return the other columns of each string of a file of items.

    Raises
    ------
    InputError
        If the column "string" is missing, or a string is empty or there twice.
    """
    found: dict[str, dict[str, str]] = {}
    for line, row in _rows(content, name, STRING):
        string = normalize("NFC", row.pop(STRING))
        if not string or string in found:
            again = "is empty, or there twice; repeats shows items more often"
            raise InputError(f"{name} line {line}: {STRING} {string!r} {again}")
        found[string] = row
    return found


def read_orders(
    content: bytes, name: str, conditions: list[str], groups: tuple[str, ...]
) -> dict[str, OrderRow]:
    """Return the order of each participant of a file.

    Raises
    ------
    InputError
        If a column is missing, or a row has not each condition once, or an unknown group.
    """
    found: dict[str, OrderRow] = {}
    for line, row in _rows(content, name, PARTICIPANT, *([GROUP] if groups else [])):
        who, group = row.pop(PARTICIPANT), row.pop(GROUP, "")
        names = list(filter(None, row.values()))
        if groups and group not in groups:
            raise InputError(f"{name} line {line}: group is {group!r}{which(group, groups)}")
        if sorted(names) != sorted(conditions) or who in found or not who:
            each = f"each participant once, with each of {', '.join(conditions)} once"
            raise InputError(f"{name} line {line}: give {each}")
        found[who] = OrderRow(names, group)
    return found


def _rows(content: bytes, name: str, *needed: str) -> Iterator[tuple[int, dict[str, str]]]:
    """Go through the rows of a file, each with its line."""
    sheet = parse_csv(content, name)
    for column in needed:
        if column not in sheet.columns:
            raise InputError(f"{name} has no column {column!r}{which(column, sheet.columns)}")
    if not sheet.rows:
        raise InputError(f"{name} has no rows; give one for each item or participant")
    yield from zip(sheet.lines, sheet.records(), strict=True)
