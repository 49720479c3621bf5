"""The kinds of events that a session's journal may have, with a class for each kind.

Those that happen in a trial are in `trialevents`, and are named here with the others.

`docs/session-format.md` has the same as a table. An event has no other fields than its class.
A new kind or field needs a higher `vbraille.sessions.record.folder.FORMAT`.
"""

from __future__ import annotations

from typing import Any, ClassVar

import msgspec

from vbraille.sessions.record.eventbase import AnyTime, JournalEvent
from vbraille.sessions.record.trialevents import (
    Answer,
    Contact,
    Cue,
    Ended,
    Fault,
    Presented,
    Read,
    Repeat,
    Stood,
    Undo,
    Warning,  # noqa: A004 - the protocol calls it so
    Well,
)


class LiveView(msgspec.Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """How the live view shows a run to those who watch it.

    Parameters
    ----------
    blind
        Whether it keeps back all from which a stimulus or an answer could be read.
    host
        Address that the page is served at.
    pointer
        Whether a page may be the hand of the simulated device.
    """

    blind: bool
    host: str
    pointer: bool = False


class Session(JournalEvent, frozen=True, forbid_unknown_fields=False, kw_only=True):
    """The session was put on the disk; this is the first event of every journal.

    Parameters
    ----------
    format
        Format of the session's files.
    sha256
        SHA-256 of session.json, protocol.toml and plan.json, by the names of the files.
    """

    format: int
    sha256: dict[str, str]


class Run(JournalEvent, frozen=True, kw_only=True):
    """A run began: the session was started or resumed, or its engine was started again.

    Parameters
    ----------
    why
        Why the run began: start, resume, or fault if the engine had died.
    trace
        Name of the run's trace file; left out on paper.
    device
        Description that the device gives of itself.
    spec
        Spec of the device that was asked for.
    hand
        Hand that moves the simulated device.
    answers
        Source of the answers.
    clock
        Clock of the run: machine, or manual where the session runs as fast as the machine can.
    sound
        Name of what makes the participant's signals.
    practice
        "left out" if there is no practice because the answers are not typed.
    versions
        Versions of the programs that were used.
    boot
        Identifier of the machine's last start, from which `up_s` counts.
    gap_s
        Seconds since the last event of the run before; left out if they are not known.
    gap_by
        Clock that `gap_s` is measured by: machine if `up_s` tells it, or wall if the machine was
        started anew meanwhile.
    torn_bytes
        Length of the torn line that was moved from the journal's end to `journal.torn`.
    torn_file
        Length (`bytes`) and checksum (`crc`) of `journal.torn` when the run began.
    monitor
        What the live view shows: whether it is `blind`, the `host` at which it is served, and
        whether its `pointer` may be the hand; left out without a live view.
    calibration
        What was made up for in the device's actuators, after the frame that the trace keeps:
        `scale`, by which each deflection was multiplied (below 0: the actuator is inverted, and
        sent 1 more), which are `dead` and which `weak`, by row and column from 0, and how many of
        the `actuators` were `tried`; left out if deflections were sent as they are.
    """

    durable: ClassVar[bool] = True

    why: str
    trace: str = ""
    device: dict[str, Any] = {}  # noqa: RUF012  (msgspec copies it)
    spec: str = ""
    hand: str | None = None
    answers: str = ""
    clock: str = ""
    sound: str = ""
    practice: str = ""
    versions: dict[str, str] = {}  # noqa: RUF012  (msgspec copies it)
    boot: str = ""
    gap_s: float | None = None
    gap_by: str = ""
    torn_bytes: int = 0
    torn_file: dict[str, Any] = {}  # noqa: RUF012  (msgspec copies it)
    monitor: LiveView | None = None
    calibration: dict[str, Any] | None = None


class DisplayBeside(JournalEvent, frozen=True, kw_only=True):
    """A conventional display stands ready, or another one than before.

    Parameters
    ----------
    driver, model
        Name of its driver, and what that calls its model.
    columns, rows
        Number of its cells in a row, and of its rows.
    spec
        Display that was asked for.
    """

    durable: ClassVar[bool] = True

    driver: str
    model: str
    columns: int
    rows: int
    spec: str


class Device(JournalEvent, frozen=True, kw_only=True):
    """The device reported something.

    Parameters
    ----------
    what
        What the device reported, in words for people.
    """

    what: str


class HandTaken(AnyTime, frozen=True):
    """A page of the live view became the hand of the simulated device."""


class HandGivenBack(AnyTime, frozen=True):
    """The simulated hand was let go at the live view, and moves by itself."""


class Pause(AnyTime, frozen=True):
    """The session was paused, and the array brought to rest."""

    durable: ClassVar[bool] = True


class Go(AnyTime, frozen=True):
    """The session went on after a pause or a break. An answer ends a pause as well."""


class BreakWanted(AnyTime, frozen=True):
    """The experimenter asked for a break."""


class Break(JournalEvent, frozen=True):
    """A break began."""

    durable: ClassVar[bool] = True


class Begin(JournalEvent, frozen=True):
    """Practice was ended."""

    durable: ClassVar[bool] = True


class Tuning(AnyTime, frozen=True, kw_only=True):
    """The experimenter set contrast or texture for the rest of the session.

    Parameters
    ----------
    tuning
        All values that the experimenter has set so far.
    line
        New number of the showing, which the trace has as `line`; left out if no trial was open.
    """

    durable: ClassVar[bool] = True

    tuning: dict[str, float]
    line: int = 0


class Note(AnyTime, frozen=True, kw_only=True):
    """The experimenter wrote a note.

    Parameters
    ----------
    text
        Text of the note.
    """

    durable: ClassVar[bool] = True

    text: str


class Stop(JournalEvent, frozen=True):
    """The session was stopped, and can be resumed."""

    durable: ClassVar[bool] = True


class End(JournalEvent, frozen=True, kw_only=True):
    """The session was ended for good.

    Parameters
    ----------
    why
        Reason for the end, in words for people.
    """

    durable: ClassVar[bool] = True

    why: str


class Closed(JournalEvent, frozen=True, kw_only=True):
    """The engine was closed, or it died.

    Parameters
    ----------
    lost
        Number of ticks that were never recorded; left out if the engine died.
    counts
        How often each thing went wrong with the device, by name; left out if nothing did or the
        engine died.
    trace
        Name of the run's trace file.
    trace_bytes
        Length of the trace file.
    trace_sha256
        SHA-256 of the trace file.
    """

    durable: ClassVar[bool] = True

    lost: int | None = None
    counts: dict[str, int] = {}  # noqa: RUF012  (msgspec copies it)
    trace: str = ""
    trace_bytes: int = 0
    trace_sha256: str = ""


class Lost(JournalEvent, frozen=True):
    """Stand-in for a damaged event when a journal is salvaged; no journal has this kind."""


AnyEvent = (
    Session | Run | Presented | DisplayBeside | Stood | Cue | Contact | Read | Ended | Warning
    | Answer | Undo | Repeat | Fault | Well | Device | HandTaken | HandGivenBack | Pause | Go
    | BreakWanted | Break | Begin | Tuning | Note | Stop | End | Closed
)  # fmt: skip
