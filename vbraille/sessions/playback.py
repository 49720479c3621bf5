"""A session played back: its frames made again from the traces, and its journal beside them."""

from __future__ import annotations

import fcntl
import os
from bisect import bisect_right
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Final

import numpy as np
from msgspec import structs

from vbraille.braille.spelling import to_braille
from vbraille.errors import InputError, VbrailleError
from vbraille.live.messages import PlayedEvent, ViewState
from vbraille.live.states import array_shown, cells_shown, geometry_shown, rows_shown
from vbraille.playback.recorded import PLAYED, Piece, Playback
from vbraille.render import work
from vbraille.render.program import Program, nothing
from vbraille.sessions.record import events, journal
from vbraille.sessions.record.bids import runs_of
from vbraille.sessions.record.folder import load
from vbraille.sessions.record.progress import stimulus_of
from vbraille.sessions.record.replay import Replay, StimulusPrograms
from vbraille.sessions.record.traces import ChunkedTrace

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from numpy.typing import NDArray

    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.bids import BidsRun
    from vbraille.sessions.record.events import JournalEvent
    from vbraille.sessions.record.folder import Record
    from vbraille.sessions.record.progress import Progress

# A fade is over long before so many chunks; a trace that says otherwise is not believed.
_MOST_BEFORE: Final = 8


@dataclass(frozen=True, slots=True, eq=False)
class _PlayedRun:
    """A trace, and where it stands in the recording.

    Parameters
    ----------
    trace
        The trace.
    first
        Number of its first chunk in the recording.
    first_ns
        Time of its first tick, by the host's clock.
    begun_s
        Time of its first tick, in seconds from the start of the recording.
    """

    trace: ChunkedTrace
    first: int
    first_ns: int
    begun_s: float

    @property
    def stop(self) -> int:
        """Number of the chunk after its last one."""
        return self.first + len(self.trace)

    def seconds(self, time_ns: NDArray[np.int64]) -> NDArray[np.float64]:
        """Times of ticks in seconds from the start of the recording."""
        return self.begun_s + (time_ns - self.first_ns) / 1e9


def open_session(path: Path) -> Playback:
    """Open a session's directory, or one of its traces."""
    found = SessionRecording(path) if path.is_dir() else SessionRecording(path.parent, path.name)
    found.locate(0.0)
    return found


class SessionRecording(Playback):
    """Frames of a session, or of one of its traces.

    Parameters
    ----------
    folder
        The session's directory.
    trace
        Name of the trace that is played alone; all of them if it is empty.

    Raises
    ------
    InputError
        If it is no session, it runs, it is of another format, or has no frame.
    VbrailleError
        If it cannot be read, or is damaged beyond use.
    """

    def __init__(self, folder: Path, trace: str = "") -> None:
        super().__init__()
        record = load(folder, salvaged=True)
        _refuse_running(folder)
        self._record = record
        self._progress = record.progress()
        self._display = record.protocol.model.display
        self._pictures = StimulusPrograms(record, self._progress)
        self._picture = lru_cache(64)(self._make_picture)
        self.moments: list[PlayedEvent] = []
        if record.journal.damage is not None:
            self.notes.append(
                f"{journal.NAME} is damaged: {record.journal.damage}; the rest is played"
            )
        if not self._progress.ended:
            self.notes.append(
                "the session is not ended; a participant who goes on with it should not see this"
            )
        self._runs: list[_PlayedRun] = []
        runs = [run for run in runs_of(record) if not trace or run.event.trace == trace]
        if trace and not runs:
            raise InputError(
                f"{folder / trace} is no trace that the session's journal names; give {folder}"
            )
        self._end_s = 0.0  # of the run before
        for run in runs:
            self._add(run, alone=bool(trace))
        if not self._runs:
            raise InputError(_no_frames(folder, record))
        self.pieces = self._runs[-1].stop
        self.moments.sort(key=lambda moment: moment.at_s)
        self.length_s = max([self._end_s, *(moment.at_s for moment in self.moments)])

    def first_s(self, number: int) -> float:
        """Time of the first tick of a piece, or of the last whole one before a damaged one."""
        run = self._run(number)
        for chunk in range(number - run.first, -1, -1):
            ticks = run.trace.ticks(chunk)
            if ticks.size:
                return float(run.seconds(ticks["time_ns"][:1])[0])
        return run.begun_s

    def read(self, number: int) -> Piece:
        """Make the frames of a chunk again; it is empty where the trace is damaged."""
        run = self._run(number)
        chunk = number - run.first
        ticks = run.trace.ticks(chunk)
        if not ticks.size:
            return Piece(np.zeros(0, PLAYED), np.zeros((0, *self._display.shape), np.float32))
        before = self._before(run.trace, chunk, ticks)
        replay = Replay(self._picture, self._display)
        if before.size:
            replay.frames(before)
        frames = replay.frames(ticks).astype(np.float32)
        return Piece(self._played(run, ticks), frames)

    def describe(self, scene: int) -> ViewState:
        """Make what a page shows of a showing of a stimulus; scene 0 is none."""
        protocol, head = self._record.protocol, self._record.head
        participant = str(head.get("participant", ""))
        plain = ViewState(
            number=0,
            title=f"{participant}: {protocol.name}" if participant else protocol.name,
            array=array_shown(self._display),
            geometry=geometry_shown(protocol.model.style.geometry),
            mapping=f"mapping: {protocol.mapping.name}",
            device="recording",
            facts=[("session", self._record.folder.resolve().name)],
        )
        if scene not in self._pictures.shown:
            return plain
        trial, showing = self._pictures.shown[scene]
        told = self._progress.record_of(trial)
        stimulus = stimulus_of(showing)
        mapping = protocol.mapping_of(stimulus)
        style = replace(protocol.model.style, mapping=mapping, geometry=stimulus.geometry)
        facts = [
            *plain.facts,
            ("trial", _name(trial)),
            ("condition", trial.condition),
            ("shown", stimulus.picture or to_braille(stimulus.masks[slice(*trial.asked)])),
            ("answer", "none" if told.answer is None else told.answer),
        ]
        if len(trial.stimuli) > 1:
            facts.insert(3, ("stimulus", f"{showing.stimulus + 1} of {len(trial.stimuli)}"))
        if showing.attempt > 1:
            facts.insert(2, ("attempt", str(showing.attempt)))
        return structs.replace(
            plain,
            geometry=geometry_shown(stimulus.geometry),
            mapping=f"mapping: {mapping.name}",
            rows_shown=rows_shown(style, self._display),
            lines=[]
            if stimulus.picture is not None
            else [
                cells_shown(scene, protocol.line(stimulus.masks), stimulus.text or "", under=True)
            ],
            place=_name(trial),
            facts=facts,
        )

    def _add(self, run: BidsRun, *, alone: bool) -> None:
        """Take in a run: its trace, if it has one, and what happened in it."""
        name, trace = run.event.trace, None
        if name:
            try:
                trace = ChunkedTrace(self._record.folder / name)
            except VbrailleError as error:
                self.notes.append(str(error))
        first_ns = None if trace is None else _first_ns(trace)
        begun_s = _begun_s(run, first_ns)
        # The trace of the run before may go on after its last event, when the machine failed.
        shift_s = -begun_s if alone else max(self._end_s - begun_s, 0.0)
        told = [run.event, *run.events]
        self.moments += moments_of(told, self._progress, self._record.protocol, -shift_s)
        if trace is None or first_ns is None:
            return
        first = self._runs[-1].stop if self._runs else 0
        played = _PlayedRun(trace, first, first_ns, begun_s + shift_s)
        self._runs.append(played)
        for chunk in trace.damage:
            text = f"{name} is damaged here: a part of it is missing"
            self.moments.append(PlayedEvent(self.first_s(first + chunk), "fault", text))
        if trace.damage:
            self.notes.append(f"{name} is damaged; what is whole is played")
        last = next(ticks for n in range(len(trace), 0, -1) if (ticks := trace.ticks(n - 1)).size)
        self._end_s = max(self._end_s, float(played.seconds(last["time_ns"][-1:])[0]))
        if trace.torn_bytes:
            self.notes.append(f"{name} was cut short; it is played up to its last whole chunk")
            self.moments.append(PlayedEvent(self._end_s, "fault", f"{name} was cut short here"))

    def _run(self, number: int) -> _PlayedRun:
        """Run that a piece belongs to."""
        return self._runs[bisect_right(self._runs, number, key=lambda run: run.first) - 1]

    def _before(self, trace: ChunkedTrace, chunk: int, ticks: NDArray[np.void]) -> NDArray[np.void]:
        """Ticks before a chunk that its first frames are made from: those of an unended fade."""
        parts: list[NDArray[np.void]] = []
        earliest = ticks
        while earliest["share"][0] < 1 and chunk > 0 and len(parts) < _MOST_BEFORE:
            chunk -= 1
            earliest = trace.ticks(chunk)
            if not earliest.size:
                break
            # A frame that is shown in full needs none before it.
            full = np.flatnonzero(earliest["share"] >= 1)
            if full.size:
                earliest = earliest[full[-1] :]
            parts.insert(0, earliest)
        return np.concatenate(parts) if parts else ticks[:0]

    def _played(self, run: _PlayedRun, ticks: NDArray[np.void]) -> NDArray[np.void]:
        """Give the numbers of ticks beside their deflections."""
        made = np.zeros(ticks.size, PLAYED)
        for name in ("flags", "line", "part", "late", "tick", "x_mm", "y_mm", "theta_rad",
                     "vx_mm_s", "share"):  # fmt: skip
            made[name] = ticks[name]
        made["time_s"] = np.maximum.accumulate(run.seconds(ticks["time_ns"]))
        made["scene"] = ticks["line"]
        return made

    def _make_picture(self, line: int) -> Program:
        """Picture of a line number; what is not known is NaN in all that it has a share in."""
        if line in self._pictures.shown:
            return self._pictures.of(line)
        program = nothing(self._display)
        program.numbers[work.IDLE : work.IDLE + self._display.rows] = np.nan
        return program


def _refuse_running(folder: Path) -> None:
    """Refuse a session that a console has open: its stimuli are still to be answered."""
    try:
        journal_file = os.open(folder / journal.NAME, os.O_RDONLY | os.O_CLOEXEC)
    except OSError as error:
        raise VbrailleError(f"{folder / journal.NAME} cannot be read: {error.strerror}") from None
    try:
        fcntl.flock(journal_file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        raise InputError(f"{folder} runs in a console; play it when that has ended") from None
    except OSError:
        pass  # a file system without locks
    finally:
        os.close(journal_file)


def _begun_s(run: BidsRun, first_ns: int | None) -> float:
    """Time of the first tick of a run, in seconds that the session had run for."""
    for event in run.events:
        time_ns = getattr(event, "time_ns", None)
        if first_ns is not None and time_ns is not None:
            return event.t_s - (time_ns - first_ns) / 1e9
    return run.event.t_s


def _first_ns(trace: ChunkedTrace) -> int | None:
    """Time of the first tick of a trace; None if it has none."""
    for chunk in range(len(trace)):
        ticks = trace.ticks(chunk)
        if ticks.size:
            return int(ticks["time_ns"][0])
    return None


def _no_frames(folder: Path, record: Record) -> str:
    if record.protocol.medium == "paper":
        return f"{folder} is a session that was read on paper; it has no frames to play"
    return f"{folder} has no trace with a frame in it; there is nothing to play"


def _name(trial: Trial) -> str:
    return f"{'practice trial' if trial.practice else 'trial'} {trial.number}"


def moments_of(
    told: Iterable[JournalEvent], progress: Progress, protocol: Protocol, begun_s: float = 0.0
) -> list[PlayedEvent]:
    """Make the moments of events, by time.

    Parameters
    ----------
    told
        Events of the journal.
    progress
        State of the session after all of them.
    protocol
        Protocol of the session, by which answers are right or wrong.
    begun_s
        Time of the session at which the recording begins, in seconds that the session had run for.
    """
    made = []
    for event in told:
        found = _say(event, progress)
        if found is not None:
            kind, text = found
            at_s, text = max(event.t_s - begun_s, 0.0), _in_trial(event) + text
            made.append(PlayedEvent(at_s, kind, text, *_judged(event, progress, protocol)))
    # The journal may have an event a little later than one that happened after it.
    return sorted(made, key=lambda moment: moment.at_s)


def _judged(event: JournalEvent, progress: Progress, protocol: Protocol) -> tuple[bool | None, str]:
    """Tell whether an answer was right, None where nothing is, and the condition of its trial."""
    if not isinstance(event, events.AnyTime):
        return None, ""
    told = (progress.practice if event.practice else progress.trials).get(event.trial)
    if told is None:
        return None, ""
    correct = None
    if isinstance(event, events.Answer):
        correct = protocol.asks.columns(told.shown, event.answer).get("correct")
    return (bool(correct) if isinstance(correct, int) else None), told.trial.condition


def _in_trial(event: JournalEvent) -> str:
    if not isinstance(event, events.AnyTime) or not event.trial:
        return ""
    return f"{'practice trial' if event.practice else 'trial'} {event.trial}: "


def _say(event: JournalEvent, progress: Progress) -> tuple[str, str] | None:
    """Kind of the moment of an event, and what happened; None for an event that is not shown."""
    match event:
        case events.Presented():
            return _say_presented(event, progress)
        case events.Cue():
            return "cue", "the start signal sounded"
        case events.Warning():
            return "cue", "the warning sounded"
        case events.Contact():
            return "line", "the array came to the first dot"
        case events.Read():
            return "line", "it was read to the end and back"
        case events.Answer(answer=answer, corrects=corrects):
            return "answer", f"the answer was {'corrected to ' if corrects else ''}{answer}"
        case events.Undo():
            return "answer", "the answer was taken back"
        case events.Repeat():
            return "trial", "the trial is shown again"
        case events.Fault(what=what):
            return "fault", what
        case events.Well():
            return "fault", "the stimulus can be felt again"
        case events.Lost(n=n):
            return "fault", f"event {n} of the journal is damaged"
        case events.Tuning(tuning=tuning):
            return "tuning", ", ".join(f"{name} {value:g}" for name, value in tuning.items())
        case events.Pause():
            return "pause", "paused"
        case events.Go():
            return "pause", "goes on"
        case events.Break():
            return "pause", "a break began"
    return _say_beside(event)


def _say_beside(event: JournalEvent) -> tuple[str, str] | None:
    """Say what happened to the session itself."""
    match event:
        case events.Note(text=text):
            return "note", f"note: {text}"
        case events.Device(what=what):
            return "note", what
        case events.Run(why=why):
            said = {"start": "the session began", "resume": "the session was resumed"}
            return "note", said.get(why, "the engine was started again")
        case events.Begin():
            return "note", "practice was ended"
        case events.Stop():
            return "note", "the session was stopped"
        case events.End(why=why):
            return "note", f"the session was ended: {why}"
    return None


def _say_presented(event: events.Presented, progress: Progress) -> tuple[str, str]:
    if event.stimulus:
        return "line", "the second stimulus is under the hand"
    again = f", attempt {event.attempt}" if event.attempt > 1 else ""
    told = (progress.practice if event.practice else progress.trials).get(event.trial)
    condition = told.trial.condition if told else ""
    return "trial", (f"condition {condition}" if condition else "begins") + again
