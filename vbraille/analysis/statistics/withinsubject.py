"""Scores in long form, arranged by participant and condition."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from vbraille.analysis.statistics.scores import LARGEST
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

Cell: TypeAlias = "tuple[str, ...]"
"""A level of each factor, in the factors' order."""

MOST_FACTORS = 4
MOST_CELLS = 2000  # a hundred times what a session holds; contrasts grow with the square of this


@dataclass(frozen=True, slots=True, eq=False)
class WithinSubject:
    """Scores of all complete participants in all cells.

    Parameters
    ----------
    cube : float64[participants, levels of the first factor, …]
        Scores by participant and level of each factor.
    participants
        Participants in order of appearance.
    dropped
        Participants who are left out, each with the missing cells.
    averaged
        Participants who had several scores in a cell, each with the number of such cells.
    """

    cube: NDArray[np.float64]
    participants: tuple[str, ...]
    dropped: tuple[tuple[str, tuple[Cell, ...]], ...]
    averaged: tuple[tuple[str, int], ...]

    def __post_init__(self) -> None:
        if self.cube.shape[0] != len(self.participants):
            raise ValueError(f"{self.cube.shape[0]} scores of {len(self.participants)}")


def arrange(
    participants: Sequence[str],
    factors: Mapping[str, Sequence[str]],
    scores: Sequence[float] | NDArray[np.float64],
) -> WithinSubject:
    """Arrange scores: repeated cells averaged, participants with a missing cell left out.

    A level for which all scores are missing is still a level: then no participant is complete,
    and nothing is compared behind the reader's back.

    Parameters
    ----------
    participants : str[n]
        Participant of each score.
    factors
        One to four names, each with the level of every row, str[n].
    scores : float[n]
        Scores; NaN where one is missing.

    Raises
    ------
    Unanswerable
        If there are no scores, a factor has one level, there are over 2000
        cells, or fewer than two participants have a score in each.
    ValueError
        If there are no or too many factors, columns differ in length, or a
        score is infinite.
    """
    row = np.asarray(scores, dtype=np.float64)
    _check(participants, factors, row)
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
    return WithinSubject(
        np.array(means).reshape(len(complete), *map(len, levels)),
        complete,
        dropped,
        tuple((who, several) for who, several in repeats if several),
    )


def _check(
    participants: Sequence[str], factors: Mapping[str, Sequence[str]], row: NDArray[np.float64]
) -> None:
    """Raise ValueError for columns that do not make one table of scores."""
    if not 1 <= len(factors) <= MOST_FACTORS:
        raise ValueError(f"{len(factors)} factors; one to {MOST_FACTORS} are needed")
    columns = {"participants": participants, **{f"factor {n!r}": c for n, c in factors.items()}}
    for name, column in columns.items():
        if row.shape != (len(column),):
            raise ValueError(f"{name}: {len(column)} rows beside scores of shape {row.shape}")
    if (np.abs(row) > LARGEST).any():
        raise ValueError(f"scores must be within ±{LARGEST:g}, or NaN where missing")
    if np.isnan(row).all():
        raise Unanswerable("no scores")


def _too_few(
    complete: tuple[str, ...],
    dropped: tuple[tuple[str, tuple[Cell, ...]], ...],
    cells: list[Cell],
) -> str:
    """Reason why there is nobody, or nobody else, to compare."""
    who = f"one participant, '{complete[0]}'," if complete else "no participant"
    lacking = dict(dropped)
    nobody = [c for c in cells if not complete and all(c in gap for gap in lacking.values())]
    if nobody:
        return f"nobody has a score for '{', '.join(nobody[0])}'; each participant needs every cell"
    why = "; ".join(
        f"'{name}' has none for '{', '.join(gap[0])}'"
        + (f" and {len(gap) - 1} more" if len(gap) > 1 else "")
        for name, gap in dropped[:3]
    )
    more = f"; and {len(dropped) - 3} more" if len(dropped) > 3 else ""
    return f"{who} has a score in every cell; two are needed" + (f" ({why}{more})" if why else "")
