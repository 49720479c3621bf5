"""A session as a table: a row for each trial, made from the plan, the events and the ticks."""

from __future__ import annotations

import csv
import io
import sqlite3
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from vbraille.braille.spelling import UNREAD
from vbraille.files import no_formula
from vbraille.sessions.planning.loading import parse_protocol
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.shown import edges_mm
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.record.movement import describe, duration, pauses
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import Content, Event, reading
from vbraille.sessions.record.record import read as read_record
from vbraille.sessions.record.ticks import read_ticks


class Column(NamedTuple):
    """Meaning of a column, its unit, and its values if they are few."""

    meaning: str
    unit: str = ""
    values: str = ""


with Path(__file__).with_name("columns.csv").open(encoding="utf-8", newline="") as _file:
    COLUMNS_OF: dict[str, dict[str, Column]] = {}
    for _name, *_told, _of in list(csv.reader(_file))[1:]:
        COLUMNS_OF.setdefault(_of, {})[_name] = Column(*_told)
COLUMNS, OF_PASSAGES = COLUMNS_OF["all"], COLUMNS_OF["passages"]
LENGTHS = [name for name in COLUMNS if name.endswith("_mm")]
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
    content = read_record(path)
    protocol = protocol_of(content)
    progress = Progress(protocol, content.plan, content.events)
    table = _Table(content, protocol, progress)
    shown = [progress.shown(trial) for trial in content.plan.trials]
    with reading(path) as db:
        found = [table.row(db, each) for each in shown if each and (practice or not each.practice)]
    if anonymous:
        words = [f"asked_{item.name}" for item in protocol.questionnaire if item.kind == "text"]
        words += ["answered", "first_answer"] if protocol.asks.kind == "free" else []
        for row in found:
            row |= dict.fromkeys((*PRIVATE, *words), "")
            row["session"] = f"{content.plan.participant}-{protocol.name}"
    return found


def protocol_of(content: Content) -> Protocol:
    """Return the protocol of a session, as the participant's group has it."""
    protocol = parse_protocol(content.files, f"protocol of {content.path}", planned=True)
    return protocol.of_group(content.plan.group)


def to_csv(table: Sequence[dict[str, Any]], separator: str = ",", nothing: str = "") -> str:
    """Return rows as CSV, with all columns that any of them has."""
    columns = list(dict.fromkeys(name for row in table for name in row)) or list(COLUMNS)
    text = io.StringIO()
    writer = csv.writer(text, delimiter=separator, lineterminator="\n")
    writer.writerow(columns)
    for row in table:
        cells = [row.get(name, "") for name in columns]
        cells = [no_formula(cell) if isinstance(cell, str) else cell for cell in cells]
        writer.writerow([nothing if cell == "" else cell for cell in cells])
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

    def __init__(self, content: Content, protocol: Protocol, progress: Progress) -> None:
        self._content, self._protocol, self._progress = content, protocol, progress
        self._runs = [event for event in content.events if event.kind == "run"]
        self._hands = [event for event in content.events if event.kind == "hand"]

    def row(self, db: sqlite3.Connection, trial: Trial) -> dict[str, Any]:
        """Return the row of a trial as it was shown."""
        progress, protocol = self._progress, self._protocol
        attempt = progress.attempts(trial)
        own = [event for event in progress.events[trial.key] if event.attempt == attempt]
        row: dict[str, Any] = dict.fromkeys(COLUMNS, "")
        if protocol.design.passage:
            row |= dict.fromkeys(OF_PASSAGES, "")
        row |= self._planned(trial) | self._happened(trial, own) | {"attempt": attempt}
        if trial.key in progress.answers:
            row |= self._answered(trial, own) | self._read(db, trial, own)
        row |= {f"item_{name}": trial.columns.get(name, "") for name in protocol.item_columns}
        for item in protocol.questionnaire:
            number = {"trial": trial.number, "block": trial.block}.get(item.when, 0)
            event = progress.replies.get((item.name, number))
            reply = "" if event is None or trial.practice else event.data["reply"]
            row[f"asked_{item.name}"] = reply
            if item.right:
                right = reply == item.of(trial.columns).right
                row[f"asked_{item.name}_correct"] = int(right) if reply else ""
        fields = self._content.head.get("fields", {})
        return row | {f"field_{name}": value for name, value in fields.items()}

    def _planned(self, trial: Trial) -> dict[str, Any]:
        """Return the cells on what was planned."""
        protocol, plan, first = self._protocol, self._content.plan, trial.stimuli[0]
        style = protocol.style(first.look)
        levels = protocol.levels(trial.condition, plan.group)
        right = protocol.asks.right_answer(trial) if first.picture else ""
        return {
            "session": self._content.path.stem,
            "participant": plan.participant,
            "protocol": protocol.name,
            "number": plan.session,
            "group": plan.group,
            **{f"factor_{name}": level for name, level in levels.items()},
            "practice": int(trial.practice),
            "block": trial.block,
            "trial": trial.number,
            "condition": trial.condition,
            "catch": trial.catch,
            "texture": style.tuning.texture,
            "contrast": style.tuning.contrast,
            "texture_cycles": style.tuning.cycles if protocol.model != "vbd" else "",
            "model": protocol.model,
            "mapping": "" if first.picture else style.mapping.name,
            "on": "paper" if protocol.medium == "paper" else first.on,
            "scene": first.look.scene or "",
            **{name: f"{getattr(style.geometry, name):g}" for name in LENGTHS},
            "parameter": protocol.design.parameter,
            "presented": right or trial.presented,
            "string_set": "" if trial.values else trial.item,
            "table": first.look.table or "",
            "text": first.text,
            "question": protocol.asks.kind,
            "gap_s": trial.gap_s,
        }

    def _happened(self, trial: Trial, own: list[Event]) -> dict[str, Any]:
        """Return the cells on what happened in the attempt that counts."""
        notes = [e.data["text"] for e in self._progress.events[trial.key] if e.kind == "note"]
        cue, contact = _first(own, "cue"), _first(own, "contact")
        row: dict[str, Any] = {
            "paused_s": round(_paused_s(own), 6),
            "warned": int(_first(own, "warning") is not None),
            "faults": "; ".join(event.data["what"] for event in own if event.kind == "fault"),
            "notes": "; ".join(notes),
            "early": 0,
            "late": int(trial.key in self._progress.missed),
            "analysed": 0,
        }
        if cue is not None:
            row["cue_time"] = cue.wall
            row |= {} if contact is None else {"contact_s": round(contact.t_s - cue.t_s, 6)}
        return row

    def _answered(self, trial: Trial, own: list[Event]) -> dict[str, Any]:
        """Return the cells on the answer that counts."""
        progress, asks = self._progress, self._protocol.asks
        answer, confidence = progress.answers[trial.key], progress.confidences.get(trial.key)
        given, data = answer.data["answer"], answer.data
        before = _first(progress.events[trial.key], "answer") or answer
        first, correct = before.data["answer"], asks.correct(trial, given)
        run = next(run for run in reversed(self._runs) if run.n < answer.n)
        row = {
            "answered": asks.cell(trial, given),
            "correct": "" if correct is None else int(correct),
            "outcome": asks.outcome(trial, given),
            "confidence": "" if confidence is None else confidence.data["confidence"],
            "first_answer": "" if first == given else asks.cell(trial, first),
            "answers_from": run.data["answers"],
            "moved_by": self._moved_by(run, own, answer),
            "ended_by": data.get("ended_by", ""),
            "answer_time": answer.wall,
            "early": int(data.get("early", False)),
            "late": int(data.get("late", False)),
            "analysed": int(not trial.catch or asks.counts_catch),
        }
        cue, ended = _first(own, "cue"), _first(own[::-1], "ended")
        if cue is not None:
            until = answer
            if ended is not None and ended.data.get("by") != "exposure":
                until = ended
            row["response_s"] = round(until.t_s - cue.t_s - _paused_s(own), 6)
        return row

    def _moved_by(self, run: Event, own: list[Event], answer: Event) -> str:
        """Return the hand that moved a simulated array; empty if a person moved it."""
        start = own[0].n if own else answer.n
        before = [hand.data["held"] for hand in self._hands if hand.n <= start]
        within = [hand.data["held"] for hand in self._hands if start < hand.n < answer.n]
        if any((*before[-1:], *within)):
            return "simulated:pointer"
        hand = run.data.get("conditions", {}).get("hand", "") if run.data.get("simulated") else ""
        return f"simulated:{hand}" if hand else ""

    def _read(self, db: sqlite3.Connection, trial: Trial, own: list[Event]) -> dict[str, Any]:
        """Return the cells on how strings were read, which the ticks tell."""
        protocol, first = self._protocol, trial.stimuli[0]
        cues = [event for event in own if event.kind == "cue" and not event.data.get("turned")]
        if protocol.design.passage:
            return self._read_passage(db, trial, own)
        if len(trial.stimuli) > 1 or not cues or first.picture:
            return {}
        if "line" not in cues[-1].data:
            end = _first(own[::-1], "read")
            return {} if end is None else {"duration_s": round(end.t_s - cues[-1].t_s, 6)}
        edges, line = edges_mm(protocol, first), cues[-1].data["line"]
        ticks = read_ticks(db, line, line, ("line", "time_ns", "x_mm"))
        found = duration(ticks, edges[0], protocol.wanted.span_mm) if edges else None
        if found is None:
            return {}
        row: dict[str, Any] = {"returned": int(found.returned)}
        if self._progress.answers[trial.key].data.get("early"):
            return row
        row["duration_s"] = round(found.seconds, 6)
        if _paused_s(own):
            return row
        read = ticks[found.ticks]
        last_mm = edges[-1] + protocol.style(first.look).geometry.dot_width_mm
        return row | describe(read["x_mm"], read["time_ns"], edges[0], last_mm)

    def _read_passage(
        self, db: sqlite3.Connection, trial: Trial, own: list[Event]
    ) -> dict[str, Any]:
        """Return the cells on a passage: its speed, the pauses of the hand, and its regressions."""
        protocol, words = self._protocol, len(trial.item.split())
        row: dict[str, Any] = {"lines": len(trial.stimuli), "words": words}
        shown = {event.data["stimulus"]: event.data["line"] for event in own if event.kind == "cue"}
        contact, read = _first(own, "contact"), _first(own[::-1], "read", "ended")
        if contact is None or read is None or len(shown) < len(trial.stimuli):
            return row
        seconds = read.t_s - contact.t_s - _paused_s(own)
        if seconds > 0:
            row["words_per_minute"] = round(60 * words / seconds, 3)
        lines = []
        for number, stimulus in enumerate(trial.stimuli):
            ticks = read_ticks(db, shown[number], shown[number])
            half_mm = protocol.style(stimulus.look).geometry.cell_pitch_mm / 2
            edge_mm = edges_mm(protocol, stimulus)[0]
            lines.append(pauses(ticks, edge_mm, protocol.wanted.span_mm, half_mm))
        number, seconds, back = map(sum, zip(*lines, strict=True))
        told = {"hand_pauses": number, "hand_paused_s": round(seconds, 3), "regressions": back}
        return row | told


def _first(events: list[Event], *kinds: str) -> Event | None:
    return next((event for event in events if event.kind in kinds), None)


def _paused_s(events: list[Event]) -> float:
    """Return how long a trial was paused."""
    paused_s, began_s = 0.0, None
    for event in events:
        if event.kind == "pause":
            began_s = event.t_s
        elif event.kind in ("go", "answer") and began_s is not None:
            paused_s, began_s = paused_s + event.t_s - began_s, None
    return paused_s


def best_level(path: Path, parameter: str) -> float:
    """Return the value of a parameter at which most characters of a session were read right.

    Raises
    ------
    ValueError
        If the session has no answers that tell.
    """
    right: Counter[float] = Counter()
    total: Counter[float] = Counter()
    for row in rows(path):
        if row["analysed"] and row["question"] == "identify":
            presented, answered = row["presented"], row["answered"]
            pairs = zip(presented, answered.ljust(len(presented), UNREAD), strict=False)
            right[row[parameter]] += sum(one == other for one, other in pairs)
            total[row[parameter]] += len(presented)
    if not total:
        raise ValueError(f"{path} has no answers that tell which {parameter} is read best")
    return max(sorted(total), key=lambda value: right[value] / total[value])
