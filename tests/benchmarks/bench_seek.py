"""Looking through a long book, and keeping places: what a reader waits for."""

from __future__ import annotations

import select
import statistics
import tempfile
import time
from pathlib import Path
from time import perf_counter, process_time
from typing import TYPE_CHECKING

import msgspec

from tests.benchmarks.big_texts import big_text
from tests.benchmarks.timing import Result
from vbraille.reading.keptplace import KeptPlace
from vbraille.reading.library import KeptPlaces
from vbraille.reading.search.questions import BookOpening, FindShare, FindText, NotFound, Searched
from vbraille.reading.search.seeker import Answering, Seeker
from vbraille.translate import Book, Document

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.reading.search.questions import Query

_SIZE = 50_000_000
_COMMITS = 5_000
_CANCELS = 20
# Words that end the text: nothing else in it has all of them.
_LAST = "Zebras rarely vexed her."


def run() -> Iterator[Result]:
    with tempfile.TemporaryDirectory() as folder:
        path = big_text(Path(folder) / "50mb", _SIZE)
        with path.open("a") as file:
            file.write(f"{_LAST}\n")
        fresh = Document.open(path)
        before = process_time()
        fresh.block(1 << 60)
        took = process_time() - before
        kept = len(msgspec.msgpack.encode(fresh.index()))
        yield Result(
            "where the blocks of 50 MB are, found out once and kept", "measured",
            f"{_SIZE / 1e6 / took:.0f} MB/s, {kept // 1000} kB", True,
        )  # fmt: skip
        for accents, bar in ((False, 50), (True, 50)):
            rates = sorted(_rate(fresh, accents=accents) for _ in range(3))
            how = ", accents folded" if accents else ""
            yield Result(
                f"search through 50 MB of text to its first hit, at the end{how}",
                f"≥ {bar} MB/s", f"{rates[1]:.0f} MB/s", rates[1] >= bar,
            )  # fmt: skip
        yield _cancels(path)
        yield _commits(Path(folder), path)


def _rate(document: Document, *, accents: bool) -> float:
    """MB of text a second up to the first hit, which is at the end of the text."""
    before = process_time()
    *_, found = Answering(Book(document)).answer(FindText(_LAST.upper(), 0, fold_accents=accents))
    took = process_time() - before
    assert getattr(found, "character", 0) > 0
    return _SIZE / 1e6 / took


def _cancels(path: Path) -> Result:
    """How long a process that works on one question takes to begin with the next."""
    taken = []
    with Seeker(BookOpening(str(path).encode())) as seeker:
        _last(seeker, FindText("not there at all", 0))
        for _ in range(_CANCELS):
            seeker.ask(FindShare(1.0))
            time.sleep(0.02)
            before = perf_counter()
            seeker.cancel()
            _last(seeker, FindText("", 0))  # nothing to look for, and so answered at once
            taken.append(perf_counter() - before)
    worst = max(taken)
    return Result(
        "a question that is given up: the worst time until the next one is begun and answered",
        "≤ 100 ms", f"{1000 * worst:.0f} ms", worst <= 0.1,
    )  # fmt: skip


def _last(seeker: Seeker, query: Query) -> None:
    seeker.ask(query)
    while not isinstance(found := seeker.poll(), NotFound):
        assert found is None or isinstance(found, Searched), found
        assert seeker.descriptor is not None
        select.select([seeker.descriptor], [], [], 1.0)


def _commits(folder: Path, book: Path) -> Result:
    """How long the loop of reading is held up when a place is kept."""
    seconds = iter(range(10**9))
    taken = []
    with KeptPlaces.open(folder / "places.sqlite", now=lambda: float(next(seconds))) as places:
        kept = places.book(book)
        for n in range(_COMMITS):
            place = KeptPlace(n, before="text " * 40, after="text " * 40)
            before = perf_counter()
            kept.keep(place)
            taken.append(1000 * (perf_counter() - before))
    p50, p99 = (statistics.quantiles(taken, n=100)[n - 1] for n in (50, 99))
    return Result(
        f"a place kept, of {_COMMITS:,}: median, and p99",
        "≤ 1 ms", f"{p50:.2f} ms, {p99:.2f} ms", p99 <= 1,
    )  # fmt: skip
