"""Sessions: nothing of them is lost, an answer is on the disk at once, and none takes long."""

from __future__ import annotations

import os
import random
import re
import select
import signal
import statistics
import subprocess
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from tests.benchmarks.timing import Result, seconds, vbraille
from tests.conftest import SEED
from vbraille.errors import InputError
from vbraille.sessions.planning.loading import load_protocol, shipped
from vbraille.sessions.planning.plan import make_plan
from vbraille.sessions.record import checking, record
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.trials import protocol_of
from vbraille.sessions.session import Session

if TYPE_CHECKING:
    from collections.abc import Iterator

KILLS, LONGEST_S = 300, 0.6
ANSWERS, PACED_ANSWERS, LONG, VIEWED = 200, 20, 1000, 100_000
PLANNED_SEEDS = 1000
HEAD = 'name = "small"\ntitle = "Small"\nmodel = "vbd"\n[trial]\ngap_s = 0.0\n'
LIST = '[design]\nkind = "list"\nstrings = ["ac", "ca", "aa", "cc"]\nblocks = 1\nrepeats = {}\n'
SURE = '[question]\nkind = "detect"\nconfidence = {{ least = 1, most = 4 }}\n'
QUEST = (
    '[procedure]\nkind = "quest"\nparameter = "contrast"\nleast = 0.0\nmost = 1.0\nstep = 0.1\n'
    "spread = [0.05, 0.2]\ntrials = 12\n"
)
FAST = {"fast": True, "hand": "sweep:150"}


def run() -> Iterator[Result]:
    with tempfile.TemporaryDirectory() as name:
        for part in (_killed, _confirmed, _long, _viewed):
            folder = Path(name, part.__name__)
            folder.mkdir()
            yield from part(folder)
    yield _planned()


def made(folder: Path, protocol: str, repeats: int, seed: int = 1) -> Session:
    path = folder / "small.toml"
    path.write_text(HEAD + protocol.format(repeats))
    return Session.create(path, "P01", path=folder / f"{seed}.session", seed=seed)


def _killed(folder: Path) -> Iterator[Result]:
    """Kill forks of this process, which has loaded all, and go on with their sessions."""
    made(folder, LIST, 1, 10_000).run("simulated", **FAST)
    draw, kills, sessions = random.Random(SEED), 0, 0
    lost = again = order = damaged = stuck = said_in_all = 0
    while kills < KILLS:
        sessions += 1
        session = made(folder, LIST + (SURE, QUEST)[sessions % 2], 5, sessions)
        said: set[str] = set()
        for _ in range(200):
            lines, code, was_killed = _until_killed(session, draw.uniform(0, LONGEST_S))
            kills += was_killed
            for line in lines:
                if found := re.match(r"(answer|cue): (trial \d+) of", line):
                    again += found[2] in said
                    if found[1] == "answer":
                        said.add(found[2])
            events = session.content.events
            kept = {f"trial {event.trial}" for event in events if event.kind == "answer"}
            lost += len(said - kept)
            damaged += bool(checking.check(session.path))
            if any(event.kind == "end" for event in events):
                break
            stuck += code not in (0, -signal.SIGKILL)
        else:
            stuck += 1
        answered = [event.trial or 0 for event in session.content.events if event.kind == "answer"]
        order += answered != sorted(set(answered))
        said_in_all += len(said)
    yield Result(
        f"SIGKILL at {kills} random moments of {sessions} sessions (confidences; QUEST+), each "
        f"gone on with to its end, seed {SEED}: answers said to be in and lost, asked again, out "
        f"of order, damaged files, sessions that do not go on",
        "0, 0, 0, 0, 0",
        f"{lost}, {again}, {order}, {damaged}, {stuck} (of {said_in_all} answers)",
        not (lost or again or order or damaged or stuck),
    )


def _until_killed(session: Session, after_s: float) -> tuple[list[str], int, bool]:
    """Go on with a session in a fork, which is killed after some time."""
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        os.close(reading)
        try:
            session.run("simulated:0.2", say=lambda s: os.write(writing, f"{s}\n".encode()), **FAST)
            os._exit(0)
        finally:
            os._exit(1)
    os.close(writing)
    end, said = time.monotonic() + after_s, b""
    while (left := end - time.monotonic()) > 0 and select.select([reading], [], [], left)[0]:
        part = os.read(reading, 1 << 16)
        said += part
        if not part:
            break
    os.kill(child, signal.SIGKILL)
    while part := os.read(reading, 1 << 16):
        said += part
    os.close(reading)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return said.decode().split("\n")[:-1], code, code == -signal.SIGKILL


def _confirmed(folder: Path) -> Iterator[Result]:
    """Answer sessions in real time: take the time to each confirmation, and the size of ticks."""
    session, taken = _answered(folder, ANSWERS, "sweep:1000")
    middle, high = statistics.median(taken), statistics.quantiles(taken, n=100)[-1]
    yield Result(
        f"from a typed answer to its confirmation, which is on the disk, {len(taken)} answers in "
        f"real time: p50, p99",
        "<= 5, <= 40 ms",
        f"{middle:.1f}, {high:.1f} ms",
        middle <= 5 and high <= 40,
    )
    yield _size(session, "ticks on the disk, of a hand of 1,000 mm/s, which is mostly in fades")
    session, _ = _answered(folder, PACED_ANSWERS, "sweep:70", seed=2)
    yield _size(session, "ticks on the disk, of a hand of 70 mm/s")


def _answered(folder: Path, answers: int, hand: str, seed: int = 1) -> tuple[Session, list[float]]:
    """Answer a session in real time, through pipes; the times to the confirmations, in ms."""
    session = made(folder, LIST, answers // 4, seed)
    command = vbraille("session", "resume", str(session.path), "--hand", hand)
    how = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "bufsize": 1}
    taken, began = [], 0.0
    with subprocess.Popen([*command, "--answers", "typed", "--cues", "none"], **how) as process:
        for line in process.stdout:
            if line.startswith(("read:", "last:")):
                process.stdin.write("ac\n" if line.startswith("read:") else "\n")
                process.stdin.flush()
                began = time.perf_counter()
            elif line.startswith("answer:"):
                taken.append(1e3 * (time.perf_counter() - began))
    return session, taken


def _size(session: Session, what: str) -> Result:
    with record.reading(session.path) as db:
        size, count = db.execute("SELECT sum(length(fields)), sum(count) FROM ticks").fetchone()
    return Result(what, "<= 18 B", f"{size / count:.1f} B", size / count <= 18)


def _long(folder: Path) -> Iterator[Result]:
    session = made(folder, LIST, LONG // 4)
    session.run("simulated", fast=True, hand="sweep:1000")
    path = session.path

    def resume() -> None:
        content = record.read(path)
        protocol = protocol_of(content)
        assert Progress(protocol, content.plan, content.events).next_trial is None

    for what, call, bar in (
        ("read a session of 1,000 trials to go on with it", resume, 0.3),
        ("session check of it", lambda: checking.check(path), 0.5),
    ):
        took = min(seconds(call) for _ in range(3))
        yield Result(what, f"<= {bar} s", f"{took:.2f} s", took <= bar)


def _viewed(folder: Path) -> Iterator[Result]:
    session = made(folder, LIST, 1)
    rows, answer = range(5, VIEWED + 1), '{"answer": "a"}'
    with record.connect(session.path, "rw") as db:
        columns = ", ".join(name for _, name, *_ in db.execute("PRAGMA table_info(trial)"))
        copied = columns.replace("number", "?", 1)
        first = "FROM trial WHERE practice = 0 AND number = 1"
        copy = f"INSERT INTO trial ({columns}) SELECT {copied} {first}"
        db.execute("BEGIN")
        db.executemany(copy, ((number,) for number in rows))
        db.executemany(
            "INSERT INTO event VALUES (?, 'answer', 0.0, '', 0, ?, 1, ?, x'00')",
            ((n + 1, n, answer) for n in range(1, VIEWED + 1)),
        )
        db.execute("COMMIT")

    def look() -> None:
        with record.reading(session.path) as db:
            assert len(db.execute("SELECT * FROM answers").fetchall()) == VIEWED

    took = seconds(look)
    yield Result("the view answers of 100,000 trials", "<= 1 s", f"{took:.2f} s", took <= 1)


def _planned() -> Result:
    """Plan all protocols that come with the program; their rules are held by tests of plans."""
    names, refused = shipped(), 0
    for name in names:
        protocol = load_protocol(name)
        for seed in range(PLANNED_SEEDS):
            try:
                make_plan(protocol, f"P{seed % 20 + 1:02}", seed)
            except InputError:
                refused += 1
    what = f"plans of all {len(names)} protocols, {PLANNED_SEEDS} seeds each, that are refused"
    return Result(what, "0", f"{refused}", refused == 0)
