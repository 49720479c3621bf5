"""The reader's place and bookmarks, kept while reading goes on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vbraille.reading.beside import BookmarkLike, KeptLike

_EVERY_S = 1.0


@dataclass(frozen=True, slots=True)
class _Mark:
    """A place with a name."""

    name: str
    character: int
    text: str


class Unkept:
    """What is kept of a book no longer than a reading lasts."""

    def __init__(self) -> None:
        self._marks: dict[str, _Mark] = {}

    def bookmarks(self) -> list[BookmarkLike]:
        """Give all bookmarks, by their place."""
        return sorted(self._marks.values(), key=lambda mark: mark.character)

    def mark(self, name: str, character: int, text: str) -> None:
        """Set a bookmark."""
        self._marks[name] = _Mark(name, character, text)

    def delete_bookmark(self, name: str) -> None:
        """Delete a bookmark."""
        self._marks.pop(name, None)

    def keep(self, character: int) -> None:
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
        self._character: int | None = None  # one that is not kept yet
        self._last_s: float | None = None

    def moved(self, character: int) -> None:
        """Take a place that is to be kept."""
        self._character = character

    def step(self, now_s: float) -> None:
        """Keep the place if it is time; called again and again."""
        if self._character is None:
            return
        if self._last_s is None or now_s - self._last_s >= _EVERY_S:
            self._last_s = now_s
            self.leave()

    def leave(self) -> None:
        """Keep the place now."""
        if self._character is not None:
            self.kept.keep(self._character)
            self._character = None
