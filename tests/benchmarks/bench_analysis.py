"""Analysis: what a lab has, analysed by the program as it is called."""

from __future__ import annotations

import csv
import os
import subprocess
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.timing import Result, vbraille
from tests.conftest import SEED
from vbraille.sessions.planning.loading import load_protocol
from vbraille.sessions.planning.plan import make_plan
from vbraille.sessions.record import record
from vbraille.sessions.record.ticks import TICK

if TYPE_CHECKING:
    from collections.abc import Iterator

PEOPLE, TRIAL_S, TICKS_A_S = 12, 12.0, 1000
COLUMNS = ("session", "participant", "condition", "trial", "presented", "answered", "duration_s")
TRIALS, TABLE_PEOPLE = 100_000, 20
ROUNDS = 3
WRONG = 0.2


def run() -> Iterator[Result]:
    with tempfile.TemporaryDirectory() as name:
        paths = make_sessions(Path(name))
        what = f"report of {PEOPLE} people, 160 trials of 12 s each at 1 kHz, from their sessions"
        yield _program(what, 4, [*paths, "--out", f"{name}/people-{{number}}"])
        table = Path(name, "trials.csv")
        make_table(table)
        what = f"report of {TRIALS:,} trials of CSV"
        yield _program(what, 8, [table, "--out", f"{name}/table-{{number}}"])


def make_sessions(folder: Path) -> list[Path]:
    """Write sessions of the protocol legibility, as big as real ones."""
    protocol = load_protocol("legibility")
    count = int(TRIAL_S * TICKS_A_S)
    ticks = np.zeros(count, TICK)
    ticks["x_mm"] = 60 * np.sin(np.linspace(0, np.pi, count))
    paths = []
    for number in range(1, PEOPLE + 1):
        plan = make_plan(protocol, f"P{number:02}", number)
        path = folder / f"P{number:02}.session"
        head = {"protocol": protocol.name, "order": 1, "group": "", "session": 1, "fields": {}}
        record.create(path, head, protocol.files, plan)
        _sit(path, plan, ticks, np.random.default_rng((SEED, number)))
        paths.append(path)
    return paths


def _sit(path: Path, plan, ticks, random: np.random.Generator) -> None:
    kept = record.Record(path)
    conditions = {"device": "serial", "hand": "device", "answers": "typed"}
    kept.append("run", 0.0, conditions=conditions, answers="typed", simulated=False, display={})
    trials = [trial for trial in plan.trials if not trial.practice]
    for line, trial in enumerate(trials):
        begun_s = line * TRIAL_S
        kept.append("cue", begun_s, trial, 1, stimulus=0, line=line)
        ticks["line"] = line
        ticks["tick"] = np.arange(ticks.size) + line * ticks.size
        ticks["time_ns"] = ticks["tick"] * 1_000_000
        kept.add_ticks(ticks)
        cells = trial.stimuli[0].cells
        answer = cells if random.random() > WRONG else "⠁" * len(cells)
        kept.append("answer", begun_s + TRIAL_S, trial, 1, answer=answer)
    kept.append("end", TRIAL_S * len(trials), why="done", reason="")
    kept.close()


def make_table(path: Path) -> None:
    """Write a table of letters that were read, as a lab might put many sessions together."""
    random = np.random.default_rng(SEED)
    letters = np.array(list("abcdefghijklmnopqrstuvwxyz"))
    presented = random.choice(letters, (TRIALS, 5))
    read = random.random((TRIALS, 5)) > WRONG
    answered = np.where(read, presented, random.choice(np.append(letters, "?"), (TRIALS, 5)))
    taken_s = random.gamma(4.0, 3.0, TRIALS)
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(COLUMNS)
        for n in range(TRIALS):
            who, number = divmod(n, TRIALS // TABLE_PEOPLE)
            condition = ("T0", "T25", "T100")[int(random.integers(3))]
            cells = ["".join(presented[n]), "".join(answered[n]), f"{taken_s[n]:.3f}"]
            rows.writerow([f"S{who}", f"P{who:02}", condition, number + 1, *cells])


def _program(what: str, most_s: float, arguments: list) -> Result:
    """Run the program as a user does: start, imports and all."""
    taken_s, worked_s = [], []
    for number in range(ROUNDS):
        call = [str(argument).format(number=number) for argument in arguments]
        began_s = time.perf_counter()
        process = subprocess.Popen(vbraille("analyse", *call), stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        taken_s.append(time.perf_counter() - began_s)
        worked_s.append(usage.ru_utime + usage.ru_stime)
        process.returncode = os.waitstatus_to_exitcode(status)
        assert process.returncode == 0
    got = f"{min(taken_s):.1f} s, {min(worked_s):.1f} s of processor time"
    return Result(what, f"≤ {most_s:g} s", got, min(taken_s) <= most_s)
