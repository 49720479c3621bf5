"""All that is said of a study, and of a table of scores: the primary analysis, then all else."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from msgspec import structs

from vbraille.analysis import figures
from vbraille.analysis.input.study import excluding
from vbraille.analysis.input.trials import Places, cell_keys, comparable, written
from vbraille.analysis.measures import (
    confusion,
    covariates,
    discrimination,
    legibility,
    movement,
    naming,
    passages,
    preferences,
    rated,
    scaling,
    trends,
)
from vbraille.analysis.methods import analysed_by, methods
from vbraille.analysis.orders import order_of
from vbraille.analysis.primary import (
    EXPLORED,
    PRIMARY,
    ComparedMeasure,
    arrange,
    cells_of,
    compare,
)
from vbraille.analysis.results import Chapter, Column, Kind, Results, Schema
from vbraille.analysis.statistics.intervals import METHODS, Interval, adjust
from vbraille.errors import InputError
from vbraille.sessions.planning.analysis import CONDITION, MEASURES, PlannedAnalysis, Task
from vbraille.sessions.planning.questions import NameQuestion, OneOfTwo, RatingQuestion
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from vbraille.analysis.input.study import Study
    from vbraille.analysis.input.trials import CellKeys
    from vbraille.analysis.results import ReportFigure, ResultTable
    from vbraille.sessions.planning.protocol import Protocol

SEED = 1
MOST_LEVELS = 50  # a factor with more levels was not varied by an experimenter
MOST_CELLS = 1_000_000  # cells of all participants together
STAGES = 2  # of the analysis of a study: measures compared, and all else
SOURCES = Schema(
    "sources",
    "Data, sessions and versions",
    "Where the numbers come from.",
    (Column("what", "what", "what is told"), Column("told", "told", "in words")),
)


_BY_CONDITION = {CONDITION: frozenset[str]()}


@dataclass(frozen=True, slots=True)
class Options:
    """Choices in an analysis; None takes what was planned.

    Parameters
    ----------
    factors
        Columns by which trials are compared.
    correction
        How p are corrected for their number, one of `METHODS`.
    marks
        Errors above these counts are marked in confusion matrices.
    seed
        Seed of what is drawn at random: resamples of comparisons, and the shares that
        information is worked out of.

    Raises
    ------
    ValueError
        If there is no such correction.
    """

    factors: tuple[str, ...] | None = None
    correction: str | None = None
    marks: tuple[int, ...] = confusion.MARKS
    seed: int = SEED

    def __post_init__(self) -> None:
        if self.correction is not None and self.correction not in METHODS:
            raise ValueError(f"correction is {self.correction!r}; it must be one of {METHODS}")


def options_of(**chosen: Any) -> Options:
    """Options with what is chosen; what is chosen as None keeps its default."""
    return Options(**{name: value for name, value in chosen.items() if value is not None})


@dataclass(frozen=True, slots=True)
class FollowedPlan:
    """Analysis that is followed, and where it departs from what was planned."""

    analysis: PlannedAnalysis
    columns: tuple[str, ...]
    departures: tuple[str, ...]


def analyse_study(
    study: Study, options: Options, report: Callable[[int], None] = lambda _: None
) -> Results:
    """Analyse trials, comparisons and judgements.

    Parameters
    ----------
    report
        Told after each of the `STAGES` how many are done.

    Raises
    ------
    InputError
        If the trials have no such factor.
    """
    plan = plan_of(study, options)
    study = excluding(study, plan.analysis)
    places = None if study.trials is None else Places.of(study.trials)
    measured = _measured(study, places, plan)
    correction = plan.analysis.correction
    primary = measured.pop(plan.analysis.measure or "", None)
    compared = None if primary is None else compare(primary, correction)
    others = [compare(cells, "none") for cells in measured.values()]
    chapters = [_others(others)]
    report(1)
    if study.trials is not None and places is not None:
        chapters += _of_trials(study, study.trials, places, plan, options)
    if study.comparisons is not None:
        chapters.append(_of_comparisons(study, study.comparisons, options))
    if study.judgements is not None:
        chapters += _of_judgements(study, study.judgements, plan)
    if (order := order_of(study, places, plan.analysis)) is not None:
        chapters.append(order)
    if any(session.notes for session in study.sessions):
        table = rated.notes(study.sessions)
        chapters.append(Chapter("Notes", (table,)))
    chapters = _corrected([each for each in map(_filled, chapters) if each.tables], correction)
    about = (*study.about, *_chosen(plan, options))
    report(STAGES)
    return _told(
        "Report of a study" if compared is None else compared.title(),
        about,
        study.warnings,
        compared,
        chapters,
        question=(f"Planned: {plan.analysis.described()}.", *plan.departures),
        methods=" ".join(
            filter(None, (methods(study, left_out=False), analysed_by(compared, plan.analysis)))
        ),
        excluded=tuple(f"{left.what}: {left.reason}" for left in study.left_out),
        chance=_chance(study, plan.analysis),
        trials=None if study.trials is None else written(study.trials),
        faults=study.faults,
    )


def compare_scores(
    scores: pd.DataFrame, about: Sequence[tuple[str, str]], options: Options
) -> Results:
    """Compare the levels of a table of scores.

    Parameters
    ----------
    scores
        The ``participant`` and ``value`` of each score, and a column for each factor.
    about
        Where the table comes from, as pairs of a word and a sentence.
    """
    frame = scores.dropna(subset="value")
    if frame.empty:
        raise InputError("the table has no scores to compare; add some")
    columns = tuple(str(name) for name in scores if name not in ("participant", "value"))
    _check_levels(frame, columns)
    cells = arrange(frame, columns, ("score", "score", ""), "linear", Interval(-np.inf, np.inf))
    analysis = structs.replace(
        PlannedAnalysis(factors=columns, model="means", measure=None),
        correction=options.correction or "holm",
    )
    compared = compare(cells, analysis.correction)
    return _told(
        compared.title(),
        about,
        (),
        compared,
        [],
        question=("No analysis was planned: a table of scores has no protocol.",),
        methods=analysed_by(compared, analysis),
    )


def plan_of(study: Study, options: Options) -> FollowedPlan:
    """Analysis that was planned, and where the options and the data depart from it.

    Raises
    ------
    InputError
        If there is no such factor.
    """
    protocols = {session.protocol.name: session.protocol for session in study.sessions}
    parts = (study.trials, study.comparisons, study.judgements)
    names = {name for part in parts if part is not None for name in part["protocol"].unique()}
    told: list[str] = []
    several = len(names) > 1
    if len(protocols) == 1 and not several:
        (protocol,) = protocols.values()
        analysis = protocol.planned_analysis
        if protocol.analysis is None:
            told.append("The protocol plans no analysis: this is the usual one of its task.")
        if len({session.protocol.planned_analysis for session in study.sessions}) > 1:
            told.append("Sessions plan different analyses; that of the first is followed.")
        told += _departures(study, analysis)
    else:
        question = "free" if several else _question(study)
        task = Task(question, scored=False, adaptive=False, catch=False, factors=_BY_CONDITION)
        analysis = PlannedAnalysis().resolved(task)
        told.append(
            f"The data are of {len(names)} protocols, and a primary analysis is of one: take it by "
            f"--protocol."
            if several
            else "No analysis was planned: a table of trials has no protocol. This is the usual "
            "one of its question."
        )
    columns = tuple(analysis.column(name) for name in analysis.factors or ())
    if options.factors is not None and options.factors != columns:
        told.append(f"Compared by {', '.join(options.factors)}, as asked for, and not as planned.")
        columns = options.factors
    if options.correction not in (None, analysis.correction):
        told.append(
            f"p are corrected by {METHODS[options.correction or '']}, as asked for, and not by "
            f"{METHODS[analysis.correction]}."
        )
        analysis = structs.replace(analysis, correction=options.correction)
    whole = next(part for part in parts if part is not None)
    for name in columns:
        if name not in comparable(whole):
            raise InputError(
                f"there is no column {name!r} to compare by; "
                f"there are {', '.join(comparable(whole))}"
            )
    if options.factors is None:
        columns = tuple(name for name in columns if whole[name].nunique() > 1)
    _check_levels(whole, columns)
    return FollowedPlan(analysis, columns, tuple(told))


def _question(study: Study) -> str:
    """Kind of the question that most of a study's rows answer."""
    if study.trials is not None:
        return "identify"
    if study.comparisons is not None:
        return "which"
    assert study.judgements is not None
    return str(study.judgements["question"].mode().iloc[0])


def _departures(study: Study, analysis: PlannedAnalysis) -> Iterator[str]:
    """Sentences on people and sessions that are not as planned."""
    people = len({session.head["participant"] for session in study.sessions})
    if analysis.participants not in (None, people):
        yield (
            f"Planned were {count(analysis.participants or 0, 'participant')}, and here are "
            f"{people}."
        )
    if unended := [session.name for session in study.sessions if session.state != "ended"]:
        yield f"Not ended: {', '.join(unended)}."
    if dropped := [one.what for one in study.left_out if one.what.startswith("participant ")]:
        yield f"Left out, which was not planned: {', '.join(dropped)}."


def _check_levels(whole: pd.DataFrame, columns: Sequence[str]) -> None:
    cells = whole["participant"].nunique()
    for name in columns:
        many = whole[name].nunique()
        cells *= many
        if many > MOST_LEVELS:
            raise InputError(
                f"{name} has {many} levels, more than can be compared; "
                f"give a factor of a few, such as condition"
            )
    if cells > MOST_CELLS:
        raise InputError(f"{', '.join(columns)} have too many levels together; give fewer factors")


def _measured(study: Study, places: Places | None, plan: FollowedPlan) -> dict[str, Any]:
    """Each measure that there is something of, by its name."""
    found = {}
    for name, measure in MEASURES.items():
        model = "trials" if measure.scale == "share" else "means"
        chosen = (plan.analysis.model or model) if name == plan.analysis.measure else model
        # A threshold is found along the levels that it would be compared by.
        columns = plan.columns if name != "threshold" or plan.analysis.measure == name else ()
        cells = cells_of(study, places, name, columns, chosen)
        if cells is not None:
            found[name] = cells
    return found


def _chance(study: Study, analysis: PlannedAnalysis) -> tuple[str, ...]:
    """Sentence on what guessing would give, where a share is compared."""
    if analysis.measure == "right":
        protocols = [session.protocol for session in study.sessions]
        ways = guesses_of(protocols[0]) if protocols else 2
        return (f"Guessing alone would give {100 / ways:.2g} %.",)
    if analysis.measure != "legibility" or study.trials is None:
        return ()
    shown = study.trials["presented"].nunique()
    return (
        f"Guessing among the {count(shown, 'string')} that were shown would give "
        f"{100 / shown:.2g} %.",
    )


def guesses_of(protocol: Protocol) -> int:
    """Number of answers that a trial may have, among which a guess is made."""
    question = protocol.asks
    if isinstance(question, NameQuestion):
        return math.prod(len(choice.names) for choice in question.choices)
    return 2 if isinstance(question, OneOfTwo) else max(2, protocol.intervals)


def _told(
    title: str,
    about: Sequence[tuple[str, str]],
    warnings: Sequence[str],
    compared: ComparedMeasure | None,
    chapters: Sequence[Chapter],
    *,
    chance: tuple[str, ...] = (),
    excluded: tuple[str, ...] = (),
    **more: Any,
) -> Results:
    """Results with the primary analysis first."""
    first: tuple[Chapter, ...] = ()
    if compared is not None:
        table = PRIMARY.fill(list(compared.rows()))
        first = (Chapter("Primary analysis", (table,), (compared.figure(),)),)
        more |= {
            "findings": (*compared.sentences(), *chance, *compared.extremes()),
            "shown": compared.shown(),
            "notes": tuple(compared.notes()),
            "main": "primary",
        }
        excluded = (*excluded, *compared.incomplete())
    sources = SOURCES.fill([{"what": word, "told": told} for word, told in about])
    last = Chapter("Sources", (sources,))
    return Results(
        title,
        tuple(about),
        tuple(warnings),
        (*first, *chapters, last),
        excluded=excluded,
        **more,
    )


def _chosen(plan: FollowedPlan, options: Options) -> list[tuple[str, str]]:
    return [
        ("Compared by", ", ".join(plan.columns) or "nothing"),
        ("Correction of p", METHODS[plan.analysis.correction]),
        ("Intervals", f"95 %; random draws with seed {options.seed}"),
    ]


def _others(others: Sequence[ComparedMeasure]) -> Chapter:
    rows = [row for each in others for row in each.rows(corrected=False)]
    drawn = tuple(each.figure(f"means_{each.cells.measure}") for each in others)
    return Chapter("Other measures", (EXPLORED.fill(rows),), drawn)


def _filled(chapter: Chapter) -> Chapter:
    """Chapter without tables that have no rows."""
    tables = tuple(table for table in chapter.tables if len(table))
    names = {table.name for table in tables}
    drawn = tuple(figure for figure in chapter.figures if figure.table in names)
    return replace(chapter, tables=tables, figures=drawn)


def _corrected(chapters: Sequence[Chapter], correction: str) -> list[Chapter]:
    """Chapters with each p corrected for all p of all of their tables."""
    tested = [
        (table, column)
        for chapter in chapters
        for table in chapter.tables
        for column in table.columns
        if column.kind is Kind.P
    ]
    known = [table.frame[column.name].dropna() for table, column in tested]
    joined = np.concatenate([p.to_numpy() for p in known]) if known else np.empty(0)
    every = iter(adjust(joined, correction).tolist() if joined.size else [])
    made: dict[str, ResultTable] = {}
    for (table, column), p in zip(tested, known, strict=True):
        now = made.get(table.name, table)
        own = Column(
            f"{column.name}_corrected",
            f"{column.heading} corrected",
            f"for all {joined.size} exploratory tests of the report",
            Kind.P,
        )
        at = now.columns.index(column) + 1
        columns = (*now.columns[:at], own, *now.columns[at:])
        corrected = pd.Series([next(every) for _ in range(len(p))], p.index, np.float64)
        frame = now.frame.copy()
        frame.insert(at, own.name, corrected.reindex(frame.index))
        made[table.name] = replace(now, schema=replace(now.schema, columns=columns), frame=frame)
    return [
        replace(chapter, tables=tuple(made.get(table.name, table) for table in chapter.tables))
        for chapter in chapters
    ]


def _of_trials(
    study: Study, trials: pd.DataFrame, places: Places, plan: FollowedPlan, options: Options
) -> list[Chapter]:
    keys = cell_keys(session.protocol for session in study.sessions)
    own = legibility.legibility(trials, places)
    averages = legibility.averages(own)
    by_dots, dots_own = legibility.dots(places), legibility.dots_of_participants(places)
    errors, errors_own = confusion.errors(places), confusion.errors_of_participants(places)
    runs, slopes = trends.over_time(trials), trends.slopes(trials)
    ways = movement.trajectories(study.sessions, trials, keys)
    drawn = figures.examples(study.sessions)
    tables, ways_drawn = ((), ()) if drawn is None else ((drawn[0],), (drawn[1],))
    return [
        Chapter(
            "Legibility",
            (own, averages),
            (figures.legibility(own, averages),),
        ),
        Chapter(
            "Characters and strings",
            (
                legibility.characters(places, keys),
                by_dots,
                dots_own,
                legibility.strings(trials, keys),
            ),
            (figures.dots(by_dots, dots_own),) if len(by_dots) else (),
        ),
        _confusions(trials, places, keys, options),
        Chapter(
            "Errors",
            (errors, errors_own),
            (figures.errors(errors, errors_own),) if len(errors) else (),
        ),
        Chapter(
            "Over time",
            (slopes, runs),
            tuple(figures.over_time(runs, slopes)),
        ),
        Chapter(
            "How strings were read",
            (movement.patterns(ways), movement.correlations(trials), ways, *tables),
            ways_drawn,
        ),
        Chapter(
            "Trials modelled",
            (covariates.covariates(trials, plan.columns),),
        ),
    ]


def _confusions(trials: pd.DataFrame, places: Places, keys: CellKeys, options: Options) -> Chapter:
    tables: list[ResultTable] = [confusion.transmitted(trials, places, seed=options.seed)]
    drawn: list[ReportFigure] = []
    for counts, schema, reason in (
        (
            confusion.of_characters(places, keys),
            confusion.CONFUSION_CHARACTERS,
            "no answer has as many places as its string",
        ),
        (
            confusion.of_pairs(trials, keys),
            confusion.CONFUSION_PAIRS,
            "not every string has two places; a matrix is made of pairs alone",
        ),
    ):
        if counts is None:
            tables.append(schema.fill([], [reason]))
        else:
            tables.append(confusion.to_table(schema, counts, places, options.marks))
            drawn.append(figures.confusion(tables[-1]))
    return Chapter("Confusions", tuple(tables), tuple(drawn))


def _of_comparisons(study: Study, comparisons: pd.DataFrame, options: Options) -> Chapter:
    table, preferred = preferences.tuning(comparisons, seed=options.seed)
    own = preferences.choices_of_participants(comparisons)
    each = preferences.own_values(comparisons, [session.protocol for session in study.sessions])
    return Chapter(
        "Which of two was chosen",
        (table, own, preferred, each),
        tuple(figures.choices(table, preferred, own)),
    )


def _of_judgements(study: Study, judgements: pd.DataFrame, plan: FollowedPlan) -> list[Chapter]:
    """Chapters of the questions that were asked, beside which cells and which of two."""
    scales: dict[str, tuple[float, float]] = {}
    sure: dict[str, tuple[float, float]] = {}
    for protocol in (session.protocol for session in study.sessions):
        question = protocol.asks
        if isinstance(question, RatingQuestion):
            scales[protocol.name] = question.least, question.most
        if question.confidence is not None:
            sure[protocol.name] = question.confidence.least, question.confidence.most
    asked = {*judgements["question"]}
    told: list[Chapter] = []
    pictures = naming.named(judgements)
    judgements = judgements[judgements["question"] != naming.NAME]
    if len(pictures):
        protocols = {session.protocol.name: session.protocol for session in study.sessions}
        told.append(
            Chapter(
                "Names",
                (
                    naming.cells(pictures, plan.columns),
                    naming.confusions(pictures, protocols),
                    naming.participants(pictures, protocols),
                ),
            )
        )
    if judgements.empty:
        return told
    if asked & {"detect", "same-different"} or (judgements["outcome"] != "").any():
        found, by_level = discrimination.thresholds(judgements, plan.columns)
        known = len(found) or "detect" in asked
        told.append(
            Chapter(
                "Telling apart",
                (discrimination.sensitivity(judgements), *((found, by_level) if known else ())),
                tuple(figures.rises(found, by_level)) if known else (),
            )
        )
    points, means = scaling.equality(judgements)
    apart, exponents = scaling.apart(judgements), scaling.exponents(judgements)
    compared = [table for table in (points, means, apart, exponents) if len(table)]
    if compared:
        told.append(Chapter("Scaling", tuple(compared)))
    if "read" in asked:
        told.append(Chapter("Reading speed", (passages.reading_speed(judgements),)))
    if "rating" in asked:
        told.append(Chapter("Ratings", rated.ratings(judgements, scales)))
    if "magnitude" in asked:
        told.append(Chapter("Magnitudes", (rated.magnitudes(judgements),)))
    if judgements["confidence"].notna().any():
        told.append(Chapter("Confidence", (rated.confidence(judgements, sure),)))
    if "free" in asked:
        told.append(Chapter("Words", (rated.words(judgements),)))
    return told
