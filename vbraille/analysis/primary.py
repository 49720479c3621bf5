"""The planned comparison: people's values in cells, the tests, who is left out, and sentences."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from pandas import DataFrame, Series

from vbraille.analysis import designs, stats
from vbraille.analysis.measures import CHOICES, LOGS, PLAIN, SHARES, Measure, alternatives
from vbraille.analysis.read import in_order, read_scores
from vbraille.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.analysis.plan import Plan

SCORE = Measure("score", PLAIN, (), lambda trials, _: trials)
UNEQUAL_TRIALS = 2
END_SHARES = (0.1, 0.9)
SMALL_GROUP = 6


@dataclass
class Result:
    """A comparison, as tables and as sentences.

    Parameters
    ----------
    measure
        What was compared.
    cells
        Value of each person of the tests (rows) in each cell (columns), logarithms as such.
    groups
        Group of each person; None if there are no groups.
    means, effects, pairs, simple
        Mean of each cell, each effect, each two levels, and simple effects.
    left_out
        People who are in no test, each with the reason.
    """

    measure: Measure
    cells: DataFrame
    groups: Series | None
    means: DataFrame
    effects: DataFrame
    pairs: DataFrame
    simple: DataFrame
    left_out: list[str]
    warnings: list[str] = field(default_factory=list)
    sentences: list[str] = field(default_factory=list)


def compare(trials: DataFrame, plan: Plan) -> Result:
    """Make the planned comparison.

    Parameters
    ----------
    trials
        Trials of the planned question, less what the plan leaves out; their factors are in order.

    Raises
    ------
    InputError
        If more than three factors vary within people, or more than one between them.
    """
    values = plan.of.values(trials, ["participant", *plan.factors])
    result = result_of(plan.of, *_in_cells(values, "no trial"))
    result.warnings += _warnings(result, trials, plan)
    result.sentences[len(result.means) : len(result.means)] = _say_chance(trials, plan)
    return result


def compare_scores(path: str | Path) -> Result:
    """Compare a table of scores; `read_scores` describes it and its errors."""
    return result_of(SCORE, *_in_cells(read_scores(path), "no score"))


def result_of(
    measure: Measure, cells: DataFrame, groups: Series | None, left_out: list[str]
) -> Result:
    """Test people's values in cells, and say what was found; `Result` describes the arguments."""
    effects = pairs = DataFrame()
    if cells.shape[1] > 1 or groups is not None:
        effects, pairs = designs.compare(cells, groups)
    if len(effects) == 1 and len(pairs) == 1:
        effects = DataFrame()  # its F is the t of the only pair, squared
    means = _means(cells, groups, measure.scale)
    simple = designs.simple_effects(cells, groups)
    result = Result(measure, cells, groups, means, effects, pairs, simple, left_out)
    result.sentences = [*_say_means(result), *_say_effects(result), *_say_pairs(result)]
    return result


def _in_cells(values: DataFrame, missing: str) -> tuple[DataFrame, Series | None, list[str]]:
    """Return people by cells, their groups, and who is left out with the reason."""
    table = values.reset_index()
    per_person = table.groupby("participant", observed=True)
    factors = list(map(str, values.index.names[1:]))
    between = [name for name in factors if per_person[name].nunique().max() == 1]
    within = [name for name in factors if name not in between]
    if len(between) > 1 or len(within) > 3:
        raise InputError(
            f"{', '.join(within) or 'no factor'} vary within people, and "
            f"{', '.join(between) or 'none'} between them; at most three and one can be compared"
        )
    groups = None
    if between:
        groups = table.drop_duplicates("participant").set_index("participant")[between[0]]
    if within:
        levels = [list(in_order(table[name]).cat.categories) for name in within]
        cells = pd.MultiIndex.from_product(levels, names=within)
        if len(within) == 1:
            cells = cells.get_level_values(0)
        wide = table.pivot(index="participant", columns=list(cells.names), values="value")
        why = table.pivot(index="participant", columns=list(cells.names), values="why")
        wide, why = wide.reindex(columns=cells), why.reindex(columns=cells).fillna(missing)
    else:
        wide, why = (table.set_index("participant")[[name]] for name in ("value", "why"))
        why.columns = wide.columns
    left_out = []
    for person in wide.index[wide.isna().any(axis=1)]:
        reasons = {}
        for name in wide.columns[wide.loc[person].isna()]:
            reasons.setdefault(why.loc[person, name], []).append(cell_words(name))
        told = [
            f"{reason} in {', '.join(names)}" if within else reason
            for reason, names in reasons.items()
        ]
        left_out.append(f"{person}: {'; '.join(told)}")
    kept = wide.dropna()
    return kept, None if groups is None else groups[kept.index].astype(str), left_out


def cell_words(name: Any) -> str:
    """Return the name of a cell, a text or several, in words."""
    return name if isinstance(name, str) else ", ".join(name)


def _means(cells: DataFrame, groups: Series | None, scale: str) -> DataFrame:
    """Return the mean of each cell with its interval, over the people of the tests."""
    parts = [("", cells)]
    if groups is not None:
        parts = [(str(name), cells.loc[own.index]) for name, own in groups.groupby(groups)]
    rows = []
    for group, part in parts:
        for column in part:
            values = part[column].to_numpy(float)
            own = [group] if column == "value" else [group, cell_words(column)]
            name = ", ".join(filter(None, own)) or "all"
            interval = stats.mean_share if scale == SHARES else stats.mean_interval
            mean = values.mean() if values.size else np.nan
            numbers = np.array([mean, *interval(values)] if values.size else [np.nan] * 3)
            rows.append((name, values.size, *(np.exp(numbers) if scale == LOGS else numbers)))
    return DataFrame(rows, columns=["cell", "participants", "mean", "low", "high"])


def _warnings(result: Result, asked: DataFrame, plan: Plan) -> list[str]:
    """Say where the tests are known to find differences that are not there."""
    made = []
    keys = ["participant", *plan.factors]
    counts = asked.groupby(keys, observed=True).size().groupby(keys[1:] or "participant").mean()
    shares = result.means["mean"]
    at_end = shares.lt(END_SHARES[0]).any() or shares.gt(END_SHARES[1]).any()
    unequal = len(result.means) > 1 and counts.max() > UNEQUAL_TRIALS * counts.min()
    if result.measure.scale == SHARES and unequal and at_end:
        made.append(
            f"Conditions have {counts.min():.0f} to {counts.max():.0f} trials a person, and a "
            f"share is near 0 or 100 %: in such data, differences that do not exist are found too "
            f"often."
        )
    if result.groups is not None:
        sizes = result.groups.value_counts()
        if sizes.min() < SMALL_GROUP and 2 * sizes.min() < sizes.max():
            made.append(
                f"The groups have {sizes.min()} and {sizes.max()} people: with such sizes, a "
                f"difference that does not exist is found in 10 to 17 % of studies."
            )
    planned = plan.participants
    if planned and planned != len(result.cells):
        made.append(f"{planned} people were planned; the tests are of {len(result.cells)}.")
    return made


def _say_chance(asked: DataFrame, plan: Plan) -> list[str]:
    """Say how many right answers guessing gives, where the possible answers are known."""
    offered = alternatives(asked) if plan.question in CHOICES else asked["presented"].nunique()
    limited = plan.question in (*CHOICES, "name") and np.min(offered) > 1
    if plan.measure != "right" or not limited:
        return []
    return [f"Guessing alone would give {100 * np.mean(1 / offered):.0f} %."]


def people(count: int) -> str:
    """Return a number of people in words."""
    return f"{count} {'person' if count == 1 else 'people'}"


def plain(value: float) -> str:
    """Return a number with three significant digits, and without an exponent."""
    if value == 0 or not np.isfinite(value):
        return "0" if value == 0 else ""
    digits = min(max(2 - int(np.floor(np.log10(abs(value)))), 0), 6)
    return f"{value:.{digits}f}".replace("-", "−")


def p_words(value: float, name: str = "p") -> str:
    """Return a p with two digits, or more where it would round to 0.05."""
    if value < 0.001:
        return f"{name} < 0.001"
    digits = next(n for n in (3, 5, 7, 9) if n == 9 or round(value, n) != stats.ALPHA)
    return f"{name} = {value:.{digits}f}"


def _number(measure: Measure, value: float) -> str:
    return f"{100 * value:.1f} %" if measure.scale == SHARES else plain(value) + measure.unit


def _difference(measure: Measure, value: float, unit: str | None = None) -> str:
    """Say a difference, or a ratio of logarithms; those of shares are clipped to ±100 points."""
    if measure.scale == SHARES:
        number = f"{np.clip(100 * value, -100, 100):.1f}".replace("-", "−")
        return number + (" points" if unit is None else unit)
    if measure.scale == LOGS:
        return plain(np.exp(value))
    return plain(value) + (measure.unit if unit is None else unit)


def _say_means(result: Result) -> list[str]:
    made = []
    kind = "Geometric mean" if result.measure.scale == LOGS else "Mean"
    for row in result.means.to_dict("records"):
        where = "" if len(result.means) == 1 else f", {row['cell']}"
        mean, low, high = (_number(result.measure, row[each]) for each in ("mean", "low", "high"))
        how = f"95 % interval {low} to {high}"
        if np.isnan(row["low"]):
            how = "all alike" if row["participants"] >= stats.FEWEST else "too few for an interval"
        said = f"{mean} ({people(row['participants'])}, {how})"
        if not row["participants"]:
            said = "no person has a value in every cell"
        made.append(f"{kind} {result.measure.name}{where}: {said}.")
    return made


def _say_effects(result: Result) -> list[str]:
    made = []
    several = len(result.effects) > 1
    for row in result.effects.to_dict("records"):
        text = f"Effect of {row['effect']} ({people(row['participants'])})"
        if row["note"]:
            made.append(f"{text}: {row['note']}.")
            continue
        text += f": F({row['df1']:.2f}, {row['df2']:.2f}) = {plain(row['F'])}, {p_words(row['p'])}"
        if several:
            text += f", {p_words(row['p_holm'], 'Holm’s p')}"
        if np.isnan(row["epsilon"]):
            text += " by Welch’s test"
        elif row["df1_uncorrected"] > 1:
            df = f"{row['df1_uncorrected']:.0f}, {row['df2_uncorrected']:.0f}"
            p = p_words(row["p_uncorrected"])
            text += f" by Greenhouse and Geisser (without: F({df}), {p})"
        text += f", partial η² = {row['partial_eta2']:.2f}"
        if several:
            found = "an effect is shown" if row["p_holm"] <= stats.ALPHA else "no effect is shown"
            text += f": {found}"
        made.append(text + ".")
    return made


def _say_pairs(result: Result) -> list[str]:
    """Say each difference: it is shown where Holm's p is at most 0.05."""
    made = []
    sign = "divided by" if result.measure.scale == LOGS else "less"
    for row in result.pairs.to_dict("records") if len(result.cells) else []:
        text = f"{row['first']} {sign} {row['second']}: "
        text += _difference(result.measure, row["value"])
        if row["note"]:
            made.append(f"{text} ({people(row['participants'])}); {row['note']}.")
            continue
        shown = row["p_holm"] <= stats.ALPHA
        ends = " to ".join(_difference(result.measure, row[end], "") for end in ("low", "high"))
        p = p_words(row["p_holm"], "Holm’s p" if len(result.pairs) > 1 else "p")
        made.append(
            f"{text} (interval {ends}), t({row['df']:.4g}) = {plain(row['t'])}, {p}, "
            f"g = {plain(row['hedges_g'])}, {people(row['participants'])}: "
            f"{'a' if shown else 'no'} difference is shown."
        )
    return made
