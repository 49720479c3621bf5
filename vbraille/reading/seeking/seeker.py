"""The process that looks through a book, as a reader has it: asked, and never waited for."""

from __future__ import annotations

import os
import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import msgspec

from vbraille.reading.queries import Answer, CountLines, Failed, FindText, Indexed, Searched
from vbraille.reading.seeking.pipes import Incoming, Outgoing

if TYPE_CHECKING:
    from vbraille.reading.queries import Query
    from vbraille.reading.seeking.opening import BookOpening
    from vbraille.translate.source import Index

_END_S = 1.0


@dataclass(slots=True)
class _Process:
    """A process that runs, and the pipes to and from it."""

    popen: subprocess.Popen[bytes]
    incoming: Incoming
    outgoing: Outgoing


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
        self._process: _Process | None = None
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
        return None if self._process is None else self._process.incoming.descriptor

    def start(self) -> None:
        """Start the process, if it does not run, so that it can see where the book's blocks are."""
        if self._process is not None:
            return
        descriptor = self._opening.descriptor
        try:
            popen = subprocess.Popen(
                [sys.executable, "-m", "vbraille.reading.seeking", str(os.getpid())],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                pass_fds=() if descriptor is None else (descriptor,),
            )
        except OSError as error:
            self._fail(f"the book cannot be looked through: {error.strerror}")
            return
        assert popen.stdin is not None
        assert popen.stdout is not None
        incoming, outgoing = Incoming(popen.stdout.fileno()), Outgoing(popen.stdin.fileno())
        self._process = _Process(popen, incoming, outgoing)
        fields = msgspec.to_builtins(self._opening)
        self._tell({"open": {**fields, "file": os.fsencode(self._opening.file)}})

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
        self._tell({"ask": msgspec.to_builtins(query), "number": self._last})

    def poll(self) -> Answer | None:
        """Give the next answer that has come, or None.

        A question has `Searched` any number of times, at most two a second, and then one other
        answer. `Indexed` comes once, without a question.
        """
        if not self._answers and self._process is not None:
            self._hear(self._process)
        return self._answers.pop(0) if self._answers else None

    def cancel(self) -> None:
        """Give the question up: no answer to it comes any more. A count of lines goes on."""
        self._give_up(counts=False)

    def close(self) -> None:
        """End the process. Further calls do nothing."""
        process, self._process = self._process, None
        self._asked.clear()
        self._answers.clear()
        if process is not None:
            self._end(process)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _give_up(self, *, counts: bool) -> None:
        number = self._asked.pop(counts, None)
        self._answers = [answer for answer in self._answers if isinstance(answer, Indexed)]
        if number is not None and self._process is not None:
            self._tell({"cancel": number})

    def _hear(self, process: _Process) -> None:
        with suppress(BrokenPipeError):
            process.outgoing.flush()
        for message in process.incoming.messages():
            self._take(message["number"], msgspec.convert(message["answer"], Answer))
        if process.incoming.ended:
            self._process = None
            self._end(process)
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

    def _tell(self, message: object) -> None:
        if self._process is not None:
            with suppress(BrokenPipeError):  # its end is heard of when it is polled
                self._process.outgoing.put(message)

    @staticmethod
    def _end(process: _Process) -> None:
        popen = process.popen
        popen.kill()  # it has nothing to leave in order
        for pipe in (popen.stdin, popen.stdout):
            assert pipe is not None
            with suppress(OSError):
                pipe.close()
        with suppress(subprocess.TimeoutExpired):
            popen.wait(_END_S)
