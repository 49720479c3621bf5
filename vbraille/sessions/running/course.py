"""The course of a session: what comes after what, and what of it is written down.

Ready, the slider at the left, the start signal, the hand reads, an answer, the
next trial; breaks, the warning and the limit where the protocol has them; a
trial again if the device failed in it.
"""

from __future__ import annotations

import time
from dataclasses import asdict, replace
from enum import Enum, auto
from typing import TYPE_CHECKING, Any

from vbraille.engine.host import HostDiedError
from vbraille.sessions.planning.planfile import stimulus_to_json
from vbraille.sessions.record import events
from vbraille.sessions.record.folder import SHOWN_FROM, versions
from vbraille.sessions.running.logbook import Logbook

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.render.braille.tuning import Tuning
    from vbraille.sessions.planning.conduct import Tone
    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.journal import Journal
    from vbraille.sessions.record.progress import Progress
    from vbraille.sessions.running.showing import Happened, OnDevice

POLL_S = 0.02
MOST_DEATHS = 3  # a host that dies so often is not started again


class Phase(Enum):
    """What is waited for."""

    BREAK = auto()  # Enter
    READY = auto()  # the slider at the left; on paper, Enter
    OPEN = auto()  # the answer
    LAST = auto()  # all trials are done: Enter, or an undo
    OVER = auto()  # nothing


class Course:
    """Go from trial to trial.

    Parameters
    ----------
    protocol, plan
        What is done.
    journal
        Where every event goes.
    progress
        What was done before.
    display
        What shows the stimuli; None on paper.
    waits
        Whether somebody is waited for at breaks.
    corrects
        Whether the last answer of all may be taken back.
    say
        Where to say things, one thing a call.
    play
        Makes the participant's signals.
    real
        Whether time is the machine's; else the display's own.

    Attributes
    ----------
    phase : Phase
        What is waited for.
    paused : bool
        Whether the array rests until told otherwise.
    book : Logbook
        Where all that happens is written down.
    read_said : bool
        Whether somebody has been told that the trial is read; on paper, whether it is.
    """

    def __init__(
        self,
        protocol: Protocol,
        plan: Plan,
        journal: Journal,
        progress: Progress,
        display: OnDevice | None,
        *,
        waits: bool,
        corrects: bool,
        say: Callable[[str], None],
        play: Callable[[Tone], None],
        real: bool = True,
    ) -> None:
        self.protocol = protocol
        self.plan = plan
        self.progress = progress
        self.display = display
        self.phase = Phase.READY
        self.paused = False
        self.read_said = False
        self._waits = waits
        self._corrects = corrects
        self._say = say
        self._play = play
        self._real = real
        self.book = Logbook(journal, progress, self._now_ns)
        self._break_wanted = False
        self._stimulus = 0
        self._attempt = 0
        self._ready_ns = 0
        self._cue_ns = 0
        self._deaths = 0

    @property
    def trial(self) -> Trial | None:
        """The trial that is open, or comes next."""
        return self.progress.next_trial

    @property
    def open_trial(self) -> Trial | None:
        """The trial that is open."""
        return self.trial if self.phase is Phase.OPEN else None

    @property
    def read(self) -> bool:
        """Whether the open trial has been read to its end."""
        trial = self.open_trial
        if trial is None or self._stimulus + 1 < len(trial.stimuli):
            return False
        return self.read_said if self.display is None else self.display.read

    @property
    def reached(self) -> bool:
        """Whether the hand has been at the end of the open trial; on paper, whether it is read."""
        return self.read_said if self.display is None else self.display.reached

    @property
    def second_to_come(self) -> bool:
        """Whether a stimulus of the open trial has not been shown yet."""
        trial = self.open_trial
        return trial is not None and self._stimulus + 1 < len(trial.stimuli)

    def name(self, trial: Trial) -> str:
        """What to call a trial."""
        if trial.practice:
            return f"practice {trial.number} of {len(self.plan.practice)}"
        return f"trial {self.progress.of_all(trial.number)}"

    def start(self, **started: Any) -> None:
        """Begin a run with the engine started; `started` are more fields of the journal's `Run`."""
        display = self.display
        if display is not None:
            trace = display.open(len(self.progress.runs) + 1, self.progress.line)
            started |= {"trace": trace, "device": asdict(display.engine.display)}
            while not display.now_ns:  # its clock is the session's
                display.poll()
                self.sleep()
        self.book.begin()
        self.book.log(events.Run, **started, versions=versions())

    def sleep(self) -> None:
        """Wait a little for the device to go on, if time does not go by polling."""
        if self._real:
            time.sleep(POLL_S)

    def next(self, *, gap: bool = True) -> None:
        """Get the next trial ready, have a break, or end."""
        trial = self.trial
        gap_s = self.protocol.trial.gap_s if gap else 0.0
        self._ready_ns = self._now_ns() + round(gap_s * 1e9)
        if trial is None:
            self._wait_for_end()
        elif self._over():
            self.end(f"the limit of {self.protocol.session.limit_s:g} s is over")
        elif self._break_due(trial):
            self.have_break()
        else:
            self._ready(trial)

    def end(self, why: str) -> None:
        """End the session for good."""
        self.book.log(events.End, why=why)
        self._say(f"end: {why}; {self.progress.of_all(self.progress.done)} have answers")
        self.phase = Phase.OVER

    def have_break(self) -> None:
        """Have a break, before the trial that comes next."""
        self._break_wanted = False
        self.book.log(events.Break)
        if self._waits:
            self.phase = Phase.BREAK
            self._say(f"break: {self.progress.done} trials are done; Enter goes on")
        elif self.trial is not None:
            self._ready(self.trial)

    def want_break(self) -> None:
        """Have a break as soon as no trial is open."""
        self._break_wanted = True
        if self.phase is Phase.READY:
            self.have_break()
        else:
            self._say("break: after this trial")

    def begin(self) -> None:
        """Show the trial that comes next."""
        trial = self.trial
        assert trial is not None, "there is no trial to begin"
        self._attempt = self.progress.told(trial).attempts + 1
        self.phase = Phase.OPEN
        self.read_said = False
        self._show(trial, 0)

    def again(self) -> None:
        """Have the open trial shown again."""
        self.withdraw()
        self.next(gap=False)

    def withdraw(self) -> None:
        """Take away what is shown; what was felt of it goes to the disk."""
        if self.display is not None:
            self.display.withdraw()
            self.display.sync()

    def press(self) -> None:
        """On paper: take the key that says that reading begins, and then that it is over."""
        trial = self.trial
        if trial is None:
            return
        if self.phase is Phase.READY:
            self.begin()
        elif self.phase is Phase.OPEN and not self.read_said:
            self.read_said = True
            self.book.log(events.Read, trial, attempt=self._attempt, stimulus=0)
            told = self.progress.told(trial)
            self._say(f"read: {told.t_s['read'] - told.t_s['cue']:.1f} s; type the answer")

    def retune(self, tuning: dict[str, float]) -> None:
        """Show this trial and those to come with another contrast or texture."""
        trial = self.open_trial
        if trial is None or self.display is None:
            self.book.log(events.Tuning, tuning=tuning)
            return
        self.book.log(events.Tuning, trial, tuning=tuning, line=self.display.line + 1)
        self.display.retune(self._tuning(trial))

    def look(self) -> bool:
        """See what the display has to tell; whether its engine still is the one before.

        Raises
        ------
        VbrailleError
            If the device, or the disk, fails for good.
        """
        if self.display is None:
            return True
        try:
            happened = self.display.poll()
        except HostDiedError as fault:
            self._start_again(fault)
            return False
        for each in happened:
            self._take(each)
        return True

    def poll(self) -> None:
        """See what the display has to tell, and what is due.

        Raises
        ------
        VbrailleError
            If the device, or the disk, fails for good.
        """
        if not self.look():
            return
        trial, display = self.trial, self.display
        if trial is None or self.paused:
            return
        if self.phase is Phase.OPEN:
            self._watch(trial)
        elif self.phase is Phase.READY and display is not None and display.ready:
            self._begin_when_due()

    def _now_ns(self) -> int:
        if self._real or self.display is None:
            return time.monotonic_ns()
        return self.display.now_ns

    def _begin_when_due(self) -> None:
        if self._now_ns() >= self._ready_ns and self.progress.correcting is None:
            self.begin()

    def _ready(self, trial: Trial) -> None:
        self.phase = Phase.READY
        again = ", again" if self.progress.told(trial).attempts else ""
        how = "; Enter when reading begins" if self.display is None and self._waits else ""
        self._say(f"ready: {self.name(trial)}{again}{how}")

    def _wait_for_end(self) -> None:
        if not self._corrects:
            self.end("all trials are done")
            return
        self.phase = Phase.LAST
        if self._waits:
            self._say("last: all trials are done; Enter ends, undo takes back the last answer")

    def _over(self) -> bool:
        limit_s = self.protocol.session.limit_s
        return limit_s is not None and self.progress.t_s >= limit_s

    def _break_due(self, trial: Trial) -> bool:
        done = self.progress.done
        if self._break_wanted:
            return True
        if trial.practice or done == self.progress.broken:
            return False
        every = self.protocol.session.break_every
        in_block = sum(past.trial.block == trial.block for past in self.progress.history)
        return not in_block or (every is not None and in_block % every == 0)

    def _show(self, trial: Trial, stimulus: int) -> None:
        self._stimulus = stimulus
        shown: dict[str, Any] = {"attempt": self._attempt, "stimulus": stimulus}
        if self.display is not None:
            # The number that it will get: the journal knows of it before it is felt.
            shown["line"] = self.display.line + 1
        if self.progress.tuning:
            shown["tuning"] = self.progress.tuning
        if self.book.format >= SHOWN_FROM:
            shown["shown"] = stimulus_to_json(trial.stimuli[stimulus])
        self.book.log(events.Presented, trial, **shown)
        if self.display is not None:
            self.display.show(trial.stimuli[stimulus], self._tuning(trial), first=not stimulus)
        self._cue_ns = self._now_ns()
        self._play(self.protocol.sound.cue)
        self.book.log(events.Cue, trial)
        self._say(f"cue: {self.name(trial)}" + (", second" if stimulus else ""))

    def _tuning(self, trial: Trial) -> Tuning:
        return replace(trial.stimuli[self._stimulus].tuning, **self.progress.tuning)

    def _take(self, happened: Happened) -> None:
        kind, fields = happened
        trial = self.open_trial
        if kind is events.Device:
            self.book.log(events.Device, **fields)
            self._say(fields["what"])
        elif trial is not None:
            self.book.log(kind, trial, attempt=self._attempt, stimulus=self._stimulus, **fields)
            if kind is events.Fault:
                self._repeat_faulty(trial, fields["what"])

    def _watch(self, trial: Trial) -> None:
        """Look whether the second stimulus, or the warning, is due."""
        warning_s = self.protocol.trial.warning_s
        told = self.progress.told(trial)
        waited_s = (self._now_ns() - self._cue_ns) / 1e9 - told.paused_s
        if warning_s is not None and "warning" not in told.t_s and waited_s >= warning_s:
            self._play(self.protocol.sound.warning)
            self.book.log(events.Warning, trial)
            self._say(f"warning: {self.name(trial)}, {warning_s:g} s")
        display = self.display
        if display is None or not display.read:
            return
        if self.second_to_come:
            if display.ready:
                self._show(trial, self._stimulus + 1)
        elif not self.read_said and self._waits:
            self.read_said = True
            self._say("read: type the answer")

    def _repeat_faulty(self, trial: Trial, what: str) -> None:
        """Have the open trial shown again after a fault, if the protocol says so."""
        repeats = self.protocol.repeat_faults
        how = "is repeated" if repeats else "goes on"
        self._say(f"fault: {what}; {self.name(trial)} {how}")
        if repeats:
            self.again()

    def _start_again(self, fault: HostDiedError) -> None:
        """Start the engine again after it died; what was open cannot go on."""
        self._deaths += 1
        trial = self.open_trial
        if trial is None:
            self.book.log(events.Device, what=str(fault))
        else:
            self.book.log(events.Fault, trial, what=str(fault), attempt=self._attempt)
        if self._deaths >= MOST_DEATHS:
            raise fault
        self._say(f"fault: {fault}; it is started again")
        assert self.display is not None, "paper has no engine"
        self.book.log(events.Closed, **self.display.close_trace())
        self.display.engine.start()
        self.start(why="fault")
        if trial is not None:
            self.next(gap=False)
