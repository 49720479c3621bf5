"""The process that looks through a book: a question at a time, then lines, then the index.

Work is a generator, which stops and goes on at each step, so that a question or the end of the
parent is heard within a step.
"""

from __future__ import annotations

import os
import time
from contextlib import suppress
from typing import TYPE_CHECKING

from vbraille.errors import VbrailleError
from vbraille.layout.texts import choose_table
from vbraille.reading.search.answering import Answering
from vbraille.reading.search.queries import (
    Ask,
    BookOpening,
    CountLines,
    Failed,
    Order,
    Searched,
    Told,
)
from vbraille.translate import Book, Undefined
from vbraille.translate.formats import open_source
from vbraille.workers import begin

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.reading.search.queries import Answer
    from vbraille.workers import Incoming, Outgoing

PROGRESS_S = 0.5
_NICE = 10  # the loop of the display and the reader's keys come first
_LOOK_S = 0.02  # how often it is looked whether somebody asks; a step of work takes about as long


class BookSearch:
    """Work on one book, as messages ask for it.

    Parameters
    ----------
    incoming, outgoing
        Messages from and to the reader.
    now
        Clock in seconds.
    """

    def __init__(
        self,
        incoming: Incoming[Order],
        outgoing: Outgoing,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._incoming = incoming
        self._outgoing = outgoing
        self._now = now
        self._answering: Answering | None = None
        self._failed: str | None = None
        # What is worked on, the most urgent first: a search, a count, the index.
        self._works: list[tuple[int, Iterator[Answer]] | None] = [None, None, None]
        self._told_s = -PROGRESS_S
        self._looked_s = -_LOOK_S

    def run(self) -> None:
        """Work until the reader is gone."""
        while not self._incoming.ended:
            idle = not any(self._works)
            if idle:
                # The reader may not have taken yet all that it was told.
                self._incoming.wait(None if self._outgoing.flush() else _LOOK_S)
            if idle or self._now() - self._looked_s >= _LOOK_S:
                self._looked_s = self._now()
                for order in self._incoming.take():
                    self._take(order)
                self._outgoing.flush()
            self._step()

    def _take(self, order: Order) -> None:
        match order:
            case BookOpening():
                self._open(order)
            case Ask():
                self._begin(order)
            case _:
                for urgency, work in enumerate(self._works[:2]):
                    if work is not None and work[0] == order.number:
                        self._works[urgency] = None

    def _open(self, opening: BookOpening) -> None:
        try:
            self._answering = Answering(_open_again(opening))
        except VbrailleError as error:
            self._failed = str(error)
            return
        self._works[2] = (0, self._answering.index())

    def _begin(self, asked: Ask) -> None:
        if self._answering is None:
            self._tell(asked.number, Failed(self._failed or "the book has not been opened"))
            return
        urgency = 1 if isinstance(asked.query, CountLines) else 0
        self._works[urgency] = (asked.number, self._answering.answer(asked.query))
        self._told_s = self._now() - PROGRESS_S / 2  # what is answered at once has no progress

    def _step(self) -> None:
        """Do the next step of what is most urgent, and tell what came of it."""
        for urgency, work in enumerate(self._works):
            if work is None:
                continue
            number, steps = work
            try:
                answer = next(steps, None)
            except VbrailleError as error:
                answer = Failed(str(error))
            except Exception as error:
                what = f"{type(error).__name__}: {error}"
                answer = Failed(f"looking through the book failed by a fault of vbraille's: {what}")
            if not isinstance(answer, Searched):
                self._works[urgency] = None
                if isinstance(answer, Failed) and not number:
                    return  # nobody asked; who reads that part is told
                if answer is not None:
                    self._tell(number, answer)
            elif number and self._now() - self._told_s >= PROGRESS_S:
                self._told_s = self._now()
                self._tell(number, answer)
            return

    def _tell(self, number: int, answer: Answer) -> None:
        self._outgoing.put(Told(number, answer))


def _open_again(opening: BookOpening) -> Book:
    """Open a book as the reader has it open.

    Raises
    ------
    InputError
        If the book or its table cannot be opened.
    """
    # A path of its own gives the process a place of its own in the file.
    file = os.fsdecode(opening.file)
    path = file if opening.descriptor is None else f"/proc/self/fd/{opening.descriptor}"
    source = open_source(
        path,
        name=opening.name or file,
        encoding=opening.encoding,
        keep_lines=opening.keep_lines,
        brf_table=opening.brf_table,
        form=opening.form,
        wishes=("encoding", "keep_lines"),  # the reader has the book open with them
    )
    if opening.index is not None:
        source.adopt(opening.index)
    if source.in_cells:
        return Book(source)
    undefined = Undefined(opening.undefined)
    named = None if opening.table else opening.language
    table = choose_table(named, None if opening.table else opening.grade, opening.table, undefined)
    return Book(
        source,
        table,
        language=opening.language or "",
        grade=opening.grade,
        switch=opening.switch,
    )


if __name__ == "__main__":
    with suppress(BrokenPipeError):
        BookSearch(*begin(Order, _NICE)).run()
