"""Runs a session trial by trial: start signal, reading, answer, and what is typed between.

A trial is written as it goes, from top to bottom. While it waits, `Runner.wait` polls the device
and takes lines. A command that ends the trial raises `Again`, one that ends the run raises `Over`.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any, NamedTuple, TypeVar

from vbraille.braille.spelling import ordinal, say_cells
from vbraille.engine.host import HostDiedError
from vbraille.errors import InputError
from vbraille.sessions.planning.questionnaire import Item
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import Record
from vbraille.sessions.running.answers import Answers, Asked, Line, NoMoreAnswers, Press
from vbraille.sessions.running.pins import Pins
from vbraille.sessions.running.presenter import Happening, Presenter
from vbraille.signals import Suspension

POLL_S = 0.02
MOST_DEATHS = 3  # number of deaths after which the engine is not started again

Read = TypeVar("Read")


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


def nothing(*_: object) -> None:
    """Do nothing."""


class Runner:
    """Runs a session.

    Parameters
    ----------
    record, progress
        Record that events are added to, and how far the session has come.
    answers, device, pins
        Where answers come from, what stimuli are felt on, and the conventional display beside it.
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
    asked : Asked or None
        What a line is waited for.
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
        device: Presenter,
        pins: Pins | None,
        *,
        real: bool,
        say: Callable[[str], None],
        play: Callable[[Tone], None],
        mark: Callable[[str, float, Trial | None, int], None],
        look: Callable[[Runner], None],
    ) -> None:
        self.progress, self.protocol = progress, progress.protocol
        self.answers, self.device, self.pins = answers, device, pins
        self.trial: Trial | None = None
        self.attempt = self.stimulus = 0
        self.is_shown = self.paused = self.break_wanted = self.is_over = False
        self.asked: Asked | None = None
        self.waits_for = ""
        self.say = say
        self._record, self._real = record, real
        self._play, self._mark, self._look = play, mark, look
        self._suspension = Suspension()
        self._key = ""  # the key that ends reading, if one does
        self._deaths = 0
        self._told: dict[str, Any] = {}  # what the event of a run says
        self._began_s = self._before_s = 0.0
        self._free_s = 0.0  # since when the gap before the next trial counts
        self._paused_s = 0.0
        # Since when the times of the open trial count, pauses left out: "cue", the time to the
        # "warning", the "exposure", and the time for an "answer". What is over is no longer there.
        self._since_s: dict[str, float] = {}
        self._late = False
        self._ended_by = ""
        self._doubted = ""  # answer that was typed early, and is asked for once more
        stimuli = [s for trial in progress.plan.trials for s in trial.stimuli]
        spelled = {say_cells(s.cells, self.protocol.masks).replace(" ", "") for s in stimuli}
        spelled |= {stimulus.text.casefold() for stimulus in stimuli}
        self._ambiguous = spelled & COMMANDS.keys() if answers.typed else set()

    @property
    def elapsed_s(self) -> float:
        """Seconds that the session has run for, without the time between runs."""
        return self._elapsed_s(self.device.now_s)

    @property
    def presenter(self) -> Presenter:
        """Presenter of the trial that is open or comes next."""
        on_pins = self.trial is not None and self.trial.stimuli[0].on == "pins"
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
            What the event of the run says, such as the conditions.

        Returns
        -------
        Over
            Why the run is over, for `finish`; the array rests.
        """
        self._told = {"answers": self.answers.name, **told}
        self._begin()
        self._watch_key()
        if self.progress.done:
            self.say(f"resume: {self.progress.done} trials have answers")
        with self._suspension:
            try:
                while self._go_through():
                    self.withdraw()
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

    def _begin(self, **why: Any) -> None:
        """Write that a run has begun; another one does when the engine is started again."""
        self._record.write_ticks()  # those of an engine that died: ticks of each run begin at 0
        self._began_s, self._before_s = self.device.now_s, self.progress.t_s
        self._free_s = -1e9
        self.log("run", **self._told, **self.device.told, **why)

    def _go_through(self) -> bool:
        """Do what comes next until nothing does; return whether there may be something again."""
        try:
            while self._go_on():
                pass
            if self.answers.typed:
                self.trial = None
                self.say("last: all trials are done; Enter ends, undo takes back the last answer")
                with suppress(NoMoreAnswers):
                    self.await_enter("Enter, which ends the session")
        except Again:
            return True
        return False

    def finish(self, over: Over) -> None:
        """Write why the run is over, and say it."""
        self.is_over, self.waits_for = True, ""
        self.log(over.kind, why=over.why, **over.data)
        goes_on = "; session resume goes on" if over.kind == "stop" else ""
        self.say(f"{over.kind}: {over.why}; {self.progress.done} trials have answers{goes_on}")
        for sentence in self.progress.found if over.kind == "end" else ():
            self.say(sentence)
        self._look(self)

    def _go_on(self) -> bool:
        """Do what comes next; return whether there was anything."""
        progress = self.progress
        trial, asked = progress.next_trial, progress.next_item
        if trial is None:
            waits = False
        else:  # nothing is asked in practice, nor between a trial and its answer or confidence
            half_done = progress.is_taken_back(trial) or progress.lacks_confidence(trial)
            waits = trial.practice or half_done
        if asked is not None and not waits:
            self._ask_item(*asked)
        elif trial is not None:
            self._conduct(trial)
        else:
            return False
        return True

    def _ask_item(self, item: Item, number: int) -> None:
        """Ask a question of the questionnaire, and write the reply."""
        self.trial = None
        self.say(f"question: {item.ask} Type {item.typed}")
        self.waits_for = "a reply to the questionnaire"
        line, reply = self._ask_for(Asked("reply", item=item), item.parse)
        self.log("reply", name=item.name, number=number, reply=reply, **_numbered(line))
        self.say(f"reply: {item.name} is in")
        self._free_s = self.device.now_s

    # A trial.

    def _conduct(self, trial: Trial) -> None:
        """Conduct a trial, or what is left of it."""
        self.trial, self.attempt = trial, self.progress.attempts(trial)
        if self.progress.lacks_confidence(trial):
            self._ask_confidence(trial)
            return
        if not self.progress.is_taken_back(trial):
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
        presenter, pins = self.presenter, self.pins
        where = ", on the conventional display" if presenter is pins else ""
        enter = presenter.by_key and self.answers.typed
        how = "; press Enter when reading begins" if enter else ""
        again = ", again" if self.attempt else ""
        self.say(f"ready: {self.name}{again}{where}{how}")
        if enter:
            self.await_enter("Enter when reading begins")
        self.waits_for = presenter.why or "the device, with the array at the left"
        needed = [presenter, pins] if pins and self.protocol.pins.reference else [presenter]
        due_s = self._free_s + trial.gap_s
        while self.paused or self.device.now_s < due_s or not all(each.ready for each in needed):
            self._wait_for_no_line()

    def _present(self, trial: Trial) -> None:
        """Show the stimuli of a trial, up to the last one."""
        self._late = False
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
        is_first = not self.stimulus and not turned
        shown: dict[str, Any] = {"stimulus": self.stimulus}
        if self.protocol.varied:
            value = getattr(stimulus.look, self.protocol.varied)
            shown["value"] = value if stimulus.value is None else stimulus.value
        shown |= presenter.prepare(stimulus)
        if turned:
            shown["turned"] = True
        if is_first and self.pins and self.pins is not presenter and self.protocol.pins.reference:
            self.pins.show_reference()
        now_s = self.device.now_s
        if not turned:
            self._play(Tone(*self.protocol.sound.cue))
            self._start_times(now_s)
        self.is_shown = True
        self.log("cue", now_s, **shown)
        presenter.show(first=is_first, turned=turned)
        if not turned:
            which = f", {ordinal(self.stimulus)}" if self.stimulus else ""
            self.say(f"cue: {self.name}{which}")

    def _start_times(self, now_s: float) -> None:
        """Have the times of a trial count from a cue."""
        pace = self.protocol.trial
        self._since_s = {"cue": now_s, "warning": now_s}
        if pace.exposure_from == "cue":
            self._since_s["exposure"] = now_s
        if pace.exposure_s is None and not self.more_to_come:
            self._since_s["answer"] = now_s

    def _ask(self, trial: Trial) -> None:
        """Wait for the answer of a trial, and write it."""
        question, typed, names = self.protocol.asks, self.answers.typed, ""
        if not self.is_shown:
            self.say(f"undo: {self.name}; type its answer: {question.typed}")
        while True:
            line = self._wait_for_line(self._of_trial("answer"))
            if self.is_shown and (steps := question.steps(line.text)) is not None:
                trial = self._turn(trial, steps)
                continue
            try:
                if question.confirm and typed:
                    names, line = self._confirm(names, line)
                if typed and not line.text:
                    continue
                answer, sure = self._parse(trial, line.text)
            except ValueError as error:
                self._refuse(error, line)
                continue
            if not self._is_doubted(answer):
                break
        self._take_answer(trial, answer, sure, line)

    def _confirm(self, before: str, line: Line) -> tuple[str, Line]:
        """Say names back until Enter takes them; the line is empty as long as nothing is taken.

        Parameters
        ----------
        before
            Names that were said back already.
        """
        question = self.protocol.asks
        names = question.marked(f"{before} {line.text}")
        chosen, missing = " ".join(filter(None, names)), question.missing(names)
        if chosen and chosen == before and not missing:
            return chosen, Line(chosen)
        if chosen:
            how = f"one of {missing} is missing" if missing else "Enter takes it"
            self.say(f"chosen: {chosen}; {how}")
        return chosen, Line("")

    def _parse(self, trial: Trial, text: str) -> tuple[str, int | None]:
        """Read an answer, and how sure it is if that stands after a semicolon."""
        asks, spelling = self.protocol.asks, self.protocol.spelling(trial.stimuli[0])
        before, semicolon, after = text.rpartition(";")
        if asks.confidence is None or not semicolon:
            return asks.parse(text, trial, spelling), None
        return asks.parse(before.strip(), trial, spelling), asks.confidence.parse(after)

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
        asks, pace, spelling = (
            self.protocol.asks,
            self.protocol.trial,
            self.protocol.spelling(trial.stimuli[0]),
        )
        told: dict[str, Any] = {"answer": answer, "typed": line.text, **_numbered(line)}
        if self.is_shown:
            told |= {} if self.presenter.reached else {"early": True}
            told |= {"late": True} if self._late else {}
            if pace.end or pace.exposure_s:
                told["ended_by"] = self._ended_by or "answer"
        self.withdraw()
        self.log("answer", **told)
        self.say(f"answer: {self.name}, {asks.said(answer, spelling)}")
        outcome, was = asks.outcome(trial, answer), asks.was(trial, spelling)
        if outcome and (trial.practice or pace.feedback):
            self.say(f"feedback: {outcome}{f', it was {was}' if was else ''}")
        self._free_s = self.device.now_s
        if sure is not None:
            self._rate(sure, line)
        elif self.progress.lacks_confidence(trial):
            self._ask_confidence(trial)

    def _ask_confidence(self, trial: Trial) -> None:
        """Wait until it is said how sure an answer is, and write it."""
        scale = self.protocol.asks.confidence
        assert scale is not None, "a confidence is lacking"
        if self.answers.typed:
            self.say(f"confidence: {self.name}; type {scale.least} to {scale.most}")
        answer = self.progress.answers[trial.key].data["answer"]
        asked = self._of_trial("confidence")._replace(answer=answer)
        line, sure = self._ask_for(asked, scale.parse)
        self._rate(sure, line)
        self._free_s = self.device.now_s

    def _rate(self, sure: int, line: Line) -> None:
        self.log("confidence", confidence=sure, **_numbered(line))
        self.say(f"rated: {self.name}, confidence {sure}")

    def _of_trial(self, what: Any) -> Asked:
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

    def _ask_for(self, asked: Asked, parse: Callable[[str], Read]) -> tuple[Line, Read]:
        """Wait for a line that can be read."""
        while True:
            line = self._wait_for_line(asked)
            try:
                return line, parse(line.text)
            except ValueError as error:
                self._refuse(error, line)

    def _refuse(self, error: ValueError, line: Line) -> None:
        """Say why a line is no answer; a line of a file or a program cannot be typed again."""
        if not self.answers.typed:
            where = f" line {line.number}" if line.number else ""
            raise InputError(f"{self.answers.name}{where}: {error}") from None
        self.say(f"no answer: {error}")

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

    # Waiting.

    def await_enter(self, waits_for: str, planned_s: float | None = None) -> None:
        """Wait until Enter is typed, and say when the planned time is over."""
        self.waits_for = waits_for
        began_s = self.device.now_s
        while True:
            found = self.wait(Asked("go"))
            if found is not None and not found.text.strip():
                return
            if found is not None:
                self.say("no answer is waited for now; Enter goes on")
            if planned_s is not None and self.device.now_s - began_s >= planned_s:
                planned_s = None
                self.say("break: its time is over; Enter goes on")

    def _wait_for_line(self, asked: Asked) -> Line:
        """Wait for a line that is no command."""
        found = None
        while found is None:
            found = self.wait(asked)
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
        self.answers.awaits_key = self.reading
        if self.is_shown and not self.answers.typed:
            self.presenter.press()  # answers that are not typed take no time to read paper
        # A file or a program is asked when the stimulus is read; a person may type at any time.
        is_due = not self.paused and (not self.is_shown or self.presenter.read)
        found = self.answers.line(asked if is_due else None, self._wait_s())
        self._poll()
        self._watch_time()
        self._look(self)
        if isinstance(found, Press):
            self.end_reading(self._key)
        elif found is not None:
            return self._obey(found, asked)
        elif asked is not None and asked.what == "answer":
            return self._controlled()
        return None

    def _obey(self, line: Line, asked: Asked | None) -> Line | None:
        """Do what a line says if it is a command, or Enter; else return it."""
        text = line.text.strip()
        if not text:
            return self._enter(line)
        word, _, rest = text.partition(" ")
        word, rest = word.lower(), rest.strip()
        command = COMMANDS.get(word)
        if command is None or (rest and not command.takes):
            return line._replace(text=text)
        if word == "answer":
            return line._replace(text=rest)
        if word == "command":
            command, rest = COMMANDS.get(rest.lower(), COMMANDS["help"]), ""
        elif not rest and word in self._ambiguous and asked and asked.what == "answer":
            said = f"type answer {text}, or command {word}"
            self.say(f"{text} is a command, and a string here: {said}")
            return None
        command.does(self, rest)
        return None

    def _enter(self, line: Line) -> Line | None:
        """Do what Enter does now; return it if something waits for it."""
        presenter = self.presenter
        if self.device.confirm():
            return None
        if self.paused:
            self.go()
        elif self.is_shown and presenter.by_key and not presenter.read:
            if why := presenter.press():
                self.say(f"too early: {why}")
        elif self.reading and self._key == "key:enter":
            self.end_reading(self._key)
        else:
            return line
        return None

    def _wait_s(self) -> float:
        """Return how long may be waited for a line."""
        if not self._real:
            return 0.0
        exposure_s, since_s = self.protocol.trial.exposure_s, self._since_s.get("exposure")
        if exposure_s is None or since_s is None or self.paused or not self.is_shown:
            return POLL_S
        return min(max(since_s + exposure_s - self.device.now_s, 0.0), POLL_S)

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
            self._since_s["exposure"] = at_s
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
        for control in self.device.take_controls():
            if self.trial is None or self.paused or not self.is_shown:
                continue
            if line := self.protocol.asks.controlled(control, self.trial):
                return Line(line)
        return None

    def _watch_time(self) -> None:
        """Do what is due by the time since the cue."""
        if not self.is_shown or self.paused:
            return
        pace = self.protocol.trial
        if self._is_past("exposure", pace.exposure_s):
            self.end_reading("exposure")
        if self._is_past("warning", pace.warning_s):
            self._play(Tone(*self.protocol.sound.warning))
            self.log("warning")
            self.say(f"warning: {self.name}, {pace.warning_s:g} s")
        if self._is_past("answer", pace.answer_s):
            if pace.late == "missed":
                self.withdraw()
                self.log("missed")
                self.say(f"missed: {self.name}, no answer in {pace.answer_s:g} s")
                self._free_s = self.device.now_s
                raise Again
            self._late = True
            self.say(f"late: {self.name}, after {pace.answer_s:g} s")

    def _is_past(self, what: str, limit_s: float | None) -> bool:
        """Tell, once, whether a time of the open trial is over."""
        since_s = self._since_s.get(what)
        if limit_s is None or since_s is None or self.device.now_s - since_s < limit_s:
            return False
        del self._since_s[what]
        return True

    def end_reading(self, by: str, at_s: float | None = None) -> None:
        """End reading of the stimulus that is shown, by the participant's key or by the time."""
        if not self.reading:
            return
        at_s = self.device.now_s if at_s is None else at_s
        self.presenter.end_reading()
        self.log("ended", at_s, by=by)
        self._since_s.pop("exposure", None)
        said = by.replace(":", " ")
        if self.more_to_come:
            self.say(f"ended: the {ordinal(self.stimulus)}, by {said}")
            return
        self._ended_by = by
        if self.protocol.trial.exposure_s is not None:
            self._since_s["answer"] = at_s
        typed = f"; type the answer: {self.protocol.asks.typed}" if self.answers.typed else ""
        self.say(f"ended: {at_s - self._since_s['cue']:.2f} s, by {said}{typed}")

    def _watch_key(self) -> None:
        """Look out for the participant's key, or say that Enter is pressed instead."""
        self._key, key = self.protocol.trial.end or "", self.protocol.trial.key
        if not key or self._key == "key:enter" or not self.answers.typed:
            return
        name = self._key.removeprefix("key:")
        if self.answers.watch(key):
            self.say(f"key: {name} ends reading, with no Enter after it")
        else:
            self._key = "key:enter"
            self.say(f"key: lines are typed whole here; Enter ends reading instead of {name}")

    def _suspend(self) -> None:
        """Pause, and stop the process; afterwards Enter ends the pause."""
        was_paused = self.paused
        self.pause()
        self.answers.release()
        self._suspension.stop()
        self.answers.take()
        if not was_paused and not self.answers.typed:
            self.go()

    def pause(self) -> None:
        """Bring the array to rest."""
        if self.paused:
            return
        self.paused, self._paused_s = True, self.device.now_s
        self._rest()
        self.log("pause")
        self.say("pause: the array is at rest; Enter goes on")

    def _rest(self) -> None:
        self.device.rest()
        if self.pins is not None:
            self.pins.rest()

    def go(self) -> None:
        """Go on after a pause."""
        self.paused = False
        away_s = self.device.now_s - self._paused_s
        self._since_s = {what: since_s + away_s for what, since_s in self._since_s.items()}
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
        at_s = self.device.now_s if at_s is None else at_s
        self._mark(kind, at_s, self.trial, data.get("stimulus", 0))
        t_s = self._elapsed_s(at_s)
        self.progress.take(self._record.append(kind, t_s, self.trial, self.attempt, **data))

    def _elapsed_s(self, at_s: float) -> float:
        return self._before_s + at_s - self._began_s


def _numbered(line: Line) -> dict[str, int]:
    return {"script_line": line.number} if line.number else {}


# Commands, which may be typed beside answers.


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


def _undo(runner: Runner, _: str) -> None:
    newest = runner.progress.newest_given
    if newest is None:
        runner.say("undo: there is no answer to take back")
        return
    if newest.kind == "reply":
        runner.trial = None
        runner.log("undo", name=newest.data["name"], number=newest.data["number"])
        raise Again
    runner.withdraw()
    trial = next(each for each in runner.progress.plan.trials if each.key == newest.key)
    runner.trial, runner.attempt = trial, runner.progress.attempts(trial)
    runner.log("undo")
    raise Again


def _repeat(runner: Runner, _: str) -> None:
    if not runner.is_shown:
        runner.say("repeat: no trial is open")
        return
    runner.log("repeat")
    raise Again


def _note(runner: Runner, text: str) -> None:
    if not text:
        runner.say("note: type the note after the word")
        return
    runner.log("note", text=text)
    runner.say("note: is in")


def _pause(runner: Runner, _: str) -> None:
    if runner.paused:
        runner.go()
    else:
        runner.pause()


def _go(runner: Runner, _: str) -> None:
    if runner.paused:
        runner.go()
    else:
        runner.say("go: nothing is paused; if it is the answer, type answer go")


def _break(runner: Runner, _: str) -> None:
    runner.break_wanted = True
    if runner.trial is None or runner.is_shown or runner.progress.lacks_confidence(runner.trial):
        runner.say("break: after this trial")
    else:
        raise Again


def _begin(runner: Runner, _: str) -> None:
    if runner.progress.practice_is_over:
        runner.say("begin: practice is over already")
        return
    runner.withdraw()
    runner.trial = None
    runner.log("begin")
    raise Again


def _stop(_runner: Runner, _: str) -> None:
    raise Over("stop", "stopped by the experimenter")


def _quit(runner: Runner, reason: str) -> None:
    if not reason:
        runner.say("quit: type the reason after the word; stop ends for now alone")
        return
    raise Over("end", "the participant stopped", reason=reason)


def _help(runner: Runner, _: str) -> None:
    asks, asked = runner.protocol.asks, runner.asked
    if asked is not None and asked.item is not None:
        runner.say(f"question: {asked.item.ask} Type {asked.item.typed}")
    elif asks.ask:
        runner.say(f"question: {asks.ask}")
    runner.say(f"an answer: {asks.typed}")
    if asks.confidence is not None:
        least, most = asks.confidence.least, asks.confidence.most
        runner.say(f"confidence: {least} to {most}, after the answer or after a semicolon")
    runner.say("Enter: go on after a pause or a break")
    for word, command in COMMANDS.items():
        runner.say(f"{word}: {command.help}")


COMMANDS: dict[str, Command] = {
    "answer": Command(nothing, "before an answer that is also a command", takes=True),
    "command": Command(nothing, "before a command that is also a string", takes=True),
    "undo": Command(_undo, "take back the last answer, and type it again"),
    "repeat": Command(_repeat, "show the open trial again, from its start"),
    "note": Command(_note, "write the rest of the line into the record", takes=True),
    "pause": Command(_pause, "bring the array to rest; Enter goes on"),
    "go": Command(_go, "go on after a pause"),
    "break": Command(_break, "have a break after the open trial"),
    "begin": Command(_begin, "end practice"),
    "stop": Command(_stop, "stop for now; session resume goes on"),
    "quit": Command(_quit, "end for good; the participant's reason after it", takes=True),
    "help": Command(_help, "list what may be typed"),
}
