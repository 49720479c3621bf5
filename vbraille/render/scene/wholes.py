"""Trees of nodes as the words of one block, in which nothing is left out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.render.machine import words
from vbraille.render.scene.nodes import NodeKind, Pushes

if TYPE_CHECKING:
    from vbraille.render.scene.blocks import WordBlock
    from vbraille.render.scene.nodes import Node

_JOINS = {
    NodeKind.ADD: words.ADD,
    NodeKind.MAXIMUM: words.MAXIMUM,
    NodeKind.MULTIPLY: words.MULTIPLY,
}


def say_whole(node: Node, block: WordBlock) -> None:
    """Say all of a tree in one block, wherever its parts are."""
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
