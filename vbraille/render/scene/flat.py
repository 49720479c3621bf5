"""Trees of nodes as plain arrays, which kernels turn into a program."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.render.machine import words
from vbraille.render.scene import gridkernels as g
from vbraille.render.scene.blocks import WordBlock
from vbraille.render.scene.nodes import LeafReach, NodeKind
from vbraille.render.scene.reachkernels import NODE, REACH_COLUMNS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.render.scene.blocks import TableEntry
    from vbraille.render.scene.nodes import Node


_BOX = int(LeafReach.BOX)


@dataclass(frozen=True, slots=True, eq=False)
class Flat:
    """One element of a scene, or its whole group, as plain arrays.

    All places count from its own beginning, so that many can be put one behind the other.

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
    frequency_hz
        Highest frequency of what moves in it; 0 if nothing does.
    """

    nodes: NDArray[np.float64]
    reach: NDArray[np.float64]
    numbers: NDArray[np.float64]
    changes: NDArray[np.float64]
    entries: tuple[TableEntry, ...]
    depth: int
    frequency_hz: float = 0.0


def flatten(tree: Node, frequency_hz: float = 0.0) -> Flat:
    """Make arrays of a tree."""
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
        frequency_hz,
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
        row[g.BLOCK], row[g.PARTED], row[g.ALWAYS] = self._size, node.parts, node.box is None
        row[g.SOLID] = node.solid
        self.entries += [entry._replace(at=entry.at + self._size) for entry in entries]
        self._keep(numbers)
        if node.box is None or node.box.is_empty:
            return
        if not node.enclosed:
            self.reach.append((number, 0, _BOX, *node.box, 0.0))
            if node.inside is not None:
                self.reach.append((number, 0, *node.inside))
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


@dataclass(frozen=True, slots=True, eq=False)
class Together:
    """Elements side by side, one behind the other.

    Parameters
    ----------
    nodes, reach, numbers, changes, entries
        All of theirs, as in `Flat`.
    sizes : int64[n, 4]
        How many rows of nodes and reach, numbers and words of changes each element has.
    begins : int64[4]
        What places count from: the elements may be some of many.
    depths : int64[n]
        Rows of the stack that each takes.
    frequencies_hz : float64[n]
        Highest frequency in each.
    """

    nodes: NDArray[np.float64]
    reach: NDArray[np.float64]
    numbers: NDArray[np.float64]
    changes: NDArray[np.float64]
    entries: tuple[TableEntry, ...]
    sizes: NDArray[np.int64]
    begins: NDArray[np.int64]
    depths: NDArray[np.int64]
    frequencies_hz: NDArray[np.float64]

    def some(self, first: int, end: int) -> Together:
        """Elements from ``first`` to before ``end``, as views."""
        begins = self.sizes[:first].sum(axis=0)
        ends = begins + self.sizes[first:end].sum(axis=0)
        nodes, reach, numbers, changes = (
            array[begin:past]
            for array, begin, past in zip(_arrays(self), begins, ends, strict=True)
        )
        return Together(
            nodes,
            reach,
            numbers,
            changes,
            tuple(entry for entry in self.entries if begins[2] <= entry.at < ends[2]),
            self.sizes[first:end],
            begins,
            self.depths[first:end],
            self.frequencies_hz[first:end],
        )

    def under(self, kind: NodeKind) -> Flat:
        """Put the elements under one more node, which is the last."""
        top = np.zeros((1, g.NODE_COLUMNS))
        top[0, g.KIND], top[0, g.CHILDREN] = kind, len(self.sizes)
        nodes = np.concatenate([self.nodes, top])
        uppermost = np.cumsum(self.sizes[:, 0]) - 1
        nodes[uppermost, g.PARENT] = len(nodes) - 1 - uppermost
        nodes[uppermost, g.ORDINAL] = np.arange(len(uppermost))
        depth = max(int(self.depths[0]), int(self.depths[1:].max(initial=0)) + 1)
        highest = float(self.frequencies_hz.max())
        return Flat(nodes, self.reach, self.numbers, self.changes, self.entries, depth, highest)


def side_by_side(parts: list[Flat]) -> Together:
    """Put elements, at least one, side by side."""
    columns = zip(*map(_arrays, parts), strict=True)
    sizes = np.array([list(map(len, _arrays(part))) for part in parts], np.int64)
    begins = np.cumsum(sizes, axis=0) - sizes
    nodes, reach, numbers, changes = map(np.concatenate, columns)
    nodes_by, reach_by, changes_by = (np.repeat(begins, sizes[:, n], axis=0) for n in (0, 1, 3))
    _move(nodes, reach, changes, nodes_by, reach_by, changes_by)
    entries = tuple(
        entry._replace(at=entry.at + int(begins[n, 2]))
        for n, part in enumerate(parts)
        if part.entries
        for entry in part.entries
    )
    depths = np.array([part.depth for part in parts], np.int64)
    highest = np.array([part.frequency_hz for part in parts], np.float64)
    start = np.zeros(4, np.int64)
    return Together(nodes, reach, numbers, changes, entries, sizes, start, depths, highest)


def in_a_row(runs: tuple[Together, ...]) -> Together:
    """Put runs of elements one behind the other."""
    nodes, reach, numbers, changes = map(np.concatenate, zip(*map(_arrays, runs), strict=True))
    entries: list[TableEntry] = []
    at = np.zeros(4, np.int64)
    for run in runs:
        end = at + run.sizes.sum(axis=0)
        by = at - run.begins
        _move(nodes[at[0] : end[0]], reach[at[1] : end[1]], changes[at[3] : end[3]], by, by, by)
        entries += [entry._replace(at=entry.at + int(by[2])) for entry in run.entries]
        at = end
    return Together(
        nodes,
        reach,
        numbers,
        changes,
        tuple(entries),
        np.concatenate([run.sizes for run in runs]),
        np.zeros(4, np.int64),
        np.concatenate([run.depths for run in runs]),
        np.concatenate([run.frequencies_hz for run in runs]),
    )


def _move(
    nodes: NDArray[np.float64],
    reach: NDArray[np.float64],
    changes: NDArray[np.float64],
    nodes_by: NDArray[np.int64],
    reach_by: NDArray[np.int64],
    changes_by: NDArray[np.int64],
) -> None:
    """Count places from elsewhere: each row by int64[4], or all of them by one."""
    nodes[:, g.BLOCK] += nodes_by[..., 2]
    nodes[:, g.CHANGES] += nodes_by[..., 3]
    reach[:, NODE] += reach_by[..., 0]
    changes += words.OPERATIONS * changes_by[..., 2]


def _arrays(part: Flat | Together) -> tuple[NDArray[np.float64], ...]:
    return part.nodes, part.reach, part.numbers, part.changes
