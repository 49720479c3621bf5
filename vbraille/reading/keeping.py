"""The reader's place and bookmarks, kept while reading goes on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.reading.whereabouts import first_character, is_counted, page_label

if TYPE_CHECKING:
    from vbraille.layout.pages import Layout, Line
    from vbraille.reading.beside import BookmarkLike, KeptLike
    from vbraille.translate.source import Source

_EVERY_S = 1.0


class Unkept:
    """What is kept of a book no longer than a reading lasts."""

    fault: str | None = None

    def __init__(self) -> None:
        self._marks: dict[str, Any] = {}

    def bookmarks(self) -> list[BookmarkLike]:
        """Give all bookmarks, by their place."""
        return sorted(self._marks.values(), key=lambda mark: mark.character)

    def set_bookmark(self, bookmark: Any) -> None:
        """Set a bookmark."""
        self._marks[bookmark.name] = bookmark

    def delete_bookmark(self, name: str) -> None:
        """Delete a bookmark."""
        self._marks.pop(name, None)

    def tend(self) -> None:
        """Write nothing: all is only remembered."""

    def keep_at(self, source: Source, character: int, **place: Any) -> None:
        """Keep no place: there is no other time."""


class Keeping:
    """Keep the place of a reading, at most once a second.

    Parameters
    ----------
    kept
        Where it is kept; None for nowhere.
    """

    def __init__(self, kept: KeptLike | None) -> None:
        self.kept: KeptLike = Unkept() if kept is None else kept
        self._place: tuple[Layout, Line] | None = None  # one that is not kept yet
        self._last_s: float | None = None

    def moved(self, layout: Layout, line: Line) -> None:
        """Take a line at which reading is to go on."""
        self._place = layout, line

    def step(self, now_s: float) -> None:
        """Keep the place, and what could not be kept before, if it is time; called all the time."""
        if self._last_s is None or now_s - self._last_s >= _EVERY_S:
            self._last_s = now_s
            self.kept.tend()
            self.leave()

    def start_over(self, layout: Layout) -> None:
        """Keep the beginning, since the text was read to its end."""
        self._place = None
        self._keep(layout, 0, line=1, lines_before=0)

    def leave(self) -> None:
        """Keep the place now."""
        if self._place is None:
            return
        (layout, line), self._place = self._place, None
        self._keep(
            layout,
            first_character(line),
            line=layout.number_of(line) if is_counted(layout) else None,
            lines_before=layout.lines_before(line),
            page=page_label(layout.book.source, line),
        )

    def _keep(self, layout: Layout, character: int, **told: Any) -> None:
        source, table = layout.book.source, layout.book.table
        name = "" if table is None else table.name
        self.kept.keep_at(source, character, width=layout.width, table=name, **told)
