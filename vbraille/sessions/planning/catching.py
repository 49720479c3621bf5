"""Catch trials among the others of a plan."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from msgspec import structs

from vbraille.sessions.planning.stimuli import Stimuli

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.sessions.planning.chance import Chance
    from vbraille.sessions.planning.ordering import Catch
    from vbraille.sessions.planning.stimuli import Trial


def stretches(trials: int, catch: Catch) -> list[int]:
    """Ends of the stretches of other trials, each of which has one catch trial."""
    number = catch.number(trials)
    if catch.every is not None:
        return [(catch.every - 1) * part for part in range(1, number + 1)]
    return [part * trials // number for part in range(1, number + 1)]


def with_catch(trials: Sequence[Trial], catch: Catch, chance: Chance) -> list[Trial]:
    """Trials with catch trials among them, one at a random place of each stretch.

    A catch trial stands after a trial of its stretch, whose block and condition it has. So it is
    never the first of the session, and no two are neighbours.
    """
    found: list[Trial] = []
    first = 0
    for end in stretches(len(trials), catch):
        after = first + chance.below(end - first)
        found += [*trials[first : after + 1], _caught(trials[after], catch)]
        found += trials[after + 1 : end]
        first = end
    return [*found, *trials[first:]]


def _caught(trial: Trial, catch: Catch) -> Trial:
    if catch.show == "repeat":
        return structs.replace(trial, catch="repeat")
    first, stop = trial.asked
    blank = [
        replace(
            s,
            masks=(*s.masks[:first], *(0,) * (stop - first), *s.masks[stop:]),
            text=None if s.text is None else "",
        )
        for s in trial.stimuli
    ]
    return structs.replace(trial, catch="blank", stimuli=Stimuli(blank))
