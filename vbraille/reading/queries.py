"""What a reader asks of a whole book, and what comes back, between two processes.

Looking through a book may take longer than a hand must wait: a process of its own does it.
"""

from __future__ import annotations

import msgspec

from vbraille.translate.source import Index


class FindText(msgspec.Struct, frozen=True, tag="text"):
    """Where a text stands next.

    Parameters
    ----------
    text
        What is looked for; case and kinds of quotes, dashes and blanks do not matter.
    start
        Place of the source from which on it is looked for, or before which.
    backward
        Whether the nearest place before the start is wanted.
    fold_accents
        Whether a letter with accents and one without are the same.
    """

    text: str
    start: int
    backward: bool = False
    fold_accents: bool = True


class FindKind(msgspec.Struct, frozen=True, tag="kind"):
    """Where the next block of a kind begins.

    Parameters
    ----------
    kind
        Value of a `BlockKind`, "link" for a block with a link in it, or "start" for one, of
        whatever kind, with which a paragraph begins.
    block
        Number of the block after which, or before which, it is looked for.
    backward
        Whether the nearest block before is wanted; if it is part of a list or a table of which
        no row was wanted, the first of that.
    level
        Greatest level of a heading that is wanted; 0 for any.
    group
        Number of a list or table that is not wanted, since the reader is in it; 0 for none.
    """

    kind: str
    block: int
    backward: bool = False
    level: int = 0
    group: int = 0


class FindShare(msgspec.Struct, frozen=True, tag="share"):
    """Where so much of the book, 0 to 1, stands before."""

    share: float


class FindPage(msgspec.Struct, frozen=True, tag="page"):
    """Where a page begins, by its number as the book writes it, or counts it in a braille file."""

    label: str


class CountLines(msgspec.Struct, frozen=True, tag="count"):
    """How many lines stand before a block, in lines of a width.

    Parameters
    ----------
    width
        Number of cells in a line.
    block
        Number of the block.
    """

    width: int
    block: int


class FindLine(msgspec.Struct, frozen=True, tag="line"):
    """Where a line begins, by its number.

    Parameters
    ----------
    line
        Number of the line, from 1, in lines of the width.
    width
        Number of cells in a line.
    table
        Name of the braille table that the lines are in; empty for a book that is in cells.
    """

    line: int
    width: int
    table: str = ""


Query = FindText | FindKind | FindShare | FindPage | FindLine | CountLines


class Found(msgspec.Struct, frozen=True, tag="found"):
    """A place of the source, and the index by which it is reached without reading up to it."""

    character: int
    index: Index


class NotFound(msgspec.Struct, frozen=True, tag="none"):
    """What was looked for is not there."""


class Searched(msgspec.Struct, frozen=True, tag="progress"):
    """About how much of the work is done, 0 to 1."""

    share: float


class Counted(msgspec.Struct, frozen=True, tag="counted"):
    """Number of lines before a block.

    Parameters
    ----------
    lines
        Number of lines.
    index
        Where the blocks up to there are.
    width, block
        Width and block that were asked for.
    """

    lines: int
    index: Index
    width: int = 0
    block: int = 0


class Failed(msgspec.Struct, frozen=True, tag="failed"):
    """A sentence on why there is no answer."""

    sentence: str


class Indexed(msgspec.Struct, frozen=True, tag="indexed"):
    """Where all blocks are: nobody asked, and it came of itself once the whole source was read."""

    index: Index


Answer = Found | NotFound | Searched | Counted | Failed | Indexed
