"""Commands that choose the braille, which lines are passed over, and scrolling by time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.reading.cues import Cue
from vbraille.translate import Book, BrailleTable, find_table
from vbraille.wording import spelled

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader
    from vbraille.reading.scrolling import Scroll

_CONTRACTED = 2  # the grade that is asked for


def contracted(reader: Reader) -> None:
    """Change between contracted and uncontracted braille of the same language."""
    table = reader.layout.book.table
    if table is None:
        reader.say("table: the text is in braille already")
        return
    info = table.info
    if info is None or not info.language:
        reader.say(f"table: {table.name} does not say its language; choose one by language")
        return
    book, before = reader.layout.book, reader.book_before
    if before is not None and before[0] is book:
        # As it was, with whatever grade passages in other languages had.
        _show(reader, before[1])
        return
    grade = 1 if info.grade.isdecimal() and int(info.grade) >= _CONTRACTED else _CONTRACTED
    _change(reader, info.language, grade)


def ask_language(reader: Reader) -> None:
    """Ask for a language and translate with its usual table."""
    if reader.layout.book.table is None:
        reader.say("table: the text is in braille already")
    else:
        reader.ask("language", "type its tag such as fr, Enter", "language", _change)


def skip_blank(reader: Reader) -> None:
    """Pass over lines without a dot, or no longer."""
    reader.skip_blank = not reader.skip_blank
    reader.say(f"blank lines: {'skipped' if reader.skip_blank else 'read'}")


def scroll(reader: Reader) -> None:
    """Have the next line come by time, or no longer."""
    scrolling = _scroll(reader)
    if scrolling is not None:
        scrolling.on = not scrolling.on
        reader.say(scrolling.sentence if scrolling.on else "autoscroll: off")


def faster(reader: Reader) -> None:
    """Have lines come sooner."""
    scrolling = _scroll(reader)
    if scrolling is not None:
        _say_speed(reader, scrolling.faster())


def slower(reader: Reader) -> None:
    """Have lines come later."""
    scrolling = _scroll(reader)
    if scrolling is not None:
        _say_speed(reader, scrolling.slower())


def _scroll(reader: Reader) -> Scroll | None:
    if reader.scroll is None:
        reader.say("autoscroll: there is none here")
    return reader.scroll


def _say_speed(reader: Reader, words: str) -> None:
    if "," in words:  # as fast or as slow as it can be
        reader.cue(Cue.LIMIT)
    reader.say(f"autoscroll: {words}")


def _change(reader: Reader, language: str, grade: int | None = None) -> None:
    """Translate with another table from now on; the same text stays under the finger."""
    book = reader.layout.book
    assert book.table is not None, "a text in braille is not translated"
    try:
        name = find_table(language, grade)
        if name == book.table.name:
            reader.say(f"table: {book.table.said}, as before")
            return
        if name == find_table(language):
            grade = None  # the usual one, with which passages have what is usual in theirs
        other = BrailleTable(name, book.table.how)
        _show(reader, Book(book.source, other, language=language, grade=grade, switch=book.switch))
    except InputError as error:
        reader.say(f"table: {spelled(str(error))}")


def _show(reader: Reader, book: Book) -> None:
    """Show a book by another table, and say by which.

    Raises
    ------
    InputError
        If it cannot be laid out.
    """
    before = reader.layout.book
    reader.lay_out_again(book=book)
    reader.book_before = (book, before)
    if book.table is not None:
        reader.say(f"table: {book.table.said}")
