"""What is said of a line when it comes under the hand."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

from vbraille.reading.whereabouts import place_sentence

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.layout.pages import Layout, Line


class Echo(StrEnum):
    """How much is said of each line."""

    NONE = "none"
    TEXT = "text"
    CELLS = "cells"
    BOTH = "both"

    def sentences(self, line: Line, layout: Layout) -> Iterator[str]:
        """Sentences that are said of a line of a layout, in order."""
        if self is Echo.NONE:
            return
        yield place_sentence(layout, line)
        yield from self.words(line)

    def words(self, line: Line) -> Iterator[str]:
        """Sentences on what is printed of a line."""
        if self in (Echo.CELLS, Echo.BOTH):
            yield f"cells: {line.printed.to_unicode()}"
        if self in (Echo.TEXT, Echo.BOTH):
            yield f"text: {line.text.strip()}"
