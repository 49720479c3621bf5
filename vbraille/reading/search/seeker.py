"""Search as a reader has it: near at once, and far by a process that is never waited for."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, Final, Self

import msgspec

from vbraille.reading.search.answering import steps
from vbraille.reading.search.queries import (
    Ask,
    Cancel,
    Counted,
    CountLines,
    Failed,
    FindKind,
    FindLine,
    FindPage,
    FindShare,
    FindText,
    Found,
    Indexed,
    Listed,
    ListHeadings,
    NotFound,
    Searched,
    Told,
)
from vbraille.reading.search.structure import Reach
from vbraille.workers import Worker

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.search.answering import Hit
    from vbraille.reading.search.queries import Answer, BookOpening, Query
    from vbraille.translate.source import Source

_PROGRESS_S: Final = 2.0
_MODULE: Final = "vbraille.reading.search.process"


class Seeker:
    """A process that looks through a book; it begins with the first question, or with `start`.

    One question is worked on at a time, and beside it one count of lines, which goes on when
    there is no question. When there is nothing else to do, the process finds out where all
    blocks of the book are. No method waits.

    Parameters
    ----------
    opening
        How the book is opened there. A descriptor in it is inherited.
    """

    def __init__(self, opening: BookOpening) -> None:
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
        if not isinstance(answer, Indexed):
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


class Search:
    """Search of a reader, one question at a time: near first, then in the whole book.

    Parameters
    ----------
    say
        Function that is called with each thing to be said.
    seeker
        Process that looks through the whole book; None to do so here.
    verbose
        Whether to say how far the search has come.
    counted
        Function that is called when lines have been counted.
    """

    def __init__(
        self,
        say: Callable[[str], None],
        seeker: Seeker | None = None,
        *,
        verbose: bool = False,
        counted: Callable[[Counted], None] = lambda _: None,
    ) -> None:
        self.seeker = seeker
        self._counted = counted
        self._verbose = verbose
        self._say = say
        self._then: Callable[[Any], None] | None = None
        self._said_s: float | None = None

    @property
    def busy(self) -> bool:
        """Whether something is looked for."""
        return self._then is not None

    def find(self, source: Source, query: Query, then: Callable[[Any], None]) -> None:
        """Look for something; one that was looked for before is given up.

        Parameters
        ----------
        source
            The book.
        query
            What is looked for.
        then
            Function that is called with its place, with the headings, or with None if it is
            nowhere: now or later.
        """
        self.cancel()
        found = look(source, query)
        if found is not query:
            then(found)
        elif self.seeker is None:
            then(look_everywhere(source, query))
        else:
            self._then, self._said_s = then, None
            self._say("searching")
            self.seeker.ask(query)

    def poll(self, source: Source, now_s: float) -> None:
        """Take what the other process has found; called again and again, with the time."""
        if self._said_s is None:
            self._said_s = now_s
        while self.seeker is not None and (answer := self.seeker.poll()) is not None:
            index = getattr(answer, "index", None)
            if index is not None:
                source.adopt(index)
            if isinstance(answer, Counted):
                self._counted(answer)
            elif self._then is None:
                continue
            elif isinstance(answer, Searched):
                if self._verbose and now_s - self._said_s >= _PROGRESS_S:
                    self._said_s = now_s
                    self._say(f"searching: {100 * answer.share:.0f} %")
            elif isinstance(answer, Failed):
                self._then = None
                self._say(f"search: {answer.sentence}")
            elif isinstance(answer, Found | Listed | NotFound):
                then, self._then = self._then, None
                if isinstance(answer, Listed):
                    then(answer.headings)
                else:
                    then(answer.character if isinstance(answer, Found) else None)

    def cancel(self) -> bool:
        """Give up what is looked for; False if nothing is."""
        if self._then is None or self.seeker is None:
            return False
        self._then = None
        self.seeker.cancel()
        return True


# A step of a search for a text is a page or two of it, and of one for a share what is read at once.
_REACHES = {
    FindText: Reach(most=16, least=4),
    FindKind: Reach(),
    FindShare: Reach(least=2),
    FindPage: Reach(),
    ListHeadings: Reach(),
}


def look(
    source: Source, query: Query, clock: Callable[[], float] = time.perf_counter
) -> Hit | Query | None:
    """Look for something for as long as a hand does not notice, by a clock in seconds.

    Returns
    -------
    int, tuple, Query or None
        Place of the source where it is, or the headings; None if it is nowhere; or the question,
        if that is not known yet.
    """
    if isinstance(query, CountLines | FindLine):
        return query
    reach, since_s = _REACHES[type(query)], clock()
    for seen, step in enumerate(steps(source, query, near=True), 1):
        if not isinstance(step, float):
            return step
        if reach.ends(seen, clock() - since_s):
            return query
    return None


def look_everywhere(source: Source, query: Query) -> Hit | None:
    """Look for something, however long that takes.

    Returns
    -------
    int, tuple or None
        Place of the source where it is, or the headings; None if it is nowhere.
    """
    if isinstance(query, CountLines | FindLine):
        return None
    found = (step for step in steps(source, query) if not isinstance(step, float))
    return next(found, None)
