"""Events of a session for BIDS: a table for each run, in the time of the run's recording."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vbraille.sessions.record.anonymous import without_paths
from vbraille.sessions.record.events import (
    Answer,
    AnyTime,
    BreakWanted,
    Closed,
    Device,
    End,
    Ended,
    Fault,
    JournalEvent,
    Lost,
    Note,
    Run,
    Tuning,
)
from vbraille.sessions.record.export import to_csv
from vbraille.sessions.record.notes import PlacedNote, read_notes

if TYPE_CHECKING:
    from vbraille.sessions.record.folder import Record

EVENT_COLUMNS = {
    "onset": {"Description": "from the first row of the run's recording", "Units": "s"},
    "duration": {"Description": "no event has one that is known", "Units": "s"},
    "trial_type": {"Description": "what happened, by the names of docs/session-format.md"},
    "practice": {"Description": "1 in a trial of practice, else 0"},
    "trial": {"Description": "number of the trial that it happened in"},
    "trial_before": {"Description": "of a note: the trial that was shown last before it"},
    "trial_after": {"Description": "of a note: the trial that was shown next"},
    "value": {
        "Description": "of an answer, what was answered, and its confidence after a "
        "semicolon; of a note, its text; else what"
    },
}
_LEFT_OUT = (Run, BreakWanted, Tuning, Closed, Lost)


@dataclass(frozen=True, slots=True)
class BidsRun:
    """A run of a session, with its events.

    Parameters
    ----------
    event
        Event that the run began with.
    events
        Events of the run, after that one.
    notes
        All notes of the session, by the numbers of their events.
    """

    event: Run
    events: list[JournalEvent]
    notes: dict[int, PlacedNote]

    def table(self, first_ns: int | None, *, without_times: bool) -> str:
        """Events as a table, with tabs between columns.

        Parameters
        ----------
        first_ns
            Time of the first tick of the run's trace; None if there is none, and times count
            from the event that the run began with.
        without_times
            Whether notes, and words that may be paths, are left out.
        """
        begun_s = self._begun_s(first_ns)
        rows = [
            self._row(event, begun_s, without_times)
            for event in self.events
            if not isinstance(event, (*_LEFT_OUT, Note) if without_times else _LEFT_OUT)
        ]
        # The journal may have an event a little later than one that happened after it.
        rows.sort(key=lambda row: row["onset"])
        if not rows:
            return "\t".join(EVENT_COLUMNS) + "\n"
        return to_csv(rows, "\t", "n/a")

    def _begun_s(self, first_ns: int | None) -> float:
        """Time of the first tick, in seconds that the session had run for."""
        for event in self.events:
            time_ns = getattr(event, "time_ns", None)
            if first_ns is not None and time_ns is not None:
                return event.t_s - (time_ns - first_ns) / 1e9
        return self.event.t_s

    def _row(self, event: JournalEvent, begun_s: float, without_times: bool) -> dict[str, Any]:
        note = self.notes.get(event.n)
        text = _text_of(event)
        return {
            "onset": round(event.t_s - begun_s, 6),
            "duration": "",
            "trial_type": event.kind,
            "practice": int(isinstance(event, AnyTime) and event.practice),
            "trial": (isinstance(event, AnyTime) and event.trial) or "",
            "trial_before": note.before or "" if note else "",
            "trial_after": note.after or "" if note else "",
            "value": without_paths(text) if without_times else text,
        }


def _text_of(event: JournalEvent) -> str:
    """Text that an event carries; empty for kinds without one."""
    match event:
        case Answer():
            sure = "" if event.confidence is None else f"; {event.confidence}"
            return event.answer + sure
        case Ended():
            return event.by
        case Note():
            return event.text
        case Fault() | Device():
            return event.what
        case End():
            return event.why
    return ""


def runs_of(record: Record) -> list[BidsRun]:
    """Runs of a session, in order."""
    notes = {note.event: note for note in read_notes(record.told.events)}
    runs: list[BidsRun] = []
    for event in record.told.events:
        if isinstance(event, Run):
            runs.append(BidsRun(event, [], notes))
        elif runs:
            runs[-1].events.append(event)
    return runs
