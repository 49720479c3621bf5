"""Order of conditions: what the period and the condition before have to do with a measure.

In a crossover, in which each block has one condition, a participant's value in a block is

    y = participant + condition + period + carry-over of the condition before,        (1)

by least squares, with no carry-over into the first period (Jones and Kenward 2014, ch. 5). Each
effect is tested by the sum of squares that its columns add to all others. Orders that do not tell
carry-over from the others, as of two conditions, leave it out of equation 1.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vbraille.analysis.primary import cells_of
from vbraille.analysis.results import (
    NOTE_COLUMN,
    PARTICIPANTS,
    Chapter,
    Column,
    Kind,
    Schema,
)
from vbraille.analysis.statistics.anova import added_by
from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, Unanswerable
from vbraille.sessions.planning.sequencing import balanced_orders
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.analysis.input.study import Study
    from vbraille.analysis.input.trials import Places
    from vbraille.analysis.primary import MeasureCells
    from vbraille.analysis.results import Row
    from vbraille.sessions.planning.analysis import PlannedAnalysis
    from vbraille.sessions.planning.protocol import Protocol

_MEASURE = Column("measure", "measure", "what is compared")
PERIODS = Schema(
    "periods",
    "Means by period",
    "Mean of the participants' own values of the primary measure in their first block, their "
    "second, and so on, whatever the condition; of logarithms the geometric mean.",
    (
        _MEASURE,
        Column("period", "period", "place of the block in the participant's order", Kind.COUNT),
        PARTICIPANTS,
        Column("value", "mean", "in the measure's unit, shares from 0 to 1", Kind.NUMBER),
    ),
)
ORDER = Schema(
    "order",
    "Period and carry-over",
    "Effects of the period, of the condition before (carry-over), and of the condition itself, "
    "each adjusted for the two others and for participants, by least squares of participants' own "
    "values; shares as 2 asin √share.",
    (
        _MEASURE,
        Column("effect", "effect", "period, carry-over, or condition"),
        PARTICIPANTS,
        Column("f", "F", "of the effect", Kind.NUMBER),
        Column("df1", "df1", "its degrees of freedom", Kind.COUNT),
        Column("df2", "df2", "those of the error", Kind.COUNT),
        Column("p", "p", "by F", Kind.P),
        NOTE_COLUMN,
    ),
)


def order_of(study: Study, places: Places | None, analysis: PlannedAnalysis) -> Chapter | None:
    """Tables of period and carry-over; None where no blocks of one condition each were planned.

    They need one protocol, whose participants sat for one session each.
    """
    protocols = {session.protocol.name: session.protocol for session in study.sessions}
    if len(protocols) != 1 or analysis.measure is None:
        return None
    (protocol,) = protocols.values()
    if protocol.design.blocks != "conditions" or len(protocol.conditions) < 2:
        return None
    shown = _conditions(study)
    sittings = shown.index.to_frame()[["participant", "session"]].drop_duplicates()
    if shown.empty or sittings["participant"].duplicated().any():
        return None
    cells = cells_of(study, places, analysis.measure, ["block"], "means")
    if cells is None or len(cells.places) < 2:
        return None
    return Chapter("Order of conditions", tuple(_tables(cells, shown, _planned(protocol, shown))))


def _conditions(study: Study) -> pd.Series:
    """Condition of each participant's blocks; empty where a block has several."""
    rows = [
        part[["participant", "session", "block", "condition"]].astype(
            {"participant": str, "session": str, "condition": str}
        )
        for part in (study.trials, study.comparisons, study.judgements)
        if part is not None
    ]
    whole = pd.concat(rows).drop_duplicates()
    by = whole.set_index(["participant", "session", "block"])["condition"].sort_index()
    return by[:0] if by.index.has_duplicates else by


def _planned(protocol: Protocol, shown: pd.Series) -> str:
    """Sentence on how orders were planned, and on the orders that participants had."""
    sequences = shown.groupby(level="participant").agg(tuple)
    had = f"{count(sequences.nunique(), 'order')} of {count(len(sequences), 'participant')}"
    match protocol.block_order:
        case "balanced" | None:
            many = len(balanced_orders(len(protocol.conditions)))
            how = (
                f"{count(many, 'order')}, in which together each condition is equally often in "
                f"each period, and follows each other one equally often"
            )
        case "table":
            how = "orders of a table of the protocol's own"
        case "shuffled":
            how = "orders drawn by chance"
        case _:
            how = "one order, in which condition and period cannot be told apart"
    return f"Planned: {how}. Here are {had}."


def _tables(cells: MeasureCells, shown: pd.Series, planned: str) -> Iterator:
    person, condition, period, before, value = _values(cells, shown)
    rows: list[Row] = []
    for at in np.unique(period):
        own = value[period == at]
        mean = float(own.mean())
        mean = float(np.exp(mean)) if cells.scale == "log" else mean
        rows.append(
            {
                "measure": cells.words,
                "period": int(at) + 1,
                "participants": own.size,
                "value": mean,
            }
        )
    yield PERIODS.fill(rows, [planned])
    y = 2 * np.arcsin(np.sqrt(value)) if cells.scale == "share" else value
    who, carried = _codes(person), _codes(before, without=-1)
    parts = {"period": _codes(period), "condition": _codes(condition)}
    tested = {"carry-over": _tested(y, carried, [who, *parts.values()])}
    if "f" not in tested["carry-over"]:
        carried = carried[:, :0]
    for name, own in parts.items():
        rest = [each for other, each in parts.items() if other != name]
        tested[name] = _tested(y, own, [who, carried, *rest])
    told = {"measure": cells.words, "participants": who.shape[1]}
    yield ORDER.fill([told | {"effect": name} | row for name, row in tested.items()], [planned])


def _values(cells: MeasureCells, shown: pd.Series) -> tuple[NDArray, ...]:
    """Participant, condition, period, condition before (-1 for none) and value of each block."""
    levels = {name: at for at, name in enumerate(sorted(set(shown)))}
    blocks = {cells.levels[0][place]: cell for cell, (place,) in enumerate(cells.places.tolist())}
    found = []
    for at, who in enumerate(cells.people):
        own = shown.xs(who, level="participant").droplevel("session")
        before = -1
        for period, (block, name) in enumerate(own.items()):
            value = cells.own[at, blocks[str(block)]] if str(block) in blocks else np.nan
            if not np.isnan(value):
                found.append((at, levels[name], period, before, value))
            before = levels[name]
    columns = np.array(found).reshape(-1, 5).T
    return *columns[:4].astype(np.int64), columns[4]


def _codes(levels: NDArray[np.int64], without: int | None = None) -> NDArray[np.float64]:
    """A column for each level, 1 in its rows."""
    return (levels[:, None] == [at for at in np.unique(levels) if at != without]).astype(np.float64)


def _tested(y: NDArray, own: NDArray, others: list[NDArray]) -> Row:
    """Test of an effect in a row of `ORDER`, or the reason why there is none."""
    if others[0].shape[1] < FEWEST_PARTICIPANTS:
        return {"note": "how orders matter is seen of three participants or more"}
    try:
        f, df1, df2, p = added_by(own, np.hstack(others), y)
    except Unanswerable as reason:
        return {"note": str(reason)}
    return {"f": f, "df1": df1, "df2": df2, "p": p}
