"""The live view of a session: what its pages are told, which may have to be blind.

A blind state is made of nothing from which a stimulus or an answer could be read: neither cells nor
condition nor distances, no answers, no sentence that may hold one of these, and not the
participant, whose number chooses the order of the conditions.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable
from typing import Any, Self

from msgspec import structs

from vbraille.braille.spelling import ordinal, say_cells
from vbraille.display import Display
from vbraille.engine.engine import WHY
from vbraille.engine.record import RingReader
from vbraille.errors import InputError
from vbraille.live.messages import LetGo, Point, ViewState
from vbraille.live.states import array_shown, cells_shown, geometry_shown, rows_shown
from vbraille.live.view import LiveView
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.trial import Stimulus
from vbraille.sessions.running.device import SessionDevice
from vbraille.simulation import steering
from vbraille.wording import setting

MOST_SAID = 20
_log = logging.getLogger(__name__)


class SessionView:
    """Pages that watch a session; whatever goes wrong with them, the session goes on.

    Parameters
    ----------
    protocol
        Protocol of the session, which may have to be blind.
    host, port
        Where the pages are served.
    fast
        Whether the session runs as fast as the machine can.
    say
        Function that is called with each sentence for the experimenter.

    Raises
    ------
    InputError
        If there is no device whose ticks could be shown.
    """

    def __init__(
        self,
        protocol: Protocol,
        host: str | None,
        port: int | None,
        *,
        fast: bool,
        say: Callable[[str], None],
    ) -> None:
        if protocol.medium != "device" or fast:
            raise InputError(
                f"{setting('monitor')} shows a device in real time; {protocol.name} is on paper, "
                f"or {setting('fast')} is given; leave one of them out"
            )
        self.blind = protocol.session.blind
        self.described = {"blind": self.blind, "host": host or "127.0.0.1"}
        self._view: LiveView | None = LiveView(host=host, port=port, blind=self.blind)
        self._say = say
        self._said: deque[str] = deque(maxlen=MOST_SAID)
        self._count = 0

    def __enter__(self) -> Self:
        assert self._view is not None
        self._view.__enter__()
        for sentence in self._view.addresses:
            self._say(sentence)
        return self

    def __exit__(self, *exception: object) -> None:
        view, self._view = self._view, None
        if view is not None:
            view.__exit__(*exception)

    def say(self, sentence: str) -> None:
        """Say a sentence to the experimenter, and to the pages unless they are blind."""
        self._say(sentence)
        if not (self.blind or sentence.startswith("live view")):  # whose address has a token
            self._said.append(sentence)
            self._count += 1

    def watch(self, ticks: RingReader) -> None:
        """Show the ticks of a device from now on; called at each start of it."""
        if self._view is not None:
            self._view.watch(ticks)

    def look(self, runner: Any) -> None:
        """Tell the pages what has changed, and lead the simulated hand as they ask.

        Parameters
        ----------
        runner
            The `Runner` of the session, which stands above this module.
        """
        if self._view is None:
            return
        device = runner.device
        assert isinstance(device, SessionDevice)
        for asked in self._view.take():
            if isinstance(asked, Point):
                device.engine.give(steering.Hold(asked.x_mm, asked.y_mm, asked.theta_rad))
            elif isinstance(asked, LetGo):
                device.engine.give(steering.LetGo())
        for note in self._view.notes():
            self._say(note)
        try:
            self._view.tell(self._state(runner, device))
        except Exception as fault:  # whatever it is, the session goes on
            _log.info("the live view failed: %r", fault)
            self._say("live view: ended by a fault; the session goes on")
            self.__exit__(None, None, None)

    def _state(self, runner: Any, device: SessionDevice) -> ViewState:
        """Return what pages show."""
        protocol, trial, newest = runner.protocol, runner.trial, device.engine.newest
        style, facts = protocol.style(protocol.display), []
        if trial is not None:
            facts.append(("trial", runner.name))
            facts.append(("stimulus", f"{ordinal(runner.stimulus)} of {len(trial.stimuli)}"))
            facts.append(("attempt", str(runner.attempt)))
        minutes, seconds = divmod(int(runner.elapsed_s), 60)
        facts.append(("answered", str(runner.progress.done)))
        facts.append(("time", f"{minutes} min {seconds:02} s"))
        flags = 0 if newest is None else int(newest["flags"])
        why = next((words for flag, words in WHY.items() if flags & flag), "the device is in use")
        state = ViewState(
            title=protocol.title,
            array=array_shown(device.display),
            geometry=geometry_shown(style.geometry),
            rows_shown=rows_shown(style, device.display),
            place=f"waits for {runner.asked.what}" if runner.asked else runner.presenter.why,
            paused=runner.paused,
            simulated=device.engine.steered,
            device="device: starts" if newest is None else f"device: {why}",
            said=list(self._said),
            said_before=self._count - len(self._said),
            facts=facts,
            blind=self.blind,
            done=runner.is_over,
        )
        if self.blind or trial is None:
            return state
        facts = [*facts, ("condition", trial.condition)]
        if not runner.is_shown or runner.presenter.by_key:
            return structs.replace(state, facts=facts)
        stimulus = trial.stimuli[runner.stimulus]
        facts.append(("asked for", stimulus.picture or say_cells(stimulus.cells, protocol.masks)))
        shown = stimulus_shown(protocol, stimulus, device.line, device.display)
        return structs.replace(state, facts=facts, **shown)


def stimulus_shown(
    protocol: Protocol, stimulus: Stimulus, line: int, display: Display
) -> dict[str, Any]:
    """Return what pages are told of a stimulus, which a blind state keeps back."""
    style, lines = protocol.style(stimulus.look), []
    if not stimulus.picture:
        masks = stimulus.masks(protocol.display.lead_cells)
        lines.append(cells_shown(line, masks, stimulus.text, under=True))
    return {
        "geometry": geometry_shown(style.geometry),
        "mapping": f"mapping: {style.mapping.name}",
        "rows_shown": [] if stimulus.picture else rows_shown(style, display),
        "lines": lines,
    }
