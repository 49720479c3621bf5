"""Analysis: what a lab has, analysed by the program as it is called."""

from __future__ import annotations

import csv
import os
import subprocess
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tests.benchmarks.timing import Result, vbraille
from tests.conftest import SEED
from tests.sessions.sittings import Session
from vbraille.engine.record import Flag
from vbraille.sessions.planning.plan import stimulus_to_json
from vbraille.sessions.planning.protocolfiles import builtin_text
from vbraille.sessions.record import events
from vbraille.sessions.record.folder import check_folder, versions
from vbraille.sessions.record.journal import Journal
from vbraille.sessions.record.traces import TRACE, TraceWriter
from vbraille.simulation.hand import DEVICE, HumanHand

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.sessions.planning.stimuli import Trial

SITTINGS, PEOPLE = 5, 12
TRIAL_S, GAP_S = 12.0, 0.5
TICKS_A_S = 1000
ROUNDS = 5
TABLE_COLUMNS = (
    "session", "participant", "condition", "block", "trial", "presented", "answered",
    "duration_s", "note",
)  # fmt: skip
TABLE_TRIALS, TABLE_PEOPLE = 100_000, 20
_NS_A_TICK = 1_000_000_000 // TICKS_A_S
_COUNTS_PER_MM = 200.0  # 5 µm, as the device needs
_WRONG = 0.2  # of the answers


def run() -> Iterator[Result]:
    with tempfile.TemporaryDirectory() as name:
        folders = make_sittings(Path(name))
        whole = "analyse of five sessions of 78 trials of 12 s at 1 kHz"
        yield _program(f"{whole}, all numbers as JSON", "≤ 5 s", 5, None, [*folders, "--json"])
        report = Path(name, "report-{number}")
        yield _program(f"{whole}, with the report", "≤ 20 s", 20, None, [*folders, "--out", report])
        folders = make_sittings(Path(name, "legibility"), PEOPLE, "legibility")
        report = Path(name, "report-of-people-{number}")
        yield _program(
            f"report of {PEOPLE} people, 160 trials of 12 s each at 1 kHz, from their sessions",
            "≤ 6 s", 6, None, [*folders, "--out", report],
        )  # fmt: skip
        table = Path(name, "trials.csv")
        make_table(table)
        yield _program(
            f"analyse of {TABLE_TRIALS:,} trials of CSV", "≤ 10 s, ≤ 500 MB", 10, 500,
            [table, "--json"],
        )  # fmt: skip
        report = Path(name, "report-of-table-{number}")
        yield _program(
            f"analyse of {TABLE_TRIALS:,} trials of CSV, with the report", "≤ 20 s, ≤ 500 MB", 20,
            500, [table, "--out", report],
        )  # fmt: skip


def make_sittings(folder: Path, sittings: int = SITTINGS, protocol: str = "letters") -> list[Path]:
    """Sessions of a protocol by a slow hand, as big as real ones; their directories."""
    folders = []
    for number in range(1, sittings + 1):
        session = Session(
            folder / f"P{number:02}", builtin_text(protocol), f"P{number:02}", seed=number,
            hand="device",
        )  # fmt: skip
        _sit(session, np.random.default_rng((SEED, number)))
        assert all(finding.good for finding in check_folder(session.folder))
        folders.append(session.folder)
    return folders


def make_table(path: Path, trials: int = TABLE_TRIALS) -> None:
    """A CSV file of letters that were read, as a lab might put many sessions together."""
    random = np.random.default_rng(SEED)
    letters = np.array(list("abcdefghijklmnopqrstuvwxyz"))
    presented = random.choice(letters, (trials, 5))
    read = random.random((trials, 5)) > _WRONG
    answered = np.where(read, presented, random.choice(np.append(letters, "?"), (trials, 5)))
    taken_s = random.gamma(4.0, 3.0, trials)
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(TABLE_COLUMNS)
        for n in range(trials):
            who, number = divmod(n, trials // TABLE_PEOPLE)
            condition = ("T0", "T25", "T100")[int(random.integers(3))]
            rows.writerow(
                [f"S{who}", f"P{who:02}", condition, 1 + number // 39, number + 1,
                 "".join(presented[n]), "".join(answered[n]), f"{taken_s[n]:.3f}", ""]
            )  # fmt: skip


def _program(what: str, bar: str, most_s: float, most_mb: int | None, arguments: list) -> Result:
    """Run the program as a user does: start, imports and all."""
    taken_s, worked_s, peak_mb = [], [], 0.0
    for number in range(ROUNDS):
        call = [str(argument).format(number=number) for argument in arguments]
        began_s = time.perf_counter()
        process = subprocess.Popen(vbraille("analyse", *call), stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        taken_s.append(time.perf_counter() - began_s)
        worked_s.append(usage.ru_utime + usage.ru_stime)
        process.returncode = os.waitstatus_to_exitcode(status)
        assert process.returncode == 0
        peak_mb = max(peak_mb, usage.ru_maxrss / 1024)
    best_s = min(taken_s)
    good = best_s <= most_s and (most_mb is None or peak_mb <= most_mb)
    got = (
        f"{np.median(taken_s):.1f} s (best {best_s:.1f} s), {min(worked_s):.1f} s of processor "
        f"time, {peak_mb:.0f} MB"
    )
    return Result(what, bar, got, good)


def _sit(session: Session, random: np.random.Generator) -> None:
    """Fill a session's journal and trace with what a hand did that took its time."""
    array = session.protocol.model.display
    hand = HumanHand(DEVICE, session.plan.seed)
    ticks = 0
    with Journal(session.folder) as journal:
        trace = TraceWriter(session.folder / "trace-001.gz", tie=lambda: journal.durable)

        def log(kind: type[events.JournalEvent], trial: Trial | None = None, **fields: Any) -> None:
            of = {} if trial is None else {"trial": trial.number}
            journal.append(kind(**of, **fields, t_s=ticks / TICKS_A_S))

        log(events.Run, why="start", trace="trace-001.gz", versions=versions())
        for trial in session.plan.trials:
            line = session.protocol.line(trial.stimuli[0].masks)
            middle_mm = array.span_mm / 2  # of the array, right of the left column that hands move
            end_mm = session.protocol.geometry.extent_mm(len(line)) - middle_mm
            still = np.full(round(GAP_S * TICKS_A_S), -middle_mm)
            waiting = _ticks(still, ticks, trial.number - 1, Flag.PAUSED | Flag.RESTING, random)
            ticks += waiting.size
            shown = stimulus_to_json(trial.stimuli[0])
            log(events.Presented, trial, attempt=1, stimulus=0, line=trial.number, shown=shown)
            log(events.Cue, trial)
            motion = hand.read_line(-array.span_mm, end_mm)
            # As it reads, but stretched: all trials are of one length.
            at_s = np.linspace(0.0, motion.duration_s, round(TRIAL_S * TICKS_A_S))
            x_mm = np.interp(at_s, motion.t_s, motion.x_mm) + middle_mm
            felt = _ticks(x_mm, ticks, trial.number, 0, random)
            for part in np.array_split(np.concatenate([waiting, felt]), 25):
                trace.add(part)
            ticks += felt.size
            log(events.Read, trial, attempt=1, stimulus=0)
            wrong = random.random() < _WRONG
            log(events.Answer, trial, attempt=1, answer="?" * 5 if wrong else trial.presented)
        trace.close()
        log(events.End, why="all trials are done")
        log(events.Closed, lost=0, counts={}, **trace.closed())


def _ticks(
    x_mm: NDArray[np.float64], first: int, line: int, flags: int, random: np.random.Generator
) -> NDArray[np.void]:
    """Ticks of a way of the array's centre, woken as late as on a real machine."""
    made = np.zeros(x_mm.size, TRACE)
    made["tick"] = first + np.arange(x_mm.size)
    made["device_ns"] = made["tick"] * _NS_A_TICK
    made["time_ns"] = made["device_ns"] + random.gamma(2.0, 20_000.0, x_mm.size).astype(np.int64)
    made["line"] = line
    made["flags"] = flags
    made["x_mm"] = np.round(x_mm * _COUNTS_PER_MM) / _COUNTS_PER_MM
    velocity_mm_s = np.gradient(made["x_mm"]) * TICKS_A_S
    made["vx_mm_s"] = np.convolve(velocity_mm_s, np.full(20, 1 / 20), "same")
    made["share"] = 1.0
    return made
