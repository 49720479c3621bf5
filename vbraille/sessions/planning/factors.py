"""Conditions and factors: what is varied, within participants or between groups of them."""

from __future__ import annotations

import itertools
from typing import Annotated, Literal

from msgspec import Meta

from vbraille.sessions.planning.values import Label, Look
from vbraille.toml import Table

Cross = Literal["all"] | tuple[tuple[str, ...], ...]


class Condition(Look, frozen=True, kw_only=True):
    """A condition, or a level of a factor: its name, and what it changes of the display."""

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
    levels: Annotated[tuple[Condition, ...], Meta(min_length=2)]
    between: bool = False


def crossed(
    factors: tuple[Factor, ...], cross: Cross, *, between: bool
) -> list[tuple[Condition, dict[str, str]]]:
    """Return the combinations of the factors within participants, or between them.

    Parameters
    ----------
    cross
        "all", or the combinations that are shown, each as levels of all factors in their order.

    Returns
    -------
    list
        Each combination as a condition, and its level of each factor.
    """
    own = [factor for factor in factors if factor.between == between]
    shown = [] if cross == "all" else cross
    listed = [
        dict(zip((factor.name for factor in factors), each, strict=False)).items() for each in shown
    ]
    found = []
    for levels in itertools.product(*(factor.levels for factor in own)):
        names = {factor.name: level.name for factor, level in zip(own, levels, strict=True)}
        if cross == "all" or any(names.items() <= each for each in listed):
            look = {key: value for level in levels for key, value in level.given.items()}
            found.append((Condition(name="-".join(names.values()), **look), names))
    return found
