"""The experimenter's console, at which each command, each answer and each event is one line.

An answer is on the disk before the console confirms it. The console never says what a stimulus is
before the answer, and says whether an answer is right in practice only.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from vbraille.braille.spelling import ordinal
from vbraille.errors import InputError
from vbraille.sessions.planning.pace import ENTER
from vbraille.sessions.planning.questions import NameQuestion
from vbraille.sessions.record import events
from vbraille.sessions.running.runner import PendingAnswer, Phase, Runner

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.questionnaire import AnyItem
    from vbraille.sessions.planning.stimuli import Trial


@dataclass(frozen=True, slots=True)
class TypedCommand:
    """A command that an experimenter may type.

    Parameters
    ----------
    word
        Word that is typed.
    handler
        Method that does it, given what stands after the word.
    help
        What the command does, in words for people.
    takes
        Whether more text may follow the word.
    """

    word: str
    handler: Callable[[Console, str], None]
    help: str
    takes: bool = False


class Console:
    """Console at which an experimenter answers, and gives commands.

    Parameters
    ----------
    runner
        Runner of the session.
    say
        Function that is called with each sentence for the experimenter.
    """

    def __init__(self, runner: Runner, say: Callable[[str], None]) -> None:
        self._runner = runner
        self._progress = runner.progress
        self._say = say
        self._early = ()  # the trial, attempt and answer that were asked about
        # The trial and attempt, and the names that were chosen in it and are not taken yet.
        self._chosen: tuple[tuple[bool, int, int] | None, Sequence[str | None]] = (None, ())

    def take(self, line: str, number: int = 0) -> None:
        """Do what a line says, which is a command, an answer, or empty for Enter.

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
        self._runner.script_line = number
        found = find_command(line)
        if not line:
            self.go_on()
        elif found is None:
            self.answer(line)
        else:
            command, rest = found
            command.handler(self, rest)

    @property
    def _draft(self) -> str:
        """Names that wait for Enter; empty if none do."""
        trial = self._progress.correcting or self._runner.open_trial
        if trial is None:
            return ""
        of = trial.practice, trial.number, self._progress.record_of(trial).attempts
        return " ".join(filter(None, self._chosen[1])) if self._chosen[0] == of else ""

    # The methods from here on do the commands.

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
        runner, correcting = self._runner, self._progress.correcting
        if runner.pending is not None:
            self._take_confidence(line, runner.pending)
            return
        if runner.asking is not None and correcting is None:
            self._reply(line, runner.asking[0])
            return
        trial = correcting or runner.open_trial
        if correcting is None and trial is not None and self._turn(line):
            return
        if trial is None:
            self._say("no answer is waited for now; help says what there is to type")
            return
        if correcting is None and runner.more_to_come:
            both = "both" if len(trial.stimuli) == 2 else "all"
            coming = ordinal(runner.stimulus + 1)
            self._say(f"the {coming} has not been felt yet; repeat shows {both} again")
            return
        question = runner.protocol.asks
        if question.turns:
            trial = self._progress.record_of(trial).shown
        try:
            if isinstance(question, NameQuestion) and question.confirm and runner.responses.typed:
                line = self._confirmed(question, trial, line)
                if not line:
                    return
            answer, confidence = read_line(runner.protocol, trial, line)
        except ValueError as error:
            self._refuse("no answer", error)
            return
        told: dict[str, Any] = {
            "attempt": self._progress.record_of(trial).attempts,
            "answer": answer,
        }
        if correcting is not None:
            told["corrects"] = True
        else:
            if not (runner.presenter.reached or runner.protocol.asks.turns):
                if self._asks_again(trial, answer):
                    return
                told["early"] = True
            if runner.late:
                told["late"] = True
            if (runner.protocol.trial.end, runner.protocol.trial.exposure_s) != (None, None):
                told["ended_by"] = runner.ended_by or "answer"
            runner.withdraw()
        scale = runner.protocol.asks.confidence
        if scale is not None and confidence is None:
            runner.pending = PendingAnswer(trial, told, runner.elapsed_s)
            spoken = self._spoken(answer)
            self._say(f"confidence: {runner.name(trial)}, {spoken}; type {scale.typed}")
            return
        self._write(trial, told if confidence is None else told | {"confidence": confidence})

    def _confirmed(self, question: NameQuestion, trial: Trial, line: str) -> str:
        """Names that were said back and are typed again; empty, and they are said, if not yet."""
        of = trial.practice, trial.number, self._progress.record_of(trial).attempts
        before = self._chosen[1] if self._chosen[0] == of else ()
        names = question.marked(line, before)
        self._chosen = of, names
        missing, said = question.missing(names), " ".join(filter(None, names))
        if not missing and names == before:
            return said
        how = f"then one of {missing}" if missing else "Enter takes it, another key changes it"
        self._say(f"chosen: {said}; {how}")
        return ""

    def _turn(self, line: str) -> bool:
        """Turn the open trial's value, or show the standard again; True if the line says so."""
        steps = self._runner.protocol.asks.steps(line)
        if steps is None or self._runner.more_to_come:
            return False
        self._runner.turn(steps)
        return True

    def undo(self, _: str = "") -> None:
        """Take back the last answer, with its confidence."""
        if (pending := self._runner.pending) is not None:
            self._runner.pending = None
            self._say(f"undo: {self._runner.name(pending.trial)}; type its answer")
            return
        if self._progress.correcting is None and self._runner.ask_before():
            return
        trial = self._progress.last_answered
        if trial is None or self._progress.correcting is not None:
            self._say("undo: there is no answer to take back")
            return
        self._runner.log(events.Undo, trial)
        self._say(f"undo: {self._runner.name(trial)}; type its answer")

    def repeat(self, _: str = "") -> None:
        """Show the open trial again."""
        trial = self._runner.open_trial
        if trial is None:
            self._say("repeat: no trial is open")
            return
        self._runner.log(events.Repeat, trial)
        self._runner.again()

    def note(self, text: str) -> None:
        """Write a note into the record."""
        if not text:
            self._say("note: type what is to be noted after it")
            return
        self._runner.log(events.Note, self._runner.open_trial, text=text)
        self._say("note: is in")

    def pause(self, _: str = "") -> None:
        """Bring the array to rest at once; in a pause, go on."""
        runner = self._runner
        if runner.paused:
            self.go_on()
            return
        if runner.pending is not None:
            self._say("pause: the array is at rest; the confidence is waited for")
            return
        runner.pause()
        self._say("pause: the array is at rest; Enter goes on")

    def go_on(self, _: str = "") -> None:
        """Go on after a pause or a break; on paper, take the key that times reading."""
        runner = self._runner
        if runner.device is not None and runner.device.confirm():
            return
        if runner.paused:
            runner.go_on()
            self._say("go: on")
        elif self._draft:
            self.answer(self._draft)
        elif runner.phase is Phase.BREAK:
            runner.log(events.Go)
            runner.next(gap=False)
        elif runner.phase is Phase.LAST and self._progress.correcting is None:
            runner.end("all trials are done")
        elif runner.by_key:
            runner.press()
        elif runner.end_key == ENTER:
            runner.end_reading(ENTER)

    def have_break(self, _: str = "") -> None:
        """Have a break, after the open trial."""
        self._runner.log(events.BreakWanted, self._runner.open_trial)
        self._runner.want_break()

    def begin(self, _: str = "") -> None:
        """End practice."""
        if self._progress.begun:
            self._say("begin: practice is over already")
            return
        self._runner.withdraw()
        self._runner.log(events.Begin)
        self._runner.next()

    def texture(self, text: str) -> None:
        """Set the texture, if the plan has the same texture for all trials."""
        self._retune("texture", text)

    def contrast(self, text: str) -> None:
        """Set the contrast, if the plan has the same contrast for all trials."""
        self._retune("contrast", text)

    def _retune(self, name: str, text: str) -> None:
        trials = self._progress.procedure.trials
        planned = {getattr(s.tuning, name) for trial in trials or () for s in trial.stimuli}
        if trials is None or len(planned) > 1 or self._runner.device is None:
            self._say(f"{name}: the plan sets it")
            return
        try:
            tuning = {**self._progress.tuning, name: float(text)}
            replace(trials[0].stimuli[0].tuning, **tuning)
        except ValueError:
            self._say(f"{name}: type a number from 0 to 1 after it")
            return
        self._runner.retune(tuning)
        self._say(f"{name}: {text}")

    def stop(self, _: str = "") -> None:
        """Stop the session, so that it can be resumed later."""
        self._runner.stop()

    def quit(self, reason: str) -> None:
        """End the session for good, since the participant stops."""
        if not reason:
            self._say("quit: type the reason after it; stop ends for now alone")
            return
        self._runner.end("the participant stopped", reason)

    def help(self, _: str = "") -> None:
        """Say what may be typed."""
        if (asking := self._runner.asking) is not None:
            self._say(f"asked: {asking[0].asked(self._runner.item_columns)}")
        question = self._runner.protocol.asks
        if question.ask:
            self._say(f"question: {question.ask}")
        protocol = self._runner.protocol
        self._say(f"an answer: {question.help(protocol.keys, protocol.written)}")
        if question.confidence is not None:
            self._say(f"confidence: {question.confidence.typed}, after the answer or a semicolon")
        if self._runner.key is not None:
            name = (self._runner.end_key or "").removeprefix("key:")
            self._say(
                f"{name}: end reading; while a stimulus is read, type a blank before a line that "
                f"begins with it"
            )
        self._say("Enter: go on after a pause or a break")
        for command in COMMANDS:
            self._say(f"{command.word}: {command.help}")

    def _reply(self, line: str, item: AnyItem) -> None:
        try:
            answer = item.parse(line, self._runner.item_columns)
        except ValueError as error:
            self._refuse("no answer", error)
            return
        self._runner.reply(answer)

    def _take_confidence(self, line: str, pending: PendingAnswer) -> None:
        scale = self._runner.protocol.asks.confidence
        assert scale is not None, "nothing waits for a confidence"
        try:
            confidence = scale.parse(line)
        except ValueError as error:
            self._refuse("no confidence", error)
            return
        waited_s = round(max(self._runner.elapsed_s - pending.at_s, 0.0), 6)
        told = pending.fields | {"confidence": confidence}
        self._write(pending.trial, told | {"confidence_s": waited_s} if waited_s else told)

    def _write(self, trial: Trial, told: dict[str, Any]) -> None:
        """Write an answer, say that it is in, and go on."""
        runner, correcting = self._runner, self._progress.correcting
        runner.pending, self._chosen = None, (None, ())
        runner.log(events.Answer, trial, **told)
        sure = f", confidence {told['confidence']}" if "confidence" in told else ""
        self._say(f"answer: {runner.name(trial)}, {self._spoken(told['answer'])}{sure}")
        if trial.practice and (protocol := runner.protocol).practice.feedback:
            shown, knob = self._progress.record_of(trial).shown, protocol.parameter
            said = protocol.asks.feedback(shown, told["answer"], protocol.keys, knob)
            if said:
                self._say(f"practice: {said}")
        # If the next trial depends on the answers, a corrected answer may lead to one more trial.
        late = runner.phase in (Phase.LAST, Phase.ASKING)
        if correcting is None or runner.trial is None or late:
            runner.paused = False
            runner.next()

    def _refuse(self, what: str, error: ValueError) -> None:
        if line := self._runner.script_line:
            raise InputError(f"line {line} of the answers: {error}") from None
        self._say(f"{what}: {error}")

    def _spoken(self, answer: str) -> str:
        return self._runner.protocol.asks.said(answer, self._runner.protocol.keys)

    def _asks_again(self, trial: Trial, answer: str) -> bool:
        """Ask once about an answer that was typed before the trial was read; True if it asks."""
        told = self._progress.record_of(trial)
        early = trial.practice, trial.number, told.attempts, answer
        if not self._runner.responses.typed or early == self._early:
            return False
        self._early = early
        if self._runner.by_key:
            why = "Enter has not said yet that it was read"
        elif "contact" in told.t_s:
            why = "it was not read to its end yet"
        else:
            why = "nothing was read yet"
        self._say(f"no answer: {why}; the same answer again is taken")
        return True


COMMANDS = (
    TypedCommand(
        "answer", Console.answer, "before an answer that is also one of these words", takes=True
    ),
    TypedCommand(
        "undo", Console.undo, "take back the last answer, and type it anew; the record keeps both"
    ),
    TypedCommand("repeat", Console.repeat, "show the open trial again, from its start"),
    TypedCommand("note", Console.note, "write the rest of the line into the record", takes=True),
    TypedCommand("pause", Console.pause, "rest the array at once; again, or Enter, goes on"),
    TypedCommand("go", Console.go_on, "go on, as Enter does"),
    TypedCommand("break", Console.have_break, "a break, after the open trial"),
    TypedCommand("begin", Console.begin, "end practice"),
    TypedCommand(
        "contrast", Console.contrast, "set the contrast, 0 to 1, unless the plan does", takes=True
    ),
    TypedCommand(
        "texture", Console.texture, "set the texture, 0 to 1, unless the plan does", takes=True
    ),
    TypedCommand("stop", Console.stop, "end for now; session resume goes on"),
    TypedCommand(
        "quit",
        Console.quit,
        "end for good, since the participant stops; the reason after it",
        takes=True,
    ),
    TypedCommand("help", Console.help, "say what there is to type"),
)
_BY_WORD = {command.word: command for command in COMMANDS}


def find_command(line: str) -> tuple[TypedCommand, str] | None:
    """Command of a line, and what stands after its word; None if the line is no command."""
    word, _, rest = line.strip().partition(" ")
    command = _BY_WORD.get(word.lower())
    if command is None or (rest.strip() and not command.takes):
        return None
    return command, rest.strip()


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
        line, confidence = question.confidence.split(line, spelling.keys)
    return question.parse(line, trial, spelling), confidence
