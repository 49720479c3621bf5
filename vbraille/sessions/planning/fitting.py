"""Check whether all that a protocol shows fits its display: dots, lines, and values."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

from vbraille.braille.spelling import name_dots, to_braille
from vbraille.sessions.planning.appearance import LENGTHS
from vbraille.sessions.planning.conventionaltable import CONVENTIONAL
from vbraille.sessions.planning.design import Choice, StringList
from vbraille.sessions.planning.knobs import KNOBS, with_value
from vbraille.sessions.planning.writing import cells_of

if TYPE_CHECKING:
    from vbraille.sessions.planning.appearance import Condition
    from vbraille.sessions.planning.protocol import Protocol


def check_cells(protocol: Protocol) -> None:
    """Check that the display can show every dot of every cell used, in every condition.

    Raises
    ------
    ValueError
        If it cannot show a dot, or a braille table cannot make cells of a text.
    """
    model = protocol.model
    for condition in _on_device(protocol):
        mapping = protocol.style_of(condition).mapping
        shown = mapping.shown_dots()
        how = (
            f"'s row {mapping.left[0] + 1}"
            if mapping.rows == 1
            else f" with the mapping {mapping.name}"
        )
        only = f"the {model.title}{how} shows {name_dots(shown)} only"
        for table, (masks, _) in _cells(protocol, condition).items():
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


def check_lines(protocol: Protocol) -> None:
    """Check that the display has room for the longest line, at each value that is compared.

    Raises
    ------
    ValueError
        If a line is too long, or a value cannot be shown.
    """
    model, design, practice = protocol.model, protocol.design, protocol.practice
    values: tuple[float | None, ...] = (None,)
    unit = ""
    if isinstance(design, Choice):
        values = tuple(dict.fromkeys((*design.values, *protocol.procedure.values(design))))
        values += () if design.reference is None else (design.reference,)
        unit = KNOBS[design.parameter].unit
    compared = (*values, *sorted(set(practice.values)))
    longest = 0
    for condition, value in product(_on_device(protocol), compared):
        lengths = {table: length for table, (_, length) in _cells(protocol, condition).items()}
        whose = max(lengths, key=lambda table: lengths[table])
        longest = max(longest, lengths[whose])
        at = "" if value is None else f" at a value of {value:g}{unit}"
        if condition.changes.keys() & set(LENGTHS):
            at += f" in the condition {condition.name}"
        try:
            shown = protocol.shown(condition, (0,), value)
            room = shown.geometry.cells_per_line(model.display.span_mm)
        except ValueError as error:
            raise ValueError(f"[design]{at}: {error}") from None
        cells = protocol.lead_cells + lengths[whose]
        if cells > room:
            raise ValueError(
                f"{whose} has a line of {cells} cells{at}, lead_cells among them, and the "
                f"{model.title} has room for {room}; make it shorter, or travel_mm longer"
            )
    _check_varied(protocol, longest)


def _on_device(protocol: Protocol) -> list[Condition]:
    """Conditions whose strings are put under the hand on the device."""
    return [c for c in protocol.conditions if protocol.place_of(c) != CONVENTIONAL]


def _cells(protocol: Protocol, condition: Condition) -> dict[str, tuple[frozenset[int], int]]:
    """Cells that a condition shows, and length of its longest line, by the tables of the file.

    Raises
    ------
    ValueError
        If a braille table cannot make cells of a text.
    """
    design, practice = protocol.design, protocol.practice
    table = protocol.table_of(condition)
    if table is None or not isinstance(design, StringList):
        practised = practice.lines(design)
        masks = frozenset(mask for line in practised for mask in line)
        length = max(map(len, practised), default=0)
        return {"[design]": (design.masks, design.cells), "[practice]": (masks, length)}
    found = {}
    for name, strings in (("[design]", design.strings), ("[practice]", practice.strings)):
        try:
            lines = [cells_of(str(text), table) for text in strings]
        except ValueError as error:
            raise ValueError(f"{name} in the condition {condition.name}: {error}") from None
        masks = frozenset(mask for line in lines for mask in line)
        found[name] = (masks, max(map(len, lines), default=0))
    return found


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
