"""Writing of what happens into the journal, with the time and the trial of each event."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from vbraille.devices.events import HandHeld
from vbraille.devices.sentences import told
from vbraille.sessions.record import events

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from vbraille.devices.events import Event
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.events import JournalEvent
    from vbraille.sessions.record.journal import Journal
    from vbraille.sessions.record.progress import Progress


class Happened(NamedTuple):
    """Something that the experimenter or the journal should be told.

    Parameters
    ----------
    kind
        Kind of event: ``Contact`` if the array came to the first dot, ``Read`` if the hand went
        to the end and back, ``Fault`` if the stimulus can no longer be felt, ``Well`` if it can be
        felt again, ``Device`` if the device reports something, ``HandTaken`` and
        ``HandGivenBack`` if somebody at the live view becomes its hand or lets that go.
    fields
        Those fields of the kind that are known here.
    said
        Sentence for the experimenter; empty if there is none.
    """

    kind: type[JournalEvent]
    fields: dict[str, Any]
    said: str = ""


def reported(what: str) -> Happened:
    """Make what has happened of a sentence on the device."""
    return Happened(events.Device, {"what": what}, what)


def of_device(given: Iterable[Event]) -> list[Happened]:
    """What events of a device, or of its engine, mean for a session."""
    return [_meant(event, sentence) for event in given for sentence in told((event,))]


def _meant(event: Event, sentence: str) -> Happened:
    if not isinstance(event, HandHeld):
        return reported(sentence)
    return Happened(events.HandTaken if event.held else events.HandGivenBack, {}, sentence)


def _nobody(_event: JournalEvent, _ago_ns: int) -> None:
    """Tell nobody of an event."""


class Logbook:
    """Book in which the events of a run are written, and by which its progress is updated.

    Parameters
    ----------
    journal
        Journal that every event is added to.
    progress
        State of the session, which every event updates.
    now_ns
        Function that tells the time by the clock of the run.

    Attributes
    ----------
    script_line : int
        Number of the line of an answers file that is being done; the next event keeps it.
    mark : Callable[[JournalEvent, int], None]
        Function that is told each event once it is in the journal, and how many nanoseconds ago it
        happened; it must not wait.
    """

    def __init__(self, journal: Journal, progress: Progress, now_ns: Callable[[], int]) -> None:
        self.script_line = 0
        self.mark: Callable[[JournalEvent, int], None] = _nobody
        self._journal = journal
        self._progress = progress
        self._now_ns = now_ns
        self.begin()

    def begin(self) -> None:
        """Begin a run: its time goes on from the total length of the runs before it."""
        self._begun_ns, self._begun_s = self._now_ns(), self._progress.t_s

    @property
    def elapsed_s(self) -> float:
        """Seconds that the session has run for, without the time between runs."""
        return self._begun_s + (self._now_ns() - self._begun_ns) / 1e9

    def log(self, kind: type[JournalEvent], trial: Trial | None = None, **fields: Any) -> None:
        """Write an event; if its kind is durable, it is on the disk when this returns.

        Parameters
        ----------
        kind
            Kind of the event.
        trial
            Trial that the event happened in; None if it was in none.
        fields
            Fields of that kind. If ``time_ns`` is among them, the event happened at that time;
            else it happens now.
        """
        at_ns = fields.get("time_ns", self._now_ns())
        fields["t_s"] = round(self._begun_s + (at_ns - self._begun_ns) / 1e9, 6)
        if trial is not None:
            fields |= {"trial": trial.number, "practice": trial.practice}
        event = kind(script_line=self.script_line, **fields)
        self.script_line = 0
        written = self._journal.append(event)
        self.mark(written, self._now_ns() - at_ns)
        self._progress.take(written)
