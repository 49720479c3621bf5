"""A source with all kinds of structure, of passages in parts."""

from vbraille.translate.documents.chapters import ChapterSource, Passage
from vbraille.translate.source import BlockKind, Mark, MarkKind

HEADING, ITEM, ROW, PAGE, NOTE = (
    BlockKind.HEADING,
    BlockKind.ITEM,
    BlockKind.ROW,
    BlockKind.PAGE,
    BlockKind.NOTE,
)


class Chapters(ChapterSource):
    """A source of these parts."""

    def __init__(self, *parts, language="en"):
        super().__init__("chapters", [1] * len(parts), "0" * 64, language=language)
        self._parts = parts
        self.adopted = []

    def passages(self, part):
        return self._parts[part]

    def adopt(self, index):
        self.adopted.append(index)
        super().adopt(index)


def linked(text, word, target, kind=MarkKind.LINK):
    """A paragraph with a link on a word."""
    start = text.index(word)
    return Passage(text, marks=(Mark(kind, start, start + len(word), target),))


BOOK = Chapters(
    [
        Passage("1", PAGE),
        Passage("The first part", HEADING, 1),
        linked("See the end of it.", "end", "#end"),
        Passage("A section", HEADING, 2),
        Passage("apples", ITEM, 1, group=1),
        Passage("pears", ITEM, 1, group=1),
        Passage("Between the lists."),
        Passage("plums", ITEM, 1, group=2),
        Passage("2", PAGE),
        Passage("Name; Age", ROW, group=3, headers=("Name", "Age")),
        Passage("Ann; 7", ROW, group=3, headers=("Name", "Age")),
    ],
    [
        Passage("The second part", HEADING, 1),
        linked("A remark follows.", "remark", "#note", MarkKind.NOTE),
        linked("More on the net.", "net", "https://example.org"),
        Passage("iii", PAGE),
        Passage("Here it ends.", anchors=("end",)),
        Passage("This is the note.", NOTE, anchors=("note",)),
    ],
)
