"""Legibility by participant and condition, of characters, of strings and by number of dots.

Lévesque 2009, 3.4, tables 3.1 to 3.3 and fig. 4.8.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vbraille.analysis.input.trials import (
    NO_KEYS,
    CellKeys,
    Places,
    codes,
    groups,
    name_cell,
    name_string,
)
from vbraille.analysis.results import (
    CONDITION,
    NOTE_COLUMN,
    PARTICIPANT,
    Column,
    Kind,
    Schema,
    ends,
    mean_or_none,
)
from vbraille.analysis.statistics.intervals import (
    FEWEST_PARTICIPANTS,
    Unanswerable,
    mean_share,
    too_few,
    wilson,
)
from vbraille.braille.cells import UNICODE_BLANK
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Sized

    from numpy.typing import NDArray

    from vbraille.analysis.input.trials import Places
    from vbraille.analysis.results import ResultTable, Row

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
        Column("duration_mean_s", "mean duration (s)", "mean of their durations", Kind.TENTHS),
        Column("duration_sd_s", "SD (s)", "their standard deviation", Kind.TENTHS),
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
        Column("trials", "trials", "mean number of trials, over all participants", Kind.TENTHS),
        Column("legibility", "legibility (%)", "mean of theirs", Kind.PERCENT),
        *ends(Kind.PERCENT),
        Column(
            "character_legibility", "legibility of characters (%)", "mean of theirs", Kind.PERCENT
        ),
        Column("duration_mean_s", "mean duration (s)", "mean of their means", Kind.TENTHS),
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
        Column("name", "character", "letter, key, or the dots"),
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
        Column("name", "string", "its print or letters, or its cells' names"),
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


def characters(places: Places, keys: CellKeys = NO_KEYS) -> ResultTable:
    """Table 3.2 of Lévesque 2009: one row for each character."""
    counts = _counts(places.frame["presented"].to_numpy(), places.frame)
    masks = sorted(counts.index.tolist(), key=cell_order)
    counts = counts.loc[masks].assign(
        name=[name_cell(mask, keys) for mask in masks],
        braille=[chr(UNICODE_BLANK + mask) for mask in masks],
        dots=[mask.bit_count() for mask in masks],
    )
    return CHARACTERS.fill(counts.reset_index(drop=True), _notes(counts, places))


def strings(trials: pd.DataFrame, keys: CellKeys = NO_KEYS) -> ResultTable:
    """Table 3.3 of Lévesque 2009: one row for each string."""
    sets = trials["string_set"].cat.categories
    shown = trials[["string_set", "presented"]].drop_duplicates()
    printed: dict[str, str] = {}
    if "text" in trials:  # print that a braille table made the cells of, such as "été"
        texts = trials[trials["text"] != ""].drop_duplicates("string_set")
        printed = dict(zip(texts["string_set"].astype(str), texts["text"], strict=True))
    counts = _counts(codes(trials["string_set"]), trials).assign(
        name=[printed.get(string) or name_string(string, keys) for string in sets],
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
    means = over_participants(level, frame)
    by = means["mean"].groupby(level="level")
    rows = pd.DataFrame({"participants": by.size(), "legibility": by.mean()})
    rows = rows.assign(low=np.nan, high=np.nan)
    few = rows["participants"] < FEWEST_PARTICIPANTS
    rows["note"] = [
        f"no interval: {too_few(number)}" if number < FEWEST_PARTICIPANTS else ""
        for number in rows["participants"].tolist()
    ]
    # Strings may be many, most of them of a participant or two: only the others are looked at.
    last = rows["participants"].cumsum()
    for at, stop in last[~few].items():
        own = means.iloc[stop - rows.at[at, "participants"] : stop]
        rows.loc[at, ["low", "high"]] = list(mean_share(own["mean"], own["number"]))
    counts = frame["correct"].groupby(level).agg(presented="size", correct="sum")
    counts = counts.assign(pooled=counts["correct"] / counts["presented"])
    return counts.join(rows)


def _notes(rows: Sized, places: Places) -> list[str]:
    none = [] if len(rows) else ["no answer has as many places as its string"]
    return none + unequal_notes(places)
