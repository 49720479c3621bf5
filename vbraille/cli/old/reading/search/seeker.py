"""Search as a reader has it: near at once, and far by a process that is never waited for.

There is one way to look, near or far: a generator, which stops and goes on at each step, so that
a question or the end of the parent is heard within a step.
"""

from __future__ import annotations

import os
import time
from array import array
from bisect import bisect_right
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final, Self

import msgspec

from vbraille.cli.old.reading.search.questions import (
    Ask,
    BookOpening,
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
    ListedHeading,
    ListHeadings,
    NotFound,
    Order,
    Searched,
    Told,
)
from vbraille.cli.old.reading.search.structure import (
    Reach,
    extended,
    find_kind,
    find_page,
    find_share,
    first_place,
    list_headings,
)
from vbraille.errors import VbrailleError

LaidBlock = None
LaidRun = None
from vbraille.translate import Book, Undefined, choose_table, open_source
from vbraille.workers import Worker, begin

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import Any as Carried

    from vbraille.cli.old.reading.search.questions import Answer, Query
    from vbraille.translate import Source
    from vbraille.workers import Incoming, Outgoing

Place = FindText | FindKind | FindShare | FindPage | ListHeadings
Hit = int | tuple[ListedHeading, ...]


def steps(source: Source, query: Place, *, near: bool = False) -> Iterator[Hit | float]:
    """Look for a place in a source, or for its headings.

    Parameters
    ----------
    near
        Whether the steps are to be small, since the caller waits for them and will not take many.

    Yields
    ------
    int, float or tuple
        About how much of the work is done, 0 to 1, as floats; then the place of the source that
        was found, if any, or the headings.

    Raises
    ------
    InputError
        If the source cannot be read any more.
    """
    match query:
        case FindText():
            # A reading in which no text is looked for does not load it.
            from vbraille.cli.old.reading.search.text import find_text

            return find_text(source, query, near=near)
        case FindKind():
            return find_kind(source, query)
        case FindShare():
            return find_share(source, query.share)
        case FindPage():
            return find_page(source, query.label)
        case ListHeadings():
            return list_headings(source)


class LineCounts:
    """Numbers of lines before the blocks of a book, at a width; never counted twice.

    Parameters
    ----------
    book
        Book with the table that it is read by.
    width
        Number of cells in a line.
    """

    def __init__(self, book: Book, width: int) -> None:
        self._book = book
        self._width = width
        self._before = array("q", [0])
        self._carried: Carried | None = None

    def count(self, block: int) -> Iterator[Answer]:
        """Count up to a block, and tell after each block how far that is; then the number."""
        while len(self._before) <= block and self._lay_out_next():
            yield Searched((len(self._before) - 1) / max(block, 1))
        lines = self._before[min(block, len(self._before) - 1)]
        yield Counted(lines, self._book.source.index(), self._width, block)

    def find(self, line: int) -> Iterator[Answer]:
        """Count up to a line, and tell after each block how far that is; then where it begins."""
        while self._before[-1] < line and self._lay_out_next():
            yield Searched(min(self._before[-1] / line, 1.0))
        if not 1 <= line <= self._before[-1]:
            yield NotFound()
            return
        block = bisect_right(self._before, line - 1) - 1
        run = LaidRun(self._book, self._width, block, self._before[block])
        found = run.line(line)
        if found is None:  # a piece of a very long paragraph, entered in its middle
            found = run.line_of(block, 0)
        cells = found.cells
        place = int(cells.starts[0]) if len(cells) else first_place(found.block)
        yield Found(place, self._book.source.index())

    def _lay_out_next(self) -> bool:
        number = len(self._before) - 1
        found = self._book.block(number)
        if found is None:
            return False
        following = self._book.source.block(number + 1)
        goes_on = following is not None and following.continues
        carried = self._carried if found[0].continues else None
        laid = LaidBlock(*found, self._width, carried, goes_on=goes_on)
        self._carried = laid.carries
        self._before.append(self._before[-1] + len(laid.bounds))
        return True


class Answering:
    """Answers of one book; what was found out for one question helps with the next.

    Parameters
    ----------
    book
        Book that is asked about. Only to count lines it needs its table.
    """

    def __init__(self, book: Book) -> None:
        self.book = book
        self._counts: dict[int, LineCounts] = {}

    def answer(self, query: Query) -> Iterator[Answer]:
        """Answer a question: `Searched` any number of times, then something else, once.

        The work goes on only while the caller takes the answers.

        Raises
        ------
        VbrailleError
            If the book cannot be read any more.
        """
        match query:
            case CountLines():
                return self._lines(query.width).count(query.block)
            case FindLine():
                return self._find_line(query)
        return _find(self.book.source, query)

    def _lines(self, width: int) -> LineCounts:
        if width not in self._counts:
            self._counts[width] = LineCounts(self.book, width)
        return self._counts[width]

    def _find_line(self, query: FindLine) -> Iterator[Answer]:
        table = "" if self.book.table is None else self.book.table.name
        if query.table == table:
            yield from self._lines(query.width).find(query.line)
        else:
            by = table or "the file's own cells"
            yield Failed(f"lines are counted by {by} only; type percent as in 40%")

    def index(self) -> Iterator[Answer]:
        """Find out where all blocks are: `Searched` any number of times, then `Indexed`."""
        yield from map(Searched, extended(self.book.source))
        yield Indexed(self.book.source.index())


def _find(source: Source, query: Place) -> Iterator[Answer]:
    for step in steps(source, query):
        if isinstance(step, float):
            yield Searched(step)
        else:
            index = source.index()
            yield Found(step, index) if isinstance(step, int) else Listed(step, index)
            return
    yield NotFound()


_PROGRESS_S: Final = 2.0
_MODULE: Final = "vbraille.cli.old.reading.search.seeker"


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
                return  # no reader waits for the progress of a count
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


def find_place(source: Source, query: FindText | FindShare) -> int | None:
    """Look for a place, however long that takes; None if it is nowhere."""
    found = look_everywhere(source, query)
    return found if isinstance(found, int) else None


PROGRESS_S = 0.5
_NICE = 10  # the loop of the display and the reader's keys come first
_LOOK_S = 0.02  # between two looks for questions; a step of work takes about as long


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
                    return  # no reader asked; a reader of that part is told
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
