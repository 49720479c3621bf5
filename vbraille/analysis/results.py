"""What an analysis has found, in the order in which a report tells it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.analysis.schemas import ResultTable
    from vbraille.pictures.charts import Chart


@dataclass(frozen=True, slots=True)
class ReportFigure:
    """A figure of the report.

    Parameters
    ----------
    name
        Of its files: "legibility".
    title
        What it shows, in a line.
    text
        What is to be seen in it, in sentences, for who does not see it.
    table
        Name of the table that has its numbers.
    chart
        What is drawn.
    """

    name: str
    title: str
    text: str
    table: str
    chart: Chart


@dataclass(frozen=True, slots=True)
class Chapter:
    """A part of the report.

    Parameters
    ----------
    title
        Its heading.
    text
        What it is about: a sentence or two.
    tables, figures
        In the order in which they are shown: a figure stands after the tables.
    """

    title: str
    text: str
    tables: tuple[ResultTable, ...]
    figures: tuple[ReportFigure, ...] = ()


@dataclass(frozen=True, slots=True)
class Results:
    """All that is reported.

    Parameters
    ----------
    title
        Of the report.
    about
        What was analysed, as pairs of a word and a sentence: data, sessions, versions, rules.
    warnings
        What the reader must know before all numbers: damage, what is simulated.
    chapters
        In their order.
    findings
        What was found, in sentences.
    main
        Name of the figure that is shown beside these; empty for none.

    Raises
    ------
    ValueError
        If there is no such figure.
    """

    title: str
    about: tuple[tuple[str, str], ...]
    warnings: tuple[str, ...]
    chapters: tuple[Chapter, ...]
    findings: tuple[str, ...] = ()
    main: str = ""

    def __post_init__(self) -> None:
        if self.main and self.main not in {figure.name for figure in self.figures()}:
            raise ValueError(f"there is no figure {self.main} to stand first")

    def main_figure(self) -> ReportFigure | None:
        """The figure that stands first; None if none does."""
        return next((figure for figure in self.figures() if figure.name == self.main), None)

    def tables(self) -> Iterator[ResultTable]:
        """All tables, in the order of the report."""
        for chapter in self.chapters:
            yield from chapter.tables

    def figures(self) -> Iterator[ReportFigure]:
        """All figures, in the order of the report."""
        for chapter in self.chapters:
            yield from chapter.figures
