"""A conventional display beside: the line under the hand, or what is said, stands on it, too."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any, Final

from vbraille.cli.old.reading.commands.reporting import say_cell
from vbraille.cli.old.reading.keys import Context
from vbraille.cli.old.reading.outputs import Output
from vbraille.cli.old.reading.speech import TOGETHER_S
from vbraille.conventional.brlapi import DisplayAway, DisplayStands, KeyPressed, KeyTyped
from vbraille.layout import lay_out_text

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vbraille.cli.old.reading.reader import Reader
    from vbraille.cli.old.reading.view import View
    from vbraille.conventional.display import ConventionalDisplay
    from vbraille.devices.events import Event
    from vbraille.layout import Line
    from vbraille.translate import BrailleTable

_ROUTE: Final = "ROUTE"
_ALONG: Final = {"FWINRT": 1, "FWINLT": -1}
_SLACK: Final = 1  # cells that the finger may be beyond what is shown before the display follows


class Pane:
    """The part of a line that stands on a display, which follows the finger.

    Attributes
    ----------
    offset : int
        Cell of the line that stands first.
    """

    def __init__(self) -> None:
        self.offset = 0
        self._width = 0
        self._line: Line | None = None
        self._panned_at: int | None = None  # the finger's cell when a key last moved the pane

    def follow(self, line: Line, width: int, cell: int | None, first: int) -> None:
        """Show the part of a line in which the finger is.

        A line falls into parts of the display's width, so that each stands still while it is read.
        The finger may stray by a cell beyond it. After a key has moved the pane it stays until the
        finger goes on.

        Parameters
        ----------
        line
            The line under the hand.
        width
            Number of cells of the display.
        cell
            Number of the cell under the finger; None if there is none.
        first
            Cell at which what is under the hand begins.
        """
        if width != self._width or not _same(line, self._line):
            self._line, self._width, self._panned_at = line, width, None
            self.offset = (first if cell is None else cell) // width * width
            return
        if cell is None or (self._panned_at is not None and abs(cell - self._panned_at) <= _SLACK):
            return
        self._panned_at = None
        slack = _SLACK if width > _SLACK else 0
        if not self.offset - slack <= cell < self.offset + width + slack:
            self.offset = cell // width * width

    def pan(self, step: int, cell: int | None) -> bool:
        """Show the next part of the line, or the one before; False if there is none.

        Parameters
        ----------
        step
            1 for the next part, -1 for the one before.
        cell
            Number of the cell under the finger; None if there is none.
        """
        offset = self.offset + step * self._width
        if self._line is None or not 0 <= offset < len(self._line):
            return False
        self.offset, self._panned_at = offset, cell
        return True

    def reset(self) -> None:
        """Begin anew where the finger is, or the hand's part of the line."""
        self._line = None

    def end(self, line: Line, cell: int | None) -> None:
        """Show the last part of another line, and stay there until the finger goes on."""
        self._line, self._panned_at = line, cell
        self.offset = max(len(line) - 1, 0) // max(self._width, 1) * self._width

    @property
    def cells(self) -> bytes:
        """Dot masks of what is shown."""
        if self._line is None:
            return b""
        return self._line.masks[self.offset : self.offset + self._width].tobytes()


def _same(line: Line, other: Line | None) -> bool:
    """Tell whether two are one line, which may have been laid out twice."""
    return other is not None and (
        line is other
        or (line.number == other.number and line.masks.tobytes() == other.masks.tobytes())
    )


class _OnDisplay(Output):
    """An output on a conventional display, whose keys are obeyed.

    Parameters
    ----------
    display
        The display. Nothing here waits for it.
    view
        Function that gives the view which is explored.
    say
        Function that is called with each sentence about the display.
    """

    def __init__(
        self,
        display: ConventionalDisplay,
        view: Callable[[], Any],
        say: Callable[[str], None],
    ) -> None:
        self._display = display
        self._view = view
        self._say = say
        self._shown: bytes | None = None

    def attend(self, events: Sequence[Event] = ()) -> None:  # noqa: ARG002 - which are said
        """Show what is to stand there, if it is another than before, and do what keys say."""
        view = self._view()
        for message in self._display.poll():
            if isinstance(message, DisplayStands):
                self._say(f"display: {message.title}, {message.columns} cells")
            elif isinstance(message, DisplayAway):
                self._say(f"display: {message.why}")
            elif isinstance(message, KeyPressed):
                self._press(view, message)
            elif isinstance(message, KeyTyped):
                view.press(message.key)
        if (cells := self._cells(view)) != self._shown:
            self._shown = cells
            self._display.show(cells)

    def rest(self) -> None:
        """Give the display back for a while, until `attend` is called."""
        self._shown = None
        self._display.rest()

    def close(self) -> None:
        """Give the display back."""
        self._display.close()

    def _press(self, view: Any, key: KeyPressed, /) -> None:
        """Do what a key of the display says."""
        raise NotImplementedError

    def _cells(self, view: Any, /) -> bytes:
        """Give the dot masks that are to stand there."""
        raise NotImplementedError


class SentencesOnDisplay(_OnDisplay):
    """A conventional display on which what was said last stands, a part at a time.

    Its keys for panning go through all that was said together.

    Parameters
    ----------
    display, view, say
        As for a `ConventionalView`.
    table
        Table that sentences are translated by.
    now_s
        Clock in seconds that does not go back.
    """

    def __init__(
        self,
        display: ConventionalDisplay,
        view: Callable[[], View],
        say: Callable[[str], None],
        table: BrailleTable,
        now_s: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(display, view, say)
        self._table = table
        self._now_s = now_s
        self._said_s = -math.inf
        self._sentences: list[str] = []
        self._at = 0  # part of all these sentences that stands there

    def say(self, sentence: str) -> None:
        """Take a sentence, which takes the place of those before unless it follows at once."""
        before_s, self._said_s = self._said_s, self._now_s()
        if self._said_s - before_s >= TOGETHER_S:
            self._sentences.clear()
            self._at = 0
        self._sentences.append(sentence)

    def _press(self, view: View, key: KeyPressed) -> None:
        at = self._at + _ALONG.get(key.name, 0)
        if at == self._at:
            view.call(f"display {key.name}", view.bound.display_keys.get(key.name))
        elif 0 <= at < len(self._parts()):
            self._at = at

    def _parts(self) -> list[bytes]:
        """Dot masks of all sentences, cut into parts of the display's width."""
        if self._display.standing is None:
            return []
        width, parts = self._display.standing.columns, []
        for sentence in self._sentences:
            layout = lay_out_text(sentence, width, self._table)
            number = 1
            while (line := layout.line(number)) is not None:
                parts.append(line.masks.tobytes())
                number += 1
        return parts

    def _cells(self, view: View) -> bytes:  # noqa: ARG002 - whose sentences come by `say`
        parts = self._parts()
        return parts[self._at] if parts else b""


class ConventionalView(_OnDisplay):
    """A conventional display on which the line under the hand stands, and whose keys are obeyed.

    Parameters
    ----------
    display
        The display. Nothing here waits for it.
    reader
        Function that gives the reader whose line it is.
    say
        Function that is called with each sentence about it.
    """

    def __init__(
        self,
        display: ConventionalDisplay,
        reader: Callable[[], Reader],
        say: Callable[[str], None],
    ) -> None:
        super().__init__(display, reader, say)
        self._pane = Pane()

    def _cells(self, reader: Reader) -> bytes:
        standing, window = self._display.standing, reader.window
        if standing is not None:
            first = max(window.offset, 0)
            self._pane.follow(window.line, standing.columns, reader.cell, first)
        return self._pane.cells

    def _press(self, reader: Reader, key: KeyPressed) -> None:
        reading = reader.context is Context.READING
        if key.name == _ROUTE and reading:
            self._go_to(reader, self._pane.offset + key.argument)
            return
        if key.name == _ROUTE and reader.context is Context.LEARNING:
            self._say("display ROUTE: say what is here, and go there")
            return
        command = reader.bound.display_keys.get(key.name)
        step = 0 if command is None else _ALONG.get(command.name, 0)
        if step and reading and self._pan(reader, step):
            return
        window, line = reader.window, reader.line
        reader.call(f"display {key.name}", command)
        if step < 0 and reader.line is not line:
            self._pane.end(reader.line, reader.cell)
        elif reader.window is not window:
            self._pane.reset()

    def _pan(self, reader: Reader, step: int) -> bool:
        """Go along the line by the display's width, the hand too; False if the line ends here."""
        window = reader.window
        panned = self._pane.pan(step, reader.cell)
        if not panned:  # so that the command goes on to another line
            there = window.last if step > 0 else window.showing(0)
        else:
            there = window.showing(self._pane.offset)
        first = max(window.offset, 0)
        seen = first <= self._pane.offset < first + len(window)
        if there.offset != window.offset and not (panned and seen):
            reader.put(there)
        return panned

    def _go_to(self, reader: Reader, cell: int) -> None:
        """Say what a cell of the line is, and bring it under the finger."""
        source = None
        if cell < len(reader.line):
            source = reader.line.source(cell)
        if source is not None:
            reader.bring_under(source[0])
        say_cell(reader, cell)
