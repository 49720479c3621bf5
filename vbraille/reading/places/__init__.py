"""Places in books, kept from one reading to the next."""

from vbraille.reading.places.book import KeptBook
from vbraille.reading.places.place import Bookmark, BookOptions, KeptPlace, ListedBook, book_options
from vbraille.reading.places.shelf import KeptPlaces, book_to_open, last_book, resume

__all__ = [
    "BookOptions",
    "Bookmark",
    "KeptBook",
    "KeptPlace",
    "KeptPlaces",
    "ListedBook",
    "book_options",
    "book_to_open",
    "last_book",
    "resume",
]
