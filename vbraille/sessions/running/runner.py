"""Runs a session trial by trial: start signal, reading, answer, and what is typed between.

A trial is written as it goes, from top to bottom. While it waits, `Runner.wait` polls the device
and takes lines. A command that ends the trial raises `Again`, one that ends the run raises `Over`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from vbraille.braille.spelling import ordinal, say_cells
from vbraille.devices.events import Knob
from vbraille.engine.host import HostDiedError
from vbraille.errors import InputError
from vbraille.sessions.planning.questionnaire import Item
from vbraille.sessions.planning.questions import Spelling
from vbraille.sessions.planning.shown import make_shown
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import Record
from vbraille.sessions.running.answers import Answers, Asked, Line, NoMoreAnswers, Press, Typed
from vbraille.sessions.running.device import Happening, SessionDevice
from vbraille.sessions.running.paper import Paper, Pins
from vbraille.signals import Suspension

POLL_S = 0.02
MOST_DEATHS = 3  # number of deaths after which the engine is not started again

Say = Callable[[str], None]


class Tone(NamedTuple):
    """A sine that the participant hears."""

    frequency_hz: float
    duration_ms: float


class Again(Exception):
    """The open trial is over; whichever trial comes next now is begun."""


class Over(Exception):
    """The run is over.

    Parameters
    ----------
    kind
        Kind of the last event: "stop" if the session can be resumed, or "end".
    why
        Why it is over.
    data
        What else the event says.
    """

    def __init__(self, kind: str, why: str, **data: Any) -> None:
        super().__init__(why)
        self.kind, self.why, self.data = kind, why, data


class Command(NamedTuple):
    """A command.

    Parameters
    ----------
    does
        Function that does it, given the runner and the text after the word.
    help
        What it does.
    takes
        Whether text may follow the word; a line with such a text is an answer otherwise.
    """

    does: Callable[[Runner, str], None]
    help: str
    takes: bool = False


class Timer:
    """Seconds since a moment of a trial, pauses left out; None before it."""

    def __init__(self) -> None:
        self.began_s: float | None = None

    def start(self, at_s: float) -> None:
        """Count from a moment on."""
        self.began_s = at_s

    def is_past(self, limit_s: float | None, now_s: float) -> bool:
        """Tell whether a limit is over, if there is one."""
        if limit_s is None or self.began_s is None:
            return False
        return now_s - self.began_s >= limit_s


def _nothing(*_: object) -> None:
    """Do nothing."""


class Runner:
    """Runs a session.

    Parameters
    ----------
    record, progress
        Record that events are added to, and how far the session has come.
    answers, device, pins
        Where answers come from, what stimuli are felt on, and the conventional display beside it.
    commands
        What may be typed beside answers, by its word.
    real
        Whether the session runs by the clock of the machine.
    say
        Function that is called with each sentence for the experimenter.
    play
        Function that is called with each tone for the participant.
    mark
        Function that is called with each event just before it is written: its kind, when it
        happened by the session's clock, the trial, and the number of the stimulus.
    look
        Function that is called with the runner each time that the session has gone on a little.

    Attributes
    ----------
    trial : Trial or None
        Trial that is open, or comes next.
    stimulus : int
        Which of its stimuli is shown, from 0.
    is_shown, paused : bool
        Whether a stimulus is shown, and whether the session is paused.
    waits_for : str
        What the session waits for, in words for people.
    break_wanted, is_over : bool
        Whether the experimenter has asked for a break that has not begun, and whether the run is
        over.
    """

    def __init__(
        self,
        record: Record,
        progress: Progress,
        answers: Answers,
        device: SessionDevice | Paper,
        *,
        commands: Mapping[str, Command],
        pins: Pins | None = None,
        real: bool = True,
        say: Say = _nothing,
        play: Callable[[Tone], None] = _nothing,
        mark: Callable[[str, float, Trial | None, int], None] = _nothing,
        look: Callable[[Runner], None] = _nothing,
    ) -> None:
        self.progress = progress
        self.protocol = progress.protocol
        self.answers, self.device, self.pins = answers, device, pins
        self.trial: Trial | None = None
        self.attempt = self.stimulus = 0
        self.is_shown = self.paused = self.break_wanted = self.is_over = False
        self.waits_for = ""
        self.asked: Asked | None = None
        self.commands, self.say = commands, say
        self._record = record
        self._real = real
        self._play, self._mark, self._look = play, mark, look
        self._suspension = Suspension()
        self._key = ""  # the key that ends reading, if one does
        self._deaths = 0
        self._free_s = 0.0  # since when the gap before the next trial counts
        self._paused_s = 0.0
        self._began_s, self._before_s = device.now_s, progress.t_s
        self._cue, self._exposed, self._answering = Timer(), Timer(), Timer()
        self._ended_by = ""
        self._warned = self._told_late = False
        self._doubted = ""  # answer that was typed early, and is asked for once more
        spelled = self._spelled_commands() if answers.typed else set()
        self._ambiguous = spelled & commands.keys()

    @property
    def now_s(self) -> float:
        """Time of the session's clock."""
        return self.device.now_s

    @property
    def elapsed_s(self) -> float:
        """Seconds that the session has run for, without the time between runs."""
        return self._elapsed_s(self.now_s)

    @property
    def presenter(self) -> SessionDevice | Paper:
        """Presenter of the trial that is open or comes next."""
        trial = self.trial
        on_pins = trial is not None and trial.stimuli[0].on == "pins"
        return self.pins if self.pins is not None and on_pins else self.device

    @property
    def name(self) -> str:
        """Name of the trial that is open or comes next."""
        assert self.trial is not None
        alike = [each for each in self.progress.plan.trials if each.practice == self.trial.practice]
        return f"{self.trial.name} of {len(alike)}"

    @property
    def reading(self) -> bool:
        """True if a stimulus is read, so that the participant's key may end it."""
        return self.is_shown and not (self.paused or self.device.ended or self.presenter.by_key)

    @property
    def more_to_come(self) -> bool:
        """True if a stimulus of the open trial has not been shown yet."""
        return self.trial is not None and self.stimulus + 1 < len(self.trial.stimuli)

    def run(self, **told: Any) -> Over:
        """Run the session from where it is to its end, or until it is stopped.

        Parameters
        ----------
        told
            What the event of the run says, such as the device.

        Returns
        -------
        Over
            Why the run is over, for `finish`; the array rests.
        """
        self._begin(answers=self.answers.name, **told)
        self._watch_key()
        if self._ambiguous:
            words = " and ".join(sorted(self._ambiguous))
            self.say(f"commands: type answer before {words} where that is the answer")
        if self.progress.done:
            self.say(f"resume: {self.progress.done} trials have answers")
        with self._suspension:
            try:
                self._go_through()
                over = Over("end", "all trials are done")
            except NoMoreAnswers:
                over = Over("stop", "there are no more answers")
            except Over as left:
                over = left
        trial, self.trial = self.trial, None
        self.withdraw()
        if trial is not None and self.progress.lacks_confidence(trial):
            self.say(f"no confidence: the answer to {trial.name} is kept without one")
        return over

    def _begin(self, **told: Any) -> None:
        """Wait for the first tick, and write that the run has begun."""
        self._record.write_ticks()  # those of an engine that died: ticks of each run begin at 0
        first: list[NDArray[np.void]] = []
        early: list[Happening] = []
        if isinstance(self.device, SessionDevice):
            while self.device.newest is None:
                ticks, happened = self.device.poll()
                first.append(ticks)
                early += happened
        self._began_s, self._before_s = self.now_s, self.progress.t_s
        self._free_s = -1e9
        self.log("run", **told)
        for ticks in filter(len, first):
            self._record.add_ticks(ticks)
        for happening in early:
            self._take(happening)

    def _go_through(self) -> None:
        """Do what comes next until nothing does."""
        while True:
            try:
                while self._go_on():
                    pass
                if not self.answers.typed or self._may_end():
                    return
            except Again:
                self.withdraw()

    def _may_end(self) -> bool:
        """Ask the experimenter whether the session is over."""
        self.trial = None
        self.say("last: all trials are done; Enter ends, undo takes back the last answer")
        with suppress(NoMoreAnswers):
            self.await_enter("Enter, which ends the session")
        return True

    def finish(self, over: Over) -> None:
        """Write why the run is over, and say it."""
        self.is_over, self.waits_for = True, ""
        self.log(over.kind, why=over.why, **over.data)
        done = f"{self.progress.done} trials have answers"
        goes_on = "; session resume goes on" if over.kind == "stop" else ""
        self.say(f"{over.kind}: {over.why}; {done}{goes_on}")
        for sentence in self.progress.found if over.kind == "end" else ():
            self.say(sentence)
        self._look(self)

    def _go_on(self) -> bool:
        """Do what comes next; return whether there was anything."""
        trial, asked = self.progress.next_trial, self.progress.next_item
        if trial is not None and (trial.practice or self._is_half_done(trial)):
            asked = None
        if asked is not None:
            self._ask_item(*asked)
        elif trial is not None:
            self._conduct(trial)
        return asked is not None or trial is not None

    def _is_half_done(self, trial: Trial) -> bool:
        """Tell whether a trial was shown, and only its answer or its confidence is to come."""
        return self.progress.is_taken_back(trial) or self.progress.lacks_confidence(trial)

    # The questionnaire.

    def _ask_item(self, item: Item, number: int) -> None:
        """Ask a question of the questionnaire, and write the reply."""
        self.trial = None
        self.say(f"question: {item.ask} Type {item.typed}")
        self.waits_for = "a reply to the questionnaire"
        asked = Asked("reply", item=item)
        while True:
            line = self._wait_for_line(asked)
            try:
                reply = item.parse(line.text)
                break
            except ValueError as error:
                self._refuse(error, line)
        self.log("reply", name=item.name, number=number, reply=reply, **_numbered(line))
        self.say(f"reply: {item.name} is in")
        self._free_s = self.now_s

    # A trial.

    def _conduct(self, trial: Trial) -> None:
        """Conduct a trial, or what is left of it."""
        self.trial, self.attempt = trial, self.progress.attempts(trial)
        if self.progress.lacks_confidence(trial):
            self._ask_confidence(trial)
        elif self.progress.is_taken_back(trial):
            self._ask(trial)
        else:
            self._prepare(trial)
            self.attempt += 1
            self._present(trial)
            self._ask(trial)

    def _prepare(self, trial: Trial) -> None:
        """Wait until a trial may begin."""
        limit_s = self.protocol.session.limit_s
        if limit_s is not None and self.elapsed_s > limit_s:
            for item in self.protocol.questionnaire:
                if item.when == "end" and (item.name, 0) not in self.progress.replies:
                    self._ask_item(item, 0)
            raise Over("end", f"the limit of {limit_s:g} s is over")
        if self.break_wanted or self.progress.is_break_due(trial):
            self._have_break()
        presenter = self.presenter
        where = ", on the conventional display" if presenter is self.pins else ""
        enter = presenter.by_key and self.answers.typed
        how = "; press Enter when reading begins" if enter else ""
        again = ", again" if self.attempt else ""
        self.say(f"ready: {self.name}{again}{where}{how}")
        if enter:
            self.await_enter("Enter when reading begins")
        self.waits_for = presenter.why or "the device, with the array at the left"
        due_s = self._free_s + trial.gap_s
        while self.paused or not presenter.ready or self.now_s < due_s or not self._is_pins_ready():
            self._wait_for_no_line()

    def _is_pins_ready(self) -> bool:
        """Tell whether the conventional display can show what stimuli are compared with."""
        return self.pins is None or not self.protocol.pins.reference or self.pins.ready

    def _present(self, trial: Trial) -> None:
        """Show the stimuli of a trial, up to the last one."""
        self._warned = self._told_late = False
        self._ended_by = self._doubted = ""
        for number in range(len(trial.stimuli)):
            self.stimulus = number
            self._show(trial)
            while self.more_to_come and not (self.presenter.read and self.presenter.ready):
                self._wait_for_no_line()

    def _show(self, trial: Trial, *, turned: bool = False) -> None:
        """Put a stimulus before the participant; the record has it before it is felt.

        Parameters
        ----------
        turned
            Whether it is the stimulus that is shown already, at another value.
        """
        stimulus, presenter = trial.stimuli[self.stimulus], self.presenter
        shown: dict[str, Any] = {"stimulus": self.stimulus}
        if stimulus.value is not None:
            shown["value"] = stimulus.value
        elif (procedure := self.protocol.procedure) is not None and procedure.parameter:
            shown["value"] = getattr(stimulus.look, procedure.parameter)
        if isinstance(presenter, SessionDevice):
            shown["line"] = presenter.line + 1
            show = partial(presenter.show, make_shown(self.protocol, stimulus))
        else:
            show = partial(presenter.show, stimulus)
        if turned:
            shown["turned"] = True
        is_first = not self.stimulus and presenter is not self.pins
        if self.pins is not None and self.protocol.pins.reference and is_first:
            self.pins.show_reference()
        now_s = self.now_s
        if not turned:
            self._play(Tone(*self.protocol.sound.cue))
            self._start_timers(now_s)
        self.is_shown = True
        self.log("cue", now_s, **shown)
        show(first=not self.stimulus and not turned, turned=turned)
        if not turned:
            which = f", {ordinal(self.stimulus)}" if self.stimulus else ""
            self.say(f"cue: {self.name}{which}")

    def _start_timers(self, now_s: float) -> None:
        self._cue, self._exposed, self._answering = Timer(), Timer(), Timer()
        self._cue.start(now_s)
        if self.protocol.trial.exposure_from == "cue":
            self._exposed.start(now_s)
        if self.protocol.trial.exposure_s is None and not self.more_to_come:
            self._answering.start(now_s)

    def _ask(self, trial: Trial) -> None:
        """Wait for the answer of a trial, and write it."""
        question, names = self.protocol.asks, ()
        if not self.is_shown:
            self.say(f"undo: {self.name}; type its answer: {question.typed}")
        while True:
            line = self._wait_for_line(self._asked("answer"))
            if self.is_shown and (steps := question.steps(line.text)) is not None:
                trial = self._turn(trial, steps)
                continue
            try:
                if question.confirms and self.answers.typed:
                    names, line = self._confirm(names, line)
                if not line.text and self.answers.typed:
                    continue
                answer, sure = self._parse(trial, line.text)
            except ValueError as error:
                self._refuse(error, line)
                continue
            if not self._is_doubted(answer):
                break
        self._take_answer(trial, answer, sure, line)

    def _confirm(self, before: tuple[str, ...], line: Line) -> tuple[tuple[str, ...], Line]:
        """Say names back until Enter takes them; the line is empty as long as nothing is taken.

        Parameters
        ----------
        before
            Names that were said back already.
        """
        question = self.protocol.asks
        names = question.marked(line.text, before) if line.text else before
        missing = question.missing(names) if names else ""
        if names and names == before and not missing:
            return names, Line(" ".join(names))
        if names:
            how = f"one of {missing} is missing" if missing else "Enter takes it"
            self.say(f"chosen: {' '.join(filter(None, names))}; {how}")
        return names, Line("")

    def _parse(self, trial: Trial, text: str) -> tuple[str, int | None]:
        """Read an answer, and how sure it is if that stands after a semicolon."""
        scale, spelling = self.protocol.asks.confidence, self._spelling(trial)
        before, semicolon, after = text.rpartition(";")
        if scale is None or not semicolon:
            return self.protocol.asks.parse(text, trial, spelling), None
        return self.protocol.asks.parse(before.strip(), trial, spelling), scale.parse(after)

    def _is_doubted(self, answer: str) -> bool:
        """Ask once about an answer that was typed before the stimulus was read."""
        typed_early = self.answers.typed and self.is_shown and not self.presenter.reached
        if not typed_early or answer == self._doubted or hasattr(self.protocol.asks, "step"):
            return False
        self._doubted = answer
        self.say("no answer: it was not read to its end yet; the same answer again is taken")
        return True

    def _take_answer(self, trial: Trial, answer: str, sure: int | None, line: Line) -> None:
        """Write an answer, say that it is in, and ask how sure it is."""
        told: dict[str, Any] = {"answer": answer, "typed": line.text, **_numbered(line)}
        if self.is_shown:
            if not self.presenter.reached:
                told["early"] = True
            if self._answering.is_past(self.protocol.trial.answer_s, self.now_s):
                told["late"] = True
            if self.protocol.trial.end or self.protocol.trial.exposure_s:
                told["ended_by"] = self._ended_by or "answer"
        self.withdraw()
        self.log("answer", **told)
        self.say(f"answer: {self.name}, {self._said(trial, answer)}")
        if trial.practice or self.protocol.trial.feedback:
            self._tell_outcome(trial, answer)
        self._free_s = self.now_s
        if sure is not None:
            self.log("confidence", confidence=sure, **_numbered(line))
            self.say(f"rated: {self.name}, confidence {sure}")
        elif self.progress.lacks_confidence(trial):
            self._ask_confidence(trial)

    def _ask_confidence(self, trial: Trial) -> None:
        """Wait until it is said how sure an answer is, and write it."""
        scale = self.protocol.asks.confidence
        assert scale is not None, "a confidence is lacking"
        if self.answers.typed:
            self.say(f"confidence: {self.name}; type {scale.least} to {scale.most}")
        answer = self.progress.answers[trial.key].data["answer"]
        asked = self._asked("confidence")._replace(answer=answer)
        while True:
            line = self._wait_for_line(asked)
            try:
                sure = scale.parse(line.text)
                break
            except ValueError as error:
                self._refuse(error, line)
        self.log("confidence", confidence=sure, **_numbered(line))
        self.say(f"rated: {self.name}, confidence {sure}")
        self._free_s = self.now_s

    def _asked(self, what: Any) -> Asked:
        self.waits_for = "the answer" if what == "answer" else "how sure the answer is"
        return Asked(what, self.trial, self.attempt, self.presenter.explorations)

    def _turn(self, trial: Trial, steps: int) -> Trial:
        """Show the last stimulus at another value, and return the trial that is shown now."""
        if not steps:  # the standard again
            self._present(trial)
            return trial
        before = trial.stimuli[-1].value
        value = self.protocol.asks.turned(before, steps)
        if value == before:
            self.say("turned: no farther; it is at its end")
            return trial
        self.trial = trial = trial.turned(self.protocol.design.parameter, value)
        self._show(trial, turned=True)
        self.say(f"turned: {self.name}")
        return trial

    def _refuse(self, error: ValueError, line: Line) -> None:
        """Say why a line is no answer; a line of a file or a program cannot be typed again."""
        if not self.answers.typed:
            where = f" line {line.number}" if line.number else ""
            raise InputError(f"{self.answers.name}{where}: {error}") from None
        self.say(f"no answer: {error}")

    def _tell_outcome(self, trial: Trial, answer: str) -> None:
        """Say whether an answer is right, and what would have been."""
        asks = self.protocol.asks
        outcome, was = asks.outcome(trial, answer), asks.was(trial, self._spelling(trial))
        if outcome:
            self.say(f"feedback: {outcome}{f', it was {was}' if was else ''}")

    def _said(self, trial: Trial, answer: str) -> str:
        return self.protocol.asks.said(answer, self._spelling(trial))

    def _spelling(self, trial: Trial) -> Spelling:
        return self.protocol.spelling(trial.stimuli[0])

    # Breaks.

    def _have_break(self) -> None:
        """Have a break until Enter is typed."""
        self.break_wanted = False
        trial, self.trial = self.trial, None
        self.log("break")
        if self.answers.typed:
            planned_s = self.protocol.session.break_s
            planned = "" if planned_s is None else f"{planned_s:g} s are planned; "
            self.say(f"break: {self.progress.done} trials are done; {planned}Enter goes on")
            self.await_enter("Enter, which ends the break", planned_s)
        self.log("go")
        self.trial = trial

    def await_enter(self, waits_for: str, planned_s: float | None = None) -> None:
        """Wait until Enter is typed, and say when the planned time is over."""
        self.waits_for = waits_for
        timer = Timer()
        timer.start(self.now_s)
        while True:
            found = self.wait(Asked("go"))
            if isinstance(found, Line) and not found.text.strip():
                return
            if found is not None:
                self.say("no answer is waited for now; Enter goes on")
            if timer.is_past(planned_s, self.now_s):
                planned_s = None
                self.say("break: its time is over; Enter goes on")

    # Waiting.

    def _wait_for_line(self, asked: Asked) -> Line:
        """Wait for a line that is no command."""
        while True:
            found = self.wait(asked)
            if found is not None:
                return found

    def _wait_for_no_line(self) -> None:
        """Wait a little, where no answer can be given yet."""
        if self.wait(None) is None:
            return
        if self.is_shown:
            coming = ordinal(self.stimulus + 1)
            self.say(f"the {coming} has not been felt yet; repeat shows all from the first")
        else:
            self.say("no answer is waited for now; help lists what may be typed")

    def wait(self, asked: Asked | None) -> Line | None:
        """Take a line and what the device tells, do what is due; return a line that is no command.

        Raises
        ------
        Again, Over
            If the open trial, or the run, is over.
        NoMoreAnswers
            If no more lines will come.
        """
        self.asked = asked
        if self._suspension.asked:
            self._suspend()
        if isinstance(self.answers, Typed):
            self.answers.awaits_key = self.reading
        presenter = self.presenter
        if isinstance(presenter, Paper) and self.is_shown and not self.answers.typed:
            presenter.press()  # answers that are not typed take no time to read paper
        # A file or a program is asked when the stimulus is read; a person may type at any time.
        is_due = not self.paused and (not self.is_shown or self.presenter.read)
        found = self.answers.line(asked if is_due else None, self._wait_s())
        self._poll()
        self._watch_time()
        self._look(self)
        if isinstance(found, Press):
            self.end_reading(self._key)
            return None
        if found is None:
            return self._controlled() if asked is not None and asked.what == "answer" else None
        return self._obey(found, asked)

    def _obey(self, line: Line, asked: Asked | None) -> Line | None:
        """Do what a line says if it is a command, or Enter; else return it."""
        text = line.text.strip()
        if not text:
            return self._enter(line)
        found = self._find_command(text)
        if found is None:
            return line._replace(text=text)
        word, rest = found
        awaited = asked is not None and asked.what == "answer"
        if word == "answer" or (awaited and not self.answers.typed and word in self._ambiguous):
            return line._replace(text=rest)
        if awaited and word in self._ambiguous and text.lower() == word:
            said = f"type answer {text}, or command {word}"
            self.say(f"{text} is a command, and a string here: {said}")
            return None
        if word == "command":
            word, rest = rest.lower(), ""
        self.commands[word].does(self, rest)
        return None

    def _find_command(self, line: str) -> tuple[str, str] | None:
        """Return the command of a line and the text after it; None if the line is no command."""
        word, _, rest = line.partition(" ")
        command = self.commands.get(word.lower())
        if command is None or (rest.strip() and not command.takes):
            return None
        return word.lower(), rest.strip()

    def _enter(self, line: Line) -> Line | None:
        """Do what Enter does now; return it if something waits for it."""
        if self.device.confirm():
            return None
        if self.paused:
            self.go()
            return None
        presenter = self.presenter
        if self.is_shown and presenter.by_key and not presenter.read:
            assert isinstance(presenter, Paper)
            if why := presenter.press():
                self.say(f"too early: {why}")
            return None
        if self.reading and self._key == "key:enter":
            self.end_reading(self._key)
            return None
        return line

    def _wait_s(self) -> float:
        """Return how long may be waited for a line."""
        if not self._real:
            return 0.0
        exposure_s, began_s = self.protocol.trial.exposure_s, self._exposed.began_s
        if exposure_s is None or began_s is None or self.paused or not self.is_shown:
            return POLL_S
        return min(max(began_s + exposure_s - self.now_s, 0.0), POLL_S)

    def _poll(self) -> None:
        """Take what the device and the conventional display tell."""
        try:
            ticks, happenings = self.device.poll()
        except HostDiedError as fault:
            self._restart(fault)
            return
        if ticks.size:
            self._record.add_ticks(ticks)
        if self.pins is not None:
            happenings += self.pins.poll()[1]
        # A fault may end the trial, and what else came with it is written before.
        for happening in sorted(happenings, key=lambda each: each.kind == "fault"):
            self._take(happening)

    def _take(self, happening: Happening) -> None:
        """Write what the hand or the device did, and say it."""
        kind, at_s, data, said = happening
        if kind == "ended":
            self.end_reading(data["by"], at_s)
            return
        if kind == "fault" and not self.is_shown:
            return
        self.log(kind, at_s, **data)
        if said:
            self.say(said)
        if kind == "contact" and self.protocol.trial.exposure_from == "contact":
            self._exposed.start(at_s)
        if kind == "read" and self.answers.typed and not self.more_to_come:
            self.say(f"read: type the answer: {self.protocol.asks.typed}")
        if kind == "fault":
            repeats = self.protocol.faults.repeat
            then = "is repeated" if repeats else "goes on"
            self.say(f"fault: {data['what']}; {self.name} {then}")
            if repeats:
                raise Again

    def _restart(self, fault: HostDiedError) -> None:
        """Start the engine again after it died; an open trial gets a new attempt."""
        self._deaths += 1
        was_shown, self.is_shown = self.is_shown, False
        self.log("fault" if was_shown else "device", what=str(fault))
        if self._deaths >= MOST_DEATHS:
            raise fault
        self.say(f"fault: {fault}; it is started again")
        self.device.start()
        trial, self.trial = self.trial, None
        self._begin(why="fault")
        self.trial = trial
        if was_shown:
            raise Again

    def _controlled(self) -> Line | None:
        """Return the line that a button or a knob of the device stands for, if one does."""
        question, trial = self.protocol.asks, self.trial
        for control in self.device.take_controls():
            if trial is None or self.paused or not self.is_shown:
                continue
            if not isinstance(control, Knob):
                if line := question.by_button(control.number):
                    return Line(line)
                continue
            value = question.by_knob(control.number, control.value)
            if value is not None:
                steps = round((value - trial.stimuli[-1].value) / question.step)
                return Line(("+" if steps > 0 else "-") * abs(steps)) if steps else None
        return None

    def _watch_time(self) -> None:
        """Do what is due by the time since the cue."""
        if not self.is_shown or self.paused:
            return
        pace, now_s = self.protocol.trial, self.now_s
        if self._exposed.is_past(pace.exposure_s, now_s):
            self.end_reading("exposure")
        if not self._warned and self._cue.is_past(pace.warning_s, now_s):
            self._warned = True
            self._play(Tone(*self.protocol.sound.warning))
            self.log("warning")
            self.say(f"warning: {self.name}, {pace.warning_s:g} s")
        if not self._told_late and self._answering.is_past(pace.answer_s, now_s):
            self._told_late = True
            if pace.late == "missed":
                self.withdraw()
                self.log("missed")
                self.say(f"missed: {self.name}, no answer in {pace.answer_s:g} s")
                self._free_s = now_s
                raise Again
            self.say(f"late: {self.name}, after {pace.answer_s:g} s")

    def end_reading(self, by: str, at_s: float | None = None) -> None:
        """End reading of the stimulus that is shown, by the participant's key or by the time."""
        if not self.reading:
            return
        at_s = self.now_s if at_s is None else at_s
        self.presenter.end_reading()
        self.log("ended", at_s, by=by)
        self._exposed = Timer()
        if self.more_to_come:
            self.say(f"ended: the {ordinal(self.stimulus)}, by {by.replace(':', ' ')}")
            return
        self._ended_by = by
        if self.protocol.trial.exposure_s is not None:
            self._answering.start(at_s)
        read_s = at_s - (self._cue.began_s or at_s)
        typed = f"; type the answer: {self.protocol.asks.typed}" if self.answers.typed else ""
        self.say(f"ended: {read_s:.2f} s, by {by.replace(':', ' ')}{typed}")

    @property
    def _typist(self) -> Typed:
        """Answers of a person, where they are typed."""
        return cast("Typed", self.answers)

    def _watch_key(self) -> None:
        """Look out for the participant's key, or say that Enter is pressed instead."""
        self._key, key = self.protocol.trial.end or "", self.protocol.trial.key
        if not key or self._key == "key:enter" or not self.answers.typed:
            return
        name = self._key.removeprefix("key:")
        if self._typist.watch(key):
            self.say(f"key: {name} ends reading, with no Enter after it")
        else:
            self._key = "key:enter"
            self.say(f"key: standard input is no terminal; Enter ends reading instead of {name}")

    def _suspend(self) -> None:
        """Pause, and stop the process; afterwards Enter ends the pause."""
        was_paused = self.paused
        self.pause()
        if self.answers.typed:
            self._typist.release()
        self._suspension.stop()
        if self.answers.typed:
            self._typist.take()
        elif not was_paused:
            self.go()

    def pause(self) -> None:
        """Bring the array to rest."""
        if self.paused:
            return
        self.paused, self._paused_s = True, self.now_s
        self.device.rest()
        if self.pins is not None:
            self.pins.rest()
        self.log("pause")
        self.say("pause: the array is at rest; Enter goes on")

    def go(self) -> None:
        """Go on after a pause."""
        self.paused = False
        away_s = self.now_s - self._paused_s
        for timer in (self._cue, self._exposed, self._answering):
            if timer.began_s is not None:
                timer.began_s += away_s
        if self.is_shown:
            self.presenter.go()
        self.log("go")
        self.say("go: on")

    def withdraw(self) -> None:
        """Take the stimulus away."""
        self.device.withdraw()
        if self.pins is not None:
            self.pins.withdraw()
        self.is_shown = self.paused = False

    def log(self, kind: str, at_s: float | None = None, **data: Any) -> None:
        """Write an event, of the open trial if there is one; it is on the disk then."""
        at_s = self.now_s if at_s is None else at_s
        self._mark(kind, at_s, self.trial, data.get("stimulus", 0))
        t_s = self._elapsed_s(at_s)
        self.progress.take(self._record.append(kind, t_s, self.trial, self.attempt, **data))

    def _elapsed_s(self, at_s: float) -> float:
        return self._before_s + at_s - self._began_s

    def _spelled_commands(self) -> set[str]:
        """Return how the strings of the plan are spelled, to tell them from commands."""
        stimuli = [s for trial in self.progress.plan.trials for s in trial.stimuli]
        cells = {say_cells(s.cells, self.protocol.masks).replace(" ", "") for s in stimuli}
        return cells | {stimulus.text.casefold() for stimulus in stimuli}


def _numbered(line: Line) -> dict[str, int]:
    return {"script_line": line.number} if line.number else {}
