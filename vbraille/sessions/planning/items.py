"""The table ``[items]`` of a protocol: strings from a file, or drawn by a rule."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from vbraille.errors import check_range
from vbraille.sessions.planning.besides import check_file_name
from vbraille.sessions.planning.chance import Chance
from vbraille.sessions.planning.design import MOST_TRIALS
from vbraille.sessions.planning.spellings import Mask, Masks
from vbraille.sessions.planning.stimuli import check_seed
from vbraille.toml.tomlfile import Table

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

_TRIES = 2000  # for each string that a rule draws


class Items(Table, frozen=True, kw_only=True):
    """Where the strings of ``kind = "items"`` come from.

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
        Number of strings that a rule draws; None, for words, for all that have the length.
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
