"""Scores to compare: one a participant and cell of a design."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.analysis.statistics.intervals import LARGEST
from vbraille.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

    from vbraille.analysis.input.sheets import Sheet


def of_sheet(sheet: Sheet) -> pd.DataFrame:
    """Scores of a table with columns ``participant`` and ``score``, and one for each factor.

    Returns
    -------
    DataFrame
        The ``participant`` and the factors as text, and ``value``, float64, NaN where a score is
        missing.

    Raises
    ------
    InputError
        If the sheet is no such table.
    """
    sheet.need(("participant", "score"))
    names = [str(name) for name in sheet.frame if name not in ("participant", "score")]
    if not names:
        raise InputError(
            f"{sheet.name} has no column but participant and score; add one for what was varied, "
            f"such as texture"
        )
    if not len(sheet):
        raise InputError(f"{sheet.name} has no scores; add a line for each")
    frame = sheet.frame.map(str.strip)
    for name in ("participant", *names):
        empty = frame.index[frame[name] == ""]
        if empty.size:
            raise InputError(f"{sheet.place(empty[0])}: {name} is empty; fill it in")
    scores = [_score(sheet, row, text) for row, text in frame["score"].items()]
    return frame[["participant", *names]].assign(value=scores)


def _score(sheet: Sheet, row: object, text: str) -> float:
    score = sheet.value(text)
    if abs(score) >= LARGEST:
        raise InputError(
            f"{sheet.place(row)}: score is {text!r}; give a number, or nothing if it is missing"
        )
    return score
