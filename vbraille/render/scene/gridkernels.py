"""Which words each tile of a canvas needs: what cannot be touched from there is left out.

A tile's words are for every array whose centre is in it. Nodes stand in an order by which children
come before what is made of them, so that words can be said in that order, too.
"""

import numpy as np

from vbraille.render.machine import words as w
from vbraille.render.scene.reachkernels import NODE, PART
from vbraille.render.waves import compiled

# Columns of nodes: see `vbraille.render.scene.flat`.
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
    PARTED,  # 1 if its words are told of parts
) = range(11)
NODE_COLUMNS = 11
LEAF, ADD, MAXIMUM, MULTIPLY, BLEND, OVER, LAYER, CHANGE = range(8)
ITSELF, PAIR, COVER = range(3)
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
def _join(kind, pushes):
    """Tell how a leaf joins what is under it."""
    if kind == ADD:
        return w.ADDED
    if kind == MAXIMUM:
        return w.LARGER
    if kind == MULTIPLY:
        return w.MULTIPLIED
    if kind == OVER:
        return w.LAID_PAIR if pushes == PAIR else w.LAID_ITSELF
    return w.PUSHED


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
    parted = nodes[node, PARTED] != 0.0
    call = w.CALL_PARTS if parted else w.CALL
    said[at] = call + w.OPERATIONS * (w.JOINS * nodes[node, BLOCK] + join)
    at += 1
    if parted:
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
                join = _join(above, pushes)
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
