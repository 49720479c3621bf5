"""A book's outline: its headings with their places, and what else it has."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.translate.source import BlockKind, MarkKind, share_before, to_text

if TYPE_CHECKING:
    from vbraille.translate.source import Block, Source


@dataclass(frozen=True, slots=True)
class OutlineHeading:
    """A heading of an outline.

    Parameters
    ----------
    level
        Depth of its part, 1 for the largest parts.
    title
        Text of the heading.
    page
        Number of the print page that it is on; empty if the source does not say.
    percent
        How much of the book's text stands before it, 0 to 100.
    """

    level: int
    title: str
    page: str
    percent: float


@dataclass(frozen=True, slots=True)
class Outline:
    """Structure of a source, as it says.

    Parameters
    ----------
    title, language
        As the source has them; empty if it does not.
    headings
        Headings in order.
    counts
        How many lists, tables, links, notes, pictures and pages there are, by these words.
    languages
        Tags of the languages in it, the most frequent first, with the number of passages.
    unshown
        What cannot be shown, such as "formula", with its number.
    """

    title: str
    language: str
    headings: tuple[OutlineHeading, ...]
    counts: dict[str, int]
    languages: dict[str, int]
    unshown: dict[str, int]


_COUNTED = {MarkKind.LINK: "links", MarkKind.IMAGE: "pictures"}
_WORDS = ("lists", "tables", "links", "notes", "pictures", "print pages", "pages of the file")


def outline(source: Source) -> Outline:
    """Make the outline of a source, which reads all of it.

    Raises
    ------
    InputError
        If the source cannot be read.
    """
    counts: Counter[str] = Counter(dict.fromkeys(_WORDS, 0))
    languages: Counter[str] = Counter()
    unshown: Counter[str] = Counter()
    groups: dict[BlockKind, int] = {BlockKind.ITEM: 0, BlockKind.ROW: 0}
    headings: list[tuple[int, str, str, int]] = []  # with the place of its first character
    page, number, before = "", 0, None
    while (block := source.block(number)) is not None:
        words = to_text(block.text.codes).strip()
        if block.kind is BlockKind.PAGE:
            counts["print pages" if words else "pages of the file"] += 1
            page = words or page
        elif not block.continues:
            _count_groups(block, before, counts, groups)
            if block.kind is BlockKind.HEADING:
                place = int(block.text.places[0]) if len(block.text) else block.text.end
                headings.append((block.level, " ".join(words.split()), page, place))
            counts["notes"] += block.kind is BlockKind.NOTE
        if block.language and not block.continues:
            languages[block.language] += 1
        for mark in block.marks:
            if not len(block.text) or mark.start < int(block.text.places[0]):
                continue  # it began in the piece before
            if mark.kind is MarkKind.LANGUAGE:
                languages[mark.target] += 1
            elif mark.kind is MarkKind.UNSHOWN:
                unshown[mark.target or "other thing"] += 1
            elif mark.kind in _COUNTED:
                counts[_COUNTED[mark.kind]] += 1
        if block.kind is not BlockKind.PAGE:
            before = block
        number += 1
    return Outline(
        source.title,
        source.language,
        tuple(
            OutlineHeading(level, title, page, round(100 * share_before(source, place), 3))
            for level, title, page, place in headings
        ),
        {word: counts[word] for word in _WORDS},
        dict(languages.most_common()),
        dict(unshown.most_common()),
    )


def _count_groups(
    block: Block, before: Block | None, counts: Counter[str], groups: dict[BlockKind, int]
) -> None:
    """Count a list or a table at its first block."""
    if block.kind not in groups:
        return
    if block.group:
        new = block.group != groups[block.kind]
    else:  # a source that does not number them: neighbours are together
        new = before is None or before.kind is not block.kind
    groups[block.kind] = block.group
    counts["lists" if block.kind is BlockKind.ITEM else "tables"] += new
