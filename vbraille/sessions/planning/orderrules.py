"""Check of the order of a finished plan: catch trials, and what may not come too often running."""

from __future__ import annotations

from collections import Counter
from itertools import groupby
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial


def check_catch(protocol: Protocol, trials: Sequence[Trial]) -> None:
    """Check which trials are catch trials, where they stand, and what they show.

    Raises
    ------
    ValueError
        If one is missing, stands elsewhere, or shows something else.
    """
    catch = protocol.design.catch
    caught = [place for place, trial in enumerate(trials) if trial.catch]
    others = len(trials) - len(caught)
    wanted = 0 if catch is None else catch.number(others)
    if len(caught) != wanted:
        raise ValueError(f"{len(caught)} trials are catch trials, and {wanted} must be")
    if catch is None:
        return
    for number, place in enumerate(caught):
        trial, before = trials[place], trials[place - 1]
        if place == 0 or before.catch:
            raise ValueError(f"the catch trial {trial.number} follows no other trial")
        if (trial.block, trial.condition) != (before.block, before.condition):
            raise ValueError(f"the catch trial {trial.number} is not of the condition before it")
        if trial.catch != catch.show:
            raise ValueError(f"the catch trial {trial.number} is no {catch.show}")
        asked = [stimulus.masks[slice(*trial.asked)] for stimulus in trial.stimuli]
        if catch.show == "repeat" and trial.stimuli != before.stimuli:
            raise ValueError(f"the catch trial {trial.number} repeats no trial")
        if catch.show == "blank" and any(map(any, asked)):
            raise ValueError(f"the catch trial {trial.number} shows dots")
        # So many others stand before it; each stretch of others has one catch trial.
        stretch = place - number
        size = others / wanted if catch.every is None else catch.every - 1
        if not int(number * size) < stretch <= int((number + 1) * size + 1e-9):
            raise ValueError(f"the catch trial {trial.number} stands outside its stretch")


def check_running(protocol: Protocol, tested: Sequence[Trial]) -> None:
    """Check how often levels come running, and that quarters are balanced.

    Parameters
    ----------
    protocol, tested
        The protocol, and the trials of the test without catch trials, in order.

    Raises
    ------
    ValueError
        If something comes too often running, or a quarter has too much or too little.
    """
    for name, most in protocol.rules.at_most_running.items():
        first = 0
        for level, run in groupby(tested, lambda trial: _level(protocol, trial, name)):  # noqa: B023
            length = len(list(run))
            if length > most:
                raise ValueError(
                    f"{name} is {level} in {length} trials running from trial "
                    f"{tested[first].number} on, and may be in {most}"
                )
            first += length
    if protocol.rules.balanced_quarters:
        _check_quarters(tested)


def _level(protocol: Protocol, trial: Trial, name: str) -> str:
    if name == "condition":
        return trial.condition
    levels = protocol.levels(trial.condition)
    if name in levels:
        return levels[name]
    return protocol.told(trial.item)[name]


def _check_quarters(tested: Sequence[Trial]) -> None:
    number = len(tested)
    whole = Counter(trial.condition for trial in tested)
    for quarter in range(4):
        part = tested[quarter * number // 4 : (quarter + 1) * number // 4]
        held = Counter(trial.condition for trial in part)
        for name, times in whole.items():
            share = times * len(part) / number
            if abs(held[name] - share) >= 1:
                raise ValueError(
                    f"quarter {quarter + 1} has {name} {held[name]} times, and its share is "
                    f"{share:g}"
                )
