"""Blocks: the words of one pattern, with their constants, in the form that the kernels read."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.render.machine import words

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

_FAR = 1e30  # stands for infinity
EVERYWHERE = (-_FAR, -_FAR, _FAR, _FAR)


class TableEntry(NamedTuple):
    """Something of a block that belongs into the table: pixels, or words of braille.

    Parameters
    ----------
    at
        Place among the block's numbers where that of the entries belongs.
    entries : uint16[n]
        What is put into the table.
    """

    at: int
    entries: NDArray[np.uint16]


class WordBlock:
    """Words and constants of one pattern, gathered bit by bit.

    The words are said in the order in which the machine takes them. Each takes its constants from
    a place that is counted from the block's beginning, so that a block can lie anywhere.
    """

    def __init__(self) -> None:
        self._words: list[tuple[int, int]] = []
        self._constants: list[float] = []
        self._entries: list[tuple[int, NDArray[np.uint16]]] = []
        self._lists: list[tuple[int, int]] = []

    def say(self, operation: int, *constants: float) -> None:
        """Add a word with its constants."""
        self._words.append((operation, len(self._constants)))
        self._constants += constants

    def say_table(
        self, operation: int, *constants: float, at: int, entries: NDArray[np.uint16]
    ) -> None:
        """Add a word of something in the table, whose place becomes the constant number ``at``."""
        self._entries.append((len(self._constants) + at, entries))
        self.say(operation, *constants)

    def keep(self, parts: Iterable[tuple[float, ...]]) -> list[int]:
        """Add the numbers of parts, and return where each is among the constants."""
        places = []
        for part in parts:
            places.append(len(self._constants))
            self._constants += part
        return places

    def say_parts(self, places: list[int]) -> None:
        """Add the word by which the following ones look at all of these parts."""
        begin = len(self._constants)
        self.say(words.PARTS, len(places), *places)
        self._lists.append((begin + 1, begin + 1 + len(places)))

    @property
    def first_constant(self) -> int:
        """Place of the first constant, from the block's beginning, once all words are said."""
        return words.WORDS + len(self._words) + 1

    def finish(
        self, box: tuple[float, float, float, float] | None
    ) -> tuple[NDArray[np.float64], list[TableEntry]]:
        """Make the numbers of the block, and tell what of it belongs into the table.

        Parameters
        ----------
        box
            Left, top, right and bottom beyond which it is nothing; None for everywhere.
        """
        first = self.first_constant
        constants = list(self._constants)
        for begin, end in self._lists:
            constants[begin:end] = [place + first for place in constants[begin:end]]
        said = [operation + words.OPERATIONS * (place + first) for operation, place in self._words]
        within = (min(max(side, -_FAR), _FAR) for side in box or EVERYWHERE)
        numbers = np.array([*within, *said, words.RETURN, *constants])
        if not np.isfinite(numbers).all():
            raise ValueError("a number of a pattern is not finite")
        return numbers, [TableEntry(first + at, entries) for at, entries in self._entries]
