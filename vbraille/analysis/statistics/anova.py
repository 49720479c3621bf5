"""Analysis of variance of scores, with factors within participants and groups between them.

Every effect within participants is a set of orthonormal contrasts of a participant's scores; these
are regressed on the groups, whose codes add up to 0, and an effect's sum of squares is what its
own columns add to all others ("type III", which groups of unequal size do not bend). Without
groups the one column is the mean (Winer, Brown and Michels 1991, ch. 4 and 7; Kirk 2013, ch. 10
and 12; Maxwell, Delaney and Kelley 2018, ch. 12 and 14). statsmodels' AnovaRM gives the same F
within participants, and the tests hold the two against each other; but it fits a dummy for each
participant in each cell (2 s and 0.4 GB for 200 participants and 26 letters), and knows no
sphericity, so that the contrasts would be needed beside it.
"""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass
from itertools import combinations, product
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from scipy.special import fdtrc

from vbraille.analysis.statistics.intervals import Unanswerable

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    Floats: TypeAlias = NDArray[np.float64]
    Levels: TypeAlias = Mapping[str, Sequence[str]]

Cell: TypeAlias = "tuple[str, ...]"
"""A level of each factor, in the factors' order."""

MOST_FACTORS = 4
MOST_CELLS = 2000  # a hundred times what a session holds; contrasts grow with the square of this
# Sums of squares below this share of the scores' own are rounding.
ROUNDING = 1e-24


@dataclass(frozen=True, slots=True)
class Effect:
    """One effect. A value that cannot be found is None, and `note` says why.

    Parameters
    ----------
    name
        The factors' names, those between participants first, joined by " × ".
    df1, df2
        Degrees of freedom of the effect and of its error.
    note
        Why something is None, or ought not to be read on its own; may be empty.
    f, p
        F, and its p if sphericity holds.
    epsilon, p_corrected
        Greenhouse and Geisser's epsilon, and p with both degrees of freedom multiplied by it; 1
        and p for an effect between participants.
    """

    name: str
    df1: int
    df2: int
    note: str = ""
    f: float | None = None
    p: float | None = None
    epsilon: float | None = None
    p_corrected: float | None = None


@dataclass(frozen=True, slots=True)
class Anova:
    """An analysis of variance.

    Parameters
    ----------
    participants
        Participants who have a score in every cell, in order of appearance.
    dropped
        Participants who lack a score, each with the cells that are missing.
    averaged
        Members of `participants` with more than one score in a cell, each with the number of such
        cells; the mean stands for them.
    effects
        Effects between participants, then each within effect in the factors' order, interactions
        last, each followed by what it has to do with the groups.
    """

    participants: tuple[str, ...]
    dropped: tuple[tuple[str, tuple[Cell, ...]], ...]
    averaged: tuple[tuple[str, int], ...]
    effects: tuple[Effect, ...]


def anova(
    participants: Sequence[str],
    within: Levels,
    scores: Sequence[float] | Floats,
    between: Levels | None = None,
) -> Anova:
    """Analysis of variance of scores in long form, a row for each score.

    Parameters
    ----------
    participants : str[n]
        The participant of each score.
    within
        One to four factors within participants by their names, each with the level of every row,
        str[n]. Any name will do. Levels count in order of first appearance.
    scores : float[n]
        Scores in any one unit; NaN where a score is missing.
    between
        Factors between participants in the same way; None for none.

    Raises
    ------
    Unanswerable
        If there are no scores, a factor has one level, there are over 2000 cells, fewer than two
        participants have a score in each, a participant is in two groups, or some combination of
        groups is empty or no group has two.
    ValueError
        If there are no or too many factors.
    """
    cube, complete, dropped, averaged = arrange(participants, within, scores)
    parts: list[tuple[Cell, Floats]] = [((), np.ones((len(complete), 1)))]
    if between:
        groups = _group_of_each(participants, between)
        parts = _columns(list(between), [groups[who] for who in complete])
    rank = sum(columns.shape[1] for _, columns in parts)
    if len(complete) <= rank:
        raise Unanswerable(f"{len(complete)} participants in {rank} groups; some group needs two")
    names = list(within)
    contrasts = {
        subset: contrast_scores(cube, subset)
        for size in range(len(names) + 1)
        for subset in combinations(range(len(names)), size)
    }
    rounding = ROUNDING * float((cube**2).sum())
    effects = [
        effect
        for subset, z in contrasts.items()
        for effect in _effects(z, parts, [names[i] for i in subset], rounding)
    ]
    return Anova(complete, dropped, averaged, tuple(effects))


def arrange(
    participants: Sequence[str], factors: Levels, scores: Sequence[float] | Floats
) -> tuple[
    Floats, tuple[str, ...], tuple[tuple[str, tuple[Cell, ...]], ...], tuple[tuple[str, int], ...]
]:
    """Arrange scores in long form, as `anova` takes them, by participant and cell.

    Repeated scores of a cell are averaged, and participants with a missing cell left out. A level
    for which all scores are missing is still a level: then no participant is complete, and nothing
    is compared behind the reader's back.

    Returns
    -------
    cube : float64[participants, levels of the first factor, …]
    participants, dropped, averaged
        These are described at `Anova`.

    Raises
    ------
    Unanswerable, ValueError
        As of `anova`.
    """
    row = np.asarray(scores, dtype=np.float64)
    if not 1 <= len(factors) <= MOST_FACTORS:
        raise ValueError(f"{len(factors)} factors; one to {MOST_FACTORS} are needed")
    if np.isnan(row).all():
        raise Unanswerable("no scores")
    levels = [tuple(dict.fromkeys(column)) for column in factors.values()]
    for name, seen in zip(factors, levels, strict=True):
        if len(seen) == 1:
            raise Unanswerable(
                f"every score has the same {name}, '{seen[0]}'; there is nothing to compare"
            )
    count = math.prod(map(len, levels))
    if count > MOST_CELLS:
        raise Unanswerable(f"{count} cells; more than {MOST_CELLS} are not compared")
    cells = list(product(*levels))
    found: defaultdict[str, defaultdict[Cell, list[float]]]
    found = defaultdict(lambda: defaultdict(list))
    for who, cell, score in zip(
        participants, zip(*factors.values(), strict=True), row.tolist(), strict=True
    ):
        mine = found[who]
        if not math.isnan(score):
            mine[cell].append(score)
    gaps = {who: tuple(c for c in cells if c not in mine) for who, mine in found.items()}
    complete = tuple(who for who, missing in gaps.items() if not missing)
    dropped = tuple((who, missing) for who, missing in gaps.items() if missing)
    if len(complete) < 2:
        raise Unanswerable(_too_few(complete, dropped, cells))
    means = [[float(np.mean(found[who][cell])) for cell in cells] for who in complete]
    repeats = ((who, sum(len(s) > 1 for s in found[who].values())) for who in complete)
    return (
        np.array(means).reshape(len(complete), *map(len, levels)),
        complete,
        dropped,
        tuple((who, several) for who, several in repeats if several),
    )


def orthonormal_contrasts(levels: int) -> Floats:
    """Helmert's contrasts, each of length 1: float64[levels, levels - 1]."""
    raw = np.tril(np.ones((levels, levels)), -1)[1:] - np.diag(np.arange(1.0, levels), 1)[:-1]
    return (raw / np.linalg.norm(raw, axis=1, keepdims=True)).T


def contrast_scores(cube: Floats, subset: tuple[int, ...]) -> Floats:
    """Each participant's scores on the contrasts of an effect, float64[participants, df1].

    The contrasts are the Kronecker product of each factor's: its own if it acts
    in the effect, the mean (also of length 1) if not. One axis is contracted after
    the other, so that the product is never made.
    """
    for axis, levels in enumerate(cube.shape[1:]):
        mean = np.full((levels, 1), levels**-0.5)
        matrix = orthonormal_contrasts(levels) if axis in subset else mean
        cube = np.moveaxis(np.tensordot(cube, matrix, axes=(axis + 1, 0)), -1, axis + 1)
    return cube.reshape(cube.shape[0], -1)


def _effects(
    z: Floats, parts: Sequence[tuple[Cell, Floats]], acting: Sequence[str], rounding: float
) -> Iterator[Effect]:
    """Effects of a set of contrasts, float64[n, d], by itself and by group.

    With S the covariance of d contrasts, Greenhouse and Geisser 1959 estimate Box's (1954)
    ε = tr(S)² / (d tr(S²)).

    Parameters
    ----------
    parts
        Columns of the groups by the names of the factors between; one column of ones for none.
    acting
        Factors within that the contrasts are of.
    rounding
        Sum of squares up to which an error is none.
    """
    n, d = z.shape
    whole = np.hstack([columns for _, columns in parts])
    left = _left_over(z, whole)
    error, df_error = float((left**2).sum()), n - whole.shape[1]
    for own, columns in parts:
        if not own and not acting:
            continue  # a mean of 0 is no question
        rest = [others for name, others in parts if name != own]
        own_columns = np.linalg.qr(_left_over(columns, np.hstack(rest)) if rest else columns)[0]
        effect = float(((own_columns.T @ z) ** 2).sum())
        name, df1, df2 = " × ".join((*own, *acting)), d * columns.shape[1], d * df_error
        if error <= rounding:
            alike = "differ alike between its levels" if len(parts) == 1 else "of a group are alike"
            yield Effect(name, df1, df2, f"all participants {alike}; F has no value")
            continue
        spread = np.linalg.svd(left, compute_uv=False) ** 2  # eigenvalues of S, but for a factor
        ratio = (effect / df1) / (error / df2)
        epsilon = min(1.0, 1 / (d * float(((spread / spread.sum()) ** 2).sum())))
        shrunk = np.array([1.0, epsilon])
        p, p_corrected = fdtrc(shrunk * df1, shrunk * df2, np.maximum(ratio, 0.0)).tolist()
        yield Effect(name, df1, df2, "", ratio, p, epsilon, p_corrected)


def added_by(own: Floats, others: Floats, y: Floats) -> tuple[float, int, int, float]:
    """Test what some columns add to others in a regression, by least squares.

    Parameters
    ----------
    own, others : float64[n, columns]
        Columns that are tested, and those they are adjusted for; they may depend on each other.
    y : float64[n]
        Values.

    Returns
    -------
    f, df1, df2, p
        F of the sum of squares that ``own`` adds, its degrees of freedom, and its p.

    Raises
    ------
    Unanswerable
        If the columns add nothing, or leave no error.
    """
    whole = np.hstack([own, others])
    rank, rank_others = (int(np.linalg.matrix_rank(each)) for each in (whole, others))
    df1, df2 = rank - rank_others, y.size - rank
    if not df1:
        raise Unanswerable("these orders do not tell it from the other effects")
    if df2 < 1:
        raise Unanswerable("too few blocks for so many effects")
    left, without = (float((_left_over(y[:, None], each) ** 2).sum()) for each in (whole, others))
    if left <= ROUNDING * float((y**2).sum()):
        raise Unanswerable("nothing is left over of the effects; F has no value")
    f = max(0.0, without - left) / df1 / (left / df2)
    return f, df1, df2, float(fdtrc(df1, df2, np.maximum(f, 0.0)))


def _left_over(z: Floats, columns: Floats) -> Floats:
    """Residuals of a regression on columns."""
    return z - columns @ np.linalg.lstsq(columns, z, rcond=None)[0]


def _group_of_each(participants: Sequence[str], between: Levels) -> dict[str, Cell]:
    """Group of each participant: a level of each factor between."""
    found: dict[str, Cell] = {}
    for who, cell in zip(participants, zip(*between.values(), strict=True), strict=True):
        if found.setdefault(who, cell) != cell:
            raise Unanswerable(
                f"participant '{who}' is in two groups, '{', '.join(found[who])}' and "
                f"'{', '.join(cell)}'"
            )
    return found


def _columns(names: Sequence[str], groups: Sequence[Cell]) -> list[tuple[Cell, Floats]]:
    """Columns of each effect between participants, and of their mean; codes add up to 0."""
    every = [list(dict.fromkeys(column)) for column in zip(*groups, strict=True)]
    for name, levels in zip(names, every, strict=True):
        if len(levels) < 2:
            raise Unanswerable(f"everybody has the same {name}, '{levels[0]}'")
    for cell in product(*every):
        if cell not in groups:
            raise Unanswerable(f"no participant with every score is in '{', '.join(cell)}'")
    codes = []
    for levels, own in zip(every, zip(*groups, strict=True), strict=True):
        code = np.vstack([np.eye(len(levels) - 1), -np.ones(len(levels) - 1)])
        codes.append(code[[levels.index(level) for level in own]])
    parts: list[tuple[Cell, Floats]] = []
    for size in range(len(names) + 1):
        for subset in combinations(range(len(names)), size):
            columns = np.ones((len(groups), 1))
            for i in subset:
                columns = (columns[:, :, None] * codes[i][:, None, :]).reshape(len(groups), -1)
            parts.append((tuple(names[i] for i in subset), columns))
    return parts


def _too_few(
    complete: tuple[str, ...], dropped: tuple[tuple[str, tuple[Cell, ...]], ...], cells: list[Cell]
) -> str:
    """Reason why there are too few participants to compare."""
    empty = [c for c in cells if not complete and all(c in gap for _, gap in dropped)]
    if empty:
        return f"no participant has a score for '{', '.join(empty[0])}'; each needs every cell"
    who = f"one participant, '{complete[0]}'," if complete else "no participant"
    why = "; ".join(f"'{name}' has none for '{', '.join(gap[0])}'" for name, gap in dropped[:3])
    return f"{who} has a score in every cell; two are needed" + (f" ({why})" if why else "")
