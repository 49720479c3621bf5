"""Detection and discrimination: d′, criterion and thresholds."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pandas as pd

from vbraille.analysis.input.parsing import LEVELS
from vbraille.analysis.input.trials import cells, groups
from vbraille.analysis.results import (
    CONDITION,
    NOTE_COLUMN,
    PARTICIPANT,
    PROTOCOL,
    Column,
    Kind,
    Schema,
    ends,
)
from vbraille.analysis.statistics.detection import same_different, two_alternatives, yes_no
from vbraille.analysis.statistics.intervals import Unanswerable
from vbraille.analysis.statistics.psychometric import fit_psychometric

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.results import ResultTable, Row
    from vbraille.analysis.statistics.detection import Detection

SENSITIVITY = Schema(
    "sensitivity",
    "How well things were told apart",
    "d′ and criterion with the log-linear correction, and Gourevitch and Galanter's intervals of "
    "this participant; that of a d′ of 0 or more begins at 0 at the least. A signal is a trial "
    "with something, with two that differ, or where the first of two is the right one; the other "
    "trials are noises. Noises of a participant's detect and same-different count for every "
    "condition, whichever condition they are of. Same or different is taken to be judged by the "
    "difference felt; d′ of two is divided by √2.",
    (
        Column("question", "question", "detect, same-different or which"),
        PARTICIPANT,
        CONDITION,
        Column("signals", "signals", "trials with a signal", Kind.COUNT),
        Column("hits", "hits", "of these, answered yes, different or first", Kind.COUNT),
        Column("noises", "noises", "trials without a signal", Kind.COUNT),
        Column("false_alarms", "false alarms", "of these, answered likewise", Kind.COUNT),
        Column("d_prime", "d′", "sensitivity", Kind.NUMBER),
        *ends(name="d_"),
        Column("criterion", "criterion", "above 0 for too few yes", Kind.NUMBER),
        *ends(name="criterion_"),
        NOTE_COLUMN,
    ),
    empty="nothing was looked for",
)
_DETECTIONS = {"detect": yes_no, "same-different": same_different, "which": two_alternatives}


def sensitivity(judgements: pd.DataFrame, columns: Sequence[str] = ("condition",)) -> ResultTable:
    """Sensitivity and criterion of each participant in each cell of some columns."""
    rows: list[Row] = []
    for question, detection in _DETECTIONS.items():
        asked = judgements[(judgements["question"] == question) & (judgements["outcome"] != "")]
        for (participant, _), own in groups(asked, "participant", "protocol"):
            for cell, part in cells(own, columns):
                counts = _counts(question, part, own)
                if not counts[1] and question != "which":
                    continue  # a condition of blank trials alone
                row: Row = dict(
                    zip(("hits", "signals", "false_alarms", "noises"), counts, strict=True)
                )
                row |= {"question": question, "participant": participant, "condition": cell}
                try:
                    rows.append(row | _told(detection(*counts)))
                except Unanswerable as reason:
                    rows.append(row | {"note": f"no d′: {reason}"})
    return SENSITIVITY.fill(rows)


def _counts(question: str, part: pd.DataFrame, own: pd.DataFrame) -> tuple[int, int, int, int]:
    """Hits and signals of a condition, false alarms and noises: those of all conditions.

    Of two, a signal is where the first is right, and noises are those of the condition alone.
    """
    if question == "which":
        part = part[part["presented"].str.split().map(len) == 2]
        yes = part["presented"].str.split().str[0] == part["answered"]
        signal = yes == (part["outcome"] == "right")
        signals, noises = yes[signal], yes[~signal]
    else:
        yes = own["outcome"].isin(("hit", "false alarm"))
        signal = own["outcome"].isin(("hit", "miss"))
        signals, noises = yes[part.index][signal[part.index]], yes[~signal]
    return int(signals.sum()), signals.size, int(noises.sum()), noises.size


def _told(found: Detection) -> Row:
    # Nothing is told apart worse than not at all; a d′ below 0 is of answers turned round.
    least = 0.0 if found.d_prime >= 0 else -math.inf
    return {
        "d_prime": found.d_prime,
        "d_low": max(found.d_interval.low, least),
        "d_high": found.d_interval.high,
        "criterion": found.criterion,
        "criterion_low": found.criterion_interval.low,
        "criterion_high": found.criterion_interval.high,
    }


_WHOSE = (
    Column("question", "question", "detect, which, odd or match"),
    PARTICIPANT,
    PROTOCOL,
    Column("condition", "condition", "levels of what it is found for; all if that is all"),
    Column("level", "level", "what varies, with its unit: of values compared, their difference"),
)
_NONE = "no level of what was detected or told apart varies"
THRESHOLDS = Schema(
    "thresholds",
    "Thresholds",
    "Of detect, the level at which half of what is neither guessed nor lapsed is answered yes, by "
    "a logistic function with free lapses and free guesses, of which a participant's blank trials "
    "tell most. Of which, where one is right by being more or by being less, of odd and of match, "
    "the difference at which half of what is neither guessed nor lapsed is right, by a Weibull "
    "function with free lapses, in which each answer is guessed as often. A participant has a row "
    "for each level that varies.",
    (
        *_WHOSE,
        Column("trials", "trials", "how many", Kind.COUNT),
        Column("blanks", "blank trials", "of these, without anything to be felt", Kind.COUNT),
        Column("threshold", "threshold", "in the unit of the level", Kind.NUMBER),
        *ends(of="95 % credible interval"),
        Column("spread", "spread", "the larger, the flatter; of a difference, 1 / the exponent",
               Kind.NUMBER),
        *ends(name="spread_", heading="spread ", of="95 % credible interval"),
        Column("guesses", "guesses (%)", "share of yes, or of right answers, at nothing",
               Kind.PERCENT),
        Column("lapses", "lapses (%)", "share of answers that no level helps", Kind.PERCENT),
        NOTE_COLUMN,
    ),
    empty=_NONE,
)  # fmt: skip
THRESHOLD_LEVELS = Schema(
    "threshold_levels",
    "Answers by level",
    "What the thresholds are fitted to: answers yes of detect, right ones of others. Blank trials "
    "of detect are a row of their own, without a value but for contrast, of which they have none.",
    (
        *_WHOSE,
        Column("value", "value", "of the level, in its unit", Kind.VALUE),
        Column("trials", "trials", "how many", Kind.COUNT),
        Column("positive", "yes or right", "how many of them", Kind.COUNT),
        Column("share", "share (%)", "yes or right by trials", Kind.PERCENT),
        Column("fitted", "fitted (%)", "by the psychometric function", Kind.PERCENT),
        NOTE_COLUMN,
    ),
    empty=_NONE,
)
_BLANK = ("false alarm", "correct rejection")
_TO_ONE = ("contrast", "texture")  # levels from 0 to 1; the others are lengths
SHAPE_OF = {"detect": "logistic", "which": "weibull", "odd": "weibull", "match": "weibull"}


# Questions with one right answer among so many; None for as many as there are stimuli.
_GUESSED_OF = {"which": None, "odd": None, "match": 2}


class LevelAnswers(NamedTuple):
    """Answers of one participant at the levels of one thing."""

    whose: Row
    levels: NDArray[np.float64]
    positive: NDArray[np.int64]
    trials: NDArray[np.int64]
    guess: float | None = None  # share of right answers at no difference; None if it is free
    blanks: tuple[int, int] = (0, 0)  # answers yes, and all


def thresholds(
    judgements: pd.DataFrame, columns: Sequence[str] = ()
) -> tuple[ResultTable, ResultTable]:
    """Threshold of each participant for each level that varies, and the answers by level.

    Parameters
    ----------
    columns
        Columns in each combination of whose levels there is a threshold of its own.
    """
    rows: list[Row] = []
    shares: list[Row] = []
    for asked in (*_detected(judgements, columns), *_told_apart(judgements, columns)):
        if isinstance(asked, dict):
            rows.append(asked)
            continue
        row, fitted = _fitted(asked)
        rows.append(asked.whose | row)
        note = {} if fitted is not None else {"note": "no function was fitted"}
        for at, (value, positive, trials) in enumerate(
            zip(asked.levels.tolist(), asked.positive.tolist(), asked.trials.tolist(), strict=True)
        ):
            counts: Row = {"value": value, "positive": positive, "trials": trials}
            counts |= {"share": positive / trials} | note
            if fitted is not None:
                counts["fitted"] = float(fitted[at])
            shares.append(asked.whose | counts)
        if asked.blanks[1]:
            yes, trials = asked.blanks
            value = 0.0 if asked.whose["level"] == "contrast" else None
            counts = {"value": value, "positive": yes, "trials": trials, "share": yes / trials}
            counts |= {"fitted": row.get("guesses"), "note": "blank trials, at no level"}
            shares.append(asked.whose | counts)
    return THRESHOLDS.fill(rows), THRESHOLD_LEVELS.fill(shares)


def _detected(judgements: pd.DataFrame, columns: Sequence[str]) -> Iterator[LevelAnswers]:
    """Answers yes by level and at nothing, for each level that varies in what was detected.

    Blank trials are at no level, whatever their dots or their contrast would have been.
    """
    asked = judgements[(judgements["question"] == "detect") & (judgements["outcome"] != "")]
    for (participant, protocol), own in groups(asked, "participant", "protocol"):
        blank = own["outcome"].isin(_BLANK)
        blanks = int((own["outcome"] == "false alarm").sum()), int(blank.sum())
        for cell, shown in cells(own[~blank], columns):
            for level in (name for name in LEVELS if name not in columns):
                part = shown[shown[level].notna()]
                # A blank trial of no contrast is a level, too.
                if own[own[level].notna()][level].nunique() < 2 or part.empty:
                    continue
                whose: Row = {"question": "detect", "participant": participant}
                whose |= {"protocol": protocol, "condition": cell, "level": level}
                counted = _counted(whose, part[level], part["outcome"] == "hit")
                yield counted._replace(blanks=blanks)


def _told_apart(judgements: pd.DataFrame, columns: Sequence[str]) -> Iterator[LevelAnswers | Row]:
    """Right answers by difference, for each parameter of which one of several was right.

    A row with a note stands for what can have no threshold.
    """
    asked = judgements["question"].isin(_GUESSED_OF) & (judgements["outcome"] != "")
    apart = judgements[asked]
    texts = apart["presented"].str.split(expand=True)
    values = texts.reindex(columns=range(max(2, texts.shape[1])))
    values = values.apply(pd.to_numeric, errors="coerce")
    known = apart.assign(
        apart=values[1] - values[0],
        furthest=values.max(axis=1) - values.min(axis=1),
        number=values.notna().sum(axis=1),
        first=values[0] == pd.to_numeric(apart["answered"], errors="coerce"),
    )
    known = known[(known["number"] > 1) & (known["furthest"] > 0)]
    for (question, participant, protocol), own in groups(
        known, "question", "participant", "protocol"
    ):
        each = (
            (cell, parameter, part)
            for cell, shown in cells(own, columns)
            for parameter, part in shown.groupby("parameter", sort=True)
        )
        for cell, parameter, part in each:
            whose: Row = {"question": question, "participant": participant, "protocol": protocol}
            whose |= {"condition": cell, "level": str(parameter) or "value"}
            right = part["outcome"] == "right"
            guess = 1 / (_GUESSED_OF[question] or int(part["number"].max()))
            # Of two, the second is right if it was chosen rightly, or the first wrongly.
            more = (part["apart"] > 0) == (right != part["first"])
            if question == "which" and part["number"].max() == 2 and more.nunique() > 1:
                yield whose | {
                    "trials": len(part),
                    "note": "no threshold: neither the larger of two is always right, nor the "
                    "smaller",
                }
            else:
                yield _counted(whose, part["furthest"], right)._replace(guess=guess)


def _counted(whose: Row, levels: pd.Series, positive: pd.Series) -> LevelAnswers:
    # Differences of decimals that are meant to be the same are made so.
    by = positive.groupby(levels.round(9)).agg(["sum", "size"])
    counts = by.to_numpy(np.int64)
    return LevelAnswers(whose, by.index.to_numpy(np.float64), counts[:, 0], counts[:, 1])


def _fitted(asked: LevelAnswers) -> tuple[Row, NDArray[np.float64] | None]:
    """Threshold and what belongs to it, and the fitted share at each level."""
    question, level = asked.whose["question"], asked.whose["level"]
    blanks = asked.blanks[1]
    row: Row = {"trials": int(asked.trials.sum()) + blanks, "blanks": blanks}
    most = max(1.0, asked.levels.max()) if level in _TO_ONE else np.inf
    try:
        fit = fit_psychometric(
            asked.levels,
            asked.positive,
            asked.trials,
            shape=SHAPE_OF[question],
            guess=asked.guess,
            blanks=asked.blanks,
            scale=(0.0, most),
        )
    except Unanswerable as reason:
        return row | {"note": f"no threshold: {reason}"}, None
    ends, spread = fit.threshold_interval, fit.spread_interval
    untold = question == "detect" and not blanks
    notes = [fit.note, "no blank trials: the levels alone tell of guesses" if untold else ""]
    return row | {
        "threshold": fit.threshold,
        "low": ends.low,
        "high": ends.high,
        "spread": fit.spread,
        "spread_low": spread.low,
        "spread_high": spread.high,
        "guesses": fit.guess,
        "lapses": fit.lapse,
        "note": "; ".join(filter(None, notes)),
    }, fit.shares(asked.levels)
