"""Legibility of characters, of strings and by number of dots: Lévesque 2009, 3.4 and fig. 4.8."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vbraille.analysis.input.trials import codes, groups, name_cell, name_string
from vbraille.analysis.measures.legibility import unequal_notes
from vbraille.analysis.schemas import NOTE_COLUMN, PARTICIPANT, Column, Kind, Schema, ends
from vbraille.analysis.statistics.intervals import Unanswerable
from vbraille.analysis.statistics.shares import mean_share
from vbraille.braille.cells import UNICODE_BLANK

if TYPE_CHECKING:
    from collections.abc import Sized

    from numpy.typing import NDArray

    from vbraille.analysis.input.trials import Places
    from vbraille.analysis.schemas import ResultTable, Row


_ABOUT = (
    "Legibility is the mean of the participants' own means, conditions averaged within a "
    "participant first (Lévesque 2009, tables 3.2 and 3.3; inferred from the print). The "
    "interval is of the population's mean share, by a logit-normal model of how people differ; of "
    "fewer than three participants there is none. Pooled is the share of all."
)
_COUNTS = (
    Column("presented", "presented", "how often it was presented", Kind.COUNT),
    Column("correct", "correct", "how often the answer was right", Kind.COUNT),
    Column("participants", "participants", "to how many participants", Kind.COUNT),
    Column("legibility", "legibility (%)", "mean of participants' means", Kind.PERCENT),
    *ends(Kind.PERCENT),
    Column("pooled", "pooled (%)", "correct by presented", Kind.PERCENT),
    NOTE_COLUMN,
)
CHARACTERS = Schema(
    "characters",
    "Legibility of each character",
    _ABOUT,
    (
        Column("name", "character", "letter, or the dots"),
        Column("braille", "braille", "Unicode braille"),
        Column("dots", "dots", "how many it has", Kind.COUNT),
        *_COUNTS,
    ),
)
STRINGS = Schema(
    "strings",
    "Legibility of each string",
    "A string whose cells come in another order at each showing is one string, as the protocol "
    "lists it. " + _ABOUT,
    (
        Column("name", "string", "its letters, or its cells' names"),
        Column("braille", "braille", "Unicode braille"),
        Column("orders", "orders", "orders of its cells in which it was presented", Kind.COUNT),
        *_COUNTS,
    ),
)
DOTS = Schema(
    "dots",
    "Legibility by number of dots",
    "Legibility of the characters that have so many dots (Lévesque 2009, fig. 4.8). " + _ABOUT,
    (Column("dots", "dots", "dots of the character", Kind.COUNT), *_COUNTS),
)
DOTS_OWN = Schema(
    "dots_participants",
    "Legibility by number of dots, of each participant",
    "Shares of each participant's own places, averaged over conditions.",
    (
        PARTICIPANT,
        Column("dots", "dots", "dots of the character", Kind.COUNT),
        *_COUNTS[:2],
        Column("legibility", "legibility (%)", "mean over conditions", Kind.PERCENT),
    ),
)


def characters(places: Places) -> ResultTable:
    """Table 3.2 of Lévesque 2009: one row for each character."""
    counts = _counts(places.frame["presented"].to_numpy(), places.frame)
    masks = sorted(counts.index.tolist(), key=cell_order)
    counts = counts.loc[masks].assign(
        name=[name_cell(mask) for mask in masks],
        braille=[chr(UNICODE_BLANK + mask) for mask in masks],
        dots=[mask.bit_count() for mask in masks],
    )
    return CHARACTERS.fill(counts.reset_index(drop=True), _notes(counts, places))


def strings(trials: pd.DataFrame) -> ResultTable:
    """Table 3.3 of Lévesque 2009: one row for each string."""
    sets = trials["string_set"].cat.categories
    shown = trials[["string_set", "presented"]].drop_duplicates()
    counts = _counts(codes(trials["string_set"]), trials).assign(
        name=[name_string(string) for string in sets],
        braille=sets.to_numpy(object),
        orders=shown["string_set"].value_counts(sort=False).to_numpy(),
    )
    return STRINGS.fill(counts.sort_values("name", kind="stable", ignore_index=True))


def dots(places: Places) -> ResultTable:
    """Legibility by number of dots: one row for each number."""
    counts = _counts(_dots(places), places.frame)
    counts = counts.rename_axis("dots").reset_index()
    return DOTS.fill(counts, _notes(counts, places))


def dots_of_participants(places: Places) -> ResultTable:
    """Legibility by number of dots: one row for each participant and number."""
    found = [
        _counts(own["dots"].to_numpy(), own).assign(participant=whose[0])
        for whose, own in groups(places.frame.assign(dots=_dots(places)), "participant")
    ]
    if not found:
        return DOTS_OWN.fill([], _notes([], places))
    counts = pd.concat(found).rename_axis("dots").reset_index()
    return DOTS_OWN.fill(counts[DOTS_OWN.names], _notes(counts, places))


def cell_order(mask: int) -> tuple[bool, str, int]:
    """Key that sorts letters before other cells, and a place that was not read last."""
    name = name_cell(mask)
    return len(name) > 1 or not name.isalpha(), name if len(name) == 1 else "", mask


def _dots(places: Places) -> NDArray[np.int64]:
    """Number of dots that were presented at each place."""
    return np.array([mask.bit_count() for mask in range(256)])[places.frame["presented"]]


def over_participants(level: NDArray[np.int64], frame: pd.DataFrame) -> pd.DataFrame:
    """Mean of each level over conditions within each participant.

    Tables 3.2 and 3.3 of Lévesque 2009 were most likely found in this way: "computed across
    all subjects using individual subject means to compensate for the unequal number of trials
    under the different conditions".

    Parameters
    ----------
    level : int64[n]
        Level of each observation.
    frame
        Data frame of observations: whether each is ``correct``, its ``participant`` and
        ``condition``.

    Returns
    -------
    DataFrame
        The ``mean`` of each level and participant that occur together, which are the index, and
        the ``number`` of observations behind it.
    """
    whose, frame = ["level", "participant"], frame.assign(level=level)
    cells = frame.groupby([*whose, "condition"], observed=True)["correct"].mean()
    means = cells.groupby(level=whose, observed=True).mean()
    return pd.DataFrame({"mean": means, "number": frame.groupby(whose, observed=True).size()})


def _counts(level: NDArray[np.int64], frame: pd.DataFrame) -> pd.DataFrame:
    """Values of the columns `_COUNTS`, a row a level; the index has the levels, ascending."""
    if not level.size:
        return pd.DataFrame(columns=[column.name for column in _COUNTS])
    rows: list[Row] = []
    for _, own in over_participants(level, frame).groupby(level="level"):
        row: Row = {"participants": len(own), "legibility": own["mean"].mean()}
        try:
            rows.append(row | mean_share(own["mean"], own["number"])._asdict())
        except Unanswerable as reason:
            rows.append(row | {"note": f"no interval: {reason}"})
    counts = frame["correct"].groupby(level).agg(presented="size", correct="sum")
    counts = counts.assign(pooled=counts["correct"] / counts["presented"])
    return counts.join(pd.DataFrame(rows, counts.index))


def _notes(rows: Sized, places: Places) -> list[str]:
    none = [] if len(rows) else ["no answer has as many places as its string"]
    return none + unequal_notes(places)
