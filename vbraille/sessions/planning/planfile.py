"""Conversion of trials to JSON and back, with one trial on each line."""

from __future__ import annotations

import json
from dataclasses import asdict, fields
from typing import TYPE_CHECKING, Any, TypeVar

import msgspec

from vbraille.braille.geometry import Geometry
from vbraille.braille.spelling import spell, to_braille
from vbraille.errors import InputError
from vbraille.render import Tuning
from vbraille.sessions.planning.appearance import mapping_named
from vbraille.sessions.planning.stimuli import Stimuli, Stimulus

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vbraille.sessions.planning.stimuli import Trial

_Plan = TypeVar("_Plan")

VERSION = 2  # of the rules that plans are made by
_OF_STIMULUS = {"cells", "value_mm", *(f.name for f in (*fields(Tuning), *fields(Geometry)))}
# Left out where the display's mapping is used, where a protocol gives cells, and on the device.
_OPTIONAL = ("mapping", "text", "table", "on")


class _Version(msgspec.Struct):
    """The one key that plans of every version have."""

    format: int


def encode(head: Mapping[str, str | int], lists: Mapping[str, tuple[Trial, ...]]) -> str:
    """JSON of a plan: first the values of its head, then its lists with one trial on each line."""
    lines = [f"{_json(name)}: {_json(value)}" for name, value in head.items()]
    for name, trials in lists.items():
        written = ",\n".join(map(_trial, trials))
        lines.append(f"{_json(name)}: [\n{written}\n]" if trials else f"{_json(name)}: []")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def decode(text: str, kind: type[_Plan]) -> _Plan:
    """Read a plan that `encode` wrote, as a value of the given type.

    Raises
    ------
    InputError
        If the text is damaged, or its version is not known.
    """
    try:
        version = msgspec.json.decode(text, type=_Version).format
        if version == VERSION:
            return msgspec.json.decode(text, type=kind, dec_hook=_read_stimuli)
    except RecursionError:
        raise InputError("the plan is damaged: its brackets nest too deep") from None
    except ValueError as error:
        raise InputError(f"the plan is damaged: {error}; put it back as it was") from None
    raise InputError(
        f"the plan is of version {version}, and this vbraille knows version {VERSION}; use the "
        f"vbraille that made it"
    )


def stimulus_to_json(stimulus: Stimulus) -> dict[str, Any]:
    """Describe a stimulus completely by strings, numbers and None, as in plan.json."""
    written = {
        "cells": to_braille(stimulus.masks),
        "value_mm": stimulus.value,
        **asdict(stimulus.tuning),
        **asdict(stimulus.geometry),
    }
    given = {name: getattr(stimulus, name) for name in _OPTIONAL}
    return written | {name: value for name, value in given.items() if value is not None}


def stimulus_from_json(written: dict[str, Any]) -> Stimulus:
    """Make a stimulus from the description that `stimulus_to_json` gives.

    Raises
    ------
    ValueError
        If a value is missing, has the wrong type or is out of range.
    """
    if set(written) - set(_OPTIONAL) != _OF_STIMULUS:
        raise ValueError(f"a stimulus must have {', '.join(sorted(_OF_STIMULUS))}, nothing else")
    optional = {name: msgspec.convert(written.get(name), str | None) for name in _OPTIONAL}
    mapping = optional["mapping"]
    if mapping is not None:
        mapping_named(mapping)
    return Stimulus(
        spell(msgspec.convert(written["cells"], str), {}),
        msgspec.convert(written, Tuning),
        msgspec.convert(written, Geometry),
        msgspec.convert(written["value_mm"], float | None),
        **optional,
    )


def _trial(trial: Trial) -> str:
    stimuli = list(map(stimulus_to_json, trial.stimuli))
    written = msgspec.structs.asdict(trial) | {"stimuli": stimuli}
    if not trial.catch:
        del written["catch"]
    return _json(written)


def _read_stimuli(_kind: type, written: list[dict[str, Any]]) -> Stimuli:
    return Stimuli(map(stimulus_from_json, msgspec.convert(written, list[dict[str, Any]])))


def _json(value: object) -> str:
    # The standard library writes 1e-05, which the sums of plans are of; msgspec writes 0.00001.
    return json.dumps(value, ensure_ascii=False, allow_nan=False)
