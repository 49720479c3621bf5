"""What an analysis has found, in the order in which a report tells it."""

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
    tables, pictures
        In the order in which they are shown: a picture stands after the tables.
    """

    title: str
    text: str
    tables: tuple[ResultTable, ...]
    pictures: tuple[ReportFigure, ...] = ()


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
    sections
        In their order.
    findings
        What was found, in sentences.
    main
        Name of the picture that is shown beside these; empty for none.

    Raises
    ------
    ValueError
        If there is no such picture.
    """

    title: str
    about: tuple[tuple[str, str], ...]
    warnings: tuple[str, ...]
    sections: tuple[Chapter, ...]
    findings: tuple[str, ...] = ()
    main: str = ""

    def __post_init__(self) -> None:
        if self.main and self.main not in {picture.name for picture in self.pictures()}:
            raise ValueError(f"there is no picture {self.main} to stand first")

    def main_picture(self) -> ReportFigure | None:
        """The picture that stands first; None if none does."""
        return next((picture for picture in self.pictures() if picture.name == self.main), None)

    def tables(self) -> Iterator[ResultTable]:
        """All tables, in the order of the report."""
        for section in self.sections:
            yield from section.tables

    def table(self, name: str) -> pd.DataFrame:
        """A table as a data frame, by its name, such as "legibility".

        Raises
        ------
        InputError
            If there is none of that name; it names those that there are.
        """
        import pandas as pd

        found = {table.name: table for table in self.tables()}
        if name not in found:
            raise InputError(f"there is no table {name!r}; there are {', '.join(found)}")
        return pd.DataFrame(found[name].records(), columns=list(found[name].names))

    def pictures(self) -> Iterator[ReportFigure]:
        """All pictures, in the order of the report."""
        for section in self.sections:
            yield from section.pictures
