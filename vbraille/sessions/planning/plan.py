"""The plan of a session: all that will be shown, in order, fixed before the first trial."""

from __future__ import annotations

import json
from dataclasses import asdict, fields
from typing import Any

import msgspec
from msgspec import Struct, field

from vbraille.braille.geometry import Geometry
from vbraille.braille.spelling import spell, to_braille
from vbraille.errors import InputError
from vbraille.render import Tuning
from vbraille.sessions.planning.analysis import PlannedAnalysis
from vbraille.sessions.planning.stimuli import (
    Stimuli,
    Stimulus,
    Trial,
    check_participant,
    check_seed,
)
from vbraille.sessions.planning.style import mapping_named

VERSION = 2  # of the making of plans; what a seed makes may change with a higher one alone
_OF_STIMULUS = {"cells", "value_mm", *(f.name for f in (*fields(Tuning), *fields(Geometry)))}
# Left out where the display's mapping is used, where a protocol gives cells, on the device, and
# where no picture is shown.
_OPTIONAL = ("mapping", "text", "table", "on", "scene", "picture", "answer")


class _Version(msgspec.Struct):
    """The one key that plans of every version have."""

    format: int


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


class Plan(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """All trials of a session, in order. The plan's file has the fields in the order given here.

    Parameters
    ----------
    version
        Version of the rules that the plan was made by.
    protocol
        Name of the protocol.
    participant
        Pseudonym of the participant.
    seed
        Number that all random choices followed from.
    order
        Number of the balanced order of conditions, or the row of the table of orders, from 1; 0 if
        there is only one order.
    group
        Name of the participant's group; empty if there are no groups.
    analysis
        Analysis that answers what the session is for.
    practice, trials
        Practice trials and trials of the test, each in the order in which they are shown.

    Raises
    ------
    ValueError
        If the participant, the seed or the order cannot be used.
    """

    version: int = field(name="format", default=VERSION)
    protocol: str
    participant: str
    seed: int
    order: int
    group: str = ""
    analysis: PlannedAnalysis
    practice: tuple[Trial, ...]
    trials: tuple[Trial, ...]

    def __post_init__(self) -> None:
        check_participant(self.participant)
        check_seed(self.seed)
        if self.order < 0:
            raise ValueError(f"order is {self.order}; it must be 0 or more")

    def stimuli(self) -> list[Stimulus]:
        """All stimuli of all trials, practice included."""
        return [stimulus for trial in (*self.practice, *self.trials) for stimulus in trial.stimuli]

    def to_json(self) -> str:
        """Plan as JSON with one trial on each line; the bytes are the same on every machine."""
        head = {n: getattr(self, n) for n in ("protocol", "participant", "seed", "order")}
        head |= {"group": self.group} if self.group else {}
        head |= {"analysis": msgspec.structs.asdict(self.analysis)}
        lines = [f"{_json(n)}: {_json(v)}" for n, v in {"format": self.version, **head}.items()]
        for name in ("practice", "trials"):
            written = ",\n".join(map(_trial, getattr(self, name)))
            lines.append(f"{_json(name)}: " + (f"[\n{written}\n]" if written else "[]"))
        return "{\n" + ",\n".join(lines) + "\n}\n"

    @classmethod
    def from_json(cls, text: str) -> Plan:
        """Read a plan that `to_json` wrote.

        Raises
        ------
        InputError
            If the text is damaged, or the plan is of another version.
        """
        try:
            version = msgspec.json.decode(text, type=_Version).format
            if version == VERSION:
                return msgspec.json.decode(text, type=cls, dec_hook=_read_stimuli)
        except RecursionError:
            raise InputError("the plan is damaged: its brackets nest too deep") from None
        except ValueError as error:
            raise InputError(f"the plan is damaged: {error}; put it back as it was") from None
        raise InputError(
            f"the plan is of version {version}, and this vbraille knows version {VERSION}; use the "
            f"vbraille that made it"
        )
