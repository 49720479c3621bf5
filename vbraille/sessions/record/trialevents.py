"""The kinds of events that happen in a trial; `events` has the others, and all of them together."""

from __future__ import annotations

from typing import Any, ClassVar

from vbraille.sessions.record.eventbase import InTrial, WithStimulus


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

    line: int = 0
    tuning: dict[str, float] = {}  # noqa: RUF012  (msgspec copies it)
    shown: dict[str, Any]


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

    cells: str = ""
    reference: bool = False
    time_ns: int


class Cue(InTrial, frozen=True):
    """The start signal sounded."""


class Contact(WithStimulus, frozen=True, kw_only=True):
    """The array came to the first dot.

    Parameters
    ----------
    tick, time_ns
        Number and time of the tick at which it came there, as in the trace.
    """

    tick: int
    time_ns: int


class Read(WithStimulus, frozen=True, kw_only=True):
    """The stimulus was read: the hand went to its end and back, or off the device Enter said so.

    Parameters
    ----------
    tick, time_ns
        Number and time of the tick at which it was read, as in the trace; left out off the device.
    """

    tick: int | None = None
    time_ns: int | None = None


class Ended(WithStimulus, frozen=True, kw_only=True):
    """The participant's own key ended the reading of a stimulus.

    Parameters
    ----------
    by
        Which key it was: "button:N" of the device, or "key:NAME".
    time_ns
        Time of it by the host's monotonic clock, as in the trace; left out if it is not known.
    """

    by: str
    time_ns: int | None = None


class Warning(InTrial, frozen=True):  # noqa: A001 - the protocol calls it so
    """The warning sounded."""


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
        What ended reading: "button:N", "key:NAME", or "answer" if the answer came before the
        participant's key; left out if the protocol has no such key.
    """

    durable: ClassVar[bool] = True

    attempt: int
    answer: str
    corrects: bool = False
    early: bool = False
    confidence: int | None = None
    confidence_s: float = 0.0
    ended_by: str = ""


class Undo(InTrial, frozen=True):
    """The last answer was taken back; the record keeps it."""

    durable: ClassVar[bool] = True


class Repeat(InTrial, frozen=True):
    """The experimenter asked for the trial to be shown again."""

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
        Which stimulus of the trial it is: 0, or 1 for the second of two; left out if the engine
        died.
    tick, time_ns
        Number and time of the first tick that was not felt, as in the trace; left out if the
        engine died.
    """

    durable: ClassVar[bool] = True

    what: str
    attempt: int
    stimulus: int | None = None
    tick: int | None = None
    time_ns: int | None = None


class Well(WithStimulus, frozen=True, kw_only=True):
    """The stimulus could be felt again after a fault.

    Parameters
    ----------
    tick, time_ns
        Number and time of the first tick that was felt again, as in the trace.
    """

    tick: int
    time_ns: int
