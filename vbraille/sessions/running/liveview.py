"""The live view of a session: what its pages are told, which may have to be blind.

The session tells it, and never waits for it. A blind state is made of nothing from which a stimulus
or an answer could be read: neither cells nor condition nor distances of a stimulus, no answers, no
sentence that may hold one of these, and not the participant, whose number chooses the order of the
conditions. `docs/session-format.md` has the list.
"""

from __future__ import annotations

import logging
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Final

from msgspec import structs

from vbraille.braille.spelling import ordinal, say_cells, to_braille
from vbraille.config.settings import say_mapping
from vbraille.devices.base import Placing
from vbraille.engine.engine import placing_of
from vbraille.engine.host import Host
from vbraille.engine.record import Flag
from vbraille.live.messages import ViewState
from vbraille.live.states import array_shown, cells_shown, geometry_shown, rows_shown
from vbraille.sessions.planning.stimuli import Stimulus, Trial, said_value
from vbraille.sessions.record.events import LiveView
from vbraille.sessions.running.runner import Phase, Runner

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np

    from vbraille.engine.record import RingReader
    from vbraille.live.messages import LineShown
    from vbraille.live.monitor import Monitor
    from vbraille.sessions.planning.protocol import Protocol


# Sentences begin with a word for their kind. Those of these kinds hold no stimulus and no answer.
_SAFE: Final = frozenset(
    {
        "begin",
        "break",
        "cue",
        "device",
        "display",
        "end",
        "fault",
        "go",
        "hand",
        "last",
        "late",
        "missed",
        "pause",
        "place",
        "read",
        "ready",
        "refused",
        "repeat",
        "resume",
        "stopped",
        "timing",
        "undo",
        "warning",
    }
)
# The live view's address holds its token, and the others tell who takes part, or the seed.
_NEVER: Final = frozenset({"live view", "record", "seed", "session"})
_MOST_SAID: Final = 20
_SECONDS_PER_MINUTE: Final = 60
_PLACES: Final = {
    Placing.MARK: "place: the carriage has to pass its mark",
    Placing.STOP: "place: the carriage has to be shown its place",
}


@dataclass(slots=True)
class SafeSentences:
    """The sentences for the experimenter that a page may be told.

    Parameters
    ----------
    blind
        Whether only sentences of kinds that hold no stimulus and no answer are kept.
    last
        The last of those sentences, oldest first.
    before
        Number of such sentences before these.
    """

    blind: bool
    last: list[str] = field(default_factory=list)
    before: int = 0

    def hear(self, sentence: str) -> None:
        """Keep a sentence if a page may be told it."""
        kind = sentence.partition(":")[0]
        if kind in _NEVER or (self.blind and kind not in _SAFE):
            return
        self.last.append(sentence)
        if len(self.last) > _MOST_SAID:
            self.last.pop(0)
            self.before += 1


def state_of(runner: Runner, heard: SafeSentences, *, simulated: bool = False) -> ViewState:
    """Make the state of a session that its pages show.

    Parameters
    ----------
    runner
        Runner of the session, which has a device.
    heard
        Sentences that pages may be told, and whether the session is blind.
    simulated
        Whether a page may be the hand.

    Returns
    -------
    ViewState
        ViewState without a number, which its sender gives.
    """
    assert runner.device is not None, "paper cannot be watched"
    engine, protocol = runner.device.engine, runner.protocol
    state = ViewState(
        number=0,
        title=protocol.title,
        array=array_shown(engine.display),
        geometry=geometry_shown(protocol.geometry),
        rows_shown=rows_shown(protocol.style, engine.display),
        place=_place(runner),
        mapping=say_mapping(protocol.mapping),
        paused=runner.paused,
        simulated=simulated,
        held=runner.progress.pointed,
        device=_device(runner.device.newest),
        said=list(heard.last),
        said_before=heard.before,
        facts=_facts(runner),
        blind=heard.blind,
        done=runner.phase is Phase.OVER,
    )
    return state if heard.blind else _unhidden(state, runner)


def _unhidden(state: ViewState, runner: Runner) -> ViewState:
    """ViewState with all that a blind one keeps back."""
    facts, trial = [*state.facts], runner.trial
    answered = runner.progress.last_answered
    if answered is not None and (answer := runner.progress.record_of(answered).answer) is not None:
        of, knob = runner.protocol, runner.protocol.parameter
        facts.append(("last answer", of.asks.verdict(answered, answer, of.keys, knob)))
    if trial is None:
        return structs.replace(state, facts=facts)
    facts.append(("condition", trial.condition))
    if runner.phase is not Phase.OPEN or runner.by_key:
        return structs.replace(state, facts=facts)
    stimulus = trial.stimuli[runner.stimulus]
    tuning = asdict(stimulus.tuning) | runner.progress.tuning
    facts += [
        ("contrast", f"{tuning['contrast']:g}"),
        ("texture", f"{tuning['texture']:g}"),
        ("asked for", _asked(runner.protocol, trial, stimulus)),
    ]
    geometry = geometry_shown(stimulus.geometry)
    style = replace(runner.protocol.style, mapping=runner.protocol.mapping_of(stimulus))
    assert runner.device is not None, "paper cannot be watched"
    return structs.replace(
        state,
        facts=facts,
        geometry=geometry,
        mapping=say_mapping(style.mapping),
        rows_shown=rows_shown(style, runner.device.engine.display),
        lines=[] if stimulus.picture is not None else [_line(runner, stimulus)],
    )


def _line(runner: Runner, stimulus: Stimulus) -> LineShown:
    """Line on which a stimulus is shown."""
    assert runner.device is not None
    cells = runner.protocol.line(stimulus.masks)
    return cells_shown(runner.device.line, cells, stimulus.text or "", under=True)


def _asked(protocol: Protocol, trial: Trial, stimulus: Stimulus) -> str:
    """Words for what the participant is to say about a stimulus."""
    if stimulus.picture is not None:
        return trial.presented
    if stimulus.value is not None:
        return said_value(stimulus.value, protocol.parameter)
    return say_cells(to_braille(stimulus.masks[slice(*trial.asked)]), protocol.keys)


def _facts(runner: Runner) -> list[tuple[str, str]]:
    """Facts on the progress of the session; nothing here depends on stimuli or answers."""
    protocol, progress, trial = runner.protocol, runner.progress, runner.trial
    facts: list[tuple[str, str]] = []
    if trial is not None:
        practice, number = trial.practice, trial.number
        told = f"{number} of {len(runner.plan.practice)}" if practice else progress.of_all(number)
        facts.append(("practice" if practice else "trial", told))
        blocks = max((one.block for one in runner.plan.trials), default=0)
        if not practice and blocks > 1:
            facts.append(("block", f"{trial.block} of {blocks}"))
        if (number := len(trial.stimuli)) > 1 and runner.phase is Phase.OPEN:
            facts.append(("stimulus", f"{ordinal(runner.stimulus)} of {number}"))
        if (attempt := progress.record_of(trial).attempts) > 1:
            facts.append(("attempt", f"{attempt}"))
    facts.append(("answered", progress.of_all(progress.done)))
    if protocol.session.break_every is not None:
        facts.append(("since the last break", f"{progress.done - progress.broken} trials"))
    facts.append(("time", _time(runner.elapsed_s)))
    if protocol.session.limit_s is not None:
        facts.append(("limit", _time(protocol.session.limit_s)))
    return facts


def _time(seconds: float) -> str:
    minutes, rest = divmod(int(seconds), _SECONDS_PER_MINUTE)
    return f"{minutes} min {rest:02} s"


def _place(runner: Runner) -> str:
    """Sentence that says what the session waits for."""
    if runner.phase is Phase.OVER:
        return "the session is over"
    correcting = runner.progress.correcting
    if correcting is not None:
        return f"{runner.name(correcting)}: its answer was taken back, and is typed anew"
    if runner.phase is Phase.LAST:
        return "all trials are done; Enter at the console ends the session"
    if runner.phase is Phase.BREAK:
        return "a break; Enter at the console ends it"
    assert runner.trial is not None
    name = runner.name(runner.trial)
    if runner.paused:
        return f"{name}: a pause; Enter at the console ends it"
    if runner.phase is Phase.READY:
        pictures = runner.protocol.pictures
        where = "the device works" if pictures else "the array is at the left stop"
        return f"{name}: waits until {where}"
    if runner.read:
        return f"{name}: was read; waits for the answer"
    return f"{name}: is read"


def _device(newest: np.void | None) -> str:
    """Sentence on the state of the device, by the newest tick."""
    if newest is None:
        return "device: starts"
    flags = int(newest["flags"])
    if flags & int(Flag.SILENT):
        return "device: silent"
    placing = placing_of(newest)
    if placing is not Placing.DONE:
        return _PLACES[placing]
    if flags & int(Flag.HELD):
        return "device: at rest by itself"
    return "device: turned too far" if flags & int(Flag.TURNED) else "device: in use"


LOOPBACK: Final = "127.0.0.1"
ENDED: Final = "live view: ended by a fault; the session goes on"
_NO_KNOBS: Final = (
    "refused: in a session nothing is turned or pressed here; the experimenter types at the console"
)
_log = logging.getLogger(__name__)


class SessionView:
    """Pages that watch a session; whatever goes wrong with them, the session goes on.

    Parameters
    ----------
    monitor
        The parent's end of the live view.
    blind
        Whether pages are shown nothing from which a stimulus or an answer could be read.
    host
        Address at which the pages are served.
    simulated
        Whether a page may be the hand of a simulated device.
    """

    def __init__(
        self,
        monitor: Monitor,
        *,
        blind: bool,
        host: str,
        simulated: bool,
    ) -> None:
        self._monitor: Monitor | None = monitor
        self._simulated = simulated
        self._host = host
        self._say: Callable[[str], None] = _ignore
        self._heard = SafeSentences(blind=blind)
        self._newest: ViewState | None = None
        self._number = 0

    def begin(self, engine: object) -> None:
        """Start the live view, and have it see the memory of an engine that is not launched yet."""
        self._try("did not start", lambda monitor: monitor.launch())
        if isinstance(engine, Host):
            engine.on_share = self._share

    def _share(self, ticks: RingReader) -> None:
        self._try("was not given the memory", lambda monitor: monitor.share(ticks))

    def relay(self, say: Callable[[str], None]) -> Callable[[str], None]:
        """Give the function that says a sentence to the experimenter by ``say``, and to the pages.

        The pages are told it as far as they may hear it. What the live view itself has to say goes
        to the experimenter alone.
        """
        self._say = say

        def tell(sentence: str) -> None:
            say(sentence)
            self._heard.hear(sentence)

        return tell

    def described(self) -> LiveView:
        """Describe the live view of a run for the journal."""
        return LiveView(self._heard.blind, self._host, self._simulated)

    def look(self, runner: Runner) -> None:
        """Tell the pages what has changed, and refuse what they ask for."""
        self._try("has failed", lambda monitor: self._look(monitor, runner))

    def close(self) -> None:
        """End the live view."""
        monitor, self._monitor = self._monitor, None
        if monitor is not None:
            _close(monitor)

    def _try(self, fails: str, act: Callable[[Monitor], object]) -> None:
        """Do something with the live view, if there is one; it is ended if that fails."""
        monitor = self._monitor
        if monitor is None:
            return
        try:
            act(monitor)
        except Exception as fault:
            _log.info("the live view %s: %r", fails, fault)
            self._end(monitor)

    def _look(self, monitor: Monitor, runner: Runner) -> None:
        for note in monitor.notes():
            self._say(note)
        if monitor.take() and _NO_KNOBS not in self._heard.last[-1:]:
            self._heard.hear(_NO_KNOBS)
        state = state_of(runner, self._heard, simulated=self._simulated)
        if state != self._newest:
            self._newest, self._number = state, self._number + 1
            monitor.tell(structs.replace(state, number=self._number))

    def _end(self, monitor: Monitor) -> None:
        self._monitor = None
        _close(monitor)
        self._say(ENDED)


def _ignore(_sentence: str) -> None:
    """Ignore a sentence, before it is known who hears them."""


def _close(monitor: Monitor) -> None:
    try:
        monitor.close()
    except Exception as fault:
        _log.info("the live view did not close: %r", fault)
