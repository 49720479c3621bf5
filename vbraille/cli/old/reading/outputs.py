"""Outputs of an exploration: observers of one interface, by which it is heard and seen."""

from __future__ import annotations

import os
import time
from enum import Enum, StrEnum
from typing import TYPE_CHECKING, Final, Self

from vbraille.cli.old.reading.position import place_sentence
from vbraille.cli.old.reading.view import SoundFile
from vbraille.workers import Worker

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from vbraille.cli.old.reading.speech import Speech
    from vbraille.cli.old.reading.view import Cue
    from vbraille.devices.events import Event
    from vbraille.layout import Layout, Line
    from vbraille.translate import Book


class Echo(StrEnum):
    """Kinds of echo: the parts of each line that are said."""

    NONE = "none"
    TEXT = "text"
    CELLS = "cells"
    BOTH = "both"

    def sentences(self, line: Line, layout: Layout) -> Iterator[str]:
        """Give the sentences that are said of a line of a layout, in order."""
        if self is Echo.NONE:
            return
        yield place_sentence(layout, line)
        yield from self.words(line)

    def words(self, line: Line) -> Iterator[str]:
        """Give the sentences on what is printed of a line."""
        if self in (Echo.CELLS, Echo.BOTH):
            yield f"cells: {line.printed.to_unicode()}"
        if self in (Echo.TEXT, Echo.BOTH):
            yield f"text: {line.text.strip()}"


_USUAL_LANGUAGE: Final = "en"
_CELLS: Final = "cells: "  # begins a sentence of braille signs, which no voice can say
_APART_S: Final = 0.1  # from one cue to the next
_CUEING: Final = "vbraille.cli.old.reading.cueing"


def language_of(book: Book, asked: str | None = None) -> str:
    """Choose the language in which a book is spoken, as a tag.

    Parameters
    ----------
    book
        The book, whose language, or whose table's, is spoken unless another was asked for.
    asked
        Language that was asked for; None if none was.
    """
    info = None if book.table is None else book.table.info
    table = "" if info is None else info.language
    return asked or book.source.language or table or _USUAL_LANGUAGE


class Output:
    """An observer of an exploration; what it leaves alone does nothing."""

    def say(self, sentence: str) -> None:
        """Take a sentence that is said."""

    def cue(self, cue: Cue) -> None:
        """Take a short signal, beside the sentence that says the same."""

    def sound(self, path: Path) -> None:
        """Take a file of sound that is to be played."""

    def attend(self, events: Sequence[Event] = ()) -> None:
        """Look at what is under the hand, and at events of the device; called all the time."""

    def stand(self, why: str) -> None:
        """Take note that nothing is explored, by a sentence; empty if it is again."""

    def rest(self) -> None:
        """Show nothing until `attend` is called, since the program is stopped."""

    def close(self) -> None:
        """End; further calls do nothing."""


class Outputs(Output):
    """All outputs of an exploration. A context manager.

    Parameters
    ----------
    outputs
        The first of them; others may be added.
    """

    def __init__(self, *outputs: Output) -> None:
        self._outputs = list(outputs)

    def add(self, output: Output) -> None:
        """Have another output from now on."""
        self._outputs.append(output)

    def say(self, sentence: str) -> None:
        """Have a sentence said by each."""
        for output in self._outputs:
            output.say(sentence)

    def cue(self, cue: Cue) -> None:
        """Have a signal given by each."""
        for output in self._outputs:
            output.cue(cue)

    def sound(self, path: Path) -> None:
        """Have a file of sound played."""
        for output in self._outputs:
            output.sound(path)

    def attend(self, events: Sequence[Event] = ()) -> None:
        """Have each look at what is under the hand."""
        for output in self._outputs:
            output.attend(events)

    def stand(self, why: str) -> None:
        """Tell each why nothing is explored."""
        for output in self._outputs:
            output.stand(why)

    def rest(self) -> None:
        """Have each show nothing for a while."""
        for output in self._outputs:
            output.rest()

    def close(self) -> None:
        """End each of them."""
        for output in self._outputs:
            output.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class ConsoleOutput(Output):
    """Sentences on lines of their own.

    Parameters
    ----------
    print_line
        Function that prints a line.
    """

    def __init__(self, print_line: Callable[[str], None]) -> None:
        self._print = print_line

    def say(self, sentence: str) -> None:
        """Print a sentence."""
        self._print(sentence)


class SpeechOutput(Output):
    """Sentences as speech, and the text of each line that comes under the hand.

    Parameters
    ----------
    speech
        Speech, which this ends.
    line
        Function that gives the line under the hand; None for none.
    echo
        How much is said of each line, which is then not spoken again.
    """

    def __init__(
        self,
        speech: Speech,
        line: Callable[[], Line | None] = lambda: None,
        *,
        echo: Echo = Echo.NONE,
    ) -> None:
        self.speech = speech
        self._line = line
        self._speaks_lines = echo in (Echo.NONE, Echo.CELLS)
        self._seen = (0, "")  # number and text of the line that was spoken last

    def say(self, sentence: str) -> None:
        """Speak a sentence."""
        if not sentence.startswith(_CELLS):
            self.speech.say(sentence)

    def attend(self, events: Sequence[Event] = ()) -> None:  # noqa: ARG002 - which are said
        """Speak the text of the line that is under the hand, if it is another than before."""
        line = self._line() if self._speaks_lines else None
        seen = self._seen if line is None else (line.number, line.text.strip())
        if seen != self._seen:
            self._seen = seen
            self.speech.say(seen[1] or "blank")

    def close(self) -> None:
        """End speech."""
        self.speech.close()


class CueKind(Enum):
    """Kinds of signals by which cues are given."""

    TONES = "tones"
    BELL = "bell"
    NONE = "none"


def choose_cues(asked: str | None, *, attended: bool) -> CueKind:
    """Choose what cues are given by.

    Parameters
    ----------
    asked
        Value of a `CueKind` that was asked for; None if none was.
    attended
        Whether a reader is at a terminal. Without one, only cues that were asked for are heard; at
        the end of a network the terminal's bell is the only sound that comes through.
    """
    if asked is not None:
        return CueKind(asked)
    if not attended:
        return CueKind.NONE
    return CueKind.BELL if "SSH_CONNECTION" in os.environ else CueKind.TONES


class Cues(Output):
    """Cues that are heard, at most ten a second.

    A process of its own gives them, so that reading never waits for a sound. Where there is no
    audio output the terminal's bell rings.

    Parameters
    ----------
    kind
        Kind of signal.
    now_s
        Clock in seconds that does not go back.
    """

    def __init__(self, kind: CueKind, now_s: Callable[[], float] = time.monotonic) -> None:
        self._now_s = now_s
        self._given_s = float("-inf")
        self._kind = kind
        self._closed = False
        self._worker: Worker | None = None  # started with the first cue

    def cue(self, cue: Cue) -> None:
        """Give a cue, in place of one that is still heard; one that comes too soon is left out."""
        now_s = self._now_s()
        if self._kind is CueKind.NONE or now_s - self._given_s < _APART_S:
            return
        self._given_s = now_s
        self._send(cue)

    def sound(self, path: Path) -> None:
        """Play a file of sound, in place of what is still heard, whatever cues are given by."""
        if not self._closed:
            self._send(SoundFile(str(path)))

    def _send(self, order: Cue | SoundFile) -> None:
        if self._worker is None:
            self._worker = Worker(_CUEING, self._kind.value)
        if not self._worker.send(order, alone=True):
            self.close()  # whatever ended it, the sentences beside the cues are still said

    def close(self) -> None:
        """Give no more cues; further calls do nothing."""
        self._kind, self._closed = CueKind.NONE, True
        worker, self._worker = self._worker, None
        if worker is not None:
            worker.close()
