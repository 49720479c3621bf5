"""Whether the tables of a protocol go together."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.braille.spelling import name_dots, to_braille
from vbraille.sessions.planning.design import MOST_TRIALS, Choice, StringList

if TYPE_CHECKING:
    from vbraille.sessions.planning.protocol import Protocol


def check_agreement(protocol: Protocol) -> None:
    """Check what no table of a protocol can check by itself.

    Raises
    ------
    ValueError
        If values do not go together.
    """
    for table, named in (("conditions", protocol.conditions), ("fields", protocol.fields)):
        names = [value.name for value in named]
        for number, name in enumerate(names, 1):
            if name in names[: number - 1]:
                raise ValueError(
                    f"[[{table}]] number {number} name is {name!r} again; give each its own"
                )
    _check_tuning(protocol)
    problem = protocol.practice.problem(protocol.design)
    if problem:
        raise ValueError(f"[practice] {problem}")
    _check_trials(protocol)
    _check_cells(protocol)
    _check_lines(protocol)
    _check_letters(protocol)


def _check_tuning(protocol: Protocol) -> None:
    table = "[display]"
    try:
        protocol.style  # noqa: B018
        for number, condition in enumerate(protocol.listed, 1):
            table = f"[[conditions]] number {number}"
            protocol.tuning(condition)
    except ValueError as error:
        raise ValueError(f"{table} {error}") from None


def _check_trials(protocol: Protocol) -> None:
    trials, blocks = protocol.trials, protocol.design.blocks
    if trials + protocol.practice.trials > MOST_TRIALS:
        raise ValueError(
            f"[design] makes a session of more than {MOST_TRIALS} trials; make it smaller"
        )
    if blocks != "conditions" and not 1 <= blocks <= trials:
        raise ValueError(
            f"[design] blocks is {blocks}; it must be 1 to {trials}, "
            f"since there are {trials} trials"
        )


def _check_cells(protocol: Protocol) -> None:
    """Check that the display shows all dots of what is shown."""
    model, mapping, design = protocol.model, protocol.mapping, protocol.design
    shown = mapping.shown_dots()
    how = (
        f"'s row {mapping.left[0] + 1}"
        if mapping.rows == 1
        else f" with the mapping {mapping.name}"
    )
    only = f"the {model.title}{how} shows {name_dots(shown)} only"
    practised = {mask for line in protocol.practice.lines(design) for mask in line}
    for table, masks in (("[design]", design.masks), ("[practice]", practised)):
        for mask in sorted(masks):
            if mask & ~shown:
                cell = f"{to_braille((mask,))} ({name_dots(mask)})"
                raise ValueError(f"{table} has the cell {cell}, and {only}; leave the cell out")
    for key, mask in protocol.keys.items():
        if mask & ~shown:
            raise ValueError(f"[keys] {key} is {name_dots(mask)}, and {only}; leave the key out")


def _check_lines(protocol: Protocol) -> None:
    """Check that the display has room for the longest line, at each value that is compared."""
    model, design, practice = protocol.model, protocol.design, protocol.practice
    values = design.values if isinstance(design, Choice) else (None,)
    longest = max((design.cells, *map(len, practice.lines(design))))
    whose = "[design]" if longest == design.cells else "[practice]"
    for value in (*values, *sorted(set(practice.values))):
        at = "" if value is None else f" at a value of {value:g} mm"
        try:
            room = protocol.geometry_at(value).cells_per_line(model.display.span_mm)
        except ValueError as error:
            raise ValueError(f"[design]{at}: {error}") from None
        cells = protocol.lead_cells + longest
        if cells > room:
            raise ValueError(
                f"{whose} has a line of {cells} cells{at}, lead_cells among them, and the "
                f"{model.title} has room for {room}; make it shorter, or travel_mm longer"
            )


def _check_letters(protocol: Protocol) -> None:
    rules = protocol.rules
    if isinstance(protocol.design, StringList):
        problem = rules.problem(protocol.design.items())
        if problem:
            raise ValueError(f"[rules] {problem}; change the strings or the rule")
    elif (rules.each_letter, rules.each_letter_at_least) != (None, None):
        raise ValueError("[rules] count the letters of kind = 'list'; leave them out")
