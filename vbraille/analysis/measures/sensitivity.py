"""How well something was told from nothing, and one of two from the other."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from vbraille.analysis.input.trials import groups
from vbraille.analysis.schemas import NOTE_COLUMN, Column, Kind, Schema
from vbraille.analysis.statistics.detection import same_different, two_alternatives, yes_no
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    import pandas as pd

    from vbraille.analysis.schemas import ResultTable, Row
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
_SIGNAL = ("hit", "miss")


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
