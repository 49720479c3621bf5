"""Rules of what a protocol shows on a conventional display, whose pins rise and fall."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.sessions.planning.conventionaltable import CONVENTIONAL

if TYPE_CHECKING:
    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Stimulus


def stands_beside(protocol: Protocol) -> bool:
    """Whether a conventional display is needed."""
    conditions = protocol.conditions
    return bool(protocol.conventional.reference) or any(
        protocol.place_of(condition) == CONVENTIONAL for condition in conditions
    )


def cells_needed(protocol: Protocol, plan: Plan) -> int:
    """Number of cells that a conventional display must have for all of a plan."""
    table = protocol.conventional
    shown = [stimulus.masks for stimulus in plan.stimuli() if is_conventional(stimulus)]
    return max(len(table.placed(masks)) for masks in [table.reference, *shown])


def is_conventional(stimulus: Stimulus) -> bool:
    """Whether a stimulus stands on the conventional display, and not on the device."""
    return stimulus.on == CONVENTIONAL


def problem(protocol: Protocol) -> str:
    """Say what of a conventional display cannot be as a protocol has it; empty if all can."""
    table = protocol.conventional
    there = [c for c in protocol.conditions if protocol.place_of(c) == CONVENTIONAL]
    if table.reference and not any(table.reference):
        return "[conventional] reference has no dots; give it some, or leave it out"
    if table.reference and protocol.medium == "paper":
        return "[conventional] reference stands beside a device; leave it out with medium = 'paper'"
    if table.reference and there:
        return (
            f"[conventional] reference needs the display on which {there[0].name} shows its "
            f"strings; leave one of the two out"
        )
    for condition in there:
        if own := sorted(condition.changes.keys() - {"on"}):
            return (
                f"the condition {condition.name} stands on a conventional display, which has no "
                f"{own[0]}; leave it out there"
            )
    if not there:
        return ""
    if protocol.task == "choice" or protocol.adaptive:
        what = "[design] compares" if protocol.task == "choice" else "[procedure] varies"
        return f"{what} what a conventional display cannot change; leave on = 'brlapi' out"
    return ""
