"""Factors: what is varied, within participants or between groups of them."""

from __future__ import annotations

import itertools
from typing import Annotated

from msgspec import Meta

from vbraille.sessions.planning.values import Label, Look
from vbraille.toml import Table


class Level(Look, kw_only=True):
    """A level of a factor: its name, and what it changes of the display."""

    name: Label


class Factor(Table, kw_only=True):
    """A factor.

    Parameters
    ----------
    name
        Its name, which is that of a column, after "factor_".
    levels
        Its levels.
    between
        Whether each participant has one of the levels, and not all.
    """

    name: Label
    levels: Annotated[tuple[Level, ...], Meta(min_length=2)]
    between: bool = False


class Cell(Table, kw_only=True):
    """A combination of levels: its name, its look, and its level of each factor."""

    name: str
    look: Look
    levels: dict[str, str]


def crossed(factors: tuple[Factor, ...], *, between: bool) -> list[Cell]:
    """Return all combinations of the factors within participants, or between them."""
    own = [factor for factor in factors if factor.between == between]
    cells = []
    for levels in itertools.product(*(factor.levels for factor in own)):
        look = Look()
        for level in levels:
            look = level.over(look)
        names = {factor.name: level.name for factor, level in zip(own, levels, strict=True)}
        cells.append(Cell(name="-".join(names.values()), look=look, levels=names))
    return cells
