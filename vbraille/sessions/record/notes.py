"""What the experimenter wrote down, each note with the trials that it stands between."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from vbraille.sessions.record.events import AnyTime, Note, Presented

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.sessions.record.events import Event


@dataclass(frozen=True, slots=True)
class PlacedNote:
    """A note, and the trials around it.

    Parameters
    ----------
    text
        As it was typed.
    event
        Number of its event in the journal.
    t_s
        When, in seconds that the session had run for.
    before
        The trial that was shown last before it; 0 if none was.
    trial
        The trial that was open; 0 if none was.
    after
        The trial that was shown next; 0 if none was.
    practice
        Whether it was typed in a trial of practice.
    """

    text: str
    event: int
    t_s: float
    before: int
    trial: int
    after: int
    practice: bool = False


def read_notes(events: Iterable[Event]) -> list[PlacedNote]:
    """Notes of a session, in their order."""
    notes: list[PlacedNote] = []
    before, waiting = 0, 0  # how many of the notes have their next trial still to come
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
                    # Of a trial that is shown again, the note is in it.
                    again = trial if note.before == trial else 0
                    notes[n] = replace(note, trial=again, after=trial)
            before, waiting = trial, 0
    return notes


def texts(notes: Iterable[PlacedNote]) -> str:
    """Write notes in one cell of a table."""
    return "; ".join(note.text for note in notes)
