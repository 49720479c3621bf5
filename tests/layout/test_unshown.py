"""What cannot be shown is counted at its place, each thing once."""

from vbraille.layout.pages import Layout
from vbraille.layout.texts import Unshown
from vbraille.translate import Book, BrailleTable
from vbraille.translate.documents.chapters import ChapterSource, Passage
from vbraille.translate.source import Mark, MarkKind


class Made(ChapterSource):
    """A source of these passages."""

    def __init__(self, *made: Passage) -> None:
        super().__init__("made", [1], "0" * 64)
        self._made = made

    def passages(self, _part):
        return self._made


def marked(text, *remarks, kind=MarkKind.UNSHOWN):
    marks = tuple(Mark(kind, at, at + 1, what) for at, what in remarks)
    return Passage(text, marks=marks)


BOOK = (
    marked("one two three four", (0, "formula"), (8, "formula"), (14, "drawing")),
    marked("plain", (0, "formula"), kind=MarkKind.LINK),
    marked("last", (3, "")),
)


def test_lines_are_counted_as_they_are_shown():
    layout = Layout(Book(Made(*BOOK), BrailleTable("en-ueb-g1.ctb")), 10)
    lines = list(layout.lines())
    unshown = Unshown()
    assert unshown.sentence is None
    unshown.see(lines[-1])  # a reader may begin at the end
    unshown.see(lines[-1])
    assert unshown.sentence == "not shown: 1 thing (1 other thing); each is marked where it stands"
    unshown = Unshown()
    unshown.see(lines[0])
    assert unshown.sentence == "not shown: 1 thing (1 formula); each is marked where it stands"
    for line in [*lines, *lines]:
        unshown.see(line)
    assert unshown.sentence == (
        "not shown: 4 things (2 formulas, 1 drawing, 1 other thing); each is marked where it stands"
    )


def test_few_kinds_are_named():
    kinds = "abcdefg"
    source = Made(marked("x" * 9, *((n, kinds[n]) for n in range(7))))
    (line,) = Layout(Book(source, BrailleTable("en-ueb-g1.ctb")), 40).lines()
    unshown = Unshown()
    unshown.see(line)
    assert unshown.sentence.startswith("not shown: 7 things (1 a, 1 b, 1 c, 1 d, 1 e, 2 other thi")
