"""The plan of a session: the same for the same protocol, participant, seed and session."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache, partial
from itertools import cycle, islice
from random import Random

import numpy as np
from msgspec import Struct, structs

from vbraille.braille.cells import Cells, dots_of
from vbraille.braille.spelling import to_braille
from vbraille.errors import InputError
from vbraille.sessions.planning.design import Catch, Setting
from vbraille.sessions.planning.order import Limit, Placed, balanced_orders, ordered
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.trial import BLANK, Trial
from vbraille.toml import which

PSEUDONYM = "[A-Za-z0-9][A-Za-z0-9_-]{0,31}"

# How long people take, as in the source: 17 s for a string of five letters and its answer.
READING_S, ANSWERING_S, BREAK_S = 2.2, 4.0, 120.0


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
    session
        Which session of the participant it is, from 1.
    """

    participant: str
    seed: int
    order: int
    group: str
    trials: tuple[Trial, ...]
    session: int = 1


def make_plan(
    protocol: Protocol,
    participant: str,
    seed: int,
    order: int | None = None,
    *,
    session: int = 1,
    group: str | None = None,
) -> Plan:
    """Plan a session.

    Parameters
    ----------
    order
        Which of the balanced orders it has, from 1; None goes by the number in the pseudonym.
    session
        Which session of the participant it is, so that a second one has another order.
    group
        Name of the group; None goes by the number in the pseudonym, or by the table of orders.

    Raises
    ------
    InputError
        If no order keeps the rules, or nothing says which balanced order is wanted.
    """
    check_participant(participant)
    group = _choose_group(protocol, participant, group)
    protocol = protocol.of_group(group)
    order = _choose_order(protocol, participant, order, session)
    drawn = f"{protocol.name} {participant} {seed}" + (f" {session}" if session > 1 else "")
    random = Random(drawn)
    blocks = _deal(protocol, participant, order, random)
    try:
        quarters = protocol.rules.balanced_quarters
        blocks = ordered(blocks, _limits(protocol), random, quarters=quarters)
        places = [(placed, block) for block, own in enumerate(blocks, 1) for placed in own]
        trials = _trials(protocol, places, random)
        if protocol.design.catch is not None:
            trials = _with_catch(trials, protocol.design.catch, random)
        # Practice has chance of its own, so that the number of its trials changes nothing else.
        practice = _practice(protocol, Random(f"{drawn} practice"))
    except ValueError as error:
        raise InputError(f"{protocol.name}: {error}") from None
    numbered = [
        structs.replace(trial, number=number)
        for part in (practice, trials)
        for number, trial in enumerate(part, 1)
    ]
    return Plan(participant, seed, order, group, tuple(numbered), session)


def check_participant(participant: str) -> None:
    """Refuse a pseudonym that files and tables cannot have.

    Raises
    ------
    InputError
        If it has other characters than letters, digits, hyphens and underscores.
    """
    if not re.fullmatch(PSEUDONYM, participant):
        raise InputError(f"participant is {participant!r}; give a pseudonym such as P07")


def _choose_group(protocol: Protocol, participant: str, group: str | None) -> str:
    """Return the name of the group; empty if there are none."""
    groups = protocol.groups
    if group and group not in groups:
        raise InputError(f"unknown group {group!r}{which(group, groups)}")
    if group or not groups:
        return group or ""
    if participant in protocol.orders:
        return protocol.orders[participant].group
    return groups[(_number(participant) - 1) % len(groups)]


def _number(participant: str) -> int:
    """Return the last number in a pseudonym, which chooses the group and the order."""
    numbers = re.findall(r"\d+", participant)
    if not numbers:
        raise InputError(f"{participant} has no number to choose the order by; give an order")
    return int(numbers[-1])


def _choose_order(protocol: Protocol, participant: str, order: int | None, session: int) -> int:
    """Return the number of the balanced order, from 1; 0 if there are none."""
    if protocol.design.order != "balanced":
        return 0
    if order is None:  # groups take turns, so that each of them has all orders
        order = (_number(participant) - 1) // max(1, len(protocol.groups)) + session
    return (order - 1) % len(balanced_orders(len(protocol.conditions))) + 1


def _deal(protocol: Protocol, participant: str, order: int, random: Random) -> list[list[Placed]]:
    """Return the items and conditions of each block, not in order yet."""
    design, names = protocol.design, [condition.name for condition in protocol.conditions]
    shown = protocol.items_shown
    items = dict.fromkeys(names, shown * design.repeats)
    if design.counterbalanced:
        # Each item is in one condition, which is the next one for the next participant.
        shift, count = _number(participant), len(names)
        for n, name in enumerate(names):
            items[name] = shown[(n + shift) % count :: count] * design.repeats
    if design.blocks == "conditions":
        if design.orders:
            if participant not in protocol.orders:
                raise InputError(f"the file of orders has no row for {participant}; add one")
            names = protocol.orders[participant].conditions
        elif order:
            names = [names[n] for n in balanced_orders(len(names))[order - 1]]
        elif design.order == "shuffled":
            random.shuffle(names)
        return [[(item, name) for item in items[name]] for name in names]
    # Dealt like cards, so that two blocks differ by one trial at most, of a condition and in all.
    cards = [
        (item, name) for name in names for item in random.sample(items[name], len(items[name]))
    ]
    return [cards[block :: design.blocks] for block in range(design.blocks)]


def _limits(protocol: Protocol) -> list[Limit]:
    """Return how many neighbours may be alike, and in what."""
    rules, limits = protocol.rules, []
    reorders = getattr(protocol.design, "reorder", False)
    levels = {
        each.name: protocol.levels(each.name, "") | {"condition": each.name}
        for each in protocol.conditions
    }

    @cache
    def level(name: str, shown: Placed) -> str:
        """Return the condition of a trial, its level of a factor, or its cell of a column."""
        item, condition = shown
        return (protocol.columns.get(item, {}) | levels[condition]).get(name, "")

    if rules.never_twice_running:
        limits.append(Limit(lambda shown: "".join(sorted(shown[0])) if reorders else shown[0], 1))
    for name, most in rules.at_most_running.items():
        limits.append(Limit(partial(level, name), most))
    return limits


def _practice(protocol: Protocol, random: Random) -> list[Trial]:
    """Return the trials of practice; all that there may be, if a criterion ends it."""
    practice = protocol.practice
    both = zip(cycle(protocol.practised), cycle(protocol.conditions), strict=False)
    shown = [(item, condition.name) for item, condition in islice(both, practice.most)]
    if practice.order == "shuffled":
        (shown,) = ordered([shown], _limits(protocol), random, quarters=False)
    return _trials(protocol, [(placed, 0) for placed in shown], random)


def _trials(protocol: Protocol, places: list[tuple[Placed, int]], random: Random) -> list[Trial]:
    """Return trials of items in conditions and blocks; they get their numbers later."""
    setting = Setting(protocol.masks, protocol.room, random)
    looks = {each.name: each.over(protocol.display) for each in protocol.conditions}
    gap_s, found = protocol.trial.gap_s, []
    for (item, condition), block in places:
        stimuli = protocol.design.stimuli(item, looks[condition], setting)
        gap = round(random.uniform(*gap_s), 3) if isinstance(gap_s, tuple) else gap_s
        columns = protocol.columns.get(item, {})
        found.append(Trial(block == 0, 0, block, condition, item, stimuli, gap, columns=columns))
    return found


def _with_catch(trials: list[Trial], catch: Catch, random: Random) -> list[Trial]:
    """Put a catch trial after a random trial of each stretch; so none is the first."""
    found: list[Trial] = []
    between = catch.every - 1
    for first in range(0, len(trials), between):
        part = trials[first : first + between]
        if len(part) == between:
            after = random.randrange(between) + 1
            caught = structs.replace(part[after - 1], catch=catch.show)
            if catch.show == "blank":
                blank = [
                    structs.replace(each, cells=BLANK * len(each.cells), text="")
                    for each in caught.stimuli
                ]
                caught = structs.replace(caught, stimuli=tuple(blank), columns={})
            part.insert(after, caught)
        found += part
    return found


def length_s(protocol: Protocol, plan: Plan) -> float:
    """Estimate how long a session takes, with people who read as in the source.

    What is felt for a time that the protocol sets is counted at its whole length.
    """
    pace, session = protocol.trial, protocol.session
    seconds, tested, blocks = 0.0, 0, 1
    for trial in plan.trials:
        cells = sum(len(each.masks(0)) for each in trial.stimuli)
        felt_s = pace.exposure_s or READING_S * cells or BREAK_S
        if pace.exposure_s and trial.values:
            felt_s *= len(trial.stimuli)
        seconds += trial.gap_s + felt_s + min(ANSWERING_S, pace.answer_s or ANSWERING_S)
        tested += not trial.practice
        blocks = max(blocks, trial.block)
    within = (tested - 1) // session.break_every if session.break_every else 0
    seconds += max(within, blocks - 1) * (session.break_s or BREAK_S)
    return min(seconds, session.limit_s or seconds)


def plan_lines(protocol: Protocol, plan: Plan) -> Iterator[str]:
    """Say a plan, a trial in each line."""
    tested = [trial for trial in plan.trials if not trial.practice]
    who = f"participant {plan.participant}, seed {plan.seed}"
    yield f"protocol: {protocol.name}, {len(tested)} trials, {who}"
    if plan.group:
        yield f"group: {plan.group}"
    yield f"analysis: {protocol.analysis.said()}"
    minutes, felt_s = max(1, round(length_s(protocol, plan) / 60)), protocol.trial.exposure_s
    read = (
        f"with trials of up to {felt_s:g} s" if felt_s else "if people read as those of the source"
    )
    yield f"length: about {minutes} min, {read}"
    if protocol.procedure is not None:
        yield "values: chosen by the answers; those of the plan are not shown"
    block = 0
    for trial in plan.trials:
        if trial.block != block:
            block = trial.block
            yield f"block: {block}"
        yield f"{trial.name}: {', '.join(_described(trial))}"


def to_brf(protocol: Protocol, plan: Plan) -> str:
    """Write the strings of a plan in ASCII braille, each in a line, practice left out.

    Raises
    ------
    InputError
        If what is shown is no string, or has dots 7 or 8.
    """
    strings = [each for trial in plan.trials if not trial.practice for each in trial.stimuli]
    if any(each.value is not None for each in strings):
        raise InputError(f"{protocol.name} compares values, which cannot be embossed")
    if any(each.picture for each in strings):
        raise InputError(f"{protocol.name} shows pictures, which are no braille")
    try:
        lines = [Cells.bare(np.array(each.masks(0), np.uint8)).to_brf() for each in strings]
    except ValueError as error:
        raise InputError(f"{protocol.name}: {error}") from None
    return "".join(f"{line}\n" for line in lines)


def _described(trial: Trial) -> Iterator[str]:
    """Say what a trial shows."""
    first = trial.stimuli[0]
    yield from filter(None, (trial.condition, trial.catch and f"catch {trial.catch}", first.text))
    if trial.values or first.picture:
        yield first.picture or " and ".join(f"{value:g}" for value in trial.values)
    else:
        yield " / ".join(to_braille(each.masks(0)) for each in trial.stimuli)
        yield "dots " + " / ".join(_dots(each.masks(0)) for each in trial.stimuli)


def _dots(masks: list[int]) -> str:
    return " ".join("-".join(map(str, dots_of(mask))) or "0" for mask in masks)
