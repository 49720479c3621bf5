"""The course of a session: which step follows which, and which events are written.

A trial waits until the slider is at the left. Then the start signal sounds, the hand reads, an
answer is given, and the next trial gets ready. There are breaks, a warning and a time limit if the
protocol has them. A trial in which the device failed is shown again.
"""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass, replace
from enum import Enum, auto
from typing import TYPE_CHECKING, Any

from vbraille.engine.host import HostDiedError
from vbraille.sessions.planning.plan import Plan, stimulus_to_json
from vbraille.sessions.record import events
from vbraille.sessions.record.folder import versions
from vbraille.sessions.running.logbook import Happened, Logbook

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.render.braille.profiles import Tuning
    from vbraille.sessions.planning.conduct import Tone
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.journal import Journal
    from vbraille.sessions.record.progress import Progress
    from vbraille.sessions.running.conventional import OnConventional
    from vbraille.sessions.running.showing import OnDevice


class Phase(Enum):
    """Phase of a session, by what the session waits for."""

    BREAK = auto()  # a break, which Enter ends
    READY = auto()  # before a trial, until the slider is at the left; on paper, until Enter
    OPEN = auto()  # a trial, until its answer
    LAST = auto()  # all trials are done; Enter ends the session, an undo takes back an answer
    OVER = auto()  # the session waits for nothing any more


@dataclass(frozen=True, slots=True)
class HalfAnswer:
    """An answer whose confidence is waited for.

    Parameters
    ----------
    trial
        Trial that was answered.
    told
        Fields of the journal's event.
    at_s
        Seconds of the session at the answer.
    """

    trial: Trial
    told: dict[str, Any]
    at_s: float


POLL_S = 0.02
MOST_DEATHS = 3  # number of deaths after which the host is not started again


class Course:
    """Course of a session, which goes from trial to trial.

    Parameters
    ----------
    protocol, plan
        What the session shows, and in which order.
    journal
        Journal that every event is added to.
    progress
        State of the session, which every event updates.
    display
        Display of the stimuli; None on paper.
    waits
        Whether breaks wait for a person.
    corrects
        Whether the answer to the last trial may be taken back.
    say
        Function that is called with each sentence for the experimenter.
    play
        Function that plays a tone for the participant.
    real
        Whether the session runs by the clock of the machine; else by that of the display.
    beside
        Conventional display of the session; None without one.

    Attributes
    ----------
    book : Logbook
        Logbook that writes the events of the session.
    phase : Phase
        What the session waits for.
    paused : bool
        Whether the session is paused, so that the array rests.
    read_said : bool
        Whether the experimenter has been told that the trial is read; on paper, whether a key has
        said so.
    half : HalfAnswer or None
        Answer whose confidence is waited for.
    ended_by : str
        Key by which the participant has ended reading; empty before.
    stimulus : int
        Which stimulus of the open trial is shown: 0, or 1 for the second of two.
    break_wanted : bool
        Whether the experimenter has asked for a break that has not begun.
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
        beside: OnConventional | None = None,
    ) -> None:
        self.protocol = protocol
        self.plan = plan
        self.progress = progress
        self.display = display
        self.beside = beside
        self.phase = Phase.READY
        self.paused = False
        self.read_said = False
        self.half: HalfAnswer | None = None
        self.ended_by = ""
        self.stimulus = 0
        self.break_wanted = False
        self._waits = waits
        self._corrects = corrects
        self._say = say
        self._play = play
        self._real = real
        self.book = Logbook(journal, progress, self._now_ns)
        self._attempt = 0
        self._ready_ns = 0
        self._cue_ns = 0
        self._deaths = 0
        self._told_why = ""  # what the experimenter was told that the trial waits for
        self._watched: dict[str, Any] = {}  # fields that each run's event has again

    @property
    def trial(self) -> Trial | None:
        """Trial that is open or comes next; None after the last."""
        return self.progress.next_trial

    @property
    def open_trial(self) -> Trial | None:
        """Trial that is open; None if none is."""
        return self.trial if self.phase is Phase.OPEN else None

    @property
    def by_key(self) -> bool:
        """Whether Enter times the trial that is open or comes next, since no device feels it.

        It is read on paper, or on the conventional display.
        """
        return self.display is None or self._stands is not None

    @property
    def _stands(self) -> OnConventional | None:
        """Conventional display, if the trial that is open or comes next stands on it."""
        trial = self.trial
        return self.beside if trial is not None and trial.stimuli[0].conventional else None

    @property
    def _referred(self) -> OnConventional | None:
        """Conventional display, if what the next trial is compared with stands on it."""
        return self.beside if self.protocol.conventional.reference and not self.by_key else None

    @property
    def read(self) -> bool:
        """Whether the open trial has been read to its end."""
        if self.open_trial is None or self.second_to_come:
            return False
        return self.read_said if self.display is None or self.by_key else self.display.read

    @property
    def reached(self) -> bool:
        """Whether the hand has been at the end of the open trial; on paper, whether it is read."""
        return self.read_said if self.display is None or self.by_key else self.display.reached

    @property
    def second_to_come(self) -> bool:
        """Whether a stimulus of the open trial has not been shown yet."""
        trial = self.open_trial
        return trial is not None and self.stimulus + 1 < len(trial.stimuli)

    def name(self, trial: Trial) -> str:
        """Name of a trial in sentences for the experimenter."""
        if trial.practice:
            return f"practice {trial.number} of {len(self.plan.practice)}"
        return f"trial {self.progress.of_all(trial.number)}"

    @property
    def reading(self) -> bool:
        """Whether a stimulus is read, so that the participant's key may end it."""
        display = self.display
        if self.open_trial is None or display is None or display.ended or self.by_key:
            return False
        return not (self.paused or self.half or self.ended_by)

    @property
    def over(self) -> bool:
        """Whether the session has lasted as long as the protocol allows."""
        limit_s = self.protocol.session.limit_s
        return limit_s is not None and self.progress.t_s >= limit_s

    def break_due(self, trial: Trial) -> bool:
        """Whether there is a break before a trial that comes next."""
        done = self.progress.done
        if self.break_wanted:
            return True
        if trial.practice or done == self.progress.broken:
            return False
        every = self.protocol.session.break_every
        in_block = sum(past.trial.block == trial.block for past in self.progress.history)
        return not in_block or (every is not None and in_block % every == 0)

    def warning_due(self, trial: Trial, since_cue_s: float) -> bool:
        """Whether the warning is due so long after the start signal, pauses included."""
        warning_s = self.protocol.trial.warning_s
        told = self.progress.told(trial)
        if warning_s is None or "warning" in told.t_s:
            return False
        return since_cue_s - told.paused_s >= warning_s

    def tuning_of(self, trial: Trial) -> Tuning:
        """Tuning of the stimulus that is shown, with what the experimenter has set instead."""
        return replace(trial.stimuli[self.stimulus].tuning, **self.progress.tuning)

    @property
    def prompt(self) -> str:
        """What the experimenter is to type as an answer."""
        return "the answer" if self.protocol.question is None else self.protocol.question.prompt()

    def told_ready(self, trial: Trial, *, waits: bool) -> str:
        """Sentence that says that a trial is ready, to somebody who presses keys if it waits."""
        again = ", again" if self.progress.told(trial).attempts else ""
        how = "; Enter when reading begins" if self.by_key and waits else ""
        if self._stands is not None:
            how = f", on the conventional display{how}"
        return f"ready: {self.name(trial)}{again}{how}"

    def told_read(self, trial: Trial) -> str:
        """Sentence that says how long a trial was read off the device, and what to type."""
        told = self.progress.told(trial)
        seconds = told.t_s["read"] - told.t_s["cue"] - told.unread_s
        return f"read: {seconds:.1f} s; type {self.prompt}"

    def told_ended(self, trial: Trial, key: str) -> str:
        """Sentence that says when the participant's key ended a trial, and what to type."""
        told = self.progress.told(trial)
        seconds = told.t_s["ended"] - told.t_s["cue"] - told.paused_s
        return f"ended: {seconds:.2f} s, by {key}; type {self.prompt}"

    def start(self, **started: Any) -> None:
        """Begin a run, once the engine is started; `started` are fields for the event `Run`."""
        display = self.display
        happened: list[Happened] = []  # before the event of the run, which comes first
        self._watched = {"monitor": started["monitor"]} if "monitor" in started else {}
        if display is not None:
            trace = display.open(len(self.progress.runs) + 1, self.progress.line)
            started |= {
                "trace": trace,
                "device": asdict(display.engine.display),
                "calibration": display.engine.calibration,
            }
            while not display.now_ns:  # the session runs by the device's clock, which has to start
                happened += display.poll()
                self.sleep()
        self.book.begin()
        self.book.log(events.Run, **started, versions=versions())
        for each in happened:
            self._take(each)

    def sleep(self) -> None:
        """Wait a little for the device, if the session runs in real time."""
        if self._real:
            time.sleep(POLL_S)

    def next(self, *, gap: bool = True) -> None:
        """Get the next trial ready, begin a break, or end the session."""
        self.half = None
        trial = self.trial
        gap_s = self.protocol.trial.gap_s if gap else 0.0
        self._ready_ns = self._now_ns() + round(gap_s * 1e9)
        if trial is None:
            self._wait_for_end()
        elif self.over:
            self.end(f"the limit of {self.protocol.session.limit_s:g} s is over")
        elif self.break_due(trial):
            self.have_break()
        else:
            self._ready(trial)

    def end(self, why: str) -> None:
        """End the session for good."""
        self.book.log(events.End, why=why)
        self._say(f"end: {why}; {self.progress.of_all(self.progress.done)} have answers")
        for sentence in self.progress.found:
            self._say(sentence)
        self.phase = Phase.OVER

    def have_break(self) -> None:
        """Begin a break before the next trial."""
        self.break_wanted = False
        self.book.log(events.Break)
        if self._waits:
            self.phase = Phase.BREAK
            self._say(f"break: {self.progress.done} trials are done; Enter goes on")
        elif self.trial is not None:
            self._ready(self.trial)

    def want_break(self) -> None:
        """Have a break now, or after the open trial."""
        self.break_wanted = True
        if self.phase is Phase.READY:
            self.have_break()
        else:
            self._say("break: after this trial")

    def begin(self) -> None:
        """Begin the next trial."""
        trial = self.trial
        assert trial is not None, "there is no trial to begin"
        self._attempt = self.progress.told(trial).attempts + 1
        self.phase = Phase.OPEN
        self.read_said, self.ended_by = False, ""
        self._show(trial, 0)

    def again(self) -> None:
        """Show the open trial again, as a new attempt."""
        self.withdraw()
        self.next(gap=False)

    def withdraw(self) -> None:
        """Take the stimulus away, and make sure that the trace of it is on the disk."""
        if self.beside is not None:
            self.beside.withdraw()
        if self.display is not None:
            self.display.withdraw()
            self.display.sync()

    def rest(self) -> None:
        """Have nothing be felt for a while."""
        if self.display is not None:
            self.display.rest()
        if self.beside is not None:
            self.beside.clear()

    def go(self) -> None:
        """Let the open trial be felt again after a rest, unless its reading was ended."""
        trial = self.open_trial
        if trial is None:
            return
        if (stands := self._stands) is not None:
            if not self.read_said:
                stands.show(trial.stimuli[0])
        elif self.display is not None:
            self.display.go()

    def press(self) -> None:
        """Take a key on paper: the first says that reading begins, the second that it is over."""
        trial, stands = self.trial, self._stands
        if trial is None:
            return
        if self.phase is Phase.READY:
            if stands is not None and not stands.ready:
                if self._told_why != stands.why:
                    self._told_why = stands.why
                    self._say(f"display: {stands.why}; the trial waits")
                return
            self._told_why = ""
            self.begin()
        elif self.phase is Phase.OPEN and not self.read_said:
            if stands is not None and not stands.taken:
                return  # it does not stand on the display yet
            self.read_said = True
            self.book.log(events.Read, trial, attempt=self._attempt, stimulus=0)
            self._say(self.told_read(trial))
            if stands is not None:
                stands.clear()

    def end_reading(self, by: str, **when: int) -> None:
        """Take the participant's key, which ends reading of the stimulus that is shown."""
        trial, display = self.open_trial, self.display
        if trial is None or display is None or not self.reading:
            return
        self.book.log(
            events.Ended, trial, attempt=self._attempt, stimulus=self.stimulus, by=by, **when
        )
        display.end_reading()
        key = by.replace(":", " ")
        if self.second_to_come:
            self._say(f"ended: the first, by {key}")
            return
        self.ended_by, self.read_said = by, True
        self._say(self.told_ended(trial, key))

    def retune(self, tuning: dict[str, float]) -> None:
        """Show the open trial and all later ones with another contrast or texture."""
        trial = self.open_trial
        if trial is None or self.display is None:
            self.book.log(events.Tuning, tuning=tuning)
            return
        if self.by_key:
            self.book.log(events.Tuning, trial, tuning=tuning)
            return
        self.book.log(events.Tuning, trial, tuning=tuning, line=self.display.line + 1)
        self.display.retune(self.tuning_of(trial))

    def look(self) -> bool:
        """Take what the display has to tell; False if its engine had to be started again.

        Raises
        ------
        VbrailleError
            If the device, or the disk, fails for good.
        """
        if self.beside is not None:
            for each in self.beside.poll():
                self._take(each)
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
        """Take what the display has to tell, and do what is due.

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
            referred = self._referred
            if not self.by_key and (referred is None or referred.ready):
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
        self._say(self.told_ready(trial, waits=self._waits))

    def _wait_for_end(self) -> None:
        if not self._corrects:
            self.end("all trials are done")
            return
        self.phase = Phase.LAST
        if self._waits:
            self._say("last: all trials are done; Enter ends, undo takes back the last answer")

    def _show(self, trial: Trial, stimulus: int) -> None:
        self.stimulus = stimulus
        shown: dict[str, Any] = {"attempt": self._attempt, "stimulus": stimulus}
        shown["shown"] = stimulus_to_json(trial.stimuli[stimulus])
        if self.display is not None and not self.by_key:
            # The showing gets this number next: the journal has it before the stimulus is felt.
            shown["line"] = self.display.line + 1
        if self.progress.tuning:
            shown["tuning"] = self.progress.tuning
        self.book.log(events.Presented, trial, **shown)
        if (stands := self._stands) is not None:
            stands.show(trial.stimuli[stimulus])
        elif self.display is not None:
            if (referred := self._referred) is not None and not stimulus:
                referred.show_reference()
            self.display.show(trial.stimuli[stimulus], self.tuning_of(trial), first=not stimulus)
        self._cue_ns = self._now_ns()
        self._play(self.protocol.sound.cue)
        self.book.log(events.Cue, trial)
        self._say(f"cue: {self.name(trial)}" + (", second" if stimulus else ""))

    def _take(self, happened: Happened) -> None:
        kind, fields, said = happened
        trial = self.open_trial
        if kind is events.Fault and self.half is not None:
            return  # an answer whose confidence is waited for needs no display
        if kind is events.Ended:
            self.end_reading(**fields)
        elif said:
            between = issubclass(kind, events.Device | events.DisplayBeside)
            self.book.log(kind, None if between else trial, **fields)
            self._say(said)
        elif trial is not None:
            self.book.log(kind, trial, attempt=self._attempt, stimulus=self.stimulus, **fields)
            if kind is events.Fault:
                self._repeat_faulty(trial, fields["what"])

    def _watch(self, trial: Trial) -> None:
        """Give the warning, or show the second stimulus, if either is due."""
        if self.half is not None:
            return
        if self.warning_due(trial, (self._now_ns() - self._cue_ns) / 1e9):
            self._play(self.protocol.sound.warning)
            self.book.log(events.Warning, trial)
            self._say(f"warning: {self.name(trial)}, {self.protocol.trial.warning_s:g} s")
        display = self.display
        if display is None or self.by_key or not display.read:
            return
        if self.second_to_come:
            if display.ready:
                self._show(trial, self.stimulus + 1)
        elif not self.read_said and self._waits:
            self.read_said = True
            self._say(f"read: type {self.prompt}")

    def _repeat_faulty(self, trial: Trial, what: str) -> None:
        """Show the open trial again after a fault, if the protocol says so."""
        repeats = self.protocol.faults.repeat
        how = "is repeated" if repeats else "goes on"
        self._say(f"fault: {what}; {self.name(trial)} {how}")
        if repeats:
            self.again()

    def _start_again(self, fault: HostDiedError) -> None:
        """Start the engine again after it died; an open trial gets a new attempt."""
        self._deaths += 1
        # An answer whose confidence is waited for needs no device: its trial is not shown again.
        trial = None if self.half is not None else self.open_trial
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
        self.start(why="fault", **self._watched)
        if trial is not None:
            self.next(gap=False)
