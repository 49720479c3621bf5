"""Trials in a few words, and all the tables that are made of them."""

import pandas as pd

from vbraille.analysis.input.parsing import parse
from vbraille.analysis.input.sheets import Sheet
from vbraille.analysis.input.trials import Places
from vbraille.analysis.measures import (
    confusion,
    covariates,
    legibility,
    movement,
    trends,
)
from vbraille.analysis.results import Schema

COLUMNS = "participant condition presented answered duration_s"


def from_rows(name, rows):
    """Sheet of rows, as text."""
    table = [{column: str(value) for column, value in row.items()} for row in rows]
    return Sheet(name, pd.DataFrame(table, range(1, len(table) + 1), dtype=object))


def sheet(*lines, columns=COLUMNS, name="made"):
    """A row a line: values with white space between, - for an empty one."""
    rows = [line.split() for line in lines]
    return from_rows(
        name,
        [
            dict(zip(columns.split(), ["" if v == "-" else v for v in row], strict=True))
            for row in rows
        ],
    )


def made(*lines, columns=COLUMNS):
    """Trials of such lines, and their places."""
    trials = parse([sheet(*lines, columns=columns)]).trials
    return trials, Places.of(trials)


def answers(*lines, timed="-"):
    """The same, of lines without a duration: "P1 T0 ac aa"."""
    return made(*(f"{line} {timed}" for line in lines))


def levels(column):
    """Levels of a column, in their order."""
    return tuple(column.cat.categories)


def table_of(columns, rows, notes=(), marks=(), told=("t", "", "")):
    """A table of rows whose values are in the columns' order."""
    schema = Schema(*told, columns)
    named = [dict(zip(schema.names, row, strict=True)) for row in rows]
    return schema.fill(named, notes, marks=marks)


def record(table, **where):
    """The one row that has these values."""
    (found,) = [
        row for row in table.records() if all(row[name] == value for name, value in where.items())
    ]
    return found


def all_tables(trials, places):
    """Every table of trials."""
    by_participant = legibility.legibility(trials, places)
    seen = movement.trajectories([])
    matrices = [
        (confusion.CONFUSION_CHARACTERS, confusion.of_characters(places)),
        (confusion.CONFUSION_PAIRS, confusion.of_pairs(trials)),
    ]
    return [
        by_participant,
        legibility.averages(by_participant),
        legibility.characters(places),
        legibility.strings(trials),
        legibility.dots(places),
        *(confusion.to_table(*of, places) for of in matrices if of[1] is not None),
        confusion.transmitted(trials, places, seed=1),
        confusion.errors(places),
        trends.over_time(trials),
        trends.slopes(trials),
        seen,
        movement.patterns(seen),
        movement.correlations(trials),
        covariates.covariates(trials, ["condition"]),
    ]
