"""Legibility of characters, of strings and by number of dots: Lévesque 2009, 3.4 and fig. 4.8."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.input.trials import codes, groups, name_cell, name_string
from vbraille.analysis.measures.averages import over_participants
from vbraille.analysis.measures.legibility import unequal_notes
from vbraille.analysis.schemas import NOTE_COLUMN, Column, Kind, Schema
from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, too_few
from vbraille.analysis.statistics.shares import mean_share
from vbraille.braille.cells import UNICODE_BLANK

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd
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
    Column("low", "from (%)", "lower end of its 95 % interval", Kind.PERCENT),
    Column("high", "to (%)", "upper end", Kind.PERCENT),
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
        Column("participant", "participant", "pseudonym"),
        Column("dots", "dots", "dots of the character", Kind.COUNT),
        *_COUNTS[:2],
        Column("legibility", "legibility (%)", "mean over conditions", Kind.PERCENT),
    ),
)


def characters(places: Places) -> ResultTable:
    """Table 3.2 of Lévesque 2009: one row for each character."""
    rows = [
        {"name": name_cell(mask), "braille": chr(UNICODE_BLANK + mask), "dots": mask.bit_count()}
        | counts
        for mask, counts in _counts(places.frame["presented"].to_numpy(), places.frame)
    ]
    rows.sort(key=lambda row: cell_order(ord(row["braille"]) - UNICODE_BLANK))
    return CHARACTERS.fill(rows, _notes(rows, places))


def strings(trials: pd.DataFrame) -> ResultTable:
    """Table 3.3 of Lévesque 2009: one row for each string."""
    names = trials["string_set"].cat.categories
    shown = trials[["string_set", "presented"]].drop_duplicates()
    orders = shown["string_set"].value_counts(sort=False)
    rows = [
        {"name": name_string(name), "braille": name, "orders": number} | counts
        for name, number, (_, counts) in zip(
            names, orders, _counts(codes(trials["string_set"]), trials), strict=True
        )
    ]
    return STRINGS.fill(sorted(rows, key=lambda row: row["name"]))


def dots(places: Places) -> ResultTable:
    """Legibility by number of dots: one row for each number."""
    rows = [{"dots": number} | counts for number, counts in _counts(_dots(places), places.frame)]
    return DOTS.fill(rows, _notes(rows, places))


def dots_of_participants(places: Places) -> ResultTable:
    """Legibility by number of dots: one row for each participant and number."""
    many = _dots(places)
    rows: list[Row] = [
        {
            "participant": whose[0],
            "dots": number,
            **{name: counts[name] for name in ("presented", "correct", "legibility")},
        }
        for whose, own in groups(places.frame.assign(dots=many), "participant")
        for number, counts in _counts(own["dots"].to_numpy(), own)
    ]
    return DOTS_OWN.fill(rows, _notes(rows, places))


def cell_order(mask: int) -> tuple[bool, str, int]:
    """Key that sorts letters before other cells, and a place that was not read last."""
    name = name_cell(mask)
    return len(name) > 1 or not name.isalpha(), name if len(name) == 1 else "", mask


def _dots(places: Places) -> NDArray[np.int64]:
    """Number of dots that were presented at each place."""
    return np.array([mask.bit_count() for mask in range(256)])[places.frame["presented"]]


def _counts(level: NDArray[np.int64], frame: pd.DataFrame) -> list[tuple[int, Row]]:
    """Values of the columns `_COUNTS` at each level; see `over_participants`."""
    if not level.size:
        return []
    levels, own, numbers = over_participants(level, frame)
    right = frame["correct"].groupby(level).agg(["size", "sum"]).to_numpy().tolist()
    return [
        (code, {"presented": n, "correct": k, "pooled": k / n} | _share(means, of))
        for code, (n, k), means, of in zip(levels.tolist(), right, own, numbers, strict=True)
    ]


def _share(means: NDArray[np.float64], numbers: NDArray[np.int64]) -> Row:
    """Mean of the participants' means with its interval, or the reason why there is no interval."""
    row: Row = {"participants": means.size, "legibility": float(means.sum()) / means.size}
    if means.size < FEWEST_PARTICIPANTS:
        return row | {"note": f"no interval: {too_few(means.size)}"}
    interval = mean_share(means, numbers)
    return row | {"low": interval.low, "high": interval.high}


def _notes(rows: Sequence[object], places: Places) -> list[str]:
    none = [] if rows else ["no answer has as many places as its string"]
    return none + unequal_notes(places)
