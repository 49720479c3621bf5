"""The rules of plans, counted anew: nothing here is the program's own check."""

from collections import Counter
from itertools import groupby, pairwise, permutations, product

from vbraille.sessions.planning.design import Choice, Combinations, name_item
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.sequencing import balanced_orders
from vbraille.sessions.planning.stimuli import KNOBS
from vbraille.sessions.planning.style import TUNED


def broken_rules(protocol, participant, seed):
    """Rules that a plan breaks, by name; none of them should be."""
    plan = make_plan(protocol, participant, seed)
    practised, tested = (
        [_shows(protocol, t) for t in run if not t.catch] for run in (plan.practice, plan.trials)
    )
    problems = []
    runs = [practised, tested]
    if protocol.adaptive and protocol.task == "choice":
        runs.pop()  # the answers choose the values; the plan says which of two comes first
    if any(one == other for run in runs for one, other in pairwise(run)):
        problems.append("twice running")
    if not protocol.pictures and set(practised) & set(tested):  # pictures are learnt first
        problems.append("practice of what is tested")
    if (len(practised), len(plan.trials)) != (protocol.practice.trials, protocol.trials):
        problems.append("trials missing")
    others = [trial for trial in plan.trials if not trial.catch]
    for condition in protocol.conditions:
        of = [
            shows
            for shows, trial in zip(tested, others, strict=True)
            if trial.condition == condition.name
        ]
        if len({of.count(shows) for shows in of}) != 1 or len(of) != protocol.design.trials:
            problems.append("not equally often")
    return problems


def _shows(protocol, trial):
    """Picture, braille asked for, in any order if it is reordered; or the values compared."""
    if protocol.pictures:
        return trial.stimuli[0].picture
    if protocol.task == "choice":
        return tuple(stimulus.value for stimulus in trial.stimuli)
    reorders = getattr(protocol.design, "reorder", False)
    return "".join(sorted(trial.presented)) if reorders else trial.presented


def check_rules(protocol, plan):
    """Check a plan against its protocol, however it was made.

    Raises
    ------
    ValueError
        If the plan breaks a rule; the message says which.
    """
    wanted = _wanted(protocol)
    if plan.protocol != protocol.name:
        raise ValueError(f"it is of the protocol {plan.protocol}")
    protocol = protocol.assigned(plan.group)
    tested = [trial for trial in plan.trials if not trial.catch]
    shown = protocol.practice.items(protocol.design)
    practised = set(map(protocol.design.content, shown))
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


def _check_practice(protocol, plan):
    """Check that practice shows no item of the test, unless it is a picture, which is learnt."""
    if protocol.pictures:
        return
    shown = {_content(protocol, trial) for trial in plan.trials if not trial.catch}
    for trial in plan.practice:
        if _content(protocol, trial) in shown:
            raise ValueError(f"practice trial {trial.number} shows what the test shows")


def _check_neighbours(protocol, trials):
    """Check that no two neighbouring trials show the same."""
    for trial, following in pairwise(trials):
        if _content(protocol, trial) == _content(protocol, following):
            raise ValueError(
                f"{'practice ' if trial.practice else ''}trials {trial.number} and "
                f"{following.number} show the same"
            )


def _wanted(protocol):
    """Count how often each condition must show each item."""
    design = protocol.design
    if isinstance(design, Combinations):
        things = product(design.characters, repeat=design.length)
    elif isinstance(design, Choice):
        things = _arranged(design)
    else:
        things = (tuple(sorted(s)) if design.reorder else s for s in design.strings)
    return Counter({thing: n * design.repeats for thing, n in Counter(things).items()})


def _arranged(design):
    """Values of the stimuli of each trial, counted out by the words of the page."""
    r, values = design.reference, design.values
    if design.form == "single":
        return [(v,) for v in values]
    if design.form == "standard":
        return [(r, v) for v in values]
    if design.form == "one":
        return [t for t in product((r, *values), repeat=design.intervals)
                if t.count(r) == design.intervals - 1]  # fmt: skip
    if design.form == "triangle":
        pairs = [(a, b) for v in values for a, b in ((r, v), (v, r))]
        return [t for a, b in pairs for t in ((a, a, b), (a, b, a), (b, a, a))]
    if design.form == "abx":
        return [(a, b, x) for v in values for a, b in ((r, v), (v, r)) for x in (r, v)]
    others = values if r is None else ()
    pairs = [*permutations(others, 2), *([(r, v) for v in values] if r is not None else ())]
    pairs += [(v, r) for v in values] if r is not None else []
    return [*pairs, *((v, v) for v in values for _ in range(design.same))]


def _content(protocol, trial):
    """Item that a trial shows, in the form in which `_wanted` counts items."""
    if isinstance(protocol.design, Choice):
        return tuple(stimulus.value or 0.0 for stimulus in trial.stimuli)
    return protocol.design.content(trial.item)


def _problem_of_trial(protocol, trial, shows):
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


def _check_tuning(protocol, plan):
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
            if name in (*condition.changes, "cycles") and value != getattr(planned, name):
                raise ValueError(f"condition {condition.name} has another {name}")


def _check_blocks(protocol, plan, tested):
    blocks = [block for block, _ in groupby(plan.trials, key=lambda trial: trial.block)]
    planned = protocol.design.blocks
    wanted = len(protocol.conditions) if planned == "conditions" else planned
    if blocks != list(range(1, wanted + 1)):
        raise ValueError(f"its blocks are not 1 to {wanted}")
    if any(not trial.practice for trial in plan.practice):
        raise ValueError("a practice trial is in a block")
    if plan.order and not (protocol.balanced or protocol.order_rows):
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


def _check_order(protocol, plan):
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
    if not protocol.balanced:
        return
    orders = balanced_orders(len(listed))
    check_balance(orders)
    if not 1 <= plan.order <= len(orders):
        raise ValueError(f"it has the balanced order {plan.order} of {len(orders)}")
    if shown != [listed[place] for place in orders[plan.order - 1]]:
        raise ValueError(f"its conditions are not in the balanced order {plan.order}")


def check_balance(orders):
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


def _check_counts(protocol, tested, wanted):
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
        try:
            protocol.rules.check_letters(trial.stimuli[0].masks for trial in trials)
        except ValueError as problem:
            raise ValueError(f"in condition {condition.name} {problem}") from None


def _name(protocol, item):
    if isinstance(protocol.design, Choice):
        return " and ".join(f"{v:g}{KNOBS[protocol.design.parameter].unit}" for v in item)
    return name_item(item)


def check_catch(protocol, trials):
    """Check which trials are catch trials, where they stand, and what they show.

    Raises
    ------
    ValueError
        If one is missing, stands elsewhere, or shows something else.
    """
    catch = protocol.design.catch
    caught = [place for place, trial in enumerate(trials) if trial.catch]
    others = len(trials) - len(caught)
    wanted = 0 if catch is None else catch.number(others)
    if len(caught) != wanted:
        raise ValueError(f"{len(caught)} trials are catch trials, and {wanted} must be")
    if catch is None:
        return
    for number, place in enumerate(caught):
        trial, before = trials[place], trials[place - 1]
        if place == 0 or before.catch:
            raise ValueError(f"the catch trial {trial.number} follows no other trial")
        if (trial.block, trial.condition) != (before.block, before.condition):
            raise ValueError(f"the catch trial {trial.number} is not of the condition before it")
        if trial.catch != catch.show:
            raise ValueError(f"the catch trial {trial.number} is no {catch.show}")
        asked = [stimulus.masks[slice(*trial.asked)] for stimulus in trial.stimuli]
        if catch.show == "repeat" and trial.stimuli != before.stimuli:
            raise ValueError(f"the catch trial {trial.number} repeats no trial")
        if catch.show == "blank" and any(map(any, asked)):
            raise ValueError(f"the catch trial {trial.number} shows dots")
        # So many others stand before it; each stretch of others has one catch trial.
        stretch = place - number
        size = others / wanted if catch.every is None else catch.every - 1
        if not int(number * size) < stretch <= int((number + 1) * size + 1e-9):
            raise ValueError(f"the catch trial {trial.number} stands outside its stretch")


def check_running(protocol, tested):
    """Check how often levels come running, and that quarters are balanced.

    Parameters
    ----------
    protocol, tested
        The protocol, and the trials of the test without catch trials, in order.

    Raises
    ------
    ValueError
        If something comes too often running, or a quarter has too much or too little.
    """
    for name, most in protocol.rules.at_most_running.items():
        first = 0
        for level, run in groupby(tested, lambda trial: _level(protocol, trial, name)):  # noqa: B023
            length = len(list(run))
            if length > most:
                raise ValueError(
                    f"{name} is {level} in {length} trials running from trial "
                    f"{tested[first].number} on, and may be in {most}"
                )
            first += length
    if protocol.rules.balanced_quarters:
        _check_quarters(tested)


def _level(protocol, trial, name):
    if name == "condition":
        return trial.condition
    levels = protocol.levels(trial.condition)
    if name in levels:
        return levels[name]
    return protocol.columns_of(trial.item)[name]


def _check_quarters(tested):
    number = len(tested)
    whole = Counter(trial.condition for trial in tested)
    for quarter in range(4):
        part = tested[quarter * number // 4 : (quarter + 1) * number // 4]
        held = Counter(trial.condition for trial in part)
        for name, times in whole.items():
            share = times * len(part) / number
            if abs(held[name] - share) >= 1:
                raise ValueError(
                    f"quarter {quarter + 1} has {name} {held[name]} times, and its share is "
                    f"{share:g}"
                )
