"""The plan of a session: the same for the same protocol, participant and seed."""

from __future__ import annotations

import re
from functools import partial
from itertools import cycle
from random import Random

from msgspec import Struct, structs

from vbraille.braille.cells import UNICODE_BLANK
from vbraille.errors import InputError
from vbraille.sessions.planning.design import Catch, practice_items
from vbraille.sessions.planning.order import Limit, balanced_orders, ordered
from vbraille.sessions.planning.protocol import Condition, Protocol
from vbraille.sessions.planning.trial import Trial

_Shown = tuple[str, Condition]  # an item, and the condition in which it is shown


class Plan(Struct, frozen=True):
    """All trials of a session.

    Parameters
    ----------
    participant, seed
        Pseudonym, and the number that all chance follows from.
    order
        Which of the balanced orders of conditions it has, from 1; 0 if there are none.
    group
        Group of the participant; empty if there are none.
    trials
        Practice, and then the trials of the blocks.
    """

    participant: str
    seed: int
    order: int
    group: str
    trials: tuple[Trial, ...]


def make_plan(protocol: Protocol, participant: str, seed: int, order: int | None = None) -> Plan:
    """Plan a session.

    Parameters
    ----------
    order
        Which of the balanced orders it has, from 1; None goes by the number in the pseudonym.

    Raises
    ------
    InputError
        If no order keeps the rules, or nothing says which balanced order is wanted.
    """
    drawn = f"{protocol.name} {participant} {seed}"
    group = _choose_group(protocol, participant)
    protocol = protocol.of_group(group)
    order = _choose_order(protocol, participant, order)
    random = Random(drawn)
    try:
        blocks = ordered(_deal(protocol, order, random), *_rules(protocol), random)
    except ValueError as error:
        raise InputError(f"{protocol.name}: {error}") from None
    trials = [
        _trial(protocol, item, condition, block, random)
        for block, shown in enumerate(blocks, 1)
        for item, condition in shown
    ]
    if protocol.design.catch is not None:
        trials = _with_catch(trials, protocol.design.catch, random)
    # Practice has chance of its own, so that another number of its trials changes nothing else.
    practice = _practice(protocol, Random(f"{drawn} practice"))
    return Plan(participant, seed, order, group, tuple(_numbered(practice) + _numbered(trials)))


def _choose_group(protocol: Protocol, participant: str) -> str:
    """Return the group that the participant's number gives; empty if there are none."""
    groups = protocol.groups
    return groups[(_number(participant) - 1) % len(groups)] if groups else ""


def _number(participant: str) -> int:
    """Return the last number in a pseudonym, which chooses the group and the order."""
    numbers = re.findall(r"\d+", participant)
    if not numbers:
        raise InputError(f"{participant} has no number to choose the order by; give --order")
    return int(numbers[-1])


def _choose_order(protocol: Protocol, participant: str, order: int | None) -> int:
    """Return the number of the balanced order, from 1; 0 if there are none."""
    if protocol.design.order != "balanced":
        return 0
    if order is None:  # groups take turns, so that each of them has all orders
        order = (_number(participant) - 1) // max(1, len(protocol.groups)) + 1
    return (order - 1) % len(balanced_orders(len(protocol.conditions))) + 1


def _deal(protocol: Protocol, order: int, random: Random) -> list[list[_Shown]]:
    """Return the items and conditions of each block, not in order yet."""
    design, conditions = protocol.design, list(protocol.conditions)
    items = design.items(protocol.masks) * design.repeats
    if design.blocks == "conditions":
        if order:
            conditions = [conditions[n] for n in balanced_orders(len(conditions))[order - 1]]
        elif design.order == "shuffled":
            random.shuffle(conditions)
        return [[(item, condition) for item in items] for condition in conditions]
    blocks: list[list[_Shown]] = [[] for _ in range(design.blocks)]
    # Dealt like cards, so that two blocks differ by one trial at most, of a condition and in all.
    into = cycle(blocks)
    for condition in conditions:
        for item in random.sample(items, len(items)):
            next(into).append((item, condition))
    return blocks


def _rules(protocol: Protocol) -> tuple[list[Limit], object]:
    """Return the limits of the rules, and the level that quarters share evenly, if any."""
    rules, limits = protocol.rules, []
    if rules.never_twice_running:
        limits.append(Limit(lambda shown: shown[0], 1))
    for name, most in rules.at_most_running.items():
        limits.append(Limit(partial(_level, protocol, name), most))
    return limits, (lambda shown: shown[1].name) if rules.balanced_quarters else None


def _level(protocol: Protocol, name: str, shown: _Shown) -> str:
    """Return the condition of a trial, or its level of a factor."""
    condition = shown[1].name
    return condition if name == "condition" else protocol.levels(condition, "")[name]


def _practice(protocol: Protocol, random: Random) -> list[Trial]:
    """Return the trials of practice; all that there may be, if a criterion ends it."""
    practice = protocol.practice
    count = practice.until.most if practice.until else practice.trials
    items = practice_items(practice.strings, protocol.design, protocol.masks)
    shown = list(zip((next(items) for _ in range(count)), cycle(protocol.conditions)))
    limits, _ = _rules(protocol)
    (shown,) = ordered([shown], limits, None, random)
    return [_trial(protocol, item, condition, 0, random) for item, condition in shown]


def _trial(
    protocol: Protocol, item: str, condition: Condition, block: int, random: Random
) -> Trial:
    """Return a trial, which gets its number later."""
    look = condition.over(protocol.display)
    stimuli = protocol.design.stimuli(item, look, protocol.masks, random)
    gap_s = protocol.trial.gap_s
    if isinstance(gap_s, tuple):
        gap_s = round(random.uniform(*gap_s), 3)
    return Trial(block == 0, 0, block, condition.name, item, stimuli, gap_s)


def _with_catch(trials: list[Trial], catch: Catch, random: Random) -> list[Trial]:
    """Put a catch trial after a random trial of each stretch; so none is the first."""
    found: list[Trial] = []
    stretch = catch.every - 1
    for first in range(0, len(trials), stretch):
        part = trials[first : first + stretch]
        after = random.randrange(len(part)) + 1
        found += [*part[:after], _caught(part[after - 1], catch), *part[after:]]
    return found


def _caught(trial: Trial, catch: Catch) -> Trial:
    """Return the catch trial that comes after a trial."""
    stimuli = trial.stimuli
    if catch.show == "blank":
        stimuli = tuple(
            structs.replace(each, cells=chr(UNICODE_BLANK) * len(each.cells)) for each in stimuli
        )
    return structs.replace(trial, stimuli=stimuli, catch=catch.show)


def _numbered(trials: list[Trial]) -> list[Trial]:
    return [structs.replace(trial, number=number) for number, trial in enumerate(trials, 1)]
