"""The primary analysis: the question of a study, answered by the analysis that was planned.

`cells_of` finds one measure of each participant in each cell of the factors; `compare` makes the
table, sentences and figure of it. The other measures go the same way, and are exploratory.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd

from vbraille.analysis.input.trials import ALL, factor
from vbraille.analysis.measures.discrimination import sensitivity, thresholds
from vbraille.analysis.measures.passages import timed
from vbraille.analysis.measures.preferences import own_values
from vbraille.analysis.results import (
    NOTE_COLUMN,
    PARTICIPANTS,
    Column,
    Kind,
    ReportFigure,
    Schema,
    ShownTable,
    ends,
    parameter_words,
    to_print,
)
from vbraille.analysis.statistics.comparisons import CellDesign, CellScores, CellShares, effects
from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, Interval, Unanswerable
from vbraille.analysis.statistics.psychometric import fit_psychometric
from vbraille.pictures.charts import Bars, Series
from vbraille.sessions.planning.analysis import ITEM, MEASURES
from vbraille.sessions.planning.questions import RatingQuestion
from vbraille.sessions.planning.questiontable import GOOD
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.input.study import Study
    from vbraille.analysis.input.trials import Places
    from vbraille.analysis.results import ResultTable, Row
    from vbraille.analysis.statistics.comparisons import CellEstimate, ComparedEffect, LevelPair
    from vbraille.sessions.planning.protocol import Protocol

SURE = 0.05  # corrected p below which two things are called different
MOST_TOLD = 6  # means in one sentence; the table has all
_NAMED = (
    Column("measure", "measure", "what is compared"),
    Column("kind", "kind", "mean, effect, difference, or simple effect"),
    Column("of", "of", "cell, factors, or levels: the first less the second"),
    PARTICIPANTS,
    Column("value", "value", "in the measure's unit, shares from 0 to 1; of a difference of "
           "logarithms the ratio", Kind.NUMBER),
    *ends(),
    Column("size", "effect size", "odds ratio of shares, else Hedges's g", Kind.NUMBER),
    Column("statistic", "F or t", "F of an effect, t of a difference", Kind.NUMBER),
    Column("df1", "df1", "degrees of freedom of F", Kind.NUMBER),
    Column("df2", "df2", "those of its error, or of t", Kind.NUMBER),
    Column("p", "p", "two-sided, not corrected", Kind.P),
    Column("p_corrected", "p corrected", "for all tests of its part of the report", Kind.P),
    NOTE_COLUMN,
)  # fmt: skip
PRIMARY = Schema(
    "primary",
    "Primary analysis",
    "Means over participants, effects of the factors, differences of their levels, and simple "
    "effects of interactions, by the planned model.",
    _NAMED,
)
EXPLORED = Schema(
    "exploratory",
    "Other measures compared",
    "As the primary analysis, of each other measure. Corrected p takes account of all exploratory "
    "tests of the report together.",
    tuple(column for column in _NAMED if column.name != "p_corrected"),
    empty="there is no other measure",
)


class MeasureCells(NamedTuple):
    """A measure of participants in the cells of a design.

    Parameters
    ----------
    measure
        Key of `MEASURES`, or "score".
    words, unit
        Words for the measure and its unit.
    scale
        "share", "log" or "linear".
    factors, levels
        Names of the factors, and of the levels of each.
    places : int64[cells, factors]
        Number of each cell's level of each factor.
    people
        Participants.
    own : float64[participants, cells]
        Each participant's own value, as the model takes it; NaN for none.
    data
        The same for the model.
    note
        What to know of all of it; or empty.
    """

    measure: str
    words: str
    unit: str
    scale: str
    factors: tuple[str, ...]
    levels: tuple[tuple[str, ...], ...]
    places: NDArray[np.int64]
    people: tuple[str, ...]
    own: NDArray[np.float64]
    data: CellShares | CellScores
    note: str = ""

    def name(self, cell: int) -> str:
        """Name of a cell: its levels."""
        named = (of[at] for of, at in zip(self.levels, self.places[cell], strict=True))
        return ", ".join(named) or ALL

    def print(self, value: float | None) -> str:
        """Text of a value with its unit."""
        if value is None:
            return "not known"
        if self.scale == "share":
            return f"{to_print(value, Kind.PERCENT)} %"
        shown = math.exp(value) if self.scale == "log" else value
        return f"{to_print(shown, Kind.NUMBER)}{self.unit}"

    def print_difference(self, value: float) -> str:
        """Text of a difference: percentage points of shares, a ratio of logarithms."""
        if self.scale == "share":
            return f"{to_print(value, Kind.PERCENT)} points"
        if self.scale == "log":
            return f"× {to_print(math.exp(value), Kind.NUMBER)}"
        return f"{to_print(value, Kind.NUMBER)}{self.unit}"


def cells_of(
    study: Study, places: Places | None, measure: str, columns: Sequence[str], model: str
) -> MeasureCells | None:
    """Values of a measure by participant and cell; None where there is nothing of it.

    Parameters
    ----------
    places
        Places of the trials; None without trials.
    measure
        Key of `MEASURES`.
    columns
        Columns that the measure is compared by.
    model
        "trials" or "means", as in `vbraille.sessions.planning.analysis.PlannedAnalysis`.
    """
    of = MEASURES[measure]
    frame, unit, note = _FRAMES[measure](study, places, list(columns))
    if frame is None or frame.empty:
        return None
    named = parameter_words(unit) if unit else ("", "")
    words = f"{of.words} of {named[0]}" if named[0] else of.words
    return arrange(
        frame,
        columns,
        (measure, words, named[1] or (of.unit and f" {of.unit}")),
        "means" if of.scale == "share" and model == "means" else of.scale,
        _bounds(study, measure),
        note,
    )


def arrange(
    frame: pd.DataFrame,
    columns: Sequence[str],
    named: tuple[str, str, str],
    scale: str,
    bounds: Interval,
    note: str = "",
) -> MeasureCells:
    """Arrange single values by participant and cell.

    Parameters
    ----------
    frame
        The ``participant`` and ``value`` of each trial or score, and the columns.
    columns
        Columns that the cells come from.
    named
        Key, words and unit of the measure.
    scale
        "share"; "means" for shares that are compared as participants' means; "log" or "linear".
    bounds
        Least and greatest value that there may be.
    """
    levels = [pd.Series(factor(frame[name]), frame.index).cat for name in columns]
    shape = tuple(len(level.categories) for level in levels)
    who = pd.Series(factor(frame["participant"]), frame.index).cat
    codes = [level.codes.to_numpy(np.int64) for level in levels]
    flat = np.ravel_multi_index(codes, shape) if columns else np.zeros(len(frame), np.int64)
    found, cell = np.unique(flat, return_inverse=True)
    size = len(who.categories), len(found)
    at = np.ravel_multi_index((who.codes.to_numpy(np.int64), cell), size)
    asked = np.bincount(at, minlength=size[0] * size[1]).reshape(size)
    value = frame["value"].to_numpy(np.float64)
    total = np.bincount(at, value, asked.size).reshape(size)
    with np.errstate(invalid="ignore"):
        own = np.where(asked > 0, total / asked, np.nan)
    places = (
        np.column_stack(np.unravel_index(found, shape)) if columns else np.zeros((1, 0), np.int64)
    )
    design = CellDesign(places)
    if scale == "share":
        data: CellShares | CellScores = CellShares(total.astype(np.int64), asked, design)
    else:
        data = CellScores(own, design, *_groups(asked > 0, places), bounds)
    return MeasureCells(
        *named,
        "share" if scale == "means" else scale,
        tuple(name.removeprefix("factor_").removeprefix(ITEM) for name in columns),
        tuple(tuple(map(str, level.categories)) for level in levels),
        places,
        tuple(map(str, who.categories)),
        own,
        data,
        note,
    )


def _groups(
    have: NDArray[np.bool_], places: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Group of each participant and of each cell, by the factors that differ between people."""
    apart = [
        at
        for at in range(places.shape[1])
        if all(np.unique(places[own, at]).size <= 1 for own in have)
    ]
    _, groups = np.unique(places[:, apart], axis=0, return_inverse=True)
    groups = groups.ravel()
    return groups[have.argmax(axis=1)], groups


def _bounds(study: Study, measure: str) -> Interval:
    """Ends of the measure's scale."""
    if MEASURES[measure].scale == "share":
        return Interval(0.0, 1.0)
    if measure == "reading_speed":
        return Interval(0.0, math.inf)
    if measure == "rating":
        asked = [s.protocol.asks for s in study.sessions]
        scales = [(q.least, q.most) for q in asked if isinstance(q, RatingQuestion)]
        if scales:
            return Interval(min(low for low, _ in scales), max(high for _, high in scales))
    return Interval(-math.inf, math.inf)


_Found = tuple["pd.DataFrame | None", str, str]  # values, name of a parameter, note


def _legibility(study: Study, _places: Places | None, columns: list[str]) -> _Found:
    if study.trials is None:
        return None, "", ""
    return study.trials[["participant", *columns]].assign(value=study.trials["correct"]), "", ""


def _characters(study: Study, places: Places | None, columns: list[str]) -> _Found:
    if study.trials is None or places is None or not len(places):
        return None, "", ""
    whose = study.trials[["participant", *columns]].loc[places.frame.index]
    return whose.assign(value=places.frame["correct"].to_numpy()), "", ""


def _duration(study: Study, _places: Places | None, columns: list[str]) -> _Found:
    if study.trials is None:
        return None, "", ""
    right = study.trials[study.trials["correct"] & (study.trials["duration_s"] > 0)]
    return _logarithms(right, right["duration_s"], columns), "", ""


def _logarithms(rows: pd.DataFrame, values: pd.Series, columns: list[str]) -> pd.DataFrame:
    return rows[["participant", *columns]].assign(value=np.log(values.to_numpy(np.float64)))


def _judged(study: Study, questions: Sequence[str]) -> pd.DataFrame | None:
    if study.judgements is None:
        return None
    rows = study.judgements[study.judgements["question"].isin(questions)]
    return rows if len(rows) else None


def _right(study: Study, _places: Places | None, columns: list[str]) -> _Found:
    rows = _judged(study, MEASURES["right"].questions)
    if rows is None or not (scored := rows[rows["outcome"] != ""]).size:
        return None, "", ""
    made = scored[["participant", *columns]]
    return made.assign(value=scored["outcome"].isin(GOOD)), "", ""


def _number(question: str) -> Callable[[Study, Places | None, list[str]], _Found]:
    def found(study: Study, _places: Places | None, columns: list[str]) -> _Found:
        rows = _judged(study, [question])
        if rows is None:
            return None, "", ""
        if MEASURES[question].scale == "log":
            return _logarithms(rows, rows["number"], columns), "", ""
        return rows[["participant", *columns]].assign(value=rows["number"]), "", ""

    return found


def _reading_speed(study: Study, _places: Places | None, columns: list[str]) -> _Found:
    if study.judgements is None:
        return None, "", ""
    read = timed(study.judgements)
    return read[["participant", *columns]].assign(value=read["words_per_minute"]), "", ""


def _d_prime(study: Study, _places: Places | None, columns: list[str]) -> _Found:
    rows = _judged(study, MEASURES["d_prime"].questions)
    if rows is None:
        return None, "", ""
    table = sensitivity(rows, columns).frame
    return _spread(table, "d_prime", rows, columns), "", ""


def _threshold(study: Study, _places: Places | None, columns: list[str]) -> _Found:
    rows = _judged(study, [name for name in MEASURES["threshold"].questions if name != "identify"])
    if rows is None:
        return _adaptive(study, columns)
    table = thresholds(rows, columns)[0].frame
    if table.empty:
        return None, "", ""
    level = str(table["level"].iloc[0])
    known = table[(table["level"] == level) & (table["threshold"] > 0)]
    made = _spread(known, "threshold", rows, columns)
    lost = len(table[table["level"] == level]) - len(known)
    note = f"{count(lost, 'threshold')} could not be found" if lost else ""
    return made.assign(value=np.log(made["value"])), level, note


def _adaptive(study: Study, columns: list[str]) -> _Found:
    """Thresholds of strings whose level a procedure chose, by a logistic function."""
    protocols = {each.protocol.name: each.protocol for each in study.sessions}
    parameter = next(
        (getattr(p.procedure, "parameter", None) for p in protocols.values() if p.adaptive), None
    )
    trials = study.trials
    if parameter is None or trials is None or parameter not in trials:
        return None, "", ""
    guesses = [getattr(p.procedure, "guess", ()) for p in protocols.values()]
    guess = float(guesses[0][0]) if guesses and len(guesses[0]) == 1 else None
    rows: list[Row] = []
    lost = 0
    for whose, part in trials.groupby(["participant", *columns], observed=True):
        levels = pd.to_numeric(part[parameter], errors="coerce").round(9)
        by = part["correct"].groupby(levels).agg(["sum", "size"])
        try:
            fit = fit_psychometric(
                by.index.to_numpy(np.float64),
                by["sum"].to_numpy(np.int64),
                by["size"].to_numpy(np.int64),
                shape="logistic",
                guess=guess,
            )
        except Unanswerable:
            lost += 1
            continue
        if fit.threshold > 0:
            names = dict(zip(["participant", *columns], whose, strict=True))
            rows.append(names | {"value": math.log(fit.threshold)})
    note = f"{count(lost, 'threshold')} could not be found" if lost else ""
    return pd.DataFrame(rows), parameter, note


def _preferred(study: Study, _places: Places | None, columns: list[str]) -> _Found:
    if study.comparisons is None:
        return None, "", ""
    protocols: list[Protocol] = [session.protocol for session in study.sessions]
    table = own_values(study.comparisons, protocols, columns).frame
    if table.empty:
        return None, "", ""
    parameter = str(table["parameter"].iloc[0])
    part = table[table["parameter"] == parameter]
    return _spread(part, "preferred", study.comparisons, columns), parameter, ""


def _spread(
    table: pd.DataFrame, value: str, rows: pd.DataFrame, columns: list[str]
) -> pd.DataFrame:
    """Values of a measure's table, with the columns that its condition is named from."""
    named: dict[str, tuple[Any, ...]] = {ALL: ()}
    if columns:
        for levels in rows[columns].astype(str).drop_duplicates().itertuples(index=False):
            named[", ".join(levels)] = tuple(levels)
    known = table.dropna(subset=value)
    made = pd.DataFrame({"participant": known["participant"], "value": known[value]})
    cells = [named[cell] for cell in known["condition"]]
    return made.assign(**{name: [of[at] for of in cells] for at, name in enumerate(columns)})


_FRAMES: dict[str, Callable[[Any, Any, list[str]], _Found]] = {
    "legibility": _legibility,
    "characters": _characters,
    "duration": _duration,
    "right": _right,
    "threshold": _threshold,
    "d_prime": _d_prime,
    "preferred": _preferred,
    "rating": _number("rating"),
    "magnitude": _number("magnitude"),
    "reading_speed": _reading_speed,
}


class ComparedMeasure(NamedTuple):
    """A measure compared.

    Parameters
    ----------
    cells
        The measure.
    means
        Mean of each cell.
    effects
        Effects of the factors, and the differences in them.
    """

    cells: MeasureCells
    means: list[CellEstimate]
    effects: list[ComparedEffect]

    def rows(self, *, corrected: bool = True) -> Iterator[Row]:
        """Rows of `PRIMARY`; without corrected p those of `EXPLORED`."""
        cells = self.cells
        for at, mean in enumerate(self.means):
            yield self._row("mean", cells.name(at), mean)
        for effect in self.effects:
            test = effect.test
            row: Row = {
                "measure": cells.words,
                "kind": "effect",
                "of": self.effect_name(effect),
                "participants": len(cells.people),
                "statistic": test.f,
                "df1": test.df1,
                "df2": test.df2,
                "p": test.p,
                "note": test.note or "an effect has a test, and its size is that of differences",
            }
            yield row | ({"p_corrected": effect.p} if corrected else {})
            single = len(effect.pairs) == 1 and len(effect.factors) == 1
            for pair, estimate, p in effect.pairs:
                kind = "difference" if pair.at is None else "simple effect"
                row = self._row(kind, self.pair_name(pair), estimate)
                # The only difference of a factor is the effect itself, which is tested once.
                if single and not corrected:
                    row["p"] = None
                    row["note"] = str(row["note"]) or "p: see the effect"
                yield row | ({"p_corrected": p} if corrected else {})

    def _row(self, kind: str, of: str, told: CellEstimate) -> Row:
        log = self.cells.scale == "log"
        value, low, high = (
            math.exp(each) if log and each is not None else each
            for each in (told.value, told.low, told.high)
        )
        return {
            "measure": self.cells.words,
            "kind": kind,
            "of": of,
            "participants": told.participants,
            "value": value,
            "low": low,
            "high": high,
            "size": told.size,
            "statistic": told.t,
            "df2": told.df,
            "p": told.p,
            "note": told.note or ("a mean has no test" if kind == "mean" else "t has one df"),
        }

    def effect_name(self, effect: ComparedEffect) -> str:
        """Words for an effect."""
        return " × ".join(self.cells.factors[at] for at in effect.factors)

    def pair_name(self, pair: LevelPair) -> str:
        """Words for two levels that are compared."""
        return pair_name(self.cells.factors, self.cells.levels, pair)

    def shown(self) -> ShownTable:
        """Table of the report's first page: means, effects, differences, and simple effects.

        Simple effects are those of interactions that are shown.
        """
        cells, rows = self.cells, []
        for at, mean in enumerate(self.means):
            rows.append((cells.name(at), str(mean.participants), self._with_ends(mean), "", "", ""))
        for effect in self.effects:
            test = effect.test
            single = len(effect.factors) == 1 and len(effect.pairs) == 1
            f = "" if test.f is None else _f(test)
            if not single:
                many = str(len(cells.people))
                rows.append(
                    (f"effect of {self.effect_name(effect)}", many, "", "", f, _p(effect.p))
                )
            if len(effect.factors) > 1 and not _sure(effect.p):
                continue
            for pair, told, p in effect.pairs:
                t = "" if told.t is None or told.df is None else _t(told.t, told.df)
                size = "" if told.size is None else to_print(told.size, Kind.NUMBER)
                rows.append(
                    (
                        self.pair_name(pair),
                        str(told.participants),
                        self._with_ends(told, difference=True),
                        size,
                        t,
                        _p(p),
                    )
                )
        size = "odds ratio" if isinstance(cells.data, CellShares) else "Hedges’s g"
        used = [True] * 3 + [any(row[at] for row in rows) for at in range(3, 6)]
        heads = ("what", "people", f"{cells.words} (95 % interval)", size, "test", "corrected p")
        keep = [at for at, is_used in enumerate(used) if is_used]
        return ShownTable(
            tuple(heads[at] for at in keep),
            tuple(tuple(row[at] for at in keep) for row in rows),
        )

    def _with_ends(self, told: CellEstimate, *, difference: bool = False) -> str:
        if told.value is None:
            return "–"
        text = self.cells.print_difference if difference else self.cells.print
        if told.low is None or told.high is None:
            return text(told.value)
        return f"{text(told.value)} ({text(told.low)} to {text(told.high)})"

    def notes(self) -> list[str]:
        """Reasons why something in the table is missing, each once."""
        told = [each.note for each in self.means]
        told += [effect.test.note for effect in self.effects]
        told += [each.note for effect in self.effects for _, each, _ in effect.pairs]
        return [note for note in dict.fromkeys([*told, self.cells.note]) if note]

    def sentences(self) -> Iterator[str]:
        """Result in sentences, what is about these people and what about others in each."""
        cells, people = self.cells, len(self.cells.people)
        several = people >= FEWEST_PARTICIPANTS
        told = [
            f"{cells.print(mean.value)}{'' if cells.name(at) == ALL else ' in ' + cells.name(at)}"
            + (
                f" ({cells.print(mean.low)} to {cells.print(mean.high)})"
                if mean.low is not None
                else ""
            )
            for at, mean in enumerate(self.means[:MOST_TOLD])
        ]
        more = "" if len(self.means) <= MOST_TOLD else "; the table has the other means"
        kind = "Geometric mean" if cells.scale == "log" else "Mean"
        others = any(mean.low is not None for mean in self.means)
        about = ", and in brackets 95 % intervals of the mean of people like them" if others else ""
        yield (
            f"{kind} {cells.words} of {'these' if several else 'the'} "
            f"{count(people, 'participant')}{about}: {'; '.join(told)}{more}."
        )
        if not several:
            yield (
                f"Of fewer than {FEWEST_PARTICIPANTS} participants nothing is known of how people "
                f"differ: nothing is tested, and nothing is said of others."
            )
            return
        for effect in self.effects:
            yield from self._effect_told(effect)

    def _effect_told(self, effect: ComparedEffect) -> Iterator[str]:
        name, words = self.effect_name(effect), self.cells.words
        words = words[0].upper() + words[1:]
        if effect.p is None:
            yield f"{words} could not be tested by {name}: {effect.test.note}."
            return
        numbers = f"{_f(effect.test)}, " if effect.test.f is not None else ""
        numbers += f"corrected {_p(effect.p, 'p ')}"
        if not _sure(effect.p):
            single = effect.pairs[0] if len(effect.pairs) == 1 else None
            at_most = ""
            if single is not None and single[1].low is not None:
                difference = self._with_ends(single[1], difference=True)
                at_most = f"; {self.pair_name(single[0])}: {difference}"
            yield f"{words}: no difference by {name} is shown ({numbers}{at_most})."
            return
        yield (
            f"{words}: a difference by {name} is shown ({numbers})."
            if len(effect.factors) == 1
            else f"{words}: {name} the effect of one depends on the other ({numbers})."
        )
        for pair, told, p in effect.pairs:
            if _sure(p) and told.value is not None:
                yield (
                    f"{self.pair_name(pair)}: {self._with_ends(told, difference=True)} in people "
                    f"like these {told.participants}, corrected {_p(p, 'p ')}."
                )

    def extremes(self) -> Iterator[str]:
        """Sentences on participants at the floor or at the ceiling of a share."""
        if self.cells.scale != "share":
            return
        for end, word in ((1.0, "right"), (0.0, "wrong")):
            told = [
                f"{number} of {known} in {self.cells.name(at)}"
                for at in range(len(self.means))
                if (number := int((self.cells.own[:, at] == end).sum()))
                and (known := int((~np.isnan(self.cells.own[:, at])).sum()))
            ]
            if len(told) > MOST_TOLD:
                yield (
                    f"In {len(told)} of the {len(self.means)} cells some participants have all "
                    f"{word}, so that their differences cannot be seen."
                )
            elif told:
                yield (
                    f"Participants with everything {word}, whose differences cannot be seen: "
                    f"{'; '.join(told)}."
                )

    def incomplete(self) -> Iterator[str]:
        """Clauses on participants who lack a cell that others of their group have."""
        have = ~np.isnan(self.cells.own)
        for at, who in enumerate(self.cells.people):
            alike = (have & have[at]).any(axis=1)
            if lacks := np.flatnonzero(have[alike].any(axis=0) & ~have[at]).tolist():
                named = ", ".join(self.cells.name(cell) for cell in lacks)
                yield f"participant {who}, where it needs all: nothing in {named}"

    def title(self) -> str:
        """Title of a report."""
        words = f"{self.cells.words[0].upper()}{self.cells.words[1:]}"
        return words + (f" by {' × '.join(self.cells.factors)}" if self.cells.factors else "")

    def figure(self, name: str = "primary") -> ReportFigure:
        """Bars of the means with intervals, and circles for participants."""
        cells = self.cells
        scale = 100.0 if cells.scale == "share" else 1.0
        first = cells.levels[0] if cells.factors else (ALL,)
        rest = sorted({tuple(place[1:]) for place in cells.places.tolist()})
        series = []
        for own in rest:
            at = [
                next(
                    (
                        cell
                        for cell, place in enumerate(cells.places.tolist())
                        if place[:1] in ([level], []) and tuple(place[1:]) == own
                    ),
                    None,
                )
                for level in range(len(first))
            ]
            named = [cells.levels[n + 1][level] for n, level in enumerate(own)]
            means = [None if cell is None else self.means[cell] for cell in at]
            values = [
                tuple(
                    None if mean is None else self._drawn(getattr(mean, end), scale)
                    for mean in means
                )
                for end in ("value", "low", "high")
            ]
            points = tuple(
                tuple(None if cell is None else self._drawn(row[cell], scale) for cell in at)
                for row in cells.own.tolist()
                if any(cell is not None and not math.isnan(row[cell]) for cell in at)
            )
            series.append(
                Series(
                    ", ".join(named) or "mean",
                    values[0],
                    values[1],
                    values[2],
                    points if len(points) > 1 else (),
                )
            )
        unit = "%" if cells.scale == "share" else cells.unit.strip()
        label = f"{cells.words} ({unit})" if unit else cells.words
        across = cells.factors[0] if cells.factors else ""
        means = [f"{cells.name(at)} {self._with_ends(mean)}" for at, mean in enumerate(self.means)]
        text = (
            f"Bars are means over participants with 95 % intervals, circles are participants"
            f"{', joined within each' if len(first) > 1 else ''}. "
            + ("; ".join(means) if len(means) <= MOST_TOLD else "The table has all numbers")
            + "."
        )
        title = self.title()
        table = PRIMARY.name if name == "primary" else EXPLORED.name
        chart = Bars(title, across, first, ((label, tuple(series)),))
        return ReportFigure(name, title, text, table, chart)

    def _drawn(self, value: float | None, scale: float) -> float | None:
        if value is None or math.isnan(value):
            return None
        return math.exp(value) if self.cells.scale == "log" else scale * value


def pair_name(factors: Sequence[str], levels: Sequence[Sequence[str]], pair: LevelPair) -> str:
    """Words for two levels that are compared: "texture: flat less rough"."""
    told = f"{levels[pair.factor][pair.first]} less {levels[pair.factor][pair.second]}"
    if pair.at is None:
        return f"{factors[pair.factor]}: {told}"
    other, level = pair.at
    return f"{told}, at {factors[other]} {levels[other][level]}"


def compare(cells: MeasureCells, correction: str) -> ComparedMeasure:
    """Means of a measure's cells, and the effects of the factors.

    Parameters
    ----------
    correction
        How p of all tests are corrected together: a key of `METHODS`.
    """
    means = [cells.data.mean(at) for at in range(len(cells.places))]
    return ComparedMeasure(cells, means, effects(cells.data, correction))


def table_of(compared: ComparedMeasure) -> ResultTable:
    """Table of the primary analysis."""
    return PRIMARY.fill(list(compared.rows()))


def _sure(p: float | None) -> bool:
    return p is not None and p < SURE


def _p(p: float | None, before: str = "") -> str:
    if p is None:
        return "not tested" if not before else f"{before}not known"
    text = to_print(p, Kind.P)
    return f"{before}{text}" if not before or text.startswith("<") else f"{before}= {text}"


def _f(test: Any) -> str:
    return (
        f"F({to_print(test.df1, Kind.TENTHS)}, {to_print(test.df2, Kind.TENTHS)}) = "
        f"{to_print(test.f, Kind.NUMBER)}"
    )


def _t(t: float, df: float) -> str:
    return f"t({to_print(df, Kind.TENTHS)}) = {to_print(t, Kind.NUMBER)}"
