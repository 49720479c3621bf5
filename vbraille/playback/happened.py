"""What happened in a session, from its journal, as moments of its recording."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.live.messages import PlayedEvent
from vbraille.sessions.record import events

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.sessions.record.events import JournalEvent
    from vbraille.sessions.record.progress import Progress


def moments_of(
    told: Iterable[JournalEvent], progress: Progress, begun_s: float = 0.0
) -> list[PlayedEvent]:
    """Make the moments of events, by time.

    Parameters
    ----------
    told
        Events of the journal.
    progress
        State of the session after all of them.
    begun_s
        Time of the session at which the recording begins, in seconds that the session had run for.
    """
    made = []
    for event in told:
        found = _say(event, progress)
        if found is not None:
            kind, text = found
            made.append(PlayedEvent(max(event.t_s - begun_s, 0.0), kind, _in_trial(event) + text))
    # The journal may have an event a little later than one that happened after it.
    return sorted(made, key=lambda moment: moment.at_s)


def _in_trial(event: JournalEvent) -> str:
    if not isinstance(event, events.AnyTime) or not event.trial:
        return ""
    return f"{'practice trial' if event.practice else 'trial'} {event.trial}: "


def _say(event: JournalEvent, progress: Progress) -> tuple[str, str] | None:
    """Kind of the moment of an event, and what happened; None for what nobody looks for."""
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
