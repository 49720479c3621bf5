"""Designs: which effects and which pairs are tested of people's values in cells.

`effects_of` and `pairs_of` take one study or many; `compare` makes tables of one.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import pandas as pd
from pandas import DataFrame, Series

from vbraille.analysis import stats

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.analysis.stats import Floats, FTest, TTest


class Design(NamedTuple):
    """Factors of a study.

    Parameters
    ----------
    factors, levels
        Names of the factors, and of the levels of each; the one between people is the last.
    member : int[people]
        Group of each person, from 0; None if there is no factor between people.
    """

    factors: list[str]
    levels: list[list[str]]
    member: NDArray[np.int64] | None = None

    @property
    def within(self) -> list[int]:
        """Number of levels of each factor within people."""
        counts = [len(each) for each in self.levels]
        return counts if self.member is None else counts[:-1]


def effects_of(cube: Floats, design: Design) -> Iterator[tuple[str, FTest]]:
    """Test each effect of a design; yield its name and its test.

    Parameters
    ----------
    cube : float64[..., people, cells]
        Values, without holes; cells are in the order of the last factor first.
    """
    for tested in stats.effect_names(len(design.within)):
        values = cube @ stats.contrasts(design.within, tested)
        names = [design.factors[place] for place in tested]
        if tested:
            yield " × ".join(names), stats.effect_within(values, design.member)
        if design.member is not None:
            name = " × ".join([design.factors[-1], *names])
            yield name, stats.effect_with_groups(values, design.member)


def pairs_of(cube: Floats, design: Design) -> Iterator[tuple[str, str, str, TTest]]:
    """Compare the levels of each factor in pairs; yield the factor, both levels, and the test.

    Other factors are averaged over within each person; `effects_of` describes the arguments.
    """
    counts = design.within
    parts = cube.reshape(*cube.shape[:-1], *counts)
    for place, (name, levels) in enumerate(zip(design.factors, design.levels, strict=True)):
        grouped = place == len(counts)
        others = tuple(n - len(counts) for n in range(len(counts)) if n != place)
        means = parts.mean(axis=others) if others else parts
        for first, second in combinations(range(len(levels)), 2):
            if grouped:
                groups = (means[..., design.member == each] for each in (first, second))
                test = stats.welch(*groups)
            else:
                test = stats.paired(means[..., first] - means[..., second])
            yield name, levels[first], levels[second], test


def levels_of(cells: DataFrame) -> list[list[str]]:
    """Return the levels of each factor within people, in their order; none of groups alone."""
    if cells.shape[1] == 1:
        return []
    columns = cells.columns
    return [list(columns.unique(n)) for n in range(columns.nlevels)]


def compare(cells: DataFrame, groups: Series | None = None) -> tuple[DataFrame, DataFrame]:
    """Test effects and pairs of people's values.

    Parameters
    ----------
    cells
        A row is a person, and a column a cell, named by one level of each factor; all combinations
        have a column, those of the last factor first. People with a hole are in no test.
    groups
        Group of each person, whose name is that of the factor between people.

    Returns
    -------
    effects, pairs
        A row for each test, with p and with p corrected by Holm among the rows.
    """
    whole = cells.dropna()
    levels = levels_of(whole)
    factors = [str(name) for name in whole.columns.names] if levels else []
    member = None
    sizes = Series(dtype=int)
    if groups is not None:
        member, found = pd.factorize(groups.loc[whole.index], sort=True)
        sizes = groups.loc[whole.index].value_counts()
        factors, levels = [*factors, str(groups.name)], [*levels, list(found)]
    design = Design(factors, levels, member)
    cube = whole.to_numpy(float)
    people = {"participants": len(whole)}
    least = len(whole) if member is None else sizes.min() if len(sizes) > 1 else 0
    if least >= stats.FEWEST:
        effects = [
            {"effect": name} | people | _floats(test) for name, test in effects_of(cube, design)
        ]
    else:
        effects = [{"effect": "all"} | people | {"note": stats.TOO_FEW}] if len(factors) > 1 else []
    pairs = []
    for factor, first, second, test in pairs_of(cube, design):
        if factor == factors[-1] and member is not None:
            people = {"participants": int(sizes[first] + sizes[second])}
        row = {"factor": factor, "first": first, "second": second}
        pairs.append(row | people | _floats(test))
    return _corrected(effects), _corrected(pairs)


def _floats(test: FTest | TTest) -> dict[str, float | str]:
    return {name: x if name == "note" else float(x) for name, x in test._asdict().items()}


def _corrected(rows: list[dict]) -> DataFrame:
    """Return a table of tests with Holm's p, and with intervals where there is an error."""
    table = DataFrame(rows)
    if "p" not in table:
        return table
    corrected, k = stats.holm(table["p"])
    table.insert(list(table).index("p") + 1, "p_holm", corrected)
    if "error" in table:
        table["k"] = k
        ends = stats.t_interval(table["value"], table["error"], table["df"], k)
        table["low"], table["high"] = ends
    return table[[*table.columns.drop("note"), "note"]]


def simple_effects(cells: DataFrame, groups: Series | None = None) -> DataFrame:
    """Test the other factors at each level of each factor; p is corrected among all rows."""
    whole = cells.dropna()
    factors = list(whole.columns.names) if levels_of(whole) else []
    parts = []
    for factor in factors if len(factors) > 1 or groups is not None else []:
        for level in whole.columns.unique(factor):
            at = whole[[level]] if len(factors) == 1 else whole.xs(level, axis=1, level=factor)
            parts.append((f"{factor} {level}", at, groups))
    if groups is not None and factors:
        for level, people in groups.loc[whole.index].groupby(groups, observed=True):
            parts.append((f"{groups.name} {level}", whole.loc[people.index], None))
    rows = [
        {"at": name} | row
        for name, at, own in parts
        for row in compare(at, own)[0].drop(columns="p_holm", errors="ignore").to_dict("records")
    ]
    return _corrected(rows)
