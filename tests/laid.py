"""Laws of a laid-out text: nothing lost or doubled, and no character cut in two."""

import numpy as np

from vbraille.layout.pages import Layout


def rebuilt(layout: Layout) -> str:
    """What `--format text` prints, without the ends of its lines."""
    return "".join(line.text for line in layout.lines())


def laid_out(layout: Layout) -> str:
    """The text that was laid out: its blocks, one after the other."""
    texts, number = [], 0
    while (block := layout.book.source.block(number)) is not None:
        texts.append(str(block.text))
        number += 1
    return "".join(texts)


def cuts_inside(layout: Layout) -> int:
    """Ends of lines that cut a character which would have found room on a line of its own."""
    cuts = 0
    before = None
    for line in layout.lines():
        raised = line.cells.starts[line.cells.masks > 0]
        if before is not None and raised.size and raised[0] == before:
            character = int(raised[0])
            _, cells = layout.book.block(layout.book.source.block_at(character))
            own = np.flatnonzero((cells.starts == character) & (cells.masks > 0))
            cuts += int(own[-1] - own[0]) < layout.width - line.indent
        before = int(raised[-1]) if raised.size else None
    return cuts
