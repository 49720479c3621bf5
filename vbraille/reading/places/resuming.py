"""A book opened where it was left, as it was open then."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.reading.places.anchoring import anchored
from vbraille.wording import count

if TYPE_CHECKING:
    from vbraille.reading.places.book import KeptBook
    from vbraille.reading.places.shelf import KeptPlaces
    from vbraille.reading.places.values import BookOptions, KeptPlace, ListedBook
    from vbraille.translate.source import Source


@dataclass(frozen=True, slots=True)
class ResumedBook:
    """A book that is open, and what is kept of it.

    Parameters
    ----------
    source
        The book.
    kept
        What is kept of it.
    options
        Options with which it was opened.
    place
        Place at which reading goes on; None for the beginning.
    note
        Sentence for the reader, such as that the text has changed; None if there is none.
    """

    source: Source
    kept: KeptBook
    options: BookOptions
    place: KeptPlace | None
    note: str | None


def last_book(places: KeptPlaces) -> KeptBook:
    """The book that was read last.

    Raises
    ------
    InputError
        If no book was read, or its file is not where it was.
    """
    path = places.last_path()
    if path is None:
        raise InputError("no book is kept from an earlier reading; give the name of a file")
    if not path.exists():
        raise InputError(
            f"the last book, {path}, is not there any more; give its file, or choose another: "
            f"vbraille books lists them"
        )
    return places.book(path)


def numbered_book(places: KeptPlaces, number: int) -> ListedBook:
    """The book with a number in the list of all books.

    Raises
    ------
    InputError
        If there is none.
    """
    books = places.listed()
    if not 1 <= number <= len(books):
        there = f"there {'is' if len(books) == 1 else 'are'} {count(len(books), 'book')}"
        raise InputError(f"there is no book {number}; {there}, and vbraille books lists them")
    return books[number - 1]


def book_to_open(places: KeptPlaces, number: int) -> KeptBook:
    """The book with a number in the list of all books, to read on in it.

    Raises
    ------
    InputError
        If there is none, it has no file, or the file is not where it was.
    """
    book = numbered_book(places, number)
    if not book.path:
        raise InputError(f"book {number} was read from standard input; give it there again")
    if book.missing:
        raise InputError(
            f"book {number}, {book.path}, is not there any more; give its file, or choose another: "
            f"vbraille books lists them"
        )
    return places.book(book.path)


def resume(source: Source, kept: KeptBook, options: BookOptions) -> ResumedBook:
    """Give an open book what is kept of it: where its blocks are, and the place."""
    same_text = (kept.options.encoding, kept.options.keep_lines, kept.options.form) == (
        options.encoding,
        options.keep_lines,
        options.form,
    )
    note = None
    index = kept.index
    if index is not None:
        source.adopt(index)
    if kept.changed:
        note = kept.settle(source)
    place = kept.place
    if place is not None and not same_text:
        place, _ = anchored(source, place)  # the same bytes, but other characters
    kept.keep_options(options)
    kept.keep_title(source.title)
    return ResumedBook(source, kept, options, place, note)
