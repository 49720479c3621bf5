"""What a reader hears of ``vbraille read`` at a terminal: sentences, speech, and little more."""

import re
import time

from tests.cli import program
from tests.reading.ssipserver import SsipServer
from vbraille.reading.cueing import MELODIES
from vbraille.reading.view import Cue

# All that may be printed for a key beside what it says, which has no end of a line.
MOST_BYTES = 40
QUIET = ("--advance", "key", "--hand", "sweep:30", "--cues", "none")
KEYS = ("n", "n", "n", "p", "\x1b[A", "w", "t", "T", "t", "c", "C", " ", " ", "x", "\x1b[15~")


def test_a_key_prints_its_sentences_and_nothing_else(text):
    with program.Terminal("read", text, *QUIET) as terminal:
        terminal.until("h says the keys\r\n")
        for key in KEYS:
            before = len(terminal.printed)
            terminal.type(key)
            terminal.until(r"\n")
            terminal.type("~")  # a key that is none says so, after all that the one before has said
            terminal.until(r"tilde;.*\r\n")
            said = re.sub(r".*tilde;.*\r\n", "", terminal.printed[before:])
            assert "\x1b" not in said
            assert re.fullmatch(r"([^\x00-\x1f]+\r\n){1,2}", said), said
            beside = len(said.encode()) - sum(len(line.encode()) for line in said.splitlines())
            assert beside <= MOST_BYTES
        terminal.type("q")
        assert terminal.end() == 0


def test_lines_and_settings_are_spoken_and_bells_ring(text, tmp_path):
    place = {"SPEECHD_ADDRESS": f"unix_socket:{tmp_path / 'sock'}"}
    options = (*QUIET, "--speech", "--cues", "bell")
    with (
        SsipServer(tmp_path / "sock") as server,
        program.Terminal("read", text, *options, **place) as terminal,
    ):
        server.until(lambda it: "one two three" in it.said)
        terminal.until("h says the keys\r\n")
        terminal.type("p")
        terminal.until("first line\r\n")
        end = time.monotonic() + program.PATIENCE_S
        while terminal.bells < len(MELODIES[Cue.LIMIT]):
            assert time.monotonic() < end
            terminal.silent(0.2)
        terminal.type("n")
        server.until(lambda it: it.said[-1] == "four five six")
        terminal.type("C")
        server.until(lambda it: it.said[-1] == "contrast: 0.9")
        terminal.type("pv")  # lines come by themselves from here on
        server.until(lambda it: it.said[-1] == "seven eight nine")
        server.goes_on.clear()  # a server that answers no more keeps no key waiting
        for key, said in (("p", "line: 2"), ("n", "line: 3"), ("C", "contrast: 0.8")):
            terminal.type(key)
            terminal.until(f"{said}\r\n")
        assert "contrast: 0.8" not in server.said
        terminal.type("q")
        assert terminal.end() == 0
        assert ("SET SELF LANGUAGE en", "") in server.done
        assert "four five six" not in terminal.printed  # spoken, and not printed
