"""Making of plans: a protocol, a participant and a seed give the same plan on every machine."""

from __future__ import annotations

import re
from itertools import cycle, zip_longest
from typing import TYPE_CHECKING

from msgspec import structs

from vbraille.errors import InputError
from vbraille.sessions.planning.design import Choice, Item, StringList
from vbraille.sessions.planning.nexttrial import varied
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.sequencing import (
    Chance,
    apart,
    balanced_orders,
    sequenced,
    with_catch,
)
from vbraille.sessions.planning.spellings import WrittenText
from vbraille.sessions.planning.stimuli import Stimuli, Trial, check_participant, check_seed, joined
from vbraille.tomlfile import which
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.style import Condition


_Shown = tuple[Item, "Condition"]


def make_plan(
    protocol: Protocol,
    participant: str,
    seed: int,
    order: int | None = None,
    *,
    group: str | None = None,
    texture: float | None = None,
    contrast: float | None = None,
) -> Plan:
    """Make the plan of a session.

    Parameters
    ----------
    protocol
        Protocol that the session follows.
    participant
        Pseudonym of the participant; the last number in it chooses the balanced order.
    seed
        Number that all random choices follow from.
    order
        Number of the balanced order, from 1, if the participant's number should not choose it. A
        number beyond the last order starts again from the first.
    group
        Name of the participant's group, if neither the table of orders nor the participant's
        number should choose it; None or the protocol's own if that has been chosen.
    texture, contrast
        Values that replace the display's own, in conditions that do not give a value.

    Raises
    ------
    InputError
        If an argument cannot be used with this protocol.
    """
    try:
        check_participant(participant)
        check_seed(seed)
        protocol = protocol.assigned(choose_group(protocol, participant, group))
        conditions = _tuned(protocol, {"texture": texture, "contrast": contrast})
    except ValueError as error:
        raise InputError(str(error)) from None
    order = choose_order(protocol, participant, order)
    drawn = f"{protocol.name} {seed} {participant}"
    chance = Chance(drawn)
    try:
        blocks = sequenced(
            protocol.rules,
            protocol.design,
            protocol.levels_of,
            lambda: _blocks(protocol, conditions, order, chance),
            chance,
        )
        # Practice is shuffled separately: the number of its trials does not change the others.
        practice = _practice(protocol, conditions, Chance(f"{drawn} practice"))
    except ValueError as error:
        raise InputError(f"{protocol.name} {error}") from None
    trials = [
        _trial(protocol, item, condition, block)
        for block, shown in enumerate(blocks, 1)
        for item, condition in shown
    ]
    if protocol.design.catch is not None:
        trials = with_catch(trials, protocol.design.catch, Chance(f"{drawn} catch"))
    return Plan(
        protocol=protocol.name,
        participant=participant,
        seed=seed,
        order=order,
        group=protocol.group,
        analysis=protocol.planned_analysis,
        practice=_numbered(practice),
        trials=_numbered(trials),
    )


def check_plan(protocol: Protocol, plan: Plan) -> None:
    """Check that a plan is what the protocol, the participant and the seed make.

    Cells of texts are taken from the plan, since liblouis may have other tables than it had.

    Raises
    ------
    InputError
        If the plan was altered; the sentence says where.
    """
    trials = (*plan.practice, *plan.trials)
    cells = {
        (first.text, first.table): joined(trial.stimuli)
        for trial in trials
        if (first := trial.stimuli[0]).text and first.table
    }
    protocol = structs.replace(protocol, cells=cells)
    try:
        again = make_plan(
            protocol,
            plan.participant,
            plan.seed,
            plan.order or None,
            group=plan.group or None,
            texture=_own_tuning(protocol, plan, "texture"),
            contrast=_own_tuning(protocol, plan, "contrast"),
        )
        if said := _difference(plan, again):
            raise ValueError(said)
    except (InputError, ValueError) as error:
        raise InputError(
            f"the plan of {plan.participant} for {protocol.name} is not what seed {plan.seed} "
            f"makes: {error}; put it back as it was"
        ) from None


def _difference(plan: Plan, again: Plan) -> str:
    """Say where a plan differs from the one that was made again; empty if it does not."""
    for name in ("protocol", "group", "order", "analysis"):
        if (kept := getattr(plan, name)) != (made := getattr(again, name)):
            return f"{name} is {kept!r}, and must be {made!r}"
    for name, trials, made in (
        ("practice trial", plan.practice, again.practice),
        ("trial", plan.trials, again.trials),
    ):
        for number, (kept, wanted) in enumerate(zip_longest(trials, made), 1):
            if kept is None or wanted is None:
                return f"{name} {number} is {'missing' if kept is None else 'one too many'}"
            for field in wanted.__struct_fields__:
                if getattr(kept, field) != getattr(wanted, field):
                    return f"{name} {number} differs in its {field}"
    return ""


def _own_tuning(protocol: Protocol, plan: Plan, name: str) -> float | None:
    """Texture or contrast that was given for the session instead of the display's; else None."""
    free = [condition.name for condition in protocol.conditions if name not in condition.changes]
    if name == varied(protocol):
        return None
    for trial in (*plan.trials, *plan.practice):
        if trial.condition in free:
            value = getattr(trial.stimuli[0].tuning, name)
            return None if value == getattr(protocol.style.tuning, name) else value
    return None


def _tuned(protocol: Protocol, given: dict[str, float | None]) -> list[Condition]:
    """Conditions of a protocol, with the given values where a condition has none of its own."""
    given = {name: float(value) for name, value in given.items() if value is not None}
    for name in given:
        if name == varied(protocol):
            what = "procedure" if protocol.adaptive else "design"
            raise ValueError(
                f"the {what} of {protocol.name} chooses {name}; leave {setting(name)} out"
            )
        if all(name in condition.changes for condition in protocol.conditions):
            raise ValueError(
                f"every condition of {protocol.name} has its own {name}; leave {setting(name)} out"
            )
    return [
        structs.replace(c, **(given | {n: v for n, v in c.changes.items() if n in given}))
        for c in protocol.conditions
    ]


def _blocks(
    protocol: Protocol, conditions: list[Condition], order: int, chance: Chance
) -> list[list[_Shown]]:
    """Items and conditions of each block, not yet shuffled."""
    items = _items(protocol, chance)
    if protocol.design.blocks == "conditions":
        places = list(range(len(conditions)))
        if protocol.order_rows:
            names = [condition.name for condition in conditions]
            places = [names.index(name) for name in protocol.order_rows[order - 1].conditions]
        elif order:
            places = list(balanced_orders(len(conditions))[order - 1])
        elif protocol.block_order == "shuffled":
            places = chance.shuffled(places)
        return [[(item, conditions[place]) for item in items[place]] for place in places]
    blocks: list[list[_Shown]] = [[] for _ in range(protocol.design.blocks)]
    # Items are dealt to the blocks like cards, and each condition goes on where the one before it
    # ended. So two blocks never differ by more than one item, of one condition or of all.
    dealt = cycle(blocks)
    pairs = list(zip(conditions, items, strict=True))
    # Where an order is searched for, each deal is to be another.
    for condition, shown in chance.shuffled(pairs) if protocol.rules.searched else pairs:
        for item in chance.shuffled(shown):
            next(dealt).append((item, condition))
    return blocks


def _items(protocol: Protocol, chance: Chance) -> list[list[Item]]:
    """Items of each condition; if the design reorders strings, their cells are shuffled."""
    items: list[Item] = [*protocol.design.items()]
    if not (isinstance(protocol.design, StringList) and protocol.design.reorder):
        return [items for _ in protocol.conditions]
    showings = {cells: _reorderings(cells, chance) for cells in dict.fromkeys(items)}
    return [[next(showings[cells]) for cells in items] for _ in protocol.conditions]


def _reorderings(cells: Item, chance: Chance) -> Iterator[Item]:
    """Endless random orders of some cells; no order returns before all others have come."""
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
    """Number of different orders of some cells: n! divided by k! for each k equal cells."""
    count = 1
    for place in range(1, len(cells)):
        # Each step counts the orders of one cell more, so that the division leaves no remainder.
        count = count * (place + 1) // cells[: place + 1].count(cells[place])
    return count


def _practice(protocol: Protocol, conditions: list[Condition], chance: Chance) -> list[Trial]:
    """Practice trials, in which each item, and each condition, is used about equally often."""
    practice, design = protocol.practice, protocol.design
    reorders = isinstance(design, StringList) and design.reorder
    items = practice.items(design)
    orders = {item: _reorderings(item, chance) for item in items if reorders}
    deck: list[Item] = []
    while items and len(deck) < practice.trials:
        deck += chance.shuffled(items)
    drawn = [
        (next(orders[item]) if reorders else item, condition)
        for item, condition in zip(deck[: practice.trials], cycle(conditions), strict=False)
    ]
    (shown,) = apart(protocol.rules, design, [drawn], chance)
    return [_trial(protocol, item, condition, 0) for item, condition in shown]


def _trial(protocol: Protocol, item: Item, condition: Condition, block: int) -> Trial:
    """Make a trial that shows an item of the design; the trial gets its number later."""
    design = protocol.design
    if isinstance(design, Choice):
        shown = [(design.string, value) for value in item]
        asked = (0, len(design.string))
    else:
        before, after = design.around
        text = isinstance(item, WrittenText)
        shown = [(item if text else (*before, *map(int, item), *after), None)]
        asked = (len(before), len(before) + len(item))
    stimuli = Stimuli(protocol.shown(condition, masks, value) for masks, value in shown)
    if protocol.passages:
        stimuli = protocol.broken(stimuli[0])
        asked = (0, min(len(stimulus.masks) for stimulus in stimuli))
        return Trial(1, block, condition.name, asked, stimuli)
    if stimuli[0].text is not None or stimuli[0].picture is not None:
        asked = (0, len(stimuli[0].masks))
    return Trial(1, block, condition.name, asked, stimuli)


def _numbered(trials: list[Trial]) -> tuple[Trial, ...]:
    return tuple(structs.replace(trial, number=number) for number, trial in enumerate(trials, 1))


def choose_group(protocol: Protocol, participant: str, group: str | None) -> str:
    """Name of the participant's group; empty if the protocol has no groups.

    Parameters
    ----------
    protocol, participant
        The protocol, and the participant's pseudonym, whose last number chooses the group if
        nothing else does.
    group
        Group that was asked for; None for that of the table of orders, or of the number.

    Raises
    ------
    InputError
        If there is no such group, the table gives another, or there is nothing to go by.
    """
    groups = protocol.groups
    if group is None and protocol.group:
        return protocol.group
    if not groups:
        if group:
            raise InputError(f"{protocol.name} has no groups; leave {setting('group')} out")
        return ""
    if group is not None and group not in groups:
        raise InputError(f"there is no group {group!r}{which(group, groups)}")
    told = next((row.group for row in protocol.order_rows if row.participant == participant), None)
    if told is not None:
        if group not in (None, told):
            raise InputError(
                f"the table of orders has {participant} in the group {told}; leave "
                f"{setting('group')} out"
            )
        return told
    if group is not None:
        return group
    return groups[(_number(participant, "group", "NAME") - 1) % len(groups)]


def choose_order(protocol: Protocol, participant: str, order: int | None) -> int:
    """Number of the balanced order or row of the table, from 1; 0 if there is only one order.

    Raises
    ------
    InputError
        If an order is asked for that there is not, or there is nothing to go by.
    """
    if protocol.order_rows:
        return _row(protocol, participant, order)
    if not protocol.balanced:
        if order is not None:
            raise InputError(
                f"{protocol.name} has no balanced orders; leave {setting('order')} out"
            )
        return 0
    if order is None:
        number = _number(participant, "order", "N")
        # Groups take turns, so that each of them has all orders.
        order = (number - 1) // max(1, len(protocol.groups)) + 1
    elif order < 1:
        raise InputError(f"order is {order}; it must be 1 or more")
    return (order - 1) % len(balanced_orders(len(protocol.conditions))) + 1


def _row(protocol: Protocol, participant: str, order: int | None) -> int:
    rows = protocol.order_rows
    if order is not None:
        if not 1 <= order <= len(rows):
            raise InputError(f"order is {order}; it must be 1 to {len(rows)}, a row of the table")
        return order
    names = [row.participant for row in rows]
    if participant not in names:
        raise InputError(
            f"the table of orders of {protocol.name} has no participant "
            f"{participant!r}{which(participant, names)}; or give {setting('order')} N, a row"
        )
    return names.index(participant) + 1


def _number(participant: str, what: str, give: str) -> int:
    """Last number in a pseudonym, by which the group or the order goes."""
    numbers = re.findall("[0-9]+", participant)
    if not numbers:
        whose = "order of the conditions" if what == "order" else "group"
        raise InputError(
            f"the {whose} goes by the participant's number, and {participant} "
            f"has none; give {setting(what)} {give}, or a participant such as P07"
        )
    return int(numbers[-1])
