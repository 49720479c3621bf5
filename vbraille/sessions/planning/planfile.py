"""Trials ↔ JSON, a trial a line."""

from __future__ import annotations

import json
from contextlib import contextmanager
from dataclasses import asdict, fields
from typing import TYPE_CHECKING, Any

import msgspec

from vbraille.braille.geometry import Geometry
from vbraille.braille.spelling import spell, to_braille
from vbraille.errors import InputError
from vbraille.render import Tuning
from vbraille.sessions.planning.stimuli import Stimulus, Trial

if TYPE_CHECKING:
    from collections.abc import Iterator

VERSIONS = (1, 2)  # of the making of plans; the file's layout is the same
_OF_STIMULUS = {"cells", "value_mm", *(f.name for f in (*fields(Tuning), *fields(Geometry)))}


class WrittenTrial(msgspec.Struct, forbid_unknown_fields=True):
    """A trial as the file has it."""

    number: int
    block: int
    condition: str
    asked: tuple[int, int]
    stimuli: list[dict[str, Any]]

    @classmethod
    def of(cls, trial: Trial) -> WrittenTrial:
        """Write a trial."""
        stimuli = list(map(stimulus_to_json, trial.stimuli))
        return cls(trial.number, trial.block, trial.condition, trial.asked, stimuli)

    def trial(self) -> Trial:
        """Make the trial that was written.

        Raises
        ------
        ValueError
            If something of it is out of range, or not of its type.
        """
        stimuli = tuple(map(stimulus_from_json, self.stimuli))
        return Trial(self.number, self.block, self.condition, stimuli, self.asked)


class WrittenPlan(msgspec.Struct, forbid_unknown_fields=True):
    """A plan as the file has it, in whose order its keys are written."""

    format: int
    protocol: str
    participant: str
    seed: int
    order: int
    practice: list[WrittenTrial]
    trials: list[WrittenTrial]


class _Version(msgspec.Struct):
    """What is known of a plan of any version."""

    format: int


@contextmanager
def damage() -> Iterator[None]:
    """Say that a plan is damaged.

    Raises
    ------
    InputError
        For a `ValueError` within.
    """
    try:
        yield
    except RecursionError:
        raise InputError("the plan is damaged: its brackets nest too deep") from None
    except ValueError as error:
        raise InputError(f"the plan is damaged: {error}; put it back as it was") from None


def encode(plan: WrittenPlan) -> str:
    """JSON of a plan, a trial a line."""
    lines = []
    for name, value in msgspec.structs.asdict(plan).items():
        if isinstance(value, list):
            written = ",\n".join(map(_json, value))
            value = f"[\n{written}\n]" if value else "[]"
        else:
            value = _json(value)
        lines.append(f'"{name}": {value}')
    return "{\n" + ",\n".join(lines) + "\n}\n"


def decode(text: str) -> WrittenPlan:
    """Read what `encode` wrote.

    Raises
    ------
    ValueError
        If it is damaged.
    InputError
        If it is of another version.
    """
    version = msgspec.json.decode(text, type=_Version).format
    if version not in VERSIONS:
        raise InputError(
            f"the plan is of version {version}, and this vbraille knows the versions 1 and 2; use "
            f"the vbraille that made it, or a newer one"
        )
    return msgspec.json.decode(text, type=WrittenPlan)


def stimulus_to_json(stimulus: Stimulus) -> dict[str, Any]:
    """Strings, numbers and None that say all of a stimulus, as plan.json has them."""
    return {
        "cells": to_braille(stimulus.masks),
        "value_mm": stimulus.value,
        **asdict(stimulus.tuning),
        **asdict(stimulus.geometry),
    }


def stimulus_from_json(written: dict[str, Any]) -> Stimulus:
    """Make the stimulus that `stimulus_to_json` wrote.

    Raises
    ------
    ValueError
        If something is missing, is not of its type or is out of range.
    """
    if set(written) != _OF_STIMULUS:
        raise ValueError(f"a stimulus must have {', '.join(sorted(_OF_STIMULUS))}, nothing else")
    return Stimulus(
        spell(msgspec.convert(written["cells"], str), {}),
        msgspec.convert(written, Tuning),
        msgspec.convert(written, Geometry),
        msgspec.convert(written["value_mm"], float | None),
    )


def _json(value: object) -> str:
    # Not msgspec's own, which writes 0.00001 where plans have had 1e-05.
    return json.dumps(msgspec.to_builtins(value), ensure_ascii=False, allow_nan=False)
