"""Trees of nodes as plain arrays, which kernels turn into a program."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vbraille.render.machine import words
from vbraille.render.scene import gridkernels as g
from vbraille.render.scene.blocks import WordBlock
from vbraille.render.scene.nodes import LeafReach, NodeKind

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.render.scene.blocks import TableEntry
    from vbraille.render.scene.nodes import Node


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
        np.array(flattening.reach, np.float64).reshape(-1, g.REACH_COLUMNS),
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
        places = [place + block.first_constant for place in kept]
        numbers, entries = block.finish(node.box)
        row[g.BLOCK], row[g.PARTED], row[g.ALWAYS] = self._size, node.parts, node.box is None
        self.entries += [entry._replace(at=entry.at + self._size) for entry in entries]
        self._keep(numbers)
        if node.box is None or node.box.is_empty:
            return
        if not node.enclosed:
            self.reach.append((number, 0.0, LeafReach.BOX, *node.box, 0.0))
            return
        for index, enclosed in enumerate(node.enclosed):
            part = places[index] if node.parts else 0
            self.reach.append((number, part, enclosed.kind, *enclosed.numbers, enclosed.reach_mm))

    def _keep(self, numbers: NDArray[np.float64]) -> None:
        self.numbers.append(numbers)
        self._size += numbers.size


@dataclass(frozen=True, slots=True, eq=False)
class Together:
    """Elements put together, and where each begins.

    Parameters
    ----------
    flat
        All of them, under one more node, which is the last.
    nodes, reach, numbers, changes : int64[n]
        Where the rows and numbers of each element begin.
    """

    flat: Flat
    nodes: NDArray[np.int64]
    reach: NDArray[np.int64]
    numbers: NDArray[np.int64]
    changes: NDArray[np.int64]


def put_together(parts: list[Flat], kind: NodeKind) -> Together:
    """Put elements together under one more node."""
    columns = tuple(zip(*map(_arrays, parts), strict=True))
    counts = [np.fromiter(map(len, column), np.int64) for column in columns]
    starts = [np.cumsum(count) - count for count in counts]
    top = np.zeros((1, g.NODE_COLUMNS))
    top[0, g.KIND], top[0, g.CHILDREN] = kind, len(parts)
    nodes = np.concatenate([*(part.nodes for part in parts), top])
    reach, numbers, changes = map(np.concatenate, columns[1:])
    nodes[:-1, g.BLOCK] += np.repeat(starts[2], counts[0])
    nodes[:-1, g.CHANGES] += np.repeat(starts[3], counts[0])
    reach[:, g.NODE] += np.repeat(starts[0], counts[1])
    changes += words.OPERATIONS * np.repeat(starts[2], counts[3])
    uppermost = starts[0] + counts[0] - 1
    nodes[uppermost, g.PARENT] = len(nodes) - 1 - uppermost
    nodes[uppermost, g.ORDINAL] = np.arange(len(parts))
    entries = tuple(
        entry._replace(at=entry.at + int(starts[2][n]))
        for n, part in enumerate(parts)
        if part.entries
        for entry in part.entries
    )
    depth = max(part.depth + (number > 0) for number, part in enumerate(parts))
    flat = Flat(nodes, reach, numbers, changes, entries, depth, _highest(parts))
    return Together(flat, *starts)


def exchanged(whole: Together, parts: list[Flat], changed: list[int]) -> Together | None:
    """Exchange some of the elements; None if they do not fit into the places of those before."""
    flat = whole.flat
    if flat.entries or any(parts[n].entries for n in changed):
        return None
    arrays = tuple(array.copy() for array in _arrays(flat))
    starts = (whole.nodes, whole.reach, whole.numbers, whole.changes)
    for n in changed:
        places = [int(start[n]) for start in starts]
        # Where the next element begins; the one more node is no element's.
        sizes = (len(flat.nodes) - 1, len(flat.reach), flat.numbers.size, flat.changes.size)
        ends = [
            int(start[n + 1]) if n + 1 < start.size else size
            for start, size in zip(starts, sizes, strict=True)
        ]
        own = _arrays(parts[n])
        if [len(array) for array in own] != [b - a for a, b in zip(places, ends, strict=True)]:
            return None
        for array, part, start, end in zip(arrays, own, places, ends, strict=True):
            array[start:end] = part
        nodes, reach, _, changes = arrays
        nodes[places[0] : ends[0], g.BLOCK] += places[2]
        nodes[places[0] : ends[0], g.CHANGES] += places[3]
        reach[places[1] : ends[1], g.NODE] += places[0]
        changes[places[3] : ends[3]] += words.OPERATIONS * places[2]
        nodes[ends[0] - 1, g.PARENT] = len(nodes) - ends[0]
        nodes[ends[0] - 1, g.ORDINAL] = n
    depth = max(part.depth + (number > 0) for number, part in enumerate(parts))
    nodes, reach, numbers, changes = arrays
    flat = Flat(nodes, reach, numbers, changes, (), depth, _highest(parts))
    return replace(whole, flat=flat)


def _arrays(part: Flat) -> tuple[NDArray[np.float64], ...]:
    return part.nodes, part.reach, part.numbers, part.changes


def _highest(parts: list[Flat]) -> float:
    return max(part.frequency_hz for part in parts)
