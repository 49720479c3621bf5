"""Reading with a Dot Pad beside, which is made of software at a pseudo-terminal."""

from tests.cli.program import Terminal
from tests.conventional.dotpad import FUNCTION, PAN_RIGHT, PERKINS, ROUTING, SimulatedDotPad
from tests.conventional.handytech import until

BLANK = bytes(20)


def test_each_line_stands_there_its_keys_are_obeyed_and_it_may_go_and_come_back(text, tmp_path):
    link = tmp_path / "ttyUSB0"
    with SimulatedDotPad(link) as dot_pad:
        how = ("--also", f"dotpad:{link}", "--hand", "sweep:5", "--cues", "none")
        with Terminal("read", text, *how) as terminal:
            terminal.until("display: DotPad 320, 20 cells")
            first = until(lambda: any(dot_pad.lines.get(0, BLANK)) and dot_pad.lines[0])
            dot_pad.press(FUNCTION, 3)
            terminal.until("line: 2")
            until(lambda: dot_pad.lines[0] != first)
            dot_pad.press(ROUTING, 3, 8)
            assert "word: four" in terminal.until("word: .*\n")
            dot_pad.press(PERKINS, PAN_RIGHT)
            terminal.until("line: 3")
            dot_pad.unplug()
            terminal.until("display: the Dot Pad at .* is gone; plug it in again")
            terminal.type("p")
            terminal.until("line: 2")  # reading goes on
            dot_pad.plug()
            terminal.until("display: DotPad 320, 20 cells")
            until(lambda: any(dot_pad.lines.get(0, BLANK)))
            terminal.type("q")
            assert terminal.end() == 0
        dot_pad.wait({0: BLANK})
