"""What events of a journal have in common."""

from __future__ import annotations

import re
from typing import ClassVar

import msgspec


def _kind_of(name: str) -> str:
    """Name that the journal has for a class of events, such as break_wanted for BreakWanted."""
    return re.sub("(?<=[a-z])(?=[A-Z])", "_", name).lower()


class JournalEvent(
    msgspec.Struct,
    frozen=True,
    kw_only=True,
    omit_defaults=True,
    forbid_unknown_fields=True,
    tag_field="event",
    tag=_kind_of,
):
    """Something that happened in a session.

    Parameters
    ----------
    n
        Number of the event, from 1. It is set when the event is added to the journal.
    t_s
        Seconds that the session had run for, without the time between runs.
    wall
        Time by the wall clock, UTC. It is set when the event is added to the journal.
    up_s
        Seconds since the machine was started, time asleep included. It is set when the event is
        added to the journal.
    script_line
        Number of the line in an answers file that caused the event; 0 if no such line did.
    """

    # Whether events of the kind are on the disk before the console says anything about them.
    durable: ClassVar[bool] = False

    n: int = 0
    t_s: float
    wall: str = ""
    up_s: float | None = None
    script_line: int = 0

    @property
    def kind(self) -> str:
        """Name of the event's kind, as in the journal."""
        return str(self.__struct_config__.tag)


class AnyTime(JournalEvent, frozen=True, kw_only=True):
    """Something that may happen in a trial or between trials.

    Parameters
    ----------
    trial
        Number of the trial that was open; 0 if none was.
    practice
        Whether that trial is practice.
    """

    trial: int = 0
    practice: bool = False


class InTrial(AnyTime, frozen=True, kw_only=True):
    """Something that can happen in a trial only."""

    def __post_init__(self) -> None:
        if self.trial < 1:
            raise ValueError("it is of no trial")


class WithStimulus(InTrial, frozen=True, kw_only=True):
    """Something that happens to a stimulus of a trial.

    Parameters
    ----------
    attempt
        Number of the attempt at the trial, from 1.
    stimulus
        Which stimulus of the trial it is: 0, or 1 for the second of two.
    """

    attempt: int
    stimulus: int
