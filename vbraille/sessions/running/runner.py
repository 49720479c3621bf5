"""Runs a session trial by trial: start signal, reading, answer, and what is typed between.

A trial is written as it goes, from top to bottom. While it waits, `Runner.wait` polls the device
and takes lines. A command that ends the trial raises `Again`, one that ends the run raises `Over`.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack, suppress
from importlib.metadata import version
from platform import python_version
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from msgspec import structs

from vbraille.braille.spelling import ordinal
from vbraille.engine.host import HostDiedError
from vbraille.errors import InputError
from vbraille.sessions.planning.questionnaire import Item
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import Record
from vbraille.sessions.running.answers import Answers, Asked, Line, NoMoreAnswers
from vbraille.sessions.running.conditions import Conditions, open_sound
from vbraille.sessions.running.markers import Markers
from vbraille.sessions.running.pins import Pins
from vbraille.sessions.running.presenter import Happening, Presenter
from vbraille.signals import Suspension

if TYPE_CHECKING:
    from vbraille.sessions.running.liveview import SessionView

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

    Its arguments are the kind of the last event, which is "stop" if the session can be resumed, or
    else "end"; why it is over; and the participant's reason, if there is one.
    """


class Runner:
    """Runs a session.

    Parameters
    ----------
    record, progress
        Record that events are added to, and how far the session has come.
    conditions, answers
        Conditions of the run, and where answers come from.
    say
        Function that is called with each sentence for the experimenter.

    Attributes
    ----------
    device : Presenter
        What stimuli are felt on.
    trial : Trial or None
        Trial that is open, or comes next.
    attempt, stimulus : int
        Which attempt at it, from 1, and which of its stimuli is shown, from 0.
    is_shown, paused, is_over : bool
        Whether a stimulus is shown, the session is paused, and the run is over.
    asked : Asked or None
        What a line is waited for.
    """

    device: Presenter

    def __init__(
        self,
        record: Record,
        progress: Progress,
        conditions: Conditions,
        answers: Answers,
        say: Callable[[str], None],
    ) -> None:
        self.progress, self.protocol = progress, progress.protocol
        self.say = say
        self.trial: Trial | None = None
        self.attempt = self.stimulus = 0
        self.is_shown = self.paused = self.is_over = False
        self.asked: Asked | None = None
        self._record, self._conditions, self._answers = record, conditions, answers
        self._pins: Pins | None = None  # the conventional display beside the device
        self._view: SessionView | None = None
        self._suspension = Suspension()
        self._deaths = 0
        self._break_wanted = False
        self._told: dict[str, Any] = {}  # what the event of a run says
        self._began_s = self._before_s = self._free_s = self._paused_s = 0.0
        # When the "warning", the end of the "exposure", of the time for an "answer", and of a
        # "break" are due.
        self._due_s: dict[str, float] = {}

    @property
    def elapsed_s(self) -> float:
        """Seconds that the session has run for, without the time between runs."""
        return self._elapsed_s(self.device.now_s)

    @property
    def presenter(self) -> Presenter:
        """Presenter of the trial that is open or comes next."""
        on_pins = self.trial is not None and self.trial.stimuli[0].on == "pins"
        return self._pins if self._pins is not None and on_pins else self.device

    @property
    def name(self) -> str:
        """Name of the trial that is open or comes next."""
        assert self.trial is not None
        alike = [each for each in self.progress.plan.trials if each.practice == self.trial.practice]
        return f"{self.trial.name} of {len(alike)}"

    @property
    def _reading(self) -> bool:
        """True if a stimulus is read, so that something may end it."""
        return self.is_shown and not (self.paused or self.device.ended or self.presenter.by_key)

    @property
    def _more_to_come(self) -> bool:
        """True if a stimulus of the open trial has not been shown yet."""
        return self.trial is not None and self.stimulus + 1 < len(self.trial.stimuli)

    def run(
        self, monitor: tuple[str | None, int | None] | None, before_rest: Callable[[], None]
    ) -> None:
        """Run the session from where it is to its end, or until it is stopped.

        Parameters
        ----------
        monitor
            Host and port of a live view; None for no live view.
        before_rest
            Function that is called before the device is closed, which nothing may interrupt.
        """
        with ExitStack() as stack:
            self._open(stack, monitor, before_rest)
            kind, *why = self._go_through()
            before_rest()
            if closed := self.device.close():
                self._log("closed", **closed)
            self.is_over, self.asked = True, None
            self._log(kind, **dict(zip(("why", "reason"), why, strict=False)))
            goes_on = "; session resume goes on" if kind == "stop" else ""
            self.say(f"{kind}: {why[0]}; {self.progress.done} trials have answers{goes_on}")
            for sentence in self.progress.found if kind == "end" else ():
                self.say(sentence)
            self._look()

    def _open(
        self,
        stack: ExitStack,
        monitor: tuple[str | None, int | None] | None,
        before_rest: Callable[[], None],
    ) -> None:
        """Open the device, and all that stands beside it."""
        conditions, protocol, answers = self._conditions, self.protocol, self._answers
        self._markers = Markers(conditions.markers, protocol.marker_codes, self.say)
        stack.callback(self._markers.close)
        versions = {name: version(name) for name in ("vbraille", "numpy")}
        self._told["versions"] = versions | {"python": python_version()}
        self._told |= {"answers": answers.name, "conditions": structs.asdict(conditions)}
        if monitor is not None:
            from vbraille.sessions.running.liveview import SessionView  # few sessions have one

            view = SessionView(protocol, *monitor, fast=conditions.fast, say=self.say)
            self._view = stack.enter_context(view)
            self.say, self._told["monitor"] = view.say, view.described
        if protocol.needs_pins and not answers.felt and not conditions.fast:
            self._pins = Pins(protocol, self.progress.plan, conditions.also)
            stack.callback(self._pins.close)
        if protocol.medium == "device":
            from vbraille.sessions.running.device import SessionDevice  # loads compiled code

            watch = None if self._view is None else self._view.watch
            self.device = SessionDevice(self.progress, conditions, answers, watch)
        else:
            self.device = Presenter()
        stack.callback(self.device.close)
        stack.callback(before_rest)
        self.device.start()
        if self._pins is not None:
            self._pins.start()
        self._play = open_sound(conditions.sound, answers, self.say)

    def _go_through(self) -> tuple[str, ...]:
        """Go through all trials, and return the arguments of `Over`; the array rests then."""
        self._begin()
        with self._suspension:
            try:
                while self._go_on():
                    pass
                over = "end", self.progress.why_over
            except NoMoreAnswers:
                over = "stop", "there are no more answers"
            except Over as left:
                over = left.args
        trial, self.trial = self.trial, None
        self._withdraw()
        if trial is not None and self.progress.lacks_confidence(trial):
            self.say(f"no confidence: the answer to {trial.name} is kept without one")
        return over

    def _begin(self, **why: Any) -> None:
        """Write that a run has begun; another one does when the engine is started again."""
        self._record.write_ticks()  # those of an engine that died: ticks of each run begin at 0
        self._began_s, self._before_s = self.device.now_s, self.progress.t_s
        self._free_s = -1e9
        self._log("run", clock_s=self._began_s, **self._told, **self.device.told, **why)

    def _go_on(self) -> bool:
        """Do what comes next; return whether there may be something again."""
        try:
            if (asked := self.progress.next_item) is not None:
                self._ask_item(*asked)
            elif (trial := self.progress.next_trial) is not None:
                self._conduct(trial)
            elif self._answers.typed:
                self.trial = None
                last = f"last: {self.progress.why_over}"
                self.say(f"{last}; Enter ends, undo takes back the last answer")
                with suppress(NoMoreAnswers):
                    self._await_enter()
                return False
            else:
                return False
        except Again:
            self._withdraw()
        return True

    def _ask_item(self, item: Item, number: int) -> None:
        """Ask a question of the questionnaire, and write the reply."""
        self.trial = None
        self.say(f"question: {item.ask} Type {item.typed}")
        line, reply = self._ask_for(Asked("reply", item=item), item.parse)
        self._log("reply", name=item.name, number=number, reply=reply, **_numbered(line))
        self.say(f"reply: {item.name} is in")
        self._free_s = self.device.now_s

    # A trial.

    def _conduct(self, trial: Trial) -> None:
        """Conduct a trial, or what is left of it."""
        self.trial, self.attempt = trial, self.progress.tried[trial.key].attempts
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
        if self._break_wanted or self.progress.is_break_due(trial):
            self._have_break()
        presenter, pins = self.presenter, self._pins
        where = ", on the conventional display" if presenter is pins else ""
        enter = presenter.by_key and self._answers.typed
        how = "; press Enter when reading begins" if enter else ""
        again = ", again" if self.attempt else ""
        self.say(f"ready: {self.name}{again}{where}{how}")
        if enter:
            self._await_enter()
        needed = [presenter, pins] if pins and self.protocol.pins.reference else [presenter]
        due_s = self._free_s + trial.gap_s
        while self.paused or self.device.now_s < due_s or not all(each.ready for each in needed):
            self._wait_idly("no answer is waited for now; help lists what may be typed")

    def _have_break(self) -> None:
        """Have a break until Enter is typed."""
        self._break_wanted = False
        trial, self.trial = self.trial, None
        self._log("break")
        if self._answers.typed:
            planned_s, planned = self.protocol.session.break_s, ""
            if planned_s is not None:
                planned = f"{planned_s:g} s are planned; "
                self._due_s["break"] = self.device.now_s + planned_s
            self.say(f"break: {self.progress.done} trials are done; {planned}Enter goes on")
            self._await_enter()
        self._log("go")
        self.trial = trial

    def _present(self, trial: Trial) -> None:
        """Show the stimuli of a trial, and wait for all but the last to be read."""
        for number in range(len(trial.stimuli)):
            self.stimulus = number
            self._show(trial)
            not_felt = f"the {ordinal(number + 1)} has not been felt yet"
            while self._more_to_come and not (self.presenter.read and self.presenter.ready):
                self._wait_idly(f"{not_felt}; repeat shows all from the first")

    def _show(self, trial: Trial, *, turned: bool = False) -> None:
        """Put a stimulus before the participant; the record has it before it is felt.

        Parameters
        ----------
        turned
            Whether it is the stimulus that is shown already, at another value.
        """
        stimulus, presenter, pins = trial.stimuli[self.stimulus], self.presenter, self._pins
        is_first = not self.stimulus and not turned
        shown: dict[str, Any] = {"stimulus": self.stimulus, **presenter.prepare(stimulus)}
        if varied := self.protocol.varied:
            shown["value"] = getattr(stimulus.look, varied)
        if is_first and pins and pins is not presenter and self.protocol.pins.reference:
            pins.show_reference()
        now_s = self.device.now_s
        if not turned:
            pace = self.protocol.trial
            self._play(Tone(*self.protocol.sound.cue))
            self._due_s.clear()
            self._expect("warning", now_s, pace.warning_s)
            if pace.exposure_from == "cue":
                self._expect("exposure", now_s, pace.exposure_s)
            if pace.exposure_s is None and not self._more_to_come:
                self._expect("answer", now_s, pace.answer_s)
        self.is_shown = True
        self._log("cue", now_s, **shown)
        presenter.show(first=is_first, turned=turned)
        if not turned:
            which = f", {ordinal(self.stimulus)}" if self.stimulus else ""
            self.say(f"cue: {self.name}{which}")

    def _expect(self, what: str, from_s: float, after_s: float | None) -> None:
        if after_s is not None:
            self._due_s[what] = from_s + after_s

    def _ask(self, trial: Trial) -> None:
        """Wait for the answer of a trial, and write it."""
        asks, names = self.protocol.asks, ""
        spelling = self.protocol.spelling(trial.stimuli[0])
        if not self.is_shown:
            self.say(f"undo: {self.name}; type its answer: {asks.typed}")
        while True:
            line = self._wait_for_line(self._of_trial("answer"))
            if self.is_shown and (steps := asks.steps(line.text)) is not None:
                trial = self._turn(trial, steps)
                continue
            try:
                if asks.confirm and self._answers.typed:
                    chosen = " ".join(filter(None, asks.marked(f"{names} {line.text}")))
                    if chosen != names:
                        names = chosen
                        self.say(f"chosen: {names}; Enter takes it")
                        continue
                    line = line._replace(text=names)
                text, _, sure = line.text.partition(";") if asks.confidence else (line.text, "", "")
                answer = asks.parse(text, trial, spelling)
                if sure:
                    asks.confidence.parse(sure)  # both are refused, or none
                break
            except ValueError as error:
                self._refuse(error, line)
        told: dict[str, Any] = {"answer": answer, "typed": line.text, **_numbered(line)}
        if self.is_shown:
            told |= {} if self.presenter.reached else {"early": True}
        self._withdraw()
        self._log("answer", **told)
        self.say(f"answer: {self.name}, {asks.said(answer, spelling)}")
        outcome, was = asks.outcome(trial, answer), asks.was(trial, spelling)
        part = self.protocol.practice if trial.practice else self.protocol.trial
        if outcome and part.feedback:
            self.say(f"feedback: {outcome}{f', it was {was}' if was else ''}")
        self._free_s = self.device.now_s
        if self.progress.lacks_confidence(trial):
            self._ask_confidence(trial, line._replace(text=sure) if sure else None)

    def _ask_confidence(self, trial: Trial, line: Line | None = None) -> None:
        """Wait until it is said how sure an answer is, unless a line has it, and write it."""
        scale = self.protocol.asks.confidence
        if self._answers.typed and line is None:
            self.say(f"confidence: {self.name}; type {scale.least} to {scale.most}")
        line, sure = self._ask_for(self._of_trial("rating"), scale.parse, line)
        self._log("confidence", confidence=sure, **_numbered(line))
        self.say(f"rated: {self.name}, confidence {sure}")
        self._free_s = self.device.now_s

    def _of_trial(self, what: Any) -> Asked:
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

    # Waiting.

    def _ask_for(
        self, asked: Asked, parse: Callable[[str], Read], line: Line | None = None
    ) -> tuple[Line, Read]:
        """Wait for a line that can be read, unless it was given already."""
        while True:
            line = line or self._wait_for_line(asked)
            try:
                return line, parse(line.text)
            except ValueError as error:
                self._refuse(error, line)
                line = None

    def _refuse(self, error: ValueError, line: Line) -> None:
        """Say why a line is no answer; a line of a file or a program cannot be typed again."""
        if not self._answers.typed:
            where = f" line {line.number}" if line.number else ""
            raise InputError(f"{self._answers.name}{where}: {error}") from None
        self.say(f"no answer: {error}")

    def _await_enter(self) -> None:
        """Wait until Enter is typed."""
        while self._wait_for_line(Asked("Enter")).text.strip():
            self.say("no answer is waited for now; Enter goes on")

    def _wait_for_line(self, asked: Asked) -> Line:
        """Wait for a line that is no command."""
        found = None
        while found is None:
            found = self.wait(asked)
        return found

    def _wait_idly(self, why: str) -> None:
        """Wait a little, where no answer can be given yet; say why if one is."""
        if self.wait(None) is not None:
            self.say(why)

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
        if self.is_shown and not self._answers.typed:
            self.presenter.press()  # answers that are not typed take no time to read paper
        wait_s = 0.0 if self._conditions.fast else POLL_S
        if not self.paused:
            wait_s = min([wait_s, *(due_s - self.device.now_s for due_s in self._due_s.values())])
        # A file or a program is asked when the stimulus is read; a person may type at any time.
        is_due = not self.paused and (not self.is_shown or self.presenter.read)
        found = self._answers.line(asked if is_due else None, max(wait_s, 0.0))
        self._poll()
        self._watch_time()
        self._look()
        if found is not None:
            return self._obey(found)
        if asked is not None and asked.what == "answer":
            return self._controlled(asked.trial)
        return None

    def _obey(self, line: Line) -> Line | None:
        """Do what a line says if it is a command, or Enter; else return it."""
        text = line.text.strip()
        if not text:
            return self._enter(line)
        word, _, rest = text.partition(" ")
        word, rest = word.lower(), rest.strip()
        if word == "answer" and rest:
            return line._replace(text=rest)
        if word not in COMMANDS or (rest and word not in WITH_TEXT):
            return line._replace(text=text)
        does, _ = COMMANDS[word]
        does(self, rest)
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
        elif self._reading and self.protocol.trial.end == "key:enter":
            self._end_reading("key:enter")
        else:
            return line
        return None

    def _controlled(self, trial: Trial | None) -> Line | None:
        """Return the line that a button or a knob of the device stands for, if one does."""
        for control in self.device.take_controls():
            line = self.protocol.asks.controlled(control, trial)
            if line and self.is_shown and not self.paused:
                return Line(line)
        return None

    def _poll(self) -> None:
        """Take what the device and the conventional display tell."""
        try:
            ticks, happenings = self.device.poll()
        except HostDiedError as fault:
            self._restart(fault)
            return
        if ticks.size:
            self._record.add_ticks(ticks)
        if self._pins is not None:
            happenings += self._pins.poll()[1]
        # A fault may end the trial, and what else came with it is written before.
        for happening in sorted(happenings, key=lambda each: each.kind == "fault"):
            self._take(happening)

    def _take(self, happening: Happening) -> None:
        """Write what the hand or the device did, and say it."""
        kind, at_s, data, said = happening
        if kind == "ended":
            self._end_reading(data["by"], at_s)
            return
        if kind == "fault" and not self.is_shown:
            return
        self._log(kind, at_s, **data)
        if said:
            self.say(said)
        if kind == "contact" and self.protocol.trial.exposure_from == "contact":
            self._expect("exposure", at_s, self.protocol.trial.exposure_s)
        if kind == "read" and self._answers.typed and not self._more_to_come:
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
        self._log("fault" if was_shown else "device", what=str(fault))
        if self._deaths >= MOST_DEATHS:
            raise fault
        self.say(f"fault: {fault}; it is started again")
        self.device.start()
        trial, self.trial = self.trial, None
        self._begin(why="fault")
        self.trial = trial
        if was_shown:
            raise Again

    def _watch_time(self) -> None:
        """Do what is due by now."""
        now_s, pace = self.device.now_s, self.protocol.trial
        for what in [] if self.paused else [*self._due_s]:
            if now_s < self._due_s[what]:
                continue
            del self._due_s[what]
            match what:
                case "break":
                    self.say("break: its time is over; Enter goes on")
                case "exposure":
                    self._end_reading("exposure")
                case "warning":
                    self._play(Tone(*self.protocol.sound.warning))
                    self._log("warning")
                    self.say(f"warning: {self.name}, {pace.warning_s:g} s")
                case "answer" if pace.late == "missed":
                    self._withdraw()
                    self._log("missed")
                    self.say(f"missed: {self.name}, no answer in {pace.answer_s:g} s")
                    self._free_s = now_s
                    raise Again
                case "answer":
                    self._log("late")
                    self.say(f"late: {self.name}, after {pace.answer_s:g} s")

    def _end_reading(self, by: str, at_s: float | None = None) -> None:
        """End reading of the stimulus that is shown, by Enter, a button or the time."""
        if not self._reading:
            return
        at_s = self.device.now_s if at_s is None else at_s
        self.presenter.end_reading()
        self._log("ended", at_s, by=by)
        self._due_s.pop("exposure", None)
        which, typed = f"the {ordinal(self.stimulus)}", ""
        if not self._more_to_come:
            which = "reading"
            typed = f"; type the answer: {self.protocol.asks.typed}" if self._answers.typed else ""
            if self.protocol.trial.exposure_s is not None:
                self._expect("answer", at_s, self.protocol.trial.answer_s)
        self.say(f"ended: {which}, by {by.replace(':', ' ')}{typed}")

    def _suspend(self) -> None:
        """Pause, and stop the process; afterwards Enter ends the pause."""
        was_paused = self.paused
        self.pause()
        self._answers.release()
        self._suspension.stop()
        self._answers.take()
        if not was_paused and not self._answers.typed:
            self.go()

    def _withdraw(self) -> None:
        """Take the stimulus away."""
        self.device.withdraw()
        if self._pins is not None:
            self._pins.withdraw()
        self.is_shown = self.paused = False
        self._due_s.clear()

    def _log(self, kind: str, at_s: float | None = None, **data: Any) -> None:
        """Write an event, of the open trial if there is one; it is on the disk then."""
        at_s = self.device.now_s if at_s is None else at_s
        self._markers.mark(kind, at_s, self.trial, data.get("stimulus", 0))
        t_s = self._elapsed_s(at_s)
        self.progress.take(self._record.append(kind, t_s, self.trial, self.attempt, **data))

    def _look(self) -> None:
        if self._view is not None:
            self._view.look(self)

    def _elapsed_s(self, at_s: float) -> float:
        return self._before_s + at_s - self._began_s

    # Commands, which may be typed beside answers.

    def undo(self, _: str) -> None:
        """Take back the newest answer or reply."""
        newest = self.progress.newest_given
        if newest is None:
            self.say("undo: there is no answer to take back")
            return
        data: dict[str, Any] = {}
        if newest.kind == "reply":
            self.trial = None
            data = {name: newest.data[name] for name in ("name", "number")}
        else:
            self._withdraw()
            trials = self.progress.plan.trials
            self.trial = next(trial for trial in trials if trial.key == newest.key)
            self.attempt = self.progress.tried[self.trial.key].attempts
        self._log("undo", **data)
        raise Again

    def repeat(self, _: str) -> None:
        """Show the open trial again."""
        if not self.is_shown:
            self.say("repeat: no trial is open")
            return
        self._log("repeat")
        raise Again

    def note(self, text: str) -> None:
        """Write a note."""
        if not text:
            self.say("note: type the note after the word")
            return
        self._log("note", text=text)
        self.say("note: is in")

    def pause(self, _: str = "") -> None:
        """Bring the array to rest."""
        if not self.paused:
            self.paused, self._paused_s = True, self.device.now_s
            self.device.rest()
            if self._pins is not None:
                self._pins.rest()
            self._log("pause")
        self.say("pause: the array is at rest; Enter goes on")

    def go(self, _: str = "") -> None:
        """Go on after a pause."""
        if not self.paused:
            self.say("go: nothing is paused; if it is the answer, type answer go")
            return
        self.paused = False
        away_s = self.device.now_s - self._paused_s
        self._due_s = {what: due_s + away_s for what, due_s in self._due_s.items()}
        if self.is_shown:
            self.presenter.go()
        self._log("go")
        self.say("go: on")

    def have_break(self, _: str) -> None:
        """Have a break as soon as no trial is open."""
        self._break_wanted = True
        if not self.is_shown:
            raise Again
        self.say("break: after this trial")

    def begin(self, _: str) -> None:
        """End practice."""
        if self.progress.practice_is_over:
            self.say("begin: practice is over already")
            return
        self._withdraw()
        self.trial = None
        self._log("begin")
        raise Again

    def stop(self, _: str) -> None:
        """Stop for now."""
        raise Over("stop", "stopped by the experimenter")

    def quit(self, reason: str) -> None:
        """End the session for good."""
        if not reason:
            self.say("quit: type the reason after the word; stop ends for now alone")
            return
        raise Over("end", "the participant stopped", reason)

    def help(self, _: str) -> None:
        """List what may be typed."""
        asks, item = self.protocol.asks, self.asked and self.asked.item
        if item:
            self.say(f"question: {item.ask} Type {item.typed}")
        elif asks.ask:
            self.say(f"question: {asks.ask}")
        self.say(f"an answer: {asks.typed}")
        if (scale := asks.confidence) is not None:
            self.say(f"confidence: {scale.least} to {scale.most}, after the answer or a semicolon")
        self.say("answer: before an answer that is also a command, such as answer pause")
        self.say("Enter: go on after a pause or a break")
        for word in COMMANDS:
            self.say(f"{word}: {COMMANDS[word][1]}")


def _numbered(line: Line) -> dict[str, int]:
    return {"script_line": line.number} if line.number else {}


COMMANDS: dict[str, tuple[Callable[[Runner, str], None], str]] = {
    "undo": (Runner.undo, "take back the last answer, and type it again"),
    "repeat": (Runner.repeat, "show the open trial again, from its start"),
    "note": (Runner.note, "write the rest of the line into the record"),
    "pause": (Runner.pause, "bring the array to rest; Enter goes on"),
    "go": (Runner.go, "go on after a pause"),
    "break": (Runner.have_break, "have a break after the open trial"),
    "begin": (Runner.begin, "end practice"),
    "stop": (Runner.stop, "stop for now; session resume goes on"),
    "quit": (Runner.quit, "end for good; the participant's reason after it"),
    "help": (Runner.help, "list what may be typed"),
}
WITH_TEXT = ("note", "quit")
