"""Events on their way into the journal: each gets its time and its trial here."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.events import Event
    from vbraille.sessions.record.journal import Journal
    from vbraille.sessions.record.progress import Progress


class Logbook:
    """Writes down what happens in a run, and lets the progress go on by it.

    Parameters
    ----------
    journal
        Where every event goes.
    progress
        What was done before.
    now_ns
        Tells the time by which the run goes.

    Attributes
    ----------
    script_line : int
        Line of an answers file that is being done; the event that comes of it keeps its number.
    """

    def __init__(self, journal: Journal, progress: Progress, now_ns: Callable[[], int]) -> None:
        self.script_line = 0
        self._journal = journal
        self._progress = progress
        self._now_ns = now_ns
        self.begin()

    @property
    def format(self) -> int:
        """Format of the session, which says what is written down."""
        return self._journal.told.format

    def begin(self) -> None:
        """Begin a run, as long after the session's start as the runs before it were, in all."""
        self._begun_ns, self._begun_s = self._now_ns(), self._progress.t_s

    def log(self, kind: type[Event], trial: Trial | None = None, **fields: Any) -> None:
        """Write an event down; it is on the disk when this returns if its kind is durable.

        Parameters
        ----------
        kind
            What happened.
        trial
            The trial that it happened in; None if it is not of one.
        fields
            The fields of its kind. With ``time_ns``, of a tick, it happened then, else now.
        """
        at_ns = fields.get("time_ns", self._now_ns())
        fields["t_s"] = round(self._begun_s + (at_ns - self._begun_ns) / 1e9, 6)
        if trial is not None:
            fields |= {"trial": trial.number, "practice": trial.practice}
        event = kind(script_line=self.script_line, **fields)
        self.script_line = 0
        self._progress.take(self._journal.append(event))
