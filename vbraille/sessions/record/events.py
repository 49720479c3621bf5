"""The events of a session's journal, a class for each kind: this is the table of them.

`docs/session-format.md` has the same table. What a class does not have, no event of its kind has;
who adds a kind, or a field, raises `vbraille.sessions.record.folder.FORMAT`.
"""

from __future__ import annotations

import json
import re
from typing import Any, ClassVar

import msgspec


def _kind_of(name: str) -> str:
    """Name of an event's kind in the journal, such as break_wanted for BreakWanted."""
    return re.sub("(?<=[a-z])(?=[A-Z])", "_", name).lower()


class Event(
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
        Its number, from 1. The journal gives it.
    t_s
        Seconds that the session had run for, without the time between runs.
    wall
        When it was by the wall clock, UTC. The journal tells.
    up_s
        The same in seconds since the machine was started, asleep or not; not in format 1. The
        journal tells.
    script_line
        Line of an answers file that it came of; 0 if it came of none.
    """

    # Whether it is on the disk before anything is said of it.
    durable: ClassVar[bool] = False

    n: int = 0
    t_s: float
    wall: str = ""
    up_s: float | None = None
    script_line: int = 0

    @property
    def kind(self) -> str:
        """What happened, by the name that the journal has for it."""
        return str(self.__struct_config__.tag)


class AnyTime(Event, frozen=True, kw_only=True):
    """Something that happens between trials, or in one.

    Parameters
    ----------
    trial
        Number of the trial that was open; 0 if none was.
    practice
        Whether that is a trial of practice.
    """

    trial: int = 0
    practice: bool = False


class InTrial(AnyTime, frozen=True, kw_only=True):
    """Something that happens in a trial only."""

    def __post_init__(self) -> None:
        if self.trial < 1:
            raise ValueError("it is of no trial")


class WithStimulus(InTrial, frozen=True, kw_only=True):
    """Something that happens to a stimulus of a trial.

    Parameters
    ----------
    attempt
        How often the trial had been begun, this time too.
    stimulus
        0, or 1 for the second of two.
    """

    attempt: int
    stimulus: int


class Session(Event, frozen=True, forbid_unknown_fields=False, kw_only=True):
    """The session was put on the disk; it is the first event of all.

    Parameters
    ----------
    format
        Format of the session's files.
    sha256
        SHA-256 of each of the first three files, by its name.
    """

    format: int
    sha256: dict[str, str]


class Run(Event, frozen=True, kw_only=True):
    """The session is run, or resumed, or its engine is started again.

    Parameters
    ----------
    why
        Start, resume or fault.
    trace
        File of the run's trace; empty on paper.
    device
        What the device says of itself.
    spec
        Which device was asked for.
    hand
        The hand of a simulated device.
    answers
        Where the answers come from.
    clock
        Machine, or manual where time goes as fast as it can.
    sound
        What the participant's signals are made with.
    practice
        "left out", if the answers are not typed.
    versions
        Versions of the programs that have a part in it.
    boot
        Which start of the machine it is; not in format 1.
    gap_s
        Of a resume, seconds since the last event; left out if nobody knows.
    gap_by
        The clock that tells so: machine by `up_s`, or wall if the machine was started anew since.
    clock_moved_s
        By how much the wall clock was set since the last event, if by more than a second.
    torn_bytes
        Length of what was set aside from the journal's end.
    torn_file
        Length (`bytes`) and checksum (`crc`) of all that `journal.torn` has by then.
    """

    durable: ClassVar[bool] = True

    why: str
    trace: str = ""
    device: dict[str, Any] = {}
    spec: str = ""
    hand: str | None = None
    answers: str = ""
    clock: str = ""
    sound: str = ""
    practice: str = ""
    versions: dict[str, str] = {}
    boot: str = ""
    gap_s: float | None = None
    gap_by: str = ""
    clock_moved_s: float | None = None
    torn_bytes: int = 0
    torn_file: dict[str, Any] = {}


class Presented(WithStimulus, frozen=True, kw_only=True):
    """A stimulus was put under the hand.

    Parameters
    ----------
    line
        Its number in the trace; left out on paper.
    tuning
        What the experimenter has set, instead of the stimulus's own.
    shown
        The stimulus itself, as `plan.json` has it; from format 4 on.
    """

    line: int = 0
    tuning: dict[str, float] = {}
    shown: dict[str, Any] = {}


class Cue(InTrial, frozen=True):
    """The start signal sounded."""


class Contact(WithStimulus, frozen=True, kw_only=True):
    """The array came to the first dot.

    Parameters
    ----------
    tick, time_ns
        The tick, as in the trace.
    """

    tick: int
    time_ns: int


class Read(WithStimulus, frozen=True, kw_only=True):
    """The hand went to the end and back; on paper, a key said so.

    Parameters
    ----------
    tick, time_ns
        The tick, as in the trace; left out on paper.
    """

    tick: int | None = None
    time_ns: int | None = None


class Warning(InTrial, frozen=True):  # noqa: A001 - the protocol calls it so
    """The warning sounded."""


class Answer(InTrial, frozen=True, kw_only=True):
    """An answer was given.

    Parameters
    ----------
    attempt
        The attempt that it was given to.
    answer
        Unicode braille, `?` for a place not read; or 1 or 2.
    corrects
        Whether it comes instead of one that was taken back.
    early
        Whether it came before the trial was read to its end.
    """

    durable: ClassVar[bool] = True

    attempt: int
    answer: str
    corrects: bool = False
    early: bool = False


class Undo(InTrial, frozen=True):
    """The last answer was taken back; it stays in the record."""

    durable: ClassVar[bool] = True


class Repeat(InTrial, frozen=True):
    """The trial is shown again because the experimenter says so."""

    durable: ClassVar[bool] = True


class Fault(InTrial, frozen=True, kw_only=True):
    """What is shown began not to be felt.

    Parameters
    ----------
    what
        Why not, for people.
    attempt
        The attempt in which it was so.
    stimulus
        0, or 1 for the second of two; left out if the engine died.
    tick, time_ns
        The first such tick, as in the trace; left out if the engine died.
    """

    durable: ClassVar[bool] = True

    what: str
    attempt: int
    stimulus: int | None = None
    tick: int | None = None
    time_ns: int | None = None


class Well(WithStimulus, frozen=True, kw_only=True):
    """What is shown is felt again, after a fault.

    Parameters
    ----------
    tick, time_ns
        The first such tick, as in the trace.
    """

    tick: int
    time_ns: int


class Device(Event, frozen=True, kw_only=True):
    """The device had something to say.

    Parameters
    ----------
    what
        What it said.
    """

    what: str


class Pause(AnyTime, frozen=True):
    """The array was rested."""

    durable: ClassVar[bool] = True


class Go(AnyTime, frozen=True):
    """The session went on after a pause or a break; an answer ends a pause too."""


class BreakWanted(AnyTime, frozen=True):
    """A break was asked for."""


class Break(Event, frozen=True):
    """A break was begun."""

    durable: ClassVar[bool] = True


class Begin(Event, frozen=True):
    """Practice is over."""

    durable: ClassVar[bool] = True


class Tuning(AnyTime, frozen=True, kw_only=True):
    """The experimenter set contrast or texture, for all that follows.

    Parameters
    ----------
    tuning
        All that is set by now.
    line
        The new number in the trace, if a trial was open.
    """

    durable: ClassVar[bool] = True

    tuning: dict[str, float]
    line: int = 0


class Note(AnyTime, frozen=True, kw_only=True):
    """The experimenter wrote something down.

    Parameters
    ----------
    text
        The note.
    """

    durable: ClassVar[bool] = True

    text: str


class Stop(Event, frozen=True):
    """The session was ended for now."""

    durable: ClassVar[bool] = True


class End(Event, frozen=True, kw_only=True):
    """The session was ended for good.

    Parameters
    ----------
    why
        What ended it.
    """

    durable: ClassVar[bool] = True

    why: str


class Closed(Event, frozen=True, kw_only=True):
    """The engine was closed, or it died.

    Parameters
    ----------
    lost
        Ticks that were never recorded; left out if the engine died.
    counts
        What went wrong with the device, and how often; left out if nothing did or the engine died.
    trace
        File of the run's trace.
    trace_bytes
        Its length.
    trace_sha256
        Its SHA-256; from format 2 on.
    """

    durable: ClassVar[bool] = True

    lost: int | None = None
    counts: dict[str, int] = {}
    trace: str = ""
    trace_bytes: int = 0
    trace_sha256: str = ""


class Lost(Event, frozen=True):
    """An event of a damaged journal that is not whole; no journal has it, a salvaged one tells."""


Kind = (
    Session | Run | Presented | Cue | Contact | Read | Warning | Answer | Undo | Repeat
    | Fault | Well | Device | Pause | Go | BreakWanted | Break | Begin | Tuning | Note
    | Stop | End | Closed
)  # fmt: skip
_FROM_JSON = msgspec.json.Decoder(Kind)
_FIELD = re.compile(r"Object (missing required|contains unknown) field `(.+?)`")


def read(line: bytes) -> Event:
    """Event that a line of a journal tells of, as JSON without its checksum.

    Raises
    ------
    ValueError
        If it is of a kind that there is not, or has other fields than its kind. It says so in
        words that go on a sentence which begins with the line.
    """
    try:
        return _FROM_JSON.decode(line)
    except msgspec.ValidationError as error:
        raise ValueError(_fault(json.loads(line), str(error))) from None
    except msgspec.DecodeError:
        return _read_slowly(line)


def _read_slowly(line: bytes) -> Event:
    """Event of a line with a lone surrogate, such as a file's name may have; or of no JSON."""
    try:
        told = json.loads(line)
    except ValueError:
        raise ValueError("is not JSON") from None
    try:
        return msgspec.convert(told, Kind)
    except msgspec.ValidationError as error:
        raise ValueError(_fault(told, str(error))) from None


def _fault(told: Any, why: str) -> str:
    """Say what is wrong with something that is no event."""
    kind = told.get("event") if isinstance(told, dict) else None
    if kind is None or why.endswith("`$.event`"):
        return f"has an event of the kind {kind!r}, which this vbraille does not know"
    has = f"has an event of the kind {kind!r}"
    found = _FIELD.match(why)
    if found is None:
        return f"{has} that cannot be read: {why}"
    missing = found[1] == "missing required"
    return f"{has} {'without' if missing else 'with an unknown field,'} {found[2]!r}"


def to_json(event: Event) -> dict[str, Any]:
    """Event as it goes into the journal; `read` gives an equal one."""
    told = msgspec.to_builtins(event)
    # The number and the kind come first and the times last, for people who read it.
    first = {"n": told.pop("n", 0), "event": told.pop("event")}
    last = {name: told.pop(name) for name in ("t_s", "wall", "up_s") if name in told}
    return first | told | last
