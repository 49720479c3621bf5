"""Items: strings from a file, or drawn by a rule; and other files that stand beside a protocol."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from vbraille.braille.spelling import spell_string
from vbraille.errors import InputError, check_range
from vbraille.sessions.planning.design import MOST_TRIALS
from vbraille.sessions.planning.pace import NAME, check_file_name
from vbraille.sessions.planning.sequencing import Chance
from vbraille.sessions.planning.spellings import Mask, Masks, SpellingKeys, read_written
from vbraille.sessions.planning.stimuli import check_seed
from vbraille.tomlfile import Table, which
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping, Sequence


_TRIES = 2000  # for each string that a rule draws


class Items(Table, frozen=True, kw_only=True):
    """Source of the strings of ``kind = "items"``.

    Parameters
    ----------
    file
        Name of a file beside the protocol: a CSV with the column ``string``, or for the rule
        "words" a text with a word on each line.
    rule
        "strings" for random strings, "words" for words drawn from the file; None for all rows of
        the file.
    length
        Number of cells of each string that a rule draws; of characters, if strings are texts.
    count
        Number of strings that a rule draws; None for all words that have the length.
    characters
        Cells that drawn strings may have; empty, for words, for all.
    distinct
        Whether no cell may be twice in a string that is drawn.
    differ_by
        Least number of places in which any two strings drawn must differ.
    seed
        Number that the draw follows from, so that all participants have the same strings.

    Raises
    ------
    ValueError
        If a number is out of range, or keys do not go together.
    """

    file: str | None = None
    rule: Literal["strings", "words"] | None = None
    length: int | None = None
    count: int | None = None
    characters: tuple[Mask, ...] = ()
    distinct: bool = False
    differ_by: int = 1
    seed: int = 1

    def __post_init__(self) -> None:
        check_range("length", self.length, 1, 100)
        check_range("count", self.count, 1, MOST_TRIALS)
        check_seed(self.seed)
        if self.file is not None:
            check_file_name(self.file, "file")
        if self.rule is None:
            self._check_listed()
            return
        if self.length is None:
            raise ValueError("length is missing; give the number of cells of each string")
        check_range("differ_by", self.differ_by, 1, self.length)
        if self.rule == "words" and self.file is None:
            raise ValueError('file is missing; give the list of words, such as "words.txt"')
        if self.rule == "strings":
            self._check_drawn(self.length)

    def _check_listed(self) -> None:
        if self.file is None:
            raise ValueError('rule and file are missing; give a file, such as "items.csv"')
        for name in ("length", "count", "characters"):
            if getattr(self, name):
                raise ValueError(f"{name} is of a rule; leave it out, or give rule")

    def _check_drawn(self, length: int) -> None:
        if self.file is not None:
            raise ValueError("file is of rule = 'words'; leave it out")
        for name in ("count", "characters"):
            if not getattr(self, name):
                raise ValueError(f"{name} is missing; add it")
        if len(set(self.characters)) < len(self.characters):
            raise ValueError("characters have a cell twice; leave one out")
        if self.distinct and length > len(self.characters):
            raise ValueError(
                f"length is {length}, and distinct cells are only {len(self.characters)}; make "
                f"it shorter"
            )

    def draw(self, words: Sequence[Masks] = ()) -> tuple[Masks, ...]:
        """Strings that the rule draws.

        Parameters
        ----------
        words
            Cells of the words of the file, for the rule "words".

        Raises
        ------
        ValueError
            If there are too few such strings; none were found in a bounded number of tries.
        """
        chance = Chance(f"items {self.rule} {self.seed}")
        if self.rule == "words":
            fitting = [word for word in dict.fromkeys(words) if self._fits(word)]
            found = self._apart(iter(chance.shuffled(fitting)), self.count or len(fitting))
            wanted = self.count or 1
        else:
            wanted = self.count or 1
            most = wanted * _TRIES
            tried = (self._string(chance) for _ in range(most))
            found = self._apart((string for string in tried if any(string)), wanted)
        if len(found) < wanted:
            raise ValueError(
                f"count is {wanted}, and only {len(found)} strings of length {self.length} were "
                f"found that keep the rule; make it smaller, or the rule weaker"
            )
        return tuple(found)

    def _fits(self, word: Masks) -> bool:
        allowed = not self.characters or set(word) <= set(self.characters)
        return len(word) == self.length and allowed and not (self.distinct and _repeats(word))

    def _string(self, chance: Chance) -> Masks:
        assert self.length is not None
        if self.distinct:
            return Masks(chance.shuffled(self.characters)[: self.length])
        drawn = (self.characters[chance.below(len(self.characters))] for _ in range(self.length))
        return Masks(drawn)

    def _apart(self, strings: Iterator[Masks], wanted: int) -> list[Masks]:
        """First strings each of which differs enough from all before it."""
        found: list[Masks] = []
        for string in strings:
            if len(found) == wanted:
                break
            if all(_places(string, other) >= self.differ_by for other in found):
                found.append(string)
        return found


def _repeats(word: Masks) -> bool:
    return len(set(word)) < len(word)


def _places(one: Masks, other: Masks) -> int:
    """Number of places in which two strings of one length differ."""
    return sum(a != b for a, b in zip(one, other, strict=True))


STRING, PARTICIPANT, GROUP = "string", "participant", "group"
_MOST_ROWS = 100_000


@dataclass(frozen=True, slots=True)
class ItemRow:
    """An item of a file.

    Parameters
    ----------
    masks
        Dot masks of its cells, or its text.
    columns
        Cells of the file's other columns, by column.
    """

    masks: Masks
    columns: Mapping[str, str]


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
