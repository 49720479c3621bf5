"""What each participant took for closest to the reference, by a model of the nearer of two."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.adaptive.estimates import GridAxis
from vbraille.adaptive.questplus import geometric, nearer_quest, steps
from vbraille.analysis.input.trials import chosen
from vbraille.analysis.schemas import Column, Kind, Schema
from vbraille.sessions.planning.procedures import PREFERRED, QuestProcedure

if TYPE_CHECKING:
    from collections.abc import Iterable

    import pandas as pd

    from vbraille.analysis.schemas import ResultTable, Row
    from vbraille.sessions.planning.protocol import Protocol

    Axes = tuple[GridAxis, ...]

LIKED = Schema(
    "preferred_participants",
    "Preferred value of each participant, by a model",
    "Mean of the posterior of the value that the nearer one of two was chosen by, its distance "
    "from each judged with normal noise. Before the answers, all values of the range are equally "
    "likely. Range, noise and lapses are those of the protocol's quest; without one, the range is "
    "that of the values compared, in 50 steps, the noise 2 to 40 % of it, and lapses are 3 %.",
    (
        Column("parameter", "parameter", "what the stimuli differ in, with its unit"),
        Column("participant", "participant", "pseudonym"),
        Column("comparisons", "comparisons", "how many", Kind.COUNT),
        Column("preferred", "preferred", "value of the parameter", Kind.NUMBER),
        Column("low", "from", "lower end of its 95 % credible interval", Kind.NUMBER),
        Column("high", "to", "upper end", Kind.NUMBER),
        Column("sd", "standard deviation", "of the posterior", Kind.NUMBER),
    ),
)
_STEPS, _SPREADS, _LAPSES = 50, 9, 0.03


def liked(comparisons: pd.DataFrame, protocols: Iterable[Protocol]) -> ResultTable:
    """Preferred value of each participant: a row for each parameter and participant.

    Parameters
    ----------
    comparisons
        Which of two was chosen, a row for each comparison.
    protocols
        Protocols of the sessions; none where the comparisons come from elsewhere.
    """
    known = _axes_of(protocols)
    rows: list[Row] = []
    for parameter in comparisons["parameter"].cat.categories:
        part = chosen(comparisons, comparisons["parameter"] == parameter)
        shown = part[["first", "second"]].to_numpy(np.float64)
        if not len(shown) or shown.min() == shown.max():
            continue
        axes = known.get(parameter) or _usual(float(shown.min()), float(shown.max()))
        for participant, own in part.groupby("participant", observed=True, sort=True):
            row = _row(own, axes)
            rows.append({"parameter": parameter, "participant": participant} | row)
    return LIKED.fill(rows)


def _row(own: pd.DataFrame, axes: Axes) -> Row:
    pairs = [(float(a), float(b)) for a, b in zip(own["first"], own["second"], strict=True)]
    firsts = (own["chosen"] == 0).astype(int).tolist()
    quest = nearer_quest(list(dict.fromkeys(pairs)), *axes)
    found = quest.estimate(list(zip(pairs, firsts, strict=True)), axes[0].name)
    return {
        "comparisons": len(pairs),
        "preferred": found.mean,
        "low": found.low,
        "high": found.high,
        "sd": found.sd,
    }


def _axes_of(protocols: Iterable[Protocol]) -> dict[str, Axes]:
    """Possible values of the model's parameters, by what is compared, of the first quest of it."""
    found: dict[str, Axes] = {}
    for protocol in protocols:
        table, parameter = protocol.procedure, protocol.parameter
        if parameter and isinstance(table, QuestProcedure) and table.scale == "linear":
            found.setdefault(parameter, table.quest(protocol.design).axes)
    return found


def _usual(least: float, most: float) -> Axes:
    range_ = most - least
    return (
        GridAxis(PREFERRED, steps(least, most, range_ / _STEPS)),
        GridAxis("spread", geometric(0.02 * range_, 0.4 * range_, _SPREADS)),
        GridAxis("lapse", (_LAPSES,)),
    )
