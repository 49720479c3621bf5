"""Questions about a whole book, and their answers, between two processes.

Looking through a book may take longer than a hand must wait: a process of its own does it.
"""

from __future__ import annotations

import msgspec

Index = None


class FindText(msgspec.Struct, frozen=True, tag="text"):
    """Question for the next place of a text.

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
    """Question for the beginning of the next block of a kind.

    Parameters
    ----------
    kind
        Value of a `BlockKind`; "link" or "image" for a block with one in it; "each item" for an
        item of whatever list; or "start" for a block, of whatever kind, with which a paragraph
        begins.
    block
        Number of the block after which, or before which, it is looked for.
    backward
        Whether the nearest block before is wanted; if it is part of a list, a table or a
        quotation other than the one that the block is in, the first of that.
    level
        Greatest level of a heading that is wanted; 0 for any.
    targets
        Targets of the links that are wanted; none for all.
    """

    kind: str
    block: int
    backward: bool = False
    level: int = 0
    targets: tuple[str, ...] = ()


class FindShare(msgspec.Struct, frozen=True, tag="share"):
    """Question for the place before which such a share of the book stands, 0 to 1."""

    share: float


class FindPage(msgspec.Struct, frozen=True, tag="page"):
    """Question for a page, by its number as the book writes it, or counts it in a braille file."""

    label: str


class ListHeadings(msgspec.Struct, frozen=True, tag="headings"):
    """All headings of the book."""


class CountLines(msgspec.Struct, frozen=True, tag="count"):
    """Question for the number of lines before a block, in lines of a width.

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
    """Question for the beginning of a line, by its number.

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


Query = FindText | FindKind | FindShare | FindPage | FindLine | ListHeadings | CountLines


class Found(msgspec.Struct, frozen=True, tag="found"):
    """A place of the source, and the index by which it is reached without reading up to it."""

    character: int
    index: Index


class ListedHeading(msgspec.Struct, frozen=True, array_like=True):
    """A heading: its level, from 1, its text, and the place of the source where it begins."""

    level: int
    title: str
    character: int


class Listed(msgspec.Struct, frozen=True, tag="listed"):
    """The headings of the book, and where its blocks are."""

    headings: tuple[ListedHeading, ...]
    index: Index


class NotFound(msgspec.Struct, frozen=True, tag="none"):
    """Answer that there is no such place."""


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
    """Index of all blocks, which comes unasked once the whole source was read."""

    index: Index


Answer = Found | Listed | NotFound | Searched | Counted | Failed | Indexed


class BookOpening(msgspec.Struct, frozen=True, tag="open"):
    """Opening of a book, as plain values that go through a pipe.

    Parameters
    ----------
    file
        Path of the file, as the system has it: not every byte of it need be text.
    descriptor
        Number of an open file that has the text, such as what standard input gave, in place of
        a path; None for a path.
    name
        Name of the book in messages; empty for the path.
    encoding, keep_lines, form, brf_table
        As the reader opened the book.
    table, language, grade
        Braille table; or None, and the language and grade by which it is chosen. With a table,
        these are what the reader chose, by which passages in other languages are translated.
    switch
        Whether passages in other languages are translated by the tables of those languages.
    undefined
        What is written for characters that the table does not know.
    index
        Index of the source, as far as it is known.
    """

    file: bytes = b""
    descriptor: int | None = None
    name: str = ""
    encoding: str | None = None
    keep_lines: bool = False
    form: str | None = None
    brf_table: str | None = None
    table: str | None = None
    language: str | None = None
    grade: int | None = None
    switch: bool = True
    undefined: str = "mark"
    index: Index | None = None


class Ask(msgspec.Struct, frozen=True, tag="ask"):
    """A question, with a number that its answers have."""

    number: int
    query: Query


class Cancel(msgspec.Struct, frozen=True, tag="cancel"):
    """A question is given up, by its number."""

    number: int


class Told(msgspec.Struct, frozen=True):
    """An answer, with the number of its question; 0 for an answer without one."""

    number: int
    answer: Answer


Order = BookOpening | Ask | Cancel
