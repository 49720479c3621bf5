"""Tables of the thesis from trials: each function takes a frame of trials and returns a frame.

"Table" and "figure" numbers are those of Lévesque (2009).
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pandas as pd
from pandas import DataFrame, Series

from vbraille.analysis import stats
from vbraille.analysis.read import in_order, to_number
from vbraille.braille.cells import UNICODE_BLANK, dots_of
from vbraille.braille.spelling import LETTERS

CELL = ["participant", "condition"]
RUN = ["participant", "session", "condition"]
WINDOW = 10  # trials of the moving average, figure 3.14
ALL = "all"
_LETTER = {chr(UNICODE_BLANK + mask): letter for letter, mask in LETTERS.items()}


def cell_name(cells: str) -> str:
    """Return letters for braille cells, and dots where a single cell is no letter."""
    if cells and all(cell in _LETTER for cell in cells):
        return "".join(_LETTER[cell] for cell in cells)
    if len(cells) == 1 and 0 <= ord(cells) - UNICODE_BLANK < 256:
        dots = dots_of(ord(cells) - UNICODE_BLANK)
        return f"dot{'s' * (len(dots) > 1)} {'-'.join(map(str, dots))}" if dots else "blank"
    return cells


def places(trials: DataFrame, keys: list[str] = CELL) -> DataFrame:
    """Return a row for each place of each string whose answer is as long as it."""
    lengths = trials["presented"].str.len()
    whole = trials[lengths == trials["answered"].str.len()]
    times = lengths[whole.index].tolist()
    each = DataFrame({key: whole[key].repeat(times) for key in keys}).reset_index(drop=True)
    shown, said = (np.array(list("".join(whole[name]))) for name in ("presented", "answered"))
    each["presented"], each["answered"] = pd.Categorical(shown), pd.Categorical(said)
    return each.assign(right=shown == said)


def durations(trials: DataFrame) -> Series:
    """Return durations of whole trials: neither paused nor answered early."""
    none = Series(np.nan, trials.index)
    paused, early = (trials.get(name, none).fillna(0) for name in ("paused_s", "early"))
    return trials.get("duration_s", none).where((paused == 0) & (early == 0)).astype(float)


def taken_s(trials: DataFrame) -> Series:
    """Return durations, or times to the answer where there is none."""
    none = Series(np.nan, trials.index)
    return trials.get("duration_s", none).fillna(trials.get("response_s", none)).astype(float)


def legibility(trials: DataFrame, each: DataFrame) -> DataFrame:
    """Table 3.1: people by conditions, with Wilson's interval of each."""
    timed = trials.assign(duration=durations(trials))
    made = timed.groupby(CELL, observed=True).agg(
        trials=("right", "size"),
        correct=("right", "sum"),
        timed=("duration", "count"),
        duration_mean_s=("duration", "mean"),
        duration_sd_s=("duration", "std"),
    )
    made["legibility"] = made["correct"] / made["trials"]
    made["low"], made["high"] = stats.wilson(made["correct"], made["trials"])
    made["character_legibility"] = each.groupby(CELL, observed=True)["right"].mean()
    return made.reset_index()


def averages(own: DataFrame) -> DataFrame:
    """Return the last row of table 3.1 for each condition: means over people of their own means.

    As in the thesis, a person without a trial in a condition counts as 0 in its mean of trials.
    """
    rows = []
    within = own["participant"].duplicated().any()
    everyone = own["participant"].nunique()
    for condition, part in own.groupby("condition", observed=True):
        low, high = stats.mean_share(part["legibility"])
        rows.append(
            {
                "condition": condition,
                "participants": len(part),
                "trials": part["trials"].sum() / (everyone if within else len(part)),
                "legibility": part["legibility"].mean(),
                "low": low,
                "high": high,
                "character_legibility": part["character_legibility"].mean(),
                "duration_mean_s": part["duration_mean_s"].mean(),
            }
        )
    return DataFrame(rows)


def by_level(rows: DataFrame, level: str) -> DataFrame:
    """Tables 3.2 and 3.3: a mean over people for each character, string or number of dots.

    A person's own mean is that of the conditions, so that each condition weighs the same.
    """
    cells = rows.groupby([level, *CELL], observed=True)["right"].mean()
    own = cells.groupby(level=[0, 1], observed=True).mean()
    made = rows.groupby(level, observed=True)["right"].agg(presented="size", correct="sum")
    people = own.groupby(level=0, observed=True)
    made["participants"] = people.size()
    made["legibility"] = people.mean()
    # Strings that are never shown twice are as many as the trials: 100,000 intervals take a minute.
    enough = own[own.index.get_level_values(0).isin(made.index[made["participants"] > 2])]
    shares = enough.groupby(level=0, observed=True)
    ends = {name: stats.mean_share(part) for name, part in shares}
    made = made.join(DataFrame.from_dict(ends, "index", columns=["low", "high"]))
    return made.rename_axis("level").reset_index()


def named_levels(rows: DataFrame, level: str) -> DataFrame:
    """Return `by_level` with the names of cells."""
    made = by_level(rows, level)
    made.insert(0, "name", made["level"].astype(str).map(cell_name))
    return made


def _masks(cells: Series) -> Series:
    codes = np.array([ord(cell) - UNICODE_BLANK for cell in cells.cat.categories])
    return Series(codes[cells.cat.codes], cells.index)


def is_braille(each: DataFrame) -> bool:
    """Tell whether every presented place is a cell, so that its dots can be counted."""
    known = [0 <= ord(cell) - UNICODE_BLANK < 256 for cell in each["presented"].cat.categories]
    return bool(known) and all(known)


def by_dots(each: DataFrame) -> DataFrame:
    """Return legibility by the number of dots of a character, figure 4.8."""
    return by_level(each.assign(dots=np.bitwise_count(_masks(each["presented"]))), "dots")


def errors(each: DataFrame) -> DataFrame:
    """Return errors by dots added, removed and moved, figure 4.8; other signs are no such error."""
    wrong = each[~each["right"]]
    told = wrong["answered"].astype(str).map(ord).between(UNICODE_BLANK, UNICODE_BLANK + 255)
    shown = _masks(wrong["presented"])[told]
    said = _masks(wrong["answered"])[told]
    added = np.bitwise_count(said & ~shown)
    removed = np.bitwise_count(shown & ~said)
    moved = np.minimum(added, removed)
    kinds = DataFrame({"added": added - moved, "removed": removed - moved, "moved": moved})
    made = kinds.value_counts().rename("count").reset_index()
    return made.assign(share=made["count"] / max(len(wrong), 1))


def confusion(presented: Series, answered: Series) -> DataFrame:
    """Tables 3.5, 4.1, 6.3 and 6.4: presented in rows, answered in columns, in the same order."""
    made = pd.crosstab(in_order(presented), in_order(answered))
    made.columns, made.index = made.columns.astype(str), made.index.astype(str)
    both = [name for name in made.index if name in made.columns]
    return made[[*both, *made.columns.difference(both)]]


def of_cells(counts: DataFrame) -> DataFrame:
    """Return a confusion matrix with the names of cells."""
    return counts.rename(index=cell_name, columns=cell_name)


def information(counts: DataFrame) -> dict[str, float]:
    """Table 3.4: accuracy, Cohen's kappa, and bits transmitted as the thesis counts them."""
    total = counts.to_numpy().sum()
    shares = counts.to_numpy() / total
    shown = shares.sum(axis=1)
    said = shares.sum(axis=0)
    both = [
        (row, counts.columns.get_loc(name))
        for row, name in enumerate(counts.index)
        if name in counts.columns
    ]
    accuracy = sum(shares[cell] for cell in both)
    chance = sum(shown[row] * said[column] for row, column in both)
    known = shares > 0
    surprise = np.log2(shares[known] / np.outer(shown, said)[known])
    return {
        "presented": total,
        "accuracy": accuracy,
        "kappa": (accuracy - chance) / (1 - chance) if chance < 1 else np.nan,
        "transmitted_bits": (shares[known] * surprise).sum(),
    }


def all_information(each: DataFrame) -> DataFrame:
    """Return `information` of all conditions together and of each."""
    parts = {ALL: each} | dict(list(each.groupby("condition", observed=True)))
    rows = [
        {"condition": name} | information(confusion(part["presented"], part["answered"]))
        for name, part in parts.items()
    ]
    return DataFrame(rows[:1] if len(rows) == 2 else rows)


def over_time(trials: DataFrame) -> DataFrame:
    """Figure 3.14: moving average of the last trials of a person in a condition."""
    made = trials[[*RUN, "block", "trial", "right"]]
    runs = made.groupby(RUN, observed=True)["right"]
    average = runs.rolling(WINDOW).mean().reset_index(RUN, drop=True)
    return made.assign(number=runs.cumcount() + 1, average=average)


def fatigue(trials: DataFrame) -> DataFrame:
    """Compare each person's first half of the trials with the second by the paired t-test."""
    people = trials.groupby("participant", observed=True)
    half = np.where(people.cumcount() < people["right"].transform("size") // 2, "first", "second")
    shares = trials.groupby(["participant", half], observed=True)["right"].mean().unstack()
    shares = shares.reindex(columns=["first", "second"]).dropna()
    made = _tested(shares["first"] - shares["second"])
    return made.assign(first_half=shares["first"].mean(), second_half=shares["second"].mean())


def duration_legibility(trials: DataFrame) -> DataFrame:
    """Correlate durations with right answers in each person, and average over people (3.4.2).

    The mean is of Fisher's z, with Student's interval, and told as r.
    """
    timed = trials.assign(duration=durations(trials)).dropna(subset=["duration"])
    own = [
        np.corrcoef(part["duration"], part["right"])[0, 1]
        for _, part in timed.groupby("participant", observed=True)
        if len(part) > 3 and part["right"].nunique() > 1 and part["duration"].nunique() > 1
    ]
    made = _tested(np.arctanh(own))
    ends = ["value", "low", "high"]
    made[ends] = np.tanh(made[ends])
    return made[made["participants"] > 0]


def _tested(values) -> DataFrame:
    """Return a row with the mean of people's values, its interval, and its test by t."""
    test = stats.paired(values)
    low, high = stats.t_interval(test.value, test.error, test.df)
    told = {"value": test.value, "low": low, "high": high, "t": test.t, "df": test.df, "p": test.p}
    numbers = {name: float(value) for name, value in told.items()}
    return DataFrame([{"participants": len(values)} | numbers | {"note": test.note}])


def by_factors(trials: DataFrame, factors: list[str]) -> DataFrame:
    """Table 6.2: right answers in each cell, and over all levels of each factor."""
    rows = []
    levels = [[*sorted(trials[name].unique()), ALL] for name in factors]
    for cell in product(*levels):
        kept = Series(True, trials.index)
        for name, level in zip(factors, cell, strict=True):
            kept &= (trials[name] == level) | (level == ALL)
        part = trials[kept]
        if len(part):
            own = part.groupby("participant", observed=True)["right"].mean()
            row = dict(zip(factors, cell, strict=True))
            counts = {"participants": len(own), "trials": len(part), "right": part["right"].sum()}
            rows.append(row | counts | {"share": own.mean(), "taken_s": taken_s(part).mean()})
    return DataFrame(rows)


def distribution(counts: DataFrame) -> DataFrame:
    """Tables 6.3 and 6.4, figure 6.10: answers to each name as shares of its trials."""
    return counts.div(counts.sum(axis=1), axis=0)


def by_difference(trials: DataFrame, level: Series) -> DataFrame:
    """Figure 6.7: right answers and times at each level, with their SD over people."""
    timed = trials.assign(level=level.round(9), taken_s=taken_s(trials))
    own = timed.dropna(subset=["level"]).groupby(["level", "participant"], observed=True)
    means = own[["right", "taken_s"]].mean().groupby(level=0)
    made = means.agg(["mean", "std"])
    made.columns = ["share", "share_sd", "taken_s", "taken_sd_s"]
    made.insert(0, "participants", means.size())
    return made.reset_index()


def compared(trials: DataFrame) -> DataFrame:
    """Return the values that trials compare, a column for each place; missing if they are none."""
    texts = trials["presented"].astype(str).str.replace(",", ".").str.split(expand=True)
    return texts.apply(pd.to_numeric, errors="coerce")


def choices(trials: DataFrame) -> DataFrame:
    """Figure 3.12: how often each value was chosen of the comparisons that it was part of."""
    offered = compared(trials).stack().droplevel(1)
    chosen = to_number(trials["answered"])[offered.index]
    each = DataFrame({"value": offered, "chosen": np.isclose(offered, chosen)})
    each["parameter"] = trials.get("parameter", "value")
    made = each.groupby(["parameter", "value"])["chosen"].agg(presented="size", chosen="sum")
    return made.assign(share=made["chosen"] / made["presented"]).reset_index()


def ratings(trials: DataFrame, column: str, keys: list[str]) -> DataFrame:
    """Return means over people of their own mean ratings, with medians of all ratings."""
    rated = trials.assign(rating=to_number(trials[column])).dropna(subset=["rating"])
    rows = []
    for cell, part in rated.groupby(keys, observed=True):
        own = part.groupby("participant", observed=True)["rating"].mean()
        low, high = stats.mean_interval(own)
        row = dict(zip(keys, cell, strict=True))
        row |= {"participants": len(own), "ratings": len(part), "mean": own.mean()}
        rows.append(row | {"low": low, "high": high, "median": part["rating"].median()})
    return DataFrame(rows)


def patterns(trials: DataFrame) -> DataFrame:
    """Count reading patterns, figure 3.15, and average the speeds of the hand."""
    known = trials.dropna(subset=["pattern"])
    counts = pd.crosstab([known[name] for name in CELL], known["pattern"])
    counts.columns = counts.columns.astype(str)
    speeds = known.columns.intersection(["speed_right_mm_s", "speed_left_mm_s"])
    means = known.groupby(CELL, observed=True)[list(speeds)].mean()
    return counts.join(means).reset_index()
