"""Compiled scenes without the words of some kinds, to be timed against the whole of them.

What a kind of pattern costs cannot be seen from outside of the machine, and a clock between any
two words would cost as much as the words do. So a program is timed as it is, and again without the
words of one kind: what pushed a deflection pushes 0, and what only fills rows is left out. All else
works on as before, since a word's loop hardly ever depends on the numbers that it finds.
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from vbraille.render.machine import words as w
from vbraille.render.program import Program

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from numpy.typing import NDArray


class WordKind(StrEnum):
    """Kinds of words that patterns have of their own."""

    STROKES = "strokes"
    FILLS = "fills"
    GRATINGS = "gratings"
    VIBRATION = "vibration"
    IMAGES = "images"
    DOTS = "dots"
    LABELS = "labels"


_KINDS = {
    **dict.fromkeys((w.CIRCLE, w.SEGMENTS, w.MARKERS, w.STROKE, w.PROFILE), WordKind.STROKES),
    **dict.fromkeys((w.INSIDE, w.FILL, w.FILL_BLENDED, w.FILL_MASK), WordKind.FILLS),
    **dict.fromkeys((w.LINEAR, w.RADIAL, w.AXIAL), WordKind.GRATINGS),
    **dict.fromkeys((w.VIBRATION, w.VIBRATE_HIGH, w.VIBRATE_LOW), WordKind.VIBRATION),
    w.IMAGE: WordKind.IMAGES,
    **dict.fromkeys((w.DOTS, w.DOTS_MASK), WordKind.DOTS),
    **dict.fromkeys((w.LABEL, w.LABEL_MASK), WordKind.LABELS),
}
# What words of these kinds do to the stack, if they change how much is on it.
_PUSHING = {
    w.STROKE,
    w.PROFILE,
    w.LINEAR,
    w.RADIAL,
    w.AXIAL,
    w.VIBRATION,
    w.IMAGE,
    w.DOTS,
    w.DOTS_MASK,
    w.LABEL,
    w.LABEL_MASK,
}
_POPPING = {w.FILL, w.FILL_BLENDED}


def kinds_in(program: Program) -> list[WordKind]:
    """List the kinds of which a compiled scene has words, in the order of `WordKind`."""
    numbers = program.numbers
    found = {kind for at in _blocks(numbers) for kind, _, _ in _told(_words_of(numbers, at))}
    found |= {_KINDS.get(_operation(said[0])) for _, said in _tile_words(numbers)}
    return [kind for kind in WordKind if kind in found]


def stripped(program: Program, kinds: Collection[WordKind]) -> Program:
    """Make a compiled scene without the words of some kinds; its frames mean nothing.

    A profile that only a blended fill asks for counts as part of the fill.

    Parameters
    ----------
    program
        The compiled scene, which stays as it is.
    kinds
        The kinds.
    """
    numbers = program.numbers.copy()
    for block in _blocks(numbers):
        kept: list[float] = []
        for kind, word, blended in _told(_words_of(numbers, block)):
            operation = _operation(word)
            if kind not in kinds:
                kept.append(word)
            elif operation in _POPPING:
                kept.append(w.DROP)
            elif operation in _PUSHING and not blended:
                kept.append(w.ZERO)
        kept.append(w.RETURN)
        numbers[block + w.WORDS : block + w.WORDS + len(kept)] = kept
    if WordKind.VIBRATION in kinds:
        _strip_tiles(numbers)
    return Program(numbers, program.table)


def _strip_tiles(numbers: NDArray[np.float64]) -> None:
    """Leave out how groups vibrate, which is said for each tile; what follows moves up."""
    kept: list[float] = []
    for at, said in _tile_words(numbers):
        if _KINDS.get(_operation(said[0])) is not WordKind.VIBRATION:
            kept += said
        if _operation(said[0]) == w.END:
            end = at + len(said)
            kept += [w.END] * (end - len(kept))
    numbers[_first(numbers) :] = kept


def emptied(program: Program) -> Program:
    """Make a program that has nothing on any of its tiles, but makes a frame there all the same."""
    numbers = np.concatenate([program.numbers, [w.ZERO, w.END]])
    starts = _starts(numbers)
    starts[numbers[starts.astype(np.int64)] != w.END] = program.numbers.size
    return Program(numbers, program.table)


def _starts(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Places of the words of all tiles, as a view."""
    tiles = int(numbers[w.GRID_COLUMNS] * numbers[w.GRID_ROWS])
    return numbers[w.GRID : w.GRID + tiles]


def _first(numbers: NDArray[np.float64]) -> int:
    """Place of the words of tiles, which follow each other to the end of the program."""
    return int(_starts(numbers).min())


def _tile_words(numbers: NDArray[np.float64]) -> Iterator[tuple[int, list[float]]]:
    """Words of all tiles with the parts that follow them: place, from the first, and numbers."""
    said = numbers[_first(numbers) :].tolist()
    at = 0
    while at < len(said):
        size = 1 if _operation(said[at]) != w.CALL_PARTS else 2 + int(said[at + 1])
        yield at, said[at : at + size]
        at += size


def _blocks(numbers: NDArray[np.float64]) -> set[int]:
    """Places of the blocks that tiles call."""
    return {
        int(said[0]) // (w.OPERATIONS * w.JOINS)
        for _, said in _tile_words(numbers)
        if _operation(said[0]) in (w.CALL, w.CALL_PARTS)
    }


def _words_of(numbers: NDArray[np.float64], block: int) -> list[float]:
    end = begin = block + w.WORDS
    while int(numbers[end]) != w.RETURN:
        end += 1
    return numbers[begin:end].tolist()


def _told(said: list[float]) -> Iterator[tuple[WordKind | None, float, bool]]:
    """Tell each word's kind, the word, and whether it is pushed for a blended fill."""
    for n, word in enumerate(said):
        blended = n + 1 < len(said) and _operation(said[n + 1]) == w.FILL_BLENDED
        yield WordKind.FILLS if blended else _KINDS.get(_operation(word)), word, blended


def _operation(word: float) -> int:
    return int(word) & (w.OPERATIONS - 1)
