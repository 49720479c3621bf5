"""``vbraille read --monitor``: pages watch, are the hand, and turn the knobs of a real reading."""

import os
import re
import signal
import subprocess
import sys
from contextlib import contextmanager

import pytest

from tests.cli import program
from tests.cli.test_read import SUMMARY
from tests.cli.test_read_serial import host_of
from tests.cli.watcher import ADDRESS, Watcher
from tests.tiers import heavy


@contextmanager
def reading(*arguments):
    """A reading, which does not outlast the test."""
    with program.start("read", *arguments, "--no-places") as process:
        try:
            yield process
        finally:
            process.kill()


def until_address(process):
    """What the program prints until it has said the address of its live view."""
    printed = ""
    while "live view: " not in printed:
        line = process.stdout.readline().decode()
        assert line, f"it has ended after {printed!r}"
        printed += line
    return printed


def test_a_page_is_the_hand_of_a_reading_and_turns_its_knobs(text):
    options = ("--monitor", "--hand", "still", "--echo", "text")
    with reading(text, *options) as process:
        with Watcher(until_address(process)) as page:
            assert page.welcome["steers"]
            page.until(lambda header, state: state["number"] > 0 and header["line"] == 1)
            assert page.state["title"] == "text.txt"
            assert page.state["simulated"]
            header = page.hold(40.0)
            assert header["rows"] == 6
            page.until(lambda _, state: state["held"])
            page.ask(ask="turn", knob="texture", value=0.5)
            page.until(lambda _, state: state["knobs"][0]["value"] == 0.5)
            page.ask(ask="press", command="UNDO")
            page.until(lambda _, state: state["knobs"][0]["value"] == 1.0)
            page.read_line(1)
            page.until(lambda _, state: state["place"].startswith("line 2"))
            under = [line["text"] for line in page.state["lines"] if line["under"]]
            assert [line.strip() for line in under] == ["four five six"]
            page.ask(ask="let-go")  # a still hand stays, and is waited for
            page.until(lambda _, state: not state["held"])
            page.read_line(2)
            page.until(lambda header, _: header["line"] == 3)
            page.ask(ask="point", x_mm=290.0)
            page.until(lambda header, _: header["x_mm"] > 289)
            page.ask(ask="point", x_mm=-5.4)
            said = process.stdout.read().decode()
        assert process.wait(program.PATIENCE_S) == 0
        assert process.stderr.read() == program.line_width(26).encode()
    for sentence in (
        "hand: moved in the live view",
        "texture: 0.5",
        "undo: texture 1",
        "line: 2",
        "hand: simulated again",
        "line: 3",
    ):
        assert sentence in said.splitlines()
    assert re.search(SUMMARY, said)
    assert "waiting" not in said
    assert "speed:" not in said


@heavy  # a host is started twice
def test_when_the_host_dies_pages_are_told_and_see_the_next_one(text):
    options = ("--monitor", "--hand", "still", "--no-places", "--cues", "none")
    with program.Terminal("read", text, *options) as terminal:
        printed = terminal.until(ADDRESS + r"\s")
        with Watcher(printed) as page:
            page.hold(30.0)
            os.kill(host_of(terminal), signal.SIGKILL)
            terminal.until("fault: .*space begins again")
            page.ask(ask="press", command="LNDN")
            page.ask(ask="next")
            terminal.type(" ")
            terminal.until("reading")
            page.until(lambda _, state: state["device"] == "reading")
            header = page.until(lambda now, _: now["line"] > 0 and now["x_mm"] > 29)
            assert header["line"] == 1  # what was asked for meanwhile was not done
            page.ask(ask="press", command="LNDN")
            terminal.until("line: 2|hand: moved")
            page.until(lambda header, _: header["line"] == 2)
            terminal.type("q")
            assert terminal.end() == 0


@heavy  # a whole reading
def test_let_go_a_hand_that_reads_goes_on_to_the_end(text):
    options = ("--monitor", "--hand", "sweep:300", "--echo", "none")
    with reading(text, *options) as process:
        with Watcher(until_address(process)) as page:
            page.hold(-2.0)
            page.hold(20.0)
            page.ask(ask="let-go")
            said = process.stdout.read().decode()
        assert process.wait(program.PATIENCE_S) == 0
    assert "hand: simulated again" in said
    assert re.search(SUMMARY, said)[1] == "3"


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ("--port 80", "--port is for the live view; add --monitor, or leave --port out"),
        ("--host ::1", "--host is for the live view; add --monitor, or leave --host out"),
        (
            "--monitor --port 65536",
            "--port is 65536; it must be 0 to 65535",
        ),
        ("--monitor --port -1", "--port is -1; it must be 0 to 65535"),
        ("--hand still", "a still hand moves only in the live view; add --monitor where there is"),
        ("--device serial:/dev/none --hand still --monitor", "--hand is for the simulated device"),
    ],
)
def test_options_that_cannot_be_are_refused_before_anything_is_opened(
    call, text, options, sentence
):
    done = call("read", text, *options.split())
    assert done.code == 2
    assert done.err.startswith(f"vbraille: {sentence}")
    assert done.err.count("\n") == 1


def test_a_reading_without_a_live_view_loads_nothing_of_it():
    code = "import sys, vbraille.cli.old.commands.read; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True).stdout
    names = set(loaded.decode().split())
    assert "vbraille.reading.reader" in names
    assert (
        not {"websockets", "PIL", "asyncio", "vbraille.live", "vbraille.reading.liveview"} & names
    )
