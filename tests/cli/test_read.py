import re
import signal

import pytest

from tests.cli.program import Terminal, run

SUMMARY = re.compile(
    r"summary: lines (\d+), seconds ([\d.]+), mean scanning speed ([\d.]+) mm/s, "
    r"ticks (\d+), late ticks (\d+)\n"
)


@pytest.fixture
def text(tmp_path):
    path = tmp_path / "text"
    path.write_text("go on\n\nso it is\n\nwe do\n")
    return path


def test_without_a_terminal_it_runs_through(text):
    done = run("read", text, "--hand", "sweep:200", "--texture", "0")
    assert (done.returncode, done.stderr) == (0, "line width: 26 cells\n")
    said = done.stdout.splitlines(keepends=True)
    assert said[0::3] == ["line: 1\n", "line: 2\n", "line: 3\n", said[-1]]
    assert said[1] == "cells: ⠀⠀⠛⠀⠕⠝\n"
    assert said[2::3] == ["text: go on\n", "text: so it is\n", "text: we do\n"]
    found = SUMMARY.fullmatch(said[-1])
    assert found
    lines, seconds, speed, ticks, late = map(float, found.groups())
    assert lines == 3
    assert abs(seconds * 1000 - ticks - late) < 100
    assert 100 < speed < 260  # 200, but for what a machine that stalls does not see


@pytest.mark.parametrize(("echo", "labels"), [("none", []), ("text", ["line", "text"])])
def test_echo(text, echo, labels):
    done = run(
        "read", text, "--hand", "sweep:999", "--lines", "1", "--texture", "0", "--echo", echo
    )
    assert [line.split(":")[0] for line in done.stdout.splitlines()] == [*labels, "summary"]


@pytest.mark.parametrize("model", ["stress2", "vbd"])
@pytest.mark.parametrize("hand", ["fluent", "recorded"])
def test_other_hands(text, tmp_path, model, hand):
    if hand == "recorded":
        path = tmp_path / "hand.csv"
        places = [*range(-10, 80, 10), *range(80, -20, -10)]
        path.write_text("".join(f"{n * 0.05},{max(x, -10.8)}\n" for n, x in enumerate(places)))
        hand = f"recorded:{path}"
    done = run("read", text, "--model", model, "--hand", hand, "--lines", "1", "--echo", "none")
    assert done.returncode == 0
    assert SUMMARY.fullmatch(done.stdout.splitlines(keepends=True)[-1])


def test_keys_at_a_terminal(text):
    with Terminal("read", text, "--texture", "0.5", "--advance", "key") as terminal:
        terminal.read_until("h says the keys")
        for keys, answer in (
            ("t", "texture: 0.6"),
            ("T", "texture: 0.5"),
            ("C", "contrast: 0.9"),
            ("c", "contrast: 1"),
            ("w", "word: "),
            (" ", "paused"),
            (" ", "reading"),
            ("p", "first line"),
            (
                "n\x1b[B",
                "",
            ),  # two lines on, and nothing said of them: speech is not to read the book
            ("n", "last line"),
            ("x", "no command: 'x'"),
            ("h", "q: stop reading"),
        ):
            terminal.type(keys)
            if answer:
                shown = terminal.read_until(answer)
                assert "text:" not in shown
                assert "cells:" not in shown
        terminal.type("q")
        terminal.read_until("late ticks")
        assert terminal.process.wait() == 0
        assert "\x1b" not in terminal.shown
        assert "\r" not in terminal.shown.replace("\r\n", "")
        assert terminal.settings() == terminal.before


def test_at_the_end_of_the_text_a_terminal_waits(text):
    with Terminal(
        "read", text, "--lines", "3", "--hand", "sweep:500", "--texture", "0"
    ) as terminal:
        terminal.read_until("end of text")
        terminal.type("q")
        terminal.read_until("summary")
        assert terminal.process.wait() == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_restores_the_terminal(text, number):
    with Terminal("read", text, "--hand", "device") as terminal:
        terminal.read_until("h says the keys")
        terminal.process.send_signal(number)
        assert "Traceback" not in terminal.read_until("vbraille: stopped")
        assert terminal.process.wait() == 1
        assert terminal.settings() == terminal.before
