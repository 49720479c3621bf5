"""Confusions of cells, and of their dots: Lévesque 2009, 3.4.2, tables 3.4 to 4.1."""

from __future__ import annotations

from functools import cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.analysis.input.trials import (
    NO_KEYS,
    UNREAD_MASK,
    groups,
    masks_of,
    name_cell,
    name_string,
)
from vbraille.analysis.measures.legibility import cell_order, unequal_notes
from vbraille.analysis.results import NOTE_COLUMN, PARTICIPANT, Column, Kind, Schema
from vbraille.analysis.statistics import information
from vbraille.analysis.statistics.information import transmission
from vbraille.analysis.statistics.intervals import Unanswerable
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pandas as pd
    from numpy.typing import NDArray

    from vbraille.analysis.input.trials import CellKeys, Places
    from vbraille.analysis.results import ResultTable, Row

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
    empty="no answer has as many places as its string",
)


def of_characters(places: Places, keys: CellKeys = NO_KEYS) -> pd.DataFrame | None:
    """Counts of characters: presented in rows, answered in columns; None if there are no places.

    The columns are the names of the rows, then other answers, and last `UNREAD`.
    """
    return _confusion(places.frame, cell_order, partial(name_cell, keys=keys))


def of_pairs(trials: pd.DataFrame, keys: CellKeys = NO_KEYS) -> pd.DataFrame | None:
    """Counts of pairs, like `of_characters`; None unless every string has two places."""
    strings = trials[["presented", "answered"]].astype(object)
    if any(len(string) != 2 for string in strings["presented"].unique()):
        return None
    return _confusion(strings, _string_order, partial(name_string, keys=keys))


def to_table(
    schema: Schema, counts: pd.DataFrame, places: Places, marks: Sequence[int] = MARKS
) -> ResultTable:
    """Table of a confusion matrix.

    Parameters
    ----------
    schema
        `CONFUSION_CHARACTERS` or `CONFUSION_PAIRS`.
    marks
        Counts: errors that are more frequent than one of these are marked.
    """
    answers = [
        Column(f"answered {name}", name, f"times answered {name}", Kind.COUNT)
        for name in counts.columns.tolist()
    ]
    rows = counts.set_axis([column.name for column in answers], axis="columns")
    rows.insert(0, "presented", counts.index)
    return schema.fill(rows.reset_index(drop=True), unequal_notes(places), answers, marks)


def transmitted(trials: pd.DataFrame, places: Places, *, seed: int) -> ResultTable:
    """Accuracy, kappa and bits of characters and pairs, over all trials and for each condition.

    Parameters
    ----------
    seed
        Seed of the random draws that corrected bits come from.
    """
    characters, pairs = {"all": of_characters(places)}, {"all": of_pairs(trials)}
    conditions = trials["condition"].cat.categories
    for condition in conditions if len(conditions) > 1 else ():
        own = places.frame["condition"] == condition
        characters[condition] = of_characters(places.where(own))
        pairs[condition] = of_pairs(trials[trials["condition"] == condition])
    rows: list[Row] = [
        {"of": of, "condition": condition} | _measures(counts.to_numpy(), seed)
        for of, matrices in (("characters", characters), ("pairs", pairs))
        for condition, counts in matrices.items()
        if counts is not None
    ]
    return INFORMATION.fill(rows)


def _measures(counts: NDArray[np.int64], seed: int) -> Row:
    row: Row = {}
    notes: list[str] = []
    try:
        row["kappa"] = information.cohen_kappa(counts)
    except Unanswerable:
        notes.append("no kappa: one and the same was presented and answered throughout")
    try:
        found = transmission(counts, seed=seed)
        row |= {"corrected_bits": found.bits} | found.interval._asdict()
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
    frame: pd.DataFrame, order: Callable[[Any], Any], name: Callable[[Any], str]
) -> pd.DataFrame | None:
    if frame.empty:
        return None
    counts = frame.groupby(["presented", "answered"]).size().unstack(fill_value=0)
    rows = sorted(counts.index, key=order)
    columns = rows + sorted(set(counts.columns) - set(rows), key=order)
    counts = counts.reindex(index=rows, columns=columns, fill_value=0)
    return counts.rename(index=name, columns=name)


def _string_order(string: str) -> list[tuple]:
    return [(mask == UNREAD_MASK, *cell_order(mask)) for mask in masks_of(string)]


ERRORS = Schema(
    "errors",
    "Errors by dots added, removed and moved",
    "Of the places answered wrongly. A dot is moved if one is missing and another is too many; "
    "what is left over is added or removed.",
    (
        Column("error", "error", "what is wrong with the answer, in words"),
        Column("added", "added", "dots answered that were not there", Kind.COUNT),
        Column("removed", "removed", "dots that were there and not answered", Kind.COUNT),
        Column("moved", "moved", "dots answered in another place", Kind.COUNT),
        Column("count", "places", "how many places", Kind.COUNT),
        Column("share", "of all errors (%)", "their share of the wrong places", Kind.PERCENT),
    ),
)
ERRORS_OWN = Schema(
    "errors_participants",
    "Errors of each participant",
    "Of the places that the participant answered wrongly.",
    (
        PARTICIPANT,
        Column("error", "error", "what is wrong with the answer, in words"),
        Column("count", "places", "how many places", Kind.COUNT),
        Column("share", "of own errors (%)", "their share of the wrong places", Kind.PERCENT),
    ),
    empty="no place was answered wrongly",
)
UNREAD_ERROR = "not read"
_BITS = np.array([mask.bit_count() for mask in range(256)])


def errors(places: Places) -> ResultTable:
    """Kinds of errors, the most frequent first; "not read" is a kind of its own."""
    kinds = ["added", "removed", "moved"]
    wrong = _wrong(places)
    found = wrong.groupby(["error", *kinds], as_index=False).size()
    found = found.rename(columns={"size": "count"}).assign(
        share=found["size"] / len(wrong), unread=found["error"] == UNREAD_ERROR
    )
    order = ["unread", "count", *kinds]
    found = found.sort_values(order, ascending=[True, False, True, True, True])
    none = [] if len(wrong) else ["no place was answered wrongly"]
    return ERRORS.fill(found.drop(columns="unread"), unequal_notes(places) + none)


def errors_of_participants(places: Places) -> ResultTable:
    """Kinds of errors of each participant, in the order of `errors`."""
    kinds = errors(places).frame["error"]
    rows: list[Row] = [
        {"participant": whose[0], "error": kind, "count": number, "share": number / len(own)}
        for whose, own in groups(_wrong(places), "participant")
        for kind, number in own["error"].value_counts().reindex(kinds, fill_value=0).items()
    ]
    return ERRORS_OWN.fill(rows)


def _wrong(places: Places) -> pd.DataFrame:
    """Places answered wrongly, each with the name of its error and its changes of dots."""
    wrong = places.frame[~places.frame["correct"]]
    presented, answered = (wrong[name].to_numpy() for name in ("presented", "answered"))
    read = answered != UNREAD_MASK
    added = np.where(read, _BITS[answered & ~presented & 0xFF], 0)
    removed = np.where(read, _BITS[presented & ~answered], 0)
    moved = np.minimum(added, removed)
    wrong = wrong.assign(added=added - moved, removed=removed - moved, moved=moved)
    dots = zip(wrong["added"], wrong["removed"], wrong["moved"], strict=True)
    return wrong.assign(error=[_name(*each) for each in dots])


@cache
def _name(added: int, removed: int, moved: int) -> str:
    """Words for an error: "1 dot moved, 2 dots added"; other words where nothing was read."""
    named = ((moved, "moved"), (added, "added"), (removed, "removed"))
    return (
        ", ".join(f"{count(number, 'dot')} {what}" for number, what in named if number)
        or UNREAD_ERROR
    )
