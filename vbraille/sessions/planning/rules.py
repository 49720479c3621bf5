"""Check of a finished plan against the rules of its design, whatever way it was made."""

from __future__ import annotations

from collections import Counter
from itertools import groupby, pairwise, permutations, product
from typing import TYPE_CHECKING

from vbraille.braille.spelling import to_braille
from vbraille.errors import InputError
from vbraille.sessions.planning.chance import balanced_orders
from vbraille.sessions.planning.design import Choice, Combinations, Item

if TYPE_CHECKING:
    from collections.abc import Collection

    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial


def is_balanced(protocol: Protocol) -> bool:
    """Whether participants differ in the order of the conditions."""
    design = protocol.design
    balanced = design.blocks == "conditions" and design.order in ("balanced", None)
    return balanced and len(protocol.conditions) > 1


def check_plan(protocol: Protocol, plan: Plan) -> None:
    """Check a plan against its protocol, however it was made.

    Raises
    ------
    InputError
        If the plan breaks a rule; the message says which.
    """
    wanted = _wanted(protocol)
    try:
        if plan.protocol != protocol.name:
            raise ValueError(f"it is of the protocol {plan.protocol}")
        practised = _practised(protocol) if plan.version > 1 else set(wanted)
        if len(plan.practice) != protocol.practice.trials:
            raise ValueError(
                f"{len(plan.practice)} trials are practice, and {protocol.practice.trials} must be"
            )
        for trials, shows in ((plan.practice, practised), (plan.trials, wanted)):
            for number, trial in enumerate(trials, 1):
                about = f"trial {number} of {'practice' if trials is plan.practice else 'all'}"
                if trial.number != number:
                    raise ValueError(f"{about} has the number {trial.number}")
                problem = _problem_of_trial(protocol, trial, shows)
                if problem:
                    raise ValueError(f"{about} {problem}")
        if plan.version > 1:
            _check_practice(protocol, plan)
        _check_counts(protocol, plan, wanted)
        _check_tuning(protocol, plan)
        _check_blocks(protocol, plan)
        if protocol.rules.never_twice_running:
            _check_neighbours(protocol, plan)
    except ValueError as error:
        raise InputError(
            f"the plan of {plan.participant} for {protocol.name} breaks a rule: {error}; "
            f"put it back as it was"
        ) from None


def _practised(protocol: Protocol) -> set[Item]:
    """Items that practice may show."""
    return set(map(protocol.design.content, protocol.practice.items))


def _check_practice(protocol: Protocol, plan: Plan) -> None:
    """Check that practice shows no item of the test."""
    shown = {_content(protocol, trial) for trial in plan.trials}
    for trial in plan.practice:
        if _content(protocol, trial) in shown:
            raise ValueError(f"practice trial {trial.number} shows what the test shows")


def _check_neighbours(protocol: Protocol, plan: Plan) -> None:
    """Check that no two neighbouring trials show the same."""
    for trials in (plan.practice, plan.trials):
        for trial, following in pairwise(trials):
            if _content(protocol, trial) == _content(protocol, following):
                raise ValueError(
                    f"{'practice ' if trial.practice else ''}trials {trial.number} and "
                    f"{following.number} show the same"
                )


def _wanted(protocol: Protocol) -> Counter[Item]:
    """How often each condition must show each item."""
    design = protocol.design
    if isinstance(design, Combinations):
        things = product(design.characters, repeat=design.length)
    elif isinstance(design, Choice):
        things = design.pairs()
    else:
        things = (tuple(sorted(s)) if design.reorder else s for s in design.strings)
    return Counter({thing: n * design.repeats for thing, n in Counter(things).items()})


def _content(protocol: Protocol, trial: Trial) -> Item:
    """Item that a trial shows, in the form in which `_wanted` counts items."""
    if isinstance(protocol.design, Choice):
        return tuple(stimulus.value or 0.0 for stimulus in trial.stimuli)
    return protocol.design.content(trial.stimuli[0].masks[slice(*trial.asked)])


def _problem_of_trial(protocol: Protocol, trial: Trial, shows: Collection[Item]) -> str:
    """Say what is wrong with a single trial; empty if nothing is."""
    design = protocol.design
    if len(trial.stimuli) != (2 if isinstance(design, Choice) else 1):
        return f"has {len(trial.stimuli)} stimuli"
    alike = len(trial.stimuli) == 2 and trial.stimuli[0] == trial.stimuli[1]
    if alike and not (isinstance(design, Choice) and design.same):
        return "compares two identical stimuli"
    first, stop = trial.asked
    for stimulus in trial.stimuli:
        if (stimulus.masks[:first], stimulus.masks[stop:]) != design.around:
            return "asks for other cells than those between the delimiters"
        if isinstance(design, Choice) and stimulus.masks != design.string:
            return "shows another string than the design's"
    if _content(protocol, trial) not in shows:
        return "shows what is not in the design"
    for stimulus in trial.stimuli:
        if stimulus.geometry != protocol.geometry_at(stimulus.value):
            return "has other distances than the protocol's"
    return ""


def _check_tuning(protocol: Protocol, plan: Plan) -> None:
    """Check that each condition has one tuning, which has the values that the protocol gives."""
    tunings = {condition.name: set() for condition in protocol.conditions}
    for trial in (*plan.practice, *plan.trials):
        if trial.condition not in tunings:
            raise ValueError(f"trial {trial.number} is of a condition {trial.condition!r}")
        tunings[trial.condition].update(stimulus.tuning for stimulus in trial.stimuli)
    for condition in protocol.conditions:
        if len(tunings[condition.name]) != 1:
            raise ValueError(f"condition {condition.name} has not one texture and contrast")
        (tuning,) = tunings[condition.name]
        planned = protocol.tuning(condition)
        for name in (*condition.given, "cycles"):
            if getattr(tuning, name) != getattr(planned, name):
                raise ValueError(f"condition {condition.name} has another {name}")


def _check_blocks(protocol: Protocol, plan: Plan) -> None:
    blocks = [block for block, _ in groupby(plan.trials, key=lambda trial: trial.block)]
    planned = protocol.design.blocks
    wanted = len(protocol.conditions) if planned == "conditions" else planned
    if blocks != list(range(1, wanted + 1)):
        raise ValueError(f"its blocks are not 1 to {wanted}")
    if any(not trial.practice for trial in plan.practice):
        raise ValueError("a practice trial is in a block")
    if plan.order and not is_balanced(protocol):
        raise ValueError(f"it has the balanced order {plan.order}, and there is none")
    if planned == "conditions":
        _check_order(protocol, plan)
        return
    for name in (*(condition.name for condition in protocol.conditions), None):
        shares = [
            sum(trial.block == block and name in (trial.condition, None) for trial in plan.trials)
            for block in blocks
        ]
        if max(shares) - min(shares) > 1:
            raise ValueError(f"{name or 'all'} is not spread evenly over the blocks: {shares}")


def _check_order(protocol: Protocol, plan: Plan) -> None:
    """Check that each block has one condition, and that the blocks are in the right order."""
    listed = [condition.name for condition in protocol.conditions]
    shown = [name for _, name in dict.fromkeys((t.block, t.condition) for t in plan.trials)]
    if sorted(shown) != sorted(listed):
        raise ValueError("its blocks are not of one condition each")
    if protocol.design.order == "listed" and shown != listed:
        raise ValueError("its conditions are not in the order listed")
    if not is_balanced(protocol):
        return
    orders = balanced_orders(len(listed))
    check_balance(orders)
    if not 1 <= plan.order <= len(orders):
        raise ValueError(f"it has the balanced order {plan.order} of {len(orders)}")
    if shown != [listed[place] for place in orders[plan.order - 1]]:
        raise ValueError(f"its conditions are not in the balanced order {plan.order}")


def check_balance(orders: list[tuple[int, ...]]) -> None:
    """Check that orders of conditions are balanced, taken all together.

    Raises
    ------
    ValueError
        If a condition is not equally often in each place, or does not follow each other
        condition equally often.
    """
    every = range(len(orders[0]))
    placed = Counter(place for order in orders for place in enumerate(order))
    if len({placed[place, condition] for place in every for condition in every}) > 1:
        raise ValueError("a condition is not equally often in each place of the balanced orders")
    followed = Counter(pair for order in orders for pair in pairwise(order))
    if len({followed[pair] for pair in permutations(every, 2)}) > 1:
        raise ValueError("a condition does not follow each other one equally often")


def _check_counts(protocol: Protocol, plan: Plan, wanted: Counter[Item]) -> None:
    """Check how often each condition shows each item and each letter."""
    for condition in protocol.conditions:
        trials = [trial for trial in plan.trials if trial.condition == condition.name]
        shown = Counter(_content(protocol, trial) for trial in trials)
        for item, times in wanted.items():
            if shown[item] != times:
                raise ValueError(
                    f"condition {condition.name} shows {_name(protocol, item)} "
                    f"{shown[item]} times, and must {times} times"
                )
        problem = protocol.rules.problem(trial.stimuli[0].masks for trial in trials)
        if problem:
            raise ValueError(f"in condition {condition.name} {problem}")


def _name(protocol: Protocol, item: Item) -> str:
    if isinstance(protocol.design, Choice):
        return " and ".join(f"{value:g} mm" for value in item)
    return to_braille(tuple(map(int, item)))
