"""Blocks: a text in parts that have a role, with marks on their text."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Any

import msgspec

from vbraille.braille.cells import Cells

if TYPE_CHECKING:
    from collections.abc import Iterable


class BlockKind(Enum):
    """Role of a block in its text.

    Attributes
    ----------
    HEADING
        The title of a part; its level is 1 for the largest parts.
    ITEM
        An item of a list; its level is 1 in a list that stands in no other.
    ROW
        A row of a table.
    LINE
        A line that begins where the source begins it: of verse, of code, of a braille file.
    QUOTE
        A paragraph that is quoted; its level is 1 where no other quotation is around it.
    NOTE
        A footnote or an endnote, at the place where its format has it.
    PAGE
        The place where a page begins, of print or of a braille file; `page_number` is its number.
    """

    PARAGRAPH = "paragraph"
    HEADING = "heading"
    ITEM = "item"
    ROW = "row"
    LINE = "line"
    QUOTE = "quote"
    NOTE = "note"
    PAGE = "page"


class MarkKind(Enum):
    """Kind of a mark on a part of a block's text.

    Attributes
    ----------
    CODE
        Computer code.
    LANGUAGE
        Text in another language than the block's; the target is its tag, such as "fr".
    LINK
        A link; the target is an address, or "#" and the name of an anchor of this source.
    NOTE
        A reference to a note; the target is "#" and the name of the note's anchor.
    IMAGE
        The text that stands for a picture; of a tactile one that the source shows as a figure, the
        target says which file that is, in the way of the source.
    UNSHOWN
        A remark on something that cannot be shown; the target is what it is, such as "formula".
    """

    ITALIC = "italic"
    BOLD = "bold"
    UNDERLINE = "underline"
    SUPERSCRIPT = "superscript"
    SUBSCRIPT = "subscript"
    CODE = "code"
    LANGUAGE = "language"
    LINK = "link"
    NOTE = "note"
    IMAGE = "image"
    UNSHOWN = "unshown"


class Mark(msgspec.Struct, frozen=True):
    """Something that is so about a part of a block's text.

    Parameters
    ----------
    kind
        What is so.
    start, end
        First character of the part and one past its last, as indices of the block's text.
    target
        Address, anchor, language, file or thing that the kind speaks of; empty for other kinds.
    """

    kind: MarkKind
    start: int
    end: int
    target: str = ""


def cut_marks(marks: Iterable[Mark], start: int, stop: int, at: int = 0) -> tuple[Mark, ...]:
    """Marks on a part of a text, as they are where the part begins at an index."""
    return tuple(
        msgspec.structs.replace(
            mark,
            start=max(mark.start, start) - start + at,
            end=min(mark.end, stop) - start + at,
        )
        for mark in marks
        if mark.start < stop and mark.end > start
    )


class Block(msgspec.Struct, frozen=True, eq=False):
    """A block of a source, or a piece of a very long one.

    Parameters
    ----------
    text : str
        Characters of the block. If the cells are ready, these are the source's way to write them.
    kind : BlockKind
        Role of the block in its text.
    level : int
        Depth of a heading, an item or a quotation, from 1; 0 for all other kinds.
    cells : Cells or None
        The block in braille, if the source has it in braille; None if its text is to be translated.
    marks : tuple of Mark
        Emphasis, links, languages and the like, by where they begin, outer ones first.
    language : str
        Tag of the block's language, such as "fr"; empty if it is the book's.
    anchors : tuple of str
        Names by which links and references to notes find the block.
    group : int
        Number of the list or table that the block is part of, from 1 in the order of the source.
        Where a page begins that the source counts without writing its number, that number.
    headers : tuple of str
        For a row of a table: the header of each of its cells, if the source has headers.
    entry : tuple of (int, str) or None
        Level and title of the book's own table of contents, if an entry of it leads here and the
        text has no heading here.
    continues : bool
        Whether this piece goes on where the block before it broke off.
    number : int
        Number of the block in its source, from 0.
    start : int
        Place of its first character in the text of the source.
    """

    text: str
    kind: BlockKind = BlockKind.PARAGRAPH
    level: int = 0
    cells: Cells | None = None
    marks: tuple[Mark, ...] = ()
    language: str = ""
    anchors: tuple[str, ...] = ()
    group: int = 0
    headers: tuple[str, ...] = ()
    entry: tuple[int, str] | None = None
    continues: bool = False
    number: int = 0
    start: int = 0

    @property
    def end(self) -> int:
        """Place one past its last character."""
        return self.start + len(self.text)

    @property
    def words(self) -> str:
        """Text with blanks folded."""
        return " ".join(self.text.split())

    @property
    def heading(self) -> tuple[int, str] | None:
        """Level and title of the part that begins here; None if none does."""
        if self.kind is BlockKind.HEADING and not self.continues:
            return self.level, self.words
        return self.entry

    @property
    def page_number(self) -> str:
        """Number of the page that begins here, as the source writes or counts it; empty if none."""
        if self.kind is not BlockKind.PAGE:
            return ""
        return self.text.strip() or (str(self.group) if self.group else "")

    def replace(self, **changes: Any) -> Block:
        """Copy of the block with other values of some fields."""
        return msgspec.structs.replace(self, **changes)
