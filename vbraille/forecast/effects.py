"""Effects that somebody expects: a share of right answers for each condition of a protocol."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.sessions.planning.design import Choice
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vbraille.sessions.planning.protocol import Protocol

ODDS_RATIO = "odds-ratio"
_EFFECT = setting("effect")


def shares_of(protocol: Protocol, effect: Mapping[str, str]) -> dict[str, float]:
    """Share of right answers in each condition, in the protocol's order.

    Parameters
    ----------
    protocol
        Protocol whose conditions are compared. Where it compares two stimuli, the only name is
        one of its values, and its share that of the comparisons in which the value is chosen.
    effect
        Shares by the names of conditions; or the share of one condition, and by the name
        ``odds-ratio`` the odds of a right answer in every other one by those in this.

    Raises
    ------
    InputError
        If a condition is not known, has no share, or its share is none; or if nothing differs.
    """
    if isinstance(protocol.design, Choice):
        return _preference(protocol.name, protocol.design, effect)
    names = [condition.name for condition in protocol.conditions]
    if len(names) < 2:
        raise InputError(
            f"{protocol.name} has one condition, and power is that of a comparison; take a "
            f"protocol with two or more"
        )
    ratio = _ratio(effect[ODDS_RATIO]) if ODDS_RATIO in effect else None
    given = {name: share for name, share in effect.items() if name != ODDS_RATIO}
    for name in given:
        if name not in names:
            raise InputError(
                f"{_EFFECT} has the condition {name}, which {protocol.name} does not have; it has "
                f"{', '.join(names)}"
            )
    shares = {name: _share(name, given[name]) for name in names if name in given}
    if ratio is not None:
        if len(shares) != 1:
            raise InputError(
                f"{_EFFECT} has an odds ratio and {len(shares)} shares; give the share of one "
                f"condition, such as {names[0]}=0.5,{ODDS_RATIO}=1.8"
            )
        ((base, share),) = shares.items()
        odds = share / (1 - share) * ratio
        shares = {name: share if name == base else odds / (1 + odds) for name in names}
    missing = [name for name in names if name not in shares]
    if missing:
        raise InputError(
            f"{_EFFECT} has no share for {', '.join(missing)}; give one such as "
            f"{missing[0]}=0.5, or {ODDS_RATIO}=1.8"
        )
    return shares


def _preference(name: str, design: Choice, effect: Mapping[str, str]) -> dict[str, float]:
    if len(effect) != 1:
        raise InputError(
            f"{name} compares two stimuli; give {_EFFECT} the share of one value that is chosen, "
            f"such as {design.values[0]:g}=0.7"
        )
    ((value, share),) = effect.items()
    values = [f"{of:g}" for of in design.values]
    if value not in values:
        there = f"give {' or '.join(values)}"
        raise InputError(f"{_EFFECT} has the value {value}, which {name} does not have; {there}")
    return {value: _share(value, share)}


def _share(name: str, text: str) -> float:
    share = _number(name, text)
    if not 0 < share < 1:
        raise InputError(
            f"{_EFFECT}: the share of {name} is {share:g}; it must be between 0 and 1, and "
            f"neither of them"
        )
    return share


def _ratio(text: str) -> float:
    ratio = _number(ODDS_RATIO, text)
    if not 1e-3 <= ratio <= 1e3:
        raise InputError(f"{_EFFECT}: {ODDS_RATIO} is {ratio:g}; it must be 0.001 to 1000")
    return ratio


def _number(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{_EFFECT}: {name} is {text!r}, which is not a number") from None
