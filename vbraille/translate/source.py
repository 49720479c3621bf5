"""What a reader reads, whatever file it comes from: numbered blocks of text or of ready cells."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from vbraille.braille.cells import Cells
    from vbraille.translate.text import Text


class BlockKind(Enum):
    """Role of a block in its text."""

    PARAGRAPH = "paragraph"
    HEADING = "heading"
    """The title of a part; its level is 1 for the largest parts."""
    ITEM = "item"
    """An item of a list; its level is 1 in a list that stands in no other."""
    ROW = "row"
    """A row of a table."""
    LINE = "line"
    """A line that begins where the source begins it: of verse, of code, of a braille file."""
    PAGE = "page"
    """The place where a page of the printed book begins; its text is the page's number, if any."""


_LEVELLED = (BlockKind.HEADING, BlockKind.ITEM)


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """A block of a source, or a piece of a very long one.

    Parameters
    ----------
    text : Text
        Characters of the block. If the cells are ready, these are the source's way to write them.
    kind : BlockKind
        Role of the block in its text.
    level : int
        Depth of a heading or an item, from 1; 0 for all other kinds.
    cells : Cells or None
        The block in braille, if the source has it in braille; None if its text is to be translated.
    continues : bool
        Whether this piece goes on where the block before it broke off.

    Raises
    ------
    ValueError
        If a heading or an item has no level, or another block has one.
    """

    text: Text
    kind: BlockKind = BlockKind.PARAGRAPH
    level: int = 0
    cells: Cells | None = None
    continues: bool = False

    def __post_init__(self) -> None:
        levelled = self.kind in _LEVELLED
        if (self.level > 0) != levelled or self.level < 0:
            wanted = "1 or more" if levelled else "0"
            raise ValueError(
                f"level of kind {self.kind.value} is {self.level}; it must be {wanted}"
            )


class Source(Protocol):
    """A text as blocks, read only as far as somebody asks.

    Its characters are counted from 0; a block knows which of them it stands for.
    """

    @property
    def name(self) -> str:
        """Name of the source in messages."""
        ...

    def block(self, number: int) -> Block | None:
        """Block of a number, from 0; None past the end.

        Raises
        ------
        InputError
            If the source cannot be read any more.
        """
        ...

    def block_at(self, character: int) -> int | None:
        """Number of the block that holds a character, or of the next block; None past the end."""
        ...

    def progress(self, number: int) -> float:
        """About how much of the source stands before a block that was read, 0 to 1."""
        ...

    def note(self) -> str | None:
        """Note on the source, given once after its cause is found; None if there is none."""
        ...

    def sha256(self) -> str:
        """SHA-256 of the bytes that the source was read from, in hexadecimal."""
        ...
