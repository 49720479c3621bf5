"""Legibility and duration, by participant and condition: Lévesque 2009, table 3.1."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.analysis.input.trials import Places, groups
from vbraille.analysis.schemas import (
    CONDITION,
    NOTE_COLUMN,
    PARTICIPANT,
    Column,
    Kind,
    Schema,
    ends,
    mean_or_none,
)
from vbraille.analysis.statistics.intervals import Unanswerable, wilson
from vbraille.analysis.statistics.shares import mean_share
from vbraille.wording import count

if TYPE_CHECKING:
    import pandas as pd

    from vbraille.analysis.schemas import ResultTable, Row

LEGIBILITY = Schema(
    "legibility",
    "Legibility and duration, by participant and condition",
    "Legibility is the share of strings of which every place is right (Lévesque 2009, 3.4), that "
    "of characters the share of places. The interval is Wilson's: of this participant alone. SD is "
    "that of a sample.",
    (
        PARTICIPANT,
        CONDITION,
        Column("trials", "trials", "trials answered", Kind.COUNT),
        Column("correct", "correct", "strings of which every place is right", Kind.COUNT),
        Column("legibility", "legibility (%)", "correct by trials", Kind.PERCENT),
        *ends(Kind.PERCENT),
        Column("characters", "characters", "places presented", Kind.COUNT),
        Column("characters_correct", "characters correct", "places that are right", Kind.COUNT),
        Column(
            "character_legibility",
            "legibility of characters (%)",
            "characters correct by characters",
            Kind.PERCENT,
        ),
        Column("timed", "trials timed", "trials whose duration is known", Kind.COUNT),
        Column("duration_mean_s", "mean duration (s)", "mean of their durations", Kind.SECONDS),
        Column("duration_sd_s", "SD (s)", "their standard deviation", Kind.SECONDS),
        NOTE_COLUMN,
    ),
)
AVERAGES = Schema(
    "averages",
    "Averages over participants, by condition",
    "Means of the participants' own means, so that unequal numbers of trials weigh the same; over "
    "those who have the condition. Trials are averaged over all participants, with 0 for those who "
    "have not (Lévesque 2009, table 3.1). The interval is of the mean share of "
    "the population that participants come from, by a logit-normal model of how people differ.",
    (
        CONDITION,
        Column("participants", "participants", "participants who have the condition", Kind.COUNT),
        Column("trials", "trials", "mean number of trials, over all participants", Kind.SECONDS),
        Column("legibility", "legibility (%)", "mean of theirs", Kind.PERCENT),
        *ends(Kind.PERCENT),
        Column(
            "character_legibility", "legibility of characters (%)", "mean of theirs", Kind.PERCENT
        ),
        Column("duration_mean_s", "mean duration (s)", "mean of their means", Kind.SECONDS),
        NOTE_COLUMN,
    ),
)


def legibility(trials: pd.DataFrame, places: Places) -> ResultTable:
    """Table 3.1 of Lévesque 2009: a row for each participant and condition, even without trials."""
    whose = ("participant", "condition")
    of_places = dict(groups(places.frame, *whose, observed=False))
    rows = [
        dict(zip(whose, key, strict=True)) | _row(part, of_places[key]["correct"])
        for key, part in groups(trials, *whose, observed=False)
    ]
    return LEGIBILITY.fill(rows, unequal_notes(places))


def averages(table: ResultTable) -> ResultTable:
    """Last row of table 3.1 of Lévesque 2009, with a row for each condition.

    Parameters
    ----------
    table
        Table that `legibility` gives.
    """
    rows: list[Row] = []
    for condition, part in table.frame.groupby("condition", sort=False):
        having = part[part["trials"] > 0]
        own = {
            name: having[name].dropna().tolist()
            for name in ("legibility", "character_legibility", "duration_mean_s")
        }
        notes = []
        row: Row = {
            "condition": condition,
            "participants": len(having),
            "trials": float(part["trials"].mean()),
            **{name: mean_or_none(values) for name, values in own.items()},
        }
        try:
            interval = mean_share(own["legibility"], having["trials"].tolist())
            row |= interval._asdict()
        except Unanswerable as reason:
            notes.append(f"no interval: {reason}")
        if not own["character_legibility"]:
            notes.append("no legibility of characters: no answer has as many places as its string")
        if not own["duration_mean_s"]:
            notes.append("no duration: none is known")
        elif len(own["duration_mean_s"]) < len(having):
            notes.append(f"durations of {count(len(own['duration_mean_s']), 'participant')}")
        rows.append(row | {"note": "; ".join(notes)})
    return AVERAGES.fill(rows)


def unequal_notes(places: Places) -> list[str]:
    """Notes on what the legibility of characters leaves out."""
    if not places.unequal:
        return []
    return [
        f"{count(places.unequal, 'answer')} of another number of places than was presented: "
        f"wrong as a string, and no part of what is said of characters"
    ]


def _row(trials: pd.DataFrame, right: pd.Series) -> Row:
    """Values of one participant in one condition.

    Parameters
    ----------
    right
        Whether each place is right, in strings whose answer has as many places.
    """
    correct, durations = trials["correct"], trials["duration_s"].dropna().to_numpy()
    row: Row = {
        "trials": correct.size,
        "correct": int(correct.sum()),
        "characters": right.size,
        "characters_correct": int(right.sum()),
        "timed": durations.size,
    }
    if not correct.size:
        return row | {"note": "no trials in this condition"}
    interval = wilson(row["correct"], correct.size)
    row |= {"legibility": correct.mean(), "low": interval.low, "high": interval.high}
    notes = []
    if right.size:
        row["character_legibility"] = right.mean()
    else:
        notes.append("no answer has as many places as its string")
    if durations.size:
        row["duration_mean_s"] = durations.mean()
    if durations.size > 1:
        row["duration_sd_s"] = durations.std(ddof=1)
    else:
        notes.append("one duration: no SD" if durations.size else "no duration is known")
    return row | {"note": "; ".join(notes)}
