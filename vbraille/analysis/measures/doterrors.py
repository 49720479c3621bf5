"""Errors by dots: added, removed and moved (Lévesque 2009, 3.4.2 and fig. 4.8)."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.input.trials import UNREAD_MASK, groups
from vbraille.analysis.measures.legibility import unequal_notes
from vbraille.analysis.schemas import Column, Kind, Schema
from vbraille.wording import count

if TYPE_CHECKING:
    import pandas as pd

    from vbraille.analysis.input.trials import Places
    from vbraille.analysis.schemas import ResultTable, Row

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
        Column("participant", "participant", "pseudonym"),
        Column("error", "error", "what is wrong with the answer, in words"),
        Column("count", "places", "how many places", Kind.COUNT),
        Column("share", "of own errors (%)", "their share of the wrong places", Kind.PERCENT),
    ),
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


def of_participants(places: Places) -> ResultTable:
    """Kinds of errors of each participant, in the order of `errors`."""
    kinds = errors(places).frame["error"]
    rows: list[Row] = [
        {"participant": whose[0], "error": kind, "count": number, "share": number / len(own)}
        for whose, own in groups(_wrong(places), "participant")
        for kind, number in own["error"].value_counts().reindex(kinds, fill_value=0).items()
    ]
    return ERRORS_OWN.fill(rows, [] if rows else ["no place was answered wrongly"])


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
