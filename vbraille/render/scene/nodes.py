"""A picture as a tree of what must be computed, and the words of its leaves.

Each place of the canvas needs a part of the tree.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.render.machine import words

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from vbraille.scene.bounds import Box


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

    def say_gated(self, gate: int, pushes: int, say: Callable[[], None]) -> None:
        """Add words that are passed over while a gate is shut, and so many zeros are pushed."""
        if not gate:
            say()
            return
        place = len(self._constants) + 1
        self.say(words.GATE, gate, 0, pushes)
        before = len(self._words)
        say()
        self._constants[place] = len(self._words) - before

    def finish(
        self, box: tuple[float, float, float, float] | None, gate: int = 0
    ) -> tuple[NDArray[np.float64], list[TableEntry]]:
        """Make the numbers of the block, and tell what of it belongs into the table.

        Parameters
        ----------
        box
            Left, top, right and bottom beyond which it is nothing; None for everywhere.
        gate
            Signals by which it is nothing: `words.SHUT_BY`.
        """
        first = self.first_constant
        constants = list(self._constants)
        for begin, end in self._lists:
            constants[begin:end] = [place + first for place in constants[begin:end]]
        said = [operation + words.OPERATIONS * (place + first) for operation, place in self._words]
        within = (min(max(side, -_FAR), _FAR) for side in box or EVERYWHERE)
        numbers = np.array([*within, gate, *said, words.RETURN, *constants])
        if not np.isfinite(numbers).all():
            raise ValueError("a number of a pattern is not finite")
        return numbers, [TableEntry(first + at, entries) for at, entries in self._entries]


class NodeKind(IntEnum):
    """Way in which a node makes its deflection."""

    LEAF = 0  # by the words of a pattern
    ADD = 1  # from its children's: their sum, at most 1
    MAXIMUM = 2
    MULTIPLY = 3
    BLEND = 4  # of the first two by the third
    OVER = 5  # the last on top
    LAYER = 6  # a child of an OVER: a deflection and a mask
    CHANGE = 7  # of the only child, by words of its own


class Pushes(IntEnum):
    """Values that a node leaves on the stack, as a child of an OVER."""

    ITSELF = 0  # a deflection, which is its own mask
    PAIR = 1  # a deflection and a mask
    COVER = 2  # a deflection whose mask is 1 everywhere


class LeafReach(IntEnum):
    """Shape that encloses a leaf or a part of it."""

    BOX = 0  # left, top, right, bottom
    CAPSULE = 1  # start, end; all that is no farther from the line between them than the reach
    RING = 2  # centre, radius; all that is no farther from the circle than the reach
    # Parts of filled shapes: see `vbraille.render.scene.paths`.
    EDGE = 3  # left, y of the start, right, y of the end of a segment
    WALL = 4  # where two segments meet: the lesser left of theirs, y, the greater left, y
    AROUND = 5  # left, top, right, bottom of all the segments


# What a leaf or a part of it lies in: a `LeafReach`, its four numbers, and the reach in mm.
Enclosed = tuple[int, float, float, float, float, float]


@dataclass(frozen=True, slots=True)
class Node:
    """Step of the computation of a pattern, or of what patterns make together.

    Parameters
    ----------
    kind
        How it is computed.
    children
        What it is computed from.
    say
        Says a leaf's words. It is given whether only parts in reach are looked at, and returns the
        places of its parts among the block's constants then.
    box
        Box of a leaf; None for everywhere.
    enclosed
        What a leaf, or each of its parts, lies in; empty for its box.
    parts
        Whether ``enclosed`` is about parts.
    pushes
        What it leaves on the stack below an OVER.
    changes : tuple of (operation, constants)
        Words of a CHANGE.
    everywhere
        Whether a CHANGE makes something of nothing.
    one
        Whether its deflection is 1 everywhere.
    depth
        Rows of the stack that it takes.
    gate
        Signals by which all of it is nothing: `words.SHUT_BY`.
    """

    kind: NodeKind
    children: tuple[Node, ...] = ()
    say: Callable[[WordBlock, bool], list[int]] | None = None
    box: Box | None = None
    enclosed: tuple[Enclosed, ...] = ()
    parts: bool = False
    pushes: Pushes = Pushes.ITSELF
    changes: tuple[tuple[int, tuple[float, ...]], ...] = field(default=())
    everywhere: bool = False
    one: bool = False
    depth: int = 1
    gate: int = 0


def joined(kind: NodeKind, children: tuple[Node, ...], pushes: Pushes = Pushes.ITSELF) -> Node:
    """Make a node of several, none of which need another's row of the stack."""
    depth = max(child.depth + (number > 0) for number, child in enumerate(children))
    return Node(kind, children, pushes=pushes, depth=depth)


_JOINS = {
    NodeKind.ADD: words.ADD,
    NodeKind.MAXIMUM: words.MAXIMUM,
    NodeKind.MULTIPLY: words.MULTIPLY,
}


def say_whole(node: Node, block: WordBlock) -> None:
    """Say all of a tree in one block, wherever its parts are."""
    pushes = 2 if node.pushes is Pushes.PAIR else 1
    block.say_gated(node.gate, pushes, partial(_say_whole, node, block))


def _say_whole(node: Node, block: WordBlock) -> None:
    if node.kind is NodeKind.LEAF:
        assert node.say is not None
        node.say(block, False)
        return
    children = node.children
    if node.kind is NodeKind.OVER:
        lowest = max((n for n, c in enumerate(children) if c.pushes is Pushes.COVER), default=0)
        children = children[lowest:]
    for number, child in enumerate(children):
        say_whole(child, block)
        if node.kind in _JOINS and number:
            block.say(_JOINS[node.kind])
        elif node.kind is NodeKind.OVER:
            pair = child.pushes is Pushes.PAIR
            if number:
                block.say(words.OVER if pair else words.OVER_ITSELF)
            elif pair:
                # The lowest layer hides nothing.
                block.say(words.DROP)
    if node.kind is NodeKind.BLEND:
        block.say(words.BLEND)
    for operation, constants in node.changes:
        block.say(operation, *constants)
