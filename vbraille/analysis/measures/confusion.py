"""Which cells are taken for which: Lévesque 2009, tables 3.4, 3.5 and 4.1."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.analysis.input.trials import UNREAD_MASK, masks_of, name_cell, name_string
from vbraille.analysis.measures.characters import cell_order
from vbraille.analysis.measures.legibility import unequal_notes
from vbraille.analysis.schemas import NOTE_COLUMN, Column, Kind, Schema
from vbraille.analysis.statistics import information
from vbraille.analysis.statistics.transmission import transmission
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.input.trials import Places, Trials
    from vbraille.analysis.schemas import ResultTable, Row

MARKS = (4, 9)  # Lévesque 2009, table 4.1
_ABOUT = (
    "How often each was presented (rows) and answered (columns); ? is a place not read. All trials "
    "are pooled. Errors above the counts given are marked."
)
_GROWS = "a column for each answer, with its count"
CONFUSION_CHARACTERS = Schema(
    "confusion_characters",
    "Confusion matrix of characters",
    _ABOUT,
    (Column("presented", "presented", "name of the character"),),
    _GROWS,
)
CONFUSION_PAIRS = Schema(
    "confusion_pairs",
    "Confusion matrix of pairs",
    _ABOUT,
    (Column("presented", "presented", "names of the pair's characters"),),
    _GROWS,
)
INFORMATION = Schema(
    "information",
    "Accuracy, agreement and information transmitted",
    "Of the confusion matrices, all trials and each condition. Kappa is Cohen's. Information "
    "transmitted is the mutual information of what was presented and what was answered; corrected "
    "is without the surplus that few trials give it, by a hierarchical Dirichlet model, with its "
    "95 % interval: of these participants' trials taken together, not of other people. Where "
    "trials are too few there is no number. What is presented bounds it.",
    (
        Column("of", "of", "characters, or pairs"),
        Column("condition", "condition", "name; all for all trials"),
        Column("presented", "presented", "how many", Kind.COUNT),
        Column("accuracy", "accuracy (%)", "share of right answers", Kind.PERCENT),
        Column("kappa", "kappa", "agreement beyond chance", Kind.NUMBER),
        Column("presented_bits", "presented (bits)", "entropy of what was presented", Kind.NUMBER),
        Column("transmitted_bits", "transmitted (bits)", "mutual information", Kind.NUMBER),
        Column("corrected_bits", "corrected (bits)", "with its bias taken off", Kind.NUMBER),
        Column("low", "from (bits)", "lower end of its 95 % interval", Kind.NUMBER),
        Column("high", "to (bits)", "upper end", Kind.NUMBER),
        NOTE_COLUMN,
    ),
)


@dataclass(frozen=True, slots=True, eq=False)
class Confusion:
    """Counts of answers.

    Parameters
    ----------
    of
        "characters" or "pairs".
    rows
        Names of what was presented.
    columns
        Names of what was answered: the rows' first, then others, at last `UNREAD`.
    counts : int64[rows, columns]
    """

    of: str
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    counts: NDArray[np.int64]


def of_characters(places: Places) -> Confusion | None:
    """Counts of characters; None without any."""
    return _confusion("characters", places.presented, places.answered, cell_order, name_cell)


def of_pairs(trials: Trials, chosen: NDArray[np.bool_] | None = None) -> Confusion | None:
    """Counts of pairs, of all trials or some; None unless every string of them has two places."""
    shown = trials.presented
    used = range(len(shown)) if chosen is None else np.unique(shown.codes[chosen]).tolist()
    if any(len(shown.levels[code]) != 2 for code in used):
        return None
    strings = sorted({*trials.presented.levels, *trials.answered.levels}, key=_string_order)
    code = {string: n for n, string in enumerate(strings)}
    presented, answered = (
        np.array([code[string] for string in factor.levels], np.int64)[
            factor.codes if chosen is None else factor.codes[chosen]
        ]
        for factor in (trials.presented, trials.answered)
    )
    return _confusion("pairs", presented, answered, lambda n: n, lambda n: name_string(strings[n]))


def to_table(confusion: Confusion, places: Places, marks: Sequence[int] = MARKS) -> ResultTable:
    """Table of a matrix.

    Parameters
    ----------
    marks
        Errors above each of these are marked.
    """
    schema = CONFUSION_CHARACTERS if confusion.of == "characters" else CONFUSION_PAIRS
    answers = [
        Column(f"answered {name}", name, f"times answered {name}", Kind.COUNT)
        for name in confusion.columns
    ]
    names = [column.name for column in answers]
    rows: list[Row] = [
        {"presented": name} | dict(zip(names, row, strict=True))
        for name, row in zip(confusion.rows, confusion.counts.tolist(), strict=True)
    ]
    return replace(schema.fill(rows, unequal_notes(places), answers), marks=tuple(marks))


def transmitted(trials: Trials, places: Places, *, seed: int) -> ResultTable:
    """Accuracy, kappa and bits, of characters and pairs, of all trials and each condition.

    Parameters
    ----------
    seed
        Of the draws that corrected bits come from.
    """
    rows: list[Row] = []
    for condition in (None, *range(len(trials.condition))):
        if condition is not None and len(trials.condition) < 2:
            break
        chosen = np.full(len(trials), True)
        if condition is not None:
            chosen = trials.condition.codes == condition
        for confusion in (
            of_characters(places.where(chosen[places.at])),
            of_pairs(trials, chosen),
        ):
            if confusion is not None:
                name = "all" if condition is None else trials.condition.levels[condition]
                rows.append(
                    {"of": confusion.of, "condition": name} | _measures(confusion.counts, seed)
                )
    rows.sort(key=lambda row: row["of"])
    return INFORMATION.fill(rows, [] if rows else ["no answer has as many places as its string"])


def _measures(counts: NDArray[np.int64], seed: int) -> Row:
    row: Row = {}
    notes: list[str] = []
    try:
        row["kappa"] = information.cohen_kappa(counts)
    except Unanswerable:
        notes.append("no kappa: one and the same was presented and answered throughout")
    try:
        found = transmission(counts, seed=seed)
        ends = found.interval
        row |= {"corrected_bits": found.bits, "low": ends.low, "high": ends.high}
    except Unanswerable as reason:
        notes.append(f"no corrected bits: {reason}")
    return row | {
        "presented": int(counts.sum()),
        "accuracy": information.accuracy(counts),
        "presented_bits": information.presented_bits(counts),
        "transmitted_bits": information.transmitted_bits(counts),
        "note": "; ".join(notes),
    }


def _confusion(
    of: str,
    presented: NDArray[np.int64],
    answered: NDArray[np.int64],
    order: Callable[[int], Any],
    name: Callable[[int], str],
) -> Confusion | None:
    if not presented.size:
        return None
    rows = sorted(np.unique(presented).tolist(), key=order)
    others = set(np.unique(answered).tolist()) - set(rows)
    columns = rows + sorted(others, key=order)
    counts = np.zeros((len(rows), len(columns)), np.int64)
    at = (_index(codes, known) for codes, known in ((presented, rows), (answered, columns)))
    np.add.at(counts, tuple(at), 1)
    return Confusion(of, tuple(map(name, rows)), tuple(map(name, columns)), counts)


def _index(codes: NDArray[np.int64], known: list[int]) -> NDArray[np.int64]:
    """Where each code stands among those known."""
    place = np.zeros(max(known) + 1, np.int64)
    place[known] = np.arange(len(known))
    return place[codes]


def _string_order(string: str) -> list[tuple]:
    return [(mask == UNREAD_MASK, *cell_order(mask)) for mask in masks_of(string)]
