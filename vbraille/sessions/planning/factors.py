"""Factors of a design: conditions that are named from levels, and groups of participants."""

from __future__ import annotations

from itertools import chain, product
from typing import TYPE_CHECKING, Any, Literal

from msgspec import structs

from vbraille.sessions.planning.pace import check_name
from vbraille.sessions.planning.style import Condition
from vbraille.tomlfile import Table
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Iterable

JOINT = "-"  # between the levels that a condition or a group is named from
Levels = tuple[str, ...]  # a level of each factor, in the order of the factors
Cross = Literal["all"] | tuple[Levels, ...]


class Factor(Table, frozen=True, kw_only=True):
    """One of the ``[[factors]]`` of a protocol.

    Parameters
    ----------
    name
        Name of the factor, and of its column in the results.
    levels
        Two or more levels, each with a name.
    between
        Whether participants have one of the levels each, and not all of them.

    Raises
    ------
    ValueError
        If there are fewer than two levels, two have the same name or change the same, or one
        changes something that another leaves as it is.
    """

    name: str
    levels: tuple[Condition, ...]
    between: bool = False

    def __post_init__(self) -> None:
        check_name("name", self.name)
        if len(self.levels) < 2:
            raise ValueError(
                f"levels are {len(self.levels)}, and a factor with one level varies nothing; "
                f"give two or more"
            )
        names = [level.name for level in self.levels]
        for number, level in enumerate(self.levels, 1):
            if level.name in names[: number - 1]:
                raise ValueError(
                    f"levels, number {number}, is {level.name!r} again; give each its own name"
                )
            if level.changes.keys() != self.levels[0].changes.keys():
                raise ValueError(
                    f"levels, number {number}, gives {_listed(level.changes)}, and the first "
                    f"gives {_listed(self.levels[0].changes)}; give the same keys in all"
                )
            for other in self.levels[: number - 1]:
                # Groups may differ in who takes part, and see the same.
                if other.changes == level.changes and (level.changes or not self.between):
                    raise ValueError(
                        f"levels, number {number}, shows what {other.name} shows, and so the "
                        f"factor varies nothing; give another value"
                    )

    @property
    def changes(self) -> dict[str, Any]:
        """Style that the levels change, with the values of the first."""
        return self.levels[0].changes

    def level(self, name: str) -> Condition:
        """Level of a name, which the factor has."""
        return next(level for level in self.levels if level.name == name)


def within(factors: Iterable[Factor]) -> tuple[Factor, ...]:
    """Factors of which each participant has all levels."""
    return tuple(factor for factor in factors if not factor.between)


def between(factors: Iterable[Factor]) -> tuple[Factor, ...]:
    """Factors of which each participant has one level."""
    return tuple(factor for factor in factors if factor.between)


def crossed(factors: Iterable[Factor], cross: Cross) -> dict[str, Levels]:
    """Combinations of levels of the factors within participants, by the conditions' names."""
    return _named(_all(within(factors)) if cross == "all" else cross)


def groups(factors: Iterable[Factor]) -> dict[str, Levels]:
    """Combinations of levels of the factors between participants, by the groups' names."""
    return _named(_all(between(factors)))


def _all(factors: tuple[Factor, ...]) -> list[Levels]:
    """All combinations of levels of some factors; none of no factor."""
    names = ([level.name for level in factor.levels] for factor in factors)
    return list(product(*names)) if factors else []


def _named(combinations: Iterable[Levels]) -> dict[str, Levels]:
    return {JOINT.join(levels): levels for levels in combinations}


def combined(factors: Iterable[Factor], levels: Levels) -> dict[str, Any]:
    """All that some levels change together, one level of each factor."""
    pairs = zip(factors, levels, strict=True)
    return dict(chain.from_iterable(f.level(name).changes.items() for f, name in pairs))


def condition(name: str, changes: dict[str, Any]) -> Condition:
    """Condition that changes some of the display's style."""
    return structs.replace(Condition(name=name), **changes)


def check_factors(factors: tuple[Factor, ...], cross: Cross, *, listed: bool) -> None:
    """Check that factors go together.

    Parameters
    ----------
    factors, cross
        The factors, and which of their combinations are shown.
    listed
        Whether the file lists conditions as well.

    Raises
    ------
    ValueError
        If they do not.
    """
    if cross != "all" and not within(factors):
        raise ValueError("cross is of [[factors]] within participants; leave it out")
    if listed and within(factors):
        raise ValueError(
            "[[conditions]] number 1 stands beside [[factors]], which make the conditions; leave "
            "one of the two out"
        )
    whose: dict[str, str] = {}
    names: list[str] = []
    for number, factor in enumerate(factors, 1):
        about = f"[[factors]] number {number}"
        if factor.name in names:
            raise ValueError(f"{about} name is {factor.name!r} again; give each its own")
        names.append(factor.name)
        for key in factor.changes:
            if key in whose:
                raise ValueError(
                    f"{about} levels give {key}, which {whose[key]} gives; leave it out of one"
                )
            whose[key] = factor.name
    if cross != "all":
        _check_cross(within(factors), cross)
        return
    combinations = [*_all(within(factors)), *_all(between(factors))]
    for name in map(JOINT.join, combinations):
        try:
            check_name("the name made from its levels", name)
        except ValueError as error:
            raise ValueError(f"[[factors]] number 1 levels: {error}; give shorter names") from None
    if len(crossed(factors, cross)) + len(groups(factors)) < len(combinations):
        raise ValueError("[[factors]] number 1 levels make two of one name; leave hyphens out")


def _check_cross(own: tuple[Factor, ...], cross: tuple[Levels, ...]) -> None:
    """Check a list of combinations."""
    for number, levels in enumerate(cross, 1):
        at = f"cross, number {number},"
        if len(levels) != len(own):
            raise ValueError(
                f"{at} has {len(levels)} levels; give {len(own)}, one of each of "
                f"{', '.join(factor.name for factor in own)}"
            )
        for factor, name in zip(own, levels, strict=True):
            known = [level.name for level in factor.levels]
            if name not in known:
                raise ValueError(
                    f"{at} has {name!r}, which {factor.name} has not{nearest(name, known)}"
                )
        if levels in cross[: number - 1]:
            raise ValueError(f"{at} is there before; leave one out")
        check_name(f"{at} as a name", JOINT.join(levels))
    if len({JOINT.join(levels) for levels in cross}) < len(cross):
        raise ValueError("cross makes two conditions of one name; leave hyphens out of the levels")
    for place, factor in enumerate(own):
        shown = {levels[place] for levels in cross}
        if len(shown) < 2:
            raise ValueError(
                f"cross has only {', '.join(shown) or 'no level'} of {factor.name}, and a factor "
                f"with one level varies nothing; give two or more, or leave the factor out"
            )


def _listed(changes: dict[str, Any]) -> str:
    return ", ".join(changes) or "nothing"
