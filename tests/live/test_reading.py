"""``vbraille read --monitor``: a page watches a real reading, is its hand, and turns its knobs."""

import re

import pytest

from tests.cli import program
from tests.live.showing import Client

LEFT_MM, RIGHT_MM = -5.4, 290.0


@pytest.fixture
def text(tmp_path):
    path = tmp_path / "text.txt"
    path.write_text("one two three\n\nfour five six\n")
    return path


def test_a_page_is_the_hand_of_a_reading_and_turns_its_knobs(text):
    options = ("--monitor", "--hand", "still", "--no-places")
    with program.start("read", text, *options) as process:
        try:
            printed = ""
            while not (found := re.search(r"live view: (http\S+)", printed)):
                printed += (line := process.stdout.readline().decode())
                assert line, printed
            with Client(found[1]) as page:
                page.until(lambda header, state: header["line"] and state["title"] == "text.txt")
                page.ask(ask="turn", knob="texture", value=0.5)
                page.until(lambda _, state: state["knobs"][0]["value"] == 0.5)
                page.ask(ask="press", command="undo")
                page.until(lambda _, state: state["knobs"][0]["value"] == 1.0)
                for line in (1, 2):
                    page.until(lambda header, _, line=line: header["line"] == line)
                    for x_mm in (RIGHT_MM, LEFT_MM):
                        page.ask(ask="point", x_mm=x_mm)
                        page.until(lambda header, _, x=x_mm: abs(header["x_mm"] - x) < 0.1)
                said = process.stdout.read().decode()
            assert process.wait(program.PATIENCE_S) == 0
        finally:
            process.kill()
    assert "line: 2" in said
    assert "summary: " in said
