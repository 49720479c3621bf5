"""Items: strings from a file, or drawn by a rule; and files of orders."""

from __future__ import annotations

from operator import ne
from random import Random
from typing import Annotated, Literal, NamedTuple
from unicodedata import normalize

from msgspec import Meta

from vbraille.csvfiles import Sheet, parse_csv
from vbraille.errors import InputError
from vbraille.sessions.planning.values import Count, FileName, Seed
from vbraille.toml import Table, WrongValue, which

TRIES = 2000  # for each string that is drawn
STRING, PARTICIPANT, GROUP = "string", "participant", "group"
NEEDED = {
    None: ("file",),
    "words": ("file", "length"),
    "strings": ("length", "count", "characters"),
}


class Items(Table, frozen=True, kw_only=True):
    """Source of the strings of a design of items.

    Parameters
    ----------
    file
        CSV file with the column "string" and any others; for the rule "words" a text with a word on
        each line.
    rule
        "strings" for random strings, "words" for words drawn from the file; None for all rows.
    length
        Cells of each string that is drawn; of characters, if strings are texts.
    count
        How many are drawn; None for all words of the length.
    characters
        Cells that drawn strings may have; empty, for words, for all.
    distinct
        Whether no cell may be twice in a string.
    differ_by
        In how many places any two strings must differ.
    seed
        Number that the draw follows from, so that all participants have the same strings.
    """

    file: FileName | None = None
    rule: Literal["strings", "words"] | None = None
    length: Annotated[int, Meta(ge=1, le=100)] | None = None
    count: Count | None = None
    characters: tuple[str, ...] = ()
    distinct: bool = False
    differ_by: Annotated[int, Meta(ge=1, le=100)] = 1
    seed: Seed = 1

    def __post_init__(self) -> None:
        for key in NEEDED[self.rule]:
            if not getattr(self, key):
                raise WrongValue(key, "is missing, and these items need it")

    def draw(self, strings: list[str], cells: list[str]) -> list[str]:
        """Return the strings that the rule draws.

        Parameters
        ----------
        strings
            Words of the file, as cells or texts.
        cells
            The characters, as cells.
        """
        random = Random(f"items {self.rule} {self.seed}")
        length, wanted = self.length or 1, self.count or len(strings)
        if self.rule == "words":
            tried = iter(random.sample(strings, len(strings)))
        elif self.distinct:
            most = min(length, len(cells))
            tried = ("".join(random.sample(cells, most)) for _ in range(wanted * TRIES))
        else:
            tried = ("".join(random.choices(cells, k=length)) for _ in range(wanted * TRIES))
        found: list[str] = []
        for string in tried:
            fits = len(string) == length and string.strip("⠀ ") != ""
            known = not cells or set(string) <= set(cells)
            repeats = self.distinct and len(set(string)) < length
            apart = (sum(map(ne, string, other)) >= self.differ_by for other in found)
            if fits and known and not repeats and all(apart):
                found.append(string)
            if len(found) == wanted:
                break
        if not found or len(found) < (self.count or 0):
            raise WrongValue("count", f"only {len(found)} strings keep the rule; make it weaker")
        return found


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
    sheet = _sheet(content, name, STRING)
    found: dict[str, dict[str, str]] = {}
    for line, row in zip(sheet.lines, sheet.records(), strict=True):
        string = normalize("NFC", row.pop(STRING))
        if not string or string in found:
            again = "is empty, or there twice; repeats shows items more often"
            raise InputError(f"{name} line {line}: {STRING} {string!r} {again}")
        found[string] = row
    return found


def read_words(content: bytes) -> list[str]:
    """Return the words of a text, one on each line; lines that begin with # are left out."""
    text = normalize("NFC", content.decode("utf-8-sig", "replace"))
    lines = (line.strip() for line in text.splitlines())
    return list(dict.fromkeys(line for line in lines if line and not line.startswith("#")))


def read_orders(
    content: bytes, name: str, conditions: list[str], groups: tuple[str, ...]
) -> dict[str, OrderRow]:
    """Return the order of each participant of a file.

    Raises
    ------
    InputError
        If a column is missing, or a row has not each condition once, or an unknown group.
    """
    sheet = _sheet(content, name, *((PARTICIPANT, GROUP) if groups else (PARTICIPANT,)))
    found: dict[str, OrderRow] = {}
    for line, row in zip(sheet.lines, sheet.records(), strict=True):
        who, group = row.pop(PARTICIPANT), row.pop(GROUP, "")
        names = list(filter(None, row.values()))
        if groups and group not in groups:
            raise InputError(f"{name} line {line}: group is {group!r}{which(group, groups)}")
        if sorted(names) != sorted(conditions) or who in found or not who:
            each = f"each participant once, with each of {', '.join(conditions)} once"
            raise InputError(f"{name} line {line}: give {each}")
        found[who] = OrderRow(names, group)
    return found


def _sheet(content: bytes, name: str, *needed: str) -> Sheet:
    sheet = parse_csv(content, name)
    for column in needed:
        if column not in sheet.columns:
            raise InputError(f"{name} has no column {column!r}{which(column, sheet.columns)}")
    if not sheet.rows:
        raise InputError(f"{name} has no rows; give one for each item or participant")
    return sheet
