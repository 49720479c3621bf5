"""The runner of a session: which step follows which, and which events are written.

A trial waits until the slider is at the left. Then the start signal sounds, the hand reads, an
answer is given, and the next trial gets ready. There are breaks, a warning and a time limit if the
protocol has them. A trial in which the device failed is shown again.

The runner knows presenters (`vbraille.sessions.running.presenters`), which put stimuli before the
participant and tell what became of them, and responses (`vbraille.sessions.running.responses`),
whose lines it hands to the console. What depends on the time since the start signal, such as the
warning, stands in `Runner._watch`; a stimulus that changes while it is felt is `Runner.retune`; and
a trial goes through as many stimuli as it has.
"""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass, replace
from enum import Enum, auto
from typing import TYPE_CHECKING, Any

from vbraille.braille.spelling import ordinal
from vbraille.devices.events import Knob
from vbraille.engine.host import HostDiedError
from vbraille.sessions.planning.pace import ENTER
from vbraille.sessions.planning.plan import stimulus_to_json
from vbraille.sessions.planning.stimuli import with_value
from vbraille.sessions.record import events
from vbraille.sessions.record.folder import versions
from vbraille.sessions.running.presenters import Paper, presentation_of
from vbraille.sessions.running.responses import KeyPress, Typed
from vbraille.signals import Suspension

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.sessions.planning.pace import Tone
    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.questionnaire import AnyItem
    from vbraille.sessions.planning.stimuli import Stimulus, Trial
    from vbraille.sessions.record.events import JournalEvent
    from vbraille.sessions.record.journal import Journal
    from vbraille.sessions.record.progress import Progress
    from vbraille.sessions.running.conventional import OnConventional
    from vbraille.sessions.running.presenters import Occurrence, OnDevice, Presentation, Presenter
    from vbraille.sessions.running.responses import Responses


class Phase(Enum):
    """Phase of a session, by what the session waits for."""

    BREAK = auto()  # a break, which Enter ends
    READY = auto()  # before a trial, until the slider is at the left; on paper, until Enter
    OPEN = auto()  # a trial, until its answer
    LAST = auto()  # all trials are done; Enter ends the session, an undo takes back an answer
    ASKING = auto()  # an answer to the questionnaire
    OVER = auto()  # the session waits for nothing any more


@dataclass(frozen=True, slots=True)
class PendingAnswer:
    """An answer whose confidence is waited for.

    Parameters
    ----------
    trial
        Trial that was answered.
    fields
        Fields of the journal's event.
    at_s
        Seconds of the session at the answer.
    """

    trial: Trial
    fields: dict[str, Any]
    at_s: float


@dataclass(frozen=True, slots=True)
class TimePoint:
    """A moment of a trial.

    Parameters
    ----------
    time_ns
        Time of it by the session's clock.
    paused_s
        Seconds that the trial had been paused by then.
    """

    time_ns: int
    paused_s: float


POLL_S = 0.02
MOST_DEATHS = 3  # number of deaths after which the host is not started again


def _unmarked(_event: JournalEvent, _ago_ns: int, _condition: str) -> None:
    """Send no marker."""


class Runner:
    """Runner of a session, which goes from trial to trial.

    Parameters
    ----------
    protocol, plan
        What the session shows, and in which order.
    journal
        Journal that every event is added to.
    progress
        State of the session, which every event updates.
    responses
        Source of lines: answers, and commands of the experimenter.
    device
        Presenter on the device; None on paper.
    conventional
        Presenter on a conventional display; None without one.
    say
        Function that is called with each sentence for the experimenter.
    play
        Function that plays a tone for the participant.
    real
        Whether the session runs by the clock of the machine; else by that of the device.

    Attributes
    ----------
    phase : Phase
        What the session waits for.
    paused : bool
        Whether the session is paused, so that the array rests.
    pending : PendingAnswer or None
        Answer whose confidence is waited for.
    end_key : str or None
        What the participant ends reading by, as the protocol has it, or Enter instead.
    key : Typed or None
        Source whose presses of a key end reading; None if none does.
    ended_by : str
        Key by which the participant has ended reading; empty before.
    stimulus : int
        Which stimulus of the open trial is shown, from 0.
    asking : tuple[AnyItem, int] or None
        Question of the questionnaire that is waited for, and the number of its trial or block.
    break_wanted : bool
        Whether the experimenter has asked for a break that has not begun.
    script_line : int
        Number of the line of an answers file that is being done; the next event keeps it.
    mark : Callable[[JournalEvent, int, str], None]
        Function that is given each event once it is in the journal, how many nanoseconds ago it
        happened, and the condition of its trial; it must not wait.
    """

    def __init__(
        self,
        protocol: Protocol,
        plan: Plan,
        journal: Journal,
        progress: Progress,
        responses: Responses,
        device: OnDevice | None,
        *,
        say: Callable[[str], None],
        play: Callable[[Tone], None],
        real: bool = True,
        conventional: OnConventional | None = None,
    ) -> None:
        self.protocol = protocol
        self.plan = plan
        self.progress = progress
        self.responses = responses
        self.device = device
        self.conventional = conventional
        self.phase = Phase.READY
        self.paused = False
        self.pending: PendingAnswer | None = None
        self.end_key = protocol.trial.end
        self.key: Typed | None = None
        self.ended_by = ""
        self.stimulus = 0
        self.asking: tuple[AnyItem, int] | None = None
        self._replied: list[tuple[AnyItem, int]] = []  # questions of this time, the last one last
        self.break_wanted = False
        self.script_line = 0
        self.mark: Callable[[JournalEvent, int, str], None] = _unmarked
        self._journal = journal
        self._paper = Paper()
        self._say = say
        self._play = play
        self._real = real
        self._attempt = 0
        self._ready_ns = 0
        self._cue = TimePoint(0, 0.0)
        self._exposed: TimePoint | None = None  # from when the stimulus's exposure counts
        self._asked: TimePoint | None = None  # from when the time for the answer counts
        self._told_late = False
        self._break_end_ns: int | None = None  # when the planned time of an open break is over
        self._turned: Stimulus | None = None  # what the participant has turned in the open trial
        self._deaths = 0
        self._why = ""  # what the experimenter was told that the trial waits for
        self._prompted = False  # whether the experimenter was asked for the answer
        self._monitor: dict[str, Any] = {}  # field that each run's event has again
        self._begin_clock()

    @property
    def trial(self) -> Trial | None:
        """Trial that is open or comes next; None after the last."""
        return self.progress.next_trial

    @property
    def open_trial(self) -> Trial | None:
        """Trial that is open; None if none is."""
        return self.trial if self.phase is Phase.OPEN else None

    @property
    def presenter(self) -> Presenter:
        """Presenter of the trial that is open or comes next."""
        trial = self.trial
        if self.conventional is not None and trial is not None and trial.stimuli[0].conventional:
            return self.conventional
        return self._paper if self.device is None else self.device

    @property
    def by_key(self) -> bool:
        """True if Enter times the trial that is open or comes next, since no device feels it."""
        return self.presenter.by_key

    @property
    def _referred(self) -> OnConventional | None:
        """Conventional display, if what the next trial is compared with stands on it."""
        return (
            self.conventional if self.protocol.conventional.reference and not self.by_key else None
        )

    @property
    def read(self) -> bool:
        """True if the open trial has been read to its end."""
        return self.open_trial is not None and not self.more_to_come and self.presenter.read

    @property
    def more_to_come(self) -> bool:
        """True if a stimulus of the open trial has not been shown yet."""
        trial = self.open_trial
        return trial is not None and self.stimulus + 1 < len(trial.stimuli)

    @property
    def reading(self) -> bool:
        """True if a stimulus is read, so that the participant's key may end it."""
        device = self.device
        if self.open_trial is None or device is None or device.ended or self.by_key:
            return False
        return not (self.paused or self.pending or self.ended_by)

    @property
    def late(self) -> bool:
        """True if the time for an answer to the open trial is over."""
        limit_s, trial = self.protocol.trial.answer_s, self.open_trial
        if limit_s is None or trial is None or self._asked is None:
            return False
        return self._since_s(self._asked, trial) > limit_s

    @property
    def prompt(self) -> str:
        """Words for an answer that the experimenter is to type."""
        usual = self.protocol.question is None and not self.protocol.passages
        return "the answer" if usual else self.protocol.asks.prompt()

    @property
    def elapsed_s(self) -> float:
        """Seconds that the session has run for, without the time between runs."""
        return self._begun_s + (self._now_ns() - self._begun_ns) / 1e9

    def name(self, trial: Trial) -> str:
        """Name of a trial in sentences for the experimenter."""
        if trial.practice:
            return f"practice {trial.number} of {len(self.plan.practice)}"
        return f"trial {self.progress.of_all(trial.number)}"

    def log(self, kind: type[JournalEvent], trial: Trial | None = None, **fields: Any) -> None:
        """Write an event; if its kind is durable, it is on the disk when this returns.

        Parameters
        ----------
        kind
            Kind of the event.
        trial
            Trial that the event happened in; None if it was in none.
        fields
            Fields of that kind. If ``time_ns`` is among them, the event happened at that time;
            else it happens now.
        """
        at_ns = fields.get("time_ns", self._now_ns())
        fields["t_s"] = round(self._begun_s + (at_ns - self._begun_ns) / 1e9, 6)
        if trial is not None:
            fields |= {"trial": trial.number, "practice": trial.practice}
        event = kind(script_line=self.script_line, **fields)
        self.script_line = 0
        written = self._journal.append(event)
        self.mark(written, self._now_ns() - at_ns, "" if trial is None else trial.condition)
        self.progress.take(written)

    def start(self, **fields: Any) -> None:
        """Begin a run, once the engine is started; ``fields`` are those of the event `Run`."""
        device = self.device
        before: list[Occurrence] = []  # of the time before the event of the run, which comes first
        self._monitor = {"monitor": fields["monitor"]} if "monitor" in fields else {}
        if device is not None:
            trace = device.open(len(self.progress.runs) + 1, self.progress.line)
            fields |= {
                "trace": trace,
                "device": asdict(device.engine.display),
                "calibration": device.engine.calibration,
            }
            while not device.now_ns:  # the session runs by the device's clock, which has to start
                before += device.poll()
                if self._real:
                    time.sleep(POLL_S)
        self._begin_clock()
        self.log(events.Run, **fields, versions=versions())
        for notice in before:
            self._take(notice)

    def run(
        self, take: Callable[[str, int], None], look: Callable[[], None] = lambda: None
    ) -> None:
        """Run the session from where it has come to, to its end or until it is stopped.

        Parameters
        ----------
        take
            Function that does what a line says, given its number in a file, or 0.
        look
            Function that is called each time that the session has gone on a little.

        Raises
        ------
        VbrailleError
            If the device or the disk fails and does not recover.
        """
        if self.progress.correcting is not None:
            self._say(f"undo: {self.name(self.progress.correcting)}; type its answer")
        self._watch_key()
        self.next()
        try:
            with Suspension() as suspension:
                while self.phase is not Phase.OVER:
                    if suspension.asked:
                        self._suspend(suspension, take)
                    if not self._take_lines(take):
                        self.leave()
                        break
                    look()
        finally:
            self.await_key(False)
        look()

    def _take_lines(self, take: Callable[[str, int], None]) -> bool:
        """Take the lines that have come, and what the presenters tell; False if no more come."""
        self.await_key(self.reading)
        lines = self.responses.lines(self._wait_s() if self._real else 0.0)
        if lines is None:
            return False
        if lines:
            self.look()  # what was felt before these lines counts first
        for line in lines:
            if self.phase is Phase.OVER:
                break
            if isinstance(line, KeyPress):
                self.end_reading(self.end_key or "")
            else:
                take(line, 0)
        self.poll()
        self._take_controls(take)
        if not self.responses.typed:
            self._ask(take)
        return True

    def _wait_s(self) -> float:
        """Seconds until the session looks at its presenters again, or the exposure is over."""
        limit_s, trial = self.protocol.trial.exposure_s, self.open_trial
        if limit_s is None or trial is None or self._exposed is None or self.paused:
            return POLL_S
        return min(max(limit_s - self._since_s(self._exposed, trial), 0.0), POLL_S)

    def _since_s(self, point: TimePoint, trial: Trial) -> float:
        """Seconds since a moment of a trial, pauses left out."""
        paused_s = self.progress.record_of(trial).paused_s - point.paused_s
        return (self._now_ns() - point.time_ns) / 1e9 - paused_s

    def _point(self, trial: Trial, time_ns: int) -> TimePoint:
        return TimePoint(time_ns, self.progress.record_of(trial).paused_s)

    def _ask(self, take: Callable[[str, int], None]) -> None:
        """Ask a source that does not type for a line, where a person would be waited for."""
        correcting = self.progress.correcting
        if self.by_key and not correcting and not self.read:
            self.press()  # answers that are not typed take no time to read paper
        last = self.phase is Phase.LAST
        if self.asking is not None and not correcting:
            given = self.responses.reply(self.asking[0], self.item_columns)
            self._take_given(given, take)
            return
        if not (correcting or self.pending or self.paused or self.read or last):
            return
        trial = correcting or self.trial or self.progress.last_answered
        if trial is None or self.phase is Phase.OVER:
            return
        felt = self.presenter.explorations if self.responses.felt else []
        given = self.responses.next(trial, self.progress.record_of(trial).attempts, felt)
        if given is None and last and not correcting:
            self.end("all trials are done")
        else:
            self._take_given(given, take)

    def _take_given(self, given: tuple[str, int] | None, take: Callable[[str, int], None]) -> None:
        """Do what a line says that a source was asked for; stop if there is none."""
        if given is not None:
            take(*given)
        else:
            self._say("answers: there are no more")
            self.leave()

    def _suspend(self, suspension: Suspension, take: Callable[[str, int], None]) -> None:
        """Pause and stop the process. Afterwards Enter ends the pause, if a person types."""
        paused = self.paused
        if not paused:
            take("pause", 0)
        if isinstance(self.responses, Typed):
            self.responses.release()
            suspension.stop()
            self.responses.take()
        else:
            suspension.stop()
        if not paused and not self.responses.typed:
            take("go", 0)

    def _watch_key(self) -> None:
        """Look out for the participant's key, or say that Enter is pressed instead."""
        key, name = self.protocol.trial.key, (self.end_key or "").removeprefix("key:")
        if self.end_key == ENTER or key is None or self.device is None:
            return
        if isinstance(self.responses, Typed) and self.responses.watch(key):
            self.key = self.responses
            self._say(f"key: {name} ends reading, with no Enter after it")
        elif self.responses.typed:
            self.end_key = ENTER
            self._say(
                f"key: standard input is no terminal, so that {name} cannot be told; Enter ends "
                f"reading"
            )

    def await_key(self, awaited: bool) -> None:
        """Have the participant's key told at once, or typed like all others."""
        if self.key is not None:
            self.key.await_key(awaited)

    def leave(self) -> None:
        """End or stop the session, since no more lines will come."""
        if self.phase is Phase.LAST and self.progress.correcting is None:
            self.end("all trials are done")
        else:
            self.stop()

    def stop(self) -> None:
        """Stop the session, so that it can be resumed later."""
        if (pending := self.pending) is not None:
            self.pending = None
            self._say(f"no confidence: {self.name(pending.trial)} is asked again")
        self.withdraw()
        self.log(events.Stop)
        done = self.progress.of_all(self.progress.done)
        self._say(f"stopped: {done} trials have answers; session resume goes on")
        self.phase = Phase.OVER

    def next(self, *, gap: bool = True) -> None:
        """Get the next trial ready, begin a break, or end the session."""
        self.pending = self.asking = None
        trial, limit_s = self.trial, self.protocol.session.limit_s
        over = limit_s is not None and self.progress.t_s >= limit_s
        asking = self.progress.due(self.protocol.questionnaire, over=over)
        if asking is not None:
            self.pose(*asking)
            return
        self._replied.clear()
        gap_s = self.protocol.trial.gap_s if gap else 0.0
        self._ready_ns = self._now_ns() + round(gap_s * 1e9)
        if trial is None:
            self._wait_for_end()
        elif over:
            self.end(f"the limit of {limit_s:g} s is over")
        elif self._break_due(trial):
            self._have_break()
        else:
            self._ready(trial)

    @property
    def item_columns(self) -> dict[str, str]:
        """Columns of the item of the trial that a question is asked beside; else empty."""
        asking, last = self.asking, self.progress.last_answered
        if asking is None or asking[0].when != "trial" or last is None:
            return {}
        return self.protocol.columns_of(last.item)

    def pose(self, item: AnyItem, number: int) -> None:
        """Ask a question of the questionnaire."""
        self.phase, self.asking = Phase.ASKING, (item, number)
        self._say(f"asked: {item.asked(self.item_columns)}")

    def reply(self, answer: str) -> None:
        """Take an answer to the questionnaire, and go on."""
        assert self.asking is not None, "nothing is asked"
        item, number = self.asking
        at = {"block": number} if item.when == "block" else {}
        last = self.progress.last_answered if item.when == "trial" else None
        self.log(events.Reply, last, name=item.name, answer=answer, **at)
        self._say(f"reply: {item.name} is in")
        self._replied.append(self.asking)
        self.paused = False
        self.next()

    def ask_before(self) -> bool:
        """Ask the question again that was answered before this one; False if there is none."""
        if self.asking is None or not self._replied:
            return False
        self.pose(*self._replied.pop())
        return True

    def end(self, why: str, reason: str = "") -> None:
        """End the session for good; a participant who stops may give a reason."""
        self.withdraw()
        self.log(events.End, why=why, reason=reason)
        self._say(f"end: {why}; {self.progress.of_all(self.progress.done)} have answers")
        for sentence in self.progress.found:
            self._say(sentence)
        self.phase = Phase.OVER

    def want_break(self) -> None:
        """Have a break now, or after the open trial."""
        self.break_wanted = True
        if self.phase is Phase.READY:
            self._have_break()
        else:
            self._say("break: after this trial")

    def again(self) -> None:
        """Show the open trial again, as a new attempt."""
        self.withdraw()
        self.next(gap=False)

    def withdraw(self) -> None:
        """Take the stimulus away, and make sure that the trace of it is on the disk."""
        for presenter in self._presenters():
            presenter.withdraw()

    def pause(self) -> None:
        """Bring the array to rest at once."""
        for presenter in reversed(self._presenters()):  # the device first
            presenter.rest()
        self.paused = True
        self.log(events.Pause, self.open_trial)

    def go_on(self) -> None:
        """Let the open trial be felt again after a pause, unless its reading was ended."""
        self.paused = False
        self.log(events.Go, self.open_trial)
        if self.open_trial is not None:
            self.presenter.go()
        self.await_key(self.reading)  # it may be pressed at the next sentence

    def press(self) -> None:
        """Take Enter off the device: reading begins by the first, and ends by the second."""
        trial, presenter = self.trial, self.presenter
        if trial is None:
            return
        if self.phase is Phase.READY:
            if self._why != presenter.why:
                self._why = presenter.why
                if self._why:
                    self._say(f"display: {self._why}; the trial waits")
            if not self._why:
                self._begin(trial)
        elif self.phase is not Phase.OPEN or presenter.read:
            return
        elif not presenter.taken:
            if self.responses.typed:
                self._say("too early: the display does not show it yet; read it, then Enter again")
        else:
            self.log(events.Read, trial, attempt=self._attempt, stimulus=0)
            told = self.progress.record_of(trial)
            seconds = told.t_s["read"] - told.t_s["cue"] - told.unread_s
            self._say(f"read: {seconds:.1f} s; type {self.prompt}")
            presenter.end_reading()

    def end_reading(self, by: str, **when: int) -> None:
        """End reading of the stimulus that is shown, by the participant's key or the exposure."""
        trial = self.open_trial
        if trial is None or not self.reading:
            return
        self.log(events.Ended, trial, attempt=self._attempt, stimulus=self.stimulus, by=by, **when)
        self.presenter.end_reading()
        self.await_key(self.reading)  # an answer may be typed as soon as it is asked for
        self._exposed = None
        key = by.replace(":", " ")
        if self.more_to_come:
            self._say(f"ended: the {ordinal(self.stimulus)}, by {key}")
            return
        if self.protocol.trial.exposure_s is not None:
            self._asked = self._point(trial, self._now_ns())
        self.ended_by, self._prompted = by, True
        told = self.progress.record_of(trial)
        seconds = told.t_s["ended"] - told.t_s["cue"] - told.paused_s
        self._say(f"ended: {seconds:.2f} s, by {key}; type {self.prompt}")

    def turn(self, steps: int) -> None:
        """Turn the value of the stimulus that is shown; by 0 steps the standard is shown again."""
        if not steps and (trial := self.open_trial) is not None:
            self._show(trial, 0)
        elif (value := self._value) is not None:
            self._turn_to(self.protocol.asks.turned(value, steps))

    @property
    def _value(self) -> float | None:
        """Value of the stimulus that can be turned now; None if none can be."""
        trial = self.open_trial
        if trial is None or self.more_to_come or self.pending is not None:
            return None
        return (self._turned or trial.stimuli[-1]).value

    def _turn_to(self, value: float) -> None:
        """Show the last stimulus of the open trial at another value."""
        trial, parameter, now = self.open_trial, self.protocol.parameter, self._value
        if trial is None or parameter is None or now is None:
            return
        if now == value:
            self._say(f"turned: {self.name(trial)}, no farther; it is at its end")
            return
        shown = replace(self._turned or trial.stimuli[-1], value=value)
        self._turned = with_value(shown, parameter, value)
        self._present(trial)
        self._say(f"turned: {self.name(trial)}")

    def _take_controls(self, take: Callable[[str, int], None]) -> None:
        """Take the device's buttons as lines, and its knobs as values, as the question has them."""
        question = self.protocol.asks
        for event in [] if self.device is None else self.device.take_controls():
            if not self.open_trial or self.paused or self.pending or self.more_to_come:
                continue  # nothing can be answered, or turned, yet
            if isinstance(event, Knob):
                if (value := question.by_knob(event.number, event.value)) is not None:
                    self._turn_to(value)
            elif line := question.by_button(event.number):
                take(f"answer {line}", 0)

    def retune(self, tuning: dict[str, float]) -> None:
        """Show the open trial and all later ones with another contrast or texture."""
        trial, device = self.open_trial, self.device
        if trial is None or device is None:
            self.log(events.Tuning, tuning=tuning)
        elif self.by_key:
            self.log(events.Tuning, trial, tuning=tuning)
        else:
            self.log(events.Tuning, trial, tuning=tuning, line=device.line + 1)
            device.change(self._presentation(trial))

    def look(self) -> bool:
        """Take what the presenters have to tell; False if the engine had to be started again.

        Raises
        ------
        VbrailleError
            If the device, or the disk, fails for good.
        """
        for presenter in self._presenters():
            try:
                notices = presenter.poll()
            except HostDiedError as fault:
                self._start_again(fault)
                return False
            for notice in notices:
                self._take(notice)
        return True

    def poll(self) -> None:
        """Take what the presenters have to tell, and do what is due.

        Raises
        ------
        VbrailleError
            If the device, or the disk, fails for good.
        """
        if not self.look():
            return
        trial, over_ns = self.trial, self._break_end_ns
        if self.phase is Phase.BREAK and over_ns is not None and self._now_ns() >= over_ns:
            self._break_end_ns = None
            self._say("break: its time is over; Enter goes on")
        if trial is None or self.paused:
            return
        if self.phase is Phase.OPEN:
            self._watch(trial)
        elif self.phase is Phase.READY and not self.by_key and self.presenter.ready:
            referred = self._referred
            due = self._now_ns() >= self._ready_ns and self.progress.correcting is None
            if due and (referred is None or referred.ready):
                self._begin(trial)

    def _presenters(self) -> list[OnConventional | OnDevice]:
        return [each for each in (self.conventional, self.device) if each is not None]

    def _now_ns(self) -> int:
        if self._real or self.device is None:
            return time.monotonic_ns()
        return self.device.now_ns

    def _begin_clock(self) -> None:
        """Begin a run: its time goes on from the total length of the runs before it."""
        self._begun_ns, self._begun_s = self._now_ns(), self.progress.t_s

    def _break_due(self, trial: Trial) -> bool:
        """True if there is a break before a trial that comes next."""
        done = self.progress.done
        if self.break_wanted:
            return True
        if trial.practice or done == self.progress.broken:
            return False
        every = self.protocol.session.break_every
        in_block = sum(past.trial.block == trial.block for past in self.progress.history)
        return not in_block or (every is not None and in_block % every == 0)

    def _have_break(self) -> None:
        """Begin a break before the next trial."""
        self.break_wanted = False
        self.log(events.Break)
        if self.responses.typed:
            self.phase = Phase.BREAK
            planned_s = self.protocol.session.break_s
            planned = "" if planned_s is None else f"{planned_s:g} s are planned, "
            self._break_end_ns = None
            if planned_s is not None:
                self._break_end_ns = self._now_ns() + round(planned_s * 1e9)
            self._say(f"break: {self.progress.done} trials are done; {planned}Enter goes on")
        elif self.trial is not None:
            self._ready(self.trial)

    def _ready(self, trial: Trial) -> None:
        self.phase = Phase.READY
        again = ", again" if self.progress.record_of(trial).attempts else ""
        where = ", on the conventional display" if self.presenter is self.conventional else ""
        how = "; Enter when reading begins" if self.by_key and self.responses.typed else ""
        self._say(f"ready: {self.name(trial)}{again}{where}{how}")

    def _wait_for_end(self) -> None:
        if self.responses.felt:  # a simulated reader takes back no answer
            self.end("all trials are done")
            return
        self.phase = Phase.LAST
        if self.responses.typed:
            self._say("last: all trials are done; Enter ends, undo takes back the last answer")

    def _begin(self, trial: Trial) -> None:
        """Begin the next trial."""
        self._attempt = self.progress.record_of(trial).attempts + 1
        self.phase = Phase.OPEN
        self._prompted, self.ended_by, self._told_late, self._turned = False, "", False, None
        self._show(trial, 0)

    def _show(self, trial: Trial, stimulus: int) -> None:
        self.stimulus = stimulus
        if (referred := self._referred) is not None and not stimulus:
            referred.show_reference()
        self._present(trial)
        self._cue = self._point(trial, self._now_ns())
        limits = self.protocol.trial
        exposed = limits.exposure_s is not None and limits.exposure_from == "cue"
        self._exposed = self._cue if exposed else None
        limited = limits.exposure_s is None and not self.more_to_come
        self._asked = self._cue if limited else None
        self._play(self.protocol.sound.cue)
        self.log(events.Cue, trial)
        self._say(f"cue: {self.name(trial)}" + (f", {ordinal(stimulus)}" if stimulus else ""))

    def _felt_now(self, trial: Trial) -> Stimulus:
        """Stimulus that is shown, as the participant has turned it."""
        if self._turned is not None and not self.more_to_come:
            return self._turned
        return trial.stimuli[self.stimulus]

    def _present(self, trial: Trial) -> None:
        """Put the stimulus before the participant; the journal has it before it is felt."""
        stimulus = self.stimulus
        shown: dict[str, Any] = {"attempt": self._attempt, "stimulus": stimulus}
        shown["shown"] = stimulus_to_json(self._felt_now(trial))
        if self.device is not None and not self.by_key:
            # The showing gets this number next: the journal has it before the stimulus is felt.
            shown["line"] = self.device.line + 1
        if self.progress.tuning:
            shown["tuning"] = self.progress.tuning
        self.log(events.Presented, trial, **shown)
        first = not stimulus and self._turned is None
        self.presenter.show(self._presentation(trial), first=first)

    def _presentation(self, trial: Trial) -> Presentation:
        stimulus = self._felt_now(trial)
        tuning = replace(stimulus.tuning, **self.progress.tuning)
        return presentation_of(self.protocol, stimulus, tuning)

    def _take(self, notice: Occurrence) -> None:
        kind, fields, said = notice
        trial = self.open_trial
        if kind is events.Fault and self.pending is not None:
            return  # an answer whose confidence is waited for needs no display
        if kind is events.Ended:
            self.end_reading(**fields)
        elif said:
            between = issubclass(kind, events.Device | events.DisplayBeside)
            self.log(kind, None if between else trial, **fields)
            self._say(said)
        elif trial is not None:
            self.log(kind, trial, attempt=self._attempt, stimulus=self.stimulus, **fields)
            if kind is events.Contact and self.protocol.trial.exposure_from == "contact":
                self._exposed = self._point(trial, fields["time_ns"])
            if kind is events.Fault:
                self._repeat_faulty(trial, fields["what"])

    def _watch(self, trial: Trial) -> None:
        """Do what is due by the time: a warning, an end of the exposure, the next stimulus."""
        if self.pending is not None:
            return
        limits, told = self.protocol.trial, self.progress.record_of(trial)
        warning_s, exposure_s = limits.warning_s, limits.exposure_s
        if (
            exposure_s is not None
            and self._exposed is not None
            and self._since_s(self._exposed, trial) >= exposure_s
        ):
            self.end_reading("exposure")
        if (
            warning_s is not None
            and "warning" not in told.t_s
            and self._since_s(self._cue, trial) >= warning_s
        ):
            self._play(self.protocol.sound.warning)
            self.log(events.Warning, trial)
            self._say(f"warning: {self.name(trial)}, {warning_s:g} s")
        if self.late and limits.late == "missed":
            self._miss(trial)
            return
        if self.late and not self._told_late:
            self._told_late = True
            self._say(f"late: {self.name(trial)}, after {limits.answer_s:g} s")
        if self.by_key or not self.presenter.read:
            return
        if self.more_to_come:
            if self.presenter.ready:
                self._show(trial, self.stimulus + 1)
        elif not self._prompted and self.responses.typed:
            self._prompted = True
            self._say(f"read: type {self.prompt}")

    def _miss(self, trial: Trial) -> None:
        """End the open trial without an answer."""
        self.withdraw()
        self.log(events.Missed, trial, attempt=self._attempt)
        self._say(f"missed: {self.name(trial)}, no answer in time")
        self.next()

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
        trial = None if self.pending is not None else self.open_trial
        if trial is None:
            self.log(events.Device, what=str(fault))
        else:
            self.log(events.Fault, trial, what=str(fault), attempt=self._attempt)
        if self._deaths >= MOST_DEATHS:
            raise fault
        self._say(f"fault: {fault}; it is started again")
        assert self.device is not None, "paper has no engine"
        self.log(events.Closed, **self.device.close_trace())
        self.device.engine.start()
        self.start(why="fault", **self._monitor)
        if trial is not None:
            self.next(gap=False)
