"""Which of two was chosen: Lévesque 2009, 3.3 and fig. 3.12."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vbraille.analysis.input.trials import chosen, codes
from vbraille.analysis.schemas import NOTE_COLUMN, Column, Kind, Schema
from vbraille.analysis.statistics.bradleyterry import bradley_terry, position_bias, preferred
from vbraille.analysis.statistics.intervals import too_few
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.analysis.schemas import ResultTable, Row

CHOICES = Schema(
    "choices",
    "How often each value was chosen",
    "The scale is Bradley and Terry's (1952), with Firth's penalty (1993): one value is chosen "
    "over another with odds of e to the difference of their strengths.",
    (
        Column("parameter", "parameter", "what the stimuli differ in, with its unit"),
        Column("value", "value", "of the parameter", Kind.VALUE),
        Column("presented", "presented", "comparisons that it was part of", Kind.COUNT),
        Column("chosen", "chosen", "comparisons in which it was chosen", Kind.COUNT),
        Column("share", "chosen (%)", "chosen by presented", Kind.PERCENT),
        Column("strength", "strength", "on the scale; all add up to 0", Kind.NUMBER),
        Column("error", "its standard error", "of the strength", Kind.NUMBER),
        NOTE_COLUMN,
    ),
)
CHOICES_OWN = Schema(
    "choices_participants",
    "How often each participant chose each value",
    "Of the comparisons that the value was part of.",
    (
        Column("parameter", "parameter", "what the stimuli differ in, with its unit"),
        Column("participant", "participant", "pseudonym"),
        Column("value", "value", "of the parameter", Kind.VALUE),
        Column("presented", "presented", "comparisons that it was part of", Kind.COUNT),
        Column("chosen", "chosen", "comparisons in which it was chosen", Kind.COUNT),
        Column("share", "chosen (%)", "chosen by presented", Kind.PERCENT),
    ),
)
PREFERRED = Schema(
    "preferred",
    "Preferred value",
    "The mean over participants of where a parabola through the strongest value of their own scale "
    "and its neighbours is highest. The interval is of the population's mean, by Student's t; of "
    "one participant it is of this participant's value, by a bootstrap. Half of the choices should "
    "be of what came first: p is by a t-test over participants, of one by an exact binomial test.",
    (
        Column("parameter", "parameter", "what the stimuli differ in, with its unit"),
        Column("participants", "participants", "how many", Kind.COUNT),
        Column("comparisons", "comparisons", "how many", Kind.COUNT),
        Column("preferred", "preferred", "value of the parameter", Kind.NUMBER),
        Column("low", "from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("high", "to", "upper end", Kind.NUMBER),
        Column("how", "interval", "what the interval comes from"),
        Column("first_share", "first chosen (%)", "choices of what came first", Kind.PERCENT),
        Column("first_low", "from (%)", "lower end of its 95 % interval", Kind.PERCENT),
        Column("first_high", "to (%)", "upper end", Kind.PERCENT),
        Column("first_p", "p", "that first and second are chosen alike", Kind.P),
        NOTE_COLUMN,
    ),
)


def tuning(comparisons: pd.DataFrame, *, seed: int) -> tuple[ResultTable, ResultTable]:
    """Choices and preferred value of each parameter.

    Parameters
    ----------
    seed
        Seed of the bootstrap's random draws.
    """
    rows: list[Row] = []
    liked: list[Row] = []
    for parameter in comparisons["parameter"].cat.categories:
        part = chosen(comparisons, comparisons["parameter"] == parameter)
        values, at = np.unique(part[["first", "second"]], return_inverse=True)
        first, second = at.T
        choice, who = part["chosen"].to_numpy(), codes(part["participant"])
        rows += _choices(parameter, values, first, second, choice)
        row: Row = {
            "parameter": parameter,
            "participants": part["participant"].nunique(),
            "comparisons": len(part),
        }
        bias = position_bias(choice, who)
        row |= {"first_share": bias.share_first, "first_p": bias.p}
        notes = []
        if bias.interval is not None:
            row |= {"first_low": bias.interval.low, "first_high": bias.interval.high}
        else:
            notes.append(f"no interval of first chosen: {too_few(row['participants'])}")
        if bias.interval is not None and bias.p is None:
            notes.append("no p: all participants chose the first as often")
        try:
            found = preferred(values, first, second, choice, who, seed=seed)
        except Unanswerable as reason:
            notes.insert(0, f"no preferred value: {reason}")
        else:
            row["preferred"] = found.value
            notes = [found.note, *notes] if found.note else notes
            if found.interval is not None:
                ends = found.interval
                row |= {"low": ends.low, "high": ends.high, "how": found.how}
        liked.append(row | {"note": "; ".join(notes)})
    return CHOICES.fill(rows), PREFERRED.fill(liked)


def choices_of_participants(comparisons: pd.DataFrame) -> ResultTable:
    """Choices of each participant: a row for each parameter, participant and value."""
    won = comparisons["first"].where(comparisons["chosen"] == 0, comparisons["second"])
    shown = [comparisons.assign(value=comparisons[name]) for name in ("first", "second")]
    whose = ["parameter", "participant", "value"]
    each = pd.concat(shown).assign(chosen=lambda shown: shown["value"] == won[shown.index])
    rows = each.groupby(whose, observed=True)["chosen"].agg(["size", "sum"]).reset_index()
    rows = rows.rename(columns={"size": "presented", "sum": "chosen"})
    return CHOICES_OWN.fill(rows.assign(share=rows["chosen"] / rows["presented"]))


def _choices(
    parameter: str, values: NDArray, first: NDArray, second: NDArray, choice: NDArray
) -> list[Row]:
    """Rows of choices, one for each value."""
    won = np.where(choice == 0, first, second)
    lost = np.where(choice == 0, second, first)
    wins = np.zeros((values.size, values.size), np.int64)
    np.add.at(wins, (won, lost), 1)
    try:
        scale = bradley_terry(wins)
        strengths = [
            {"strength": strength, "error": error}
            for strength, error in zip(scale.strengths.tolist(), scale.errors.tolist(), strict=True)
        ]
    except Unanswerable as reason:
        strengths = [{"note": f"no strength: {reason}"}] * values.size
    often, presented = wins.sum(axis=1), wins.sum(axis=1) + wins.sum(axis=0)
    return [
        {
            "parameter": parameter,
            "value": value,
            "presented": shown,
            "chosen": times,
            "share": times / shown,
        }
        | strength
        for value, shown, times, strength in zip(
            values.tolist(), presented.tolist(), often.tolist(), strengths, strict=True
        )
    ]
