"""The codebook of a report has each column of each of its CSV files, in their order."""

import csv
import io
from pathlib import Path

from tests.analysis.making import table_of
from tests.analysis.report.made import RESULTS
from tests.tiers import heavy
from vbraille.analysis import analyse
from vbraille.analysis.report.tohtml import csv_name
from vbraille.analysis.report.written import codebook
from vbraille.analysis.results import Chapter, Column, Kind, Results

SAMPLE = Path(__file__).parents[1] / "input/samples/trials.csv"


def test_every_table_is_in_it_with_its_columns():
    read = [*csv.DictReader(io.StringIO(codebook(RESULTS, "trials.csv")))]
    assert [(row["file"], row["column"], row["meaning"]) for row in read] == [
        (csv_name(table), column.name, column.meaning)
        for table in RESULTS.result_tables()
        for column in table.columns
    ]


def test_a_number_with_a_decimal_is_no_duration():
    """A mean number of trials was told to be in seconds."""
    columns = (
        Column("trials", "trials", "mean number", Kind.TENTHS),
        Column("duration_mean_s", "mean duration (s)", "of them", Kind.TENTHS),
    )
    chapter = Chapter("All", (table_of(columns, ((7.5, 3.25),)),))
    read = csv.DictReader(io.StringIO(codebook(Results("One", (), (), (chapter,)), "trials.csv")))
    assert [row["unit"] for row in read] == ["", "s"]


@heavy  # a whole analysis
def test_every_column_of_an_analysis_is_in_it():
    results = analyse(SAMPLE)
    read = [*csv.DictReader(io.StringIO(codebook(results, "trials.csv")))]
    expected = [("trials.csv", name) for name in results.trials]
    for table in results.result_tables():
        expected += [(csv_name(table), column.name) for column in table.columns]
    assert [(row["file"], row["column"]) for row in read] == expected
    assert all(row["meaning"] for row in read)
    told = {(row["file"], row["column"]): row for row in read}
    assert told["tables/legibility.csv", "condition"]["values"] == "rough; smooth"
    assert told["tables/legibility.csv", "legibility"]["unit"] == "share, 1 = 100 %"
    assert told["tables/legibility.csv", "duration_mean_s"]["unit"] == "s"
    assert told["tables/legibility.csv", "trials"]["unit"] == "count"
