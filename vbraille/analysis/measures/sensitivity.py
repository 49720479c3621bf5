"""How well something was told from nothing, and one of two from the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.input.judgements import LEVELS
from vbraille.analysis.input.trials import groups
from vbraille.analysis.schemas import NOTE_COLUMN, Column, Kind, Schema
from vbraille.analysis.statistics.detection import same_different, two_alternatives, yes_no
from vbraille.analysis.statistics.psychometric import fit_psychometric
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    import pandas as pd

    from vbraille.analysis.schemas import ResultTable, Row
    from vbraille.analysis.statistics.detection import Detection

SENSITIVITY = Schema(
    "sensitivity",
    "How well things were told apart",
    "d′ and criterion with the log-linear correction, and Gourevitch and Galanter's intervals of "
    "this participant. A signal is a trial with something, with two that differ, or where the "
    "first of two is the right one; the other trials are noises. Noises of a participant's detect "
    "and same-different count for every condition, whichever condition they are of. Same or "
    "different is taken to be judged by the difference felt; d′ of two is divided by √2.",
    (
        Column("question", "question", "detect, same-different or which"),
        Column("participant", "participant", "pseudonym"),
        Column("condition", "condition", "name, as in the protocol"),
        Column("signals", "signals", "trials with a signal", Kind.COUNT),
        Column("hits", "hits", "of these, answered yes, different or first", Kind.COUNT),
        Column("noises", "noises", "trials without a signal", Kind.COUNT),
        Column("false_alarms", "false alarms", "of these, answered likewise", Kind.COUNT),
        Column("d_prime", "d′", "sensitivity", Kind.NUMBER),
        Column("d_low", "from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("d_high", "to", "upper end", Kind.NUMBER),
        Column("criterion", "criterion", "above 0 for too few yes", Kind.NUMBER),
        Column("criterion_low", "from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("criterion_high", "to", "upper end", Kind.NUMBER),
        NOTE_COLUMN,
    ),
)
THRESHOLDS = Schema(
    "thresholds",
    "Thresholds of detection",
    "Level at which half of what is neither guessed nor lapsed is answered yes, by a logistic "
    "function with free guesses and lapses; a participant's row for each level that varies.",
    (
        Column("participant", "participant", "pseudonym"),
        Column("protocol", "protocol", "name of the protocol"),
        Column("level", "level", "what varies: contrast, texture, or a length in mm"),
        Column("trials", "trials", "how many", Kind.COUNT),
        Column("threshold", "threshold", "in the unit of the level", Kind.NUMBER),
        Column("low", "from", "lower end of its 95 % credible interval", Kind.NUMBER),
        Column("high", "to", "upper end", Kind.NUMBER),
        Column("spread", "spread", "the larger, the flatter", Kind.NUMBER),
        NOTE_COLUMN,
    ),
)
_SIGNAL, _YES = ("hit", "miss"), ("hit", "false alarm")


def sensitivity(judgements: pd.DataFrame) -> ResultTable:
    """Sensitivity and criterion of each participant in each condition."""
    rows: list[Row] = []
    for question in ("detect", "same-different", "which"):
        asked = judgements[(judgements["question"] == question) & (judgements["outcome"] != "")]
        for (participant, _), own in groups(asked, "participant", "protocol"):
            for (condition,), part in groups(own, "condition"):
                counts = _of_two(part) if question == "which" else _found(part, own)
                if not counts[1] and question != "which":
                    continue  # a condition of blank trials alone
                row: Row = dict(
                    zip(("hits", "signals", "false_alarms", "noises"), counts, strict=True)
                )
                row |= {"question": question, "participant": participant, "condition": condition}
                try:
                    rows.append(row | _told(_detection(question, *counts)))
                except Unanswerable as reason:
                    rows.append(row | {"note": f"no d′: {reason}"})
    return SENSITIVITY.fill(rows, () if rows else ("nothing was looked for",))


def thresholds(judgements: pd.DataFrame) -> ResultTable:
    """Threshold of each participant, for each level that varies in what was detected."""
    rows: list[Row] = []
    asked = judgements[(judgements["question"] == "detect") & (judgements["outcome"] != "")]
    for (participant, protocol), own in groups(asked, "participant", "protocol"):
        for level in LEVELS:
            part = own[own[level].notna()]
            if part[level].nunique() < 2:
                continue
            row: Row = {"participant": participant, "protocol": protocol, "level": level}
            rows.append(row | _threshold(part, level))
    return THRESHOLDS.fill(rows, () if rows else ("no level of what was detected varies",))


def _threshold(part: pd.DataFrame, level: str) -> Row:
    yes = part["outcome"].isin(_YES)
    by = yes.groupby(part[level]).agg(["sum", "size"])
    row: Row = {"trials": len(part)}
    try:
        fit = fit_psychometric(
            by.index.to_numpy(np.float64), by["sum"].to_numpy(), by["size"].to_numpy(), guess=None
        )
    except Unanswerable as reason:
        return row | {"note": f"no threshold: {reason}"}
    ends = fit.threshold_interval
    return row | {
        "threshold": fit.threshold,
        "low": ends.low,
        "high": ends.high,
        "spread": fit.spread,
        "note": fit.note,
    }


def _found(part: pd.DataFrame, own: pd.DataFrame) -> tuple[int, int, int, int]:
    """Hits and signals of a condition, false alarms and noises of all conditions."""
    signals = part["outcome"].isin(_SIGNAL)
    noises = own[~own["outcome"].isin(_SIGNAL)]
    return (
        int((part["outcome"] == "hit").sum()),
        int(signals.sum()),
        int((noises["outcome"] == "false alarm").sum()),
        len(noises),
    )


def _of_two(part: pd.DataFrame) -> tuple[int, int, int, int]:
    """Answers "first" where the first is right, those trials, and the same where it is not."""
    first = part["presented"].str.split().str[0] == part["answered"]
    right = part["outcome"] == "right"
    is_first = first == right
    return (
        int((first & is_first).sum()),
        int(is_first.sum()),
        int((first & ~is_first).sum()),
        int((~is_first).sum()),
    )


def _detection(question: str, hits: int, signals: int, alarms: int, noises: int) -> Detection:
    if question == "which":
        return two_alternatives(hits, signals, noises - alarms, noises)
    if question == "same-different":
        return same_different(hits, signals, alarms, noises)
    return yes_no(hits, signals, alarms, noises)


def _told(found: Detection) -> Row:
    return {
        "d_prime": found.d_prime,
        "d_low": found.d_interval.low,
        "d_high": found.d_interval.high,
        "criterion": found.criterion,
        "criterion_low": found.criterion_interval.low,
        "criterion_high": found.criterion_interval.high,
    }
