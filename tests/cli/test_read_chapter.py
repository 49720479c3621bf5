"""``vbraille read``: a whole chapter at a terminal, by hand and keys, is what the page says."""

import re
from pathlib import Path

from tests.cli import program

FILES = Path(__file__).parents[1] / "translate" / "documents" / "files"
CHAPTER = FILES / "pandoc-3.epub"
READ = ("--hand", "sweep:1000", "--advance", "key", "--echo", "both")


def printed(call, form):
    """What ``vbraille page`` prints of the chapter, by lines."""
    done = call("page", CHAPTER, "--format", form)
    assert done.code == 0
    return [line.rstrip() for line in done.out.splitlines()]


def lines_of(said):
    """The lines that were said, each its number, its cells and its text."""
    found = re.findall(r"line: (\d+)\r\ncells: (.*)\r\ntext: (.*)\r\n", said)
    assert len(found) == said.count("line: ")
    return [(int(number), cells, text) for number, cells, text in found]


def test_a_chapter_that_is_read_is_what_the_page_says_and_is_gone_on_with(call):
    cells, texts = printed(call, "unicode"), printed(call, "text")
    page = [
        (number, cells, text)
        for number, (cells, text) in enumerate(zip(cells, texts, strict=True), 1)
    ]
    line = {text: (number, cells, text) for number, cells, text in page}
    note, noted = line["1. Except the harbour"], line["counts them.[1]"]
    light, cod = line["The light"], line["cod  12"]
    read = []
    with program.Terminal("read", CHAPTER, *READ) as terminal:

        def press(keys, *last):
            """Type keys; give the lines that are said until these are."""
            terminal.type(keys)
            said = terminal.until(
                "".join(rf"{re.escape(line)}\r\n" for line in last)
                # A simulated hand may be told at any moment that it is too fast.
                + r"(speed: .*\r\n)?$"
            )
            return lines_of(said)

        def go(keys, line):
            """Type keys, by which one line is gone to: this one."""
            terminal.type(keys)
            assert lines_of(terminal.until(r"cells: .*\r\ntext: .*\r\n")) == [line]

        read += lines_of(terminal.until("h says the keys\r\n"))
        detours = {
            noted: lambda: (go("\r", note), go("b", noted)),
            line["1. herring"]: lambda: (
                press("mhere\n", "bookmark here: set"),
                go("e", light),
                go("ohere\n", line["1. herring"]),
            ),
            cod: lambda: (
                press("H", "headers: Fish; Price"),
                go("/the li\n", light),
                go("b", cod),
            ),
            light: lambda: (
                press("T", "texture: 0.9"),
                press("s", "dot spacing: 3.9 mm"),
                press("U", "undo: dot spacing 3.7 mm"),
            ),
        }
        done = []
        for _ in page[1:]:
            terminal.type("n")
            read += lines_of(terminal.until(r"text: .*\r\n"))
            if read[-1] in detours:
                detours[read[-1]]()
                done.append(read[-1])
        assert done == list(detours)
        assert press("n", "last line") == []
        assert read == page
        go("ohere\n", line["1. herring"])
        terminal.type("q")
        assert terminal.end() == 0

    with program.Terminal("read", *READ) as terminal:
        said = lines_of(terminal.until("h says the keys\r\n"))
        assert said == [line["1. herring"]]
        terminal.type("B")
        terminal.until(r"bookmark here: .*\r\n")
        terminal.type("T")
        terminal.until("texture: 0.8\r\n")
        terminal.type("q")
        assert terminal.end() == 0
