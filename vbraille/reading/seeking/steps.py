"""What is looked for in a book, found a step at a time: the one way to do so, near or far."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.queries import (
    FindKind,
    FindPage,
    FindShare,
    FindText,
    ListedHeading,
    ListHeadings,
)
from vbraille.reading.seeking.extent import find_share
from vbraille.reading.seeking.finding import find_text
from vbraille.reading.seeking.kinds import find_kind, find_page, list_headings

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.source import Source

Place = FindText | FindKind | FindShare | FindPage | ListHeadings
Found = int | tuple[ListedHeading, ...]


def steps(source: Source, query: Place, *, near: bool = False) -> Iterator[Found | float]:
    """Look for a place in a source, or for its headings.

    Parameters
    ----------
    near
        Whether the steps are to be small, since somebody waits for them and will not take many.

    Yields
    ------
    int, float or tuple
        About how much of the work is done, 0 to 1, as floats; then the place of the source that
        was found, if any, or the headings.

    Raises
    ------
    InputError
        If the source cannot be read any more.
    """
    match query:
        case FindText():
            return find_text(source, query, near=near)
        case FindKind():
            return find_kind(source, query)
        case FindShare():
            return find_share(source, query.share)
        case FindPage():
            return find_page(source, query.label)
        case ListHeadings():
            return list_headings(source)
