"""Sessions and tables of trials, or of scores, as one typed frame."""

from __future__ import annotations

from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from pandas import DataFrame, Series

from vbraille.braille.spelling import LETTERS
from vbraille.csvfiles import parse_csv
from vbraille.errors import InputError
from vbraille.names import check_alike, likeness, natural, visible

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from vbraille.sessions.record.record import Content

MISSING = frozenset({"", "NA", "N/A", "n/a", "NaN", "None", "NULL", "<NA>"})
NEEDED = ("participant", "presented", "answered")
TEXTS = frozenset({"session", "participant", "protocol", "condition", *NEEDED[1:], "string_set"})
LEVELS = (
    "contrast", "texture", "dot_width_mm", "dot_spacing_mm", "cell_gap_mm", "row_spacing_mm",
)  # fmt: skip
DURATIONS = ("duration_s", "response_s", "contact_s", "paused_s")
NUMBERS = (*DURATIONS, "trial", "block", "early", "confidence", "words_per_minute")
STRINGS = "identify"
QUESTIONS = (
    STRINGS, "which", "odd", "match", "same-different", "detect", "rating", "magnitude", "adjust",
    "name", "free", "read",
)  # fmt: skip
USUAL = {
    "condition": "all", "protocol": "", "block": np.nan, "trial": np.nan, "question": None,
    "string_set": None, "outcome": None, "correct": np.nan, "practice": 0, "catch": None,
}  # fmt: skip
KNOWN = {*NEEDED, *NUMBERS, *USUAL}  # columns, in capitals or not
NUMERIC = ("rating", "magnitude", "adjust")
SIGNALS = {"detect": ("yes", "no"), "same-different": ("different", "same")}
GOOD = ("right", "hit", "correct rejection")
OUTCOMES = (*GOOD, "wrong", "miss", "false alarm")
_NUMBER = r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?"
_CELLS = str.maketrans({letter: chr(0x2800 + mask) for letter, mask in LETTERS.items()})
_BLANK = str.maketrans(" ", "⠀")
_SQLITE = b"SQLite format 3\0"


@dataclass
class Trials:
    """Trials that are analysed, and what was seen while they were read.

    Parameters
    ----------
    frame
        A row a trial: what was read, with ``right``, ``outcome``, and conditions and participants
        in their order.
    notes, warnings
        Sentences on what was left out or changed, and what a reader must know first.
    people
        Everyone of whom there is a row.
    left_out
        People who are left out, each with the reason.
    sources
        Sentences on each file.
    contents
        Sessions, for the methods.
    """

    frame: DataFrame
    notes: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    people: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    sources: list[str] = field(default_factory=list)
    contents: list[Content] = field(default_factory=list)


def read_trials(
    paths: Sequence[str | Path],
    *,
    protocol: str | None = None,
    exclude: Mapping[str, str] | None = None,
) -> Trials:
    """Read sessions and tables.

    Parameters
    ----------
    protocol
        Name of the protocol whose trials are taken; None for all.
    exclude
        People to leave out, each with the reason.

    Raises
    ------
    InputError
        If something cannot be read, is there twice, or nothing is left.
    """
    files = [Path(path) for path in paths]
    trials = Trials(DataFrame())
    tables = {name: _load(path, name, trials) for name, path in _named(files).items()}
    trials.frame = _typed(pd.concat(tables))
    _check_copies(trials.frame)
    trials.frame = trials.frame.reset_index(drop=True)
    _fill(trials)
    _join_names(trials, ["participant", "condition"])
    trials.people = sorted(trials.frame["participant"].unique(), key=natural)
    _drop_unanswered(trials)
    _read_answers(trials)
    if protocol is not None:
        _keep(trials, "protocol", protocol, kept=True)
    for person, reason in (exclude or {}).items():
        _keep(trials, "participant", person, kept=False)
        trials.left_out.append(f"{person}: {reason}")
    if trials.frame.empty:
        raise InputError("no trial is left; see what was excluded")
    order = ["participant", "session", "block", "trial"]
    _warn_of_sources(trials)
    for name in ("participant", "condition"):
        trials.frame[name] = in_order(trials.frame[name])
    trials.frame = trials.frame.sort_values(order, kind="stable", ignore_index=True)
    return trials


def in_order(values: Series) -> Series:
    """Return names as categories in natural order: T0, T25, T100."""
    names = values.astype("category").cat.remove_unused_categories().cat.rename_categories(str)
    return names.cat.reorder_categories(sorted(names.cat.categories, key=natural), ordered=True)


def _load(path: Path, name: str, trials: Trials) -> DataFrame:
    """Read a session or a table as text, a row for each line."""
    data = _content(path)
    trials.sources.append(f"{name}: SHA-256 {sha256(data).hexdigest()[:16]}…")
    if data.startswith(_SQLITE):
        from vbraille.sessions.record import record
        from vbraille.sessions.record.trials import rows

        trials.contents.append(record.read(path))
        cells = [{key: str(cell) for key, cell in row.items()} for row in rows(path)]
        return DataFrame(cells, dtype=object).assign(session=name)
    sheet = parse_csv(data, name)
    columns = [each.lower() if each.lower() in KNOWN else each for each in sheet.columns]
    table = DataFrame(sheet.rows, sheet.lines, columns, dtype=object)
    for column in NEEDED:
        if column not in table:
            raise InputError(f"{name} has no column {column}; it has {', '.join(columns)}")
    again = table.index[table.duplicated()] if "trial" in table else []
    if len(again):
        raise InputError(
            f"{name}: line {again[0]} is the same as a line above it; give each trial once, and "
            f"tell sessions apart in a column session"
        )
    return table if "session" in table else table.assign(session=name)


def _content(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except IsADirectoryError:
        raise InputError(f"{path} is a directory; give files of sessions, or tables") from None
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None


def _named(paths: list[Path]) -> dict[str, Path]:
    """Return files by their names, with the folder where two have the same name."""
    names = [path.name for path in paths]
    named = {path.name if names.count(path.name) == 1 else str(path): path for path in paths}
    if len({path.resolve() for path in paths}) < len(paths):
        again = next(name for name in names if names.count(name) > 1)
        raise InputError(f"{again} is given twice; give it once")
    return named


def _typed(table: DataFrame) -> DataFrame:
    """Return a table with missing cells, and with numbers in columns that have nothing else."""
    made = {}
    for column in table:
        cells = table[column].mask(table[column].isin(MISSING))
        made[column] = cells if column in TEXTS else _numbers(cells, str(column))
    return DataFrame(made, table.index)


def _numbers(cells: Series, column: str) -> Series:
    """Return a column as numbers, if all that is there is one; its index names file and line."""
    known = cells.dropna()
    good = known.drop_duplicates().astype(str).str.fullmatch(_NUMBER).astype(bool)
    if good.all():
        cells = to_number(cells)
        wrong = cells.index[np.isinf(cells) | ((cells < 0) & (column in DURATIONS))]
    elif column in (*NUMBERS, "score"):
        wrong = good.index[~good]
    else:
        return cells
    if len(wrong):
        (name, line), value = wrong[0], known[wrong[0]]
        raise InputError(f"{name}: line {line} has {column} {value!r}; give a number, or nothing")
    return cells


def to_number(values: Series) -> Series:
    """Return numbers, with decimal points or commas; what is none is missing."""
    texts = values.astype(object).map(lambda value: str(value).replace(",", "."), "ignore")
    return pd.to_numeric(texts, errors="coerce").astype(float)


def _check_copies(frame: DataFrame) -> None:
    """Refuse a session, or the trials of a person, that two files hold."""
    sessions = {}
    people = {}
    for name, table in frame.groupby(level=0, sort=False):
        for session in table["session"].dropna().unique():
            other = sessions.setdefault(session, name)
            if other != name:
                raise InputError(
                    f"{other} and {name} both hold the session {session}; give one, or give "
                    f"sessions other names in the column session"
                )
        for person, part in table.dropna(subset=["answered"]).groupby("participant"):
            for other, earlier in people.setdefault(person, {}).items():
                if _same_trials(part, earlier):
                    raise InputError(
                        f"{other} and {name} hold the same trials of {person}; give one of them"
                    )
            people[person][name] = part


def _same_trials(*parts: DataFrame) -> bool:
    """Tell whether two tables have the same answers of a person, by their times or by all cells."""
    one, other = (part.dropna(axis=1, how="all").drop(columns="session") for part in parts)
    shared = one.columns.intersection(other.columns)
    if "answer_time" in shared:
        return bool(one["answer_time"].dropna().isin(other["answer_time"]).any())
    rows = [sorted(part[shared].astype(str).to_numpy().tolist()) for part in (one, other)]
    return rows[0] == rows[1]


def _fill(trials: Trials) -> None:
    """Add the columns that a table may leave out, and refuse names that are missing."""
    frame = trials.frame
    for name, usual in USUAL.items():
        if name not in frame:
            frame[name] = usual
    numbers = frame.groupby("session").cumcount() + 1.0
    pairs = frame["presented"].astype(str).str.fullmatch(rf"{_NUMBER}\s+{_NUMBER}")
    kinds = Series(np.where(pairs, "which", STRINGS), frame.index)
    known = {"protocol": "", "block": 0.0, "trial": numbers, "question": kinds}
    known["string_set"] = frame["presented"]
    for name, values in known.items():
        frame[name] = frame[name].fillna(values)
    unknown = sorted(set(frame["question"]) - set(QUESTIONS))
    if unknown:
        raise InputError(f"unknown question {unknown[0]!r}; known: {', '.join(QUESTIONS)}")
    for name in ("participant", "condition", "session", "presented"):
        missing = frame[name].isna()
        if name in ("participant", "condition"):  # letters that are presented may spell nan
            missing |= frame[name].str.casefold().isin(map(str.casefold, MISSING))
        if missing.any():
            raise InputError(
                f"{name} is missing in {missing.sum()} rows; an empty cell and "
                f"{', '.join(sorted(MISSING)[1:])} name nothing"
            )


def _join_names(trials: Trials, columns: Iterable[str]) -> None:
    """Join names that differ by what cannot be seen, and refuse those that look like one."""
    for column in columns:
        names = {name: visible(name) for name in trials.frame[column].unique()}
        check_alike(names.values(), column)
        joined = sorted({shown for name, shown in names.items() if shown != name})
        if joined:
            trials.frame[column] = trials.frame[column].map(names)
            trials.notes.append(
                f"{column}: spellings that look the same were joined: {', '.join(joined)}"
            )


def _drop_unanswered(trials: Trials) -> None:
    frame = trials.frame
    practice = frame["practice"].eq(1)
    if practice.any():
        trials.notes.append(f"{practice.sum()} trials of practice are left out")
    frame = frame[~practice]
    unanswered = frame["answered"].isna()
    for person, count in frame.loc[unanswered, "participant"].value_counts(sort=False).items():
        trials.notes.append(f"{person}: {count} trials without an answer are left out")
    if unanswered.all():
        raise InputError("no trial has an answer; nothing can be analysed")
    trials.frame = frame[~unanswered].reset_index(drop=True)


def _read_answers(trials: Trials) -> None:
    """Bring presented and answered into one spelling, and tell which answers are right."""
    frame = trials.frame
    strings = frame["question"] == STRINGS
    for column in ("presented", "answered", "string_set"):
        known = frame.loc[strings, column].unique()
        cells = {text: visible(text.translate(_BLANK)).lower() for text in known}
        cells = {text: plain.translate(_CELLS) for text, plain in cells.items()}
        frame.loc[strings, column] = frame.loc[strings, column].map(cells)
    _name_answers(frame, frame["question"] == "name")
    frame["right"] = frame["presented"] == frame["answered"]
    said = frame["correct"]
    # A blank string is read rightly if no dot is felt.
    frame["right"] = frame["right"].where(frame["catch"].isna() | said.isna(), said == 1)
    odds = int((strings & said.notna() & (said != frame["right"])).sum())
    if odds:
        trials.notes.append(f"correct disagrees with the answer in {odds} rows: answers count")
    for question, rows in frame[~strings].groupby("question"):
        if question in NUMERIC:
            numbers = to_number(rows["answered"])
            wrong = rows["answered"][numbers.isna() | ((numbers <= 0) & (question == "magnitude"))]
            if len(wrong):
                above = " above 0" if question == "magnitude" else ""
                raise InputError(f"answered is {wrong.iloc[0]!r}; a {question} is a number{above}")
        elif question in SIGNALS:
            frame.loc[rows.index, "outcome"] = _detected(rows, *SIGNALS[str(question)])
        else:
            scored = rows["correct"].map({1: "right", 0: "wrong"})
            frame.loc[rows.index, "outcome"] = rows["outcome"].fillna(scored)
    outcome = frame["outcome"]
    unknown = sorted(set(outcome.dropna()) - set(OUTCOMES))
    if unknown:
        raise InputError(f"unknown outcome {unknown[0]!r}; known: {', '.join(OUTCOMES)}")
    told = ~strings & (outcome.notna() | (frame["question"] != "name"))
    frame["right"] = frame["right"].where(~told, outcome.isin(GOOD))


def _name_answers(frame: DataFrame, named: Series) -> None:
    """Spell names that were answered as they were presented, whatever their case."""
    rows = frame[named]
    check_alike(map(visible, rows["presented"].unique()), "presented")
    known = {likeness(name): visible(name) for name in rows["presented"].unique()}
    for column in ("presented", "answered"):
        spelled = {each: known.get(likeness(each), visible(each)) for each in rows[column].unique()}
        frame.loc[named, column] = rows[column].map(spelled)


def _detected(rows: DataFrame, signal: str, noise: str) -> Series:
    """Return the outcome of each answer, as given, or by what was presented."""
    answered = rows["answered"].str.lower()
    wrong = answered[~answered.isin([signal, noise])]
    if len(wrong):
        raise InputError(f"answered is {wrong.iloc[0]!r}; it must be {signal} or {noise}")
    presented = rows["presented"].str.lower()
    told = {
        f"{signal} {signal}": "hit",
        f"{signal} {noise}": "miss",
        f"{noise} {signal}": "false alarm",
        f"{noise} {noise}": "correct rejection",
    }
    outcome = rows["outcome"].fillna((presented + " " + answered).map(told))
    untold = rows["presented"][outcome.isna()]
    if len(untold):
        raise InputError(
            f"presented is {untold.iloc[0]!r}, and there is no outcome; give {signal} or {noise}, "
            f"or a column outcome"
        )
    return outcome


def _keep(trials: Trials, column: str, name: str, *, kept: bool) -> None:
    """Keep the trials that have a name, or those that have not."""
    known = sorted(trials.frame[column].unique(), key=natural)
    if name not in known:
        raise InputError(f"no {column} {name!r} has answered; known: {', '.join(known)}")
    rows = (trials.frame[column] == name) == kept
    trials.frame = trials.frame[rows].copy()
    trials.contents = [
        each
        for each in trials.contents
        if (name in (each.head["protocol"], each.plan.participant)) == kept
    ]
    if kept and not rows.all():
        trials.notes.append(f"{(~rows).sum()} trials of another {column} are left out")


def caught(frame: DataFrame) -> Series:
    """Tell which trials only keep watch over the participant."""
    return frame["catch"].notna() & ~frame["question"].eq("detect")


def _warn_of_sources(trials: Trials) -> None:
    """Say how many answers no person gave, and how many trials no finger read."""
    for column, source, words in (
        ("answers_from", "simulated", "answers are of a simulated reader"),
        ("moved_by", "simulated:pointer", "trials were moved by the pointer of a live view"),
    ):
        if column in trials.frame:
            count = int(trials.frame[column].astype(str).str.startswith(source).sum())
            if count:
                trials.warnings.append(f"{count} {words}: no data about people.")


def read_scores(path: str | Path) -> DataFrame:
    """Read a table of scores: columns participant, one to four factors, and score.

    The last column holds the scores if none is called score.

    Returns
    -------
    DataFrame
        A row for each person and cell, with ``value``, and ``why`` it is missing if it is.

    Raises
    ------
    InputError
        If it is no such table.
    """
    sheet = parse_csv(_content(Path(path)), Path(path).name)
    table = DataFrame(sheet.rows, sheet.lines, list(sheet.columns), dtype=object)
    table = pd.concat({sheet.name: table})
    if "participant" not in table or table.shape[1] < 3 or table.empty:
        raise InputError(f"{sheet.name} needs columns participant, what was varied, and score")
    score = "score" if "score" in table else str(table.columns[-1])
    table = table.mask(table.isin(MISSING))
    table[score] = _numbers(table[score], "score")
    factors = [str(name) for name in table if name not in ("participant", score)]
    for name in ("participant", *factors):
        if table[name].isna().any():
            _, line = table.index[table[name].isna()][0]
            raise InputError(f"{sheet.name}: line {line} has no {name}")
        table[name] = table[name].map(visible)
        check_alike(table[name], name)
        table[name] = in_order(table[name])
    again = table.index[table.duplicated(["participant", *factors])]
    if len(again):
        raise InputError(
            f"{sheet.name}: line {again[0][1]} has a second score of a person in a cell"
        )
    factors = [name for name in factors if table[name].nunique() > 1]
    values = table.set_index(["participant", *factors])[[score]].set_axis(["value"], axis=1)
    return values.assign(why="no score")
