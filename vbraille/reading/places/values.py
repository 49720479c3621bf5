"""What is kept of a book: plain values, and their bytes in the database."""

from __future__ import annotations

import msgspec


def storable(text: str) -> str:
    """Text without what cannot be written as UTF-8: halves of characters, bytes of no text."""
    return text.encode("utf-8", "replace").decode()


class KeptPlace(msgspec.Struct, frozen=True):
    """A place in a book, told in so many ways that one of them holds later.

    Parameters
    ----------
    character
        Place of the source, counted in characters from 0.
    block
        Number of the block that the character is in.
    share
        How much of the book stands before it, 0 to 1.
    before, after
        Text before the place and from it on, as it is read; a changed book is searched for it.
    reach
        Number of the source's characters that the text before the place is from.
    line
        Number of the line, from 1, in lines of `width` cells by `table`; None if nobody counted.
    lines_before
        Number of such lines before the block; None if nobody counted. A `Layout` can begin there.
    width, table
        Width in cells and name of the table for which these numbers hold.
    page
        Number of the page as the book writes or counts it; empty if it has none.
    about
        Whether the share is about right, since the book was not read to its end.
    """

    character: int
    block: int = 0
    share: float = 0.0
    before: str = ""
    after: str = ""
    reach: int = 0
    line: int | None = None
    lines_before: int | None = None
    width: int = 0
    table: str = ""
    page: str = ""
    about: bool = False

    def lines_before_for(self, width: int, table: str) -> int | None:
        """Number of such lines before the block; None if it is not known for them."""
        return self.lines_before if (self.width, self.table) == (width, table) else None


class Bookmark(msgspec.Struct, frozen=True):
    """A place of a book with a name.

    Parameters
    ----------
    name
        Name that the reader gave it.
    character
        Place of the source, counted in characters from 0.
    text
        A few words of the text from there on.
    share
        About how much of the book stands before it, 0 to 1.
    after
        Text from the place on, for which a changed book is searched; empty for that of `text`.
    """

    name: str
    character: int
    text: str = ""
    share: float = 0.0
    after: str = ""


class BookOptions(msgspec.Struct, frozen=True):
    """Options with which a book was opened; None for what is usual.

    `turned` says that language and grade were chosen by keys while the book was read: they hold
    the next time, too, unless options say otherwise then.
    """

    language: str | None = None
    grade: int | None = None
    table: str | None = None
    foreign: str = "switch"
    undefined: str = "mark"
    encoding: str | None = None
    form: str | None = None
    brf_table: str | None = None
    keep_lines: bool = False
    turned: bool = False


class ListedBook(msgspec.Struct, frozen=True):
    """A book in the list of those that were read.

    Parameters
    ----------
    number
        Number by which the database knows it.
    title
        Title, or the file's name.
    path
        Where the file was; empty if it was standard input.
    read_s
        When it was last read, in seconds since 1970.
    place
        Where reading goes on; None if nothing was read.
    missing
        Whether there is no such file now.
    """

    number: int
    title: str
    path: str
    read_s: float
    place: KeptPlace | None
    missing: bool
