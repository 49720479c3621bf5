"""The process that looks through a book, as a reader has it: asked, and never waited for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Self

import msgspec

from vbraille.reading.queries import (
    Ask,
    Cancel,
    CountLines,
    Failed,
    FindText,
    Indexed,
    Searched,
    Told,
)
from vbraille.workers import Worker

if TYPE_CHECKING:
    from vbraille.reading.queries import Answer, BookOpening, Query
    from vbraille.translate.source import Index

_MODULE: Final = "vbraille.reading.seeking.working"


class Seeker:
    """A process that looks through a book; it begins with the first question, or with `start`.

    One question is worked on at a time, and beside it one count of lines, which goes on when
    there is no question. When there is nothing else to do, the process finds out where all
    blocks of the book are. No method waits.

    Parameters
    ----------
    opening
        How the book is opened there. A descriptor in it is inherited.

    Attributes
    ----------
    index : Index or None
        Where all blocks of the book are, once that is known.
    """

    def __init__(self, opening: BookOpening) -> None:
        self.index: Index | None = None
        self._opening = opening
        self._worker: Worker[Told] | None = None
        self._last = 0
        self._asked: dict[bool, int] = {}  # number of a question, and of a count of lines
        self._answers: list[Answer] = []

    @property
    def busy(self) -> bool:
        """Whether a question has not been answered; a count of lines is no question here."""
        return False in self._asked

    @property
    def counting(self) -> bool:
        """Whether lines are being counted."""
        return True in self._asked

    @property
    def descriptor(self) -> int | None:
        """Number of the open file that can be read when an answer comes; None without a process."""
        return None if self._worker is None else self._worker.descriptor

    def start(self) -> None:
        """Start the process, if it does not run, so that it can see where the book's blocks are."""
        if self._worker is not None:
            return
        descriptor = self._opening.descriptor
        inherited = () if descriptor is None else (descriptor,)
        try:
            self._worker = Worker(_MODULE, tells=Told, pass_fds=inherited, quiet=True)
        except OSError as error:
            self._fail(f"the book cannot be looked through: {error.strerror}")
            return
        self._worker.send(self._opening)

    def ask(self, query: Query) -> None:
        """Ask a question; one of the same kind that was not answered yet is given up."""
        counts = isinstance(query, CountLines)
        if isinstance(query, FindText):  # halves of characters cannot be sent, nor found
            text = query.text.encode("utf-8", "replace").decode()
            query = msgspec.structs.replace(query, text=text)
        self._give_up(counts=counts)
        self._last += 1
        self._asked[counts] = self._last
        self.start()
        if self._worker is not None:
            self._worker.send(Ask(self._last, query))

    def poll(self) -> Answer | None:
        """Give the next answer that has come, or None.

        A question has `Searched` any number of times, at most two a second, and then one other
        answer. `Indexed` comes once, without a question.
        """
        if not self._answers and self._worker is not None:
            self._hear(self._worker)
        return self._answers.pop(0) if self._answers else None

    def cancel(self) -> None:
        """Give the question up: no answer to it comes any more. A count of lines goes on."""
        self._give_up(counts=False)

    def close(self) -> None:
        """End the process. Further calls do nothing."""
        worker, self._worker = self._worker, None
        self._asked.clear()
        self._answers.clear()
        if worker is not None:
            worker.close(0)  # it has nothing to leave in order

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _give_up(self, *, counts: bool) -> None:
        number = self._asked.pop(counts, None)
        self._answers = [answer for answer in self._answers if isinstance(answer, Indexed)]
        if number is not None and self._worker is not None:
            self._worker.send(Cancel(number))

    def _hear(self, worker: Worker[Told]) -> None:
        for told in worker.receive():
            self._take(told.number, told.answer)
        if worker.ended:
            self._worker = None
            worker.close(0)
            self._fail("the process that looks through the book has ended; ask again")

    def _take(self, number: int, answer: Answer) -> None:
        if isinstance(answer, Indexed):
            self.index = answer.index
        else:
            asked = [counts for counts, n in self._asked.items() if n == number]
            if not asked:
                return  # it was given up
            if not isinstance(answer, Searched):
                del self._asked[asked[0]]
            elif asked[0]:
                return  # how far a count is, nobody waits for
        self._answers.append(answer)

    def _fail(self, sentence: str) -> None:
        if self._asked:
            self._asked.clear()
            self._answers.append(Failed(sentence))
