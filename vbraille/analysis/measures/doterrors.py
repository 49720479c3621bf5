"""Errors by dots: added, removed and moved (Lévesque 2009, 3.4.2 and fig. 4.8)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.input.trials import UNREAD_MASK, count
from vbraille.analysis.measures.legibility import unequal_notes
from vbraille.analysis.schemas import Column, Kind, Schema

if TYPE_CHECKING:
    from vbraille.analysis.input.trials import Places, Trials
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
_BITS = np.array([mask.bit_count() for mask in range(256)])


def errors(places: Places) -> ResultTable:
    """Kinds of errors, the most frequent first; places not read are a kind of their own."""
    wrong = places.where(~places.correct)
    read = wrong.where(wrong.answered != UNREAD_MASK)
    added = _BITS[read.answered & ~read.presented]
    removed = _BITS[read.presented & ~read.answered]
    moved = np.minimum(added, removed)
    shape = (9, 9, 9)  # a cell has eight dots
    codes = np.ravel_multi_index((added - moved, removed - moved, moved), shape)
    kinds, counts = np.unique(codes, return_counts=True)
    found = [
        (*kind, number)
        for kind, number in zip(
            np.transpose(np.unravel_index(kinds, shape)).tolist(), counts.tolist(), strict=True
        )
    ]
    rows: list[Row] = [
        {
            "error": _name(more, fewer, elsewhere),
            "added": more,
            "removed": fewer,
            "moved": elsewhere,
            "count": number,
            "share": number / len(wrong),
        }
        for more, fewer, elsewhere, number in sorted(found, key=lambda f: (-f[3], f[:3]))
    ]
    unread = len(wrong) - len(read)
    if unread:
        zeros = dict.fromkeys(("added", "removed", "moved"), 0)
        rows.append({"error": "not read", **zeros, "count": unread, "share": unread / len(wrong)})
    notes = unequal_notes(places)
    if not rows:
        notes.append("no place was answered wrongly")
    return ERRORS.fill(rows, notes)


def of_participants(trials: Trials, places: Places) -> ResultTable:
    """Kinds of errors of each participant, in the order of `errors`."""
    kinds = [row["error"] for row in errors(places).records()]
    who = trials.participant.codes[places.at]
    rows: list[Row] = []
    for code, participant in enumerate(trials.participant.levels):
        own = places.where(who == code)
        counts = {row["error"]: row["count"] for row in errors(own).records()}
        total = sum(counts.values())
        rows += [
            {
                "participant": participant,
                "error": kind,
                "count": counts.get(kind, 0),
                "share": counts.get(kind, 0) / total,
            }
            for kind in kinds
            if total
        ]
    return ERRORS_OWN.fill(rows, [] if rows else ["no place was answered wrongly"])


def _name(added: int, removed: int, moved: int) -> str:
    """Words for an error: "1 dot moved, 2 dots added"."""
    named = ((moved, "moved"), (added, "added"), (removed, "removed"))
    return ", ".join(f"{count(number, 'dot')} {what}" for number, what in named if number)
