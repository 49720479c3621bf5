"""Places and bookmarks that are found again, by the text around them, where a book has changed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from vbraille.cli.old.reading.search.questions import FindShare, FindText
from vbraille.cli.old.reading.search.seeker import find_place

share_before = None

if TYPE_CHECKING:
    from vbraille.translate import Source


def storable(text: str) -> str:
    """Text without what cannot be written as UTF-8: halves of characters, bytes of no text."""
    return text.encode("utf-8", "replace").decode()


class KeptPlace(msgspec.Struct, frozen=True):
    """A place in a book, told in so many ways that one of them holds later.

    Parameters
    ----------
    character
        Place of the source, counted in characters from 0.
    block
        Number of the block that the character is in.
    share
        How much of the book stands before it, 0 to 1.
    before, after
        Text before the place and from it on, as it is read; a changed book is searched for it.
    reach
        Number of the source's characters that the text before the place is from.
    line
        Number of the line, from 1, in lines of `width` cells by `table`; None if not counted.
    lines_before
        Number of such lines before the block; None if not counted. A `Layout` can begin there.
    width, table
        Width in cells and name of the table for which these numbers hold.
    page
        Number of the page as the book writes or counts it; empty if it has none.
    about
        Whether the share is about right, since the book was not read to its end.
    """

    character: int
    block: int = 0
    share: float = 0.0
    before: str = ""
    after: str = ""
    reach: int = 0
    line: int | None = None
    lines_before: int | None = None
    width: int = 0
    table: str = ""
    page: str = ""
    about: bool = False

    def lines_before_for(self, width: int, table: str) -> int | None:
        """Number of such lines before the block; None if it is not known for them."""
        return self.lines_before if (self.width, self.table) == (width, table) else None


class Bookmark(msgspec.Struct, frozen=True):
    """A place of a book with a name.

    Parameters
    ----------
    name
        Name that the reader gave it.
    character
        Place of the source, counted in characters from 0.
    text
        A few words of the text from there on.
    share
        About how much of the book stands before it, 0 to 1.
    after
        Text from the place on, for which a changed book is searched; empty for that of `text`.
    """

    name: str
    character: int
    text: str = ""
    share: float = 0.0
    after: str = ""


AROUND = 200  # characters
# How much text before and after a place is looked for, the most telling first.
_TRIED = ((200, 200), (60, 60), (0, 100), (100, 0), (20, 20), (0, 30))
_LEAST = 12  # a shorter text stands anywhere


def place_in(source: Source, character: int) -> KeptPlace:
    """Place of a source, with the text around it."""
    number = source.block_at(character)
    block = None if number is None else source.block(number)
    if number is None or block is None:
        return KeptPlace(character, share=1.0)
    text, index = str(block.text), block.text.index(character)
    before, after = text[:index], text[index:]
    begins = int(block.text.places[max(0, index - AROUND)]) if index else character
    earlier = source.block(number - 1) if number else None
    if len(before) < AROUND and earlier is not None and len(earlier.text):
        more = AROUND - len(before)
        before = str(earlier.text)[-more:] + ("" if block.continues else " ") + before
        begins = int(earlier.text.places[max(0, len(earlier.text) - more)])
    later = source.block(number + 1) if len(after) < AROUND else None
    if later is not None:
        after += ("" if later.continues else " ") + str(later.text)
    return KeptPlace(
        character,
        number,
        share_before(source, character),
        storable(before[-AROUND:]),
        storable(after[:AROUND]),
        max(0, character - begins),
        about=not source.complete,
    )


def anchored(source: Source, place: KeptPlace) -> tuple[KeptPlace, bool]:
    """Place in a source that has changed since it was kept, and whether the text was found again.

    The nearest to the old place is taken of all where the same text stands. If it stands nowhere,
    the place is the one with the same share of the book before it.
    """
    for before, after in _TRIED:
        head = place.before[len(place.before) - min(before, len(place.before)) :]
        tail = place.after[:after]
        if len((head + tail).strip()) < _LEAST:
            continue
        found = _nearest(source, head + tail, place.character - len(head))
        if found is None:
            continue
        character = found
        if head.strip():
            reach = place.reach if before >= len(place.before) else len(head)
            character = found + reach
            if tail.strip():
                nearer = find_place(source, FindText(tail, found + reach // 2))
                character = character if nearer is None else nearer
        return _again(source, place, character), True
    character = find_place(source, FindShare(place.share)) or 0
    return _again(source, place, character), False


def _again(source: Source, place: KeptPlace, character: int) -> KeptPlace:
    """A new place, with what is still so of the old one; lines are counted anew."""
    return msgspec.structs.replace(place_in(source, character), page=place.page)


def _nearest(source: Source, text: str, character: int) -> int | None:
    character = max(0, character)
    after = find_place(source, FindText(text, character))
    before = find_place(source, FindText(text, character, backward=True))
    near = [at for at in (after, before) if at is not None]
    return min(near, key=lambda at: abs(at - character), default=None)
