"""Measures: what each person's value in a cell is, and why one is missing.

A cell is a combination of levels of the factors that are compared.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from pandas import DataFrame, Series

from vbraille.analysis import stats
from vbraille.analysis.read import LEVELS, SIGNALS, STRINGS, to_number
from vbraille.analysis.tables import compared, durations, places
from vbraille.analysis.thresholds import Threshold, find_preferred, find_threshold

SHARES, LOGS, PLAIN = "shares", "logarithms", "values"
SIGNAL = ("hit", "miss")
CHOICES = ("which", "odd", "match")
SCORED = ("name", *CHOICES, "detect", "same-different")
TO_ONE = ("contrast", "texture")  # levels from 0 to 1; others are lengths

Values = Callable[[DataFrame, list[str]], DataFrame]


@dataclass(frozen=True)
class Measure:
    """A measure.

    Parameters
    ----------
    name
        Name in sentences.
    scale
        "shares" of right answers; "logarithms" of what is above 0, so that differences are ratios;
        or "values" as they are.
    questions
        Kinds of question that give it.
    values
        Function of trials and the columns of a cell, which returns a row for each person and cell,
        with columns ``value`` and ``why``: the reason for which a value is missing.
    unit
        Unit, with a blank before it.
    """

    name: str
    scale: str
    questions: tuple[str, ...]
    values: Values
    unit: str = ""


def _means(numbers: Callable[[DataFrame], Series], why: str, *, log: bool = False) -> Values:
    """Return a function that averages numbers of trials, or their logarithms."""

    def values(trials: DataFrame, keys: list[str]) -> DataFrame:
        made = numbers(trials)
        if log:
            made = made.where(made > 0).transform(np.log)
        value = made.groupby([trials[key] for key in keys], observed=True).mean()
        return DataFrame({"value": value, "why": np.where(value.isna(), why, "")})

    return values


def _right(trials: DataFrame) -> Series:
    return trials["right"].astype(float)


def _answered(trials: DataFrame) -> Series:
    return to_number(trials["answered"])


def _speed(trials: DataFrame) -> Series:
    return trials.get("words_per_minute", Series(np.nan, trials.index))


def _characters(trials: DataFrame, keys: list[str]) -> DataFrame:
    value = places(trials, keys).groupby(keys, observed=True)["right"].mean()
    value = value.reindex(trials.groupby(keys, observed=True).size().index)
    why = "no answer as long as what was presented"
    return DataFrame({"value": value, "why": np.where(value.isna(), why, "")})


def detections(trials: DataFrame, keys: list[str]) -> DataFrame:
    """Return hits, false alarms and d′ of each person in each cell.

    Trials with nothing to detect have no condition: those of a person count in each.
    """
    signal = trials["outcome"].isin(SIGNAL)
    shown = trials[signal]
    made = (shown["outcome"] == "hit").groupby([shown[key] for key in keys], observed=True)
    table = made.agg(signals="size", hits="sum").reset_index()
    blank = trials[~signal]
    noises = (blank["outcome"] == "false alarm").groupby(blank["participant"], observed=True)
    counted = noises.agg(noises="size", false_alarms="sum")
    table = table.merge(counted, "left", left_on="participant", right_index=True)
    table[["noises", "false_alarms"]] = table[["noises", "false_alarms"]].fillna(0).astype(int)
    differ = (trials["question"] == "same-different").any()
    d_prime = stats.d_prime_differencing if differ else stats.d_prime
    hit_rate = stats.hautus_rate(table["hits"], table["signals"])
    false_rate = stats.hautus_rate(table["false_alarms"], table["noises"])
    known = table["noises"] > 0
    table["d_prime"] = np.where(known, d_prime(hit_rate, false_rate), np.nan)
    return table.assign(why=np.where(known, "", "no d′, as no trial had nothing to detect"))


def level_of(trials: DataFrame) -> str:
    """Return the column whose levels a threshold is found among; empty if none varies."""
    if trials["question"].isin(CHOICES).any():
        return "difference"
    shown = trials[trials["outcome"].isin((*SIGNAL, "right", "wrong")) | trials["outcome"].isna()]
    counts = {name: shown[name].nunique() for name in LEVELS if name in shown}
    return max(counts, key=lambda name: counts[name]) if max(counts.values(), default=0) > 1 else ""


def thresholds(trials: DataFrame, keys: list[str]) -> DataFrame:
    """Return the threshold of each person in each cell, with its interval.

    Of detection it is where half of what is neither guessed nor lapsed is felt; of one of several,
    the difference at which half of what is not guessed is right.
    """
    level = level_of(trials)
    blank = trials["outcome"].isin(("false alarm", "correct rejection"))
    levels = differences(trials) if level == "difference" else trials.get(level)
    rows = []
    for cell, own in trials[~blank].groupby(keys, observed=True):
        noises = trials.loc[blank & (trials["participant"] == cell[0]), "outcome"]
        found = Threshold(why="no level varies")
        if levels is not None:
            known = own[levels[own.index].notna()]
            found = find_threshold(
                levels[known.index],
                known["right"],
                guess=_guess(known),
                blanks=(int((noises == "false alarm").sum()), len(noises)),
                by_ratio=level == "difference",
                most=max(1.0, levels.max()) if level in TO_ONE else np.inf,
            )
        rows.append((*cell, len(own), len(noises), *found))
    columns = [*keys, "trials", "blanks", "threshold", *Threshold._fields[1:]]
    return DataFrame(rows, columns=columns)


def differences(trials: DataFrame) -> Series:
    """Return by how much the compared values differ; missing where they do not."""
    values = compared(trials)
    apart = values.max(axis=1) - values.min(axis=1)
    return apart.where(apart > 0)


def alternatives(trials: DataFrame) -> Series:
    """Return among how many stimuli one was right: of a match, two."""
    offered = trials["presented"].str.count(r"\S+")
    return offered.mask(trials["question"] == "match", 2)


def _guess(trials: DataFrame) -> float | None:
    question = trials["question"].iloc[0]
    if question in CHOICES:
        return 1 / float(alternatives(trials).max())
    return None if question == "detect" else 0.0


def _with_why(column: str, found: Callable[[DataFrame, list[str]], DataFrame]) -> Values:
    def values(trials: DataFrame, keys: list[str]) -> DataFrame:
        table = found(trials, keys).set_index(keys)
        return table[[column, "why"]].rename(columns={column: "value"})

    return values


def preferences(trials: DataFrame, keys: list[str]) -> DataFrame:
    """Return the preferred value of each person in each cell, with its interval."""
    values = compared(trials)
    chose_first = np.isclose(values[0], _answered(trials))
    trials = trials.assign(first=values[0], second=values.get(1), chose_first=chose_first)
    rows = []
    for cell, own in trials.groupby(keys, observed=True):
        known = own.dropna(subset=["first", "second"])
        found = Threshold(why="no two values were compared")
        if len(known):
            found = find_preferred(known["first"], known["second"], known["chose_first"])
        rows.append((*cell, len(known), found.value, found.low, found.high, found.why))
    return DataFrame(rows, columns=[*keys, "comparisons", "preferred", "low", "high", "why"])


MEASURES = {
    "legibility": Measure("legibility of strings", SHARES, (STRINGS,), _means(_right, "")),
    "characters": Measure("legibility of characters", SHARES, (STRINGS,), _characters),
    "right": Measure("share of right answers", SHARES, SCORED,
                     _means(_right, "")),
    "duration": Measure(
        "duration of right answers", LOGS, (STRINGS, "name", *CHOICES),
        _means(lambda trials: durations(trials).where(trials["right"]),
               "no duration of a right answer", log=True), " s",
    ),
    "threshold": Measure("threshold", PLAIN, ("detect", *CHOICES, STRINGS),
                         _with_why("threshold", thresholds)),
    "d_prime": Measure("d′", PLAIN, ("detect", "same-different"), _with_why("d_prime", detections)),
    "preferred": Measure("preferred value", PLAIN, ("which",),
                         _with_why("preferred", preferences)),
    "rating": Measure("rating", PLAIN, ("rating",), _means(_answered, "no number")),
    "adjusted": Measure("adjusted value", PLAIN, ("adjust",), _means(_answered, "no number")),
    "magnitude": Measure("magnitude", LOGS, ("magnitude",),
                         _means(_answered, "no magnitude above 0", log=True)),
    "reading_speed": Measure("reading speed", LOGS, ("read",),
                             _means(_speed, "no speed", log=True), " words/min"),
}  # fmt: skip


def usual_measure(trials: DataFrame) -> str:
    """Return the name of the usual measure of what was asked; empty if there is none."""
    question = trials["question"].iloc[0]
    if question == "detect" and level_of(trials):
        return "threshold"
    if question in SIGNALS:
        return "d_prime"
    if question == "which":
        return "threshold" if trials["outcome"].notna().any() else "preferred"
    return next((name for name, each in MEASURES.items() if question in each.questions), "")
