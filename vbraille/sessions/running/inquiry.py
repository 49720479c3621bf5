"""The taking of an answer: read, asked about if it is early, written, and said again.

If the protocol asks how sure an answer is, the two are written as one event. An answer that has no
confidence yet is not in the record: if the session is killed between the two, the trial is shown
again, and both are asked again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.sessions.planning.knobs import said_value
from vbraille.sessions.record import events
from vbraille.sessions.running.halfanswer import HalfAnswer
from vbraille.sessions.running.phases import Phase

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.running.course import Course


class Inquiry:
    """Taker of the answers of a session.

    Parameters
    ----------
    course
        Course of the session, which knows the open trial.
    typed
        Whether a person types the answers, who is asked about early ones.
    say
        Function that is called with each sentence for the experimenter.

    Attributes
    ----------
    half : HalfAnswer or None
        Answer whose confidence is waited for.
    """

    def __init__(self, course: Course, *, typed: bool, say: Callable[[str], None]) -> None:
        self._course = course
        self._progress = course.progress
        self._typed = typed
        self._say = say
        self._early = ()  # the trial, attempt and answer that were asked about

    def take(self, line: str) -> None:
        """Take an answer to the open trial, or to the one that was taken back, or a confidence.

        Raises
        ------
        InputError
            If a line of a file cannot be used.
        """
        course, correcting = self._course, self._progress.correcting
        if course.half is not None:
            self._take_confidence(line, course.half)
            return
        trial = correcting or course.open_trial
        if trial is None:
            self._say("no answer is waited for now; help says what there is to type")
            return
        if correcting is None and course.second_to_come:
            self._say("the second has not been felt yet; repeat shows both again")
            return
        try:
            answer, confidence = read_line(course.protocol, trial, line)
        except ValueError as error:
            self._refuse("no answer", error)
            return
        told: dict[str, Any] = {"attempt": self._progress.told(trial).attempts, "answer": answer}
        if correcting is not None:
            told["corrects"] = True
        else:
            if not course.reached:
                if self._asks_whether(trial, answer):
                    return
                told["early"] = True
            if course.protocol.trial.end is not None:
                told["ended_by"] = course.ended_by or "answer"
            course.withdraw()
        scale = course.protocol.asks.confidence
        if scale is not None and confidence is None:
            course.half = HalfAnswer(trial, told, course.book.elapsed_s)
            spoken = self._spoken(answer)
            self._say(f"confidence: {course.name(trial)}, {spoken}; type {scale.typed}")
            return
        self._write(trial, told if confidence is None else told | {"confidence": confidence})

    def _take_confidence(self, line: str, half: HalfAnswer) -> None:
        scale = self._course.protocol.asks.confidence
        assert scale is not None, "nothing waits for a confidence"
        try:
            confidence = scale.parse(line)
        except ValueError as error:
            self._refuse("no confidence", error)
            return
        waited_s = round(max(self._course.book.elapsed_s - half.at_s, 0.0), 6)
        told = half.told | {"confidence": confidence}
        self._write(half.trial, told | {"confidence_s": waited_s} if waited_s else told)

    def _write(self, trial: Trial, told: dict[str, Any]) -> None:
        """Write an answer, say that it is in, and go on."""
        course, correcting = self._course, self._progress.correcting
        course.half = None
        course.book.log(events.Answer, trial, **told)
        sure = f", confidence {told['confidence']}" if "confidence" in told else ""
        self._say(f"answer: {course.name(trial)}, {self._spoken(told['answer'])}{sure}")
        if trial.practice and course.protocol.practice.feedback:
            self._tell(trial, told["answer"])
        # If the next trial depends on the answers, a corrected answer may lead to one more trial.
        if correcting is None or course.trial is None or course.phase is Phase.LAST:
            course.paused = False
            course.next()

    def _refuse(self, what: str, error: ValueError) -> None:
        if line := self._course.book.script_line:
            raise InputError(f"line {line} of the answers: {error}") from None
        self._say(f"{what}: {error}")

    def _spoken(self, answer: str) -> str:
        return self._course.protocol.asks.said(answer, self._course.protocol.keys)

    def _tell(self, trial: Trial, answer: str) -> None:
        """Say what a practice trial has shown."""
        trial = self._progress.told(trial).shown
        question, parameter = self._course.protocol.asks, self._course.protocol.parameter
        was = question.was(trial, self._course.protocol.keys)
        values = [stimulus.value for stimulus in trial.stimuli if stimulus.value is not None]
        if was:
            self._say(f"practice: {verdict(self._course.protocol, trial, answer)}, it was {was}")
        elif len(values) == 2:
            first, second = (said_value(value, parameter) for value in values)
            self._say(f"practice: they were {first} and {second}")

    def _asks_whether(self, trial: Trial, answer: str) -> bool:
        """Ask once about an answer that was typed before the trial was read; True if it asks."""
        told = self._progress.told(trial)
        early = trial.practice, trial.number, told.attempts, answer
        if not self._typed or early == self._early:
            return False
        self._early = early
        if self._course.by_key:
            why = "Enter has not said yet that it was read"
        elif "contact" in told.t_s:
            why = "it was not read to its end yet"
        else:
            why = "nothing was read yet"
        self._say(f"no answer: {why}; the same answer again is taken")
        return True


def verdict(protocol: Protocol, trial: Trial, answer: str) -> str:
    """Whether an answer is right: "right" or "wrong"."""
    return "right" if protocol.asks.good(trial, answer) else "wrong"


def read_line(protocol: Protocol, trial: Trial, line: str) -> tuple[str, int | None]:
    """Read an answer to a trial in its canonical form, and its confidence if the line has that.

    Raises
    ------
    ValueError
        If the line is not an answer to the trial.
    """
    question, spelling = protocol.asks, protocol.cell_spelling(trial.stimuli[0])
    confidence = None
    if question.confidence is not None:
        line, confidence = question.confidence.split(line, spelling)
    return question.parse(line, trial, spelling), confidence
