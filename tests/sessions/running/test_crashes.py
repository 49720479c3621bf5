"""Sessions whose process is killed, whose disk fills, whose file is in use: real processes."""

import random
import re
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.sessions.sittings import MINI, SURE, made

PROGRAM = [sys.executable, "-m", "vbraille", "session"]
FAST = ["--answers", "simulated:0.3", "--fast", "--hand", "sweep:150"]


@pytest.fixture
def started():
    """What starts a command of the program, in a process of its own that ends with the test."""
    processes = []

    def start(*words, stdin=subprocess.DEVNULL, **how):
        process = subprocess.Popen(
            [*PROGRAM, *map(str, words)], stdin=stdin, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, encoding="utf-8", **how,
        )  # fmt: skip
        processes.append(process)
        return process

    yield start
    for process in processes:
        process.kill()
        process.wait()
        for pipe in filter(None, (process.stdin, process.stdout, process.stderr)):
            pipe.close()


def said_of(process, kills_at=None):
    """What a process said until it ended, or was killed at a line."""
    said = []
    for line in process.stdout:
        if line.endswith("\n"):
            said.append(line.rstrip())
        if kills_at is not None and len(said) >= kills_at:
            process.kill()
            break
    said += [line for line in process.stdout.read().splitlines(keepends=True) if line[-1] == "\n"]
    process.wait()
    return [line.rstrip() for line in said]


@pytest.mark.parametrize("seed", [1, 2])
def test_no_answer_is_lost_or_asked_again_however_often_it_is_killed(started, tmp_path, seed):
    rows = MINI.replace('"aa"]', '"aa"]\nrepeats = 3') + SURE
    sat = made(tmp_path, rows, seed=seed)
    draw, told, cues = random.Random(seed), {}, []
    for _ in range(20):
        process = started("resume", sat.session.path, *FAST)
        said = said_of(process, draw.randint(1, 9))
        for line in said:
            if found := re.match(r"answer: (trial \d+) of 9, (.*)", line):
                told[found[1]] = found[2]
            if found := re.match(r"cue: (trial \d+) of", line):
                assert found[1] not in told, "its answer was said to be in, and it is shown again"
                cues.append(found[1])
        if any(event.kind == "end" for event in sat.events):
            break
    kept = {f"trial {e.trial}": e.data["answer"] for e in sat.of("answer")}
    assert set(told) <= set(kept)
    assert sat.of("end")
    order = [event.trial for event in sat.of("answer")]
    assert order == sorted(set(order)) == list(range(1, 10))
    assert len(sat.of("confidence")) == 9


def test_a_killed_host_process_leaves_no_array_moving(started, tmp_path):
    sat = made(tmp_path)
    process = started("resume", sat.session.path, "--answers", "simulated", "--hand", "sweep:20")
    for line in process.stdout:
        if line.startswith("cue: trial 1"):
            break
    children = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True,
                              check=True).stdout.split()  # fmt: skip
    process.kill()
    process.wait()
    end = time.monotonic() + 10
    while any(Path(f"/proc/{child}").exists() for child in children):
        assert time.monotonic() < end, "the process that drives the device goes on alone"
        time.sleep(0.05)


def test_a_signal_ends_it_in_order_and_it_goes_on(started, tmp_path):
    sat = made(tmp_path)
    process = started("resume", sat.session.path, "--answers", "simulated", "--hand", "sweep:40")
    for line in process.stdout:
        if line.startswith("cue: trial 1"):
            process.send_signal(signal.SIGTERM)
            break
    _, err = process.communicate(timeout=30)
    assert process.returncode == 1
    assert err == "vbraille: stopped\n"
    assert sat.sit(answers="simulated").of("end")


def test_a_full_disk_loses_nothing_that_was_said_to_be_in(started, tmp_path):
    sat = made(tmp_path, MINI.replace('"aa"]', '"aa"]\nrepeats = 20'))

    def little_room():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        size = sat.session.path.stat().st_size + 60_000
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    process = started("resume", sat.session.path, *FAST, preexec_fn=little_room)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert err.count("\n") == 1
    said = out.count("\nanswer: ")
    assert 0 < said == len(sat.of("answer"))
    assert sat.sit(answers="simulated").of("end")


def test_a_clock_that_was_set_back_is_said_and_elapsed_times_go_on(tmp_path):
    sat = made(tmp_path).sit(answers=["ac"])
    before = sat.events[-1]
    code = (
        "import sys, vbraille.sessions.session as s\n"
        "from datetime import datetime, timedelta\n"
        "class Early(datetime):\n"
        "    @classmethod\n"
        "    def now(cls, tz=None):\n"
        "        return datetime.now(tz) - timedelta(days=2)\n"
        "s.datetime = Early\n"
        "s.Session(sys.argv[1]).run('simulated', say=print, fast=True)\n"
    )
    told = subprocess.run([sys.executable, "-c", code, str(sat.session.path)],
                          capture_output=True, text=True, check=True).stdout  # fmt: skip
    assert sum(line.startswith("clock: ") for line in told.splitlines()) == 1
    assert all(event.t_s >= before.t_s for event in sat.events if event.n > before.n)
    assert sat.of("end")


def test_a_device_that_is_not_there_leaves_no_file(started, tmp_path):
    protocol = tmp_path / "mini.toml"
    protocol.write_text(MINI)
    process = started("run", protocol, "--participant", "P01", "--device", "serial:/dev/none",
                      "--answers", "simulated", cwd=tmp_path)  # fmt: skip
    _, err = process.communicate(timeout=30)
    assert process.returncode in (1, 2)
    assert err.splitlines()[-1].startswith("vbraille: ")
    assert not list(tmp_path.glob("*.session*"))
