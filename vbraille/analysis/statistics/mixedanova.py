"""Analysis of variance with factors within participants and factors between them.

Each within effect is a set of orthonormal contrasts of a participant's scores, as in `anova`;
each is regressed on the groups, whose codes add up to 0, and an effect's sum of squares is what
is lost without its columns ("type III", which groups of unequal size do not bend). Kirk 2013, ch.
12; Maxwell, Delaney and Kelley 2018, ch. 12 and 14.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, product
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import f as f_distribution

from vbraille.analysis.statistics.anova import ROUNDING, contrast_scores
from vbraille.analysis.statistics.sphericity import huynh_feldt
from vbraille.analysis.statistics.unanswerable import Unanswerable
from vbraille.analysis.statistics.withinsubject import arrange

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.statistics.withinsubject import Cell


@dataclass(frozen=True, slots=True)
class MixedEffect:
    """One effect of a mixed design. A value that cannot be found is None, and `note` says why.

    Parameters
    ----------
    name
        The factors' names, those between participants first, joined by " × ".
    df1, df2
        Degrees of freedom of the effect and of its error.
    f, p
        F, and its p if sphericity holds.
    epsilon, p_corrected
        Greenhouse and Geisser's epsilon, and p with both degrees of freedom multiplied by it; 1
        and p for an effect between participants.
    huynh_feldt, p_huynh_feldt
        The same by Huynh and Feldt's epsilon, as Lecoutre (1991) put it right for groups.
    partial_eta2
        SS_effect / (SS_effect + SS_error).
    note
        Why something is None; may be empty.
    """

    name: str
    df1: int
    df2: int
    f: float | None
    p: float | None
    epsilon: float | None
    p_corrected: float | None
    huynh_feldt: float | None
    p_huynh_feldt: float | None
    partial_eta2: float | None
    note: str

    def __post_init__(self) -> None:
        if self.df1 < 1 or self.df2 < 1:
            raise ValueError(f"degrees of freedom {self.df1}, {self.df2} of {self.name}")


@dataclass(frozen=True, slots=True)
class MixedAnova:
    """An analysis of variance of a mixed design.

    Parameters
    ----------
    participants
        Participants who have a score in every cell, in order of appearance.
    dropped
        Participants who lack a score, each with the cells that are missing.
    effects
        Effects between participants, then each within effect followed by what it has to do with
        the groups.
    """

    participants: tuple[str, ...]
    dropped: tuple[tuple[str, tuple[Cell, ...]], ...]
    effects: tuple[MixedEffect, ...]


def mixed_anova(
    participants: Sequence[str],
    between: Mapping[str, Sequence[str]],
    within: Mapping[str, Sequence[str]],
    scores: Sequence[float] | NDArray[np.float64],
) -> MixedAnova:
    """Analysis of variance of scores in long form, a row for each score.

    Parameters
    ----------
    participants : str[n]
        The participant of each score.
    between, within
        Factors between and within participants: one name or more, each with the level of every
        row, str[n].
    scores : float[n]
        Scores in any one unit; NaN where a score is missing.

    Raises
    ------
    Unanswerable
        If a participant is in two groups, some combination of groups has nobody or no group has
        two, or `vbraille.analysis.statistics.withinsubject.arrange` finds nothing to compare.
    ValueError
        If columns differ in length, there are no factors between, or a score is infinite.
    """
    if not between:
        raise ValueError("no factor between participants; take anova for those within")
    design = arrange(participants, within, scores)
    levels = _levels_of_each(participants, between)
    groups = [levels[who] for who in design.participants]
    parts = _columns(between, groups)
    n, rank = len(groups), sum(part.shape[1] for _, part in parts)
    if n <= rank:
        raise Unanswerable(f"{n} participants in {rank} groups; some group needs two")
    rounding = ROUNDING * float((design.cube**2).sum())
    names = tuple(within)
    effects: list[MixedEffect] = []
    for size in range(len(names) + 1):
        for subset in combinations(range(len(names)), size):
            z = contrast_scores(design.cube, subset)
            acting = [names[i] for i in subset]
            effects += _of_contrasts(z, parts, acting, rounding)
    return MixedAnova(design.participants, design.dropped, tuple(effects))


def _levels_of_each(
    participants: Sequence[str], between: Mapping[str, Sequence[str]]
) -> dict[str, Cell]:
    """Group of each participant: a level of each factor between."""
    found: dict[str, Cell] = {}
    for who, cell in zip(participants, zip(*between.values(), strict=True), strict=True):
        if found.setdefault(who, cell) != cell:
            raise Unanswerable(
                f"participant '{who}' is in two groups, '{', '.join(found[who])}' and "
                f"'{', '.join(cell)}'"
            )
    return found


def _columns(
    between: Mapping[str, Sequence[str]], groups: Sequence[Cell]
) -> list[tuple[tuple[str, ...], NDArray[np.float64]]]:
    """Columns of each effect between participants, and of their mean; codes add up to 0."""
    names = tuple(between)
    codes = []
    every = [list(dict.fromkeys(column)) for column in zip(*groups, strict=True)]
    for name, levels in zip(names, every, strict=True):
        if len(levels) < 2:
            raise Unanswerable(f"everybody has the same {name}, '{levels[0]}'")
    for cell in product(*every):
        if cell not in groups:
            raise Unanswerable(f"nobody with every score is in '{', '.join(cell)}'")
    for levels, own in zip(every, zip(*groups, strict=True), strict=True):
        code = np.vstack([np.eye(len(levels) - 1), -np.ones(len(levels) - 1)])
        codes.append(code[[levels.index(level) for level in own]])
    parts: list[tuple[tuple[str, ...], NDArray[np.float64]]] = []
    for size in range(len(names) + 1):
        for subset in combinations(range(len(names)), size):
            column = np.ones((len(groups), 1))
            for i in subset:
                column = (column[:, :, None] * codes[i][:, None, :]).reshape(len(groups), -1)
            parts.append((tuple(names[i] for i in subset), column))
    return parts


def _of_contrasts(
    z: NDArray[np.float64],
    parts: Sequence[tuple[tuple[str, ...], NDArray[np.float64]]],
    acting: Sequence[str],
    rounding: float,
) -> Iterator[MixedEffect]:
    """Effects of a set of contrasts, float64[n, d], by itself and by group."""
    n, d = z.shape
    whole = np.hstack([column for _, column in parts])
    left = z - whole @ np.linalg.lstsq(whole, z, rcond=None)[0]
    squares = left.T @ left
    error, df_error = float(np.trace(squares)), n - whole.shape[1]
    for names, column in parts:
        if not names and not acting:
            continue  # that the mean of everything is 0 is nobody's question
        rest = np.hstack([other for name, other in parts if name != names] or [whole[:, :0]])
        alone = z - rest @ np.linalg.lstsq(rest, z, rcond=None)[0]
        effect = float((alone**2).sum()) - error
        name = " × ".join((*names, *acting))
        df1, df2 = d * column.shape[1], d * df_error
        if error <= rounding:
            note = "all participants of a group are alike; F has no value"
            yield MixedEffect(name, df1, df2, None, None, None, None, None, None, None, note)
            continue
        ratio = effect / df1 / (error / df2)
        narrow = error**2 / (d * float((squares**2).sum()))
        wide = huynh_feldt(narrow, n, d, groups=n - df_error)
        p, p_narrow, p_wide = (
            float(f_distribution.sf(ratio, epsilon * df1, epsilon * df2))
            for epsilon in (1.0, narrow, wide)
        )
        share = effect / (effect + error)
        yield MixedEffect(name, df1, df2, ratio, p, narrow, p_narrow, wide, p_wide, share, "")
