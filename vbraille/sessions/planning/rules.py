"""Check of a finished plan against the rules of its design, whatever way it was made."""

from __future__ import annotations

from collections import Counter
from itertools import groupby, pairwise, permutations, product
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.sessions.planning.appearance import TUNED
from vbraille.sessions.planning.chance import balanced_orders
from vbraille.sessions.planning.design import Choice, Combinations, Item
from vbraille.sessions.planning.knobs import KNOBS
from vbraille.sessions.planning.orderrules import check_catch, check_running
from vbraille.sessions.planning.practice import name_item

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial


def is_balanced(protocol: Protocol) -> bool:
    """Whether participants differ in the order of the conditions."""
    design = protocol.design
    balanced = design.blocks == "conditions" and protocol.block_order in ("balanced", None)
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
        protocol = protocol.assigned(plan.group)
        tested = [trial for trial in plan.trials if not trial.catch]
        practised = set(map(protocol.design.content, protocol.practice.items))
        if len(plan.practice) != protocol.practice.trials:
            raise ValueError(
                f"{len(plan.practice)} trials are practice, and {protocol.practice.trials} must be"
            )
        for trials, shows in ((plan.practice, practised), (plan.trials, wanted)):
            for number, trial in enumerate(trials, 1):
                about = f"trial {number} of {'practice' if trials is plan.practice else 'all'}"
                if trial.number != number:
                    raise ValueError(f"{about} has the number {trial.number}")
                problem = "" if trial.catch else _problem_of_trial(protocol, trial, shows)
                if problem:
                    raise ValueError(f"{about} {problem}")
        _check_practice(protocol, plan)
        _check_counts(protocol, tested, wanted)
        _check_tuning(protocol, plan)
        _check_blocks(protocol, plan, tested)
        if protocol.rules.never_twice_running:
            _check_neighbours(protocol, plan.practice)
            _check_neighbours(protocol, tested)
        check_catch(protocol, plan.trials)
        check_running(protocol, tested)
    except ValueError as error:
        raise InputError(
            f"the plan of {plan.participant} for {protocol.name} breaks a rule: {error}; "
            f"put it back as it was"
        ) from None


def _check_practice(protocol: Protocol, plan: Plan) -> None:
    """Check that practice shows no item of the test."""
    shown = {_content(protocol, trial) for trial in plan.trials if not trial.catch}
    for trial in plan.practice:
        if _content(protocol, trial) in shown:
            raise ValueError(f"practice trial {trial.number} shows what the test shows")


def _check_neighbours(protocol: Protocol, trials: Sequence[Trial]) -> None:
    """Check that no two neighbouring trials show the same."""
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
    return protocol.design.content(trial.item)


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
    condition = next((c for c in protocol.conditions if c.name == trial.condition), None)
    if condition is None:
        return ""  # which `_check_tuning` says
    for stimulus in trial.stimuli:
        planned = protocol.shown(condition, stimulus.masks, stimulus.value)
        if stimulus.geometry != planned.geometry:
            return "has other distances than the protocol's"
        if stimulus.mapping != planned.mapping:
            return "has another mapping than the protocol's"
        if stimulus.table != protocol.table_of(condition):
            return "has another table than the protocol's"
    return ""


def _check_tuning(protocol: Protocol, plan: Plan) -> None:
    """Check that each condition has one tuning, which has the values that the protocol gives.

    What two stimuli are compared by has its own values.
    """
    compared = "cycles" if protocol.parameter == "texture_cycles" else protocol.parameter
    tunings = {condition.name: set[tuple[float, ...]]() for condition in protocol.conditions}
    names = [name for name in TUNED if name != compared]
    for trial in (*plan.practice, *plan.trials):
        if trial.condition not in tunings:
            raise ValueError(f"trial {trial.number} is of a condition {trial.condition!r}")
        for stimulus in trial.stimuli:
            tunings[trial.condition].add(tuple(getattr(stimulus.tuning, n) for n in names))
            if compared in TUNED and getattr(stimulus.tuning, compared) != stimulus.value:
                raise ValueError(f"trial {trial.number} has another {protocol.parameter}")
    for condition in protocol.conditions:
        if len(tunings[condition.name]) != 1:
            raise ValueError(f"condition {condition.name} has not one texture and contrast")
        (tuning,) = tunings[condition.name]
        planned = protocol.style_of(condition).tuning
        for name, value in zip(names, tuning, strict=True):
            if name in (*condition.given, "cycles") and value != getattr(planned, name):
                raise ValueError(f"condition {condition.name} has another {name}")


def _check_blocks(protocol: Protocol, plan: Plan, tested: Sequence[Trial]) -> None:
    blocks = [block for block, _ in groupby(plan.trials, key=lambda trial: trial.block)]
    planned = protocol.design.blocks
    wanted = len(protocol.conditions) if planned == "conditions" else planned
    if blocks != list(range(1, wanted + 1)):
        raise ValueError(f"its blocks are not 1 to {wanted}")
    if any(not trial.practice for trial in plan.practice):
        raise ValueError("a practice trial is in a block")
    if plan.order and not (is_balanced(protocol) or protocol.order_rows):
        raise ValueError(f"it has the balanced order {plan.order}, and there is none")
    if planned == "conditions":
        _check_order(protocol, plan)
        return
    for name in (*(condition.name for condition in protocol.conditions), None):
        shares = [
            sum(trial.block == block and name in (trial.condition, None) for trial in tested)
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
    if protocol.order_rows:
        if not 1 <= plan.order <= len(protocol.order_rows):
            raise ValueError(f"it has the order {plan.order} of {len(protocol.order_rows)}")
        if tuple(shown) != protocol.order_rows[plan.order - 1].conditions:
            raise ValueError(f"its conditions are not in the order of the table's row {plan.order}")
    if protocol.block_order == "listed" and shown != listed:
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


def _check_counts(protocol: Protocol, tested: Sequence[Trial], wanted: Counter[Item]) -> None:
    """Check how often each condition shows each item and each letter."""
    for condition in protocol.conditions:
        trials = [trial for trial in tested if trial.condition == condition.name]
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
        return " and ".join(f"{v:g}{KNOBS[protocol.design.parameter].unit}" for v in item)
    return name_item(item)
