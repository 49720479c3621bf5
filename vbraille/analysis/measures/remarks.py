"""What the experimenter wrote down in the sessions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.analysis.schemas import Column, Schema

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.analysis.input.sittings import SessionTrials
    from vbraille.analysis.schemas import ResultTable, Row

NOTES = Schema(
    "notes",
    "Notes of the experimenter",
    "A note that was typed between two trials has none of its own; one typed before the first "
    "trial has none before it, and one after the last has none after it.",
    (
        Column("participant", "participant", "pseudonym"),
        Column("session", "session", "name of the session"),
        Column("text", "note", "as it was typed"),
        Column("trial_before", "trial before", "the one shown last before it"),
        Column("trial", "trial", "the one that was open"),
        Column("trial_after", "trial after", "the one shown next"),
    ),
)


def notes(sittings: Iterable[SessionTrials]) -> ResultTable:
    """Notes of all sessions, in their order."""
    rows: list[Row] = [
        {
            "participant": sitting.head["participant"],
            "session": sitting.name,
            "text": note.text,
            "trial_before": _number(note.before),
            "trial": _number(note.trial),
            "trial_after": _number(note.after),
        }
        for sitting in sittings
        for note in sitting.notes
    ]
    return NOTES.fill(rows)


def _number(trial: int) -> str:
    return str(trial) if trial else "none"
