"""Search for an order of trials that keeps the rules; `rules` checks what is found anew."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import partial
from itertools import accumulate, chain, pairwise
from typing import TYPE_CHECKING, Any

from vbraille.sessions.planning.factors import within

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Sequence

    from vbraille.sessions.planning.chance import Chance
    from vbraille.sessions.planning.design import Item
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.style import Condition

    Shown = tuple[Item, Condition]

QUARTERS = 4
CONDITION = "condition"
# Bounds of the search: fresh starts, exchanges tried in all, and random draws before a full look.
_STARTS, _EXCHANGES, _PARTNERS, _DRAWS = 40, 30_000, 25, 40


def limited(protocol: Protocol) -> dict[str, Callable[[Shown], str]]:
    """Names that ``at_most_running`` may have, each with the level of an item in a condition."""
    levels = {c.name: protocol.levels(c.name) for c in protocol.conditions}

    def level(name: str, shown: Shown) -> str:
        return levels[shown[1].name][name]

    def told(name: str, shown: Shown) -> str:
        return protocol.columns_of(tuple(map(int, shown[0])))[name]

    return {
        CONDITION: lambda shown: shown[1].name,
        **{factor.name: partial(level, factor.name) for factor in within(protocol.factors)},
        **{column: partial(told, column) for column in protocol.item_columns},
    }


def check_possible(protocol: Protocol) -> None:
    """Check by counting that some order of trials can keep each rule.

    Raises
    ------
    ValueError
        If none can.
    """
    design, kinds = protocol.design, limited(protocol)
    items = design.items()
    blocks = [[(item, condition) for item in items] for condition in protocol.conditions]
    if design.blocks != "conditions":
        blocks = [list(chain.from_iterable(blocks))]
    for name, most in protocol.rules.at_most_running.items():
        for block in blocks:
            counts = Counter(map(kinds[name], block))
            level, times = counts.most_common(1)[0]
            others = len(block) - times
            if times > most * (others + 1):
                where = "" if len(blocks) == 1 else f" of the block of {block[0][1].name}"
                raise ValueError(
                    f"at_most_running {name} = {most} cannot be kept: {level or 'an empty one'} "
                    f"is in {times} of {len(block)} trials{where}, and the other {others} part "
                    f"them into {others + 1} runs of {most} only; make it larger"
                )


@dataclass(slots=True)
class _Limit:
    """Values of all places of a sequence, of which so many may be the same running."""

    values: list[Hashable]
    most: int

    def broken(self, start: int) -> bool:
        """True if the places from a start on hold one value too often running."""
        stop = start + self.most + 1
        if start < 0 or stop > len(self.values):
            return False
        first = self.values[start]
        return all(self.values[place] == first for place in range(start + 1, stop))


@dataclass(slots=True)
class _Search:
    """A sequence of trials that is brought to keep limits and shares by exchanges in blocks."""

    sequence: list[Any]
    blocks: list[tuple[int, int]]  # first place of each block, and the one after its last
    limits: list[_Limit]
    cuts: list[int]  # ends of the quarters; empty if these need not be balanced
    block_of: list[int] = field(init=False)
    quarter_of: list[int] = field(init=False)
    names: list[str] = field(init=False)
    shares: dict[str, list[int]] = field(init=False)
    bounds: dict[str, list[tuple[int, int]]] = field(init=False)

    def __post_init__(self) -> None:
        self.block_of = [
            n for n, (first, stop) in enumerate(self.blocks) for _ in range(first, stop)
        ]
        self.quarter_of = [sum(place >= cut for cut in self.cuts) for place in range(len(self))]
        self.names = [condition.name for _, condition in self.sequence]
        self.shares, self.bounds = {}, {}
        for name, times in Counter(self.names).items():
            held = Counter(
                q for q, own in zip(self.quarter_of, self.names, strict=True) if own == name
            )
            self.shares[name] = [held[q] for q in range(len(self.cuts))]
            self.bounds[name] = share_bounds(times, self.cuts)

    def __len__(self) -> int:
        return len(self.sequence)

    def swap(self, one: int, other: int) -> None:
        """Exchange two places."""
        columns: list[list[Any]] = [self.sequence, self.names]
        for values in (*columns, *(limit.values for limit in self.limits)):
            values[one], values[other] = values[other], values[one]
        if self.cuts:
            first, second = self.quarter_of[one], self.quarter_of[other]
            if first != second:
                for place, gains, loses in ((one, first, second), (other, second, first)):
                    share = self.shares[self.names[place]]
                    share[gains] += 1
                    share[loses] -= 1

    def cost(self, places: tuple[int, ...]) -> int:
        """Number of broken rules at some places, and in the shares of what stands there."""
        found = 0
        for limit in self.limits:
            starts = {s for place in places for s in range(place - limit.most, place + 1)}
            found += sum(map(limit.broken, starts))
        if self.cuts:
            found += sum(self._off(name) for name in {self.names[place] for place in places})
        return found

    def _off(self, name: str) -> int:
        pairs = zip(self.shares[name], self.bounds[name], strict=True)
        return sum(max(0, low - n, n - high) for n, (low, high) in pairs)

    def faults(self) -> list[int]:
        """A place of each broken rule."""
        found = [
            start + limit.most
            for limit in self.limits
            for start in range(len(self) - limit.most)
            if limit.broken(start)
        ]
        for place in range(len(self)) if self.cuts else ():
            quarter, name = self.quarter_of[place], self.names[place]
            if self.shares[name][quarter] > self.bounds[name][quarter][1]:
                found.append(place)
        # A quarter may lack a condition of which no other quarter has too much.
        if not found and any(map(self._off, self.shares)):
            return list(range(len(self)))
        return found

    def mend(self, chance: Chance, most: int) -> bool:
        """Exchange places while that breaks no more rules; True if none is broken at the end.

        At most so many exchanges are tried.
        """
        tried = 0
        while tried < most:
            faults = self.faults()
            if not faults:
                return True
            for place in chance.shuffled(faults):
                tried += _PARTNERS
                self._mend_at(place, chance)
        return not self.faults()

    def _mend_at(self, place: int, chance: Chance) -> None:
        first, stop = self.blocks[self.block_of[place]]
        for _ in range(_PARTNERS):
            if chance.below(2):
                other = first + chance.below(stop - first)
            else:
                # Trials of other blocks change places if both blocks keep their conditions.
                other = chance.below(len(self))
                if self.names[other] != self.names[place]:
                    continue
            if other == place:
                continue
            before = self.cost((place, other))
            if not before:
                return
            self.swap(place, other)
            after = self.cost((place, other))
            if after < before or (after == before and chance.below(4) == 0):
                return
            self.swap(place, other)


def share_bounds(times: int, cuts: Sequence[int]) -> list[tuple[int, int]]:
    """Least and largest number of times that each part holds something which all hold so often.

    Parameters
    ----------
    times
        How often all parts together hold it.
    cuts
        Ends of the parts.
    """
    whole, bounds, first = (cuts[-1] if cuts else 0), [], 0
    for cut in cuts:
        size, first = cut - first, cut
        bounds.append((times * size // whole, -(-times * size // whole)))
    return bounds


def arranged(
    protocol: Protocol, deal: Callable[[], list[list[Shown]]], chance: Chance
) -> list[list[Shown]] | None:
    """Trials of each block in an order that keeps all rules; None if none was found.

    Parameters
    ----------
    protocol
        The protocol, which has the rules.
    deal
        Function that deals the trials to the blocks anew.
    chance
        What is drawn at random. The search is bounded, and the same for the same chance.
    """
    rules, kinds = protocol.rules, limited(protocol)
    named = [(kinds[name], most) for name, most in rules.at_most_running.items()]
    if rules.never_twice_running:
        named.append((lambda shown: str(protocol.design.content(shown[0])), 1))
    for _ in range(_STARTS):
        blocks = deal()
        ends = list(accumulate(map(len, blocks)))
        spans = list(zip([0, *ends], ends, strict=False))
        cuts = [part * ends[-1] // QUARTERS for part in range(1, QUARTERS + 1)]
        cuts = cuts if rules.balanced_quarters else []
        sequence: list[Shown] = []
        for block in blocks:
            for part in _parts(block, len(sequence), cuts, chance):
                _append(sequence, part, named, chance)
        limits = [_Limit([kind(shown) for shown in sequence], most) for kind, most in named]
        search = _Search(sequence, spans, limits, cuts)
        if search.mend(chance, _EXCHANGES // _STARTS + 50 * len(sequence) // 4):
            return [search.sequence[first:stop] for first, stop in spans]
    return None


def _parts(block: list[Shown], first: int, cuts: list[int], chance: Chance) -> list[list[Shown]]:
    """Trials of a block, cut where quarters end, with each condition spread evenly over it."""
    mixed = chance.shuffled(block)
    if not cuts:
        return [mixed]
    counts = Counter(condition.name for _, condition in mixed)
    seen: Counter[str] = Counter()
    keys: list[tuple[float, int]] = []
    for place, (_, condition) in enumerate(mixed):
        keys.append(((seen[condition.name] + 0.5) / counts[condition.name], place))
        seen[condition.name] += 1
    spread = [mixed[place] for _, place in sorted(keys)]
    inner = [cut - first for cut in cuts if first < cut < first + len(block)]
    edges = [0, *inner, len(block)]
    return [spread[a:b] for a, b in pairwise(edges)]


def _append(
    sequence: list[Shown],
    left: list[Shown],
    named: list[tuple[Callable[[Shown], str], int]],
    chance: Chance,
) -> None:
    """Append trials one by one, each drawn from those that keep the limits, if there are any."""
    left = list(left)
    counts = [Counter(map(kind, left)) for kind, _ in named]
    while left:
        need: list[str | None] = []
        barred: list[str | None] = []
        for (kind, most), held in zip(named, counts, strict=True):
            # With more than this, a level must come next: the others could not part it later.
            level, times = max(held.items(), key=lambda pair: pair[1])
            need.append(level if times > most * (len(left) - times) else None)
            last = [kind(shown) for shown in sequence[-most:]]
            full = len(last) == most and len(set(last)) == 1
            barred.append(last[0] if full else None)

        def fits(shown: Shown, *, strictly: bool) -> bool:
            for (kind, _), must, no in zip(named, need, barred, strict=True):  # noqa: B023
                level = kind(shown)
                if level == no or (strictly and must not in (None, level)):
                    return False
            return True

        at = _drawn(left, fits, chance)
        shown = left[at]
        left[at] = left[-1]
        left.pop()
        sequence.append(shown)
        for (kind, _), held in zip(named, counts, strict=True):
            held[kind(shown)] -= 1


def _drawn(left: list[Shown], fits: Callable[..., bool], chance: Chance) -> int:
    """Place of a trial that fits, at random; of any trial if none does."""
    for strictly in (True, False):
        for _ in range(_DRAWS):
            at = chance.below(len(left))
            if fits(left[at], strictly=strictly):
                return at
        fitting = [at for at, shown in enumerate(left) if fits(shown, strictly=strictly)]
        if fitting:
            return fitting[chance.below(len(fitting))]
    return chance.below(len(left))
