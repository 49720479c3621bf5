"""What a device has to say, each kind of it at most once a second."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Sequence

EVERY_NS: Final = 1_000_000_000
# Kinds that are told apart at a time; what has more to say than that says it in one voice.
_MOST_KINDS = 16
_OTHERS = ""


@dataclass(slots=True)
class _Kind:
    """What is known of one kind of notice: when it was said last, and what came since."""

    said_ns: int
    sentence: str = ""
    held: int = 0


class Notices:
    """Sentences for the reader, who must not have to hear the same a thousand times a second.

    The first of a kind is said at once. Those that follow within the second are counted, and
    when it is over the last of them is said, with how many there were.
    """

    def __init__(self) -> None:
        self._kinds: dict[str, _Kind] = {}
        self._due: list[str] = []
        self._holding = False

    def add(self, kind: str, sentence: str, now_ns: int) -> None:
        """Have something to say.

        Parameters
        ----------
        kind
            Which notices are throttled together.
        sentence
            What to say.
        now_ns
            Time of a clock that does not go back.
        """
        if kind not in self._kinds and len(self._kinds) >= _MOST_KINDS:
            self._forget(now_ns)
            kind = kind if len(self._kinds) < _MOST_KINDS else _OTHERS
        known = self._kinds.get(kind)
        if known is None or (not known.held and now_ns - known.said_ns >= EVERY_NS):
            self._kinds[kind] = _Kind(now_ns)
            self._due.append(sentence)
            return
        # What was held last is said last: of "silent" and "back" the later one is true.
        self._kinds[kind] = self._kinds.pop(kind)
        known.sentence = sentence
        known.held += 1
        self._holding = True

    def take(self, now_ns: int) -> Sequence[str]:
        """What is to be said by now, in order; it is not said again."""
        if self._holding:
            self._release(now_ns)
        due, self._due = self._due, []
        return due

    def _forget(self, now_ns: int) -> None:
        """Forget kinds that may be said at once again."""
        self._kinds = {
            name: kind
            for name, kind in self._kinds.items()
            if kind.held or now_ns - kind.said_ns < EVERY_NS
        }

    def _release(self, now_ns: int) -> None:
        """Let go of what was held for a second."""
        self._holding = False
        for kind in self._kinds.values():
            if not kind.held:
                continue
            if now_ns - kind.said_ns < EVERY_NS:
                self._holding = True
                continue
            more = f" ({kind.held} times in the last second)" if kind.held > 1 else ""
            self._due.append(kind.sentence + more)
            kind.said_ns, kind.held = now_ns, 0
