"""The canvas in tiles: for each, the words that an array with its centre there has to work on.

Tiles are squares. An array reaches beyond its tile by its own radius, and so a tile tells the words
of all that lies in the tile, grown by that radius; what cannot be touched from there is left out.
The grid is wider than the canvas by as much. The tree of a picture is made plain arrays, from which
kernels choose the words of each tile: nodes stand in an order by which children come before what is
made of them, so that words can be said in that order, too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.render.machine import words
from vbraille.render.machine import words as w
from vbraille.render.scene.nodes import EVERYWHERE, LeafReach, NodeKind, Pushes, WordBlock
from vbraille.render.waves import compiled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.render.scene.nodes import Node, TableEntry
    from vbraille.scene.scene import Canvas

# Columns of what leaves, and their parts, lie in.
(
    NODE,
    PART,  # its place in the leaf's block; 0 for the whole leaf
    REACH_KIND,
    A,
    B,
    C,
    D,
    REACH_MM,
) = range(8)
REACH_COLUMNS = 8

BOX, CAPSULE, RING, EDGE, WALL, AROUND = map(int, LeafReach)
_ROUNDING_MM = 1e-6


@compiled
def _is_near(reach, n, x, y, radius):
    """Tell whether anything of a thing is nearer than that to a place."""
    a, b, c, d = reach[n, A], reach[n, B], reach[n, C], reach[n, D]
    kind = reach[n, REACH_KIND]
    radius += reach[n, REACH_MM]
    if kind == EDGE:
        beside = a > x + radius or c < x - radius
        return not (beside or min(b, d) > y + radius or max(b, d) < y - radius)
    if kind == WALL:
        return a <= x + radius < c and y - radius <= b <= y + radius
    if kind == BOX:
        dx, dy = max(a - x, x - c, 0.0), max(b - y, y - d, 0.0)
        return dx * dx + dy * dy <= radius * radius
    if kind == RING:
        return abs(math.sqrt((x - a) ** 2 + (y - b) ** 2) - c) <= radius
    dx, dy = c - a, d - b
    u, v = x - a, y - b
    square = dx * dx + dy * dy
    if square > 0.0:
        share = min(max((u * dx + v * dy) / square, 0.0), 1.0)
        u -= share * dx
        v -= share * dy
    return u * u + v * v <= radius * radius


@compiled
def _range(reach, n, radius, left, top, tiles_per_mm, columns, rows):
    """Range of the tiles that a thing can be near to: columns, and rows."""
    a, b, c, d = reach[n, A], reach[n, B], reach[n, C], reach[n, D]
    radius += reach[n, REACH_MM]
    if reach[n, REACH_KIND] == RING:
        a, b, c, d = a - c, b - c, a + c, b + c
    x0, x1 = (min(a, c) - radius - left) * tiles_per_mm, (max(a, c) + radius - left) * tiles_per_mm
    y0, y1 = (min(b, d) - radius - top) * tiles_per_mm, (max(b, d) + radius - top) * tiles_per_mm
    return (
        int(max(math.floor(min(x0, columns)), 0.0)),
        int(min(math.floor(max(x1, -1.0)), columns - 1.0)),
        int(max(math.floor(min(y0, rows)), 0.0)),
        int(min(math.floor(max(y1, -1.0)), rows - 1.0)),
    )


@compiled
def entries(reach, radius, left, top, tile_mm, columns, rows):
    """List what is near each tile: where its list begins, and numbers of rows of ``reach``.

    ``radius`` is that of the array; the tiles are grown by it.
    """
    tiles_per_mm = 1.0 / tile_mm
    # Discs about a tile and all that is reached from it, and squares about that.
    disc, square = radius + tile_mm * math.sqrt(0.5), radius + tile_mm * 0.5
    # They are kept, so that each of the many comparisons with them is with the same number.
    across, down = np.empty(columns), np.empty(rows)
    for column in range(columns):
        across[column] = left + (column + 0.5) * tile_mm
    for row in range(rows):
        down[row] = top + (row + 0.5) * tile_mm
    odd = np.zeros((rows, columns), np.bool_)
    begins = np.zeros(columns * rows + 1, np.int64)
    free = np.zeros(columns * rows, np.int64)
    filled = np.empty(0, np.int64)
    for filling in range(2):
        if filling:
            for tile in range(columns * rows):
                begins[tile + 1] = begins[tile] + free[tile]
                free[tile] = begins[tile]
            filled = np.empty(begins[-1], np.int64)
        for n in range(reach.shape[0]):
            kind = reach[n, REACH_KIND]
            of_filled = EDGE <= kind <= AROUND
            grown = square if of_filled else disc
            farther = radius + tile_mm if of_filled else radius
            first, last, upper, lower = _range(
                reach, n, farther, left, top, tiles_per_mm, columns, rows
            )
            if kind == EDGE:
                _cross(reach, n, grown, across, down, odd)
            elif kind == AROUND:
                first, last = max(first - 2, 0), min(last + 1, columns - 1)
            for row in range(upper, lower + 1):
                if kind == AROUND:
                    _sum_up(odd, row, first, last)
                for column in range(first, last + 1):
                    if kind == AROUND:
                        near = odd[row, column]
                        odd[row, column] = False
                    else:
                        near = _is_near(reach, n, across[column], down[row], grown)
                    if not near:
                        continue
                    tile = row * columns + column
                    if filling:
                        filled[free[tile]] = n
                    free[tile] += 1
    return begins, filled


@compiled
def _cross(reach, n, radius, across, down, odd):
    """Count a segment for the tiles that it is to the right of, with all that they reach.

    It counts where it crosses the lower end of all that a row of tiles reaches; so much of what is
    to the right is the same for all places of a tile. What is kept of a row is where the count
    changes, at the last of the tiles.
    """
    radius += reach[n, REACH_MM]
    a, b, d = reach[n, A], reach[n, B], reach[n, D]
    upper = np.searchsorted(down, min(b, d) - radius - _ROUNDING_MM)
    lower = np.searchsorted(down, max(b, d) - radius + _ROUNDING_MM)
    if upper == lower:
        return
    column = np.searchsorted(across, a - radius + _ROUNDING_MM) - 1
    while column >= 0 and across[column] + radius >= a:
        column -= 1
    if column < 0:
        return
    for row in range(upper, lower):
        end = down[row] + radius
        if (b > end) != (d > end):
            odd[row, column] = not odd[row, column]


@compiled
def _sum_up(odd, row, first, last):
    """Make of the tiles where the count changes those for which it is odd."""
    count = False
    for column in range(last, first - 1, -1):
        count ^= odd[row, column]
        odd[row, column] = count


# Columns of nodes: see `vbraille.render.scene.grid`.
(
    KIND,
    PARENT,  # how many nodes farther its parent is; 0 for none
    ORDINAL,  # which child of it this is
    CHILDREN,
    BLOCK,  # place of a leaf's block
    PUSHES,
    ALWAYS,  # 1 if it is something wherever the array is
    ONE,  # 1 if it is 1 everywhere
    CHANGES,  # place of a change's words, and how many these are
    CHANGE_COUNT,
    HAS_PARTS,  # 1 if its words are told of parts
) = range(11)
NODE_COLUMNS = 11
LEAF, ADD, MAXIMUM, MULTIPLY, BLEND, OVER, LAYER, CHANGE = map(int, NodeKind)
ITSELF, PAIR, COVER = map(int, Pushes)
_NONE = -1


# Columns of what is known of the nodes of one tile: the row of the nodes in reach is `_STAMP`.
(
    _STAMP,
    _HAVE,
    _LOWEST,
    _MASK,
    _ALIVE,
    _FIRST,
    _LAST,
) = range(7)
ROOM_COLUMNS = 7


@compiled
def _gather(nodes, always, reach, listed, room, active, stamp):
    """List the nodes that matter to a tile, in order; return how many."""
    count = 0
    for k in range(always.size + listed.size):
        if k < always.size:
            node = always[k]
        else:
            n = listed[k - always.size]
            node = int(reach[n, NODE])
            if room[node, _STAMP] != stamp:
                room[node, _FIRST] = k - always.size
            room[node, _LAST] = k - always.size + 1
        while room[node, _STAMP] != stamp:
            room[node, _STAMP] = stamp
            room[node, _HAVE] = room[node, _MASK] = room[node, _ALIVE] = 0
            room[node, _LOWEST] = _NONE
            active[count] = node
            count += 1
            if nodes[node, PARENT] == 0.0:
                break
            node += int(nodes[node, PARENT])
    active[:count].sort()
    return count


@compiled
def _is_present(nodes, node, room):
    """Tell whether a node is anything, from what its children are."""
    kind, have, mask = nodes[node, KIND], room[node, _HAVE], room[node, _MASK]
    if kind == LEAF:
        return True
    if kind == MULTIPLY:
        return have == nodes[node, CHILDREN]
    if kind == BLEND:
        # Bit 0 and 1 are the two parts, 2 what chooses, 3 whether that is 1 everywhere.
        return (mask & 1 != 0 and mask & 8 == 0) or (mask & 6) == 6
    if kind == CHANGE:
        return have > 0 or nodes[node, ALWAYS] != 0.0
    return have > 0


@compiled
def _is_needed(nodes, node, parent, room):
    """Tell whether a node is needed for its parent, which is."""
    kind, mask = nodes[parent, KIND], room[parent, _MASK]
    ordinal = nodes[node, ORDINAL]
    if kind == OVER:
        return node >= room[parent, _LOWEST]
    if kind == BLEND:
        if ordinal == 0.0:
            return mask & 8 == 0
        if ordinal == 1.0:
            return mask & 4 != 0
        return mask & 8 == 0
    if kind == LAYER and ordinal == 1.0:
        # The lowest layer hides nothing.
        over = parent + int(nodes[parent, PARENT])
        return room[over, _LOWEST] != parent
    return True


@compiled
def _choose(nodes, room, active, count):
    """Mark those of a tile's nodes that must be computed."""
    for k in range(count):
        node = active[k]
        if not _is_present(nodes, node, room):
            continue
        room[node, _ALIVE] = 1
        if nodes[node, PARENT] == 0.0:
            continue
        parent = node + int(nodes[node, PARENT])
        room[parent, _HAVE] += 1
        if nodes[node, ORDINAL] < 3.0:
            room[parent, _MASK] |= 1 << int(nodes[node, ORDINAL])
        if nodes[node, ONE] != 0.0 and nodes[node, ORDINAL] == 2.0:
            room[parent, _MASK] |= 8
        covers = nodes[parent, KIND] == OVER and nodes[node, PUSHES] == COVER
        if covers or room[parent, _LOWEST] == _NONE:
            room[parent, _LOWEST] = node
    for k in range(count - 1, -1, -1):
        node = active[k]
        if room[node, _ALIVE] == 0 or nodes[node, PARENT] == 0.0:
            continue
        parent = node + int(nodes[node, PARENT])
        if room[parent, _ALIVE] == 0 or not _is_needed(nodes, node, parent, room):
            room[node, _ALIVE] = 0
    # What is lowest is so among what is left.
    for k in range(count):
        room[active[k], _HAVE] = 0


@compiled
def _join_word(kind, pushes):
    """Tell the word by which what is uppermost joins what is under it."""
    if kind == ADD:
        return w.ADD
    if kind == MAXIMUM:
        return w.MAXIMUM
    if kind == MULTIPLY:
        return w.MULTIPLY
    return w.OVER if pushes == PAIR else w.OVER_ITSELF


@compiled
def _joins(kind):
    return kind in (ADD, MAXIMUM, MULTIPLY, OVER)


@compiled
def _say_leaf(nodes, node, reach, listed, room, join, said, at):
    """Say the words by which a leaf is computed, with its parts in reach."""
    has_parts = nodes[node, HAS_PARTS] != 0.0
    call = w.CALL_PARTS if has_parts else w.CALL
    said[at] = call + w.OPERATIONS * (w.JOINS * nodes[node, BLOCK] + join)
    at += 1
    if has_parts:
        first, last = room[node, _FIRST], room[node, _LAST]
        said[at] = last - first
        at += 1
        for k in range(first, last):
            said[at] = reach[listed[k], PART]
            at += 1
    return at


@compiled
def _say_tile(nodes, changes, reach, listed, room, active, count, said, at):
    """Say the words of a tile whose nodes are chosen; return where they end."""
    for k in range(count):
        node = active[k]
        if room[node, _ALIVE] == 0:
            continue
        kind, pushes = nodes[node, KIND], nodes[node, PUSHES]
        top = nodes[node, PARENT] == 0.0
        parent = node + int(nodes[node, PARENT])
        above = nodes[parent, KIND]
        # Something that it joins is on the stack already.
        joining = not top and _joins(above) and room[parent, _HAVE] > 0
        if not top:
            room[parent, _HAVE] += 1
        if kind == LEAF:
            join = w.PUSHED
            if joining:
                join = _join_word(above, pushes)
            elif pushes == PAIR:
                join = w.PUSHED_PAIR
            at = _say_leaf(nodes, node, reach, listed, room, join, said, at)
            if not joining and pushes == PAIR:
                said[at] = w.DROP
                at += 1
            continue
        if kind == CHANGE:
            if room[node, _HAVE] == 0:
                said[at] = w.ZERO
                at += 1
            first = int(nodes[node, CHANGES])
            for n in range(int(nodes[node, CHANGE_COUNT])):
                said[at] = changes[first + n]
                at += 1
        elif kind == BLEND:
            mask = room[node, _MASK]
            if mask & 12 == 4:
                said[at] = w.BLEND
                if mask & 1 == 0:
                    said[at] = w.MULTIPLY
                elif mask & 2 == 0:
                    said[at] = w.BLEND_FIRST
                at += 1
        elif kind == LAYER and room[node, _MASK] & 1 == 0:
            # At rest, but hiding: r, μ -> (1 - μ) r.
            if not joining:
                said[at] = w.ZERO
                at += 1
            else:
                said[at] = w.INVERT
                said[at + 1] = w.MULTIPLY
                at += 2
            continue
        if joining:
            said[at] = _join_word(above, pushes)
            at += 1
    said[at] = w.END
    return at + 1


@compiled
def say(nodes, changes, always, reach, begins, listed, base):
    """Say the words of each tile; return where they begin, and all of them.

    Parameters
    ----------
    nodes : float64[n, NODE_COLUMNS]
        Nodes, each after its children.
    changes : float64[m]
        Words of changes.
    always : int64[k]
        Leaves and changes that are something wherever the array is.
    reach, begins, listed
        What lies where, as `entries` gives it.
    base
        Place among the program's numbers where the words will be.
    """
    room = np.zeros((nodes.shape[0] + 1, ROOM_COLUMNS), np.int64)
    active = np.empty(nodes.shape[0] + 1, np.int64)
    starts = np.empty(begins.size - 1)
    said = np.empty(1024)
    at = np.int64(0)  # a plain 0 would have what it is given to compiled twice
    # What is said first is for all places that only what is everywhere touches.
    for tile in range(-1, starts.size):
        here = listed[:0] if tile < 0 else listed[begins[tile] : begins[tile + 1]]
        if tile >= 0 and here.size == 0:
            starts[tile] = base
            continue
        count = _gather(nodes, always, reach, here, room, active, tile + 2)
        _choose(nodes, room, active, count)
        most = at + here.size + 4 * count + changes.size + 2
        if most > said.size:
            longer = np.empty(2 * most)
            # A slice given to a slice would be compiled with all words of its refusal.
            for n in range(at):
                longer[n] = said[n]
            said = longer
        if tile >= 0:
            starts[tile] = base + at
        at = _say_tile(nodes, changes, reach, here, room, active, count, said, at)
    return starts, said[:at].copy()


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
        np.array(flattening.nodes, np.float64).reshape(-1, NODE_COLUMNS),
        np.array(flattening.reach, np.float64).reshape(-1, REACH_COLUMNS),
        numbers[0] if len(numbers) == 1 else np.concatenate([np.empty(0), *numbers]),
        np.array(flattening.changes, np.float64),
        tuple(flattening.entries),
        tree.depth,
    )


class _Flattening:
    """Part of a tree that has been flattened so far."""

    def __init__(self) -> None:
        self.nodes: list[list[float]] = []
        self.reach: list[tuple[float, ...]] = []
        self.numbers: list[NDArray[np.float64]] = []
        self.changes: list[int] = []
        self.entries: list[TableEntry] = []
        self._size = 0

    def add(self, node: Node, ordinal: int = 0, gate: int = 0) -> int:
        """Add a node and all below it; return its number. A gate above it is one of its own."""
        gate |= node.gate
        children = [self.add(child, number, gate) for number, child in enumerate(node.children)]
        number = len(self.nodes)
        for child in children:
            self.nodes[child][PARENT] = number - child
        row = [0.0] * NODE_COLUMNS
        row[KIND], row[ORDINAL], row[CHILDREN] = node.kind, ordinal, len(children)
        row[PUSHES], row[ONE] = node.pushes, node.one
        self.nodes.append(row)
        if node.kind is NodeKind.LEAF:
            self._add_leaf(node, row, number, gate)
        elif node.changes:
            row[ALWAYS] = node.everywhere
            row[CHANGES], row[CHANGE_COUNT] = len(self.changes), len(node.changes)
            for operation, constants in node.changes:
                self.changes.append(operation + words.OPERATIONS * self._size)
                self._keep(np.array(constants, np.float64))
        return number

    def _add_leaf(self, node: Node, row: list[float], number: int, gate: int) -> None:
        assert node.say is not None
        block = WordBlock()
        kept = node.say(block, node.parts)
        numbers, entries = block.finish(node.box, gate)
        row[BLOCK], row[HAS_PARTS], row[ALWAYS] = self._size, node.parts, node.box is None
        self.entries += [entry._replace(at=entry.at + self._size) for entry in entries]
        self._keep(numbers)
        if node.box is None or node.box.is_empty:
            return
        if not node.enclosed:
            self.reach.append((number, 0, BOX, *node.box, 0.0))
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


# With what is not touched left out again by its box, tiles need not be smaller than the array.
TILE_MM = 8.0
_FAR_MM = 1e9
_MOST_TILES = 40_000


@dataclass(frozen=True, slots=True)
class TileGrid:
    """Tiles over a canvas.

    Parameters
    ----------
    left_mm, top_mm
        Corner of the first tile.
    tile_mm
        Length of a tile's sides.
    columns, rows
        How many tiles there are.
    radius_mm
        How far arrays reach beyond the tile that their centre is in.
    prunes
        Whether what an array cannot touch is left out.
    """

    left_mm: float
    top_mm: float
    tile_mm: float
    columns: int
    rows: int
    radius_mm: float
    prunes: bool = True

    @classmethod
    def over(
        cls, canvas: Canvas, radius_mm: float, pruned: bool = True, tile_mm: float = TILE_MM
    ) -> TileGrid:
        """Lay a grid over a canvas, for arrays of a radius; not pruned it is one tile."""
        width_mm, height_mm = canvas.width_mm + 2 * radius_mm, canvas.height_mm + 2 * radius_mm
        # The array is on the canvas still where its centre is on the grid's far edge.
        width_mm, height_mm = width_mm + 1e-6, height_mm + 1e-6
        if not pruned:
            side_mm = max(width_mm, height_mm)
            return cls(-radius_mm, -radius_mm, side_mm, 1, 1, _FAR_MM, prunes=False)
        tile_mm = max(tile_mm, math.sqrt(width_mm * height_mm / _MOST_TILES))
        columns, rows = math.ceil(width_mm / tile_mm), math.ceil(height_mm / tile_mm)
        return cls(-radius_mm, -radius_mm, tile_mm, columns, rows, radius_mm)


def assemble(
    head: NDArray[np.float64], canvas: Canvas, grid: TileGrid, flat: Flat | None
) -> tuple[NDArray[np.float64], NDArray[np.uint16]]:
    """Make the numbers and the table of a program.

    Parameters
    ----------
    head : float64[GRID]
        Head of the program, with what belongs to the display.
    canvas, grid
        The canvas, and the tiles over it.
    flat
        What is on it; None for nothing.

    Returns
    -------
    float64[n], uint16[m]
        Numbers and table.
    """
    head = head.copy()
    head[words.RIGHT_MM], head[words.BOTTOM_MM] = canvas.width_mm, canvas.height_mm
    head[words.GRID_LEFT_MM], head[words.GRID_TOP_MM] = grid.left_mm, grid.top_mm
    head[words.TILES_PER_MM] = 1.0 / grid.tile_mm
    head[words.GRID_COLUMNS], head[words.GRID_ROWS] = grid.columns, grid.rows
    tiles = grid.columns * grid.rows
    base = words.GRID + tiles
    if flat is None:
        return np.concatenate([head, np.full(tiles, float(base)), [words.END]]), np.zeros(
            1, np.uint16
        )
    nodes, changes = flat.nodes.copy(), flat.changes + words.OPERATIONS * base
    nodes[:, BLOCK] += base
    begins, listed = entries(
        flat.reach,
        grid.radius_mm,
        grid.left_mm,
        grid.top_mm,
        grid.tile_mm,
        grid.columns,
        grid.rows,
    )
    always = np.flatnonzero(nodes[:, ALWAYS])
    starts, said = say(nodes, changes, always, flat.reach, begins, listed, base + flat.numbers.size)
    numbers = np.concatenate([head, starts, flat.numbers, said])
    if not grid.prunes:
        blocks = nodes[nodes[:, KIND] == LEAF, BLOCK].astype(np.int64)
        numbers[blocks[:, None] + range(len(EVERYWHERE))] = EVERYWHERE
    return numbers, _table(numbers, flat, base)


def _table(numbers: NDArray[np.float64], flat: Flat, base: int) -> NDArray[np.uint16]:
    """Make the table, and write into the numbers where in it each entry is."""
    entries = [np.zeros(1, np.uint16)]
    size = 1
    for at, part in flat.entries:
        numbers[base + at] = size
        entries.append(part)
        size += part.size
    return np.concatenate(entries)
