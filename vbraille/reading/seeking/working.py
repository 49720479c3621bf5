"""What the process does: one question at a time, lines in between, the index when nothing is asked.

Work is a generator, which stops and goes on at each step, so that a question or the end of the
parent is heard within a step.
"""

from __future__ import annotations

import os
import select
import time
from typing import TYPE_CHECKING, Any

import msgspec

from vbraille.errors import VbrailleError
from vbraille.reading.queries import CountLines, Failed, Query, Searched
from vbraille.reading.seeking.answering import Answering
from vbraille.reading.seeking.opening import BookOpening, open_again

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.reading.queries import Answer
    from vbraille.reading.seeking.pipes import Incoming, Outgoing

PROGRESS_S = 0.5
_LOOK_S = 0.02  # how often it is looked whether somebody asks; a step of work takes about as long


class Worker:
    """Work on one book, as messages ask for it.

    A message to it is a dict: "open" with the fields of a `BookOpening`, then "ask" with those
    of a question and its "number", or "cancel" with that. A message from it has the "number" and
    the "answer"; the number of what nobody asked is 0.

    Parameters
    ----------
    incoming, outgoing
        Pipes from and to the reader.
    now
        Clock in seconds.
    """

    def __init__(
        self, incoming: Incoming, outgoing: Outgoing, now: Callable[[], float] = time.monotonic
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

    def run(self, wait: Callable[[Incoming], None]) -> None:
        """Work until the reader is gone; where there is nothing to do, a function waits."""
        while not self._incoming.ended:
            idle = not any(self._works)
            if idle and self._outgoing.flush():
                wait(self._incoming)
            elif idle:
                time.sleep(_LOOK_S)  # the reader has not taken all that it was told
            if idle or self._now() - self._looked_s >= _LOOK_S:
                self._looked_s = self._now()
                for message in self._incoming.messages():
                    self._take(message)
                self._outgoing.flush()
            self._step()

    def _take(self, message: dict[str, Any]) -> None:
        if "open" in message:
            fields = {**message["open"], "file": os.fsdecode(message["open"]["file"])}
            self._open(msgspec.convert(fields, BookOpening))
        elif "ask" in message:
            self._begin(message["number"], msgspec.convert(message["ask"], Query))
        elif "cancel" in message:
            for urgency, work in enumerate(self._works[:2]):
                if work is not None and work[0] == message["cancel"]:
                    self._works[urgency] = None

    def _open(self, opening: BookOpening) -> None:
        try:
            self._answering = Answering(open_again(opening))
        except VbrailleError as error:
            self._failed = str(error)
            return
        self._works[2] = (0, self._answering.index())

    def _begin(self, number: int, query: Query) -> None:
        if self._answering is None:
            self._tell(number, Failed(self._failed or "the book has not been opened"))
            return
        urgency = 1 if isinstance(query, CountLines) else 0
        self._works[urgency] = (number, self._answering.answer(query))
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
        self._outgoing.put({"number": number, "answer": answer})


def wait(incoming: Incoming) -> None:
    """Wait until a message or the end of the pipe comes."""
    select.select([incoming.descriptor], [], [])
