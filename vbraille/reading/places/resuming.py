"""A book opened where it was left, as it was open then."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.reading.places.anchoring import anchored
from vbraille.translate.documents.document import Document

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.places.book import KeptBook
    from vbraille.reading.places.shelf import KeptPlaces
    from vbraille.reading.places.values import BookOptions, KeptPlace
    from vbraille.translate.source import Source

    Opener = Callable[[str, BookOptions], Source]


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


def open_document(file: str, options: BookOptions) -> Source:
    """Open a plain text with the options that are for it."""
    return Document.open(file, options.encoding, keep_lines=options.keep_lines)


def open_kept(
    places: KeptPlaces,
    file: str | None,
    options: BookOptions | None = None,
    *,
    opener: Opener = open_document,
) -> ResumedBook:
    """Open a book where it was left.

    Parameters
    ----------
    places
        What is kept.
    file
        Name of the file; None for the book that was read last.
    options
        Options to open it with; None for those of its last reading.
    opener
        Function that opens a file with options.

    Raises
    ------
    InputError
        If there is no last book, or the file cannot be read.
    """
    kept = last_book(places) if file is None else None
    if file is None:
        assert kept is not None
        assert kept.path is not None, "a book without a file is never the last one"
        file = str(kept.path)
    if options is None and kept is None:
        kept = places.book(file)
    chosen = options if options is not None or kept is None else kept.options
    assert chosen is not None
    # Where options are given, a file that cannot be read is no book: nothing is kept of it.
    source = opener(file, chosen)
    kept = places.book(file) if kept is None else kept
    return resume(source, kept, chosen)


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
