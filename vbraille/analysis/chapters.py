"""All that is said of a study, and of a table of scores."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vbraille.analysis import figures
from vbraille.analysis.findings import findings
from vbraille.analysis.input.scoretable import of_trials
from vbraille.analysis.input.trials import Places, written
from vbraille.analysis.measures import (
    confusion,
    discrimination,
    legibility,
    levels,
    movement,
    preferences,
    rated,
    trends,
    trialsmodel,
)
from vbraille.analysis.methods import methods
from vbraille.analysis.results import Chapter, Results
from vbraille.analysis.statistics.intervals import METHODS
from vbraille.sessions.planning.questions import RatingQuestion

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

    from vbraille.analysis.input.scoretable import Scores
    from vbraille.analysis.input.study import Study
    from vbraille.analysis.input.trials import LeftOut
    from vbraille.analysis.results import ReportFigure, ResultTable

SEED = 20090618
_MAIN = ("means_", "legibility", "choices_")  # beginnings of names, the first that is found first


@dataclass(frozen=True, slots=True)
class Options:
    """Choices in an analysis.

    Parameters
    ----------
    factors
        Columns by which trials are compared.
    correction
        How the p-values of t-tests are corrected for their number, one of `METHODS`.
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

    factors: tuple[str, ...] = ("condition",)
    correction: str = "holm"
    marks: tuple[int, ...] = confusion.MARKS
    seed: int = SEED

    def __post_init__(self) -> None:
        if self.correction not in METHODS:
            raise ValueError(f"correction is {self.correction!r}; it must be one of {METHODS}")

    def described(self) -> list[tuple[str, str]]:
        """Describe the choices, as pairs of a word and a sentence, for the report's head."""
        return [
            ("Correction of t-tests", METHODS[self.correction]),
            ("Compared by", ", ".join(self.factors)),
            ("Intervals", f"95 %; random draws with seed {self.seed}"),
        ]


def options_of(correction: str, **chosen: Any) -> Options:
    """Options with what is chosen; what is chosen as None keeps its default."""
    given = {name: value for name, value in chosen.items() if value is not None}
    return Options(correction=correction, **given)


def analyse_study(study: Study, options: Options) -> Results:
    """Analyse trials and comparisons.

    Raises
    ------
    InputError
        If the trials have no such factor.
    """
    chapters: list[Chapter] = []
    left_out = list(study.left_out)
    if study.trials is not None:
        chapters += _of_trials(study, study.trials, options, left_out)
    if study.comparisons is not None:
        chapters.append(_of_comparisons(study, study.comparisons, options))
    if study.judgements is not None:
        chapters += _of_judgements(study, study.judgements)
    if any(session.notes for session in study.sessions):
        table = rated.notes(study.sessions)
        chapters.append(Chapter("Notes", "What the experimenter wrote down.", (table,)))
    told = methods(study)
    return _told(
        "Legibility sessions",
        (
            *([("Methods", told)] if told else ()),
            *study.about,
            *_excluded(left_out),
            *options.described(),
        ),
        study.warnings,
        chapters,
        None if study.trials is None else written(study.trials),
        study.faults,
    )


def compare_scores(scores: Scores, about: Sequence[tuple[str, str]], options: Options) -> Results:
    """Compare the levels of a table of scores.

    Parameters
    ----------
    about
        Where the table comes from, as pairs of a word and a sentence.
    """
    left_out: list[LeftOut] = []
    chapter = _compared([scores], options, left_out)
    told = [pair for pair in options.described() if pair[0] != "Compared by"]
    compared = ("Compared by", ", ".join(scores.factors))
    head = (*about, *_excluded(left_out), compared, *told)
    return _told("Scores", head, (), [chapter])


def _told(
    title: str,
    about: Sequence[tuple[str, str]],
    warnings: Sequence[str],
    chapters: Sequence[Chapter],
    trials: pd.DataFrame | None = None,
    faults: tuple[str, ...] = (),
) -> Results:
    """Results with the sentences of what was found, and the figure that stands beside them."""
    told = findings(table for chapter in chapters for table in chapter.tables)
    names = [figure.name for chapter in chapters for figure in chapter.figures]
    main = next(
        (name for start in _MAIN for name in names if name.startswith(start)),
        names[0] if names else "",
    )
    return Results(
        title, tuple(about), tuple(warnings), tuple(chapters), told, main, trials, faults
    )


def _excluded(left_out: Sequence[LeftOut]) -> list[tuple[str, str]]:
    told = "; ".join(f"{left.what}: {left.reason}" for left in left_out)
    return [("Excluded", told or "nothing")]


def _of_trials(
    study: Study, trials: pd.DataFrame, options: Options, left_out: list[LeftOut]
) -> list[Chapter]:
    places = Places.of(trials)
    own = legibility.legibility(trials, places)
    averages = legibility.averages(own)
    by_dots, dots_own = legibility.dots(places), legibility.dots_of_participants(places)
    errors, errors_own = confusion.errors(places), confusion.errors_of_participants(places)
    runs, slopes = trends.over_time(trials), trends.slopes(trials)
    ways = movement.trajectories(study.sessions, trials)
    drawn = figures.examples(study.sessions)
    tables, ways_drawn = ((), ()) if drawn is None else ((drawn[0],), (drawn[1],))
    return [
        Chapter(
            "Legibility",
            "Who read how much of it right, and how long it took.",
            (own, averages),
            (figures.legibility(own, averages),),
        ),
        Chapter(
            "Characters and strings",
            "What is easy to read, and what is not.",
            (legibility.characters(places), by_dots, dots_own, legibility.strings(trials)),
            (figures.dots(by_dots, dots_own),) if len(by_dots) else (),
        ),
        _confusions(trials, places, options),
        Chapter(
            "Errors",
            "What is wrong with wrong answers.",
            (errors, errors_own),
            (figures.errors(errors, errors_own),) if len(errors) else (),
        ),
        Chapter(
            "Over time",
            "Whether reading became harder or easier.",
            (slopes, runs),
            tuple(figures.over_time(runs, slopes)),
        ),
        Chapter(
            "How strings were read",
            "What the hand did, from the traces of sessions.",
            (movement.patterns(ways), movement.correlations(trials), ways, *tables),
            ways_drawn,
        ),
        _compared(of_trials(trials, places, options.factors), options, left_out),
        Chapter(
            "Trials modelled",
            "Conditions, and what else legibility goes with, by a logistic model of single trials.",
            (
                *trialsmodel.trials_model(trials, options.factors, options.correction),
                trialsmodel.covariates(trials, options.factors),
            ),
        ),
    ]


def _confusions(trials: pd.DataFrame, places: Places, options: Options) -> Chapter:
    tables: list[ResultTable] = [confusion.transmitted(trials, places, seed=options.seed)]
    drawn: list[ReportFigure] = []
    for counts, schema, reason in (
        (
            confusion.of_characters(places),
            confusion.CONFUSION_CHARACTERS,
            "no answer has as many places as its string",
        ),
        (
            confusion.of_pairs(trials),
            confusion.CONFUSION_PAIRS,
            "not every string has two places; a matrix is made of pairs alone",
        ),
    ):
        if counts is None:
            tables.append(schema.fill([], [reason]))
        else:
            tables.append(confusion.to_table(schema, counts, places, options.marks))
            drawn.append(figures.confusion(tables[-1]))
    return Chapter("Confusions", "What was taken for what.", tuple(tables), tuple(drawn))


def _compared(scores: Sequence[Scores], options: Options, left_out: list[LeftOut]) -> Chapter:
    means, own = levels.level_means(scores), levels.own_means(scores)
    table, dropped = levels.analyses(scores)
    left_out += dropped
    return Chapter(
        "Levels compared",
        "Differences within participants.",
        (means, own, levels.t_tests(scores, options.correction), table),
        tuple(figures.level_means(means, own)),
    )


def _of_comparisons(study: Study, comparisons: pd.DataFrame, options: Options) -> Chapter:
    table, preferred = preferences.tuning(comparisons, seed=options.seed)
    own = preferences.choices_of_participants(comparisons)
    each = preferences.own_values(comparisons, [session.protocol for session in study.sessions])
    return Chapter(
        "Which of two was chosen",
        "What participants took for closer to the reference.",
        (table, own, preferred, each),
        tuple(figures.choices(table, preferred, own)),
    )


def _of_judgements(study: Study, judgements: pd.DataFrame) -> list[Chapter]:
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
    if asked & {"detect", "same-different"} or (judgements["outcome"] != "").any():
        found, by_level = discrimination.thresholds(judgements)
        known = len(found) or "detect" in asked
        told.append(
            Chapter(
                "Telling apart",
                "How well one thing was told from another.",
                (discrimination.sensitivity(judgements), *((found, by_level) if known else ())),
                tuple(figures.rises(found, by_level)) if known else (),
            )
        )
    if "rating" in asked:
        text = "Where on a scale things were put."
        told.append(Chapter("Ratings", text, rated.ratings(judgements, scales)))
    if "magnitude" in asked:
        text = "How strong things felt, in numbers of one's own."
        told.append(Chapter("Magnitudes", text, (rated.magnitudes(judgements),)))
    if judgements["confidence"].notna().any():
        text = "How sure somebody was of the answers."
        told.append(Chapter("Confidence", text, (rated.confidence(judgements, sure),)))
    if "free" in asked:
        told.append(Chapter("Words", "What was said in words.", (rated.words(judgements),)))
    return told
