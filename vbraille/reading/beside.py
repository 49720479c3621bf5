"""What works beside a reader, as the reader sees it: each may be missing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vbraille.reading.bindings import Bound
    from vbraille.reading.cues import Cue
    from vbraille.reading.queries import Answer, Query
    from vbraille.render import BrailleStyle
    from vbraille.translate.source import Source


class SeekerLike(Protocol):
    """A process that looks through the whole book meanwhile; one question at a time."""

    @property
    def busy(self) -> bool:
        """Whether a question has not been answered yet."""
        ...

    def ask(self, query: Query) -> None:
        """Ask a question; one that was not answered yet is given up."""
        ...

    def poll(self) -> Answer | None:
        """Give what has come since the last call, without waiting; None if nothing has."""
        ...

    def cancel(self) -> None:
        """Give the question up."""
        ...


class BookmarkLike(Protocol):
    """A place of a book that has a name."""

    @property
    def name(self) -> str:
        """Name that the reader gave it."""
        ...

    @property
    def character(self) -> int:
        """Place of the source."""
        ...

    @property
    def text(self) -> str:
        """A few words of the text there."""
        ...


class KeptLike(Protocol):
    """What is kept of a book between two readings."""

    def bookmarks(self) -> Sequence[BookmarkLike]:
        """Give all bookmarks, by their place."""
        ...

    def set_bookmark(self, bookmark: Any) -> None:
        """Set a bookmark; one with the same name is moved."""
        ...

    def delete_bookmark(self, name: str) -> None:
        """Delete a bookmark."""
        ...

    def keep_at(
        self,
        source: Source,
        character: int,
        *,
        line: int | None = None,
        lines_before: int | None = None,
        width: int = 0,
        table: str = "",
        page: str = "",
    ) -> None:
        """Keep the place at which reading goes on another time.

        Parameters
        ----------
        source
            The book.
        character
            Place of the source.
        line, lines_before
            Number of the line, and that of lines before its block, in lines of a width by a table;
            None if nobody counted.
        width, table
            Width in cells, and name of the table.
        page
            Number of the page of print; empty if there is none.
        """
        ...


class ScrollLike(Protocol):
    """Brings the next line after a time that the reader chooses."""

    @property
    def on(self) -> bool:
        """Whether lines come by time."""
        ...

    @on.setter
    def on(self, on: bool) -> None: ...

    @property
    def sentence(self) -> str:
        """Sentence that says the speed."""
        ...

    def begin(self, now_s: float) -> None:
        """Note that a line has come under the hand."""
        ...

    def faster(self) -> str:
        """Have lines come sooner; give words for the speed."""
        ...

    def slower(self) -> str:
        """Have lines come later; give words for the speed."""
        ...

    def due(self, line_cells: int, now_s: float) -> bool:
        """Whether a line of so many cells, under the hand now, has had its time."""
        ...


def _no_cue(_: Cue) -> None:
    """Give no signal."""


@dataclass(frozen=True, slots=True)
class Beside:
    """What works beside a reader.

    Parameters
    ----------
    bound
        Keys and buttons of commands; None for the usual ones.
    seeker
        Process that looks through the whole book; None to do so where the reader is.
    kept
        What is kept of the book between two readings; None to keep it while this one lasts.
    scroll
        What brings lines by time when the reader asks for that; None if nothing does.
    cue
        Function that is called with short signals, beside the sentences.
    save_style
        Function that saves how braille feels, and gives a sentence on that; None if nothing does.
    verbose
        Whether more is said, such as how far a search has come.
    """

    bound: Bound | None = None
    seeker: SeekerLike | None = None
    kept: KeptLike | None = None
    scroll: ScrollLike | None = None
    cue: Callable[[Cue], None] = _no_cue
    save_style: Callable[[BrailleStyle], str] | None = None
    verbose: bool = False
