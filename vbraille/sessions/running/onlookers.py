"""The live view of a session, seen from the session: it is told, and never waited for."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, Final, Protocol

from msgspec import structs

from vbraille.engine.host import Host
from vbraille.sessions.record.events import LiveView
from vbraille.sessions.running.viewed import Heard, state_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vbraille.engine.shared import Extent
    from vbraille.live.messages import PagePress, Turn, ViewState
    from vbraille.sessions.running.course import Course

LOOPBACK: Final = "127.0.0.1"
ENDED: Final = "live view: ended by a fault; the session goes on"
_NO_KNOBS: Final = (
    "refused: in a session nothing is turned or pressed here; the experimenter types at the console"
)
_log = logging.getLogger(__name__)


class ToldMonitor(Protocol):
    """What is used here of `vbraille.live.monitor.Monitor`, none of which waits."""

    def launch(self) -> None:
        """Start the process of the server."""
        ...

    def share(self, descriptor: int, extent: Extent, /) -> None:
        """Give the server the memory of an engine."""
        ...

    def tell(self, state: ViewState) -> None:
        """Give the pages another state."""
        ...

    def take(self) -> Sequence[PagePress | Turn]:
        """What pages have asked for since the last call."""
        ...

    def notes(self) -> Sequence[str]:
        """Sentences for the experimenter since the last call."""
        ...

    def close(self) -> None:
        """End the live view."""
        ...


class Onlookers:
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
        monitor: ToldMonitor,
        *,
        blind: bool,
        host: str,
        simulated: bool,
    ) -> None:
        self._monitor: ToldMonitor | None = monitor
        self._simulated = simulated
        self._host = host
        self._say: Callable[[str], None] = _nobody
        self._heard = Heard(blind=blind)
        self._newest: ViewState | None = None
        self._number = 0

    def begin(self, engine: object) -> None:
        """Start the live view, and have it see the memory of an engine that is not launched yet."""
        monitor = self._monitor
        if monitor is None:
            return
        try:
            monitor.launch()
        except Exception as fault:
            _log.info("the live view did not start: %r", fault)
            self._end(monitor)
            return
        if isinstance(engine, Host):
            engine.on_share = self._share

    def _share(self, descriptor: int, extent: Extent) -> None:
        if self._monitor is None:
            return
        try:
            self._monitor.share(descriptor, extent)
        except Exception as fault:
            _log.info("the live view was not given the memory: %r", fault)
            self._end(self._monitor)

    def beside(self, say: Callable[[str], None]) -> Callable[[str], None]:
        """Give the function that says a sentence to the experimenter by ``say``, and to the pages.

        The pages are told it as far as they may hear it. What the live view itself has to say goes
        to the experimenter alone.
        """
        self._say = say

        def tell(sentence: str) -> None:
            say(sentence)
            self._heard.hear(sentence)

        return tell

    def told(self) -> LiveView:
        """What the journal has about the live view of a run."""
        return LiveView(self._heard.blind, self._host, self._simulated)

    def look(self, course: Course) -> None:
        """Tell the pages what has changed, and refuse what they ask for."""
        if self._monitor is None:
            return
        try:
            self._look(self._monitor, course)
        except Exception as fault:
            _log.info("the live view has failed: %r", fault)
            self._end(self._monitor)

    def close(self) -> None:
        """End the live view."""
        monitor, self._monitor = self._monitor, None
        if monitor is not None:
            _close(monitor)

    def _look(self, monitor: ToldMonitor, course: Course) -> None:
        for note in monitor.notes():
            self._say(note)
        if monitor.take() and _NO_KNOBS not in self._heard.last[-1:]:
            self._heard.hear(_NO_KNOBS)
        state = state_of(course, self._heard, simulated=self._simulated)
        if state != self._newest:
            self._newest, self._number = state, self._number + 1
            monitor.tell(structs.replace(state, number=self._number))

    def _end(self, monitor: ToldMonitor) -> None:
        self._monitor = None
        _close(monitor)
        self._say(ENDED)


def _nobody(_sentence: str) -> None:
    """Ignore a sentence, before it is known who hears them."""


def _close(monitor: ToldMonitor) -> None:
    try:
        monitor.close()
    except Exception as fault:
        _log.info("the live view did not close: %r", fault)
