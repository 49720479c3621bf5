"""Factors: what is varied, within participants or between groups of them."""

from __future__ import annotations

import itertools
from typing import Annotated, Literal

from msgspec import Meta

from vbraille.sessions.planning.values import Label, Look
from vbraille.toml import Table

Cross = Literal["all"] | tuple[tuple[str, ...], ...]


class Level(Look, frozen=True, kw_only=True):
    """A level of a factor: its name, and what it changes of the display."""

    name: Label


class Factor(Table, frozen=True, kw_only=True):
    """A factor.

    Parameters
    ----------
    name
        Name, which is that of a column, after "factor_".
    levels
        Two or more levels.
    between
        Whether each participant has one of the levels, and not all.
    """

    name: Label
    levels: Annotated[tuple[Level, ...], Meta(min_length=2)]
    between: bool = False


class Cell(Table, frozen=True, kw_only=True):
    """A combination of levels: its name, its look, and its level of each factor."""

    name: str
    look: Look
    levels: dict[str, str]


def crossed(factors: tuple[Factor, ...], cross: Cross, *, between: bool) -> list[Cell]:
    """Return the combinations of the factors within participants, or between them.

    Parameters
    ----------
    cross
        "all", or the combinations that are shown, each as levels of all factors in their order.
    """
    own = [factor for factor in factors if factor.between == between]
    cells = []
    for levels in itertools.product(*(factor.levels for factor in own)):
        names = {factor.name: level.name for factor, level in zip(own, levels, strict=True)}
        if cross != "all" and not any(_holds(names, listed, factors) for listed in cross):
            continue
        look = Look()
        for level in levels:
            look = level.over(look)
        cells.append(Cell(name="-".join(names.values()), look=look, levels=names))
    return cells


def _holds(names: dict[str, str], listed: tuple[str, ...], factors: tuple[Factor, ...]) -> bool:
    """Tell whether a listed combination has these levels."""
    levels = dict(zip((factor.name for factor in factors), listed, strict=False))
    return names.items() <= levels.items()
