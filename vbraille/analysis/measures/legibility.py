"""Legibility and duration, by participant and condition: Lévesque 2009, table 3.1."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.input.trials import Places, count
from vbraille.analysis.measures.averages import mean_or_none
from vbraille.analysis.schemas import NOTE_COLUMN, Column, Kind, Schema
from vbraille.analysis.statistics.intervals import wilson
from vbraille.analysis.statistics.shares import mean_share
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.analysis.input.trials import Trials
    from vbraille.analysis.schemas import ResultTable, Row

LEGIBILITY = Schema(
    "legibility",
    "Legibility and duration, by participant and condition",
    "Legibility is the share of strings of which every place is right (Lévesque 2009, 3.4), that "
    "of characters the share of places. The interval is Wilson's: of this participant alone. SD is "
    "that of a sample.",
    (
        Column("participant", "participant", "pseudonym"),
        Column("condition", "condition", "name, as in the protocol"),
        Column("trials", "trials", "trials answered", Kind.COUNT),
        Column("correct", "correct", "strings of which every place is right", Kind.COUNT),
        Column("legibility", "legibility (%)", "correct by trials", Kind.PERCENT),
        Column("low", "from (%)", "lower end of legibility's 95 % interval", Kind.PERCENT),
        Column("high", "to (%)", "upper end", Kind.PERCENT),
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
        Column("condition", "condition", "name, as in the protocol"),
        Column("participants", "participants", "participants who have the condition", Kind.COUNT),
        Column("trials", "trials", "mean number of trials, over all participants", Kind.SECONDS),
        Column("legibility", "legibility (%)", "mean of theirs", Kind.PERCENT),
        Column("low", "from (%)", "lower end of its 95 % interval", Kind.PERCENT),
        Column("high", "to (%)", "upper end", Kind.PERCENT),
        Column(
            "character_legibility", "legibility of characters (%)", "mean of theirs", Kind.PERCENT
        ),
        Column("duration_mean_s", "mean duration (s)", "mean of their means", Kind.SECONDS),
        NOTE_COLUMN,
    ),
)


def legibility(trials: Trials, places: Places) -> ResultTable:
    """Table 3.1: one row a participant and condition, also where there are no trials."""
    return LEGIBILITY.fill(list(_rows(trials, places)), unequal_notes(places))


def averages(table: ResultTable) -> ResultTable:
    """The last row of table 3.1, a row a condition.

    Parameters
    ----------
    table
        Of `legibility`.
    """
    records = table.records()
    rows: list[Row] = []
    for condition in dict.fromkeys(record["condition"] for record in records):
        all_of = [record for record in records if record["condition"] == condition]
        having = [record for record in all_of if record["trials"]]
        own = {
            name: [float(record[name]) for record in having if record[name] is not None]
            for name in ("legibility", "character_legibility", "duration_mean_s")
        }
        notes = []
        row: Row = {
            "condition": condition,
            "participants": len(having),
            "trials": float(np.mean([record["trials"] for record in all_of])),
            **{name: mean_or_none(values) for name, values in own.items()},
        }
        try:
            interval = mean_share(own["legibility"], [int(of["trials"]) for of in having])
            row |= {"low": interval.low, "high": interval.high}
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
    """What characters leave out."""
    if not places.unequal:
        return []
    return [
        f"{count(places.unequal, 'answer')} of another number of places than was presented: "
        f"wrong as a string, and no part of what is said of characters"
    ]


def _rows(trials: Trials, places: Places) -> Iterator[Row]:
    who, what = trials.participant, trials.condition
    for p, participant in enumerate(who.levels):
        for c, condition in enumerate(what.levels):
            chosen = (who.codes == p) & (what.codes == c)
            correct = trials.correct[chosen]
            row: Row = {
                "participant": participant,
                "condition": condition,
                "trials": correct.size,
                "correct": int(correct.sum()),
            }
            if not correct.size:
                row |= {"characters": 0, "characters_correct": 0, "timed": 0}
                yield row | {"note": "no trials in this condition"}
                continue
            interval = wilson(int(correct.sum()), correct.size)
            row |= {"legibility": float(correct.mean()), "low": interval.low, "high": interval.high}
            right = places.correct[chosen[places.at]]
            row |= {"characters": right.size, "characters_correct": int(right.sum())}
            notes = []
            if right.size:
                row["character_legibility"] = float(right.mean())
            else:
                notes.append("no answer has as many places as its string")
            durations = trials.duration_s[chosen]
            durations = durations[~np.isnan(durations)]
            row["timed"] = durations.size
            if durations.size:
                row["duration_mean_s"] = float(durations.mean())
            if durations.size > 1:
                row["duration_sd_s"] = float(durations.std(ddof=1))
            else:
                notes.append("one duration: no SD" if durations.size else "no duration is known")
            yield row | {"note": "; ".join(notes)}
