"""Something that is looked for in the whole book, while reading goes on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.reading.nearby import look, look_everywhere
from vbraille.reading.queries import Counted, Failed, Found, Listed, NotFound, Searched

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.beside import SeekerLike
    from vbraille.reading.queries import Query
    from vbraille.translate.source import Source

_PROGRESS_S = 2.0


class Looking:
    """One question at a time: near first, then the whole book.

    Parameters
    ----------
    say
        Function that is called with each thing to be said.
    verbose
        Whether to say how far the search has come.
    counted
        Function that is called when lines have been counted.
    """

    def __init__(
        self,
        say: Callable[[str], None],
        *,
        verbose: bool = False,
        counted: Callable[[Counted], None] = lambda _: None,
    ) -> None:
        self._counted = counted
        self._verbose = verbose
        self._say = say
        self._then: Callable[[Any], None] | None = None
        self._said_s: float | None = None

    @property
    def busy(self) -> bool:
        """Whether something is looked for."""
        return self._then is not None

    def find(
        self,
        source: Source,
        query: Query,
        then: Callable[[Any], None],
        seeker: SeekerLike | None = None,
    ) -> None:
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
        seeker
            The process that looks through the whole book; None to do so here.
        """
        self.cancel(seeker)
        found = look(source, query)
        if found is not query:
            then(found)
        elif seeker is None:
            then(look_everywhere(source, query))
        else:
            self._then, self._said_s = then, None
            self._say("searching")
            seeker.ask(query)

    def poll(self, seeker: SeekerLike, source: Source, now_s: float) -> None:
        """Take what the other process has found; called again and again, with the time."""
        if self._said_s is None:
            self._said_s = now_s
        while (answer := seeker.poll()) is not None:
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

    def cancel(self, seeker: SeekerLike | None) -> bool:
        """Give up what is looked for; False if nothing is."""
        if self._then is None or seeker is None:
            return False
        self._then = None
        seeker.cancel()
        return True
