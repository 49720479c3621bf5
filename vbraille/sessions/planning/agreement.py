"""Check whether the tables of a protocol agree with each other."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

from vbraille.braille.spelling import name_dots, to_braille
from vbraille.sessions.planning import standing
from vbraille.sessions.planning.appearance import LENGTHS
from vbraille.sessions.planning.conventionaltable import CONVENTIONAL
from vbraille.sessions.planning.design import MOST_TRIALS, Choice, StringList
from vbraille.sessions.planning.factors import problem
from vbraille.sessions.planning.knobs import GAP, KNOBS, with_value
from vbraille.sessions.planning.sequencing import CONDITION, impossible, limited
from vbraille.toml.tomlfile import which

if TYPE_CHECKING:
    from vbraille.sessions.planning.appearance import Condition
    from vbraille.sessions.planning.protocol import Protocol


def check_agreement(protocol: Protocol) -> None:
    """Check that the tables of a protocol agree with each other, for each group.

    Raises
    ------
    ValueError
        If values contradict each other.
    """
    said = problem(protocol.factors, protocol.cross, listed=bool(protocol.listed))
    if said:
        raise ValueError(said)
    for table, named in (("conditions", protocol.conditions), ("fields", protocol.fields)):
        names = [value.name for value in named]
        for number, name in enumerate(names, 1):
            if name in names[: number - 1]:
                raise ValueError(
                    f"[[{table}]] number {number} name is {name!r} again; give each its own"
                )
    _check_names(protocol)
    _check_styles(protocol)
    _check_procedure(protocol)
    said = standing.problem(protocol)
    if said:
        raise ValueError(said)
    _check_question(protocol)
    said = protocol.practice.problem(protocol.design)
    if said:
        raise ValueError(f"[practice] {said}")
    _check_trials(protocol)
    _check_order(protocol)
    _check_cells(protocol)
    _check_lines(protocol)
    _check_letters(protocol)
    _check_rules(protocol)
    if not protocol.group:
        _check_groups(protocol)


def _check_names(protocol: Protocol) -> None:
    """Check that factors and columns of items can be told apart."""
    taken = {CONDITION, *protocol.item_columns}
    for number, factor in enumerate(protocol.factors, 1):
        if factor.name in taken:
            raise ValueError(
                f"[[factors]] number {number} name is {factor.name!r}, which already stands for "
                f"the conditions or for a column of the items; give another"
            )


def _check_groups(protocol: Protocol) -> None:
    """Check the protocol as each group has it."""
    for group in protocol.groups:
        number = 1 + next(n for n, factor in enumerate(protocol.factors) if factor.between)
        try:
            check_agreement(protocol.assigned(group))
        except ValueError as error:
            raise ValueError(f"[[factors]] number {number} group {group}: {error}") from None


def _place(protocol: Protocol, condition: Condition) -> str:
    """Table that a message about a condition begins with."""
    if condition in protocol.listed:
        return f"[[conditions]] number {protocol.listed.index(condition) + 1}"
    if condition.changes:
        own = next(n for n, factor in enumerate(protocol.factors, 1) if not factor.between)
        return f"[[factors]] number {own} condition {condition.name}:"
    return "[display]"


def _check_styles(protocol: Protocol) -> None:
    table = "[display]"
    try:
        protocol.style  # noqa: B018
        for condition in protocol.conditions:
            table = _place(protocol, condition)
            protocol.style_of(condition)
    except ValueError as error:
        raise ValueError(f"{table} {error}") from None
    compared = protocol.parameter
    for condition in protocol.conditions if compared else ():
        if _sets(condition, compared):
            raise ValueError(
                f"[design] parameter is {compared!r}, which the condition {condition.name} sets "
                f"itself; leave it out there"
            )


def _sets(condition: Condition, knob: str | None) -> bool:
    """Whether a condition sets what is compared or varied."""
    same = {GAP: "dot_spacing_mm", "texture_cycles": "cycles"}
    return knob is not None and same.get(knob, knob) in condition.changes


def _check_question(protocol: Protocol) -> None:
    stimuli = 2 if protocol.task == "choice" else 1
    problem = protocol.asks.problem(stimuli, adaptive=protocol.adaptive)
    if problem:
        raise ValueError(f"[question] {problem}")
    same = isinstance(protocol.design, Choice) and protocol.design.same
    if same and (protocol.asks.name != "same-different" or protocol.adaptive):
        raise ValueError(
            "[design] same is of [question] kind = 'same-different' in a fixed order; leave it out"
        )
    if protocol.trial.end is not None and protocol.medium == "paper":
        raise ValueError("[trial] end is of a device; on paper Enter ends reading, leave it out")


def _check_procedure(protocol: Protocol) -> None:
    said = protocol.procedure.problem(protocol.design)
    if said:
        raise ValueError(f"[procedure] {said}")
    if not protocol.adaptive:
        return
    if protocol.medium == "paper":
        raise ValueError(
            "[procedure] varies what a device shows; with medium = 'paper' leave it out"
        )
    if protocol.task == "choice" and protocol.rules.never_twice_running:
        raise ValueError(
            "[rules] never_twice_running is of a fixed order of values; leave it out, since "
            "[procedure] chooses them"
        )
    own = getattr(protocol.procedure, "parameter", None)
    for condition in protocol.conditions if own else ():
        if _sets(condition, own):
            raise ValueError(
                f"[procedure] parameter is {own!r}, which the condition {condition.name} sets "
                f"itself; leave it out there"
            )


def _check_trials(protocol: Protocol) -> None:
    design = protocol.design
    if design.catch is not None and (protocol.adaptive or protocol.task == "choice"):
        what = "[procedure] chooses what is asked" if protocol.adaptive else "two are compared"
        raise ValueError(
            f"[design] catch is for strings in a fixed order, and {what}; leave it out"
        )
    trials, blocks = design.trials * len(protocol.conditions), design.blocks
    catch = 0 if design.catch is None else design.catch.number(trials)
    if trials + catch + protocol.practice.trials > MOST_TRIALS:
        raise ValueError(
            f"[design] makes a session of more than {MOST_TRIALS} trials; make it smaller"
        )
    if design.catch is not None and not 1 <= catch <= trials:
        raise ValueError(
            f"[design] catch would be {catch} of {trials + catch} trials; make every smaller, or "
            f"the design larger"
        )
    if blocks != "conditions" and not 1 <= blocks <= trials:
        raise ValueError(
            f"[design] blocks is {blocks}; it must be 1 to {trials}, "
            f"since there are {trials} trials"
        )


def _check_order(protocol: Protocol) -> None:
    order, design = protocol.order, protocol.design
    if order is None:
        return
    if design.order is not None:
        raise ValueError("[order] kind stands beside order of [design]; leave one of the two out")
    if design.blocks != "conditions" and order.kind != "random":
        raise ValueError(
            f"[order] kind is {order.kind!r}, which orders blocks of a condition each; give "
            f"'random', or [design] blocks = 'conditions'"
        )


def _on_device(protocol: Protocol) -> list[Condition]:
    """Conditions whose strings are put under the hand on the device."""
    return [c for c in protocol.conditions if protocol.place_of(c) != CONVENTIONAL]


def _check_cells(protocol: Protocol) -> None:
    """Check that the display can show every dot of every cell used, in every condition."""
    model, design = protocol.model, protocol.design
    practised = {mask for line in protocol.practice.lines(design) for mask in line}
    for condition in _on_device(protocol):
        mapping = protocol.style_of(condition).mapping
        shown = mapping.shown_dots()
        how = (
            f"'s row {mapping.left[0] + 1}"
            if mapping.rows == 1
            else f" with the mapping {mapping.name}"
        )
        only = f"the {model.title}{how} shows {name_dots(shown)} only"
        for table, masks in (("[design]", design.masks), ("[practice]", practised)):
            for mask in sorted(masks):
                if mask & ~shown:
                    cell = f"{to_braille((mask,))} ({name_dots(mask)})"
                    raise ValueError(f"{table} has the cell {cell}, and {only}; leave the cell out")
        # Keys may spell what one condition shows and another does not.
        for key, mask in protocol.keys.items() if len(protocol.conditions) == 1 else ():
            if mask & ~shown:
                raise ValueError(
                    f"[keys] {key} is {name_dots(mask)}, and {only}; leave the key out"
                )


def _check_lines(protocol: Protocol) -> None:
    """Check that the display has room for the longest line, at each value that is compared."""
    model, design, practice = protocol.model, protocol.design, protocol.practice
    values: tuple[float | None, ...] = (None,)
    unit = ""
    if isinstance(design, Choice):
        values = tuple(dict.fromkeys((*design.values, *protocol.procedure.values(design))))
        values += () if design.reference is None else (design.reference,)
        unit = KNOBS[design.parameter].unit
    longest = max((design.cells, *map(len, practice.lines(design))))
    whose = "[design]" if longest == design.cells else "[practice]"
    for condition, value in product(_on_device(protocol), (*values, *sorted(set(practice.values)))):
        at = "" if value is None else f" at a value of {value:g}{unit}"
        if condition.changes.keys() & set(LENGTHS):
            at += f" in the condition {condition.name}"
        try:
            shown = protocol.shown(condition, (0,), value)
            room = shown.geometry.cells_per_line(model.display.span_mm)
        except ValueError as error:
            raise ValueError(f"[design]{at}: {error}") from None
        cells = protocol.lead_cells + longest
        if cells > room:
            raise ValueError(
                f"{whose} has a line of {cells} cells{at}, lead_cells among them, and the "
                f"{model.title} has room for {room}; make it shorter, or travel_mm longer"
            )
    _check_varied(protocol, longest)


def _check_varied(protocol: Protocol, longest: int) -> None:
    """Check that strings can be shown at both ends of what a procedure varies."""
    knob = getattr(protocol.procedure, "parameter", None)
    if knob is None or protocol.task == "choice":
        return
    for condition, value in product(
        protocol.conditions, protocol.procedure.values(protocol.design)
    ):
        try:
            shown = with_value(protocol.shown(condition, (0,)), knob, value)
        except ValueError as error:
            raise ValueError(f"[procedure] parameter at {value:g}: {error}") from None
        room = shown.geometry.cells_per_line(protocol.model.display.span_mm)
        if protocol.lead_cells + longest > room:
            raise ValueError(
                f"[procedure] parameter at {value:g} leaves room for {room} cells, and there are "
                f"{protocol.lead_cells + longest}; make it less, or travel_mm longer"
            )


def _check_letters(protocol: Protocol) -> None:
    rules = protocol.rules
    if isinstance(protocol.design, StringList):
        said = rules.problem(protocol.design.items())
        if said:
            raise ValueError(f"[rules] {said}; change the strings or the rule")
    elif (rules.each_letter, rules.each_letter_at_least) != (None, None):
        raise ValueError("[rules] count the letters of kind = 'list'; leave them out")


def _check_rules(protocol: Protocol) -> None:
    """Check that rules on the order of trials name what there is, and can be kept."""
    rules, design = protocol.rules, protocol.design
    if not rules.searched:
        return
    if protocol.adaptive:
        raise ValueError(
            "[rules] at_most_running and balanced_quarters are of a fixed order; leave them out, "
            "since [procedure] chooses the trials"
        )
    known = limited(protocol)
    for name in rules.at_most_running:
        if name not in known:
            raise ValueError(f"[rules] at_most_running has {name!r}{which(name, known)}")
    if rules.balanced_quarters and design.blocks == "conditions" and len(protocol.conditions) > 1:
        raise ValueError(
            "[rules] balanced_quarters cannot be kept: each condition has a block of its own; "
            "give [design] blocks = 1, or leave the rule out"
        )
    said = impossible(protocol)
    if said:
        raise ValueError(f"[rules] {said}")
