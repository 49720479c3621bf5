"""Which of two was chosen: Lévesque 2009, 3.3 and fig. 3.12."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.schemas import NOTE_COLUMN, Column, Kind, Schema
from vbraille.analysis.statistics.bradleyterry import bradley_terry, position_bias, preferred
from vbraille.analysis.statistics.intervals import too_few
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from vbraille.analysis.input.trials import Comparisons
    from vbraille.analysis.schemas import ResultTable, Row

CHOICES = Schema(
    "choices",
    "How often each value was chosen",
    "The scale is Bradley and Terry's (1952), with Firth's penalty (1993): one value is chosen "
    "over another with odds of e to the difference of their strengths.",
    (
        Column("parameter", "parameter", "what the stimuli differ in, with its unit"),
        Column("value", "value", "of the parameter", Kind.COUNT),
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
        Column("value", "value", "of the parameter", Kind.COUNT),
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


def tuning(comparisons: Comparisons, *, seed: int) -> tuple[ResultTable, ResultTable]:
    """Choices and preferred value of each parameter.

    Parameters
    ----------
    seed
        Of the bootstrap.
    """
    rows: list[Row] = []
    liked: list[Row] = []
    for code, parameter in enumerate(comparisons.parameter.levels):
        part = comparisons[comparisons.parameter.codes == code]
        values, at = np.unique(np.concatenate((part.first, part.second)), return_inverse=True)
        first, second = np.split(at, 2)
        rows += _choices(parameter, values, first, second, part)
        row: Row = {
            "parameter": parameter,
            "participants": len(part.participant),
            "comparisons": len(part),
        }
        bias = position_bias(part.chosen, part.participant.codes)
        row |= {"first_share": bias.share_first, "first_p": bias.p}
        notes = []
        if bias.interval is not None:
            row |= {"first_low": bias.interval.low, "first_high": bias.interval.high}
        else:
            notes.append(f"no interval of first chosen: {too_few(len(part.participant))}")
        if bias.interval is not None and bias.p is None:
            notes.append("no p: all participants chose the first as often")
        try:
            found = preferred(values, first, second, part.chosen, part.participant.codes, seed=seed)
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


def choices_of_participants(comparisons: Comparisons) -> ResultTable:
    """Choices of each participant, a row a parameter, participant and value."""
    rows: list[Row] = []
    for code, parameter in enumerate(comparisons.parameter.levels):
        part = comparisons[comparisons.parameter.codes == code]
        won = np.where(part.chosen == 0, part.first, part.second)
        for who, participant in enumerate(part.participant.levels):
            own = part.participant.codes == who
            for value in np.unique(np.concatenate((part.first, part.second))).tolist():
                shown = int(((part.first == value) | (part.second == value))[own].sum())
                chosen = int((won == value)[own].sum())
                if shown:
                    rows.append(
                        {
                            "parameter": parameter,
                            "participant": participant,
                            "value": value,
                            "presented": shown,
                            "chosen": chosen,
                            "share": chosen / shown,
                        }
                    )
    return CHOICES_OWN.fill(rows)


def _choices(
    parameter: str, values: np.ndarray, first: np.ndarray, second: np.ndarray, part: Comparisons
) -> list[Row]:
    """One row a value."""
    won = np.where(part.chosen == 0, first, second)
    lost = np.where(part.chosen == 0, second, first)
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
    chosen, presented = wins.sum(axis=1), wins.sum(axis=1) + wins.sum(axis=0)
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
            values.tolist(), presented.tolist(), chosen.tolist(), strengths, strict=True
        )
    ]
