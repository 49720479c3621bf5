"""Trees of nodes as plain arrays, which kernels turn into a program."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.render.scene import gridkernels as g
from vbraille.render.scene import words
from vbraille.render.scene.blocks import Block
from vbraille.render.scene.nodes import NodeKind, Reach

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.render.scene.blocks import Placed
    from vbraille.render.scene.nodes import Node


@dataclass(frozen=True, slots=True, eq=False)
class Flat:
    """One element of a scene, or its whole group, as plain arrays.

    All places count from its own beginning, so that many can be put one behind the other.

    Parameters
    ----------
    nodes : float64[n, NODE_COLUMNS]
        Its nodes, each after its children; the last is the uppermost.
    reach : float64[m, REACH_COLUMNS]
        What its leaves and their parts lie in.
    numbers : float64[k]
        Blocks of its leaves, and constants of its changes.
    changes : float64[j]
        Words of its changes; their arguments are places in ``numbers``.
    entries : tuple of Placed
        What belongs into the table, by places in ``numbers``.
    depth
        Rows of the stack that it takes.
    frequency_hz
        Highest frequency of what moves in it; 0 if nothing does.
    """

    nodes: NDArray[np.float64]
    reach: NDArray[np.float64]
    numbers: NDArray[np.float64]
    changes: NDArray[np.float64]
    entries: tuple[Placed, ...]
    depth: int
    frequency_hz: float = 0.0


def flatten(tree: Node, frequency_hz: float = 0.0) -> Flat:
    """Make arrays of a tree."""
    flattening = _Flattening()
    flattening.add(tree)
    numbers = flattening.numbers
    return Flat(
        np.array(flattening.nodes, np.float64).reshape(-1, g.NODE_COLUMNS),
        np.array(flattening.reach, np.float64).reshape(-1, g.REACH_COLUMNS),
        np.concatenate(numbers) if numbers else np.empty(0),
        np.array(flattening.changes, np.float64),
        tuple(flattening.entries),
        tree.depth,
        frequency_hz,
    )


class _Flattening:
    """What has been flattened of a tree so far."""

    def __init__(self) -> None:
        self.nodes: list[list[float]] = []
        self.reach: list[tuple[float, ...]] = []
        self.numbers: list[NDArray[np.float64]] = []
        self.changes: list[int] = []
        self.entries: list[Placed] = []
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
        block = Block()
        kept = node.say(block, node.parts)
        places = [place + block.first_constant for place in kept]
        numbers, entries = block.finish(node.box)
        row[g.BLOCK], row[g.PARTED], row[g.ALWAYS] = self._size, node.parts, node.box is None
        self.entries += [entry._replace(at=entry.at + self._size) for entry in entries]
        self._keep(numbers)
        if node.box is None:
            return
        if not node.enclosed:
            self.reach.append((number, 0.0, Reach.BOX, *node.box, 0.0))
            return
        for index, enclosed in enumerate(node.enclosed):
            part = places[index] if node.parts else 0
            self.reach.append((number, part, enclosed.kind, *enclosed.numbers, enclosed.reach_mm))

    def _keep(self, numbers: NDArray[np.float64]) -> None:
        self.numbers.append(numbers)
        self._size += numbers.size


def put_together(parts: list[Flat], kind: NodeKind) -> Flat:
    """Put elements together under one more node, which is the last."""
    counts = np.array([len(part.nodes) for part in parts], np.int64)
    nodes = np.concatenate([*(part.nodes for part in parts), np.zeros((1, g.NODE_COLUMNS))])
    reach = np.concatenate([part.reach for part in parts])
    changes = np.concatenate([part.changes for part in parts])
    numbers = np.concatenate([part.numbers for part in parts])
    node_starts = np.cumsum(counts) - counts
    number_starts = _starts(part.numbers.size for part in parts)
    change_starts = _starts(part.changes.size for part in parts)
    nodes[:-1, g.BLOCK] += np.repeat(number_starts, counts)
    nodes[:-1, g.CHANGES] += np.repeat(change_starts, counts)
    reach[:, g.NODE] += np.repeat(node_starts, [len(part.reach) for part in parts])
    changes += words.OPERATIONS * np.repeat(number_starts, [part.changes.size for part in parts])
    uppermost = node_starts + counts - 1
    nodes[uppermost, g.PARENT] = counts.sum() - uppermost
    nodes[uppermost, g.ORDINAL] = np.arange(len(parts))
    nodes[-1, g.KIND], nodes[-1, g.CHILDREN] = kind, len(parts)
    entries = tuple(
        entry._replace(at=entry.at + int(start))
        for part, start in zip(parts, number_starts, strict=True)
        if part.entries
        for entry in part.entries
    )
    depth = max(part.depth + (number > 0) for number, part in enumerate(parts))
    most_hz = max(part.frequency_hz for part in parts)
    return Flat(nodes, reach, numbers, changes, entries, depth, most_hz)


def _starts(sizes) -> NDArray[np.int64]:
    sizes = np.fromiter(sizes, np.int64)
    return np.cumsum(sizes) - sizes
