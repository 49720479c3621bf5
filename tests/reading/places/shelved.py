"""A book whose place is kept, and a clock that goes on by a second at each look."""

from itertools import count

from vbraille.reading.keptplace import KeptPlace
from vbraille.reading.library import KeptPlaces

TEXT = "\n\n".join(f"Paragraph number {n} says {n * n} and no more." for n in range(200))


def opened(folder):
    seconds = count(1_000_000)
    return KeptPlaces.open(folder / "kept" / "places.sqlite", now=lambda: float(next(seconds)))


def keep(folder, name="book.txt", place=None, **more):
    with opened(folder) as places:
        kept = places.book(folder / name)
        kept.keep(place or KeptPlace(1000, 20, 0.1))
        for method, value in more.items():
            getattr(kept, method)(value)
        assert places.note() is None
        return kept.digest


def kept_place(folder, name="book.txt"):
    with opened(folder) as places:
        kept = places.book(folder / name)
        assert places.note() is None
        return None if kept.place is None else kept.place.character
