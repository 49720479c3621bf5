"""A book that several processes translate, for who reads all of it in order."""

from __future__ import annotations

import sys
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from select import select
from subprocess import PIPE, Popen
from typing import TYPE_CHECKING, Self

from vbraille.errors import VbrailleError
from vbraille.translate.batches import Batch, Translated
from vbraille.translate.book import Book
from vbraille.translate.passing import receive, send

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.braille.cells import Cells
    from vbraille.translate.source import Block

BATCH_CHARACTERS = 16_384  # so that the cells of one find room in a pipe
_AHEAD = 4  # batches that are under way for each process, this one too
_GIVEN = 2  # batches that another process has been given at a time
_BEHIND = 16  # blocks that are kept after they were read


@dataclass(slots=True)
class _Under:
    """A batch under way: who translates it, if it has been given to anybody, and what came back."""

    blocks: list[Block]
    process: Popen[bytes] | None = None
    cells: list[Cells] | None = None


class BookAhead(Book):
    """A book that several processes translate ahead of who reads it, block after block.

    It has the same blocks and cells as the book that it is made of. This process is one of those
    that translate: it does so whenever it would have to wait for the others. They begin when a
    block is read, and only if the book is long; a context manager ends them. What is read in
    another order is translated here.

    Parameters
    ----------
    book
        Book to translate. From now on its source is read by this one only.
    processes
        Number of processes that translate, this one among them; with fewer than two, it does
        everything.
    batch
        Number of characters that a process is given at a time, about.
    """

    def __init__(self, book: Book, processes: int, batch: int = BATCH_CHARACTERS) -> None:
        super().__init__(book.source, book.table, unnamed=book.unnamed)
        self.translator = book.translator
        self._wanted = processes if book.translator is not None else 1
        self._size = batch
        self._processes: list[Popen[bytes]] = []
        self._read = 0  # number of the next block to be read from the source
        self._ended = False
        # What is under way, in order; and blocks that are being translated and those read last.
        self._batches: deque[_Under] = deque()
        self._waiting: dict[int, Block] = {}
        self._ready: dict[int, tuple[Block, Cells]] = {}
        self._next = 0  # number of the first block of the first batch
        self._due: dict[str, None] = {}  # notes, each once
        self._told = 0

    @property
    def processes(self) -> tuple[Popen[bytes], ...]:
        """The other processes that translate now."""
        return tuple(self._processes)

    def block(self, number: int) -> tuple[Block, Cells] | None:
        """Block of a number, from 0, with its cells; None past the end.

        Raises
        ------
        VbrailleError
            If a process ended by itself.
        """
        found = self._ready.get(number)
        if found is not None:
            return found
        if self._wanted < 2 or number != self._next:
            return super().block(number)
        self._go_on()
        if not self._batches:
            return super().block(number)
        self._take()
        return self._ready[number]

    def continues(self, number: int) -> bool:
        """Whether a block goes on where the one before broke off; False past the end."""
        found = self._ready.get(number)
        block = self._waiting.get(number) if found is None else found[0]
        return super().continues(number) if block is None else block.continues

    def notes(self) -> Iterator[str]:
        """Notes on the source and the tables that are due now; each is given once."""
        for note in super().notes():
            self._due.setdefault(note)
        for note in list(self._due)[self._told :]:
            self._told += 1
            yield note

    def close(self) -> None:
        """End the processes."""
        for process in self._processes:
            process.kill()
            with suppress(BrokenPipeError):
                process.communicate()  # closes its streams
        self._processes.clear()
        self._batches.clear()
        self._waiting.clear()
        self._wanted = 1

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _go_on(self) -> None:
        """Have processes translate as far ahead as they may."""
        while not self._ended and len(self._batches) < _AHEAD * self._wanted:
            blocks = self._gather()
            if blocks:
                self._batches.append(_Under(blocks))
        if not self._processes:
            if self._ended:  # the book is short
                self.close()
                return
            self._start()
        # What is wanted next is translated here, unless another process has it already.
        left = [under for under in list(self._batches)[1:] if under.process is under.cells is None]
        for process in self._processes:
            for under in left[: max(_GIVEN - len(self._given(process)), 0)]:
                left.remove(under)
                under.process = process
                self._send(process, Batch.of(under.blocks))

    def _gather(self) -> list[Block]:
        """Read blocks of about the text of a batch."""
        blocks: list[Block] = []
        characters = 0
        while characters < self._size:
            block = self.source.block(self._read)
            if block is None:
                self._ended = True
                break
            blocks.append(block)
            self._waiting[self._read] = block
            self._read += 1
            characters += len(block.text) + 1
        return blocks

    def _take(self) -> None:
        """Take the next batch, when it is translated; until then, translate others."""
        under = self._batches[0]
        while under.cells is None:
            self._hear(0)
            free = (other for other in self._batches if other.process is other.cells is None)
            mine = None if under.cells is not None else next(free, None)
            if mine is not None:
                mine.cells = self._cells_of(mine.blocks)
            elif under.cells is None:
                self._hear(None)
            self._go_on()
        self._batches.popleft()
        for number in list(self._ready)[:-_BEHIND]:
            del self._ready[number]
        for block, cells in zip(under.blocks, under.cells, strict=True):
            del self._waiting[self._next]
            self._ready[self._next] = block, cells
            self._next += 1

    def _given(self, process: Popen[bytes]) -> list[_Under]:
        """Batches that a process has been given and has not answered, in order."""
        return [u for u in self._batches if u.process is process and u.cells is None]

    def _hear(self, seconds: float | None) -> None:
        """Take what other processes have translated; wait so long for the first to answer."""
        streams = {p.stdout: p for p in self._processes if p.stdout and self._given(p)}
        for stream in select(list(streams), (), (), seconds)[0]:
            process = streams[stream]
            done = self._answer(process)
            assert self.table is not None
            self.table.undefined |= done.undefined
            for note in done.notes:
                self._due.setdefault(note)
            under = self._given(process)[0]
            pairs = zip(under.blocks, done.cells(under.blocks), strict=True)
            under.cells = [c if block.cells is None else block.cells for block, c in pairs]

    def _start(self) -> None:
        """Start the other processes."""
        assert self.translator is not None
        for _ in range(self._wanted - 1):
            command = [sys.executable, "-m", "vbraille.translate.translating"]
            process = Popen(command, stdin=PIPE, stdout=PIPE)
            self._processes.append(process)
            self._send(process, self.translator.how)

    def _send(self, process: Popen[bytes], what: object) -> None:
        assert process.stdin is not None
        try:
            send(process.stdin, what)
        except BrokenPipeError:
            raise self._ended_by_itself() from None

    def _answer(self, process: Popen[bytes]) -> Translated:
        assert process.stdout is not None
        try:
            done = receive(process.stdout)
        except EOFError:
            raise self._ended_by_itself() from None
        if isinstance(done, VbrailleError):
            raise done
        assert isinstance(done, Translated)
        return done

    def _ended_by_itself(self) -> VbrailleError:
        name = self.source.name
        return VbrailleError(f"a process that translates {name} ended by itself; try again")
