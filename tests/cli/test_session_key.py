"""A session at a terminal in which the participant ends reading by a key."""

from pathlib import Path

from tests.cli import program
from tests.cli.program import Terminal
from tests.reading.ssipserver import SsipServer
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.folder import load

MINE = """
format = 1
name = "mine"
title = "Two"
source = "ours"
model = "vbd"
[design]
kind = "combinations"
characters = ["a", "c"]
length = 1
[trial]
end = "key:space"
"""


def arguments(folder: Path):
    (folder / "mine.toml").write_text(MINE)
    session = folder / "s"
    named = ["--participant", "P01", "--seed", "1", "--hand", "sweep:60", "--cues", "none"]
    return ["session", "run", folder / "mine.toml", "--out", session, *named]


def test_one_press_ends_reading_and_orders_are_typed_as_ever(tmp_path):
    with Terminal(*arguments(tmp_path)) as terminal:
        terminal.until("key: space ends reading, with no Enter after it")
        terminal.until("cue: trial 1 of 2")
        terminal.type_apart([b"no", b"te ", b"a b", b"\n"])
        terminal.until("note: is in")
        terminal.type(" ")
        terminal.until("ended: .* s, by key space; type the answer")
        terminal.type("a\x7fx y\x17\x7f\x7f\x7fc\n")  # Backspace and Ctrl-W take back what is typed
        terminal.until("answer: trial 1 of 2, c")
        terminal.until("cue: trial 2 of 2")
        terminal.type("pause\n")
        terminal.until("pause: the array is at rest")
        terminal.type(" \n")  # in a pause the key is a blank, and Enter goes on
        terminal.until("go: on")
        terminal.type(" ")
        terminal.until("ended: .* s, by key space")
        terminal.type("note\x15a\n")  # and Ctrl-U the line
        terminal.until("last: all trials are done")
        terminal.type("\n")
        assert terminal.end() == 0
        assert terminal.settings() == terminal.before
    table = rows(load(tmp_path / "s"))
    assert [row["ended_by"] for row in table] == ["key:space"] * 2
    assert [row["notes"] for row in table] == ["a b", ""]
    assert "\x1b" not in terminal.printed


def test_at_a_pipe_enter_is_pressed_instead(tmp_path):
    done = program.run(*arguments(tmp_path), stdin=None, input="stop\n")
    assert done.returncode == 0, done.stderr
    assert "key: standard input is no terminal, so that space cannot be told; Enter" in done.stdout


LEFT, RIGHT, HOME, END, DELETE = "\x1b[D", "\x1b[C", "\x1b[H", "\x1b[F", "\x1b[3~"


def test_what_is_typed_is_edited_by_arrows_and_said(tmp_path):
    with Terminal(*arguments(tmp_path)) as terminal:
        terminal.until("cue: trial 1 of 2")
        terminal.type("note bc")
        terminal.type(LEFT)
        terminal.until(r"cursor: c\s+note bc\x08")
        terminal.type(LEFT)
        terminal.until(r"cursor: b\s+note bc\x08\x08")
        terminal.type("a")
        terminal.type(END + "x" + LEFT)
        terminal.until("cursor: x")
        terminal.type(DELETE + HOME)
        terminal.until("cursor: n")
        terminal.type(RIGHT + "\n")
        terminal.until("note: is in")
        terminal.type(" ")
        terminal.until("ended: .* s, by key space")
        terminal.type("ca" + LEFT + "\x7f" + "\n")
        terminal.until("answer: trial 1 of 2, a")
        terminal.type("stop\n")
        assert terminal.end() == 0
        assert terminal.settings() == terminal.before
    first = rows(load(tmp_path / "s"))[0]
    assert (first["notes"], first["answered"]) == ("abc", "⠁")


def test_a_sentence_leaves_what_is_being_typed_as_it_is(tmp_path):
    with Terminal(*arguments(tmp_path)) as terminal:
        terminal.until("ready: trial 1")
        terminal.type("note mine")
        terminal.until(r"cue: trial 1 of 2[^\n]*\s+note mine")
        terminal.type("\nstop\n")
        assert terminal.end() == 0
    assert rows(load(tmp_path / "s"))[0]["notes"] == "mine"


def test_what_the_console_says_is_spoken(tmp_path):
    place = {"SPEECHD_ADDRESS": f"unix_socket:{tmp_path / 'sock'}"}
    with (
        SsipServer(tmp_path / "sock") as server,
        Terminal(*arguments(tmp_path), "--speech", **place) as terminal,
    ):
        server.until(lambda it: "cue: trial 1 of 2" in it.said)
        terminal.type("note ab" + LEFT)
        server.until(lambda it: it.said[-1] == "cursor: b")
        terminal.type("\n")
        server.until(lambda it: it.said[-1].startswith("note: is in"))
        terminal.type("stop\n")
        assert terminal.end() == 0
