"""Trials as arrays: what was presented, what was answered, by whom and when."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells
from vbraille.braille.spelling import LETTERS, UNREAD

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

UNREAD_MASK = 0x100  # one more than masks of eight dots
_LETTER_AT = {UNICODE_BLANK + mask: letter for letter, mask in LETTERS.items()}
_LETTER_OF = {mask: letter for letter, mask in LETTERS.items()}


@dataclass(frozen=True, slots=True, eq=False)
class Factor:
    """Which of some levels each trial has.

    Parameters
    ----------
    levels
        Names, in natural order: T0, T25, T100.
    codes : int64[n]
        Index of the level of each trial.
    """

    levels: tuple[str, ...]
    codes: NDArray[np.int64]

    @classmethod
    def of(cls, names: Sequence[str]) -> Factor:
        """Factor of each trial's level."""
        return cls._sorted(names, sorted(set(names), key=natural))

    @classmethod
    def of_strings(cls, texts: Sequence[str]) -> Factor:
        """Factor of each trial's Unicode braille, of which there may be as many as trials."""
        return cls._sorted(texts, sorted(set(texts)))

    @classmethod
    def _sorted(cls, names: Sequence[str], levels: list[str]) -> Factor:
        index = {name: code for code, name in enumerate(levels)}
        codes = np.fromiter((index[name] for name in names), np.int64, len(names))
        return cls(tuple(levels), codes)

    def __len__(self) -> int:
        return len(self.levels)

    def names(self) -> list[str]:
        """Level of each trial."""
        return [self.levels[code] for code in self.codes.tolist()]

    def __getitem__(self, chosen: NDArray) -> Factor:
        """Those of some trials; levels that none of them has are gone."""
        codes = self.codes[chosen]
        left = np.unique(codes)
        return Factor(tuple(self.levels[c] for c in left.tolist()), np.searchsorted(left, codes))


@dataclass(frozen=True, slots=True, eq=False)
class Trials:
    """Strings that were read and answered.

    Parameters
    ----------
    participant, condition, session, protocol
        Of each trial.
    presented, answered
        Unicode braille; `UNREAD` for a place not read.
    string_set
        Unicode braille of the string whose cells are presented in this order or another; where
        strings keep their order, of what is presented.
    correct : bool[n]
        Whether all places are right.
    block, trial : int64[n]
        As given; 0 if not. Trials are in the order of sessions, blocks and trials.
    duration_s : float64[n]
        NaN if not known.
    others
        Further columns, as they were given.
    """

    participant: Factor
    condition: Factor
    session: Factor
    protocol: Factor
    presented: Factor
    answered: Factor
    string_set: Factor
    correct: NDArray[np.bool_]
    block: NDArray[np.int64]
    trial: NDArray[np.int64]
    duration_s: NDArray[np.float64]
    others: dict[str, list[str]]

    def __len__(self) -> int:
        return self.correct.size

    def __getitem__(self, chosen: NDArray) -> Trials:
        """Some of the trials: a mask or indices."""
        index = np.arange(len(self))[chosen]
        kept = {name: [values[n] for n in index.tolist()] for name, values in self.others.items()}
        parts = {name: getattr(self, name)[chosen] for name in self.__slots__ if name != "others"}
        return Trials(**parts, others=kept)

    def columns(self) -> tuple[str, ...]:
        """Names of what trials can be compared by."""
        return ("condition", "block", "session", "protocol", *self.others)

    def factor(self, name: str) -> Factor:
        """One of `columns`."""
        if name in ("condition", "session", "protocol"):
            return getattr(self, name)
        if name == "block":
            return Factor.of([str(block) for block in self.block.tolist()])
        return Factor.of(self.others[name])

    def _listed(self) -> list[str]:
        """Set of each trial's string; empty where it is the string itself."""
        pairs = zip(self.string_set.names(), self.presented.names(), strict=True)
        return ["" if listed == presented else listed for listed, presented in pairs]

    def rows(self) -> list[dict[str, str | int | float]]:
        """A row a trial, of all columns; what is not known is empty."""
        known = ("participant", "session", "protocol", "condition")
        columns = {name: getattr(self, name).names() for name in known} | {
            "block": [block or "" for block in self.block.tolist()],
            "trial": self.trial.tolist(),
            "presented": self.presented.names(),
            "string_set": self._listed(),
            "answered": self.answered.names(),
            "correct": self.correct.astype(int).tolist(),
            "duration_s": ["" if math.isnan(s) else s for s in self.duration_s.tolist()],
            **self.others,
        }
        return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


@dataclass(frozen=True, slots=True, eq=False)
class Comparisons:
    """Pairs of stimuli of which one was chosen.

    Parameters
    ----------
    participant, session, protocol
        Of each.
    parameter
        What the stimuli differ in, with its unit: "dot_width_mm".
    first, second : float64[n]
        Values, in the order in which they were felt.
    chosen : int64[n]
        0 if the first was chosen, 1 if the second.
    """

    participant: Factor
    session: Factor
    protocol: Factor
    parameter: Factor
    first: NDArray[np.float64]
    second: NDArray[np.float64]
    chosen: NDArray[np.int64]

    def __len__(self) -> int:
        return self.chosen.size

    def __getitem__(self, index: NDArray) -> Comparisons:
        """Some of them: a mask or indices."""
        return Comparisons(**{name: getattr(self, name)[index] for name in self.__slots__})


@dataclass(frozen=True, slots=True)
class LeftOut:
    """Something that is no part of the results.

    Parameters
    ----------
    what
        "participant S1", "3 trials of session P07-letters".
    reason
        The rule.
    """

    what: str
    reason: str


@dataclass(frozen=True, slots=True, eq=False)
class Places:
    """The places of all strings whose answer has as many of them.

    Parameters
    ----------
    at : int64[m]
        Index of the trial of each place.
    presented, answered : int64[m]
        Dot masks; `UNREAD_MASK` for a place not read.
    unequal : int
        Trials that are left out, since their answer has another number of places.
    """

    at: NDArray[np.int64]
    presented: NDArray[np.int64]
    answered: NDArray[np.int64]
    unequal: int

    @classmethod
    def of(cls, trials: Trials) -> Places:
        """Places of some trials."""
        asked = _lengths(trials.presented.levels)[trials.presented.codes]
        given = _lengths(trials.answered.levels)[trials.answered.codes]
        equal = np.flatnonzero(asked == given)
        return cls(
            np.repeat(equal, asked[equal]),
            _masks(trials.presented, equal),
            _masks(trials.answered, equal),
            len(trials) - equal.size,
        )

    def __len__(self) -> int:
        return self.at.size

    @property
    def correct(self) -> NDArray[np.bool_]:
        """Whether each place is right."""
        return self.presented == self.answered

    def where(self, chosen: NDArray[np.bool_]) -> Places:
        """Some of the places."""
        return Places(self.at[chosen], self.presented[chosen], self.answered[chosen], self.unequal)


def natural(name: str) -> list[tuple[int, float, str]]:
    """Key by which T25 comes before T100."""
    parts = re.split(r"(\d+(?:\.\d+)?)", name)
    return [(0, float(p), p) if n % 2 else (1, 0.0, p) for n, p in enumerate(parts) if p]


@cache
def name_cell(mask: int) -> str:
    """Name of a cell: its letter, "blank" or its dots: "dot 4", "dots 1-3-4-6"."""
    if mask == UNREAD_MASK:
        return UNREAD
    if not mask:
        return "blank"
    if mask in _LETTER_OF:
        return _LETTER_OF[mask]
    dots = Cells.from_unicode(chr(UNICODE_BLANK + mask)).to_dots()
    return f"dots {dots}" if len(dots) > 1 else f"dot {dots}"


def masks_of(text: str) -> list[int]:
    """Dot mask of each place of Unicode braille; `UNREAD_MASK` for one not read."""
    return [UNREAD_MASK if place == UNREAD else ord(place) - UNICODE_BLANK for place in text]


def name_string(text: str) -> str:
    """Name of a string: "word" if all of it is letters, else its cells' names."""
    word = text.translate(_LETTER_AT)
    if word.isascii():
        return word
    return ", ".join([name_cell(mask) for mask in masks_of(text)])


def count(number: int, noun: str) -> str:
    """A number of things: "1 trial", "2 trials"."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def times(number: int) -> str:
    """How often: "once", "2 times"."""
    return "once" if number == 1 else f"{number} times"


def _lengths(strings: Sequence[str]) -> NDArray[np.int64]:
    return np.fromiter(map(len, strings), np.int64, len(strings))


def _masks(strings: Factor, chosen: NDArray[np.int64]) -> NDArray[np.int64]:
    """Dot masks of all places of some trials, one after the other."""
    text = "".join([strings.levels[code] for code in strings.codes[chosen].tolist()])
    points = np.frombuffer(text.encode("utf-32-le"), "<u4").astype(np.int64)
    return np.where(points == ord(UNREAD), UNREAD_MASK, points - UNICODE_BLANK)
