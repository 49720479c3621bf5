"""What a device has to tell, each kind of it at most once a second."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Hashable, Sequence

    from vbraille.devices.events import Event

EVERY_NS: Final = 1_000_000_000
# Kinds that are told apart at a time; what has more to say than that says it in one voice.
_MOST_KINDS = 16
_OTHERS = "others"
# Events that wait to be taken; a button that bounces for ever must not fill the memory.
_MOST_DUE = 256


@dataclass(slots=True)
class _NoticeKind:
    """What is known of one kind of event: when it was told last, and what came since."""

    told_ns: int
    event: Event
    held: int = 0


class Notices:
    """Events for the reader, who must not have to hear the same a thousand times a second.

    The first of a kind is told at once. Those that follow within the second are counted, and
    when it is over the last of them is told, with how many there were.
    """

    def __init__(self) -> None:
        self._kinds: dict[Hashable, _NoticeKind] = {}
        self._due: list[Event] = []
        self._holding = False

    def add(self, event: Event, now_ns: int, kind: Hashable = None) -> None:
        """Have something to tell.

        Parameters
        ----------
        event
            What.
        now_ns
            Time of a clock that does not go back.
        kind
            Which events are throttled together; the event's own kind if this is None. An event
            that has none is told as often as it happens.
        """
        kind = kind or event.kind
        if kind is None:
            self._tell(event)
            return
        if kind not in self._kinds and len(self._kinds) >= _MOST_KINDS:
            self._forget(now_ns)
            kind = kind if len(self._kinds) < _MOST_KINDS else _OTHERS
        known = self._kinds.get(kind)
        if known is None or (not known.held and now_ns - known.told_ns >= EVERY_NS):
            self._kinds[kind] = _NoticeKind(now_ns, event)
            self._tell(event)
            return
        # What was held last is told last: of "silent" and "back" the later one is true.
        self._kinds[kind] = self._kinds.pop(kind)
        known.event = event
        known.held += 1
        self._holding = True

    def take(self, now_ns: int) -> Sequence[Event]:
        """What is to be told by now, in order; it is not told again."""
        if self._holding:
            self._release(now_ns)
        due, self._due = self._due, []
        return due

    def _tell(self, event: Event) -> None:
        if len(self._due) < _MOST_DUE:
            self._due.append(event)

    def _forget(self, now_ns: int) -> None:
        """Forget kinds that may be told at once again."""
        self._kinds = {
            name: kind
            for name, kind in self._kinds.items()
            if kind.held or now_ns - kind.told_ns < EVERY_NS
        }

    def _release(self, now_ns: int) -> None:
        """Let go of what was held for a second."""
        self._holding = False
        for kind in self._kinds.values():
            if not kind.held:
                continue
            if now_ns - kind.told_ns < EVERY_NS:
                self._holding = True
                continue
            times = kind.held if kind.held > 1 else kind.event.times
            self._tell(replace(kind.event, times=times))
            kind.told_ns, kind.held = now_ns, 0
