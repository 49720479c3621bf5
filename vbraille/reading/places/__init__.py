"""Places in books, kept from one reading to the next."""

from vbraille.reading.places.book import KeptBook
from vbraille.reading.places.resuming import ResumedBook, book_to_open, last_book, resume
from vbraille.reading.places.shelf import KeptPlaces
from vbraille.reading.places.values import Bookmark, BookOptions, KeptPlace, ListedBook

__all__ = [
    "BookOptions",
    "Bookmark",
    "KeptBook",
    "KeptPlace",
    "KeptPlaces",
    "ListedBook",
    "ResumedBook",
    "book_to_open",
    "last_book",
    "resume",
]
