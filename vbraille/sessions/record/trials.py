"""A session as a table: a row for each trial, made from the plan, the events and the ticks."""

from __future__ import annotations

import csv
import io
import sqlite3
from collections import defaultdict
from collections.abc import Iterable, Sequence
from operator import attrgetter
from pathlib import Path
from statistics import fmean
from types import SimpleNamespace
from typing import Any, NamedTuple

from vbraille.braille.spelling import UNREAD
from vbraille.csvfiles import read_csv
from vbraille.files import no_formula
from vbraille.sessions.planning.loading import parse_protocol
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.shown import edges_mm
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.record.movement import describe, duration, pauses
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import Content, reading
from vbraille.sessions.record.record import read as read_record
from vbraille.sessions.record.ticks import FIELDS, read_ticks


class Column(NamedTuple):
    """Meaning of a column, its unit, and its values if they are few."""

    meaning: str
    unit: str = ""
    values: str = ""


COLUMNS_OF: dict[str, dict[str, Column]] = {}
PLANNED: dict[str, str] = {}  # where the plan has what a column holds, by names of `_planned`
for _name, *_told, _of, _from in read_csv(Path(__file__).with_name("columns.csv")).rows:
    COLUMNS_OF.setdefault(_of, {})[_name] = Column(*_told)
    PLANNED |= {_name: _from} if _from else {}
COLUMNS, OF_PASSAGES = COLUMNS_OF["all"], COLUMNS_OF["passages"]
WAY = ("line", "time_ns", "x_mm")  # of the ticks, what tells how a string was read
# What may tell who a person is, or where the session was.
PRIVATE = ("notes", "cue_time", "answer_time", "answers_from", "faults")


def rows(path: Path, *, practice: bool = False, anonymous: bool = False) -> list[dict[str, Any]]:
    """Return a row for each trial of a session, with `COLUMNS`, levels, items, replies and fields.

    Parameters
    ----------
    practice
        Whether trials of practice have rows, too.
    anonymous
        Whether times of day, notes, words of the participant and names of files are left out.
    """
    table = _Table(read_record(path))
    shown = [table.progress.shown(trial) for trial in table.progress.plan.trials]
    with reading(path) as db:
        found = [table.row(db, each) for each in shown if each and (practice or not each.practice)]
    if anonymous:
        protocol = table.progress.protocol
        words = [f"asked_{item.name}" for item in protocol.questionnaire if item.kind == "text"]
        words += ["answered", "first_answer"] if protocol.asks.kind == "free" else []
        for row in found:
            row |= dict.fromkeys((*PRIVATE, *words), "")
            row["session"] = f"{row['participant']}-{protocol.name}"
    return found


def protocol_of(content: Content) -> Protocol:
    """Return the protocol of a session, as the participant's group has it."""
    protocol = parse_protocol(content.files, f"protocol of {content.path}", planned=True)
    return protocol.of_group(content.plan.group)


def to_csv(
    table: Sequence[dict[str, Any]],
    separator: str = ",",
    nothing: str = "",
    columns: Iterable[str] = COLUMNS,
) -> str:
    """Return rows as CSV, with all columns that any of them has; some columns, if there is none."""
    columns = list(dict.fromkeys(name for row in table for name in row) or columns)
    text = io.StringIO()
    writer = csv.writer(text, delimiter=separator, lineterminator="\n")
    writer.writerow(columns)
    for row in table:
        cells = (no_formula(str(row.get(name, ""))) for name in columns)
        writer.writerow([cell or nothing for cell in cells])
    return text.getvalue()


def codebook(columns: Iterable[str], protocol: Protocol) -> dict[str, Column]:
    """Return what some columns of a session's table hold."""
    known = COLUMNS | OF_PASSAGES
    for factor in protocol.factors:
        levels = ", ".join(level.name for level in factor.levels)
        known[f"factor_{factor.name}"] = Column(f"level of the factor {factor.name}", "", levels)
    for field in protocol.fields:
        known[f"field_{field.name}"] = Column(field.ask, "", ", ".join(field.choices))
    for item in protocol.questionnaire:
        known[f"asked_{item.name}"] = Column(item.ask, "", ", ".join(item.choices))
        known[f"asked_{item.name}_correct"] = Column(f"whether that is {item.right}", "", "0, 1")
    for column in protocol.item_columns:
        known[f"item_{column}"] = Column(f"column {column} of the file of items")
    return {name: known[name] for name in columns}


class _Table:
    """Makes rows of a session."""

    def __init__(self, content: Content) -> None:
        self._content = content
        self._protocol = protocol_of(content)
        self.progress = Progress(self._protocol, content.plan, content.events)
        # Where each answer came from, by its event, and what moved the array if no person did.
        self._sources: dict[int, dict[str, Any]] = {}
        source: dict[str, Any] = {}
        for event in content.events:
            if event.kind == "run":
                hand = event.data.get("conditions", {}).get("hand", "")
                moved_by = f"simulated:{hand}" if hand and event.data.get("simulated") else ""
                source = {"answers_from": event.data["answers"], "moved_by": moved_by}
            elif event.kind == "hand" and event.data["held"]:
                source = source | {"moved_by": "simulated:pointer"}
            elif event.kind == "answer":
                self._sources[event.n] = source

    def row(self, db: sqlite3.Connection, trial: Trial) -> dict[str, Any]:
        """Return the row of a trial as it was shown."""
        protocol, replies = self._protocol, self.progress.replies
        row: dict[str, Any] = dict.fromkeys(COLUMNS, "")
        if protocol.design.passage:
            row |= dict.fromkeys(OF_PASSAGES, "")
        row |= self._planned(trial) | self._happened(trial)
        if self.progress.answer(trial) is not None:
            row |= (self._read_passage if protocol.design.passage else self._read)(db, trial)
        row |= {f"item_{name}": trial.columns.get(name, "") for name in protocol.item_columns}
        for item in protocol.questionnaire:
            number = {"trial": trial.number, "block": trial.block}.get(item.when, 0)
            event = replies.get((item.name, number))
            reply = "" if event is None or trial.practice else event.data["reply"]
            row[f"asked_{item.name}"] = reply
            if item.right:
                right = reply == item.of(trial.columns).right
                row[f"asked_{item.name}_correct"] = int(right) if reply else ""
        fields = self._content.head.get("fields", {})
        return row | {f"field_{name}": value for name, value in fields.items()}

    def _planned(self, trial: Trial) -> dict[str, Any]:
        """Return the cells on what was planned, as `PLANNED` says."""
        protocol, plan, first = self._protocol, self._content.plan, trial.stimuli[0]
        known = SimpleNamespace(
            path=self._content.path,
            protocol=protocol,
            design=protocol.design,
            asks=protocol.asks,
            plan=plan,
            trial=trial,
            first=first,
            style=protocol.style(first.look),
            tried=self.progress.tried[trial.key],
        )
        row = {name: _cell(name, attrgetter(where)(known)) for name, where in PLANNED.items()}
        levels = protocol.levels(trial.condition, plan.group)
        row |= {f"factor_{name}": level for name, level in levels.items()}
        if protocol.model == "vbd":
            row["texture_cycles"] = ""
        if protocol.medium == "paper":
            row["on"] = "paper"
        if first.picture:
            row |= {"mapping": "", "presented": protocol.asks.right_answer(trial) or first.picture}
        if trial.values:
            row["string_set"] = ""
        return row

    def _happened(self, trial: Trial) -> dict[str, Any]:
        """Return the cells on what happened in the attempt that counts."""
        tried, asks = self.progress.tried[trial.key], self._protocol.asks
        answer, paused_s = tried.answer, tried.paused_s
        data = {} if answer is None else answer.data
        row: dict[str, Any] = {
            "paused_s": round(paused_s, 6),
            "warned": int(bool(tried.of("warning"))),
            "faults": "; ".join(event.data["what"] for event in tried.of("fault")),
            "notes": "; ".join(e.data["text"] for e in tried.events if e.kind == "note"),
            "early": int(data.get("early", False)),
            "late": int(bool(tried.of("late", "missed"))),
            "analysed": int(answer is not None and (not trial.catch or asks.counts_catch)),
        }
        for cue in tried.of("cue")[:1]:
            row["cue_time"] = cue.wall
            for contact in tried.of("contact")[:1]:
                row["contact_s"] = round(contact.t_s - cue.t_s, 6)
        if answer is None:
            return row
        until = answer
        for ended in tried.of("ended"):
            row["ended_by"] = ended.data["by"]
            until = answer if ended.data["by"] == "exposure" else ended
        for cue in tried.of("cue")[:1]:
            row["response_s"] = round(until.t_s - cue.t_s - paused_s, 6)
        given, correct = data["answer"], self.progress.is_right(trial)
        first = next(e.data["answer"] for e in tried.events if e.kind == "answer")
        return row | {
            "answered": asks.cell(trial, given),
            "correct": "" if correct is None else int(correct),
            "outcome": asks.outcome(trial, given),
            "confidence": "" if tried.confidence is None else tried.confidence.data["confidence"],
            "first_answer": "" if first == given else asks.cell(trial, first),
            "answer_time": answer.wall,
            **self._sources[answer.n],
        }

    def _read(self, db: sqlite3.Connection, trial: Trial) -> dict[str, Any]:
        """Return the cells on how a string was read, which the ticks tell."""
        protocol, first, tried = self._protocol, trial.stimuli[0], self.progress.tried[trial.key]
        cues = tried.of("cue")
        if len(trial.stimuli) > 1 or not cues or first.picture:
            return {}
        cue = cues[0]
        if "line" not in cue.data:
            reads = tried.of("read")
            return {"duration_s": round(reads[-1].t_s - cue.t_s, 6)} if reads else {}
        edges = edges_mm(protocol, first)
        ticks = read_ticks(db, cue.data["line"], WAY)
        found = duration(ticks, edges[0], protocol.wanted.span_mm) if edges else None
        if found is None:
            return {}
        row: dict[str, Any] = {"returned": int(found.returned)}
        if tried.answer is not None and tried.answer.data.get("early"):
            return row
        row["duration_s"] = round(found.seconds, 6)
        if tried.paused_s:
            return row
        read = ticks[found.ticks]
        last_mm = edges[-1] + protocol.style(first.look).geometry.dot_width_mm
        return row | describe(read["x_mm"], read["time_ns"], edges[0], last_mm)

    def _read_passage(self, db: sqlite3.Connection, trial: Trial) -> dict[str, Any]:
        """Return the cells on a passage: its speed, the pauses of the hand, and its regressions."""
        protocol, tried = self._protocol, self.progress.tried[trial.key]
        words = len(trial.item.split())
        row: dict[str, Any] = {"lines": len(trial.stimuli), "words": words}
        shown = {cue.data["stimulus"]: cue.data["line"] for cue in tried.of("cue")}
        contacts, reads = tried.of("contact"), tried.of("read", "ended")
        if not contacts or not reads or len(shown) < len(trial.stimuli):
            return row
        seconds = reads[-1].t_s - contacts[0].t_s - tried.paused_s
        if seconds > 0:
            row["words_per_minute"] = round(60 * words / seconds, 3)
        lines = []
        for number, stimulus in enumerate(trial.stimuli):
            ticks = read_ticks(db, shown[number], FIELDS)
            half_mm = protocol.style(stimulus.look).geometry.cell_pitch_mm / 2
            edge_mm = edges_mm(protocol, stimulus)[0]
            lines.append(pauses(ticks, edge_mm, protocol.wanted.span_mm, half_mm))
        number, seconds, back = map(sum, zip(*lines, strict=True))
        told = {"hand_pauses": number, "hand_paused_s": round(seconds, 3), "regressions": back}
        return row | told


def _cell(name: str, value: Any) -> Any:
    """Return a value of the plan as a table has it."""
    if name.endswith("_mm"):
        return f"{value:g}"
    return "" if value is None else int(value) if isinstance(value, bool) else value


def best_level(path: Path, parameter: str) -> float:
    """Return the value of a parameter at which most characters of a session were read right.

    Raises
    ------
    ValueError
        If the session has no answers that tell.
    """
    right: defaultdict[float, list[bool]] = defaultdict(list)
    for row in rows(path):
        if row["analysed"] and row["question"] == "identify":
            presented, answered = row["presented"], row["answered"]
            pairs = zip(presented, answered.ljust(len(presented), UNREAD), strict=False)
            right[row[parameter]] += [one == other for one, other in pairs]
    if not right:
        raise ValueError(f"{path} has no answers that tell which {parameter} is read best")
    return max(sorted(right), key=lambda value: fmean(right[value]))
