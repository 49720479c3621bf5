"""``vbraille structure``."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from vbraille.cli import options
from vbraille.cli.printing import say, show

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate import Block, Source


@options.command(
    "structure book.epub",
    options.file, options.json,
    options.encoding(group=options.FIRST), options.form(group=options.FIRST),
    options.keep_lines(group=options.FIRST),
)  # fmt: skip
def command(json: bool, **chosen: Any) -> None:
    """Headings with their pages and percentages, then what else is in the book."""
    from vbraille.cli.build import open_text

    source = open_text(chosen)
    found = _outline(source)
    for note in source.notes():
        say(note, aside=True)
    show(_lines(found), found, as_json=json)


def _lines(found: dict[str, Any]) -> Iterator[str]:
    for what in ("title", "language"):
        if found[what]:
            yield f"{what}: {found[what]}"
    for heading in found["headings"]:
        page = f"page {heading['page']}, " if heading["page"] else ""
        yield "level {level}: {title}, {0}{percent:.0f} percent".format(page, **heading)
    yield f"headings: {len(found['headings'])}"
    for what, number in found["counts"].items():
        if number:
            yield f"{what}: {number}"
    for label, key in (("languages", "languages"), ("not shown", "unshown")):
        if found[key]:
            yield f"{label}: {', '.join(f'{what} {n}' for what, n in found[key].items())}"


def _outline(source: Source) -> dict[str, Any]:
    """Headings of a book, with what else it has, by words for each."""
    from vbraille.translate import BlockKind, MarkKind

    words = ("lists", "tables", "links", "notes", "pictures", "print pages", "pages of the file")
    counts: Counter[str] = Counter(dict.fromkeys(words, 0))
    languages: Counter[str] = Counter()
    unshown: Counter[str] = Counter()
    groups: set[tuple[BlockKind, int]] = set()
    for block in source.blocks():
        if block.kind is BlockKind.PAGE:
            counts["print pages" if block.text.strip() else "pages of the file"] += 1
        if block.kind in (BlockKind.ITEM, BlockKind.ROW):
            groups.add((block.kind, block.group))
        counts["notes"] += block.kind is BlockKind.NOTE and not block.continues
        counts["links"] += _marked(block, MarkKind.LINK)
        counts["pictures"] += _marked(block, MarkKind.IMAGE)
        if block.language and not block.continues:
            languages[block.language] += 1
        for mark in block.marks:
            if mark.kind is MarkKind.LANGUAGE:
                languages[mark.target] += 1
            elif mark.kind is MarkKind.UNSHOWN:
                unshown[mark.target or "other thing"] += 1
    counts["lists"] = sum(kind is BlockKind.ITEM for kind, _ in groups)
    counts["tables"] = sum(kind is BlockKind.ROW for kind, _ in groups)
    headings = [
        {
            "level": heading.level,
            "title": heading.title,
            "page": heading.page,
            "percent": round(100 * source.progress(heading.place), 3),
        }
        for heading in source.headings()
    ]
    return {
        "title": source.title,
        "language": source.language,
        "headings": headings,
        "counts": {word: counts[word] for word in words},
        "languages": dict(languages.most_common()),
        "unshown": dict(unshown.most_common()),
    }


def _marked(block: Block, kind: Any) -> int:
    return sum(mark.kind is kind for mark in block.marks)
