"""The paragraph on methods: facts that were counted, which the template puts into sentences."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from vbraille.analysis.measures import LOGS, SHARES
from vbraille.analysis.primary import Result, people
from vbraille.analysis.read import STRINGS, Trials
from vbraille.analysis.templates import render
from vbraille.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterable

    from pandas import DataFrame

DISTANCES = {
    "mapping": "mapping {}",
    "dot_width_mm": "dots {} mm wide",
    "dot_spacing_mm": "dot columns {} mm apart",
    "cell_gap_mm": "{} mm between cells",
}


def methods(trials: Trials | None, result: Result | None) -> list[str]:
    """Return the paragraph, a sentence each.

    Parameters
    ----------
    trials
        What was done; None for scores.
    result
        How values were compared; None to leave that out.
    """
    facts: dict[str, Any] = {"version": __version__, "versions": []}
    if trials is not None:
        facts |= _of_trials(trials.frame) | _of_sessions(trials)
    if result is not None:
        facts |= _of_tests(result)
    return render("methods.txt", **facts).strip().splitlines()


def span(counts: Iterable[int], noun: str) -> str:
    """Return a number of things, or the least and the largest.

    >>> span([26, 26], "trial"), span([1], "break"), span([2, 3], "break")
    ('26 trials', '1 break', '2 to 3 breaks')
    """
    least, *_, most = sorted([*counts, *counts])
    number = f"{most}" if least == most else f"{least} to {most}"
    return f"{number} {noun}{'' if most == 1 else 's'}"


def _of_trials(frame: DataFrame) -> dict[str, Any]:
    counts = frame.groupby("participant", observed=True).size()
    strings = frame.loc[frame["question"] == STRINGS, "presented"].str.len()
    return {
        "people": people(len(counts)),
        "trials": span(counts, "trial"),
        "each": " each" if counts.max() > 1 and len(counts) > 1 else "",
        "protocols": [name for name in frame["protocol"].unique() if name],
        "sessions": span([frame["session"].nunique()], "session"),
        "cells": span(strings, "cell") if len(strings) else "",
        "conditions": list(frame["condition"].cat.categories),
        "model": _only(frame, "model"),
        "how": [
            words.format(_only(frame, column))
            for column, words in DISTANCES.items()
            if _only(frame, column)
        ],
    }


def _only(frame: DataFrame, column: str) -> str:
    """Return the value that all trials have; empty if they differ or have none."""
    values = frame[column].dropna().unique() if column in frame else []
    if len(values) != 1:
        return ""
    return f"{values[0]:g}" if isinstance(values[0], float) else str(values[0])


def _of_sessions(trials: Trials) -> dict[str, Any]:
    """Count practice, breaks, faults and repeats in the records of sessions."""
    if not trials.contents:
        return {}
    kinds = [Counter(event.kind for event in content.events) for content in trials.contents]
    runs = [
        event.data.get("versions", {})
        for content in trials.contents
        for event in content.events
        if event.kind == "run"
    ]
    practice = [
        len({event.trial for event in content.events if event.kind == "answer" and event.practice})
        for content in trials.contents
    ]
    return {
        "practice": span(practice, "trial"),
        "breaks": span([each["break"] for each in kinds], "break"),
        "faults": sum(each["fault"] for each in kinds),
        "repeats": sum(each["repeat"] for each in kinds),
        "ended": sum(each["end"] > 0 for each in kinds),
        "begun": len(kinds),
        "versions": sorted({run.get("vbraille", "unknown") for run in runs}),
    }


def _of_tests(result: Result) -> dict[str, Any]:
    scale = result.measure.scale
    return {
        "what": "mean logarithm of the " * (scale == LOGS) + result.measure.name,
        "pairs": int(result.pairs["p"].notna().sum()) if len(result.pairs) else 0,
        "within": result.cells.shape[1] > 1,
        "grouped": result.groups is not None,
        "effects": len(result.effects),
        "shares": scale == SHARES,
        "logarithms": scale == LOGS,
        "intervals": result.means["low"].notna().any(),
    }
