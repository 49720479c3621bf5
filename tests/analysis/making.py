"""Tables of trials and of scores for tests, and analyses of them."""

import csv
import io
from pathlib import Path

from vbraille.analysis import analyse, analyse_scores

CASES = Path(__file__).parent / "cases"


def trials_of(shares, trials=26, **columns):
    """Rows of strings: people by conditions, each with a number of right answers.

    `shares` has the numbers of right answers of each person by condition; one may be a pair of
    right answers and trials.
    """
    rows = []
    for condition, people in shares.items():
        for number, right in enumerate(people, 1):
            if right is None:
                continue
            good, asked = right if isinstance(right, tuple) else (right, trials)
            for trial in range(asked):
                answered = "ab" if trial < good else "ac"
                row = {"participant": f"P{number:02}", "condition": condition}
                rows.append(row | {"presented": "ab", "answered": answered} | columns)
    return rows


def to_csv(rows, separator=","):
    """Rows as CSV."""
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), delimiter=separator, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def analysed(rows, folder, name="trials.csv", **options):
    """The analysis of rows, by way of a file."""
    path = Path(folder) / name
    path.write_text(rows if isinstance(rows, str) else to_csv(rows), encoding="utf-8")
    return analyse([path], **options)


def scored(rows, folder):
    """The analysis of rows of scores, by way of a file."""
    path = Path(folder) / "scores.csv"
    path.write_text(to_csv(rows), encoding="utf-8")
    return analyse_scores(path)


def row_of(table, **values):
    """The only row of a table that has these values, as a dict."""
    for name, value in values.items():
        table = table[table[name].astype(str) == str(value)]
    (row,) = table.to_dict("records")
    return row
