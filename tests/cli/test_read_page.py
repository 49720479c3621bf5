"""``vbraille read`` on a surface of two axes: pages, as many lines as there is room for."""

import re

import pytest

from tests.tiers import heavy

LETTERS = "abcde"
FAST = ("--hand", "sweep:1000", "--echo", "text", "--no-places")
PAGES = ("--model", "stress2-8x8", "--height", "40")  # three lines of 11 mm, and a foot


@pytest.fixture
def letters(tmp_path):
    """A file of five lines of one letter each."""
    path = tmp_path / "letters.txt"
    path.write_text("\n\n".join(LETTERS) + "\n")
    return path


def numbers(said):
    return [int(found) for found in re.findall(r"^line: (\d+)$", said, re.MULTILINE)]


def test_a_hand_reads_page_after_page_along_and_back_and_down(call, letters):
    said = call("read", letters, *FAST, *PAGES)
    assert said.code == 0
    assert "line width: 19 cells" in said.err
    assert [n for n in numbers(said.out) if n > 3][:2] == [4, 5]
    lines = said.out.splitlines()
    assert lines[:6] == ["line: 1", "text: a", "line: 2", "text: b", "line: 3", "text: c"]
    assert lines[6] == "page: lines 4 to 5"
    assert lines[7:9] == ["line: 4", "text: d"]
    assert lines[-3:-1] == ["line: 5", "text: e"]


def test_without_a_height_one_line_is_shown_wherever_the_array_is(call, letters):
    said = call("read", letters, *FAST, "--model", "latero", "--height", "0", "--lines", "1-2")
    assert (said.code, numbers(said.out)) == (0, [1, 2])
    assert "page:" not in said.out


@heavy
def test_a_slider_becomes_a_plane(call, letters):
    said = call("read", letters, *FAST, "--height", "60", "--travel", "113", "--straying", "free")
    assert (said.code, "page: line 5" in said.out) == (0, True)
