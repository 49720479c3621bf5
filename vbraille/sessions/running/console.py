"""The experimenter's console, at which each order, each answer and each event is one line.

An answer is on the disk before the console confirms it. The console never says what a stimulus is
before the answer, and says whether an answer is right in practice only.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from vbraille.engine.suspending import Suspension
from vbraille.errors import InputError
from vbraille.sessions.planning.conduct import ENTER
from vbraille.sessions.record import events
from vbraille.sessions.running.answers import Answers, KeyPress, Typed
from vbraille.sessions.running.course import POLL_S, Course, HalfAnswer, Phase

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial


@dataclass(frozen=True, slots=True)
class Order:
    """An order that an experimenter may type.

    Parameters
    ----------
    word
        Word that the order is typed as.
    handler
        Does it: it is given whom the order is to, and what stands after the word.
    help
        What the order does, in words for people.
    takes
        Whether more text may follow the word.
    """

    word: str
    handler: Callable[[Console, str], None]
    help: str
    takes: bool = False


class Console:
    """Console at which a session runs to its end, or until it is stopped.

    Parameters
    ----------
    course
        Course of the session, which chooses what comes next.
    answers
        Source of the lines.
    say
        Function that is called with each sentence for the experimenter.
    real
        Whether the session runs in real time, so that it has to wait.
    look
        Function that is called each time that the session has gone on a little.

    Raises
    ------
    VbrailleError
        If the device or the disk fails and does not recover.
    """

    def __init__(
        self,
        course: Course,
        answers: Answers,
        *,
        say: Callable[[str], None],
        real: bool = True,
        look: Callable[[], None] = lambda: None,
    ) -> None:
        self._course = course
        self._progress = course.progress
        self._answers = answers
        self._say = say
        self._wait_s = POLL_S if real else 0.0
        self._look = look
        self._early = ()  # the trial, attempt and answer that were asked about
        self._end = course.protocol.trial.end
        self._keyed: Typed | None = None  # where a press of the participant's key comes from

    def run(self) -> None:
        """Run the session from where it has come to."""
        course = self._course
        if self._progress.correcting is not None:
            self._say(f"undo: {course.name(self._progress.correcting)}; type its answer")
        self._watch_key()
        course.next()
        try:
            with Suspension() as suspension:
                self._go_through(suspension)
        finally:
            self._await_key(False)
        self._look()

    def _watch_key(self) -> None:
        """Look out for the participant's key, or say that Enter is pressed instead."""
        key, name = self._course.protocol.trial.key, (self._end or "").removeprefix("key:")
        if self._end == ENTER or key is None or self._course.display is None:
            return
        if isinstance(self._answers, Typed) and self._answers.watch(key):
            self._keyed = self._answers
            self._say(f"key: {name} ends reading, with no Enter after it")
        elif self._answers.typed:
            self._end = ENTER
            self._say(
                f"key: standard input is no terminal, so that {name} cannot be told; Enter ends "
                f"reading"
            )

    def _await_key(self, awaited: bool) -> None:
        if self._keyed is not None:
            self._keyed.await_key(awaited)

    def _go_through(self, suspension: Suspension) -> None:
        course = self._course
        while course.phase is not Phase.OVER:
            if suspension.asked:
                self._suspend(suspension)
            self._await_key(course.reading)
            lines = self._answers.lines(self._wait_s)
            if lines is None:
                self._leave()
                return
            if lines:
                course.look()  # what was felt before these lines counts first
            for line in lines:
                if course.phase is Phase.OVER:
                    break
                if isinstance(line, KeyPress):
                    course.end_reading(self._end or "")
                else:
                    self.take(line)
            course.poll()
            if not self._answers.typed:
                self._ask()
            self._look()

    def _suspend(self, suspension: Suspension) -> None:
        """Pause and stop the process. Afterwards Enter ends the pause, if somebody types."""
        paused = self._course.paused
        if not paused:
            self.pause()
        self._await_key(False)  # the terminal is somebody else's for a while
        suspension.stop()
        if not paused and not self._answers.typed:
            self.go_on()

    def take(self, line: str, number: int = 0) -> None:
        """Do what a line says, which is an order, an answer, or empty for Enter.

        Parameters
        ----------
        line
            The line, without its line break.
        number
            Number of the line in its file, which the journal keeps; 0 if it is in no file.

        Raises
        ------
        InputError
            If a line of a file cannot be used.
        """
        line = line.strip()
        self._course.book.script_line = number
        found = find_order(line)
        if not line:
            self.go_on()
        elif found is None:
            self.answer(line)
        else:
            order, rest = found
            order.handler(self, rest)

    def _ask(self) -> None:
        """Ask a source that does not type for a line, where a person would be waited for."""
        course, correcting = self._course, self._progress.correcting
        if course.by_key and not correcting and not course.read:
            course.press()  # answers that are not typed take no time to read paper
        last = course.phase is Phase.LAST
        if not (correcting or course.half or course.paused or course.read or last):
            return
        trial = correcting or course.trial or self._progress.last_answered
        if trial is None or course.phase is Phase.OVER:
            return
        felt = []
        if course.display is not None and self._answers.felt and not course.by_key:
            felt = course.display.explorations
        given = self._answers.next(trial, self._progress.told(trial).attempts, felt)
        if given is not None:
            self.take(*given)
        elif last and not correcting:
            course.end("all trials are done")
        else:
            self._say("answers: there are no more")
            self._leave()

    def _leave(self) -> None:
        """End or stop the session, since no more lines will come."""
        if self._course.phase is Phase.LAST and self._progress.correcting is None:
            self._course.end("all trials are done")
        else:
            self.stop()

    # The methods from here on do the orders.

    def answer(self, line: str) -> None:
        """Take an answer to the open trial, or to the one that was taken back, or a confidence.

        If the protocol asks how sure an answer is, the two are written as one event. An answer that
        has no confidence yet is not in the record: if the session is killed between the two, the
        trial is shown again, and both are asked again.

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

    def undo(self, _: str = "") -> None:
        """Take back the last answer, with its confidence."""
        if (half := self._course.half) is not None:
            self._course.half = None
            self._say(f"undo: {self._course.name(half.trial)}; type its answer")
            return
        trial = self._progress.last_answered
        if trial is None or self._progress.correcting is not None:
            self._say("undo: there is no answer to take back")
            return
        self._course.book.log(events.Undo, trial)
        self._say(f"undo: {self._course.name(trial)}; type its answer")

    def repeat(self, _: str = "") -> None:
        """Show the open trial again."""
        trial = self._course.open_trial
        if trial is None:
            self._say("repeat: no trial is open")
            return
        self._course.book.log(events.Repeat, trial)
        self._course.again()

    def note(self, text: str) -> None:
        """Write a note into the record."""
        if not text:
            self._say("note: type what is to be noted after it")
            return
        self._course.book.log(events.Note, self._course.open_trial, text=text)
        self._say("note: is in")

    def pause(self, _: str = "") -> None:
        """Bring the array to rest at once; in a pause, go on."""
        course = self._course
        if course.paused:
            self.go_on()
            return
        if course.half is not None:
            self._say("pause: the array is at rest; the confidence is waited for")
            return
        course.rest()
        course.paused = True
        course.book.log(events.Pause, course.open_trial)
        self._say("pause: the array is at rest; Enter goes on")

    def go_on(self, _: str = "") -> None:
        """Go on after a pause or a break; on paper, take the key that times reading."""
        course = self._course
        if course.display is not None and course.display.confirm():
            return
        if course.paused:
            course.paused = False
            course.book.log(events.Go, course.open_trial)
            course.go()
            self._await_key(course.reading)  # whoever hears the sentence may press it at once
            self._say("go: on")
        elif course.phase is Phase.BREAK:
            course.book.log(events.Go)
            course.next(gap=False)
        elif course.phase is Phase.LAST and self._progress.correcting is None:
            course.end("all trials are done")
        elif course.by_key:
            course.press()
        elif self._end == ENTER:
            course.end_reading(ENTER)

    def have_break(self, _: str = "") -> None:
        """Have a break, after the open trial."""
        self._course.book.log(events.BreakWanted, self._course.open_trial)
        self._course.want_break()

    def begin(self, _: str = "") -> None:
        """End practice."""
        if self._progress.begun:
            self._say("begin: practice is over already")
            return
        self._course.withdraw()
        self._course.book.log(events.Begin)
        self._course.next()

    def texture(self, text: str) -> None:
        """Set the texture, if the plan has the same texture for all trials."""
        self._retune("texture", text)

    def contrast(self, text: str) -> None:
        """Set the contrast, if the plan has the same contrast for all trials."""
        self._retune("contrast", text)

    def _retune(self, name: str, text: str) -> None:
        trials = self._progress.procedure.trials
        planned = {getattr(s.tuning, name) for trial in trials or () for s in trial.stimuli}
        if trials is None or len(planned) > 1 or self._course.display is None:
            self._say(f"{name}: the plan sets it")
            return
        try:
            tuning = {**self._progress.tuning, name: float(text)}
            replace(trials[0].stimuli[0].tuning, **tuning)
        except ValueError:
            self._say(f"{name}: type a number from 0 to 1 after it")
            return
        self._course.retune(tuning)
        self._say(f"{name}: {text}")

    def stop(self, _: str = "") -> None:
        """Stop the session, so that it can be resumed later."""
        course = self._course
        if (half := course.half) is not None:
            course.half = None
            self._say(f"no confidence: {course.name(half.trial)} is asked again")
        course.withdraw()
        course.book.log(events.Stop)
        done = self._progress.of_all(self._progress.done)
        self._say(f"stopped: {done} trials have answers; session resume goes on")
        course.phase = Phase.OVER

    def help(self, _: str = "") -> None:
        """Say what may be typed."""
        question = self._course.protocol.asks
        if question.ask:
            self._say(f"question: {question.ask}")
        protocol = self._course.protocol
        self._say(f"an answer: {question.help(protocol.keys, protocol.written)}")
        if question.confidence is not None:
            self._say(f"confidence: {question.confidence.typed}, after the answer or a semicolon")
        if self._keyed is not None:
            name = (self._end or "").removeprefix("key:")
            self._say(
                f"{name}: end reading; while a stimulus is read, type a blank before a line that "
                f"begins with it"
            )
        self._say("Enter: go on after a pause or a break")
        for order in ORDERS:
            self._say(f"{order.word}: {order.help}")

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
        protocol = self._course.protocol
        told = protocol.asks.feedback(trial, answer, protocol.keys, protocol.parameter)
        if told:
            self._say(f"practice: {told}")

    def _asks_whether(self, trial: Trial, answer: str) -> bool:
        """Ask once about an answer that was typed before the trial was read; True if it asks."""
        told = self._progress.told(trial)
        early = trial.practice, trial.number, told.attempts, answer
        if not self._answers.typed or early == self._early:
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


ORDERS = (
    Order("answer", Console.answer, "before an answer that is also one of these words", takes=True),
    Order(
        "undo", Console.undo, "take back the last answer, and type it anew; the record keeps both"
    ),
    Order("repeat", Console.repeat, "show the open trial again, from its start"),
    Order("note", Console.note, "write the rest of the line into the record", takes=True),
    Order("pause", Console.pause, "rest the array at once; again, or Enter, goes on"),
    Order("go", Console.go_on, "go on, as Enter does"),
    Order("break", Console.have_break, "a break, after the open trial"),
    Order("begin", Console.begin, "end practice"),
    Order(
        "contrast", Console.contrast, "set the contrast, 0 to 1, unless the plan does", takes=True
    ),
    Order("texture", Console.texture, "set the texture, 0 to 1, unless the plan does", takes=True),
    Order("stop", Console.stop, "end for now; session resume goes on"),
    Order("help", Console.help, "say what there is to type"),
)
_BY_WORD = {order.word: order for order in ORDERS}


def find_order(line: str) -> tuple[Order, str] | None:
    """Order of a line, and what stands after its word; None if the line is no order."""
    word, _, rest = line.strip().partition(" ")
    order = _BY_WORD.get(word.lower())
    if order is None or (rest.strip() and not order.takes):
        return None
    return order, rest.strip()


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
