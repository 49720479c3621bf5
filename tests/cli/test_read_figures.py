"""``vbraille read`` of a text with figures: on pages, and alone by a key."""

import subprocess
import sys

import pytest

from tests.cli import program
from tests.reading.test_figured import SCENE, TEXT
from tests.tiers import heavy
from tests.translate.documents.epubs import epub

PAGES = ("--model", "stress2-8x8", "--height", "75", "--no-places", "--grade", "1")
SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="30mm" viewBox="0 0 40 30">'
    '<title>Water cycle</title><circle cx="20" cy="15" r="8" fill="none" stroke="black">'
    "<title>lake</title></circle></svg>"
)


@pytest.fixture
def water(tmp_path):
    """A text with a figure beside it, and one that is missing."""
    (tmp_path / "water.scene").write_text(SCENE)
    path = tmp_path / "text.md"
    path.write_text(TEXT + "\n![no](gone.scene)\n")
    return path


@heavy
def test_a_hand_comes_over_the_figure_to_what_follows(call, water):
    said = call("read", water, *PAGES, "--hand", "sweep:800", "--echo", "text")
    assert said.code == 0
    lines = [
        line for line in said.out.splitlines() if line.startswith(("text:", "figure:", "page:"))
    ]
    assert lines[:4] == [
        "text: ab",
        "text: figure: water",
        "figure: Water cycle, 40 mm × 30 mm; below this line",
        "text: cd",
    ]
    assert said.err.count("figure not felt: ") == 1
    assert "gone.scene" in said.err


@heavy
def test_an_epub_has_its_figure_within(call, tmp_path):
    path = tmp_path / "book.epub"
    chapters = {"one.xhtml": '<p>ab</p><img src="w.svg" alt="Water"/><p>cd</p>'}
    path.write_bytes(epub(chapters, **{"OPS/w.svg": SVG}))
    said = call("read", path, *PAGES, "--hand", "sweep:800", "--echo", "text")
    assert said.code == 0
    assert "figure: Water cycle, 40 mm × 30 mm; below this line" in said.out
    assert "not felt" not in said.err
    assert "note: figure: w.svg line 1: circle: its line is drawn 2 mm wide" in said.err


def test_a_key_feels_it_on_a_slider_and_the_same_place_is_read_on(water):
    how = ("--advance", "key", "--no-places", "--grade", "1", "--echo", "none", "--cues", "none")
    with program.Terminal("read", water, *how) as terminal:
        terminal.until("h says the keys\r\n")
        terminal.type("G")
        terminal.until("figure: none on this line\r\n")
        terminal.type("n")
        terminal.until("figure: Water cycle, 40 mm × 30 mm; shift-g feels it\r\n")
        terminal.type("G")
        said = terminal.until("goes back to the text\r\n")
        assert "picture: Water cycle\r\n" in said
        assert "one axis: " in said
        terminal.type("O")
        terminal.until(
            "element: lake, 20 mm × 20 mm, middle 20 mm from the left, 15 mm from the top\r\n"
        )
        terminal.type("GV")
        assert "line: 2\r\ntext: figure: water\r\n" in terminal.until(r"text: .*\r\n")
        terminal.type("q")
        assert terminal.end() == 0


def test_a_text_without_figures_loads_nothing_of_them():
    code = "import sys, vbraille.cli.old.commands.read; print(*sys.modules)"
    loaded = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    names = loaded.stdout.split()
    assert "vbraille.reading.lineviews" in names
    bounds = "vbraille.scene.measures"  # of an option
    pictures = ("vbraille.feeling", "vbraille.scene.", "numba")
    assert [name for name in names if name.startswith(pictures)] == [bounds]
