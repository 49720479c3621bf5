"""Results of an analysis, in the order in which a report tells them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    import pandas as pd

    from vbraille.analysis.schemas import ResultTable
    from vbraille.pictures.charts import Chart


@dataclass(frozen=True, slots=True)
class ReportFigure:
    """A figure of the report.

    Parameters
    ----------
    name
        Name of its files: "legibility".
    title
        What the figure shows, in a line.
    text
        What is to be seen in it, in sentences, for readers who do not see it.
    table
        Name of the table that has the figure's numbers.
    chart
        Chart that is drawn.
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
        Heading of the chapter.
    text
        What the chapter is about: a sentence or two.
    tables, figures
        What the chapter shows, in order: figures stand after the tables.
    """

    title: str
    text: str
    tables: tuple[ResultTable, ...]
    figures: tuple[ReportFigure, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Results:
    """All that an analysis reports.

    Parameters
    ----------
    title
        Heading of the report.
    about
        What was analysed, as pairs of a word and a sentence: data, sessions, versions, rules.
    warnings
        What the reader must know before all numbers: damage, what is simulated.
    chapters
        Tables and figures, in the order of the report.
    findings
        What was found, in sentences.
    main
        Name of the figure that is shown beside the findings; empty for none.
    trials
        Trials that were analysed, with all columns that were given; None if there were none.
    faults
        What is damaged in the sessions, in clauses.
    """

    title: str
    about: tuple[tuple[str, str], ...]
    warnings: tuple[str, ...]
    chapters: tuple[Chapter, ...]
    findings: tuple[str, ...] = ()
    main: str = ""
    trials: pd.DataFrame | None = None
    faults: tuple[str, ...] = ()

    @property
    def tables(self) -> dict[str, pd.DataFrame]:
        """All tables as data frames, by name, in the order of the report."""
        return {table.name: table.frame for table in self.result_tables()}

    def table(self, name: str) -> pd.DataFrame:
        """One table as a data frame: docs/tables.md describes its columns.

        Raises
        ------
        InputError
            If there is no table of this name.
        """
        if name not in self.tables:
            raise InputError(f"there is no table {name!r}; there are {', '.join(self.tables)}")
        return self.tables[name]

    def result_tables(self) -> Iterator[ResultTable]:
        """All tables with titles, columns and notes, in the order of the report."""
        for chapter in self.chapters:
            yield from chapter.tables

    def figures(self) -> Iterator[ReportFigure]:
        """All figures, in the order of the report."""
        for chapter in self.chapters:
            yield from chapter.figures
