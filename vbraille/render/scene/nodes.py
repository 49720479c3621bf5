"""A picture as a tree of what must be computed, of which each place of the canvas needs a part."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.render.scene.blocks import WordBlock
    from vbraille.scene.bounds import Box


class NodeKind(IntEnum):
    """How a node makes its deflection."""

    LEAF = 0  # by the words of a pattern
    ADD = 1  # from its children's: their sum, at most 1
    MAXIMUM = 2
    MULTIPLY = 3
    BLEND = 4  # of the first two by the third
    OVER = 5  # the last on top
    LAYER = 6  # a child of an OVER: a deflection and a mask
    CHANGE = 7  # of the only child, by words of its own


class Pushes(IntEnum):
    """What a node leaves on the stack, as a child of an OVER."""

    ITSELF = 0  # a deflection, which is its own mask
    PAIR = 1  # a deflection and a mask
    COVER = 2  # a deflection whose mask is 1 everywhere


class LeafReach(IntEnum):
    """What encloses a leaf or a part of it."""

    BOX = 0  # left, top, right, bottom
    CAPSULE = 1  # start, end; all that is no farther from the line between them than the reach
    RING = 2  # centre, radius; all that is no farther from the circle than the reach
    # Parts of filled shapes: see `vbraille.render.scene.enclosures`.
    EDGE = 3  # left, y of the start, right, y of the end of a segment
    WALL = 4  # where two segments meet: the lesser left of theirs, y, the greater left, y
    AROUND = 5  # left, top, right, bottom of all the segments


# What a leaf or a part of it lies in: a `LeafReach`, its four numbers, and the reach in mm.
Enclosed = tuple[int, float, float, float, float, float]


@dataclass(frozen=True, slots=True)
class Node:
    """What must be computed for a pattern, or for what patterns make together.

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


def joined(kind: NodeKind, children: tuple[Node, ...], pushes: Pushes = Pushes.ITSELF) -> Node:
    """Make a node of several, none of which need another's row of the stack."""
    depth = max(child.depth + (number > 0) for number, child in enumerate(children))
    return Node(kind, children, pushes=pushes, depth=depth)
