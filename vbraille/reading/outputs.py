"""All that a reader hears beside the braille: sentences, speech and cues, in one place."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, Final, Self

from vbraille.reading.speech import Speech
from vbraille.reading.whereabouts import place_sentence

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.layout.pages import Layout, Line
    from vbraille.reading.cues import Cue, Cues
    from vbraille.translate import Book


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


_USUAL_LANGUAGE: Final = "en"
_CELLS: Final = "cells: "  # what a sentence of braille signs begins with, which nobody can say


def language_of(book: Book, asked: str | None = None) -> str:
    """Language in which a book is spoken, as a tag: what was asked for, or the book or table says.

    Parameters
    ----------
    book
        The book.
    asked
        Language that was asked for; None if none was.
    """
    info = None if book.table is None else book.table.info
    table = "" if info is None else info.language
    return asked or book.source.language or table or _USUAL_LANGUAGE


class Outputs:
    """What a reader hears. A context manager.

    Parameters
    ----------
    print_line
        Function that prints a sentence.
    cues
        Cues that are given.
    echo
        How much is printed of each line, and spoken with it.

    Attributes
    ----------
    speech : Speech or None
        Speech, once `speak` was called.
    """

    def __init__(
        self, print_line: Callable[[str], None], cues: Cues, *, echo: Echo = Echo.NONE
    ) -> None:
        self.speech: Speech | None = None
        self._print = print_line
        self._cues = cues
        self._speaks_lines = echo in (Echo.NONE, Echo.CELLS)
        self._seen = (0, "")  # number and text of the line that was spoken last

    def speak(self, language: str) -> None:
        """Speak from now on, in a language given by its tag."""
        self.speech = Speech(language)

    def say(self, sentence: str) -> None:
        """Print a sentence, and speak it."""
        self._print(sentence)
        if self.speech is not None and not sentence.startswith(_CELLS):
            self.speech.say(sentence)

    def see(self, line: Line | None) -> None:
        """Speak the text of the line that is under the hand, if it is another than before."""
        if self.speech is None or line is None or not self._speaks_lines:
            return
        seen = line.number, line.text.strip()
        if seen != self._seen:
            self._seen = seen
            self.speech.say(seen[1] or "blank")

    def cue(self, cue: Cue) -> None:
        """Give a cue."""
        self._cues.give(cue)

    def close(self) -> None:
        """End speech and cues; further calls do nothing."""
        if self.speech is not None:
            self.speech.close()
        self._cues.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
