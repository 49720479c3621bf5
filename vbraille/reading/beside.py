"""What works beside a reader, as the reader sees it: each may be missing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from vbraille.reading.keyed import Keyed

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.reading.bindings import Bound
    from vbraille.reading.cues import Cue
    from vbraille.reading.search.queries import Answer, Query
    from vbraille.render import BrailleStyle
    from vbraille.render.program import Program
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

    @property
    def fault(self) -> str | None:
        """Why something could not be written yet; None if all was."""
        ...

    def bookmarks(self) -> Sequence[BookmarkLike]:
        """Give all bookmarks, by their place."""
        ...

    def set_bookmark(self, bookmark: Any) -> None:
        """Set a bookmark; one with the same name is moved."""
        ...

    def delete_bookmark(self, name: str) -> None:
        """Delete a bookmark."""
        ...

    def tend(self) -> None:
        """Write what could not be written before, if it is time for that."""
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


class FigureLike(Protocol):
    """A tactile picture that stands in a text."""

    @property
    def title(self) -> str:
        """Title of the picture."""
        ...

    @property
    def width_mm(self) -> float:
        """Width of its canvas, in mm."""
        ...

    @property
    def height_mm(self) -> float:
        """Height of its canvas, in mm."""
        ...

    def name_at(self, x_mm: float, y_mm: float) -> str:
        """Name of the element at a place of its canvas, in mm; empty if none has one there."""
        ...


class FiguresLike(Protocol):
    """The tactile pictures of a text, which are read when a line comes that stands for one."""

    def find(self, address: str) -> FigureLike | None:
        """Give the picture of an address; None if there is none, which is said once."""
        ...

    @property
    def ready(self) -> bool:
        """Whether a page can be made at once."""
        ...

    def feel(
        self, address: str, say: Callable[[str], None], cue: Callable[[Cue], None]
    ) -> FeltLike:
        """Put a figure alone under the hand, in place of the text.

        Raises
        ------
        InputError
            If there is none, or it cannot be felt on the device.
        """
        ...

    def page(
        self,
        lines: Sequence[NDArray[np.uint8]],
        start_mm: float,
        style: BrailleStyle,
        placed: Sequence[tuple[FigureLike, float]],
    ) -> Program | None:
        """Make one picture of a page and its figures; None if it cannot be, which is said.

        Parameters
        ----------
        lines : sequence of uint8[cells]
            Dot masks of each line of the page.
        start_mm
            Place at which the lines begin.
        style
            How the braille is shown.
        placed
            Figures, each with the place of its upper edge on the page, in mm.
        """
        ...


class FeltLike(Keyed, Protocol):
    """A figure that is felt in place of the text, by keys of its own."""

    @property
    def done(self) -> bool:
        """Whether the reader has enough of it."""
        ...

    def attend(self, now_s: float) -> None:
        """Do what is done by time."""
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
    figures
        Function that gives the figures of the text, called when there is one; None if they stay
        unfelt.
    """

    bound: Bound | None = None
    seeker: SeekerLike | None = None
    kept: KeptLike | None = None
    scroll: ScrollLike | None = None
    cue: Callable[[Cue], None] = _no_cue
    save_style: Callable[[BrailleStyle], str] | None = None
    verbose: bool = False
    figures: Callable[[], FiguresLike] | None = None
