"""The outline of a source: headings with places, and what else there is."""

import io

from vbraille.translate.braillefiles.lines import open_brf
from vbraille.translate.documents.chapters import ChapterSource, Passage
from vbraille.translate.outline import outline
from vbraille.translate.source import BlockKind as K
from vbraille.translate.source import Mark, MarkKind

TEXT = (
    Passage("xi", K.PAGE),
    Passage("One & two", K.HEADING, 1),
    Passage("some  text"),
    Passage("a", K.ITEM, 1, group=1),
    Passage("b", K.ITEM, 2, group=1),
    Passage("c", K.ITEM, 3, group=1),
    Passage("d", K.ITEM, 1, group=1),
    Passage("deep", K.ITEM, 2, group=2),
    Passage("12", K.PAGE),
    Passage("Inner", K.HEADING, 3),
    Passage("quoted", K.QUOTE, 1, language="fr-CA"),
    Passage("noted", K.NOTE),
    Passage("  a  line", K.LINE),
    Passage("Mid", K.HEADING, 2),
    Passage("a row", K.ROW, group=1),
    Passage("Last", K.HEADING, 1),
    Passage("word " * 4_000),
)
MARKS = (
    Mark(MarkKind.LINK, 0, 3, "#x"),
    Mark(MarkKind.IMAGE, 4, 6),
    Mark(MarkKind.UNSHOWN, 4, 6, "formula"),
    Mark(MarkKind.LANGUAGE, 5, 6, "fr"),
    Mark(MarkKind.NOTE, 5, 6, "#n"),
    Mark(MarkKind.UNSHOWN, 9_000, 9_001),
)


class Made(ChapterSource):
    """A source of these passages."""

    def __init__(self, *made: Passage) -> None:
        super().__init__("made", [1], "0" * 64)
        self._made = made

    def passages(self, _part):
        return self._made


def test_headings_have_their_page_and_their_percent():
    found = outline(Made(*TEXT))
    told = [(heading.level, heading.title, heading.page) for heading in found.headings]
    assert told == [
        (1, "One & two", "xi"),
        (3, "Inner", "12"),
        (2, "Mid", "12"),
        (1, "Last", "12"),
    ]
    percents = [heading.percent for heading in found.headings]
    assert percents == sorted(percents)
    assert 0 < percents[0] < percents[-1] < 100


def test_each_thing_is_counted_once():
    long = Passage("word " * 4_000, marks=MARKS, language="de")
    found = outline(Made(*TEXT, long, Passage("a", K.ROW), Passage("b", K.ROW)))
    assert found.counts == {
        "lists": 2,
        "tables": 2,
        "links": 1,
        "notes": 1,
        "pictures": 1,
        "print pages": 2,
        "pages of the file": 0,
    }
    assert found.languages == {"fr-CA": 1, "de": 1, "fr": 1}
    assert found.unshown == {"formula": 1, "other thing": 1}


def test_pages_of_braille_are_not_print_pages():
    found = outline(open_brf(io.BytesIO(b"A\n\fB\n\f"), "x"))
    assert (found.headings, found.counts["print pages"]) == ((), 0)
    assert found.counts["pages of the file"] == 2
