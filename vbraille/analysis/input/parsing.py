"""Sheets to trials, comparisons and judgements: what each value means, and which rows count.

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

from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd

from vbraille.analysis.input.sheets import (
    is_pair,
    parse_cells,
    parse_name,
    parse_pair,
    parse_presented,
    parse_seconds,
    parse_whole,
)
from vbraille.analysis.input.trials import ALL, TRIAL_COLUMNS, LeftOut, factor, name_string
from vbraille.analysis.statistics.intervals import LARGEST
from vbraille.errors import InputError
from vbraille.sessions.planning.questions import KINDS, RIGHT, WRONG, OneOfTwo
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from vbraille.analysis.input.sheets import Sheet

NEEDED = ("participant", "condition", "presented", "answered")
# Further columns that are understood; all are optional.
_KNOWN = [
    *NEEDED, "session", "protocol", "block", "trial", "duration_s", "parameter", "correct",
    "string_set", "question", "outcome",
]  # fmt: skip
_OPEN = ("", "n/a")  # the answer to a trial that was not answered
# Columns that, where they are above 0, say why a duration does not count.
_UNTIMED = {
    "paused_s": "the trial was paused meanwhile",
    "early": "it was answered before it was read to its end",
}
CATCH, _CATCHES = "catch", ("blank", "repeat")
# Columns of typed values, in which nothing is filled in.
_OWN = (
    *TRIAL_COLUMNS, "first", "second", "chosen", "parameter", "question", "number", "outcome",
    "confidence",
)  # fmt: skip


class Parsed(NamedTuple):
    """Content of the sheets.

    Parameters
    ----------
    trials, comparisons
        Data frames as in `vbraille.analysis.input.trials`; None if there are none.
    left_out
        Rows that are in neither data frame.
    warnings
        Sentences about what does not agree.
    judgements
        Data frame as in `vbraille.analysis.input.parsing`; None if there are none.
    """

    trials: pd.DataFrame | None
    comparisons: pd.DataFrame | None
    left_out: tuple[LeftOut, ...]
    warnings: tuple[str, ...]
    judgements: pd.DataFrame | None = None


def parse(sheets: Sequence[Sheet]) -> Parsed:
    """Trials of some sheets together; a row that presents two values is a comparison.

    Raises
    ------
    InputError
        If columns are missing, something cannot be read, or a trial is there twice.
    """
    strings: dict[int, pd.DataFrame] = {}
    pairs: dict[int, pd.DataFrame] = {}
    judgements: dict[int, pd.DataFrame] = {}
    left_out: list[LeftOut] = []
    warnings: list[str] = []
    for number, sheet in enumerate(sheets):
        sheet.need(NEEDED)
        answered = sheet.frame[~sheet.frame["answered"].str.strip().str.lower().isin(_OPEN)]
        unanswered = len(sheet) - len(answered)
        if unanswered:
            left_out.append(LeftOut(f"{count(unanswered, 'trial')} of {sheet.name}", "no answer"))
        detected = answered.get("question", pd.Series("", answered.index)).eq("detect")
        caught = _caught(answered) & ~detected  # blank ones are what detection needs
        if caught.any():
            left_out.append(_told_catch(sheet, answered[caught]))
            answered = answered[~caught]
        told = read_judgements(sheet, answered, _who(sheet, answered))
        if told is not None:
            judgements[number] = _with_others(told, answered)
        answered = answered[~judged(sheet, answered)]
        if answered.empty:
            continue
        paired = answered["presented"].map(is_pair).astype(bool)
        if "parameter" in answered:
            paired |= answered["parameter"].str.strip() != ""
        if not paired.all():
            rows = answered[~paired]
            read = _strings(sheet, rows)
            warnings += _scored_otherwise(sheet, rows, read)
            left_out += _forget_durations(sheet, rows, read)
            strings[number] = _with_others(read, rows)
        if paired.any():
            pairs[number] = _with_others(_pairs(sheet, answered[paired]), answered)
    return Parsed(
        _joined(strings, sheets, _trials),
        _joined(pairs, sheets, lambda whole: whole.assign(parameter=factor(whole["parameter"]))),
        tuple(left_out),
        tuple(warnings),
        _joined(judgements, sheets, lambda whole: whole.assign(condition=_conditions(whole))),
    )


def _with_others(read: pd.DataFrame, rows: pd.DataFrame) -> pd.DataFrame:
    """Typed columns of some rows, with those that were given beside them."""
    others = [name for name in rows if name == "duration_s" or name not in _KNOWN]
    return read.join(rows[[name for name in others if name not in read]])


def _joined(
    parts: Mapping[int, pd.DataFrame],
    sheets: Sequence[Sheet],
    typed: Callable[[pd.DataFrame], pd.DataFrame],
) -> pd.DataFrame | None:
    """Rows of all sheets by participant, session, block and trial, with levels in natural order."""
    if not parts:
        return None
    whole = pd.concat(parts)
    others = whole.columns.difference([*_OWN]).difference(whole.select_dtypes("float64").columns)
    whole[others] = whole[others].fillna("")  # empty where a sheet has no such column
    _check_once(whole, sheets)
    names = ("participant", "session", "protocol", "condition")
    whole = typed(whole)
    whole = whole.assign(**{name: factor(whole[name]) for name in names})
    order = ["participant", "session", "block", "trial"]
    return whole.sort_values(order, kind="stable", ignore_index=True)


def _caught(rows: pd.DataFrame) -> pd.Series:
    """True if each row is a catch trial, which belongs to no item."""
    if CATCH not in rows:
        return pd.Series(data=False, index=rows.index)
    return rows[CATCH].astype(str).str.strip().isin(_CATCHES)


def _told_catch(sheet: Sheet, rows: pd.DataFrame) -> LeftOut:
    right = sum(rows["correct"].astype(str).str.strip() == "1") if "correct" in rows else 0
    what = f"{count(len(rows), 'catch trial')} of {sheet.name}"
    return LeftOut(what, f"they keep watch over the participant; {right} answered right")


def _strings(sheet: Sheet, rows: pd.DataFrame) -> pd.DataFrame:
    """Rows of strings with values of the right types."""
    read = _who(sheet, rows).assign(
        presented=_each(sheet, rows, "presented", parse_presented),
        string_set=_each(sheet, rows, "string_set", parse_cells, ""),
        answered=_each(sheet, rows, "answered", parse_cells),
    )
    read["correct"] = read["presented"] == read["answered"]
    read["duration_s"] = _seconds(sheet, rows, "duration_s", np.nan)
    listed = read[read["string_set"] != ""]
    for row, cells, given in listed[["string_set", "presented"]].itertuples(name=None):
        if sorted(cells) != sorted(given):
            raise InputError(
                f"{sheet.place(row)}: string_set is {name_string(cells)!r}, and presented, "
                f"{name_string(given)!r}, is no order of its cells; leave string_set empty where "
                f"strings keep their order"
            )
    return read


def _pairs(sheet: Sheet, rows: pd.DataFrame) -> pd.DataFrame:
    """Rows of comparisons with values of the right types."""
    told = []
    for row, presented, answered in rows[["presented", "answered"]].itertuples(name=None):
        try:
            told.append(parse_pair(presented, answered, number=sheet.number))
        except ValueError as error:
            raise InputError(f"{sheet.place(row)}: {error}") from None
    pairs = pd.DataFrame(told, rows.index, ["first", "second", "chosen"])
    named = _each(sheet, rows, "parameter", lambda text: text.strip() or "value", "value")
    return _who(sheet, rows).join(pairs).assign(parameter=named)


def _who(sheet: Sheet, rows: pd.DataFrame) -> pd.DataFrame:
    """Columns that say whose trial each row is, and which one."""
    numbers = pd.Series(range(1, len(sheet) + 1), sheet.frame.index)
    return pd.DataFrame(
        {
            "participant": _each(sheet, rows, "participant", parse_name),
            "session": _each(sheet, rows, "session", parse_name, sheet.name),
            "protocol": _each(sheet, rows, "protocol", str.strip, ""),
            "condition": _each(sheet, rows, "condition", parse_name),
            "block": _each(sheet, rows, "block", parse_whole, 0),
            "trial": _each(sheet, rows, "trial", parse_whole, numbers[rows.index]),
        }
    )


def _each(
    sheet: Sheet,
    rows: pd.DataFrame,
    column: str,
    parse: Callable[[str], Any],
    absent: Any = None,
) -> pd.Series:
    """Parsed values of a column; an InputError names the first row that cannot be parsed.

    Parameters
    ----------
    absent
        One value for all rows, or a value for each, where there is no such column.
    """
    if column not in rows:
        return pd.Series(absent, rows.index)
    given = rows[column]
    if sheet.typed:
        return given
    known = {}
    for value in given.unique():
        try:
            known[value] = parse(value)
        except ValueError as error:
            row = given.index[given == value][0]
            raise InputError(f"{sheet.place(row)}: {column} {error}") from None
    return given.map(known)


def _seconds(sheet: Sheet, rows: pd.DataFrame, column: str, absent: float) -> pd.Series:
    parsed = _each(sheet, rows, column, partial(parse_seconds, value=sheet.value), absent)
    return pd.to_numeric(parsed).astype(np.float64)


def _scored_otherwise(sheet: Sheet, rows: pd.DataFrame, read: pd.DataFrame) -> Iterator[str]:
    """Sentences about a column ``correct`` that does not agree with the answers."""
    if "correct" not in rows:
        return
    told = rows["correct"].astype(str).str.strip().map({"0": False, "1": True})
    wrong = read.index[told.notna() & (told != read["correct"])]
    if wrong.size:
        yield (
            f"{sheet.name}: column correct says otherwise than the answers in "
            f"{count(wrong.size, 'trial')}, first in {sheet.place(wrong[0])}; the answers count."
        )


def _forget_durations(sheet: Sheet, rows: pd.DataFrame, read: pd.DataFrame) -> Iterator[LeftOut]:
    """Take durations away that do not count, as a column says; tell how many those are."""
    for column, why in _UNTIMED.items():
        if column == "early":
            told = _each(sheet, rows, column, parse_whole, 0)
        else:
            told = _seconds(sheet, rows, column, 0.0)
        untimed = (told > 0) & read["duration_s"].notna()
        if untimed.any():
            read.loc[untimed, "duration_s"] = np.nan
            yield LeftOut(f"{count(int(untimed.sum()), 'duration')} of {sheet.name}", why)


def _check_once(whole: pd.DataFrame, sheets: Sequence[Sheet]) -> None:
    """Raise InputError if a trial is there twice: it would count twice in every figure.

    Trials whose number or session is not given may be different ones, and are not checked.
    """
    names = ["participant", "session", "protocol", "condition", "block", "trial"]
    told = np.array([{"session", "trial"} <= set(sheet.frame) for sheet in sheets])
    numbered = told[whole.index.get_level_values(0)] & (whole["trial"] > 0)
    again = whole[whole.duplicated(names) & numbered]
    for (number, row), trial, session in again[["trial", "session"]].itertuples(name=None):
        raise InputError(
            f"{sheets[number].place(row)}: trial {trial} of session {session} is there a second "
            f"time; give every trial once, and each session a name of its own"
        )


def _conditions(whole: pd.DataFrame) -> pd.Series:
    """Condition of each trial; equal names in different protocols are told apart."""
    condition, protocol = whole["condition"], whole["protocol"]
    if protocol.nunique() < 2:
        return condition
    shared = protocol.groupby(condition).transform("nunique") > 1
    told = condition.mask(shared, (protocol + " " + condition).str.strip())
    return told.mask((condition == ALL) & (protocol != ""), protocol)


def _trials(whole: pd.DataFrame) -> pd.DataFrame:
    """Strings with columns of their types; one that names no set is its own."""
    listed, shown = whole["string_set"], whole["presented"]
    whole = whole.assign(string_set=listed.mask(listed == "", shown), condition=_conditions(whole))
    strings = {name: factor(whole[name], None) for name in ("presented", "string_set", "answered")}
    return whole.assign(**strings)


USUAL = ("identify", "which")  # questions whose answers are trials or comparisons
_NUMBERS = [name for name, kind in KINDS.items() if kind.numeric]
PASSAGE_COLUMNS = ("words_per_minute", "hand_pauses", "regressions")  # numbers of passages
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
    of_two = rows["presented"].astype(str).str.split().map(len) <= 2
    return ~kinds.isin((*USUAL, "")) | ((kinds == "which") & ~of_two)


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
        **{name: _levels(sheet, rows.get(name, empty)) for name in (*LEVELS, *PASSAGE_COLUMNS)},
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
    named = (kinds == "name") & (found == "") & (presented != "")
    found = found.mask(named, (presented == answered).map({True: RIGHT, False: WRONG}))
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
