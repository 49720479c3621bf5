"""Trials, comparisons and places as data frames whose columns have their types.

Trials are strings that were read and answered, a row each, in the order of participants,
sessions, blocks and trials. Their columns are `TRIAL_COLUMNS`:

- ``participant``, ``session``, ``protocol``, ``condition``: categories in natural order;
- ``block``, ``trial``: int64 as given, 0 if not;
- ``presented``, ``answered``: categories, Unicode braille with `UNREAD` for a place not read;
- ``string_set``: categories, Unicode braille of the string whose cells are presented in this
  order or another; where strings keep their order, of what is presented;
- ``correct``: bool, whether all places are right;
- ``duration_s``: float64, NaN if not known;

and further columns as they were given. Comparisons are pairs of stimuli of which one was chosen.
They have the columns up to ``trial``, and

- ``first``, ``second``: float64, values in the order in which they were felt;
- ``chosen``: int64, 0 if the first was chosen, 1 if the second;
- ``parameter``: categories, what the stimuli differ in, with its unit: "dot_width_mm".
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pandas as pd

from vbraille.braille.cells import UNICODE_BLANK, Cells
from vbraille.braille.spelling import LETTERS, UNREAD

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence
    from typing import Any

    from numpy.typing import NDArray

    from vbraille.sessions.planning.protocol import Protocol

ALL = "all"  # name of the condition in a protocol that compares none
TRIAL_COLUMNS = (
    "participant", "session", "protocol", "condition", "block", "trial", "presented", "string_set",
    "answered", "correct", "duration_s",
)  # fmt: skip
CellKeys = Mapping[int, str]  # a protocol's name of a cell, by its dot mask
NO_KEYS: CellKeys = {}
UNREAD_MASK = 0x100  # one more than masks of eight dots
_LETTER_OF = {mask: letter for letter, mask in LETTERS.items()}
_LETTERS = {UNICODE_BLANK + mask: letter for mask, letter in _LETTER_OF.items()}


def natural(name: str) -> list[tuple[int, float, str]]:
    """Key by which T25 comes before T100."""
    parts = re.split(r"(\d+(?:\.\d+)?)", name)
    return [(0, float(p), p) if n % 2 else (1, 0.0, p) for n, p in enumerate(parts) if p]


class LeftOut(NamedTuple):
    """Something that is no part of the results.

    Parameters
    ----------
    what
        What is left out: "participant S1", "3 trials of session P07-letters".
    reason
        Rule by which it is left out.
    """

    what: str
    reason: str


@dataclass(frozen=True, slots=True, eq=False)
class Places:
    """All places of the strings whose answer has as many places as the string.

    Parameters
    ----------
    frame
        A row a place: ``participant`` and ``condition`` of its trial, ``presented`` and
        ``answered``, int64 dot masks with `UNREAD_MASK` for a place not read, and ``correct``.
        The index is that of the trial.
    unequal : int
        Number of trials that are left out, since their answer has another number of places.
    """

    frame: pd.DataFrame
    unequal: int

    @classmethod
    def of(cls, trials: pd.DataFrame) -> Places:
        """All places of some trials."""
        asked, given = (_lengths(trials[name]) for name in ("presented", "answered"))
        equal = np.flatnonzero(asked == given)
        frame = trials[["participant", "condition"]].take(np.repeat(equal, asked[equal]))
        for name in ("presented", "answered"):
            frame[name] = _masks(trials[name].iloc[equal])
        frame["correct"] = frame["presented"] == frame["answered"]
        return cls(frame, len(trials) - equal.size)

    def __len__(self) -> int:
        return len(self.frame)

    def where(self, chosen: pd.Series) -> Places:
        """Those places for which ``chosen`` is true."""
        return replace(self, frame=self.frame[chosen])


def factor(
    values: Iterable[object], key: Callable[[str], Any] | None = natural
) -> pd.Categorical[str]:
    """Levels of some values as text, in natural order: T0, T25, T100.

    Parameters
    ----------
    key
        Key by which the levels are sorted; None for the order of their characters.
    """
    column = values if isinstance(values, pd.Series) else pd.Series(list(values), dtype=object)
    # Words are made and sorted of what differs alone: most values occur many times.
    at, different = pd.factorize(column, use_na_sentinel=False)
    names = [str(value) for value in different]
    levels = sorted(set(names), key=key)
    place = {name: number for number, name in enumerate(levels)}
    own = np.array([place[name] for name in names], np.int64)
    return pd.Categorical.from_codes(own[at], pd.Index(levels, dtype=object), ordered=True)


def codes(levels: pd.Series) -> NDArray[np.int64]:
    """Number of each row's level, counted from 0 in the order of the levels."""
    return np.asarray(levels.cat.codes, np.int64)


def chosen(frame: pd.DataFrame, rows: pd.Series) -> pd.DataFrame:
    """Chosen rows of trials or comparisons, without levels that none of them has."""
    part = frame[rows].reset_index(drop=True)
    for name in part.select_dtypes("category"):
        part[name] = part[name].cat.remove_unused_categories()
    return part


def groups(
    frame: pd.DataFrame, *names: str, observed: bool = True
) -> Iterator[tuple[tuple[str, ...], pd.DataFrame]]:
    """Groups of rows that have the same levels, in the order of the levels.

    Parameters
    ----------
    observed
        Whether combinations of levels that no row has are left out.
    """
    grouped: Any = frame.groupby(list(names), observed=observed)
    return iter(grouped)


def cells(frame: pd.DataFrame, columns: Sequence[str]) -> Iterator[tuple[str, pd.DataFrame]]:
    """Rows of each combination of the levels of some columns, named by them; "all" without any."""
    if not columns:
        yield ALL, frame
        return
    for levels, part in frame.assign(**{n: factor(frame[n]) for n in columns}).groupby(
        list(columns), observed=True
    ):
        yield ", ".join(map(str, levels)), part


def written(trials: pd.DataFrame) -> pd.DataFrame:
    """Trials as a file has them: what is not known is missing, and a string is its own set."""
    presented, string_set = (trials[name].astype(object) for name in ("presented", "string_set"))
    return trials.assign(
        block=trials["block"].astype("Int64").mask(trials["block"] == 0),
        string_set=string_set.mask(string_set == presented, ""),
        correct=trials["correct"].astype(np.int64),
    )


def comparable(trials: pd.DataFrame) -> list[str]:
    """Names of the columns by which trials can be compared."""
    given = [str(name) for name in trials if name not in TRIAL_COLUMNS]
    return ["condition", "block", "session", "protocol", *given]


@cache
def _name_plain(mask: int) -> str:
    """Name of a cell that has no key."""
    if mask == UNREAD_MASK:
        return UNREAD
    if not mask:
        return "blank"
    if mask in _LETTER_OF:
        return _LETTER_OF[mask]
    dots = Cells.from_unicode(chr(UNICODE_BLANK + mask)).to_dots()
    return f"dots {dots}" if len(dots) > 1 else f"dot {dots}"


def name_cell(mask: int, keys: CellKeys = NO_KEYS) -> str:
    """Name of a cell: its letter, "blank" or its dots: "dot 4", "dots 1-3-4-6".

    A key of the protocol stands before the dots: "é (dots 1-2-3-4-5-6)".
    """
    name = _name_plain(mask)
    return f"{keys[mask]} ({name})" if mask in keys else name


def cell_keys(protocols: Iterable[Protocol]) -> CellKeys:
    """Keys of protocols by dot mask, of cells that are no letters, by which people know them.

    A key that is one of the letters a to z stands for another cell than its letter, and names
    none; a cell has the name of a key if all protocols with such a key have the same one.
    """
    named: dict[int, set[str]] = {}
    for protocol in protocols:
        for key, mask in protocol.keys.items():
            if mask and mask not in _LETTER_OF and key not in LETTERS:
                named.setdefault(mask, set()).add(key)
    return {mask: key for mask, (key, *others) in named.items() if not others}


def masks_of(text: str) -> list[int]:
    """Dot mask of each place of Unicode braille; `UNREAD_MASK` for a place that was not read."""
    return [UNREAD_MASK if place == UNREAD else ord(place) - UNICODE_BLANK for place in text]


def name_string(text: str, keys: CellKeys = NO_KEYS) -> str:
    """Name of a string: "word" if all of it is letters and keys, else its cells' names."""
    if not keys and (word := text.translate(_LETTERS)).isascii():
        return word
    masks = masks_of(text)
    known = [keys.get(mask) or _LETTER_OF.get(mask) for mask in masks]
    if all(letter or mask == UNREAD_MASK for letter, mask in zip(known, masks, strict=True)):
        return "".join(letter or UNREAD for letter in known)
    return ", ".join([name_cell(mask, keys) for mask in masks])


def times(number: int) -> str:
    """Words for how often: "once", "2 times"."""
    return "once" if number == 1 else f"{number} times"


def _lengths(strings: pd.Series) -> NDArray[np.int64]:
    """Number of places of each string."""
    return np.array([len(text) for text in strings.cat.categories])[codes(strings)]


def _masks(strings: pd.Series) -> NDArray[np.int64]:
    """Dot masks of all places of some strings, one after the other."""
    texts = strings.cat.categories.to_numpy(object)[codes(strings)]
    points = np.frombuffer("".join(texts).encode("utf-32-le"), "<u4").astype(np.int64)
    return np.where(points == ord(UNREAD), UNREAD_MASK, points - UNICODE_BLANK)
