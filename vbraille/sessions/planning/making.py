"""Plans are made: of a protocol, a participant and a seed, the same one on every machine."""

from __future__ import annotations

import re
from itertools import cycle
from typing import TYPE_CHECKING

from msgspec import structs

from vbraille.errors import InputError
from vbraille.sessions.planning.chance import Chance, balanced_orders
from vbraille.sessions.planning.design import Choice, Item, StringList
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.rules import check_plan, is_balanced
from vbraille.sessions.planning.stimuli import (
    Stimuli,
    Stimulus,
    Trial,
    check_participant,
    check_seed,
)
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.sessions.planning.appearance import Condition
    from vbraille.sessions.planning.protocol import Protocol

_Shown = tuple[Item, "Condition"]


def make_plan(
    protocol: Protocol,
    participant: str,
    seed: int,
    order: int | None = None,
    *,
    texture: float | None = None,
    contrast: float | None = None,
) -> Plan:
    """Plan a session, and check it.

    Parameters
    ----------
    protocol
        What is shown.
    participant
        A pseudonym; the last number in it says which balanced order it is.
    seed
        Of all that is drawn.
    order
        Which of the balanced orders, from 1, instead of the participant's. They
        come round again.
    texture, contrast
        Instead of the display's, in those conditions that do not give their own.

    Raises
    ------
    InputError
        If something cannot be used with this protocol.
    """
    try:
        check_participant(participant)
        check_seed(seed)
        conditions = _tuned(protocol, {"texture": texture, "contrast": contrast})
    except ValueError as error:
        raise InputError(str(error)) from None
    order = _choose_order(protocol, participant, order)
    drawn = f"{protocol.name} {seed} {participant}"
    chance = Chance(drawn)
    blocks = _ordered(protocol, _blocks(protocol, conditions, order, chance), chance)
    trials = [
        _trial(protocol, item, condition, block)
        for block, shown in enumerate(blocks, 1)
        for item, condition in shown
    ]
    # By chances of its own: another number of practice trials leaves the others as they are.
    practice = _practice(protocol, conditions, Chance(f"{drawn} practice"))
    plan = Plan(
        protocol=protocol.name,
        participant=participant,
        seed=seed,
        order=order,
        practice=_numbered(practice),
        trials=_numbered(trials),
    )
    check_plan(protocol, plan)
    return plan


def _tuned(protocol: Protocol, given: dict[str, float | None]) -> list[Condition]:
    """Conditions with what is given instead of the display's own values."""
    given = {name: float(value) for name, value in given.items() if value is not None}
    for name in given:
        if all(name in condition.given for condition in protocol.conditions):
            raise ValueError(
                f"every condition of {protocol.name} has its own {name}; leave {setting(name)} out"
            )
    return [structs.replace(c, **(given | c.given)) for c in protocol.conditions]


def _choose_order(protocol: Protocol, participant: str, order: int | None) -> int:
    """Number of the balanced order, from 1; 0 if there is nothing to balance."""
    if not is_balanced(protocol):
        if order is not None:
            raise InputError(
                f"{protocol.name} has no balanced orders; leave {setting('order')} out"
            )
        return 0
    if order is None:
        numbers = re.findall("[0-9]+", participant)
        if not numbers:
            raise InputError(
                f"the order of the conditions goes by the participant's number, and {participant} "
                f"has none; give {setting('order')} N, or a participant such as P07"
            )
        order = int(numbers[-1])
    elif order < 1:
        raise InputError(f"order is {order}; it must be 1 or more")
    return (order - 1) % len(balanced_orders(len(protocol.conditions))) + 1


def _blocks(
    protocol: Protocol, conditions: list[Condition], order: int, chance: Chance
) -> list[list[_Shown]]:
    """What each block shows, not yet shuffled."""
    items = _items(protocol, chance)
    if protocol.design.blocks == "conditions":
        places = list(range(len(conditions)))
        if order:
            places = list(balanced_orders(len(conditions))[order - 1])
        elif protocol.design.order == "shuffled":
            places = chance.shuffled(places)
        return [[(item, conditions[place]) for item in items[place]] for place in places]
    blocks: list[list[_Shown]] = [[] for _ in range(protocol.design.blocks)]
    # Dealt like cards, and each condition goes on where the one before it ended: so no block gets
    # more than one more of a condition than another, nor more than one more in all.
    dealt = cycle(blocks)
    for condition, shown in zip(conditions, items, strict=True):
        for item in chance.shuffled(shown):
            next(dealt).append((item, condition))
    return blocks


def _ordered(protocol: Protocol, blocks: list[list[_Shown]], chance: Chance) -> list[list[_Shown]]:
    """What each block shows, in the order in which it does."""
    if not protocol.rules.never_twice_running:
        return [chance.shuffled(block) for block in blocks]

    def shows(shown: _Shown) -> Item:
        return protocol.design.content(shown[0])

    ordered: list[list[_Shown]] = []
    before: Item | None = None
    for block in blocks:
        try:
            ordered.append(chance.apart(block, shows, before))
        except ValueError:
            raise InputError(
                f"{protocol.name} cannot keep never_twice_running: one thing is shown too often "
                f"in a block or in practice; show more different ones, or leave the rule out"
            ) from None
        if block:
            before = shows(ordered[-1][-1])
    return ordered


def _items(protocol: Protocol, chance: Chance) -> list[list[Item]]:
    """What each condition shows, with the cells of its strings in their order."""
    items: list[Item] = [*protocol.design.items()]
    if not (isinstance(protocol.design, StringList) and protocol.design.reorder):
        return [items for _ in protocol.conditions]
    showings = {cells: _reorderings(cells, chance) for cells in dict.fromkeys(items)}
    return [[next(showings[cells]) for cells in items] for _ in protocol.conditions]


def _reorderings(cells: Item, chance: Chance) -> Iterator[Item]:
    """Orders of some cells by chance, without end; none comes again before all have come."""
    seen: set[Item] = set()
    all_orders = _count_orders(cells)
    while True:
        order = tuple(chance.shuffled(cells))
        if order not in seen:
            seen.add(order)
            yield order
        if len(seen) == all_orders:
            seen.clear()


def _count_orders(cells: Item) -> int:
    """How many different orders some cells have: n! by the product of k! of equal ones."""
    count = 1
    for place in range(1, len(cells)):
        # Whole at every step: the orders of the first cells, one more each time.
        count = count * (place + 1) // cells[: place + 1].count(cells[place])
    return count


def _practice(protocol: Protocol, conditions: list[Condition], chance: Chance) -> list[Trial]:
    """Trials of the items of practice, and of all conditions, alike."""
    practice, design = protocol.practice, protocol.design
    reorders = isinstance(design, StringList) and design.reorder
    orders = {item: _reorderings(item, chance) for item in practice.items if reorders}
    deck: list[Item] = []
    while practice.items and len(deck) < practice.trials:
        deck += chance.shuffled(practice.items)
    drawn = [
        (next(orders[item]) if reorders else item, condition)
        for item, condition in zip(deck[: practice.trials], cycle(conditions), strict=False)
    ]
    (shown,) = _ordered(protocol, [drawn], chance)
    return [_trial(protocol, item, condition, 0) for item, condition in shown]


def _trial(protocol: Protocol, item: Item, condition: Condition, block: int) -> Trial:
    """Make a trial of an item of the design; it gets its number later."""
    design, tuning = protocol.design, protocol.tuning(condition)
    if isinstance(design, Choice):
        shown = [(design.string, value) for value in item]
        asked = (0, len(design.string))
    else:
        before, after = design.around
        shown = [((*before, *map(int, item), *after), None)]
        asked = (len(before), len(before) + len(item))
    stimuli = Stimuli(
        Stimulus(masks, tuning, protocol.geometry_at(value), value) for masks, value in shown
    )
    return Trial(1, block, condition.name, asked, stimuli)


def _numbered(trials: list[Trial]) -> tuple[Trial, ...]:
    return tuple(structs.replace(trial, number=number) for number, trial in enumerate(trials, 1))
