"""``vbraille books``."""

from __future__ import annotations

import json
import time
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from vbraille.cli.old.terminal import say_line
from vbraille.errors import InputError, VbrailleError
from vbraille.reading.library import KeptPlaces, numbered_book

if TYPE_CHECKING:
    import argparse

    from vbraille.reading.library import ListedBook

_A_WEEK = 7  # days; what is older is told by its date


def run(arguments: argparse.Namespace) -> int:
    """List the books that were read, the last one first, or forget one of them."""
    with KeptPlaces.open() as places:
        if (note := places.note()) is not None:
            say_line(note, aside=True)
        if arguments.forget:
            if arguments.number is None:
                raise InputError("--forget is of one book; give its number in the list")
            _forget(places, arguments.number)
            return 0
        books = places.listed()
        if arguments.json:
            print(json.dumps([_fields(n, book) for n, book in enumerate(books, 1)], indent=1))
        else:
            today = datetime.fromtimestamp(time.time()).astimezone()
            for number, book in enumerate(books, 1):
                say_line(f"{number}: {describe(book, today)}")
            if not books:
                say_line("books: none")
    return 0


def describe(book: ListedBook, now: datetime) -> str:
    """Describe a book of the list, as seen from a time in the reader's zone."""
    parts = [book.title]
    if book.place is not None:
        about = "about " if book.place.about else ""
        parts.append(f"{about}{100 * book.place.share:.0f} %")
        if book.place.page:
            parts.append(f"page {book.place.page}")
    parts.append(_when(datetime.fromtimestamp(book.read_s, now.tzinfo), now))
    parts.append(book.path)
    if book.missing:
        parts.append("missing")
    return ", ".join(parts)


def _when(read: datetime, now: datetime) -> str:
    days = (now.date() - read.date()).days
    if days == 0:
        return f"today {read:%H:%M}"
    if days == 1:
        return "yesterday"
    return f"{days} days ago" if 1 < days < _A_WEEK else f"{read:%Y-%m-%d}"


def _fields(number: int, book: ListedBook) -> dict[str, object]:
    place = book.place
    return {
        "number": number,
        "title": book.title,
        "path": book.path,
        "missing": book.missing,
        "read": datetime.fromtimestamp(book.read_s, UTC).isoformat(timespec="seconds"),
        "share": None if place is None else round(place.share, 4),
        "character": None if place is None else place.character,
        "page": None if place is None else place.page,
    }


def _forget(places: KeptPlaces, number: int) -> None:
    book = numbered_book(places, number)
    if not places.forget(book.digest):
        why = places.fault or "another program is writing"
        raise VbrailleError(f"{book.title} could not be forgotten: {why}; try again")
    say_line(f"forgotten: {book.title}")
