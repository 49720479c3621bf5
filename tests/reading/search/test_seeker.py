"""The process beside a reader: asked, given up, killed, and gone with its parent."""

import os
import select
import signal
import subprocess
import sys
import time
from itertools import pairwise

import pytest

from vbraille.layout.pages import Layout
from vbraille.reading.search.questions import (
    BookOpening,
    Counted,
    CountLines,
    Failed,
    FindShare,
    FindText,
    Found,
    Indexed,
    Listed,
    ListHeadings,
    NotFound,
    Searched,
)
from vbraille.reading.search.seeker import Seeker
from vbraille.translate import Book, BrailleTable, Document
from vbraille.translate.formats import open_source

PATIENCE_S = 60.0
LONG = "nothing to see here\n\n" * 30_000


def answers(seeker, *, until):
    """Answers up to the first of a kind."""
    given = []
    end = time.monotonic() + PATIENCE_S
    while not given or not isinstance(given[-1], until):
        assert time.monotonic() < end, given
        if (answer := seeker.poll()) is not None:
            given.append(answer)
        elif seeker.descriptor is not None:
            select.select([seeker.descriptor], [], [], 1.0)
    return given


def final(seeker, query):
    seeker.ask(query)
    *_, last = answers(seeker, until=Found | Listed | NotFound | Counted | Failed)
    return last


@pytest.fixture
def book(tmp_path):
    path = tmp_path / "book.txt"
    path.write_text("First words.\n\n" + "Some more words in between.\n\n" * 50 + "Last words.")
    return path


def test_questions_are_answered(book):
    with Seeker(BookOpening(os.fsencode(book), language="en")) as seeker:
        assert seeker.poll() is None
        found = final(seeker, FindText("LAST  words", 0))
        assert found.character == book.read_text().index("Last")
        assert isinstance(final(seeker, FindText("first", 5)), NotFound)
        assert isinstance(final(seeker, FindShare(0.5)), Found)
        layout = Layout(Book(Document.open(book), BrailleTable("en-ueb-g2.ctb")), 12)
        line, _ = layout.place(found.character)
        seeker.ask(CountLines(12, 51))
        *_, counted = answers(seeker, until=Counted)
        assert (counted.lines, counted.width, counted.block) == (line.number - 1, 12, 51)


def test_the_index_of_the_whole_book_comes_of_itself(book):
    with Seeker(BookOpening(os.fsencode(book))) as seeker:
        seeker.start()
        *_, indexed = answers(seeker, until=Indexed)
        document = Document.open(book)
        document.adopt(indexed.index)
        assert document.complete
    with Seeker(BookOpening(os.fsencode(book), index=indexed.index)) as seeker:
        assert isinstance(final(seeker, FindText("last", 0)), Found)


def test_a_text_that_has_no_name(book):
    with book.open("rb") as stream:
        document = Document.take(stream, "standard input")
    assert str(document.block(0).text) == "First words."
    opening = BookOpening(descriptor=document.descriptor, name="standard input")
    with Seeker(opening) as seeker:
        assert isinstance(final(seeker, FindText("last", 0)), Found)
    assert str(document.block(51).text) == "Last words."
    assert Document.from_text("in memory").descriptor is None


def test_the_headings_of_a_book(tmp_path):
    path = tmp_path / "book.md"
    path.write_text("# One\n\nText.\n\n## Two *and*\n\nMore.\n")
    source = open_source(str(path))
    with Seeker(BookOpening(os.fsencode(path), form="markdown")) as seeker:
        listed = final(seeker, ListHeadings())
    assert [(one.level, one.title) for one in listed.headings] == [(1, "One"), (2, "Two and")]
    assert [source.block_at(one.character) for one in listed.headings] == [0, 2]


def test_lines_of_a_braille_file(tmp_path):
    path = tmp_path / "book.brf"
    path.write_text(",! FIR/ L9E\n,! SECOND\n,! ?IRD\n")
    with Seeker(BookOpening(os.fsencode(path), form="brf")) as seeker:
        seeker.ask(CountLines(6, 2))
        *_, counted = answers(seeker, until=Counted | Failed)
    line, _ = Layout(Book(open_source(str(path))), 6).place(path.read_text().index(",! ?"))
    assert counted.lines == line.number - 1 > 2


def test_a_name_that_is_no_text(book):
    path = book.rename(book.with_name(os.fsdecode(b"b\xffk.txt")))
    with Seeker(BookOpening(os.fsencode(path))) as seeker:
        assert isinstance(final(seeker, FindText("last \udcff", 0)), NotFound)


def test_what_cannot_be_opened_is_one_sentence(tmp_path):
    with Seeker(BookOpening(os.fsencode(tmp_path / "none.txt"))) as seeker:
        failed = final(seeker, FindText("last", 0))
        assert failed.sentence == f"there is no file {tmp_path / 'none.txt'}; check the name"


def test_a_question_that_is_given_up_has_no_answer(tmp_path):
    path = tmp_path / "long.txt"
    path.write_text(LONG)
    with Seeker(BookOpening(os.fsencode(path))) as seeker:
        seeker.ask(FindShare(1.0))
        seeker.cancel()
        seeker.ask(FindShare(0.9))
        seeker.ask(FindText("not there", 0))  # this gives the other one up, too
        given = answers(seeker, until=NotFound)
        assert not any(isinstance(answer, Found) for answer in given)


def test_a_process_that_is_killed_is_told_of_and_begun_again(book):
    with Seeker(BookOpening(os.fsencode(book))) as seeker:
        assert isinstance(final(seeker, FindText("last", 0)), Found)
        process = seeker._worker.process
        os.kill(process.pid, signal.SIGSTOP)
        seeker.ask(FindText("last", 0))
        os.kill(process.pid, signal.SIGKILL)
        *_, failed = answers(seeker, until=Failed)
        assert "has ended" in failed.sentence
        assert isinstance(final(seeker, FindText("last", 0)), Found)
        seeker.close()
        assert process.returncode == -signal.SIGKILL


_PARENT = """
import sys
from vbraille.reading.search.questions import BookOpening
from vbraille.reading.search.seeker import Seeker
seeker = Seeker(BookOpening(sys.argv[1].encode()))
seeker.start()
print(seeker._worker.process.pid, flush=True)
sys.stdin.read()
"""


def test_it_is_gone_with_its_parent(book):
    parent = subprocess.Popen(
        [sys.executable, "-c", _PARENT, str(book)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    child = os.pidfd_open(int(parent.stdout.readline()))
    parent.kill()
    parent.communicate()
    assert select.select([child], [], [], PATIENCE_S)[0]
    os.close(child)


def test_progress_is_told_at_most_twice_a_second():
    from vbraille.reading.search.seeker import PROGRESS_S, BookSearch

    told, clock = [], iter(range(10**9))
    seconds = 0.0

    class Pipe:
        ended = False

        def take(self):
            return []

        def flush(self):
            return True

        def put(self, message):
            told.append((seconds, message.answer))

    def now():
        nonlocal seconds
        seconds = next(clock) / 50
        return seconds

    worker = BookSearch(Pipe(), Pipe(), now)
    worker._works[0] = (1, (Searched(n / 999) for n in range(1000)))
    for _ in range(999):
        worker._step()
    times = [at for at, _ in told]
    assert len(times) > 5
    assert all(b - a >= PROGRESS_S for a, b in pairwise(times))
