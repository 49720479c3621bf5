"""What is said of things that a format holds and that cannot be shown, such as formulas."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from vbraille.translate.source import MarkKind
from vbraille.wording import count

if TYPE_CHECKING:
    from vbraille.layout.pages import Line

_NAMED = 5  # at most so many kinds are named in the sentence, the most frequent


class Unshown:
    """Count what lines have remarks on, because it cannot be shown; each once."""

    def __init__(self) -> None:
        self._seen: set[tuple[int, str]] = set()  # places and targets of what was counted
        self._counts: Counter[str] = Counter()

    def see(self, line: Line) -> None:
        """Count the remarks that begin on a line, each once, however often the line comes."""
        block = line.block
        if not block.marks or line.first >= line.after:
            return
        places = block.text.places
        first, after = int(places[line.first]), int(places[line.after - 1]) + 1
        for mark in block.marks:
            place = mark.start, mark.target
            if mark.kind is not MarkKind.UNSHOWN or not first <= mark.start < after:
                continue
            if place not in self._seen:
                self._seen.add(place)
                self._counts[mark.target or "other thing"] += 1

    @property
    def sentence(self) -> str | None:
        """Sentence on how many there were, and of what kinds; None if there were none."""
        total = self._counts.total()
        if not total:
            return None
        named = [count(n, what) for what, n in self._counts.most_common(_NAMED)]
        others = total - sum(n for _, n in self._counts.most_common(_NAMED))
        if others:
            named.append(count(others, "other thing"))
        return (
            f"not shown: {count(total, 'thing')} ({', '.join(named)}); "
            f"each is marked where it stands"
        )
