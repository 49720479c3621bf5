"""``vbraille read``: through a pipe, and at a terminal with its keys."""

import re
import signal
import subprocess
import time
from pathlib import Path

import pytest

from tests.cli import program
from tests.tiers import heavy
from vbraille.layout.pages import Layout
from vbraille.reading import COMMANDS, Context
from vbraille.reading.commands.table import BOUND
from vbraille.translate import Book, BrailleTable, Document

SUMMARY = r"summary: lines (\d+), seconds (\d+\.\d), mean scanning speed (\d+\.\d) mm/s"
FAST = ("--hand", "sweep:1000")


def of_lines(said):
    """What was said but for notes on the speed of the hand."""
    return [line for line in said.splitlines() if not line.startswith("speed:")]


def spoken(path, first, last, labels=("line", "cells", "text")):
    layout = Layout(Book(Document.open(path), BrailleTable("en-ueb-g2.ctb")), 26)
    said = []
    for line in layout.lines(first, last):
        parts = {"line": line.number, "cells": line.printed.to_unicode(), "text": line.text}
        said += [f"{label}: {parts[label]}" for label in labels]
    return said


@pytest.mark.new_processes
def test_without_a_terminal_it_runs_through_and_says_each_line(text):
    done = program.run("read", text, "--hand", "sweep:900", "--lines", "2-3")
    assert done.returncode == 0
    assert done.stderr == program.line_width(26)
    *lines, summary = of_lines(done.stdout)
    assert lines == spoken(text, 2, 3)
    found = re.fullmatch(SUMMARY, summary)
    read, seconds, speed = map(float, found.groups())
    assert read == 2
    assert 300 < speed <= 910
    assert 1 < seconds < 60


def with_closed(streams, *arguments):
    """Command for the program with some of its standard streams closed, as the shell spells it."""
    return ["sh", "-c", f'exec "$@" {streams}', "sh", *program.PROGRAM, *map(str, arguments)]


@pytest.mark.parametrize("closed", ["<&-", "<&- 2>&-"])
def test_closed_streams_are_like_those_that_lead_nowhere(text, closed):
    command = with_closed(closed, "read", text, "--hand", "sweep:900", "--lines", "2-3")
    with subprocess.Popen(command, stdout=subprocess.PIPE, encoding="utf-8") as process:
        first = process.stdout.readline()
        if "2>" in closed:  # nor do those that it starts write into what they open
            children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
            messages = [Path(f"/proc/{child}/fd/2").readlink() for child in children]
            assert {str(path) for path in messages} == {"/dev/null"}
        *lines, summary = of_lines(first + process.stdout.read())
        assert process.wait(program.PATIENCE_S) == 0
    assert lines == spoken(text, 2, 3)
    assert re.fullmatch(SUMMARY, summary)


def test_a_closed_output_is_said_instead_of_read(text):
    done = subprocess.run(
        with_closed(">&-", "read", text), check=False, stderr=subprocess.PIPE, encoding="utf-8"
    )
    assert done.returncode == 1
    assert "output is closed" in done.stderr.splitlines()[-1]


@heavy  # the other tests here have all four on their way
@pytest.mark.parametrize(
    ("echo", "labels"),
    [
        ("none", ()),
        ("text", ("line", "text")),
        ("cells", ("line", "cells")),
        ("both", ("line", "cells", "text")),
    ],
)
def test_echo(call, text, echo, labels):
    said = call("read", text, *FAST, "--lines", "1", "--echo", echo)
    assert said.code == 0
    *lines, summary = of_lines(said.out)
    assert lines == spoken(text, 1, 1, labels)
    assert re.fullmatch(SUMMARY, summary)


def test_the_other_model_and_the_tuning(call, text):
    options = (
        "--model vbd --dot-row 3 --texture 0.5 --contrast 0.5 --rate 500 --lines 3 --echo cells"
    )
    said = call("read", text, *FAST, *options.split())
    assert said.code == 0
    assert said.err == program.line_width(28)
    *lines, summary = of_lines(said.out)
    assert [line.split(" ")[0] for line in lines] == ["line:", "cells:"]
    assert lines[0] == "line: 3"
    assert re.fullmatch(SUMMARY, summary)


def test_a_recording_that_is_over_ends_the_reading(call, tmp_path, text):
    hand = tmp_path / "hand.csv"
    hand.write_text("0,-10.8\n0.05,40\n0.1,20\n")
    said = call("read", text, "--hand", f"recorded:{hand}")
    assert said.code == 0
    *lines, summary = of_lines(said.out)
    assert lines == spoken(text, 1, 1)
    assert summary.startswith("summary: lines 1,")


def test_a_hand_that_is_at_the_end_between_two_ticks_goes_on(call, text):
    text.write_text("a\n\nb\n")
    said = call("read", text, *FAST, "--rate", "2", "--echo", "text")
    assert said.code == 0
    *lines, summary = of_lines(said.out)
    assert lines == ["line: 1", "text: a", "line: 2", "text: b"]
    assert summary.startswith("summary: lines 2,")


def check_plain(terminal):
    """Nothing was printed but lines; pasted text is marked while keys are taken, and no longer."""
    on, off = terminal.printed.find("\x1b[?2004h"), terminal.printed.find("\x1b[?2004l")
    assert 0 <= on < off
    assert not re.search(r"[^\n\x20-\x7e\u00a0-\U0010ffff\r]", terminal.lines)
    assert not re.search(r"\r(?!\n)", terminal.lines)


@pytest.mark.new_processes
def test_keys_at_a_terminal(tmp_path, text):
    hand = tmp_path / "hand.csv"
    hand.write_text("0,64.2\n0.1,64.2\n")  # goes to the second word, and stays
    arguments = ("read", text, "--hand", f"recorded:{hand}", "--advance", "key")
    with program.Terminal(*arguments) as terminal:

        def press(keys, said):
            terminal.type(keys)
            return terminal.until(rf"(^|\n){re.escape(said)}\r\n")

        start = terminal.until("h says the keys\r\n")
        assert start.splitlines()[0] == program.line_width(26)[:-1]
        assert terminal.settings() != terminal.before
        helped = press("h", "q: stop reading").splitlines()
        assert [line for line in helped if ": " in line and not line.startswith("speed")] == [
            f"{command.spoken_keys}: {command.help}" for command in BOUND.of(Context.READING)
        ]
        word = ""
        while "two" not in word:
            terminal.type("w")
            word = terminal.until(r"word: .*\r\n")
        press("p", "first line")
        press("T", "texture: 0.9")
        press("tt", "texture: 1, the most")
        press("CC", "contrast: 0.8")
        press("c", "contrast: 0.9")
        press(" ", "paused")
        press(" ", "reading")
        press("Y", "no command: shift-y; h says the keys")
        press("n", "line: 2")
        press("\x1bOB", "line: 3")
        press("n", "last line")
        press("\x1bOA", "line: 2")
        press("\x1b[A", "line: 1")
        press("p", "first line")
        press("\x1b[24~", "no command: f12; h says the keys")
        press("\x1b[1;5C", "no command: ctrl-right; h says the keys")
        press("\x1b[99~é", "no command: é; h says the keys")
        assert "~" not in terminal.printed  # a sequence that stands for no key is passed over whole
        press("\x1b[200~nq\nq\x1b[201~", "paste: text that is pasted is passed over; type the keys")
        press("\x04", "no command: ctrl-d; h says the keys")
        terminal.type("q")
        assert terminal.end() == 0
        assert terminal.settings() == terminal.before
        *_, summary = terminal.lines.splitlines()
        assert re.fullmatch(SUMMARY, summary)
        assert summary.startswith("summary: lines 5,")
        for label in ("cells: ", "text: "):  # no echo unless asked for
            assert label not in terminal.printed
        check_plain(terminal)


CHAPTER = "\n\n".join(
    f"Paragraph {n} tells of long and winding things that are {'café' if n == 7 else 'here'}."
    for n in range(1, 61)
)


def test_a_bookmark_that_cannot_be_kept_says_so_and_is_kept_once_it_can_be(text, tmp_path):
    in_the_way = tmp_path / "kept"
    in_the_way.write_text("a file where a folder is to be")
    places = in_the_way / "places.sqlite"
    arguments = ("read", text, "--advance", "key")
    with program.Terminal(*arguments, VBRAILLE_PLACES=str(places)) as terminal:
        assert "Not a directory" in terminal.until("h says the keys\r\n")
        terminal.type("M")
        assert "Not a directory" in terminal.until(r"bookmark 1: set, but not kept: [^\n]*\n")
        in_the_way.unlink()
        until = time.monotonic() + program.PATIENCE_S
        while not places.exists():  # reading goes on meanwhile, and no key is typed
            assert time.monotonic() < until
            terminal.silent(0.1)
        terminal.type("q")
        assert terminal.end() == 0
    with program.Terminal(*arguments, VBRAILLE_PLACES=str(places)) as terminal:
        terminal.until("h says the keys\r\n")
        terminal.type("B")
        terminal.until("bookmark 1: ")
        terminal.type("Mq")
        terminal.until(r"bookmark 2: set\r\n")
        assert terminal.end() == 0


def test_a_book_is_found_one_s_way_in_by_keys_at_a_terminal(text):
    text.write_text(CHAPTER)
    with program.Terminal("read", text, "--advance", "key", "--cells", "60") as terminal:

        def press(keys, *said):
            """Type keys; these lines and no others are said, with few bytes beside them."""
            terminal.type(keys)
            new = terminal.until(re.escape(said[-1]) + r"\r\n$")
            assert [line for line in new.split("\r\n")[:-1] if "speed" not in line] == list(said)
            assert len(new.encode()) - sum(len(line.encode()) for line in said) <= 40

        terminal.until("h says the keys\r\n")
        press("'", "accents: matter")
        press("/", "search: type the text, Enter")
        press("cafex\x7f\n", "text: cafe", "not found after this: cafe")
        press("'", "accents: do not matter")
        press("/\n", "search: type the text, Enter", "text: cafe", "line: 7")
        press("mhere\n", "bookmark: type a name, Enter", "name: here", "bookmark here: set")
        press(">", "line: 60")
        press("i", "line: 60", "page: 3 in braille", "percent: 98", "words left: 11")
        press("b", "line: 7")
        press("\x1b[6~", "line: 26")
        press("g100 %\n", "go to: type a page, or percent as in 40%, then Enter", "go to: 100 %",
              "line: 60")  # fmt: skip
        press("ohere\n", "go to bookmark: type its name, Enter", "name: here", "line: 7")
        press("\x1b[H", "cells: 1 to 26")  # it was in the second part
        press("\x1b[C", "cells: 27 to 50")
        press("\x1b[C", "line: 8")
        press("\x1b[D", "line: 7")
        press("\x1b[H", "cells: 1 to 26")
        press("x", "table: Unified English uncontracted braille, grade 1")
        press("?", "learn: a key says what it does; this key again or q ends it")
        press("q", "learn: off")
        press("/given up\x1b", "search: type the text, Enter", "text: given up")
        terminal.type("q")
        assert terminal.end() == 0
        check_plain(terminal)


def test_standard_input_is_read_while_keys_come_from_the_terminal(text):
    piped = f"cat {text} | {' '.join(program.PROGRAM)} read - --advance key --echo text"
    with program.Terminal(piped, program=["sh", "-c"]) as terminal:
        terminal.until("text: one two three\r\nh says the keys\r\n")
        assert terminal.settings() != terminal.before
        terminal.type("n")
        terminal.until("line: 2\r\ntext: four five six\r\n")
        terminal.type("q")
        assert terminal.end() == 0
        assert terminal.settings() == terminal.before
        check_plain(terminal)


def test_a_text_is_typed_and_keys_in_pieces_until_the_terminal_goes_away():
    with program.Terminal("read", "-", "--advance", "key", "--echo", "text") as terminal:
        terminal.until("type the text; Ctrl-D on an empty line ends it\r\n")
        terminal.type("one\n\ntwo\n\x04")
        terminal.until("h says the keys")
        terminal.type_apart([b"\xc3", b"\xa9"])
        terminal.until("no command: é; h says the keys")
        for piece in (b"\x1b", b"["):  # as over a slow line
            terminal.type_apart([piece])
            assert terminal.silent(0.1)
        terminal.type_apart([b"B"])
        terminal.until("line: 2\r\ntext: two\r\n")
        terminal.hang_up()
        assert terminal.process.wait(program.PATIENCE_S) == 1


def test_standard_input_is_read_without_a_terminal_too(text):
    with text.open() as stdin:
        done = program.run("read", *FAST, "--echo", "text", "-", "--lines", "2", stdin=stdin)
    assert done.returncode == 0
    assert "four five six\n" in done.stdout
    # It is opened for all commands in one place, and a page needs no device.
    done = program.run("page", "-")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "vbraille: standard input is empty; give a text file\n"


def test_help_says_the_keys_and_how_a_slow_hand_is_called(call):
    done = call("read", "--help")
    assert done.code == 0
    for command in COMMANDS:
        assert re.search(rf"^  \S.*  {re.escape(command.help)}$", done.out, re.MULTILINE)
    assert "slow" in done.out


def test_a_key_brings_the_next_line_and_nothing_else_does(text):
    text.write_text("one\n\ntwo\n\nthree\n")
    options = ("--echo", "text", "--model", "vbd", "--texture", "0")
    with program.Terminal("read", text, *FAST, "--advance", "key", *options) as terminal:
        terminal.until("text: one\r\nh says the keys\r\n")
        assert terminal.silent(1.0)  # the hand is there and back in 0.3 s
        terminal.type("n")
        terminal.until("line: 2\r\ntext: two\r\n")
        terminal.type("\x03")  # Ctrl-C
        assert terminal.end() == 1
        assert terminal.lines.endswith("\r\nvbraille: stopped\r\n")
        assert terminal.settings() == terminal.before
        check_plain(terminal)


def test_at_a_terminal_the_hand_brings_lines_and_the_end_waits_for_keys(text):
    text.write_text("one\n\ntwo\n")
    arguments = ("read", text, "--hand", "sweep:300", "--echo", "text")
    with program.Terminal(*arguments) as terminal:
        said = terminal.until("end of text.*\r\n")
        assert [s for s in said.splitlines() if s.startswith("text")] == [
            "text: one",
            "text: two",
        ]
        terminal.type("w")
        terminal.until("word: none here\r\n")
        terminal.process.send_signal(signal.SIGTERM)
        assert terminal.end() == 1
        assert terminal.settings() == terminal.before
        check_plain(terminal)


@pytest.mark.new_processes
def test_a_log_has_the_lines_of_both_processes_and_nothing_else_does(tmp_path):
    (tmp_path / "text").write_bytes(b"\x1b[31m")  # which moves no cursor either
    log = tmp_path / "log"
    ran = program.run("read", tmp_path / "text", *FAST, "--log", log)
    assert ran.returncode == 0
    assert ran.stdout.startswith("line: 1\ncells: ")
    assert "text: <escape>[31m\n" in ran.stdout
    assert "\x1b" not in ran.stdout + ran.stderr
    assert "vbraille." not in ran.stdout + ran.stderr
    lines = log.read_text().splitlines()
    said = "\n".join(lines)
    assert "vbraille.engine.host: started process" in said
    assert "has ended: exit code 0" in said
    assert "vbraille.devices.registry: opened sim" in said
    assert "ready: " in said
    assert len({line.split()[2] for line in lines}) == 2
