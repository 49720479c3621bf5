"""What a device has to tell, each kind of it at most once a second; a knob more often."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Hashable, Sequence

    from vbraille.devices.events import Event

EVERY_NS: Final = 1_000_000_000
PLACE_EVERY_NS: Final = 20_000_000  # of a knob: it is felt at once, whoever turns it
# So many kinds are told apart at a time; further ones share a kind.
_MOST_KINDS = 16
_OTHERS = "others"
# So many events wait to be taken; a button that bounces for ever must not fill the memory.
_MOST_DUE = 256


@dataclass(slots=True)
class _NoticeKind:
    """State of one kind of event: when it was told last, and what came since."""

    told_ns: int
    event: Event
    held: int = 0

    def due(self, now_ns: int) -> bool:
        """Whether the next event of the kind may be told."""
        every_ns = PLACE_EVERY_NS if self.event.tells_place else EVERY_NS
        return now_ns - self.told_ns >= every_ns


class Notices:
    """Events for the reader, who must not have to hear the same a thousand times a second.

    The first event of a kind is told at once. Those that follow within a second are counted; when
    the second is over, the last of them is told with their number. Where only the last matters, as
    of a knob, it is told fifty times a second, without a number.
    """

    def __init__(self) -> None:
        self._kinds: dict[Hashable, _NoticeKind] = {}
        self._due: list[Event] = []
        self._holding = False

    def add(self, event: Event, now_ns: int, kind: Hashable = None) -> None:
        """Add an event that is to be told.

        Parameters
        ----------
        event
            The event.
        now_ns
            Time by a clock that does not go back.
        kind
            Key of events that are throttled together; None for the event's own kind. An event
            without a kind is told as often as it happens.
        """
        kind = kind or event.kind
        if kind is None:
            self._tell(event)
            return
        if kind not in self._kinds and len(self._kinds) >= _MOST_KINDS:
            self._forget(now_ns)
            kind = kind if len(self._kinds) < _MOST_KINDS else _OTHERS
        known = self._kinds.get(kind)
        if known is None or (not known.held and known.due(now_ns)):
            self._kinds[kind] = _NoticeKind(now_ns, event)
            self._tell(event)
            return
        # The event held last is told last: of "silent" and "back" the later one is true.
        self._kinds[kind] = self._kinds.pop(kind)
        known.event = event
        known.held += 1
        self._holding = True

    def take(self, now_ns: int) -> Sequence[Event]:
        """Events that are to be told by now, in order; each is given once."""
        if self._holding:
            self._release(now_ns)
        due, self._due = self._due, []
        return due

    def _tell(self, event: Event) -> None:
        if len(self._due) < _MOST_DUE:
            self._due.append(event)

    def _forget(self, now_ns: int) -> None:
        """Forget kinds of which the next event may be told at once."""
        self._kinds = {
            name: kind for name, kind in self._kinds.items() if kind.held or not kind.due(now_ns)
        }

    def _release(self, now_ns: int) -> None:
        """Release events that were held for a second."""
        self._holding = False
        for kind in self._kinds.values():
            if not kind.held:
                continue
            if not kind.due(now_ns):
                self._holding = True
                continue
            counted = kind.held > 1 and not kind.event.tells_place
            self._tell(replace(kind.event, times=kind.held) if counted else kind.event)
            kind.told_ns, kind.held = now_ns, 0
