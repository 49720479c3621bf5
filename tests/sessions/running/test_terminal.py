"""A session typed at a terminal, as an experimenter has it."""

import re

from tests.cli.program import Terminal
from tests.sessions.sittings import MINI, SURE, made
from vbraille.sessions.record.checking import sum_of

ARGUMENTS = ("--answers", "typed", "--hand", "sweep:200", "--cues", "none")


def test_answers_are_edited_and_commands_typed(tmp_path):
    sat = made(tmp_path, MINI + SURE)
    with Terminal("session", "resume", sat.session.path, *ARGUMENTS) as terminal:
        terminal.until(r"read: ")
        terminal.type("cc\x1b[D\x1b[D\x1b[3~a\n")  # left, left, delete
        terminal.until(r"(?s)answer: trial 1 of 3, a c\r?\n.*confidence: .*type 1 to 4")
        terminal.type("3\n")
        terminal.until(r"cue: trial 2")
        terminal.type("note the fan is on\n")
        terminal.until(r"note: is in")
        terminal.type("stop\n")
        said = terminal.until(r"record: [0-9a-f]{64}")
        assert terminal.end() == 0
    assert sum_of(sat.session.path) in said
    assert [event.data["answer"] for event in sat.of("answer")] == ["⠁⠉"]
    assert sat.of("note")[0].data["text"] == "the fan is on"


def test_what_the_protocol_asks_about_the_participant_is_asked_before(tmp_path):
    field = "[[fields]]\nname = 'hand'\nask = 'Reading hand'\nchoices = ['right', 'left']\n"
    path = tmp_path / "mini.toml"
    path.write_text(MINI + field)
    out = tmp_path / "P01.session"
    with Terminal("session", "run", path, "--participant", "P01", "--out", out,
                  "--hand", "sweep:200", "--cues", "none") as terminal:  # fmt: skip
        terminal.until(r"Reading hand \(right or left\):")
        terminal.type("both\n")
        terminal.until(r"Reading hand")
        terminal.type("left\n")
        terminal.until(r"session: ")
        terminal.until(r"cue: trial 1")
        terminal.type("quit tired\n")
        assert re.search(r"end: ", terminal.until(r"record: "))
    from vbraille.sessions.session import Session

    assert Session(out).content.head["fields"] == {"hand": "left"}
