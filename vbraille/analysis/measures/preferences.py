"""Choices of one of two (Lévesque 2009, 3.3 and fig. 3.12), and each participant's own value."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vbraille.adaptive.questplus import GridAxis, geometric, nearer_quest, steps
from vbraille.analysis.input.trials import cells, chosen, codes
from vbraille.analysis.results import (
    NOTE_COLUMN,
    PARTICIPANT,
    PARTICIPANTS,
    Column,
    Kind,
    Schema,
    ends,
)
from vbraille.analysis.statistics.bradleyterry import bradley_terry, position_bias, preferred
from vbraille.analysis.statistics.intervals import Unanswerable, too_few
from vbraille.sessions.planning.design import Choice
from vbraille.sessions.planning.procedures import PREFERRED as CENTRE
from vbraille.sessions.planning.procedures import QuestProcedure

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.results import ResultTable, Row
    from vbraille.sessions.planning.protocol import Protocol

    Axes = tuple[GridAxis, ...]

_PARAMETER = Column("parameter", "parameter", "what the stimuli differ in, with its unit")
CHOICES = Schema(
    "choices",
    "How often each value was chosen",
    "The scale is Bradley and Terry's (1952), with Firth's penalty (1993): one value is chosen "
    "over another with odds of e to the difference of their strengths.",
    (
        _PARAMETER,
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
        _PARAMETER,
        PARTICIPANT,
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
        _PARAMETER,
        PARTICIPANTS,
        Column("comparisons", "comparisons", "how many", Kind.COUNT),
        Column("preferred", "preferred", "value of the parameter", Kind.NUMBER),
        *ends(),
        Column("how", "interval", "what the interval comes from"),
        Column("first_share", "first chosen (%)", "choices of what came first", Kind.PERCENT),
        *ends(Kind.PERCENT, name="first_"),
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
    choices: list[pd.DataFrame] = []
    liked: list[Row] = []
    for parameter in comparisons["parameter"].cat.categories:
        part = chosen(comparisons, comparisons["parameter"] == parameter)
        values, at = np.unique(part[["first", "second"]], return_inverse=True)
        first, second = at.T
        choice, who = part["chosen"].to_numpy(), codes(part["participant"])
        choices.append(_choices(parameter, values, first, second, choice))
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
    return CHOICES.fill(pd.concat(choices)), PREFERRED.fill(liked)


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
) -> pd.DataFrame:
    """Rows of choices, one for each value."""
    wins = np.zeros((values.size, values.size), np.int64)
    np.add.at(wins, (np.where(choice, second, first), np.where(choice, first, second)), 1)
    often, presented = wins.sum(axis=1), wins.sum(axis=1) + wins.sum(axis=0)
    rows = pd.DataFrame({"parameter": parameter, "value": values, "presented": presented})
    rows = rows.assign(chosen=often, share=often / presented)
    try:
        scale = bradley_terry(wins)
    except Unanswerable as reason:
        return rows.assign(note=f"no strength: {reason}")
    return rows.assign(strength=scale.strengths, error=np.sqrt(np.diag(scale.covariance)))


LIKED = Schema(
    "preferred_participants",
    "Preferred value of each participant, by a model",
    "Mean of the posterior of the value that the nearer one of two was chosen by, its distance "
    "from each judged with normal noise. Before the answers, all values of the range are equally "
    "likely. Range, noise and lapses are those of the protocol's quest; without one, the range is "
    "that of the values compared, in 50 steps, the noise 2 to 40 % of it, and lapses are 3 %.",
    (
        _PARAMETER,
        PARTICIPANT,
        Column("condition", "condition", "levels of what it is found for; all if that is all"),
        Column("comparisons", "comparisons", "how many", Kind.COUNT),
        Column("preferred", "preferred", "value of the parameter", Kind.NUMBER),
        *ends(of="95 % credible interval"),
        Column("sd", "standard deviation", "of the posterior", Kind.NUMBER),
    ),
)
_STEPS, _SPREADS, _LAPSES = 50, 9, 0.03


def own_values(
    comparisons: pd.DataFrame, protocols: Iterable[Protocol], columns: Sequence[str] = ()
) -> ResultTable:
    """Preferred value of each participant: a row for each parameter and participant.

    Parameters
    ----------
    comparisons
        Which of two was chosen, a row for each comparison.
    protocols
        Protocols of the sessions; none where the comparisons come from elsewhere.
    columns
        Columns in each combination of whose levels there is a value of its own.
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
            for cell, answers in cells(own, columns):
                whose: Row = {"parameter": parameter, "participant": participant}
                rows.append(whose | {"condition": cell} | _row(answers, axes))
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
        table, design = protocol.procedure, protocol.design
        if not isinstance(table, QuestProcedure) or table.scale != "linear":
            continue
        if isinstance(design, Choice) and design.reference is None:
            found.setdefault(design.parameter, table.quest(design).axes)
    return found


def _usual(least: float, most: float) -> Axes:
    range_ = most - least
    return (
        GridAxis(CENTRE, steps(least, most, range_ / _STEPS)),
        GridAxis("spread", geometric(0.02 * range_, 0.4 * range_, _SPREADS)),
        GridAxis("lapse", (_LAPSES,)),
    )
