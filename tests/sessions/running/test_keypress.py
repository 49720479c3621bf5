"""The participant's key: at a pseudo-terminal it is told at once, and lines are typed as ever."""

import os
import select
import sys
import termios

import pytest

from tests.sessions.sittings import MINI, Session, of
from vbraille.devices import open_device
from vbraille.engine.batch import BatchEngine
from vbraille.sessions import session as door
from vbraille.sessions.record.export import rows
from vbraille.sessions.running.responses import TerminalKey, Typed


@pytest.fixture
def terminal():
    """Both ends of a pseudo-terminal: of the person, and of the program."""
    person, program = os.openpty()
    yield person, program
    os.close(person)
    os.close(program)


def come(program):
    """What has come to the program, as far as it may read it."""
    return os.read(program, 100) if select.select([program], [], [], 0.0)[0] else b""


@pytest.mark.parametrize("key", [" ", "\t", "+", "a"])
def test_a_key_is_told_at_once_while_it_is_waited_for(terminal, key):
    person, program = terminal
    told = TerminalKey.at(program, key)
    os.write(person, key.encode())
    assert come(program) == b""
    told.tell(at_once=True)
    os.write(person, key.encode())
    # The one from before, which was not waited for, comes with it, and both are one press.
    assert told.pressed(come(program))
    told.tell(at_once=False)
    os.write(person, key.encode())
    assert come(program) == b""
    os.write(person, b"x\n")
    assert come(program) == f"{key}x\n".encode()


def test_a_line_is_no_press_and_is_edited_as_ever(terminal):
    person, program = terminal
    told = TerminalKey.at(program, "+")
    told.tell(at_once=True)
    os.write(person, b"notd\x7fe\n")
    line = come(program)
    assert line == b"note\n"
    assert not told.pressed(line)
    assert not told.pressed(b"\n")


def test_the_terminal_is_left_as_it_was(terminal):
    _, program = terminal
    before = termios.tcgetattr(program)
    told = TerminalKey.at(program, " ")
    told.tell(at_once=True)
    assert termios.tcgetattr(program) != before
    told.tell(at_once=False)
    assert termios.tcgetattr(program) == before


def test_a_pipe_has_no_keys():
    reading, writing = os.pipe()
    assert TerminalKey.at(reading, " ") is None
    assert TerminalKey.at(None, " ") is None
    os.close(reading)
    os.close(writing)


def test_where_no_terminal_is_enter_ends_reading_and_the_console_says_so(tmp_path):
    session = Session(tmp_path / "s", MINI + '[trial]\nend = "key:space"\n')
    sat = session.sit(
        ("key: standard input is no terminal, so that space cannot be told; Enter ends", ""),
        ("cue: trial 1", ""),
        ("ended: .* by key enter", "c"),
        ("answer", "stop"),
    )
    assert [e["by"] for e in of(sat.events, "ended")] == ["key:enter"]
    assert rows(sat.record)[0]["ended_by"] == "key:enter"


def test_the_key_types_a_blank_again_before_the_end_of_reading_is_told(
    tmp_path, terminal, monkeypatch
):
    """An answer typed as soon as it is asked for can be erased as a whole, blanks and all."""
    person, program = terminal
    typed = {"cue": b"note x\n", "note: is in": b" ", "ended": b"stop\n"}
    ends = []

    def say(sentence):
        if sentence.startswith("ended"):
            ends.append(termios.tcgetattr(program)[6][termios.VEOL])
        for beginning, keys in typed.items():
            if sentence.startswith(beginning):
                os.write(person, keys)

    Session(tmp_path / "s", MINI + '[trial]\nend = "key:space"\n')
    with os.fdopen(os.dup(program)) as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        door.Session.resume(
            tmp_path / "s",
            fast=False,
            engine=lambda spec, wanted: BatchEngine(open_device(spec, wanted), poll_ticks=100),
        ).run(Typed(), say=say)
    assert ends == [b"\0"]
