"""Files that stand beside a protocol: items, words and orders, checked line by line."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.braille.spelling import spell_string
from vbraille.errors import InputError
from vbraille.sessions.planning.conduct import NAME
from vbraille.sessions.planning.spellings import Masks, read_written
from vbraille.toml.tomlfile import which
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from vbraille.sessions.planning.spellings import SpellingKeys

STRING, PARTICIPANT, GROUP = "string", "participant", "group"
_FILE = re.compile(r"[A-Za-z0-9_-]{1,40}\.(csv|txt)")
_MOST_ROWS = 100_000


@dataclass(frozen=True, slots=True)
class ItemRow:
    """An item of a file.

    Parameters
    ----------
    masks
        Dot masks of its cells, or its text.
    told
        What the file's other columns tell of it, by column.
    """

    masks: Masks
    told: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class OrderRow:
    """Order of the conditions of a participant, as a file gives it.

    Parameters
    ----------
    participant
        Pseudonym.
    conditions
        Names of all conditions, in order.
    group
        Name of the group; empty if the file gives none.
    """

    participant: str
    conditions: tuple[str, ...]
    group: str = ""


def check_file_name(name: str, what: str) -> None:
    """Check the name of a file that stands beside a protocol.

    Raises
    ------
    ValueError
        If it is no plain name of a CSV or a text.
    """
    if not _FILE.fullmatch(name):
        raise ValueError(
            f"{what} is {name!r}; it must be the name of a file beside the protocol: 1 to 40 "
            f"letters a to z, digits, hyphens or underscores, and .csv or .txt"
        )


def read_items(
    text: str, where: str, keys: SpellingKeys, *, written: bool = False
) -> tuple[ItemRow, ...]:
    """Read a file of items: a CSV with the column ``string``, and any others.

    Parameters
    ----------
    text, where
        Text of the file, and its name for messages.
    keys
        Dot masks of the characters that may spell a cell beside a to z.
    written
        Whether the strings are texts, whose cells braille tables make.

    Raises
    ------
    InputError
        If the column is missing, or a row is empty, is spelled badly or is there twice; the
        message names the line.
    """
    found: dict[Masks, ItemRow] = {}
    for line, row in _rows(text, where, (STRING,)):
        masks = _spelled(row.pop(STRING), f"{where} line {line}: {STRING}", keys, written)
        if masks in found:
            raise InputError(
                f"{where} line {line}: {STRING} is there before; leave one out, and give repeats "
                f"to show items more often"
            )
        found[masks] = ItemRow(masks, row)
    if not found:
        raise InputError(f"{where} has no items; give a row for each")
    return tuple(found.values())


def read_words(
    text: str, where: str, keys: SpellingKeys, *, written: bool = False
) -> tuple[Masks, ...]:
    """Read a list of words, one on each line; empty lines and lines with # are left out.

    The parameters are described at `read_items`.

    Raises
    ------
    InputError
        If a word is spelled badly; the message names the line.
    """
    lines = [(n, line.strip()) for n, line in enumerate(text.splitlines(), 1)]
    return tuple(
        _spelled(word, f"{where} line {n}: word", keys, written)
        for n, word in lines
        if word and not word.startswith("#")
    )


def read_orders(
    text: str, where: str, conditions: Collection[str], groups: Collection[str]
) -> tuple[OrderRow, ...]:
    """Read a file of orders: a row a participant, with all conditions in the other columns.

    Parameters
    ----------
    text, where
        Text of the file, and its name for messages.
    conditions, groups
        Names of the protocol's conditions, and of its groups.

    Raises
    ------
    InputError
        If a column is missing, a name is not known, or a row has not each condition once.
    """
    needed = (PARTICIPANT, GROUP) if groups else (PARTICIPANT,)
    found: dict[str, OrderRow] = {}
    for line, row in _rows(text, where, needed):
        who, at = row.pop(PARTICIPANT), f"{where} line {line}"
        group = row.pop(GROUP, "")
        if groups and group not in groups:
            raise InputError(f"{at}: {GROUP} is {group!r}{which(group, groups)}")
        names = tuple(row.values())
        for name in names:
            if name not in conditions:
                raise InputError(f"{at}: condition is {name!r}{which(name, conditions)}")
        if sorted(names) != sorted(conditions):
            raise InputError(
                f"{at}: it has {', '.join(names) or 'no condition'}; give each of "
                f"{', '.join(conditions)} once"
            )
        if who in found:
            raise InputError(f"{at}: {PARTICIPANT} {who} is there before; leave one out")
        found[who] = OrderRow(who, names, group)
    if not found:
        raise InputError(f"{where} has no orders; give a row for each participant")
    return tuple(found.values())


def _rows(text: str, where: str, needed: tuple[str, ...]) -> Iterator[tuple[int, dict[str, str]]]:
    """Rows of a CSV with a head, each with its line; columns that are needed come checked."""
    reader = csv.reader(text.splitlines(), strict=True)
    head: list[str] = []
    try:
        for cells in reader:
            line = reader.line_num
            if line > _MOST_ROWS:
                raise InputError(f"{where} has more than {_MOST_ROWS} lines; make it shorter")
            values = [cell.strip() for cell in cells]
            if not head:
                head = values
                _check_head(head, f"{where} line {line}", needed)
                continue
            if not any(values):
                raise InputError(f"{where} line {line} is empty; leave it out")
            if len(values) != len(head):
                raise InputError(
                    f"{where} line {line} has {len(values)} values, and the head has "
                    f"{len(head)}; give one for each column"
                )
            row = dict(zip(head, values, strict=True))
            for name in needed:
                if not row[name]:
                    raise InputError(f"{where} line {line}: {name} is empty; add it")
            yield line, row
    except csv.Error as error:
        raise InputError(f"{where} line {reader.line_num} is no CSV: {error}; mend it") from None
    if not head:
        raise InputError(f"{where} is empty; begin it with the names of its columns")


def _check_head(head: list[str], at: str, needed: tuple[str, ...]) -> None:
    for name in head:
        if not NAME.fullmatch(name):
            raise InputError(
                f"{at}: a column is named {name[:40]!r}; it must be 1 to 40 letters a to z, "
                f"digits, hyphens or underscores"
            )
        if head.count(name) > 1:
            raise InputError(f"{at}: two columns are named {name}; rename one")
    for name in needed:
        if name not in head:
            raise InputError(
                f"{at}: there is no column {name}{nearest(name, head)}; rename one, or add it"
            )


def _spelled(text: str, what: str, keys: SpellingKeys, written: bool) -> Masks:
    try:
        masks = read_written(text) if written else Masks(spell_string(text, keys))
    except ValueError as error:
        raise InputError(f"{what}: {error}") from None
    if not any(masks):
        raise InputError(f"{what} has no dots, and nothing can be felt of it; give it some")
    return masks
