"""Trees of nodes as plain arrays, which kernels turn into a program."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.render.machine import words
from vbraille.render.scene import gridkernels as g
from vbraille.render.scene.gridkernels import REACH_COLUMNS
from vbraille.render.scene.nodes import LeafReach, NodeKind, WordBlock

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.render.scene.nodes import Node, TableEntry


_BOX = int(LeafReach.BOX)


@dataclass(frozen=True, slots=True, eq=False)
class Flat:
    """A tree of nodes as plain arrays.

    All places count from its own beginning.

    Parameters
    ----------
    nodes : float64[n, NODE_COLUMNS]
        Nodes, each after its children; the last is the uppermost.
    reach : float64[m, REACH_COLUMNS]
        What its leaves and their parts lie in.
    numbers : float64[k]
        Blocks of its leaves, and constants of its changes.
    changes : float64[j]
        Words of its changes; their arguments are places in ``numbers``.
    entries : tuple of TableEntry
        What belongs into the table, by places in ``numbers``.
    depth
        Rows of the stack that it takes.
    """

    nodes: NDArray[np.float64]
    reach: NDArray[np.float64]
    numbers: NDArray[np.float64]
    changes: NDArray[np.float64]
    entries: tuple[TableEntry, ...]
    depth: int


def flatten(tree: Node) -> Flat:
    """Make arrays of a tree.

    Raises
    ------
    ValueError
        If it needs more rows of the stack than there are.
    """
    if tree.depth > words.DEPTH:
        raise ValueError(
            f"patterns stand in each other so deep that {tree.depth} of them are half done at "
            f"once; there is room for {words.DEPTH}, so put fewer into each other"
        )
    flattening = _Flattening()
    flattening.add(tree)
    numbers = flattening.numbers
    return Flat(
        np.array(flattening.nodes, np.float64).reshape(-1, g.NODE_COLUMNS),
        np.array(flattening.reach, np.float64).reshape(-1, REACH_COLUMNS),
        numbers[0] if len(numbers) == 1 else np.concatenate([np.empty(0), *numbers]),
        np.array(flattening.changes, np.float64),
        tuple(flattening.entries),
        tree.depth,
    )


class _Flattening:
    """What has been flattened of a tree so far."""

    def __init__(self) -> None:
        self.nodes: list[list[float]] = []
        self.reach: list[tuple[float, ...]] = []
        self.numbers: list[NDArray[np.float64]] = []
        self.changes: list[int] = []
        self.entries: list[TableEntry] = []
        self._size = 0

    def add(self, node: Node, ordinal: int = 0) -> int:
        """Add a node and all below it; return its number."""
        children = [self.add(child, number) for number, child in enumerate(node.children)]
        number = len(self.nodes)
        for child in children:
            self.nodes[child][g.PARENT] = number - child
        row = [0.0] * g.NODE_COLUMNS
        row[g.KIND], row[g.ORDINAL], row[g.CHILDREN] = node.kind, ordinal, len(children)
        row[g.PUSHES], row[g.ONE] = node.pushes, node.one
        self.nodes.append(row)
        if node.kind is NodeKind.LEAF:
            self._add_leaf(node, row, number)
        elif node.changes:
            row[g.ALWAYS] = node.everywhere
            row[g.CHANGES], row[g.CHANGE_COUNT] = len(self.changes), len(node.changes)
            for operation, constants in node.changes:
                self.changes.append(operation + words.OPERATIONS * self._size)
                self._keep(np.array(constants, np.float64))
        return number

    def _add_leaf(self, node: Node, row: list[float], number: int) -> None:
        assert node.say is not None
        block = WordBlock()
        kept = node.say(block, node.parts)
        numbers, entries = block.finish(node.box)
        row[g.BLOCK], row[g.HAS_PARTS], row[g.ALWAYS] = self._size, node.parts, node.box is None
        self.entries += [entry._replace(at=entry.at + self._size) for entry in entries]
        self._keep(numbers)
        if node.box is None or node.box.is_empty:
            return
        if not node.enclosed:
            self.reach.append((number, 0, _BOX, *node.box, 0.0))
            return
        first = block.first_constant
        places = [place + first for place in kept] if node.parts else [0] * len(node.enclosed)
        self.reach += [
            (number, place, *enclosed)
            for place, enclosed in zip(places, node.enclosed, strict=True)
        ]

    def _keep(self, numbers: NDArray[np.float64]) -> None:
        self.numbers.append(numbers)
        self._size += numbers.size
