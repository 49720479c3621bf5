"""Trials ↔ JSON, a trial a line."""

from __future__ import annotations

import json
from contextlib import contextmanager
from dataclasses import asdict, fields
from typing import TYPE_CHECKING, Any

from vbraille.braille.geometry import Geometry
from vbraille.braille.spelling import spell, to_braille
from vbraille.errors import InputError
from vbraille.render import Tuning
from vbraille.sessions.planning.stimuli import Stimulus, Trial

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

VERSIONS = (1, 2)  # of the making of plans; the file's layout is the same
_HEAD = ("format", "protocol", "participant", "seed", "order")
_RUNS = ("practice", "trials")
_TUNING = tuple(field.name for field in fields(Tuning))
_GEOMETRY = tuple(field.name for field in fields(Geometry))


class Entry:
    """An object of the file; values are taken from it, each of its type.

    Parameters
    ----------
    value
        As `json` read it.
    names
        All that it must have.

    Raises
    ------
    ValueError
        If it is no object, or has other names.
    """

    def __init__(self, value: object, names: Collection[str]) -> None:
        if not isinstance(value, dict) or set(value) != set(names):
            raise ValueError(f"an entry must have {', '.join(names)}, and nothing else")
        self._values = value

    def text(self, name: str) -> str:
        """A string."""
        return self._take(name, str)

    def whole(self, name: str) -> int:
        """A whole number."""
        return self._take(name, int)

    def number(self, name: str) -> float:
        """A number that is written with a point."""
        return self._take(name, float)

    def items(self, name: str) -> list[Any]:
        """A list."""
        return self._take(name, list)

    def __getitem__(self, name: str) -> object:
        return self._values[name]

    def _take(self, name: str, kind: type) -> Any:
        if type(self._values[name]) is not kind:  # True is an int to isinstance
            raise ValueError(f"{name} is not of its type")
        return self._values[name]


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


def encode(head: dict[str, object], runs: dict[str, tuple[Trial, ...]]) -> str:
    """JSON of a plan.

    Parameters
    ----------
    head
        What stands before the trials.
    runs
        Trials by name.
    """
    lines = [f"{_json(name)}: {_json(value)}" for name, value in head.items()]
    for name, trials in runs.items():
        written = ",\n".join(_json(_trial_entry(trial)) for trial in trials)
        lines.append(f"{_json(name)}: [\n{written}\n]" if trials else f"{_json(name)}: []")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def decode(text: str) -> tuple[Entry, dict[str, tuple[Trial, ...]]]:
    """Head and trials of a plan.

    Raises
    ------
    ValueError
        If it is damaged.
    InputError
        If it is of another version.
    """
    tree = json.loads(text)
    written = tree.get("format") if isinstance(tree, dict) else None
    if type(written) is not int:
        raise ValueError("it does not say which format it has")
    if written not in VERSIONS:
        raise InputError(
            f"the plan is of version {written}, and this vbraille knows the versions 1 and 2; use "
            f"the vbraille that made it, or a newer one"
        )
    head = Entry(tree, (*_HEAD, *_RUNS))
    return head, {name: tuple(map(_read_trial, head.items(name))) for name in _RUNS}


def stimulus_to_json(stimulus: Stimulus) -> dict[str, Any]:
    """Strings, numbers and None that say all of a stimulus, as plan.json has them."""
    return {
        "cells": to_braille(stimulus.masks),
        "value_mm": stimulus.value,
        **asdict(stimulus.tuning),
        **asdict(stimulus.geometry),
    }


def stimulus_from_json(value: object) -> Stimulus:
    """Make the stimulus that `stimulus_to_json` wrote.

    Raises
    ------
    ValueError
        If something is missing, is not of its type or is out of range.
    """
    entry = Entry(value, ("cells", "value_mm", *_TUNING, *_GEOMETRY))
    return Stimulus(
        spell(entry.text("cells"), {}),
        Tuning(entry.number("texture"), entry.number("contrast"), entry.whole("cycles")),
        Geometry(**{name: entry.number(name) for name in _GEOMETRY}),
        None if entry["value_mm"] is None else entry.number("value_mm"),
    )


def _trial_entry(trial: Trial) -> dict[str, object]:
    return {
        "number": trial.number,
        "block": trial.block,
        "condition": trial.condition,
        "asked": trial.asked,
        "stimuli": [stimulus_to_json(stimulus) for stimulus in trial.stimuli],
    }


def _read_trial(value: object) -> Trial:
    entry = Entry(value, ("number", "block", "condition", "asked", "stimuli"))
    asked = entry.items("asked")
    if len(asked) != 2 or any(type(place) is not int for place in asked):
        raise ValueError("asked is not two whole numbers")
    return Trial(
        entry.whole("number"),
        entry.whole("block"),
        entry.text("condition"),
        tuple(map(stimulus_from_json, entry.items("stimuli"))),
        (asked[0], asked[1]),
    )


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False)
