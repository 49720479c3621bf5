"""Analysis: five sittings of 78 strings, every tick of them, read in little time and memory."""

from __future__ import annotations

import resource
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.timing import Result, seconds
from tests.conftest import SEED
from tests.sessions.sittings import Session
from vbraille.analysis.sittings import read_sitting
from vbraille.devices.hand import DEVICE, HumanHand
from vbraille.engine.ring import Flag
from vbraille.sessions.planning.protocol import builtin_text
from vbraille.sessions.record.check import check_folder
from vbraille.sessions.record.folder import versions
from vbraille.sessions.record.journal import Journal
from vbraille.sessions.record.traces import TRACE, TraceWriter

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.sessions.planning.plan import Trial

SITTINGS = 5
TRIAL_S, GAP_S = 12.0, 0.5
TICKS_A_S = 1000
ROUNDS = 5
READ_S, PEAK_MB = 1.8, 500
_NS_A_TICK = 1_000_000_000 // TICKS_A_S
_COUNTS_PER_MM = 200.0  # 5 µm, as the device needs
_WRONG = 0.2  # of the answers


def run() -> Iterator[Result]:
    with tempfile.TemporaryDirectory() as name:
        folders = make_sittings(Path(name))
        yield _read(folders)


def make_sittings(folder: Path, sittings: int = SITTINGS) -> list[Path]:
    """Sessions of `letters` by a slow hand, as big as real ones; their directories."""
    folders = []
    for number in range(1, sittings + 1):
        session = Session(
            folder / f"P{number:02}", builtin_text("letters"), f"P{number:02}", seed=number,
            hand="device",
        )  # fmt: skip
        _sit(session, np.random.default_rng((SEED, number)))
        assert all(finding.good for finding in check_folder(session.folder))
        folders.append(session.folder)
    return folders


def _read(folders: list[Path]) -> Result:
    ticks = 0
    for folder in folders:
        sitting = read_sitting(folder)
        assert not sitting.faults
        assert len(sitting.readings) == len(sitting.rows)
        ticks += len(sitting.rows) * round((TRIAL_S + GAP_S) * TICKS_A_S)
    taken_s = [seconds(lambda: [read_sitting(folder) for folder in folders]) for _ in range(ROUNDS)]
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    best_s = min(taken_s)
    return Result(
        f"reading {len(folders)} sittings of 78 strings, {ticks / 1e6:.1f} million ticks; "
        f"memory of the process that also made them",
        f"≤ {READ_S:g} s, < {PEAK_MB} MB",
        f"{best_s:.2f} s (median {np.median(taken_s):.2f} s), {peak_mb:.0f} MB",
        best_s <= READ_S and peak_mb < PEAK_MB,
    )


def _sit(session: Session, random: np.random.Generator) -> None:
    """Fill a session's journal and trace with what a hand did that took its time."""
    array = session.protocol.model.array
    trace = TraceWriter(session.folder / "trace-001.gz")
    hand = HumanHand(DEVICE, session.plan.seed)
    ticks = 0
    with Journal(session.folder) as journal:

        def log(event: str, trial: Trial | None = None, **fields: object) -> None:
            of = {} if trial is None else {"trial": trial.number}
            at = {"t_s": ticks / TICKS_A_S}
            journal.append({"event": event, **of, **fields, **at}, durable=False)

        log("run", why="start", trace="trace-001.gz", versions=versions())
        for trial in session.plan.trials:
            line = session.protocol.line(trial.stimuli[0].masks)
            end_mm = session.protocol.geometry.extent_mm(len(line)) - array.span_mm / 2
            still = np.full(round(GAP_S * TICKS_A_S), -array.span_mm)
            waiting = _ticks(still, ticks, trial.number - 1, Flag.PAUSED | Flag.RESTING, random)
            ticks += waiting.size
            log("presented", trial, attempt=1, stimulus=0, line=trial.number)
            log("cue", trial)
            motion = hand.read_line(-array.span_mm, end_mm)
            # As it reads, but stretched: all trials are of one length.
            at_s = np.linspace(0.0, motion.duration_s, round(TRIAL_S * TICKS_A_S))
            felt = _ticks(np.interp(at_s, motion.t_s, motion.x_mm), ticks, trial.number, 0, random)
            for part in np.array_split(np.concatenate([waiting, felt]), 25):
                trace.add(part)
            ticks += felt.size
            log("read", trial, attempt=1, stimulus=0)
            wrong = random.random() < _WRONG
            log("answer", trial, attempt=1, answer="?" * 5 if wrong else trial.presented)
        trace.close()
        log("end", why="all trials are done")
        size = (session.folder / "trace-001.gz").stat().st_size
        log("closed", lost=0, counts={}, trace="trace-001.gz", trace_bytes=size)


def _ticks(
    x_mm: NDArray[np.float64], first: int, line: int, flags: int, random: np.random.Generator
) -> NDArray[np.void]:
    """Ticks of a way, woken as late as on a real machine."""
    made = np.zeros(x_mm.size, TRACE)
    made["tick"] = first + np.arange(x_mm.size)
    made["device_ns"] = made["tick"] * _NS_A_TICK
    made["time_ns"] = made["device_ns"] + random.gamma(2.0, 20_000.0, x_mm.size).astype(np.int64)
    made["line"] = line
    made["flags"] = flags
    made["x_mm"] = np.round(x_mm * _COUNTS_PER_MM) / _COUNTS_PER_MM
    speed_mm_s = np.gradient(made["x_mm"]) * TICKS_A_S
    made["speed_mm_s"] = np.convolve(speed_mm_s, np.full(20, 1 / 20), "same")
    made["share"] = 1.0
    return made
