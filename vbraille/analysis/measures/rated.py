"""What was rated, estimated, said, and how sure of it somebody was."""

from __future__ import annotations

from itertools import combinations
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.input.trials import codes, groups
from vbraille.analysis.schemas import NOTE_COLUMN, Column, Kind, Schema
from vbraille.analysis.statistics.intervals import mean_interval
from vbraille.analysis.statistics.ratings import compare_ratings, summarise_ratings
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd
    from numpy.typing import NDArray

    from vbraille.analysis.schemas import ResultTable, Row
    from vbraille.analysis.statistics.intervals import Interval

    Scale = tuple[float, float]

_PROTOCOL = Column("protocol", "protocol", "name of the protocol")
_CONDITION = Column("condition", "condition", "name, as in the protocol")
_PARTICIPANTS = Column("participants", "participants", "how many", Kind.COUNT)
RATINGS = Schema(
    "ratings",
    "Ratings",
    "The mean is over participants of their own means, with Student's interval of the population's "
    "mean, as far as the scale goes where a session tells its ends. In the quartiles each "
    "participant weighs the same.",
    (
        _PROTOCOL,
        _CONDITION,
        _PARTICIPANTS,
        Column("ratings", "ratings", "how many", Kind.COUNT),
        Column("mean", "mean", "in steps of the scale", Kind.NUMBER),
        Column("low", "from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("high", "to", "upper end", Kind.NUMBER),
        Column("median", "median", "in steps of the scale", Kind.NUMBER),
        Column("low_quartile", "lower quartile", "in steps of the scale", Kind.NUMBER),
        Column("high_quartile", "upper quartile", "in steps of the scale", Kind.NUMBER),
        NOTE_COLUMN,
    ),
)
RATING_PAIRS = Schema(
    "rating_pairs",
    "How often one condition is rated higher than another",
    "Mean over participants of the share of their pairs of ratings in which the first condition's "
    "is the higher, ties counting half, with Student's interval.",
    (
        _PROTOCOL,
        Column("first", "first", "one condition"),
        Column("second", "second", "the other"),
        Column("participants", "participants", "who rated both", Kind.COUNT),
        Column("higher", "first higher (%)", "share of pairs", Kind.PERCENT),
        Column("low", "from (%)", "lower end of its 95 % interval", Kind.PERCENT),
        Column("high", "to (%)", "upper end", Kind.PERCENT),
        NOTE_COLUMN,
    ),
)
MAGNITUDES = Schema(
    "magnitudes",
    "Magnitude estimates",
    "Geometric mean over participants of their own geometric means. For the interval, by Student's "
    "t of logarithms, each participant's estimates are divided by the mean of all conditions, and "
    "multiplied by that of all participants, since everybody's numbers are of an own size.",
    (
        _PROTOCOL,
        _CONDITION,
        _PARTICIPANTS,
        Column("estimates", "estimates", "how many", Kind.COUNT),
        Column("mean", "geometric mean", "of the numbers given", Kind.NUMBER),
        Column("low", "from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("high", "to", "upper end", Kind.NUMBER),
        NOTE_COLUMN,
    ),
)
CONFIDENCE = Schema(
    "confidence",
    "How sure the answers were",
    "The mean is over participants of their own means, with Student's interval of the population's "
    "mean, as far as the scale goes where a session tells its ends.",
    (
        _PROTOCOL,
        Column("question", "question", "what was asked"),
        _CONDITION,
        Column("outcome", "outcome", "how the answers were scored; - if they were not"),
        _PARTICIPANTS,
        Column("answers", "answers", "how many", Kind.COUNT),
        Column("mean", "mean", "confidence, in steps of the scale", Kind.NUMBER),
        Column("low", "from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("high", "to", "upper end", Kind.NUMBER),
        NOTE_COLUMN,
    ),
)
WORDS = Schema(
    "words",
    "Answers in words",
    "As they were typed. Nobody has scored them.",
    (
        Column("participant", "participant", "pseudonym"),
        Column("session", "session", "name of the session"),
        Column("trial", "trial", "its number in the session", Kind.COUNT),
        _CONDITION,
        Column("presented", "presented", "what was shown"),
        Column("answered", "answered", "the words"),
    ),
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
            found = summarise_ratings(part["number"], codes(part["participant"]))
            row: Row = {"protocol": protocol, "condition": condition, "note": found.note}
            row |= {"participants": found.participants, "ratings": found.ratings}
            row |= {"mean": found.mean, "median": found.median}
            row |= {"low_quartile": found.low_quartile, "high_quartile": found.high_quartile}
            if found.interval is not None:
                row |= _kept(found.interval, scales.get(protocol))
            rows.append(row)
        for (first, one), (second, two) in combinations(parts.items(), 2):
            pairs.append({"protocol": protocol, "first": first, "second": second} | _pair(one, two))
    return (
        RATINGS.fill(rows, () if rows else ("nothing was rated",)),
        RATING_PAIRS.fill(pairs, () if pairs else ("no two conditions were rated",)),
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
    return MAGNITUDES.fill(rows, () if rows else ("no magnitude was asked",))


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
    return CONFIDENCE.fill(rows, () if rows else ("no confidence was asked",))


def words(judgements: pd.DataFrame) -> ResultTable:
    """Answers in words, a row for each."""
    said = judgements[judgements["question"] == "free"]
    frame = said[WORDS.names].assign(
        **{name: said[name].astype(str) for name in WORDS.names if name != "trial"}
    )
    return WORDS.fill(frame, () if len(frame) else ("nothing was asked in words",))


def _pair(one: pd.DataFrame, two: pd.DataFrame) -> Row:
    sides = [
        (part["number"].to_numpy(np.float64), codes(part["participant"])) for part in (one, two)
    ]
    try:
        found = compare_ratings(*sides[0], *sides[1])
    except Unanswerable as reason:
        return {"participants": 0, "note": f"no share: {reason}"}
    row: Row = {"participants": found.participants, "higher": found.higher, "note": found.note}
    if found.interval is not None:
        row |= {"low": found.interval.low, "high": found.interval.high}
    return row


def _ends(own: NDArray[np.float64], scale: Scale | None = None, *, logarithms: bool = False) -> Row:
    """Ends of the interval of a mean over participants, or why there is none."""
    try:
        found = mean_interval(own)
    except Unanswerable as reason:
        return {"note": f"no interval: {reason}"}
    if logarithms:
        return {"low": float(np.exp(found.low)), "high": float(np.exp(found.high))}
    return _kept(found, scale)


def _kept(interval: Interval, scale: Scale | None) -> Row:
    """Ends of an interval, as far as the scale goes."""
    least, most = scale or (-np.inf, np.inf)
    return {"low": max(interval.low, least), "high": min(interval.high, most)}
