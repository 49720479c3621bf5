"""Runs a session trial by trial: start signal, reading, answer, and what is typed between.

A trial is written as it goes, from top to bottom. While it waits, `Runner._wait` polls the device
and takes lines; a command that ends the trial raises `_Again` or `_Stop`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from vbraille.errors import InputError
from vbraille.sessions.planning.questionnaire import Item
from vbraille.sessions.planning.questions import Spelling
from vbraille.sessions.planning.shown import make_shown
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import Record
from vbraille.sessions.running.answers import Answers, Asked, NoMoreAnswers
from vbraille.sessions.running.device import Happening, SessionDevice
from vbraille.sessions.running.paper import Paper

Say = Callable[[str], None]


class _Again(Exception):
    """The open trial is over; whichever trial comes next now is begun."""


class _Stop(Exception):
    """The session stops, and can be resumed."""


def _silence(_tone: tuple[int, int]) -> None:
    """Play nothing."""


class Runner:
    """Runs a session.

    Parameters
    ----------
    record, progress
        Record that events are added to, and how far the session has come.
    answers, device
        Where answers come from, and what stimuli are felt on.
    say
        Is called with each sentence for the experimenter.
    play
        Is called with each tone for the participant.
    """

    def __init__(
        self,
        record: Record,
        progress: Progress,
        answers: Answers,
        device: SessionDevice | Paper,
        say: Say,
        play: Callable[[tuple[int, int]], None] = _silence,
    ) -> None:
        self.progress = progress
        self.protocol = progress.protocol
        self._record = record
        self._answers = answers
        self._device = device
        self._say = say
        self._play = play
        self._trial: Trial | None = None  # the trial that is shown or asked about
        self._attempt = 0
        self._paused = self._is_shown = False
        self._ready_s = 0.0  # when the next trial may begin
        self._began_s = 0.0
        self._before_s = progress.t_s

    def run(self, **told: Any) -> None:
        """Run the session from where it is to its end, or until it is stopped.

        Parameters
        ----------
        told
            What the event of the run says, such as the device.
        """
        while not self._device.now_s:
            self._device.poll()
        self._began_s = self._ready_s = self._device.now_s
        self._log("run", answers=self._answers.name, **told)
        if self.progress.done:
            self._say(f"resume: {self.progress.done} trials have answers")
        try:
            while True:
                try:
                    if not self._go_on():
                        break
                except _Again:
                    self._withdraw()
            self._log("end")
            self._say("end: all trials are done")
        except (_Stop, NoMoreAnswers, KeyboardInterrupt):
            self._withdraw()
            self._log("stop")
            self._say("stop: session resume goes on")

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

    def _ask_item(self, item: Item, number: int) -> None:
        """Ask a question of the questionnaire, and write the reply."""
        self._trial = None
        self._say(f"question: {item.ask} Type {item.typed}")
        while True:
            line, script_line = self._wait_for_line(Asked("reply", None, 0, list, item=item))
            try:
                reply = item.parse(line)
                break
            except ValueError as error:
                self._refuse(error, script_line)
        self._log("reply", name=item.name, number=number, reply=reply, **_numbered(script_line))

    def _conduct(self, trial: Trial) -> None:
        """Conduct a trial, or what is left of it."""
        self._trial, self._attempt = trial, self.progress.attempts(trial)
        if self.progress.lacks_confidence(trial):
            self._ask_confidence(trial)
            return
        if self.progress.is_taken_back(trial):
            self._ask(trial)
            return
        self._trial = None
        if self.progress.is_break_due(trial):
            self._have_break(trial)
        self._check_limit()
        if self._device.by_key and self._answers.typed:
            self._say(f"ready: {trial.name}; Enter when reading begins")
            self._wait_for_line(Asked("go", trial, 0, list))
        while not self._device.ready or self._device.now_s < self._ready_s:
            self._wait(None)
        self._trial, self._attempt = trial, self.progress.attempts(trial) + 1
        for number in range(len(trial.stimuli)):
            self._show(trial, number)
            if number + 1 < len(trial.stimuli):
                while not (self._device.read and self._device.ready):
                    if self._wait(None) is not None:
                        self._say("no answer is waited for now")
        self._ask(trial)

    def _check_limit(self) -> None:
        """Stop if the session has run for longer than the protocol allows."""
        limit_s = self.protocol.session.limit_s
        if limit_s is not None and self._elapsed_s(self._device.now_s) > limit_s:
            self._say(f"limit: {limit_s:g} s are over")
            raise _Stop

    def _show(self, trial: Trial, stimulus: int) -> None:
        """Put a stimulus under the hand; the record has it before it is felt."""
        line = make_shown(self.protocol, trial.stimuli[stimulus])
        shown = {"stimulus": stimulus, "line": self._device.line + 1}
        if trial.stimuli[stimulus].value is not None:
            shown["value"] = trial.stimuli[stimulus].value
        elif (procedure := self.protocol.procedure) is not None:
            shown["value"] = getattr(trial.stimuli[stimulus].look, procedure.parameter)
        self._log("cue", **shown)
        self._play(self.protocol.sound.cue)
        self._is_shown = True
        self._cue_s = self._device.now_s
        self._warned = False
        self._device.show(line, first=stimulus == 0)
        self._say(f"cue: {trial.name}" + (f", stimulus {stimulus + 1}" if stimulus else ""))

    def _ask(self, trial: Trial) -> None:
        """Wait for the answer of a trial, and write it."""
        question, spelling = self.protocol.asks, self._spelling(trial)
        asked = Asked("answer", trial, self._attempt, self._device.explorations)
        while True:
            line, number = self._wait_for_line(asked)
            if (steps := question.steps(line)) is not None and self._is_shown:
                trial = self._turn(trial, steps)
                continue
            try:
                answer = question.parse(line, trial, spelling)
                break
            except ValueError as error:
                self._refuse(error, number)
        early = {"early": True} if self._is_shown and not self._device.read else {}
        self._withdraw()
        self._log("answer", answer=answer, typed=line, **early, **_numbered(number))
        said = question.said(answer, spelling)
        self._say(f"in: {trial.name} attempt {self._attempt}, {said}")
        if trial.practice or self.protocol.trial.feedback:
            self._tell_outcome(trial, answer)
        self._ready_s = self._device.now_s + trial.gap_s
        if self.progress.lacks_confidence(trial):
            self._ask_confidence(trial)

    def _turn(self, trial: Trial, steps: int) -> Trial:
        """Show the last stimulus at another value, and return the trial that is shown now."""
        value = self.protocol.asks.turned(trial.stimuli[-1].value, steps)
        trial = trial.turned(self.protocol.design.parameter, value)
        self._show(trial, len(trial.stimuli) - 1)
        return trial

    def _ask_confidence(self, trial: Trial) -> None:
        """Wait until it is said how sure an answer is, and write it."""
        scale = self.protocol.asks.confidence
        assert scale is not None, "a confidence is lacking"
        answer = self.progress.answers[trial.key].data["answer"]
        asked = Asked("confidence", trial, self._attempt, self._device.explorations, answer)
        if self._answers.typed:
            self._say(f"confidence: type {scale.least} to {scale.most}")
        while True:
            line, number = self._wait_for_line(asked)
            try:
                self._log("confidence", confidence=scale.parse(line), **_numbered(number))
                return
            except ValueError as error:
                self._refuse(error, number)

    def _refuse(self, error: ValueError, number: int) -> None:
        """Say why a line is no answer; a line of a file cannot be typed again."""
        if not self._answers.typed:
            raise InputError(f"{self._answers.name} line {number}: {error}") from None
        self._say(f"no answer: {error}")

    def _tell_outcome(self, trial: Trial, answer: str) -> None:
        """Say whether an answer is right, and what would have been."""
        asks = self.protocol.asks
        was = asks.was(trial, self._spelling(trial))
        self._say(" ".join(filter(None, [asks.outcome(trial, answer), was and f"it was {was}"])))

    def _have_break(self, trial: Trial) -> None:
        """Have a break until Enter is typed."""
        self._log("break")
        self._say(f"break: {self.progress.done} trials are done; Enter goes on")
        self._wait_for_line(Asked("go", trial, 0, list))
        self._log("go")

    def _wait_for_line(self, asked: Asked) -> tuple[str, int]:
        """Wait for a line that is no command."""
        while True:
            found = self._wait(asked)
            if found is not None:
                return found

    def _wait(self, asked: Asked | None) -> tuple[str, int] | None:
        """Poll the device, do what is due, and return a line that is no command, if one came."""
        ticks, happenings = self._device.poll()
        if ticks.size:
            self._record.add_ticks(ticks)
        for happening in happenings:
            self._take(happening)
        self._watch_time()
        # A file or a program is asked when the line is read; a person may type at any time.
        is_due = not self._paused and (not self._is_shown or self._device.read)
        found = self._answers.line(asked if is_due else None)
        if found is None:
            return None
        word, _, rest = found[0].strip().partition(" ")
        if self._paused and not word:
            word = "go"
        elif not word and self._device.by_key and self._is_shown and not self._device.read:
            self._device.press()
            return None
        if word not in COMMANDS:
            return found
        command, _ = COMMANDS[word]
        command(self, rest.strip())
        return None

    def _take(self, happening: Happening) -> None:
        """Write what the hand or the device did."""
        self._log(happening.kind, happening.time_s, **happening.data)
        if happening.kind == "read" and self._answers.typed:
            self._say(f"read: type {self.protocol.asks.typed}")
        if happening.kind == "fault":
            self._say(f"fault: {happening.data['what']}")
            if self.protocol.faults.repeat:
                raise _Again

    def _watch_time(self) -> None:
        """Warn the participant, and take the stimulus away when its time is over."""
        if not self._is_shown or self._paused:
            return
        shown_s, pace = self._device.now_s - self._cue_s, self.protocol.trial
        if pace.exposure_s is not None and shown_s >= pace.exposure_s and not self._device.read:
            self._log("ended", by="exposure")
            self._device.read = True
            self._device.rest()
        if pace.warning_s is not None and shown_s >= pace.warning_s and not self._warned:
            self._warned = True
            self._play(self.protocol.sound.warning)
            self._log("warning")

    def _withdraw(self) -> None:
        """Take the stimulus away."""
        self._device.withdraw()
        self._is_shown = self._paused = False

    def _spelling(self, trial: Trial) -> Spelling:
        style = self.protocol.style(trial.stimuli[0].look)
        return Spelling(self.protocol.masks, style.mapping.shown_dots())

    def _elapsed_s(self, at_s: float) -> float:
        """Return the time that the session had run for, without the time between runs."""
        return self._before_s + at_s - self._began_s

    def _log(self, kind: str, at_s: float | None = None, **data: Any) -> None:
        """Write an event, of the open trial if there is one; it is on the disk then."""
        t_s = self._elapsed_s(self._device.now_s if at_s is None else at_s)
        event = self._record.append(kind, t_s, self._trial, self._attempt, **data)
        self.progress.take(event)

    # Commands of the experimenter.

    def undo(self, _: str) -> None:
        """Take back the last answer."""
        trial = self.progress.last_answered
        if trial is None:
            self._say("nothing to undo")
            return
        self._trial, self._attempt = trial, self.progress.attempts(trial)
        self._log("undo")
        self._say(f"undo: {trial.name}; type its answer")
        raise _Again

    def repeat(self, _: str) -> None:
        """Show the open trial again."""
        if not self._is_shown:
            self._say("no trial is open")
            return
        self._log("repeat")
        raise _Again

    def pause(self, _: str) -> None:
        """Bring the array to rest; Enter goes on."""
        if not self._paused:
            self._paused = True
            self._device.rest()
            self._log("pause")
            self._say("pause: Enter goes on")

    def go(self, _: str) -> None:
        """Go on after a pause."""
        if self._paused:
            self._paused = False
            if self._is_shown:
                self._device.go()
            self._log("go")
            self._say("go: on")

    def note(self, text: str) -> None:
        """Note something in the record."""
        self._log("note", text=text)
        self._say("note: is in")

    def stop(self, _: str) -> None:
        """Stop for now."""
        raise _Stop

    def help(self, _: str) -> None:
        """List what may be typed."""
        self._say(f"{self.protocol.asks.typed}, or a command:")
        for word, (_, told) in COMMANDS.items():
            self._say(f"{word}: {told}")


def _numbered(number: int) -> dict[str, int]:
    return {"script_line": number} if number else {}


# What an experimenter may type beside answers, and what it does.
COMMANDS: dict[str, tuple[Callable[[Runner, str], None], str]] = {
    "undo": (Runner.undo, "take back the last answer"),
    "repeat": (Runner.repeat, "show the open trial again"),
    "pause": (Runner.pause, "bring the array to rest; Enter goes on"),
    "go": (Runner.go, "go on after a pause"),
    "note": (Runner.note, "note the text after it"),
    "stop": (Runner.stop, "stop for now; session resume goes on"),
    "help": (Runner.help, "list this"),
}
