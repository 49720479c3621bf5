"""Values compared with a standard: points of equality, what differs just noticeably, exponents.

The standard of a comparison is the value that every trial of it shows. Differences from it are
signed: the point of subjective equality is where half of the answers say that the value is more
than the standard, and the just noticeable difference is from there to where three quarters do.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from scipy.special import gammaincinv, ndtri

from vbraille.analysis.input.parsing import LEVELS
from vbraille.analysis.input.trials import groups
from vbraille.analysis.results import (
    CONDITION,
    NOTE_COLUMN,
    PARTICIPANT,
    PARTICIPANTS,
    PROTOCOL,
    Column,
    Kind,
    Schema,
    ends,
)
from vbraille.analysis.statistics.intervals import (
    TAIL,
    Unanswerable,
    mean_interval,
    slope_interval,
    wilson,
)
from vbraille.analysis.statistics.psychometric import fit_psychometric

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.analysis.results import ResultTable, Row

QUARTILE = float(ndtri(0.75))  # from the median of a normal distribution, in its SD
_WHOSE = (
    PROTOCOL,
    PARTICIPANT,
    CONDITION,
    Column("parameter", "parameter", "what was compared, in mm if its name says so"),
)
EQUALITY = Schema(
    "points_of_equality",
    "Points of subjective equality",
    "Of constant stimuli, by a cumulative normal function of the signed difference from the "
    "standard, with lapses; its intervals are credible. Of adjustment, the mean of the "
    "settings, with Student's interval over a participant's own, and their standard deviation, "
    "with that of a chi-squared. The just noticeable difference is 0.674 standard deviations.",
    (
        *_WHOSE,
        Column("method", "method", "constant stimuli or adjustment"),
        Column("trials", "trials", "how many", Kind.COUNT),
        Column("standard", "standard", "in the unit of the parameter", Kind.VALUE),
        Column("equal", "point of equality", "in the unit of the parameter", Kind.NUMBER),
        *ends(),
        Column("error", "constant error", "point of equality less the standard", Kind.NUMBER),
        Column("jnd", "just noticeable", "in the unit of the parameter", Kind.NUMBER),
        *ends(name="jnd_", heading="just noticeable "),
        NOTE_COLUMN,
    ),
    empty="nothing was compared with a standard",
)
EQUALITY_MEANS = Schema(
    "points_of_equality_means",
    "Points of subjective equality over participants",
    "Mean over participants, with Student's interval.",
    (
        PROTOCOL,
        CONDITION,
        Column("parameter", "parameter", "what was compared"),
        Column("method", "method", "constant stimuli or adjustment"),
        PARTICIPANTS,
        Column("error", "constant error", "point of equality less the standard", Kind.NUMBER),
        *ends(),
        Column("jnd", "just noticeable", "in the unit of the parameter", Kind.NUMBER),
        *ends(name="jnd_", heading="just noticeable "),
        NOTE_COLUMN,
    ),
    empty="nothing was compared with a standard",
)
APART = Schema(
    "told_apart",
    "How well values were told from the standard",
    "Share of right answers, with Wilson's interval, and the difference at which half of what is "
    "neither guessed nor lapsed is right, by a Weibull function with free lapses.",
    (
        Column("question", "question", "which, odd or match"),
        *_WHOSE,
        Column("trials", "trials", "how many", Kind.COUNT),
        Column("guesses", "guesses (%)", "right by chance", Kind.PERCENT),
        Column("right", "right (%)", "of the trials", Kind.PERCENT),
        *ends(Kind.PERCENT, "right_", "right "),
        Column("threshold", "threshold", "in the unit of the parameter", Kind.NUMBER),
        *ends(of="95 % credible interval"),
        NOTE_COLUMN,
    ),
    empty="nothing was told from a standard among several",
)
EXPONENTS = Schema(
    "exponents",
    "Exponents of magnitudes",
    "Slope of the logarithm of the estimates over that of the value, by least squares, with "
    "Student's interval over a participant's own trials; over participants, the mean of their "
    "slopes, with Student's interval.",
    (
        PROTOCOL,
        Column("participant", "participant", "pseudonym; all for the mean over participants"),
        CONDITION,
        Column("parameter", "parameter", "what varies"),
        Column("estimates", "estimates", "how many", Kind.COUNT),
        Column("exponent", "exponent", "1 if the estimates grow as the value does", Kind.NUMBER),
        *ends(),
        NOTE_COLUMN,
    ),
    empty="no magnitude of a value was estimated",
)
_ALL = "all"
_METHODS = {"which": "constant stimuli", "adjust": "adjustment"}


def equality(judgements: pd.DataFrame) -> tuple[ResultTable, ResultTable]:
    """Points of equality of each participant, and their means."""
    rows: list[Row] = []
    for question, method in _METHODS.items():
        for whose, part, standard in _standards(judgements, question, (2,)):
            row = whose | {"method": method, "trials": len(part), "standard": standard}
            try:
                found = _constant(part, standard) if question == "which" else _adjusted(part)
            except Unanswerable as reason:
                rows.append(row | {"note": f"no point of equality: {reason}"})
            else:
                rows.append(row | found | {"error": float(found["equal"]) - standard})
    return EQUALITY.fill(rows), EQUALITY_MEANS.fill(list(_means(rows)))


def _values(texts: pd.Series) -> pd.Series:
    """Values of each trial, in the order in which they were shown; empty where they are none."""

    def read(text: str) -> tuple[float, ...]:
        try:
            return tuple(map(float, text.split()))
        except ValueError:
            return ()

    return texts.astype(str).map({text: read(str(text)) for text in texts.unique()})


def _standards(
    judgements: pd.DataFrame, question: str, sizes: tuple[int, ...]
) -> Iterator[tuple[Row, pd.DataFrame, float]]:
    """Trials of each participant, condition and parameter that have one value in common."""
    asked = judgements[(judgements["question"] == question) & (judgements["parameter"] != "")]
    asked = asked.assign(values=_values(asked["presented"]))
    asked = asked[asked["values"].map(len).isin(sizes)]
    for (protocol, parameter), own in groups(asked, "protocol", "parameter"):
        shared = set.intersection(*map(set, own["values"]))
        if len(shared) != 1:
            continue
        for (participant, condition), part in groups(own, "participant", "condition"):
            whose: Row = {"protocol": protocol, "participant": participant}
            whose |= {"condition": condition, "parameter": parameter}
            yield whose, part, next(iter(shared))


def _constant(part: pd.DataFrame, standard: float) -> Row:
    """Point of equality and just noticeable difference of constant stimuli.

    Raises
    ------
    Unanswerable
        If the answers do not tell them.
    """
    pairs: list[tuple[float, float]] = part["values"].tolist()
    first = pd.Series([pair[0] for pair in pairs], part.index)
    second = pd.Series([pair[1] for pair in pairs], part.index)
    other = first.where(first != standard, second)
    chosen = pd.to_numeric(part["answered"]) == other
    larger = chosen == (other > standard)  # if the larger of the two was chosen
    asked_more = larger == (part["outcome"] == "right")
    if asked_more.nunique() > 1:
        raise Unanswerable("neither the larger of two is always right, nor the smaller")
    more = chosen if asked_more.iloc[0] else ~chosen
    if (other > standard).nunique() == 1:
        raise Unanswerable("all values lie on one side of the standard")
    counts = more.groupby((other - standard).round(9)).agg(["sum", "size"])
    fit = fit_psychometric(
        counts.index.to_numpy(np.float64),
        counts["sum"].to_numpy(np.int64),
        counts["size"].to_numpy(np.int64),
        shape="normal",
        even=True,
    )
    jnd, of_jnd = QUARTILE * fit.spread, fit.spread_interval
    return {
        "equal": standard + fit.threshold,
        "low": standard + fit.threshold_interval.low,
        "high": standard + fit.threshold_interval.high,
        "jnd": jnd,
        "jnd_low": QUARTILE * of_jnd.low,
        "jnd_high": QUARTILE * of_jnd.high,
        "note": fit.note,
    }


def _adjusted(part: pd.DataFrame) -> Row:
    """Mean of the settings, and their scatter.

    Raises
    ------
    Unanswerable
        If there are fewer than three settings, or all are the same.
    """
    settings = part["number"].to_numpy(np.float64)
    around, free = mean_interval(settings), settings.size - 1
    scatter = QUARTILE * float(settings.std(ddof=1))
    low, high = (math.sqrt(free / (2 * gammaincinv(free / 2, share))) for share in (1 - TAIL, TAIL))
    return {
        "equal": float(settings.mean()),
        "low": around.low,
        "high": around.high,
        "jnd": scatter,
        "jnd_low": scatter * low,
        "jnd_high": scatter * high,
    }


def _means(rows: list[Row]) -> Iterator[Row]:
    """Means over the participants of each condition."""
    known = [row for row in rows if row.get("equal") is not None]
    names = ("protocol", "condition", "parameter", "method")
    for key in dict.fromkeys(tuple(row[name] for name in names) for row in known):
        own = [row for row in known if tuple(row[name] for name in names) == key]
        row: Row = dict(zip(names, key, strict=True)) | {"participants": len(own)}
        notes = []
        for name, before in (("error", ""), ("jnd", "jnd_")):
            values = np.array([each[name] for each in own], np.float64)
            row[name] = float(values.mean())
            try:
                found = mean_interval(values)
            except Unanswerable as reason:
                notes.append(f"no interval: {reason}")
            else:
                row |= {f"{before}low": found.low, f"{before}high": found.high}
        yield row | {"note": "; ".join(dict.fromkeys(notes))}


def apart(judgements: pd.DataFrame) -> ResultTable:
    """Share of right answers, and threshold, of values told from the standard among several."""
    rows: list[Row] = []
    for question, sizes in (("which", (3, 4, 5)), ("odd", (3, 4, 5)), ("match", (3,))):
        for whose, part, standard in _standards(judgements, question, sizes):
            number = len(part["values"].iloc[0])
            guess = 0.5 if question == "match" else 1 / number
            right = part["outcome"] == "right"
            shares = wilson(int(right.sum()), len(part))
            row = whose | {"question": question, "trials": len(part), "guesses": guess}
            row |= {"right": float(right.mean()), "right_low": shares.low}
            row |= {"right_high": shares.high}
            shown: list[tuple[float, ...]] = part["values"].tolist()
            off = pd.Series([max(abs(v - standard) for v in each) for each in shown], part.index)
            counts = right.groupby(off.round(9)).agg(["sum", "size"])
            try:
                fit = fit_psychometric(
                    counts.index.to_numpy(np.float64),
                    counts["sum"].to_numpy(np.int64),
                    counts["size"].to_numpy(np.int64),
                    shape="weibull",
                    guess=guess,
                    scale=(0.0, math.inf),
                )
            except Unanswerable as reason:
                rows.append(row | {"note": f"no threshold: {reason}"})
                continue
            interval = fit.threshold_interval
            row |= {"threshold": fit.threshold, "low": interval.low, "high": interval.high}
            rows.append(row | {"note": fit.note})
    return APART.fill(rows)


def exponents(judgements: pd.DataFrame) -> ResultTable:
    """Exponent of each participant's estimates in each condition, and their means."""
    rows: list[Row] = []
    asked = judgements[judgements["question"] == "magnitude"]
    values = _values(asked["presented"])
    texts: list[tuple[float, ...]] = values.tolist()
    last = pd.Series(
        [shown[-1] if shown else math.nan for shown in texts], values.index, np.float64
    )
    for (protocol,), own in groups(asked.assign(value=last), "protocol"):
        parameter, value = _varied(own)
        if not parameter:
            continue
        logs = own.assign(x=np.log(value.where(value > 0)), y=np.log(own["number"]))
        for (condition,), part in groups(logs, "condition"):
            about: Row = {"protocol": protocol, "condition": condition, "parameter": parameter}
            slopes: list[float] = []
            for (participant,), each in groups(part, "participant"):
                known = each[each["x"].notna()]
                row = about | {"participant": participant, "estimates": len(known)}
                try:
                    x, y = (known[name].to_numpy(np.float64) for name in ("x", "y"))
                    slope, interval, _ = slope_interval(x, y)
                except Unanswerable as reason:
                    rows.append(row | {"note": f"no exponent: {reason}"})
                    continue
                slopes.append(slope)
                rows.append(row | {"exponent": slope, "low": interval.low, "high": interval.high})
            if len(slopes) < 2:
                continue
            row = about | {"participant": _ALL, "estimates": len(part)}
            row["exponent"] = float(np.mean(slopes))
            try:
                interval = mean_interval(slopes)
            except Unanswerable as reason:
                rows.append(row | {"note": f"no interval: {reason}"})
            else:
                rows.append(row | {"low": interval.low, "high": interval.high})
    return EXPONENTS.fill(rows)


def _varied(own: pd.DataFrame) -> tuple[str, pd.Series]:
    """Name and values of what varies in the trials of a protocol; an empty name if nothing does."""
    named = own["parameter"].iloc[0]
    if named and own["value"].nunique() > 1:
        return str(named), own["value"]
    for level in LEVELS:
        if own[level].nunique() > 1:
            return level, own[level]
    return "", own["value"]
