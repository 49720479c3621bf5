"""What happens at the device in a trial, on its way to the journal and to the experimenter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from vbraille.devices.events import HandHeld
from vbraille.devices.saying import told
from vbraille.sessions.record import events

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.devices.events import Event
    from vbraille.sessions.record.eventbase import JournalEvent


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
    return [_of(event, sentence) for event in given for sentence in told((event,))]


def _of(event: Event, sentence: str) -> Happened:
    if not isinstance(event, HandHeld):
        return reported(sentence)
    return Happened(events.HandTaken if event.held else events.HandGivenBack, {}, sentence)
