"""Figures of psychometric functions: how answers rise with the level, and the thresholds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.results import ReportFigure
from vbraille.analysis.schemas import Kind, to_print
from vbraille.analysis.statistics.psychometric import SHAPES
from vbraille.pictures.charts import Rise, Rises

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.analysis.schemas import ResultTable, Row

MOST_PANELS = 12  # in one figure
MOST_PAGES = 10  # figures
_POINTS = 80  # of a curve
_SHAPE = {"detect": "logistic", "which": "weibull"}
_WHOSE = ("question", "participant", "protocol", "level")
_TOLD = 6  # thresholds that the text tells; the table has all


def rises(table: ResultTable, levels: ResultTable) -> Iterator[ReportFigure]:
    """Psychometric functions, `MOST_PANELS` to a figure.

    Parameters
    ----------
    table, levels
        Tables of thresholds, and of answers by level.
    """
    answers: dict[tuple[str, ...], list[Row]] = {}
    for row in levels.records():
        answers.setdefault(tuple(row[name] for name in _WHOSE), []).append(row)
    drawn = [row for row in table.records() if tuple(row[n] for n in _WHOSE) in answers]
    panels = [_panel(row, answers[tuple(row[name] for name in _WHOSE)]) for row in drawn]
    known = [row for row in drawn if row["threshold"] is not None]
    said = "; ".join(
        f"{row['participant']}, {row['level']}: {to_print(row['threshold'], Kind.NUMBER)} "
        f"({to_print(row['low'], Kind.NUMBER)} to {to_print(row['high'], Kind.NUMBER)})"
        for row in known[:_TOLD]
    )
    more = "; the table has all" if len(known) > _TOLD else ""
    pages = -(-len(panels) // MOST_PANELS)
    for page in range(min(pages, MOST_PAGES)):
        part = f", {page + 1} of {pages}" if pages > 1 else ""
        title = f"Answers by level, and thresholds{part}"
        text = (
            "A panel for each participant and level; the more trials, the larger the dot, and the "
            f"curve is the psychometric function. Thresholds with their 95 % intervals: "
            f"{said or 'none'}{more}."
        )
        yield ReportFigure(
            "thresholds" if not page else f"thresholds_{page + 1}",
            title,
            text if not page else "As the figure before, of the participants that follow.",
            levels.name,
            Rises(title, tuple(panels[page * MOST_PANELS : (page + 1) * MOST_PANELS])),
        )


def _panel(row: Row, answers: list[Row]) -> Rise:
    answers = [answer for answer in answers if answer["value"] is not None]
    levels = tuple(answer["value"] for answer in answers)
    curve: tuple[tuple[float, float], ...] = ()
    threshold = None
    if row["threshold"] is not None:
        x = np.linspace(min(levels), max(levels), _POINTS)
        rising = SHAPES[_SHAPE[row["question"]]](
            x, np.array(row["threshold"]), np.array(row["spread"])
        )
        shares = row["guesses"] + (1 - row["guesses"] - row["lapses"]) * rising
        curve = tuple(zip(x.tolist(), shares.tolist(), strict=True))
        threshold = (row["threshold"], row["low"], row["high"])
    what = "difference of " if row["question"] == "which" else ""
    return Rise(
        f"{row['participant']}, {row['question']}, {row['level']}",
        f"{what}{_words(row['level'])}",
        levels,
        tuple(answer["share"] for answer in answers),
        tuple(answer["trials"] for answer in answers),
        curve,
        threshold,
    )


def _words(level: str) -> str:
    unit = " (mm)" if level.endswith("_mm") else ""
    return level.removesuffix("_mm").replace("_", " ") + unit
