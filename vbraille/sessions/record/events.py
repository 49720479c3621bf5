"""The kinds of events that a session's journal may have, a class for each, and their JSON.

`docs/session-format.md` has the same as a table. An event has no other fields than its class.
A new kind or field needs a higher `vbraille.sessions.record.folder.FORMAT`.
"""

from __future__ import annotations

import json
import re
from typing import Any, ClassVar, Union

import msgspec

OTHER = 255  # byte of a marker of an event that has none of its own


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

    # Byte of a marker of the kind. It is no longer another kind's once sessions were recorded.
    code: ClassVar[int] = OTHER
    # Whether events of the kind are on the disk before the console says anything about them.
    durable: ClassVar[bool] = False
    exported: ClassVar[bool] = True  # whether tables of events have the kind

    n: int = 0
    t_s: float
    wall: str = ""
    up_s: float | None = None
    script_line: int = 0

    @property
    def kind(self) -> str:
        """Name of the event's kind, as in the journal."""
        return str(self.__struct_config__.tag)

    @property
    def said(self) -> str:
        """Text that the event carries, for tables of events; empty for kinds without one."""
        return ""


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
        Which stimulus of the trial it is, from 0.
    """

    attempt: int
    stimulus: int


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


class LiveView(msgspec.Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """View that the live view gives of a run.

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

    code: ClassVar[int] = 1
    exported: ClassVar[bool] = False
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
    torn_bytes: int = 0
    torn_file: dict[str, Any] = {}
    monitor: LiveView | None = None
    calibration: dict[str, Any] | None = None


class Presented(WithStimulus, frozen=True, kw_only=True):
    """A stimulus was put under the hand.

    Parameters
    ----------
    line
        Number of the showing, which the trace has as `line`; left out on paper, and on a
        conventional display.
    tuning
        Contrast or texture that the experimenter has set instead of the stimulus's own.
    shown
        The stimulus itself, in the form that `plan.json` has.
    """

    code: ClassVar[int] = 2

    line: int = 0
    tuning: dict[str, float] = {}
    shown: dict[str, Any]


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

    code: ClassVar[int] = 27
    durable: ClassVar[bool] = True

    driver: str
    model: str
    columns: int
    rows: int
    spec: str


class Stood(WithStimulus, frozen=True, kw_only=True):
    """Cells were put on the conventional display.

    Parameters
    ----------
    cells
        What stands on it from its left, in Unicode braille; left out if nothing does any more.
    reference
        Whether that is what the stimuli are compared with, and not the stimulus itself.
    time_ns
        Time at which the display's driver had taken it, by the host's monotonic clock.
    """

    code: ClassVar[int] = 26

    cells: str = ""
    reference: bool = False
    time_ns: int


class Cue(InTrial, frozen=True):
    """The start signal sounded."""

    code: ClassVar[int] = 3


class Contact(WithStimulus, frozen=True, kw_only=True):
    """The array came to the first dot.

    Parameters
    ----------
    tick, time_ns
        Number and time of the tick at which it came there, as in the trace.
    """

    code: ClassVar[int] = 4

    tick: int
    time_ns: int


class Read(WithStimulus, frozen=True, kw_only=True):
    """The stimulus was read: the hand went to its end and back, or off the device Enter said so.

    Parameters
    ----------
    tick, time_ns
        Number and time of the tick at which it was read, as in the trace; left out off the device.
    """

    code: ClassVar[int] = 5

    tick: int | None = None
    time_ns: int | None = None


class Ended(WithStimulus, frozen=True, kw_only=True):
    """The participant's own key, or the limit of the exposure, ended the reading of a stimulus.

    Parameters
    ----------
    by
        What it was: "button:N" of the device, "key:NAME", or "exposure".
    time_ns
        Time of it by the host's monotonic clock, as in the trace; left out if it is not known.
    """

    code: ClassVar[int] = 22

    by: str
    time_ns: int | None = None

    @property
    def said(self) -> str:
        """Text of the event."""
        return self.by


class Warning(InTrial, frozen=True):  # noqa: A001 - the protocol calls it so
    """The warning sounded."""

    code: ClassVar[int] = 6


class Answer(InTrial, frozen=True, kw_only=True):
    """An answer was given.

    Parameters
    ----------
    attempt
        Number of the attempt at the trial that was answered.
    answer
        The answer: Unicode braille with `?` for a place not read; 1 or 2, for the stimulus
        chosen; or as `[question]` has it: yes or no, same or different, a number, or words.
    corrects
        Whether the answer replaces one that was taken back.
    early
        Whether the answer came before the trial was read to its end.
    confidence
        How sure the answer is, on the protocol's scale; left out if that is not asked.
    confidence_s
        Seconds from the answer to its confidence, with which it was written.
    ended_by
        What ended reading: "button:N", "key:NAME", "exposure", or "answer" if the answer came
        before these; left out if the protocol has no such key and no limit of the exposure.
    late
        Whether the answer came after the time that the protocol gives for it.
    """

    code: ClassVar[int] = 7
    durable: ClassVar[bool] = True

    attempt: int
    answer: str
    corrects: bool = False
    early: bool = False
    confidence: int | None = None
    confidence_s: float = 0.0
    ended_by: str = ""
    late: bool = False

    @property
    def said(self) -> str:
        """Answer, with its confidence."""
        return self.answer + ("" if self.confidence is None else f"; {self.confidence}")


class Missed(InTrial, frozen=True, kw_only=True):
    """The time for an answer was over, and the trial ended without one.

    Parameters
    ----------
    attempt
        Number of the attempt at the trial that was not answered.
    """

    code: ClassVar[int] = 28
    durable: ClassVar[bool] = True

    attempt: int


class Undo(InTrial, frozen=True):
    """The last answer was taken back; the record keeps it."""

    code: ClassVar[int] = 8
    durable: ClassVar[bool] = True


class Repeat(InTrial, frozen=True):
    """The experimenter asked for the trial to be shown again."""

    code: ClassVar[int] = 9
    durable: ClassVar[bool] = True


class Fault(InTrial, frozen=True, kw_only=True):
    """The stimulus could no longer be felt, because of the device or the engine.

    Parameters
    ----------
    what
        What went wrong, in words for people.
    attempt
        Number of the attempt at the trial in which it went wrong.
    stimulus
        Which stimulus of the trial it is, from 0; left out if the engine
        died.
    tick, time_ns
        Number and time of the first tick that was not felt, as in the trace; left out if the
        engine died.
    """

    code: ClassVar[int] = 10
    durable: ClassVar[bool] = True

    what: str
    attempt: int
    stimulus: int | None = None
    tick: int | None = None
    time_ns: int | None = None

    @property
    def said(self) -> str:
        """Text of the event."""
        return self.what


class Well(WithStimulus, frozen=True, kw_only=True):
    """The stimulus could be felt again after a fault.

    Parameters
    ----------
    tick, time_ns
        Number and time of the first tick that was felt again, as in the trace.
    """

    code: ClassVar[int] = 11

    tick: int
    time_ns: int


class Device(JournalEvent, frozen=True, kw_only=True):
    """The device reported something.

    Parameters
    ----------
    what
        What the device reported, in words for people.
    """

    code: ClassVar[int] = 18

    what: str

    @property
    def said(self) -> str:
        """Text of the event."""
        return self.what


class HandTaken(AnyTime, frozen=True):
    """A page of the live view became the hand of the simulated device."""

    code: ClassVar[int] = 23


class HandGivenBack(AnyTime, frozen=True):
    """The simulated hand was let go at the live view, and moves by itself."""

    code: ClassVar[int] = 24


class Pause(AnyTime, frozen=True):
    """The session was paused, and the array brought to rest."""

    code: ClassVar[int] = 12
    durable: ClassVar[bool] = True


class Go(AnyTime, frozen=True):
    """The session went on after a pause or a break. An answer ends a pause as well."""

    code: ClassVar[int] = 13


class BreakWanted(AnyTime, frozen=True):
    """The experimenter asked for a break."""

    code: ClassVar[int] = 25
    exported: ClassVar[bool] = False


class Break(JournalEvent, frozen=True):
    """A break began."""

    code: ClassVar[int] = 14
    durable: ClassVar[bool] = True


class Begin(JournalEvent, frozen=True):
    """Practice was ended."""

    code: ClassVar[int] = 15
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

    code: ClassVar[int] = 17
    exported: ClassVar[bool] = False
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

    code: ClassVar[int] = 16
    durable: ClassVar[bool] = True

    text: str

    @property
    def said(self) -> str:
        """Text of the event."""
        return self.text


class Reply(AnyTime, frozen=True, kw_only=True):
    """A question of the questionnaire was answered; of several answers to one the last counts.

    Parameters
    ----------
    name
        Name of the question.
    answer
        The answer.
    block
        Number of the block after which it was asked; left out at other times.
    """

    code: ClassVar[int] = 29
    durable: ClassVar[bool] = True

    name: str
    answer: str
    block: int = 0

    @property
    def said(self) -> str:
        """Name and answer."""
        return f"{self.name}: {self.answer}"


class Stop(JournalEvent, frozen=True):
    """The session was stopped, and can be resumed."""

    code: ClassVar[int] = 19
    durable: ClassVar[bool] = True


class End(JournalEvent, frozen=True, kw_only=True):
    """The session was ended for good.

    Parameters
    ----------
    why
        Reason for the end, in words for people.
    reason
        Reason for which the participant stopped for good; left out if all trials are done.
    """

    code: ClassVar[int] = 20
    durable: ClassVar[bool] = True

    why: str
    reason: str = ""

    @property
    def said(self) -> str:
        """Text of the event."""
        return f"{self.why}: {self.reason}" if self.reason else self.why


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

    code: ClassVar[int] = 21
    exported: ClassVar[bool] = False
    durable: ClassVar[bool] = True

    lost: int | None = None
    counts: dict[str, int] = {}
    trace: str = ""
    trace_bytes: int = 0
    trace_sha256: str = ""


# All kinds that a journal may have, in the order of this file.
KINDS = tuple(
    kind
    for kind in list(globals().values())
    if isinstance(kind, type) and issubclass(kind, JournalEvent) and not kind.__subclasses__()
)
AnyEvent = Union[KINDS]  # noqa: UP007 - pyright: ignore[reportInvalidTypeForm]


class Lost(JournalEvent, frozen=True):
    """Stand-in for a damaged event when a journal is salvaged; no journal has this kind."""

    exported: ClassVar[bool] = False


_FROM_JSON = msgspec.json.Decoder(AnyEvent)
_FIELD = re.compile(r"Object (missing required|contains unknown) field `(.+?)`")


def read_event(line: bytes) -> JournalEvent:
    """Read an event from a line of a journal, given as JSON without its checksum.

    Raises
    ------
    ValueError
        If the kind is not known, or the fields are not those of the kind. The message goes on
        a sentence that begins with the number of the line.
    """
    try:
        return _FROM_JSON.decode(line)
    except msgspec.ValidationError as error:
        raise ValueError(_fault(json.loads(line), str(error))) from None
    except msgspec.DecodeError:
        return _read_slowly(line)


def _read_slowly(line: bytes) -> JournalEvent:
    """Read an event that has a lone surrogate, as file names may; fail if it is not JSON."""
    try:
        told = json.loads(line)
    except ValueError:
        raise ValueError("is not JSON") from None
    try:
        return msgspec.convert(told, AnyEvent)
    except msgspec.ValidationError as error:
        raise ValueError(_fault(told, str(error))) from None


def _fault(told: Any, why: str) -> str:
    """Say what is wrong with JSON that is not an event."""
    kind = told.get("event") if isinstance(told, dict) else None
    if kind is None or why.endswith("`$.event`"):
        return f"has an event of the kind {kind!r}, which this vbraille does not know"
    has = f"has an event of the kind {kind!r}"
    found = _FIELD.match(why)
    if found is None:
        return f"{has} that cannot be read: {why}"
    missing = found[1] == "missing required"
    return f"{has} {'without' if missing else 'with an unknown field,'} {found[2]!r}"


def to_json(event: JournalEvent) -> dict[str, Any]:
    """Event in the form that the journal has; `read_event` makes an equal event of it."""
    told = msgspec.to_builtins(event)
    # The number and the kind come first and the times last, for people who read the journal.
    first = {"n": told.pop("n", 0), "event": told.pop("event")}
    last = {name: told.pop(name) for name in ("t_s", "wall", "up_s") if name in told}
    return first | told | last
