"""Names that pictures were given: Lévesque 2009, 6.4, tables 6.2 to 6.4."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vbraille.analysis.input.trials import ALL, groups, natural
from vbraille.analysis.results import NOTE_COLUMN, PARTICIPANT, PROTOCOL, Column, Kind, Schema
from vbraille.sessions.planning.questions import RIGHT, NameQuestion

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from vbraille.analysis.results import ResultTable, Row
    from vbraille.sessions.planning.protocol import Protocol

NAME = "name"  # kind of the question, and what is named where it is one thing that has no word
_NUMBERS = (
    Column("trials", "trials", "how many", Kind.COUNT),
    Column("right", "right", "how many", Kind.COUNT),
    Column("share", "right (%)", "share of right names", Kind.PERCENT),
    Column("response_s", "time (s)", "mean time to the answer", Kind.NUMBER),
    Column("over", "over time (%)", "share in which the picture's time was over before the answer",
           Kind.PERCENT),
    NOTE_COLUMN,
)  # fmt: skip
CELLS = Schema(
    "names",
    "Right names by what was varied",
    "All trials of all participants are pooled. A cell has a level of each factor, in their order, "
    "or all for all of its levels together.",
    (PROTOCOL, Column("cell", "cell", "its levels"), *_NUMBERS),
    empty="no right name is known",
)
CONFUSIONS = Schema(
    "names_confusion",
    "Names presented and answered",
    "How often each was answered to each, with all trials pooled.",
    (
        PROTOCOL,
        Column("of", "of", "what was named"),
        Column("presented", "presented", "right name"),
        Column("answered", "answered", "name that was given"),
        Column("trials", "trials", "how many", Kind.COUNT),
        Column("share", "of presented (%)", "share of the trials of that right name", Kind.PERCENT),
    ),
    empty="no right name is known",
)
PEOPLE = Schema(
    "names_participants",
    "Right names of each participant",
    "Where several things are named, each by itself and all together; the last rows have all "
    "participants' trials.",
    (PROTOCOL, PARTICIPANT, Column("of", "of", "what was named"), *_NUMBERS),
    empty="no right name is known",
)


def named(judgements: pd.DataFrame) -> pd.DataFrame:
    """Judgements that name pictures, and of which the right names are known."""
    return judgements[(judgements["question"] == NAME) & (judgements["outcome"] != "")]


def cells(rows: pd.DataFrame, columns: Sequence[str]) -> ResultTable:
    """Right names in each cell of what was varied, and over all levels of each: table 6.2.

    Parameters
    ----------
    rows
        Those of `named`.
    columns
        Columns that have the levels.
    """
    found: list[Row] = []
    for whose, own in groups(rows, "protocol"):
        levels = [[*sorted(own[name].astype(str).unique(), key=natural), ALL] for name in columns]
        for cell in product(*levels):
            kept = np.ones(len(own), bool)
            for name, level in zip(columns, cell, strict=True):
                kept &= (level == ALL) | (own[name].astype(str) == level).to_numpy()
            if kept.any():
                told = {"protocol": whose[0], "cell": ", ".join(cell) or ALL}
                found.append(told | _numbers(own[kept], own["outcome"][kept] == RIGHT))
    return CELLS.fill(found)


def confusions(rows: pd.DataFrame, protocols: Mapping[str, Protocol]) -> ResultTable:
    """Names presented and answered, of each thing that was named: tables 6.3 and 6.4."""
    found: list[Row] = []
    for whose, own in groups(rows, "protocol"):
        for of, presented, answered in _things(own, protocols.get(whose[0])):
            counts = pd.crosstab(presented, answered)
            names = sorted({*counts.index, *counts.columns}, key=natural)
            for right in sorted(counts.index, key=natural):
                total = int(counts.loc[right].sum())
                for name in names:
                    times = int(counts.loc[right].get(name, 0))
                    row = {"protocol": whose[0], "of": of, "presented": right, "answered": name}
                    found.append(row | {"trials": times, "share": times / total})
    return CONFUSIONS.fill(found)


def participants(rows: pd.DataFrame, protocols: Mapping[str, Protocol]) -> ResultTable:
    """Right names, times, and trials over the time, of each participant and of all."""
    found: list[Row] = []
    for whose, of_all in groups(rows, "protocol"):
        people = [(who[0], own) for who, own in groups(of_all, "participant")]
        for who, own in (*people, (ALL, of_all)):
            things = [*_things(own, protocols.get(whose[0]))]
            if len(things) > 1:
                things.append((ALL, own["presented"], own["answered"]))
            for of, presented, answered in things:
                told = {"protocol": whose[0], "participant": who, "of": of}
                found.append(told | _numbers(own, presented == answered))
    return PEOPLE.fill(found)


def _things(
    rows: pd.DataFrame, protocol: Protocol | None
) -> Iterator[tuple[str, pd.Series, pd.Series]]:
    """Words for each thing that was named, and its names presented and answered."""
    question = None if protocol is None else protocol.asks
    parts = [rows[name].astype(str).str.split(expand=True) for name in ("presented", "answered")]
    for number in range(min(part.shape[1] for part in parts)):
        of = NAME if rows["presented"].str.contains(" ").sum() == 0 else f"{NAME} {number + 1}"
        if isinstance(question, NameQuestion):
            of = question.choices[number].of or of
        yield of, parts[0][number], parts[1][number]


def _numbers(rows: pd.DataFrame, right: Iterable[bool]) -> Row:
    """Numbers of some trials; see `_NUMBERS`."""
    good = int(np.sum([*right]))
    row: Row = {"trials": len(rows), "right": good, "share": good / len(rows)}
    times = pd.to_numeric(rows.get("response_s", pd.Series(dtype=float)), errors="coerce").dropna()
    ended = rows.get("ended_by", pd.Series("", rows.index)).astype(str)
    missing = []
    if times.size:
        row["response_s"] = float(times.mean())
    else:
        missing.append("no time is known")
    if (ended != "").any():
        row["over"] = float((ended == "exposure").mean())
    else:
        missing.append("the time of a picture had no limit")
    return row | {"note": "; ".join(missing)}
