"""Bookmarks: set, told, gone to, deleted."""

from tests.reading.commands.test_moving import finger_at
from tests.reading.test_reader import Bench
from vbraille.reading.keptplace import Bookmark

TEXT = "\n\n".join(f"paragraph {n} says something of its own" for n in range(1, 9))


def test_a_bookmark_is_set_by_one_key_or_by_a_name_and_gone_to():
    bench = Bench(TEXT, width=60)
    assert bench.press("B") == ["bookmarks: none; m sets one"]
    assert bench.press("o") == ["bookmarks: none; m sets one"]
    assert bench.press("nnM") == ["line: 2", "line: 3", "bookmark 1: set"]
    assert bench.press("nmThe end\n") == [
        "line: 4",
        "bookmark: type a name, Enter",
        "name: The end",
        "bookmark The end: set",
    ]
    assert bench.press("pppm\n")[-1] == "bookmark 2: set"
    assert bench.press("B") == [
        "bookmark 2: paragraph 1 says something of",
        "bookmark 1: paragraph 3 says something of",
        "bookmark The end: paragraph 4 says something of",
    ]
    assert bench.press("othe end\n") == ["go to bookmark: type its name, Enter", "name: the end",
                                         "line: 4"]  # fmt: skip
    assert bench.press("b") == ["line: 1"]
    assert bench.press("othe nd\n")[-1] == (
        "bookmark the nd: there is none; the nearest is The end"
    )


def test_a_bookmark_within_a_word_is_told_by_the_whole_word():
    bench = Bench(TEXT, width=60)
    finger_at(bench, bench.reader.line.cell_of(TEXT.index("thing")))
    bench.press("mhere\n")
    assert bench.press("B") == ["bookmark here: something of its own"]


def test_a_bookmark_is_moved_and_deleted():
    bench = Bench(TEXT, width=60)
    bench.press("mhere\n")
    bench.press("nnmhere\n")
    assert bench.press("B") == ["bookmark here: paragraph 3 says something of"]
    assert bench.press("Xhere\n")[-1] == "bookmark here: deleted"
    assert bench.press("X") == ["bookmarks: none; m sets one"]


def test_a_bookmark_outside_of_what_is_read_is_told():
    bench = Bench(TEXT, width=60, first=2, last=4)
    bench.reader.kept.set_bookmark(Bookmark("far", TEXT.index("paragraph 8"), "paragraph"))
    assert bench.press("ofar\n")[-1] == "bookmark far: not in the lines that are read"
