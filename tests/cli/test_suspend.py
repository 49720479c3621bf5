"""Ctrl-Z and fg, at a shell with job control."""

import json
import os
import shlex
import signal
import time
from pathlib import Path

import numpy as np
import pytest

from tests import drivers
from tests.cli import program
from tests.reading.felt import SCENE
from tests.sessions.sittings import MINI
from tests.tiers import heavy

SHELL = ("bash", "--norc", "--noprofile", "-i")
PROMPT = "prompt> "
STOPPED = r"Stopped[\s\S]*" + PROMPT


@pytest.fixture
def shell():
    with program.Terminal(program=SHELL, PS1=PROMPT, HISTFILE="") as terminal:
        terminal.until(PROMPT)
        yield terminal


def job(shell):
    """Process of the program: the shell's one child."""
    (child,) = (
        Path(f"/proc/{shell.process.pid}/task/{shell.process.pid}/children").read_text().split()
    )
    return int(child)


def until_stopped(shell):
    """Wait until the shell knows that the program is stopped: else its fg would not continue it."""
    end = time.monotonic() + program.PATIENCE_S
    told = ""
    while "Stopped" not in told:
        assert time.monotonic() < end, "the program is not stopped"
        shell.type("jobs\n")
        told = shell.until(r"jobs[\s\S]*" + PROMPT)


def frames(log):
    numbers = np.fromfile(log)
    return numbers[: numbers.size // 60 * 60].reshape(-1, 6, 10)  # the last may be in the writing


def until_frames(log, number, shown):
    """Wait until the last frames are, or are not, of rest."""
    end = time.monotonic() + program.PATIENCE_S
    while (last := frames(log)[-number:].any(axis=(1, 2))).all() != shown or last.any() != shown:
        assert time.monotonic() < end, f"the frames are {last}"
        os.sched_yield()


def test_ctrl_z_rests_the_array_and_fg_gives_the_keys_back(shell, tmp_path, text):
    log = tmp_path / "log"
    drivers.install(tmp_path)
    command = [*program.PROGRAM, "read", text, "--device", f"logged:{log}", "--advance", "key"]
    options = ["--mapping", "sheared", "--texture", "0"]  # its idle rows stand at 1
    words = shlex.join(map(str, [*command, *options]))
    shell.type(f"PYTHONPATH={tmp_path} {words}\n")
    shell.until("h says the keys")
    until_frames(log, 50, True)
    shell.type("\x1a")
    said = shell.until(STOPPED)
    assert "stopped: the array rests; fg goes on\r\n" in said
    assert said.count("\x1b[?2004l") == 1
    until_frames(log, 200, False)  # a host that stopped too would send none
    shell.type("stty -a\n")
    modes = shell.until(PROMPT).split()
    assert {"icanon", "echo"} <= set(modes)
    shell.type("fg\n")
    said = shell.until("reading\r\n")
    assert "\x1b[?2004h" in said
    until_frames(log, 50, True)
    shell.type("n")
    shell.until("line: 2\r\n")

    shell.type(" ")  # what was paused stays so
    shell.until("paused\r\n")
    shell.type("\x1a")
    shell.until(STOPPED)
    shell.type("bg\n")  # it needs the terminal, and the shell has it
    shell.until(r"&[\s\S]*" + PROMPT)
    until_stopped(shell)
    shell.type("fg\n")
    shell.until("paused\r\n")
    shell.type(" ")
    shell.until("reading\r\n")

    os.kill(job(shell), signal.SIGSTOP)  # which no process can catch
    shell.until(STOPPED)
    shell.type("fg\n")
    shell.until("--texture 0")
    shell.type("n")
    shell.until("line: 3\r\n")
    shell.type("q")
    shell.until(r"summary: lines 3,[\s\S]*" + PROMPT)
    assert not frames(log)[-1].any()


@heavy  # with keys it is tested above
def test_without_keys_the_array_rests_too(shell, tmp_path, text):
    log = tmp_path / "log"
    drivers.install(tmp_path)
    command = [*program.PROGRAM, "read", text, "--device", f"logged:{log}"]
    options = ["--mapping", "sheared", "--texture", "0", "--echo", "none", "--lines", "1-2"]
    words = shlex.join(map(str, [*command, *options]))
    shell.type(f"PYTHONPATH={tmp_path} {words} </dev/null\n")
    while not log.exists():
        os.sched_yield()
    until_frames(log, 5, True)
    shell.type("\x1a")
    shell.until(r"stopped: the array rests; fg goes on\r\n[\s\S]*Stopped")
    until_frames(log, 200, False)
    shell.type("fg\n")
    shell.until("reading\r\n")
    shell.until(r"summary: lines 2,")


@heavy  # three programs more, each with a host or a device
@pytest.mark.parametrize(
    ("command", "begun", "again", "key", "said"),
    [
        ("feel house.scene --cues none", "h says the keys", "feeling", "V", "picture: A house"),
        ("tune", "now: 1", "reading", " ", "now: 2"),
        ("device calibrate sim: --model vbd", "actuator 1 ", "actuator 1 ", "n", "actuator 2 "),
    ],
)
def test_whoever_else_is_at_a_device_has_the_keys_back(
    shell, tmp_path, command, begun, again, key, said
):
    """After Ctrl-Z, and after a stop that no process can catch."""
    (tmp_path / "house.scene").write_text(SCENE)
    (tmp_path / "mine.toml").touch()
    shell.type(f"cd {tmp_path}; export VBRAILLE_SETTINGS=mine.toml\n")
    shell.until(PROMPT)
    shell.type(f"{shlex.join(program.PROGRAM)} {command}\n")
    shell.until(begun)
    shell.type("\x1a")
    assert "stopped: the array rests; fg goes on\r\n" in shell.until(STOPPED)
    shell.type("fg\n")
    shell.until(rf"{again}.*\r\n")
    os.kill(job(shell), signal.SIGSTOP)
    shell.until(STOPPED)
    shell.type("fg\n")
    shell.until(command)
    shell.type(key)
    shell.until(rf"{said}.*\r\n")
    shell.type("q")
    shell.until(PROMPT)


def test_a_session_pauses(shell, tmp_path):
    (tmp_path / "mini.toml").write_text(MINI)
    options = ["--participant", "P1", "--seed", "3", "--cues", "none", "--out", tmp_path / "s"]
    command = [*program.PROGRAM, "session", "run", tmp_path / "mini.toml", *options]
    shell.type(f"{shlex.join(map(str, command))}\n")
    shell.until("cue: ")
    shell.type("\x1a")
    said = shell.until(STOPPED)
    assert "pause: the array is at rest; Enter goes on\r\n" in said
    shell.type("fg\n")
    shell.until("session run")
    shell.type("\n")
    shell.until("go: on\r\n")
    shell.type("stop\n")
    shell.until(r"stopped: [\s\S]*" + PROMPT)
    lines = (tmp_path / "s/journal.jsonl").read_text().splitlines()
    told = [json.loads(line)["event"] for line in lines]
    assert [event for event in told if event in ("pause", "go")] == ["pause", "go"]
