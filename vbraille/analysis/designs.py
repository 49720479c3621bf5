"""Designs: which effects and which pairs are tested of people's values in cells.

`effects_of` and `pairs_of` take one study or many; `compare` makes tables of one.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pandas as pd
from pandas import DataFrame, Series

from vbraille.analysis import stats

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike

    from vbraille.analysis.stats import Floats, FTest, TTest

GROUP = -1  # place of the factor between people


class Effect(NamedTuple):
    """A tested effect: places of its factors, `GROUP` first if it is one, and its test."""

    factors: tuple[int, ...]
    test: FTest


class Pair(NamedTuple):
    """Two compared levels of a factor, by their places, and their test."""

    factor: int
    first: int
    second: int
    test: TTest


def effects_of(
    cube: Floats, levels: list[int], member: ArrayLike | None = None
) -> Iterator[Effect]:
    """Test each effect of a design.

    Parameters
    ----------
    cube : float64[..., people, cells]
        Values, without holes; cells are in the order of the last factor first.
    levels
        Number of levels of each factor within people; none for groups alone.
    member : int[people]
        Group of each person, from 0; None if there are no groups.
    """
    for tested in stats.effect_names(len(levels)):
        values = cube @ stats.contrasts(levels, tested)
        if tested:
            yield Effect(tested, stats.effect_within(values, member))
        if member is not None:
            yield Effect((GROUP, *tested), stats.effect_with_groups(values, member))


def pairs_of(cube: Floats, levels: list[int], member: ArrayLike | None = None) -> Iterator[Pair]:
    """Compare the levels of each factor in pairs; `effects_of` describes the arguments.

    Other factors are averaged over within each person.
    """
    for factor, count in enumerate(levels):
        parts = cube.reshape(*cube.shape[:-1], *levels)
        others = [place - len(levels) for place in range(len(levels)) if place != factor]
        means = parts.mean(axis=tuple(others))
        for first, second in combinations(range(count), 2):
            test = stats.paired(means[..., first] - means[..., second])
            yield Pair(factor, first, second, test)
    if member is not None:
        means = cube.mean(axis=-1)
        groups = [means[..., np.equal(member, each)] for each in range(np.max(member) + 1)]
        for first, second in combinations(range(len(groups)), 2):
            test = stats.welch(groups[first], groups[second])
            yield Pair(GROUP, first, second, test)


def levels_of(cells: DataFrame) -> list[list[str]]:
    """Return the levels of each factor within people, in their order; none of groups alone."""
    if cells.shape[1] == 1:
        return []
    table = cells.columns.to_frame(index=False)
    return [list(dict.fromkeys(table[name])) for name in table]


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
    names = [str(name) for name in whole.columns.names] if levels else []
    member = None
    named: list[str] = []
    if groups is not None:
        member, found = pd.factorize(groups.loc[whole.index], sort=True)
        named = [str(name) for name in found]
        names.append(str(groups.name))  # at the place GROUP, which is the last
    counts = [len(each) for each in levels]
    cube = whole.to_numpy(float)
    enough = len(whole) >= stats.FEWEST if member is None else len(named) > 1
    if not enough or (member is not None and np.bincount(member).min() < stats.FEWEST):
        note = {"effect": "all", "participants": len(whole), "note": stats.TOO_FEW}
        effects = [note] if len(counts) > 1 or (counts and named) else []
    else:
        effects = []
        for factors, test in effects_of(cube, counts, member):
            own = {"effect": " × ".join(names[n] for n in factors), "participants": len(whole)}
            effects.append(own | _floats(test))
    pairs = []
    for factor, first, second, test in pairs_of(cube, counts, member):
        own = named if factor == GROUP else levels[factor]
        people = len(whole) if factor != GROUP else int(np.isin(member, [first, second]).sum())
        pairs.append(
            {"factor": names[factor], "first": own[first], "second": own[second]}
            | {"participants": people}
            | _floats(test)
        )
    return _corrected(effects), _corrected(pairs)


def _floats(test: FTest | TTest) -> dict[str, float | str]:
    return {name: x if name == "note" else float(x) for name, x in test._asdict().items()}


def _corrected(rows: list[dict]) -> DataFrame:
    """Return a table of tests with Holm's p, and with intervals where there is an error."""
    table = DataFrame(rows)
    if "p" not in table:
        return table
    corrected, k = stats.holm(table["p"])
    table.insert(table.columns.get_loc("p") + 1, "p_holm", corrected)
    if "error" in table:
        table["k"] = k
        ends = stats.t_interval(table["value"], table["error"], table["df"], k)
        table["low"], table["high"] = ends
    return table[[*table.columns.drop("note"), "note"]]


def simple_effects(cells: DataFrame, groups: Series | None = None) -> DataFrame:
    """Test the other factors at each level of each factor; p is corrected among all rows."""
    whole = cells.dropna()
    found = []
    factors = list(whole.columns.names) if levels_of(whole) else []
    for factor in factors if len(factors) > 1 or groups is not None else []:
        for level in whole.columns.unique(factor):
            at = whole[[level]] if len(factors) == 1 else whole.xs(level, axis=1, level=factor)
            found.append(compare(at, groups)[0].assign(at=f"{factor} {level}"))
    if groups is not None and factors:
        for level, people in groups.loc[whole.index].groupby(groups, observed=True):
            at = whole.loc[people.index]
            found.append(compare(at)[0].assign(at=f"{groups.name} {level}"))
    tables = [table for table in found if "p" in table]
    if not tables:
        return DataFrame()
    made = pd.concat(tables, ignore_index=True).drop(columns="p_holm")
    made.insert(0, "at", made.pop("at"))
    return _corrected(made.to_dict("records"))
