"""Notes of the experimenter, each with the trials before and after it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from vbraille.sessions.record.eventbase import AnyTime
from vbraille.sessions.record.events import Note, Presented

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.sessions.record.eventbase import JournalEvent


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
