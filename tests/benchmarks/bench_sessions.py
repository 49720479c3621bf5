"""Sessions: nothing of them is lost, an answer is on the disk at once, and none takes long."""

from __future__ import annotations

import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import builtin_names, builtin_text, load_protocol
from vbraille.sessions.record.events import Answer, Closed
from vbraille.sessions.record.folder import load
from vbraille.sessions.record.traces import read_trace

from tests.benchmarks.killing import ADAPTIVE, kill_often
from tests.benchmarks.killing import KILLS as KILLED
from tests.benchmarks.timing import Result, seconds, vbraille
from tests.conftest import SEED
from tests.sessions.planning.rulebook import broken_rules

if TYPE_CHECKING:
    from collections.abc import Iterator

KILLS = 300
ANSWERS = 240
LONG_TRIALS, LONG_ANSWERS = 1000, 990
RESUMES = 5
BLOCK_TRIALS = 80
RECORDED_S = 120.0
_PATIENCE_S = 60.0
# Of an event's line in the journal.
_LINE_BYTES = 200

SMALL = """
format = 1
name = "small"
title = "Single characters between delimiters"
source = "ours"
model = "vbd"
[keys]
l = "1"
r = "4"
n = "0"
[design]
kind = "combinations"
characters = ["a", "c", "4", "0"]
length = 1
before = "c"
after = "c"
repeats = {repeats}
[trial]
gap_s = 0.0
"""
PLANNED_SEEDS = 500
# What a resume has to import, and a host to come up with: seconds of each.
_START = """
import time
begun_s = time.perf_counter()
import vbraille.cli.old.commands.session
import vbraille.sessions.running.console, vbraille.sessions.running.runner
import vbraille.sessions.running.presenters
from vbraille.engine.host import Host
from vbraille.render import VBD
imported_s = time.perf_counter()
display = VBD.on(VBD.style.geometry)
with Host("sim:?hand=sweep:150", display, VBD.style.room(display, 4)) as host:
    while not host.poll().size:
        time.sleep(0.001)
    print(imported_s - begun_s, time.perf_counter() - imported_s)
"""


def run() -> Iterator[Result]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for part in (
            _planned,
            _acknowledged,
            _resumed,
            _block,
            _recorded,
            _killed,
            _killed_by_answers,
        ):
            inner = folder / part.__name__
            inner.mkdir()
            yield part(inner)


def _killed(folder: Path, toml: str = KILLED, how: str = "scripted sessions") -> Result:
    tally = kill_often(KILLS, SEED, folder, toml)
    for problem in (*tally.lost, *tally.skipped, *tally.others):
        print(problem, file=sys.stderr)
    return Result(
        f"SIGKILL at {tally.kills} random moments of {tally.sessions} {how}, each "
        f"gone on with to its end, seed {SEED}: acknowledged answers lost or asked again, trials "
        f"skipped, other faults",
        "0, 0, 0",
        f"{len(tally.lost)}, {len(tally.skipped)}, {len(tally.others)} "
        f"({tally.acknowledged} acknowledged answers; {tally.starting} kills in the start, "
        f"{tally.torn} torn lines, up to {tally.most_attempts} attempts)",
        not (tally.lost or tally.skipped or tally.others),
    )


def _killed_by_answers(folder: Path) -> Result:
    return _killed(folder, ADAPTIVE, "scripted sessions whose trials QUEST+ chooses")


def _planned(_: Path) -> Result:
    broken, plans, alike = 0, 0, 0
    for name in builtin_names():
        protocol = load_protocol(name)
        seen = set()
        for seed in range(PLANNED_SEEDS):
            broken += bool(broken_rules(protocol, f"P{seed % 20:02}", seed))
            seen.add(make_plan(protocol, f"P{seed % 20:02}", seed).trials)
        plans += PLANNED_SEEDS
        alike += PLANNED_SEEDS - len(seen)
    return Result(
        f"plans of all protocols, {PLANNED_SEEDS} seeds each: breaking a rule, alike",
        "0, 0",
        f"{broken}, {alike} (of {plans} plans)",
        not (broken or alike),
    )


def _acknowledged(folder: Path) -> Result:
    protocol = _protocol(folder, ANSWERS)
    session = folder / "session"
    ours, bare = [], []
    command = vbraille("session", "run", *_who(protocol, session), "--hand", "sweep:150")
    with subprocess.Popen(
        [*command, "--cues", "none"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        bufsize=1,
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        _until(process, "ready:")
        with (session / "bare").open("ab", buffering=0) as file:
            for _ in range(ANSWERS):
                _until(process, "read:")
                begun_s = time.perf_counter()
                process.stdin.write("l\n")
                _until(process, "answer:")
                ours.append(time.perf_counter() - begun_s)
                bare.append(seconds(lambda: _append(file.fileno())))
        process.stdin.close()
        assert not process.wait(_PATIENCE_S)
    (our_median, our_high), (median, high) = (
        np.percentile(np.array(taken) * 1e3, (50, 99)) for taken in (ours, bare)
    )
    return Result(
        f"key to acknowledged, {len(ours)} answers, beside a bare fsync in the same run, p99",
        "≤ 50 ms above",
        f"{our_high - high:.1f} ms above (p50 and p99: {our_median:.1f} and {our_high:.1f} ms, "
        f"bare {median:.1f} and {high:.1f} ms)",
        our_high - high <= 50,
    )


def _append(descriptor: int) -> None:
    os.write(descriptor, bytes(_LINE_BYTES))
    os.fsync(descriptor)


def _resumed(folder: Path) -> Result:
    protocol = _protocol(folder, LONG_TRIALS)
    answers = folder / "answers.txt"
    third = "l\n" * (LONG_ANSWERS // 3)
    answers.write_text(f"{third}stop\n{third}stop\n{third}stop\n")
    session = folder / "session"
    arguments = [*_who(protocol, session), "--answers", str(answers), "--hand", "sweep:150"]
    subprocess.run(
        vbraille("session", "run", *arguments, "--fast"), check=True, stdout=subprocess.PIPE
    )
    for _ in range(2):
        resume = vbraille("session", "resume", str(session))
        subprocess.run(resume, check=True, stdout=subprocess.PIPE)
    few = folder / "few"
    begin = vbraille("session", "run", *_who(_protocol(folder, 12), few), "--cues", "none")
    taken, new, started = [], [], []
    for number in range(RESUMES):
        copy = folder / f"copy-{number}"
        shutil.copytree(session, copy)
        resume = vbraille("session", "resume", str(copy), "--answers", "typed", "--cues", "none")
        taken.append(_ready_s(resume, f"ready: trial {LONG_ANSWERS + 1} of {LONG_TRIALS}"))
        new.append(_ready_s(begin, "ready: trial 1 of 12"))
        shutil.rmtree(few)
        said = subprocess.run([sys.executable, "-c", _START], check=True, stdout=subprocess.PIPE)
        started.append([float(part) for part in said.stdout.split()])
    version = statistics.median(
        seconds(lambda: subprocess.run(vbraille("--version"), check=True, stdout=subprocess.PIPE))
        for _ in range(RESUMES)
    )
    imports, host = map(statistics.median, zip(*started, strict=True))
    return Result(
        f"resume of a session of {LONG_TRIALS} trials, {LONG_ANSWERS} answered, to its first "
        f"ready, median of {RESUMES}",
        "≤ 1.0 s",
        f"{statistics.median(taken):.2f} s (best {min(taken):.2f} s; a new session of 12 trials "
        f"{statistics.median(new):.2f} s; vbraille --version {version:.2f} s, imports "
        f"{imports:.2f} s, the host's start {host:.2f} s)",
        statistics.median(taken) <= 1.0,
    )


def _ready_s(command: list[str], line: str) -> float:
    """Time from the start of the program to this line; it is stopped then."""
    begun_s = time.perf_counter()
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdin is not None
        _until(process, line)
        taken_s = time.perf_counter() - begun_s
        process.stdin.close()  # no answers come any more: it stops
        assert not process.wait(_PATIENCE_S)
    return taken_s


def _block(folder: Path) -> Result:
    arguments = ["legibility", "--participant", "P1", "--seed", "1", "--hand", "device"]
    arguments += ["--answers", "simulated", "--fast", "--out", str(folder / "session")]
    begun_s = time.perf_counter()
    with subprocess.Popen(
        vbraille("session", "run", *arguments), stdout=subprocess.PIPE, text=True
    ) as process:
        _until(process, f"answer: trial {BLOCK_TRIALS} of")
        taken_s = time.perf_counter() - begun_s
        process.kill()
    return Result(
        f"{BLOCK_TRIALS} trials of legibility, fast, with the hand `device`",
        "< 30 s",
        f"{taken_s:.1f} s",
        taken_s < 30,
    )


def _recorded(folder: Path) -> Result:
    protocol = folder / "limited.toml"
    limited = re.sub(
        r"^\[session\]$", f"[session]\nlimit_s = {RECORDED_S:g}", builtin_text("legibility"),
        flags=re.MULTILINE,
    )  # fmt: skip
    protocol.write_text(limited)
    session = folder / "session"
    arguments = [*_who(protocol, session), "--hand", "device", "--answers", "simulated"]
    subprocess.run(vbraille("session", "run", *arguments), check=True, stdout=subprocess.PIPE)
    events = load(session).journal.events
    closed = events[-1]
    assert isinstance(closed, Closed)
    trace = read_trace(session / "trace-001.gz")
    assert trace.damage is None
    ticks = trace.ticks["tick"]
    missing = int(ticks[0] + (np.diff(ticks) - 1).sum())
    late = int(trace.ticks["late"][-1])
    trials = sum(isinstance(event, Answer) for event in events)
    return Result(
        f"ticks missing from the trace while recording {trials} trials at 1 kHz for "
        f"{RECORDED_S:g} s, beyond the engine's own late ticks; lost, as the journal says",
        "0, 0",
        f"{missing}, {closed['lost']} ({ticks.size} ticks; {late} deadlines late)",
        not missing and not closed.lost and ticks.size > 0.9 * RECORDED_S * 1000,
    )


def _protocol(folder: Path, trials: int) -> Path:
    path = folder / f"small-{trials}.toml"
    path.write_text(SMALL.format(repeats=trials // 4))
    return path


def _who(protocol: Path, session: Path) -> list[str]:
    return [str(protocol), "--participant", "P1", "--seed", "1", "--out", str(session)]


def _until(process: subprocess.Popen, start: str) -> str:
    """Read what a program says, to a line that starts so."""
    assert process.stdout is not None
    for line in process.stdout:
        if line.startswith(start):
            return line
    raise AssertionError(f"{start!r} was not said")
