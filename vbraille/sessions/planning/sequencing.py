"""Orders of trials: chance that is the same on every machine, the rules of order, their keeping."""

from __future__ import annotations

import random
from collections import Counter
from dataclasses import dataclass, field, replace
from hashlib import sha256
from itertools import accumulate, chain, pairwise
from typing import TYPE_CHECKING, Any, TypeVar

from msgspec import structs

from vbraille.braille.spelling import LETTERS
from vbraille.errors import check_range
from vbraille.sessions.planning.design import MOST_TRIALS, StringList
from vbraille.sessions.planning.stimuli import Stimuli
from vbraille.tomlfile import Table, which

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence

    from vbraille.sessions.planning.design import Catch, Design, Item
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.planning.style import Condition

    Shown = tuple[Item, Condition]
    LevelsOf = Mapping[str, Callable[[Shown], str]]

_Item = TypeVar("_Item")
QUARTERS = 4
# Bounds of the search: fresh starts, exchanges tried in all, and random draws before a full look.
_STARTS, _EXCHANGES, _PARTNERS, _DRAWS = 40, 30_000, 25, 40


class Chance:
    """Shuffles that are the same on every machine and for every Python.

    Python promises only that `random.Random.random` gives the same numbers for a seed in every
    version. So the shuffle is made of these numbers alone, and the seed is the SHA-256 of a text.

    Parameters
    ----------
    seed
        Any text; equal texts give equal shuffles.
    """

    def __init__(self, seed: str) -> None:
        self._random = random.Random(int.from_bytes(sha256(seed.encode()).digest(), "big")).random

    def below(self, number: int) -> int:
        """Whole number from 0 to one less than the given one, all equally likely."""
        return int(self._random() * number)

    def shuffled(self, items: Iterable[_Item]) -> list[_Item]:
        """Items in random order, in which every order is equally likely (Fisher and Yates)."""
        order = list(items)
        for last in range(len(order) - 1, 0, -1):
            other = self.below(last + 1)
            order[last], order[other] = order[other], order[last]
        return order

    def apart(
        self,
        items: Iterable[_Item],
        content: Callable[[_Item], Hashable],
        before: Hashable = None,
    ) -> list[_Item]:
        """Items in an order in which no two neighbours have the same content.

        Each item is drawn from the items left whose content differs from the one before, and all
        of these are equally likely. But a content that more than half of the items left have
        comes next, since otherwise it would have to come twice in a row later. So contents that
        are equally frequent are equally likely at every place.

        Parameters
        ----------
        items
            The items, in any order.
        content
            Function that gives the content of an item.
        before
            Content of the item that comes before all of these; None if there is no such item.

        Raises
        ------
        ValueError
            If there is no such order.
        """
        left = [(content(item), item) for item in items]
        counts = Counter(kind for kind, _ in left)
        order: list[_Item] = []
        while left:
            must = next((kind for kind, n in counts.items() if n > len(left) // 2), None)
            if must is not None and must == before:
                raise ValueError("something is in more than half of them")
            while True:
                at = self.below(len(left))
                kind, item = left[at]
                if kind == must if must is not None else kind != before:
                    break
            left[at] = left[-1]
            left.pop()
            counts[kind] -= 1
            order.append(item)
            before = kind
        return order


def balanced_orders(number: int) -> list[tuple[int, ...]]:
    """Orders of a number of conditions, balanced for place and for what goes before.

    Over all orders together, each condition is equally often in each place, and follows each
    other condition equally often (E. J. Williams, 1949). There are as many orders as conditions;
    if that number is odd, their mirror images are added.

    Parameters
    ----------
    number
        Number of conditions, at least 1.

    Returns
    -------
    list of tuple of int
        Orders of the numbers 0 … number - 1, each of which is in every order once.
    """
    # The first order is 0, 1, n-1, 2, n-2, …: its neighbours differ by each of 1 … n-1 once if n
    # is even, and twice together with the mirror image if n is odd.
    first = [(place + 1) // 2 if place % 2 else -(place // 2) for place in range(number)]
    square = [tuple((row + step) % number for step in first) for row in range(number)]
    if number % 2 and number > 1:
        square += [order[::-1] for order in square]
    return square


class Rules(Table, frozen=True):
    """Rules that a plan must follow beside its design.

    Parameters
    ----------
    each_letter
        Exact number of times that each letter of the alphabet is shown in each condition; None
        for any number.
    each_letter_at_least
        Least number of times that each letter is shown in each condition; None for any number.
    never_twice_running
        Whether no two neighbouring trials may show the same. Two trials show the same if they
        have the same string, the same cells in any order where cells are reordered, or the same
        two values in the same order.
    at_most_running
        Largest number of neighbouring trials that may have the same level of a factor, by the
        factor's name; "condition" stands for the conditions, and a column of the items' file for
        itself.
    balanced_quarters
        Whether each quarter of the test has each condition equally often, as far as numbers allow.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    each_letter: int | None = None
    each_letter_at_least: int | None = None
    never_twice_running: bool = False
    at_most_running: dict[str, int] = {}  # noqa: RUF012  (msgspec copies an empty default)
    balanced_quarters: bool = False

    def __post_init__(self) -> None:
        check_range("each_letter", self.each_letter, 1, MOST_TRIALS)
        check_range("each_letter_at_least", self.each_letter_at_least, 1, MOST_TRIALS)
        for most in self.at_most_running.values():
            check_range("at_most_running: one", most, 1, MOST_TRIALS)

    @property
    def searched(self) -> bool:
        """True if an order that keeps the rules must be searched for."""
        return bool(self.at_most_running) or self.balanced_quarters

    def check(
        self,
        design: Design,
        conditions: Sequence[Condition],
        levels_of: LevelsOf,
        *,
        adaptive: bool,
    ) -> None:
        """Check that these rules name what there is in a protocol, and can be kept.

        Parameters
        ----------
        design, conditions
            What is shown, and in which conditions.
        levels_of
            Functions that give the level of an item in a condition, by the names that a rule may
            have.
        adaptive
            Whether the answers choose the trials.

        Raises
        ------
        ValueError
            If not.
        """
        if isinstance(design, StringList):
            self.check_letters(design.items())
        elif (self.each_letter, self.each_letter_at_least) != (None, None):
            raise ValueError("count the letters of kind = 'list'; leave them out")
        if not self.searched:
            return
        if adaptive:
            raise ValueError(
                "at_most_running and balanced_quarters are of a fixed order; leave them out, since "
                "[procedure] chooses the trials"
            )
        for name in self.at_most_running:
            if name not in levels_of:
                raise ValueError(f"at_most_running has {name!r}{which(name, levels_of)}")
        by_blocks = design.blocks == "conditions" and len(conditions) > 1
        if self.balanced_quarters and by_blocks:
            raise ValueError(
                "balanced_quarters cannot be kept: each condition has a block of its own; give "
                "[design] blocks = 1, or leave the rule out"
            )
        self._check_possible(design, conditions, levels_of)

    def _check_possible(
        self, design: Design, conditions: Sequence[Condition], levels_of: LevelsOf
    ) -> None:
        """Check by counting that some order of trials can keep each rule."""
        items = design.items()
        blocks = [[(item, condition) for item in items] for condition in conditions]
        if design.blocks != "conditions":
            blocks = [list(chain.from_iterable(blocks))]
        for name, most in self.at_most_running.items():
            for block in blocks:
                counts = Counter(map(levels_of[name], block))
                level, times = counts.most_common(1)[0]
                others = len(block) - times
                if times > most * (others + 1):
                    where = "" if len(blocks) == 1 else f" of the block of {block[0][1].name}"
                    raise ValueError(
                        f"at_most_running {name} = {most} cannot be kept: "
                        f"{level or 'an empty one'} is in {times} of {len(block)} trials{where}, "
                        f"and the other {others} part them into {others + 1} runs of {most} only; "
                        f"make it larger"
                    )

    def check_letters(self, lines: Iterable[tuple[int, ...]]) -> None:
        """Check how often each letter is shown in a condition.

        Raises
        ------
        ValueError
            If one is shown too often or too seldom.
        """
        shown = Counter(mask for masks in lines for mask in masks)
        for letter, mask in LETTERS.items():
            least = self.each_letter_at_least or 0
            if self.each_letter in (None, shown[mask]) and shown[mask] >= least:
                continue
            exactly = self.each_letter not in (None, shown[mask])
            name = "each_letter" if exactly else "each_letter_at_least"
            raise ValueError(
                f"{letter} is shown {_times(shown[mask])}; {name} is {getattr(self, name)}; "
                f"change the strings or the rule"
            )


def _times(number: int) -> str:
    return "once" if number == 1 else f"{number} times"


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


def sequenced(
    rules: Rules,
    design: Design,
    levels_of: LevelsOf,
    deal: Callable[[], list[list[Shown]]],
    chance: Chance,
) -> list[list[Shown]]:
    """Trials of each block in an order that keeps all rules.

    Parameters
    ----------
    rules, design
        The rules, and what is shown.
    levels_of
        Functions that give the level of an item in a condition, by names.
    deal
        Function that deals the trials to the blocks anew.
    chance
        What is drawn at random. A search is bounded, and the same for the same chance.

    Raises
    ------
    ValueError
        If no such order was found.
    """
    if not rules.searched:
        return apart(rules, design, deal(), chance)
    named = [(levels_of[name], most) for name, most in rules.at_most_running.items()]
    if rules.never_twice_running:
        named.append((lambda shown: str(design.content(shown[0])), 1))
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
    kept = [f"at_most_running {name} = {most}" for name, most in rules.at_most_running.items()]
    kept += ["balanced_quarters"] if rules.balanced_quarters else []
    kept += ["never_twice_running"] if rules.never_twice_running else []
    raise ValueError(
        f"cannot keep {' with '.join(kept)}: no order of its trials was found that does; make the "
        f"rules weaker, or show more different items"
    )


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


def apart(
    rules: Rules, design: Design, blocks: list[list[Shown]], chance: Chance
) -> list[list[Shown]]:
    """Trials of each block at random; no two neighbours show the same, if the rules say so.

    Raises
    ------
    ValueError
        If one thing is shown too often for that.
    """
    if not rules.never_twice_running:
        return [chance.shuffled(block) for block in blocks]

    def shows(shown: Shown) -> Item:
        return design.content(shown[0])

    ordered: list[list[Shown]] = []
    before: Item | None = None
    for block in blocks:
        try:
            ordered.append(chance.apart(block, shows, before))
        except ValueError:
            raise ValueError(
                "cannot keep never_twice_running: one thing is shown too often in a block or in "
                "practice; show more different ones, or leave the rule out"
            ) from None
        if block:
            before = shows(ordered[-1][-1])
    return ordered


def with_catch(trials: Sequence[Trial], catch: Catch, chance: Chance) -> list[Trial]:
    """Trials with catch trials among them, one at a random place of each stretch.

    A catch trial stands after a trial of its stretch, whose block and condition it has. So it is
    never the first of the session, and no two are neighbours.
    """
    found: list[Trial] = []
    first = 0
    for end in catch.stretches(len(trials)):
        after = first + chance.below(end - first)
        found += [*trials[first : after + 1], _caught(trials[after], catch)]
        found += trials[after + 1 : end]
        first = end
    return [*found, *trials[first:]]


def _caught(trial: Trial, catch: Catch) -> Trial:
    if catch.show == "repeat":
        return structs.replace(trial, catch="repeat")
    first, stop = trial.asked
    blank = [
        replace(
            s,
            masks=(*s.masks[:first], *(0,) * (stop - first), *s.masks[stop:]),
            text=None if s.text is None else "",
        )
        for s in trial.stimuli
    ]
    return structs.replace(trial, catch="blank", stimuli=Stimuli(blank))
