"""Answers that are no cells: yes and no, same and different, ratings, magnitudes, words.

Judgements have a row for each answered trial, with the columns ``participant``, ``session``,
``protocol``, ``condition`` (categories in natural order), ``block``, ``trial``, and

- ``question``: kind of the question, a key of `vbraille.sessions.planning.questions.KINDS`;
- ``presented``, ``answered``: text as it was exported; of two values, each as numbers are written
  here, so that equal values are equal texts;
- ``number``: float64, the answer as a number; NaN for questions that have none;
- ``outcome``: one of those of the question, or empty; where a table has none, it is made of
  what was presented and answered, or of ``correct``;
- ``confidence``: float64, NaN where it was not asked;
- ``parameter``: text, what two values were of; empty if it is not known;
- each of `LEVELS`: float64, NaN where it is not known or two values were compared.

Strings that were identified, and choices of one of two, are among them if they have a confidence,
or if one of two was right; they are trials and comparisons as well.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vbraille.analysis.input.sheets import is_pair, parse_pair
from vbraille.analysis.statistics.intervals import LARGEST
from vbraille.errors import InputError
from vbraille.sessions.planning.questions import KINDS, OneOfTwo

if TYPE_CHECKING:
    from vbraille.analysis.input.sheets import Sheet

USUAL = ("identify", "which")  # questions whose answers are trials or comparisons
_NUMBERS = [name for name, kind in KINDS.items() if kind.numeric]
LEVELS = (
    "contrast", "texture", "dot_width_mm", "dot_spacing_mm", "cell_gap_mm", "row_spacing_mm",
)  # fmt: skip


def judged(sheet: Sheet, rows: pd.DataFrame) -> pd.Series:
    """True if each row is a judgement alone, and neither a string that was read nor a choice.

    Raises
    ------
    InputError
        If a question is of no known kind.
    """
    if "question" not in rows:
        return pd.Series(False, rows.index)
    kinds = rows["question"].str.strip()
    for row, kind in kinds.items():
        if kind not in (*KINDS, ""):
            raise InputError(
                f"{sheet.place(row)}: question is {kind!r}; it must be one of "
                f"{', '.join(KINDS)}, or empty"
            )
    return ~kinds.isin((*USUAL, ""))


def read_judgements(sheet: Sheet, rows: pd.DataFrame, who: pd.DataFrame) -> pd.DataFrame | None:
    """Judgements of a sheet; None if there are none.

    Parameters
    ----------
    rows
        Answered rows of the sheet.
    who
        Participant, session, protocol, condition, block and trial of each of these rows.

    Raises
    ------
    InputError
        If an outcome or a number cannot be used.
    """
    if "question" not in rows:
        return None
    empty = pd.Series("", rows.index)
    kinds = rows["question"].str.strip()
    outcome = _outcomes(sheet, rows, kinds)
    confidence = _numbers(sheet, rows.get("confidence", empty), "confidence")
    kept = judged(sheet, rows) | (kinds.isin(USUAL) & confidence.notna())
    kept |= (kinds == "which") & (outcome != "")
    if not kept.any():
        return None
    for row in rows.index[kept]:
        if outcome[row] and outcome[row] not in KINDS[kinds[row]].outcomes:
            known = ", ".join(sorted(KINDS[kinds[row]].outcomes)) or "none"
            raise InputError(
                f"{sheet.place(row)}: outcome is {outcome[row]!r}; of the question "
                f"{kinds[row]!r} it must be one of: {known}"
            )
    presented, answered = _texts(sheet, rows, kinds)
    number = _numbers(sheet, answered.where(kinds.isin(_NUMBERS), ""), "answered")
    for row in rows.index[kinds.isin(_NUMBERS) & number.isna()][:1]:
        raise _no_number(sheet, row, "answered", answered[row])
    found = who.assign(
        question=kinds,
        presented=presented,
        answered=answered,
        number=number,
        outcome=outcome,
        confidence=confidence,
        parameter=rows.get("parameter", empty).fillna("").astype(str).str.strip(),
        **{name: _levels(sheet, rows.get(name, empty)) for name in LEVELS},
    )
    bad = kept & (kinds == "magnitude") & (number <= 0)
    if bad.any():
        row = rows.index[bad][0]
        raise InputError(
            f"{sheet.place(row)}: answered is {answered[row]!r}; a magnitude must be above 0"
        )
    return found[kept]


def _texts(sheet: Sheet, rows: pd.DataFrame, kinds: pd.Series) -> tuple[pd.Series, pd.Series]:
    """Texts presented and answered; two values are written alike wherever they are equal.

    Raises
    ------
    InputError
        If two values cannot be read, or the answer is none of them.
    """
    presented, answered = rows["presented"].astype(str), rows["answered"].astype(str).str.strip()
    pairs = presented.index[(kinds == "which") & presented.map(is_pair).astype(bool)]
    for row in pairs:
        try:
            first, second, chosen = parse_pair(presented[row], answered[row], number=sheet.number)
        except ValueError as error:
            raise InputError(f"{sheet.place(row)}: {error}") from None
        presented[row] = f"{first:.15g} {second:.15g}"
        answered[row] = f"{(first, second)[chosen]:.15g}"
    return presented, answered


def _outcomes(sheet: Sheet, rows: pd.DataFrame, kinds: pd.Series) -> pd.Series:
    """Outcome of each row: as given, else as it follows from what was presented and answered.

    Raises
    ------
    InputError
        If it does not follow, and the question needs one; or a word is none of the question's.
    """
    empty = pd.Series("", rows.index)
    given = rows.get("outcome", empty).astype(str).str.strip()
    correct = rows.get("correct", empty).astype(str).str.strip()
    right = correct.map({"1": "right", "1.0": "right", "0": "wrong", "0.0": "wrong"}).fillna("")
    found = given.where(given != "", right.where(kinds.isin(USUAL), ""))
    presented, answered = (rows[name].astype(str).str.strip() for name in ("presented", "answered"))
    for kind, asked in KINDS.items():
        if not issubclass(asked, OneOfTwo):
            continue
        own, words = kinds == kind, asked.words
        either = f"{words[0]} or {words[1]}"
        for row in rows.index[own & ~answered.isin(words)][:1]:
            raise InputError(
                f"{sheet.place(row)}: answered is {answered[row]!r}; to the question {kind!r} it "
                f"must be {either}"
            )
        untold = own & (found == "")
        for row in rows.index[untold & ~presented.isin(words)][:1]:
            raise InputError(
                f"{sheet.place(row)}: outcome is missing, and presented is {presented[row]!r}, "
                f"which does not tell it; give outcome, or presented as {either}"
            )
        told = (presented + " " + answered).map(
            {f"{there} {said}": asked.score(there == words[0], said)
             for there in words for said in words}
        )  # fmt: skip
        found = found.mask(untold, told)
    return found


def _numbers(sheet: Sheet, given: pd.Series, column: str) -> pd.Series:
    """Numbers of a column, NaN where there is nothing."""
    values = []
    for row, value in given.items():
        text = str(value).strip()
        number = sheet.value(text)
        if abs(number) > LARGEST:
            raise _no_number(sheet, row, column, text)
        values.append(number)
    return pd.Series(values, given.index, np.float64)


def _no_number(sheet: Sheet, row: object, column: str, text: str) -> InputError:
    return InputError(f"{sheet.place(row)}: {column} is {text!r}; give a number")


def _levels(sheet: Sheet, given: pd.Series) -> pd.Series:
    """Numbers of a column, NaN where it has something else, such as two values."""
    known = {value: sheet.value(str(value)) for value in given.unique()}
    return given.map(known).astype(np.float64).replace([np.inf, -np.inf], np.nan)
