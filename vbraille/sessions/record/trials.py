"""A session as a table: a row for each trial, made from the plan and the events."""

from __future__ import annotations

import csv
import io
import sqlite3
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vbraille.sessions.planning.shown import make_shown
from vbraille.sessions.planning.protocol import Protocol, parse_protocol
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import Content, Event, read_ticks, reading
from vbraille.sessions.record.record import read as read_record

# Columns and what each holds; `session export --codebook` writes these words.
COLUMNS = {
    "session": "name of the session's file",
    "participant": "pseudonym",
    "protocol": "name of the protocol",
    "practice": "1 in practice",
    "block": "number of the block, 0 in practice",
    "trial": "number of the trial",
    "condition": "name of the condition",
    "catch": "what a catch trial shows; else empty",
    "texture": "texture level, 0 to 1",
    "contrast": "share of the full swing, 0 to 1",
    "texture_cycles": "half-cycles of texture in a radius, on the STReSS²",
    "model": "display that the protocol is written for",
    "mapping": "mapping from dots to rows of actuators",
    "dot_width_mm": "width of a dot",
    "dot_spacing_mm": "distance of the two dot columns of a cell",
    "cell_gap_mm": "distance of the last dot column of a cell and the first of the next",
    "row_spacing_mm": "distance of dot rows",
    "line_pitch_mm": "distance of lines",
    "travel_mm": "way of the carriage",
    "parameter": "what stimuli are compared by",
    "presented": "cells that were asked for, or values that were compared",
    "string_set": "the string as the protocol lists it",
    "answered": "the answer that counts",
    "correct": "1 if it is right, 0 if not",
    "question": "kind of the question",
    "outcome": "how the answer is scored",
    "confidence": "how sure the answer is",
    "first_answer": "the answer that was given first, if another one counts",
    "answers_from": "source of the answer",
    "attempt": "how often the trial was shown",
    "duration_s": "time from the first touch of the first dot to the last (Lévesque 2009, 3.4)",
    "returned": "1 if the hand went back over the first dot",
    "contact_s": "time from the cue to the first dot",
    "response_s": "time from the cue to the answer, pauses left out",
    "ended_by": "what ended reading, if not the hand",
    "paused_s": "time of pauses in the trial",
    "early": "1 if the answer came before the line was read",
    "analysed": "1 if the analysis uses the trial",
    "warned": "1 if the warning sounded",
    "faults": "faults of the device in the attempt that counts",
    "notes": "notes of the experimenter",
    "cue_time": "time of day of the cue, UTC",
    "answer_time": "time of day of the answer, UTC",
}
LENGTHS = [name for name in COLUMNS if name.endswith("_mm")]


def rows(path: Path, *, practice: bool = False) -> list[dict[str, Any]]:
    """Return a row for each trial of a session, with `COLUMNS` and the protocol's fields."""
    content = read_record(path)
    protocol = parse_protocol(content.files["protocol.toml"], f"protocol of {path}")
    protocol = protocol.of_group(content.plan.group)
    progress = Progress(protocol, content.plan, content.events)
    sources = _sources(content)
    fields = {f"field_{name}": value for name, value in content.head["fields"].items()}
    found = []
    with reading(path) as db:
        for trial in map(progress.shown, content.plan.trials):
            if trial is None or (trial.practice and not practice):
                continue
            row = dict.fromkeys(COLUMNS, "")
            row |= _shown(protocol, content, trial)
            row |= _happened(protocol, progress, trial, sources)
            if trial.key in progress.answers and len(trial.stimuli) == 1:
                row |= _read(db, protocol, progress, trial)
            found.append(row | _replies(protocol, progress, trial) | fields)
    return found


def to_csv(table: list[dict[str, Any]]) -> str:
    """Return rows as CSV."""
    text = io.StringIO()
    writer = csv.DictWriter(text, list(table[0]) if table else list(COLUMNS), lineterminator="\n")
    writer.writeheader()
    writer.writerows(table)
    return text.getvalue()


def _shown(protocol: Protocol, content: Content, trial: Trial) -> dict[str, Any]:
    """Return the cells on what was planned."""
    style = protocol.style(trial.stimuli[0].look)
    compared = trial.stimuli[0].value is not None
    levels = protocol.levels(trial.condition, content.plan.group)
    cycles = style.tuning.cycles if protocol.model == "stress2" else ""
    return {
        "session": content.path.stem,
        "participant": content.plan.participant,
        "protocol": protocol.name,
        **{f"factor_{name}": level for name, level in levels.items()},
        "practice": int(trial.practice),
        "block": trial.block,
        "trial": trial.number,
        "condition": trial.condition,
        "catch": trial.catch,
        "texture": style.tuning.texture,
        "contrast": style.tuning.contrast,
        "texture_cycles": cycles,
        "model": protocol.model,
        "mapping": style.mapping.name,
        **{name: f"{getattr(style.geometry, name):g}" for name in LENGTHS},
        "parameter": getattr(protocol.design, "parameter", ""),
        "presented": trial.presented,
        "string_set": "" if compared else trial.item,
        "question": protocol.asks.kind,
    }


def _happened(
    protocol: Protocol, progress: Progress, trial: Trial, sources: list[tuple[int, str]]
) -> dict[str, Any]:
    """Return the cells on what happened, as far as events tell."""
    events, asks = progress.events[trial.key], protocol.asks
    attempt = progress.attempts(trial)
    own = [event for event in events if event.attempt == attempt]
    cue = next((event for event in own if event.kind == "cue"), None)
    contact = next((event for event in own if event.kind == "contact"), None)
    ended = next((event for event in own if event.kind == "ended"), None)
    paused_s = _paused_s(own)
    row: dict[str, Any] = {
        "attempt": attempt,
        "paused_s": round(paused_s, 6),
        "warned": int(any(event.kind == "warning" for event in own)),
        "faults": "; ".join(event.data["what"] for event in own if event.kind == "fault"),
        "notes": "; ".join(event.data["text"] for event in events if event.kind == "note"),
        "cue_time": "" if cue is None else cue.wall,
        "ended_by": "" if ended is None else ended.data["by"],
        "analysed": 0,
        "early": 0,
    }
    if cue is not None and contact is not None:
        row["contact_s"] = round(contact.t_s - cue.t_s, 6)
    answer = progress.answers.get(trial.key)
    if answer is None:
        return row
    given = answer.data["answer"]
    first = next(event.data["answer"] for event in events if event.kind == "answer")
    confidence = progress.confidences.get(trial.key)
    correct = asks.correct(trial, given)
    row |= {
        "answered": asks.cell(trial, given),
        "correct": "" if correct is None else int(correct),
        "outcome": asks.outcome(trial, given),
        "confidence": "" if confidence is None else confidence.data["confidence"],
        "first_answer": "" if first == given else asks.cell(trial, first),
        "answers_from": next(name for n, name in reversed(sources) if n < answer.n),
        "answer_time": answer.wall,
        "analysed": int(not trial.catch or asks.counts_catch),
        "early": int(answer.data.get("early", False)),
    }
    if cue is not None:
        row["response_s"] = round(answer.t_s - cue.t_s - paused_s, 6)
    return row


def _replies(protocol: Protocol, progress: Progress, trial: Trial) -> dict[str, Any]:
    """Return the replies to the questionnaire that go with a trial, and whether they are right."""
    row: dict[str, Any] = {}
    for item in protocol.questionnaire:
        number = {"trial": trial.number, "block": trial.block}.get(item.when, 0)
        reply = progress.replies.get((item.name, number), "")
        row[f"asked_{item.name}"] = reply
        if item.right:
            row[f"asked_{item.name}_correct"] = int(reply == item.right) if reply else ""
    return row


def _paused_s(events: list[Event]) -> float:
    """Return how long a trial was paused."""
    paused_s, began_s = 0.0, None
    for event in events:
        if event.kind == "pause":
            began_s = event.t_s
        elif event.kind == "go" and began_s is not None:
            paused_s, began_s = paused_s + event.t_s - began_s, None
    return paused_s


def _sources(content: Content) -> list[tuple[int, str]]:
    """Return the source of answers from each run on."""
    return [(e.n, e.data["answers"]) for e in content.events if e.kind == "run"]


def _read(
    db: sqlite3.Connection, protocol: Protocol, progress: Progress, trial: Trial
) -> dict[str, Any]:
    """Return the cells on how long the line was read, which the ticks tell."""
    cues = [event for event in progress.events[trial.key] if event.kind == "cue"]
    edges_mm = make_shown(protocol, trial.stimuli[0]).edges_mm
    if protocol.medium == "paper" and cues:
        read = next((e for e in progress.events[trial.key][::-1] if e.kind == "read"), None)
        return {} if read is None else {"duration_s": round(read.t_s - cues[-1].t_s, 6)}
    if not cues or not edges_mm:
        return {}
    line = cues[-1].data["line"]
    ticks = read_ticks(db, line, line)
    found = duration(ticks, edges_mm[0], protocol.display_model.display.span_mm)
    if found is None:
        return {}
    seconds, returned = found
    return {"duration_s": round(seconds, 6), "returned": int(returned)}


def duration(ticks: NDArray[np.void], edge_mm: float, span_mm: float) -> tuple[float, bool] | None:
    """Return how long a line was read, and whether the hand came back; None if it never came.

    Reading begins when the rightmost actuator comes to the left edge of the first dot, and ends
    when it crosses that edge to the left for the last time (Lévesque 2009, 3.4).
    """
    on = ticks["x_mm"] + span_mm / 2 >= edge_mm
    if not on.any():
        return None
    start = int(np.argmax(on))
    left = start + 1 + np.flatnonzero(on[start:-1] & ~on[start + 1 :])
    end = int(left[-1]) if left.size else len(ticks) - 1
    return float(ticks["time_ns"][end] - ticks["time_ns"][start]) / 1e9, bool(left.size)
