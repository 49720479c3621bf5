"""What a session begins with: its plan, facts about the participant, the head of its record."""

from __future__ import annotations

import secrets
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.protocolfiles import load_protocol
from vbraille.sessions.planning.spellings import made_by
from vbraille.sessions.record.folder import FORMAT, versions

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from vbraille.sessions.conditions import Conditions
    from vbraille.sessions.planning.plan import Plan

_MOST_DRAWN = 1_000_000  # so that a seed that is drawn is short enough to be written down by hand


def plan_session(
    protocol: str | Path | Protocol,
    participant: str,
    seed: int | None = None,
    order: int | None = None,
    texture: float | None = None,
    contrast: float | None = None,
    group: str | None = None,
) -> tuple[Protocol, Plan]:
    """Make the protocol and the plan of a session; a seed is drawn if none is given.

    `Session.create` describes the arguments.
    """
    if not isinstance(protocol, Protocol):
        protocol = load_protocol(str(protocol))
    if seed is None:
        seed = secrets.randbelow(_MOST_DRAWN)
    plan = make_plan(
        protocol, participant, seed, order, group=group, texture=texture, contrast=contrast
    )
    return protocol.assigned(plan.group), plan


def told_fields(protocol: Protocol, given: Mapping[str, str]) -> dict[str, str]:
    """Answers to all of the protocol's questions about the participant; empty where none is given.

    Raises
    ------
    InputError
        If the protocol has no such question, or the answer is none of the question's choices.
    """
    names = [field.name for field in protocol.fields]
    for name in given:
        if name not in names:
            raise InputError(
                f"{protocol.name} does not ask for {name!r}; "
                f"it asks for {', '.join(names) or 'nothing'}"
            )
    for field in protocol.fields:
        value = given.get(field.name)
        if value is None:
            continue
        if field.choices and value not in field.choices:
            raise InputError(f"{field.name} is {value!r}; it must be {' or '.join(field.choices)}")
        if not value.isprintable():
            raise InputError(f"{field.name} is {value!r}; it must be one line of text")
    return {name: given.get(name, "") for name in names}


def head_of(
    protocol: Protocol,
    plan: Plan,
    fields: Mapping[str, str],
    conditions: Conditions,
) -> dict[str, Any]:
    """Content of session.json: who takes part, what is shown, and with which equipment.

    Parameters
    ----------
    protocol, plan, conditions
        What the session shows, in which order, and with which equipment.
    fields
        Answers to the protocol's questions about the participant.
    """
    display = protocol.model.display
    group = {"group": plan.group} if plan.group else {}
    also = {} if conditions.also is None else {"also": conditions.also}
    return {
        "format": FORMAT,
        "protocol": protocol.name,
        "participant": plan.participant,
        "seed": plan.seed,
        "order": plan.order,
        **group,
        "model": protocol.model.name,
        "array": {
            name: getattr(display, name)
            for name in ("rows", "columns", "column_pitch_mm", "row_pitch_mm")
        },
        "mapping": protocol.mapping.name,
        "geometry": asdict(protocol.geometry),
        "fields": dict(fields),
        "device": conditions.device,
        "hand": conditions.hand,
        "answers": conditions.answers,
        "fast": conditions.fast,
        "rate_hz": conditions.rate_hz,
        **also,
        "versions": versions() | (made_by() if protocol.written else {}),
    }
