"""A session as a table with a row for each planned trial, made from the record alone."""

from __future__ import annotations

import csv
import io
import re
from bisect import bisect_left, bisect_right
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.braille.geometry import BOUNDS_MM
from vbraille.braille.spelling import to_braille
from vbraille.engine.record import Flag
from vbraille.files import no_formula
from vbraille.sessions.planning.design import StringList
from vbraille.sessions.planning.style import TUNED
from vbraille.sessions.record.codebook import ASKED, COLUMNS, CORRECT, designed
from vbraille.sessions.record.events import AnyTime, JournalEvent, Note, Presented
from vbraille.sessions.record.folder import Record, open_told_trace
from vbraille.sessions.record.passages import COLUMNS as PASSAGE
from vbraille.sessions.record.passages import read_so, spans_of
from vbraille.sessions.record.traces import LAST_FIELD, NO_TRACE, TraceLines
from vbraille.sessions.record.trajectory import Trajectory, duration, edges_mm

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    import pandas as pd
    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.progress import Progress, TrialRecord
    from vbraille.sessions.record.traces import TickColumns, Trace


@dataclass(frozen=True, slots=True)
class PlacedNote:
    """A note, and the trials around it.

    Parameters
    ----------
    text
        Text of the note, as it was typed.
    event
        Number of its event in the journal.
    t_s
        Time of the note, in seconds that the session had run for.
    before
        Number of the trial that was shown last before the note; 0 if none was.
    trial
        Number of the trial that was open when the note was typed; 0 if none was.
    after
        Number of the trial that was shown next after the note; 0 if none was.
    practice
        Whether the note was typed in a practice trial.
    """

    text: str
    event: int
    t_s: float
    before: int
    trial: int
    after: int
    practice: bool = False


def read_notes(events: Iterable[JournalEvent]) -> list[PlacedNote]:
    """Notes of a session, in order."""
    notes: list[PlacedNote] = []
    before, waiting = 0, 0  # waiting: number of notes whose next trial is still to come
    for event in events:
        trial = event.trial if isinstance(event, AnyTime) and not event.practice else 0
        if isinstance(event, Note):
            told = (event.text, event.n, event.t_s)
            if trial:
                notes.append(PlacedNote(*told, trial, trial, trial))
            else:
                notes.append(PlacedNote(*told, before, 0, 0, event.practice))
                waiting += 1
        elif isinstance(event, Presented) and trial:
            for n, note in enumerate(notes) if waiting else ():
                if not note.after:
                    # Between two attempts at one trial, a note counts as typed in that trial.
                    again = trial if note.before == trial else 0
                    notes[n] = replace(note, trial=again, after=trial)
            before, waiting = trial, 0
    return notes


def texts(notes: Iterable[PlacedNote]) -> str:
    """Text of notes for one cell of a table."""
    return "; ".join(note.text for note in notes)


_TIMES = ("duration_s", "returned", "contact_s", "response_s", "paused_s")
# This is a plain number because numpy, when it reads an enumeration, can swallow an exception that
# a signal raises.
_PAUSED = int(Flag.PAUSED)
ROWS_NEED = "vx_mm_s"
NEVER_CAME = "the hand never came to the first dot"


class Traces:
    """The traces of a session, as far as they are whole.

    Parameters
    ----------
    record
        The session.
    salvaged
        Whether ticks after a damage are used too.
    upto
        Last field of the ticks that is read. Those up to `ROWS_NEED` are what `rows` needs.

    Attributes
    ----------
    faults : list[str]
        What is wrong with the traces that were asked for.
    """

    def __init__(self, record: Record, *, salvaged: bool = False, upto: str = LAST_FIELD) -> None:
        self.faults: list[str] = []
        self._upto = upto
        self._salvaged = salvaged
        self._record = record
        self._traces: dict[str, TraceLines | Trace] = {}

    def read(self, name: str) -> Trace:
        """Read the trace of a name, as far as it is whole."""
        found = self._opened(name)
        return found.whole() if isinstance(found, TraceLines) else found

    def of(self, name: str, lines: list[int]) -> TickColumns | None:
        """Ticks of a trace that have some line numbers; None if some of the ticks may be lost."""
        found = self._opened(name)
        if isinstance(found, TraceLines):
            return _some(found.between(min(lines), max(lines)), lines)
        if found.damage is None:
            return _of(found.ticks, lines)
        # Line numbers grow along a trace. So damage may take ticks from the last number before it
        # and from the first number after it, and these two are not used.
        known = found.ticks["line"]
        if known.size and known[-1] > max(lines):
            return _of(found.ticks, lines)
        for stretch in found.later if self._salvaged else ():
            known = stretch["line"]
            last = stretch is found.later[-1] or known[-1] > max(lines)
            if known[0] < min(lines) and last:
                return _of(stretch, lines)
        return None

    def _opened(self, name: str) -> TraceLines | Trace:
        """A whole trace, whose ticks are read as they are wanted, or what is left of another."""
        if name not in self._traces:
            chunks, damage = open_told_trace(self._record.folder, name, self._record.journal)
            if damage is not None:
                self.faults.append(f"{name} is damaged, {damage}")
            if chunks is None or damage is not None:
                trace = NO_TRACE if chunks is None else chunks.whole(self._upto)
                self._traces[name] = replace(trace, damage=damage)
            else:
                self._traces[name] = TraceLines(chunks, self._upto)
        return self._traces[name]


def _of(ticks: NDArray[np.void], lines: list[int]) -> TickColumns:
    """Ticks that have some line numbers, out of ticks whose line numbers grow."""
    known = ticks["line"]
    # Bisection in Python is faster here: numpy would copy the whole column for each trial.
    part = ticks[bisect_left(known, min(lines)) : bisect_right(known, max(lines))]
    return _some({name: part[name] for name in part.dtype.names or ()}, lines)


def _some(ticks: TickColumns, lines: list[int]) -> TickColumns:
    """Ticks that have some line numbers, out of those between the first and the last of these."""
    if max(lines) - min(lines) < len(set(lines)):  # no other line numbers lie between them
        return ticks
    wanted = np.isin(ticks["line"], lines)
    return {name: column[wanted] for name, column in ticks.items()}


def rows(record: Record, traces: Traces | None = None) -> list[dict[str, Any]]:
    """Rows of a session, with `COLUMNS` and then the answers to the protocol's questions.

    Parameters
    ----------
    record
        The session.
    traces
        Traces of the session, if the caller wants to know what is wrong with them. Cells that
        need a missing part of a trace are left empty.
    """
    return [row for row, _ in walk(record, traces)]


def frame_of(table: Sequence[dict[str, Any]]) -> pd.DataFrame:
    """Make a data frame of the rows of sessions, whose columns have their types.

    Numbers of trials and blocks are whole, and durations float64 with NaN for one that is not
    known. Other columns are as they are exported. The index is the number of the row, from 1.
    """
    import pandas as pd  # takes a while to load, and an export does without

    frame = pd.DataFrame(table, range(1, len(table) + 1), dtype=object)
    if not table:
        return frame
    seconds = pd.to_numeric(frame["duration_s"]).astype(np.float64)
    return frame.assign(duration_s=seconds).astype({"block": np.int64, "trial": np.int64})


def walk(
    record: Record, traces: Traces | None = None, progress: Progress | None = None
) -> Iterator[tuple[dict[str, Any], Trajectory | str | None]]:
    """Go through a session trial by trial.

    Parameters
    ----------
    record, traces
        These are described at `rows`.
    progress
        Course of the session, if it is known already.

    Yields
    ------
    row : dict[str, Any]
        Row of the trial, as `rows` gives it.
    trajectory : Trajectory, str or None
        Trajectory that the row's duration is taken from, or the reason why there is none. None
        for trials whose trace is not read: comparisons, trials on paper or on a conventional
        display, and trials without an answer.
    """
    progress = record.progress() if progress is None else progress
    traces = Traces(record, upto=ROWS_NEED) if traces is None else traces
    fields = {f"field_{name}": value for name, value in record.head["fields"].items()}
    notes = read_notes(record.journal.events)
    for told in progress.trials.values():
        trial = told.shown
        row, seen = _row(record, trial, told), None
        row |= _noted(notes, trial.number) | _replies(record, progress, trial)
        strings = shown_on(record.protocol, trial) == "device" and len(trial.stimuli) == 1
        strings = strings and not record.protocol.pictures
        if strings and told.answer is not None:
            seen = _trajectory(record, trial, told, traces)
        if isinstance(seen, Trajectory):
            row["duration_s"] = round(seen.duration.seconds, 6)
            row["returned"] = int(seen.duration.returned)
        if record.protocol.passages and told.answer is not None:
            row |= _passage(record, trial, told, traces)
        if told.lost:
            # One of the lost events may be a pause, or a new attempt at the trial.
            seen = f"events of the journal are lost: {spans(told.lost)}"
            row |= dict.fromkeys(_TIMES, "")
            row["faults"] = "; ".join([*told.faults, seen])
        yield row | fields, seen


def _row(record: Record, trial: Trial, told: TrialRecord) -> dict[str, Any]:
    """Row of a trial, without the cells that its trace tells."""
    t_s = told.t_s
    tuning = trial.stimuli[0].tuning
    protocol, geometries = record.protocol, [stimulus.geometry for stimulus in trial.stimuli]
    row: dict[str, Any] = dict.fromkeys(COLUMNS, "")
    row |= designed(protocol, trial)
    row |= dict.fromkeys(PASSAGE, "") if protocol.passages else {}
    row |= {
        "session": record.folder.resolve().name,
        "participant": record.plan.participant,
        "protocol": record.plan.protocol,
        "block": trial.block,
        "trial": trial.number,
        "condition": trial.condition,
        "texture": told.tuning.get("texture", tuning.texture),
        "contrast": told.tuning.get("contrast", tuning.contrast),
        "texture_cycles": tuning.cycles if protocol.model.name == "stress2" else "",
        "model": protocol.model.name,
        "shown_on": shown_on(protocol, trial),
        "mapping": protocol.mapping_of(trial.stimuli[0]).name,
        **{name: _each(geometries, name) for name in BOUNDS_MM},
        "answers_from": told.source,
        "moved_by": told.moved_by,
        "attempt": told.attempts,
        "paused_s": round(told.paused_s, 6),
        "early": int(told.early),
        "analysed": int(
            told.answer is not None and not (trial.catch and not protocol.asks.of_catch)
        ),
        "warned": int("warning" in t_s),
        "faults": "; ".join(told.faults),
        "cue_time": told.wall.get("cue", ""),
        "answer_time": told.wall.get("answer", ""),
        "trace": told.trace or "",
    }
    if protocol.pictures:  # which have none of what cells have
        row |= dict.fromkeys(("texture", "texture_cycles", "mapping", *BOUNDS_MM), "")
    if "cue" in t_s and "contact" in t_s and t_s["contact"] >= t_s["cue"]:
        row["contact_s"] = round(t_s["contact"] - t_s["cue"], 6)
    if protocol.trial.answer_s is not None:
        row["late"] = int(told.late)
    if told.response_s is not None:
        row["response_s"] = round(told.response_s, 6)
    return row | _asked(record, trial, told)


def _asked(record: Record, trial: Trial, told: TrialRecord) -> dict[str, Any]:
    """Cells of a trial's row for what was asked, and what was answered."""
    question, t_s = record.protocol.asks, told.t_s
    row = question.columns(trial, told.answer) | {"ended_by": told.ended_by}
    row["confidence"] = "" if told.confidence is None else told.confidence
    stimuli = told.trial.stimuli if question.turns else trial.stimuli  # from where it was turned
    values = [f"{stimulus.value:g}" for stimulus in stimuli if stimulus.value is not None]
    if record.protocol.parameter is not None:
        row["parameter"] = record.protocol.parameter
        row |= _compared(trial, record.protocol.parameter)
        row["presented"] = " ".join(values)
    else:
        row["presented"] = trial.presented
        row["string_set"] = _string_set(record, trial)
    for column, answer in (("answered", told.answer), ("first_answer", told.first_answer)):
        row[column] = "" if answer is None else question.cell(trial, answer)
    if shown_on(record.protocol, trial) != "device" and "read" in t_s and "cue" in t_s:
        row["duration_s"] = round(t_s["read"] - t_s["cue"] - told.unread_s, 6)
    return row


def shown_on(protocol: Protocol, trial: Trial) -> str:
    """Place of a trial's string: "device", "conventional" for such a display, or "paper"."""
    if trial.stimuli[0].conventional:
        return "conventional"
    return protocol.medium


def _compared(trial: Trial, parameter: str | None) -> dict[str, str]:
    """Cells for what two stimuli are compared by, where that is of their tuning."""
    name = "cycles" if parameter == "texture_cycles" else parameter
    if parameter is None or name not in TUNED:
        return {}
    return {parameter: " ".join(f"{getattr(s.tuning, name):g}" for s in trial.stimuli)}


def _string_set(record: Record, trial: Trial) -> str:
    design = record.protocol.design
    masks = trial.stimuli[0].masks[slice(*trial.asked)]
    listed = design.listed(masks) if isinstance(design, StringList) else None
    return "" if listed is None else to_braille(listed)


def _replies(record: Record, progress: Progress, trial: Trial) -> dict[str, Any]:
    """Cells of a trial's row for the answers to the questionnaire that go with it."""
    numbers = {"trial": trial.number, "block": trial.block}
    columns = record.protocol.columns_of(trial.item)
    cells: dict[str, Any] = {}
    for item in record.protocol.questionnaire:
        name, answer = (
            f"{ASKED}{item.name}",
            progress.replies.get((item.name, numbers.get(item.when, 0)), ""),
        )
        cells[name] = answer
        if item.right:
            good = item.good(answer, columns) if answer else None
            cells[f"{name}{CORRECT}"] = "" if good is None else int(good)
    return cells


def _passage(record: Record, trial: Trial, told: TrialRecord, traces: Traces) -> dict[str, Any]:
    """Cells of a trial's row for how a passage was read."""
    numbers = {showing.stimulus: showing.line for showing in told.last_attempt}
    lines = [] if told.trace is None else [
        traces.of(told.trace, [numbers[n]]) for n in range(len(trial.stimuli)) if n in numbers
    ]  # fmt: skip
    whole = [ticks for ticks in lines if ticks is not None]
    return read_so(trial, told, spans_of(record.journal.events, told), whole)


def _noted(notes: list[PlacedNote], trial: int) -> dict[str, str]:
    """Cells of a trial's row for the notes in the trial and around it."""
    between = [note for note in notes if not note.trial]
    return {
        "notes": texts(note for note in notes if note.trial == trial),
        "notes_before": texts(note for note in between if note.after == trial),
        "notes_after": texts(note for note in between if note.before == trial),
    }


def _each(geometries: list[Geometry], name: str) -> str:
    """A length of each stimulus of a trial as text; a single number if all agree."""
    lengths = dict.fromkeys(f"{getattr(geometry, name):g}" for geometry in geometries)
    return " ".join(lengths)


def spans(numbers: Sequence[int]) -> str:
    """Text for increasing numbers, such as 3-5, 9."""
    parts: list[list[int]] = []
    for number in numbers:
        if parts and parts[-1][-1] == number - 1:
            parts[-1].append(number)
        else:
            parts.append([number])
    return ", ".join(f"{p[0]}-{p[-1]}" if len(p) > 1 else f"{p[0]}" for p in parts)


def _trajectory(
    record: Record, trial: Trial, told: TrialRecord, traces: Traces
) -> Trajectory | str:
    """Trajectory of the last attempt at a trial, or the reason why there is none."""
    protocol, stimulus = record.protocol, trial.stimuli[0]
    line = protocol.line(stimulus.masks)
    edges = edges_mm(line, protocol.mapping_of(stimulus), stimulus.geometry)
    if (trace := told.trace) is None:
        return "it has no trace"
    ticks = traces.of(trace, [showing.line for showing in told.last_attempt])
    if ticks is None:
        return f"{trace} is damaged before the end of it"
    if not ticks["line"].size:
        return f"{trace} has no tick of it"
    if not edges:
        return "no dot of it is shown"
    felt = np.flatnonzero(ticks["flags"] & _PAUSED == 0)
    until = int(felt[-1]) + 1 if felt.size else None  # the answer ended the trial
    span_mm, time_ns = protocol.model.display.span_mm, ticks["time_ns"][:until]
    x_mm = ticks["x_mm"][:until]
    left_mm = x_mm - span_mm / 2

    def moved() -> NDArray[np.bool_]:
        tuning = replace(stimulus.tuning, **told.tuning)
        program = protocol.program(stimulus, tuning)
        frames = program.path(x_mm)
        idle = program.path(np.full(1, np.nan))
        return (frames != idle).any(axis=(1, 2))

    found = duration(left_mm, time_ns, moved, edge_mm=edges[0], span_mm=span_mm)
    if found is None:
        return NEVER_CAME
    return Trajectory(left_mm, time_ns, edges, stimulus.geometry.dot_width_mm, span_mm, found)


def to_csv(table: list[dict[str, Any]], delimiter: str = ",", missing: str = "") -> str:
    """Rows that have the same columns, as the text of a table with a head.

    In a table with commas, which people open in spreadsheets, no text is a formula.
    """
    text = io.StringIO()
    writer = csv.writer(text, delimiter=delimiter, lineterminator="\n")
    writer.writerow(table[0])
    for row in table:
        cells = [missing if value == "" else value for value in row.values()]
        if delimiter == ",":
            cells = [no_formula(cell) if isinstance(cell, str) else cell for cell in cells]
        writer.writerow(cells)
    return text.getvalue()


def encode(text: str) -> bytes:
    """UTF-8 of a text; surrogates, which a directory's name may have, are written as escapes."""
    return text.encode("utf-8", "backslashreplace")


LEFT_OUT = ("notes", "notes_before", "notes_after", "cue_time", "answer_time", "trace")
_PATH = re.compile(r"\S*[/\\]\S*")
_SOURCES = ("typed", "simulated", "program")


def number_of(record: Record) -> str:
    """Eight digits that identify a session, whatever its directory is called."""
    return f"{record.journal.crcs[0] if record.journal.crcs else 0:08x}"


def without_paths(text: str) -> str:
    """Text with each word that may be a path replaced."""
    return _PATH.sub("(left out)", text)


def anonymous(record: Record, table: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of `vbraille.sessions.record.export.rows` without times of day, paths and notes."""
    return [_without_times(record, row) for row in table]


def _without_times(record: Record, row: dict[str, Any]) -> dict[str, Any]:
    words = [f"{ASKED}{item.name}" for item in record.protocol.questionnaire if item.words_only]
    left_out = {*LEFT_OUT, *words}
    kept = {
        name: without_paths(value) if name == "faults" or name.startswith("field_") else value
        for name, value in row.items()
        if name not in left_out
    }
    kept["session"] = number_of(record)
    if kept["answers_from"] and kept["answers_from"].partition(":")[0] not in _SOURCES:
        kept["answers_from"] = "file"
    return kept
