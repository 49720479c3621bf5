"""Ratings, magnitudes, words, notes, and the confidence of answers."""

from __future__ import annotations

from itertools import combinations
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.input.trials import groups
from vbraille.analysis.results import (
    CONDITION,
    NOTE_COLUMN,
    PARTICIPANT,
    PARTICIPANTS,
    PROTOCOL,
    SESSION,
    TRIAL,
    Column,
    Kind,
    Schema,
    ends,
)
from vbraille.analysis.statistics.intervals import Unanswerable, mean_interval

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd
    from numpy.typing import NDArray

    from vbraille.analysis.results import ResultTable, Row

    Scale = tuple[float, float]
    from collections.abc import Iterable

    from vbraille.analysis.input.sessions import SessionTrials

RATINGS = Schema(
    "ratings",
    "Ratings",
    "The mean is over participants of their own means, with Student's interval of the population's "
    "mean, as far as the scale goes where a session tells its ends. In the quartiles each "
    "participant weighs the same.",
    (
        PROTOCOL,
        CONDITION,
        PARTICIPANTS,
        Column("ratings", "ratings", "how many", Kind.COUNT),
        Column("mean", "mean", "in steps of the scale", Kind.NUMBER),
        *ends(),
        Column("median", "median", "in steps of the scale", Kind.NUMBER),
        Column("low_quartile", "lower quartile", "in steps of the scale", Kind.NUMBER),
        Column("high_quartile", "upper quartile", "in steps of the scale", Kind.NUMBER),
        NOTE_COLUMN,
    ),
    empty="nothing was rated",
)
RATING_PAIRS = Schema(
    "rating_pairs",
    "How often one condition is rated higher than another",
    "Mean over participants of the share of their pairs of ratings in which the first condition's "
    "is the higher, ties counting half, with Student's interval.",
    (
        PROTOCOL,
        Column("first", "first", "one condition"),
        Column("second", "second", "the other"),
        Column("participants", "participants", "who rated both", Kind.COUNT),
        Column("higher", "first higher (%)", "share of pairs", Kind.PERCENT),
        *ends(Kind.PERCENT),
        NOTE_COLUMN,
    ),
    empty="no two conditions were rated",
)
MAGNITUDES = Schema(
    "magnitudes",
    "Magnitude estimates",
    "Geometric mean over participants of their own geometric means. For the interval, by Student's "
    "t of logarithms, each participant's estimates are divided by the mean of all conditions, and "
    "multiplied by that of all participants, since everybody's numbers are of an own size.",
    (
        PROTOCOL,
        CONDITION,
        PARTICIPANTS,
        Column("estimates", "estimates", "how many", Kind.COUNT),
        Column("mean", "geometric mean", "of the numbers given", Kind.NUMBER),
        *ends(),
        NOTE_COLUMN,
    ),
    empty="no magnitude was asked",
)
CONFIDENCE = Schema(
    "confidence",
    "How sure the answers were",
    "The mean is over participants of their own means, with Student's interval of the population's "
    "mean, as far as the scale goes where a session tells its ends.",
    (
        PROTOCOL,
        Column("question", "question", "what was asked"),
        CONDITION,
        Column("outcome", "outcome", "how the answers were scored; - if they were not"),
        PARTICIPANTS,
        Column("answers", "answers", "how many", Kind.COUNT),
        Column("mean", "mean", "confidence, in steps of the scale", Kind.NUMBER),
        *ends(),
        NOTE_COLUMN,
    ),
    empty="no confidence was asked",
)
WORDS = Schema(
    "words",
    "Answers in words",
    "As they were typed, without a score.",
    (
        PARTICIPANT,
        SESSION,
        TRIAL,
        CONDITION,
        Column("presented", "presented", "what was shown"),
        Column("answered", "answered", "the words"),
    ),
    empty="nothing was asked in words",
)
_UNSCORED = "-"


def ratings(
    judgements: pd.DataFrame, scales: Mapping[str, Scale] = MappingProxyType({})
) -> tuple[ResultTable, ResultTable]:
    """Ratings of each condition, and each two conditions compared.

    Parameters
    ----------
    scales
        Ends of the scale of each protocol, as far as they are known; no interval is beyond them.
    """
    rated = judgements[judgements["question"] == "rating"]
    rows: list[Row] = []
    pairs: list[Row] = []
    for (protocol,), own in groups(rated, "protocol"):
        parts = {condition: part for (condition,), part in groups(own, "condition")}
        for condition, part in parts.items():
            row: Row = {"protocol": protocol, "condition": condition}
            row |= summarised(part, scales.get(protocol))
            rows.append(row)
        for (first, one), (second, two) in combinations(parts.items(), 2):
            row = {"protocol": protocol, "first": first, "second": second}
            pairs.append(row | compared(one, two))
    return (
        RATINGS.fill(rows),
        RATING_PAIRS.fill(pairs),
    )


def magnitudes(judgements: pd.DataFrame) -> ResultTable:
    """Geometric mean of the estimates of each condition."""
    rows: list[Row] = []
    asked = judgements[judgements["question"] == "magnitude"]
    for (protocol,), own in groups(asked, "protocol"):
        logs = own.assign(number=np.log(own["number"]))
        means = logs.groupby(["participant", "condition"], observed=True)["number"].mean()
        each = means.unstack("condition")
        size = each.mean(axis=1)  # what a participant's numbers are about, as a logarithm
        for (condition,), part in groups(own, "condition"):
            known = each[condition].dropna()
            row: Row = {"protocol": protocol, "condition": condition, "estimates": len(part)}
            row |= {"participants": len(known), "mean": float(np.exp(known.mean()))}
            even = (known - size[known.index] + size.mean()).to_numpy(np.float64)
            rows.append(row | _ends(even, logarithms=True))
    return MAGNITUDES.fill(rows)


def confidence(
    judgements: pd.DataFrame, scales: Mapping[str, Scale] = MappingProxyType({})
) -> ResultTable:
    """Mean confidence of each condition and outcome; `ratings` describes the arguments."""
    rows: list[Row] = []
    asked = judgements[judgements["confidence"].notna()]
    asked = asked.assign(outcome=asked["outcome"].mask(asked["outcome"] == "", _UNSCORED))
    names = ("protocol", "question", "condition", "outcome")
    for whose, part in groups(asked, *names):
        own = part.groupby("participant", observed=True)["confidence"].mean().to_numpy(np.float64)
        row: Row = dict(zip(names, whose, strict=True))
        row |= {"participants": own.size, "answers": len(part), "mean": float(own.mean())}
        rows.append(row | _ends(own, scales.get(str(row["protocol"]))))
    return CONFIDENCE.fill(rows)


def words(judgements: pd.DataFrame) -> ResultTable:
    """Answers in words, a row for each."""
    said = judgements[judgements["question"] == "free"]
    frame = said[WORDS.names].assign(
        **{name: said[name].astype(str) for name in WORDS.names if name != "trial"}
    )
    return WORDS.fill(frame)


def summarised(rated: pd.DataFrame, scale: Scale | None = None) -> Row:
    """Mean of participants' own means, with its interval, and quartiles in which each weighs alike.

    Parameters
    ----------
    rated
        Ratings of one condition: ``number`` and ``participant`` of each.
    scale
        Ends of the scale, which no interval goes beyond; None if they are not known.
    """
    by = rated.groupby("participant", observed=True)["number"]
    own = by.mean().to_numpy(np.float64)
    weights = (1 / by.transform("size")).to_numpy(np.float64)
    low, median, high = np.quantile(
        rated["number"], [0.25, 0.5, 0.75], weights=weights, method="inverted_cdf"
    ).tolist()
    return {
        "participants": own.size,
        "ratings": len(rated),
        "mean": float(own.mean()),
        "median": median,
        "low_quartile": low,
        "high_quartile": high,
    } | _ends(own, scale)


def compared(one: pd.DataFrame, two: pd.DataFrame) -> Row:
    """Mean over participants of how often their ratings of one condition are above the other's.

    It is the share of a participant's pairs of ratings, ties counting half (Vargha and Delaney
    2000); `summarised` describes the ratings.
    """
    first, second = (
        {who: own.to_numpy() for who, own in part.groupby("participant", observed=True)["number"]}
        for part in (one, two)
    )
    own = np.array(
        [
            (np.sign(first[who][:, None] - second[who]).mean() + 1) / 2
            for who in first
            if who in second
        ]
    )
    if not own.size:
        return {"participants": 0, "note": "no share: no participant rated both"}
    return {"participants": own.size, "higher": float(own.mean())} | _ends(own, (0.0, 1.0))


def _ends(own: NDArray[np.float64], scale: Scale | None = None, *, logarithms: bool = False) -> Row:
    """Ends of the interval of a mean over participants, or why there is none."""
    try:
        found = mean_interval(own)
    except Unanswerable as reason:
        return {"note": f"no interval: {reason}"}
    if logarithms:
        return {"low": float(np.exp(found.low)), "high": float(np.exp(found.high))}
    least, most = scale or (-np.inf, np.inf)
    return {"low": max(found.low, least), "high": min(found.high, most)}


NOTES = Schema(
    "notes",
    "Notes of the experimenter",
    "A note that was typed between two trials has none of its own; one typed before the first "
    "trial has none before it, and one after the last has none after it.",
    (
        PARTICIPANT,
        SESSION,
        Column("text", "note", "as it was typed"),
        Column("trial_before", "trial before", "the one shown last before it"),
        Column("trial", "trial", "the one that was open"),
        Column("trial_after", "trial after", "the one shown next"),
    ),
)


def notes(sessions: Iterable[SessionTrials]) -> ResultTable:
    """Notes of all sessions, in their order."""
    rows: list[Row] = [
        {
            "participant": session.head["participant"],
            "session": session.name,
            "text": note.text,
            "trial_before": _number(note.before),
            "trial": _number(note.trial),
            "trial_after": _number(note.after),
        }
        for session in sessions
        for note in session.notes
    ]
    return NOTES.fill(rows)


def _number(trial: int) -> str:
    return str(trial) if trial else "none"
