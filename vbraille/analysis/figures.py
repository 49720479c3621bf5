"""Figures of results, each with what it shows in words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.analysis.input.trials import UNREAD, cell_keys, name_string, times
from vbraille.analysis.measures.discrimination import SHAPE_OF
from vbraille.analysis.results import (
    OTHER,
    PARTICIPANT,
    SESSION,
    TRIAL,
    Column,
    Kind,
    ReportFigure,
    Schema,
    parameter_words,
    to_print,
)
from vbraille.analysis.statistics.psychometric import SHAPES
from vbraille.pictures.charts import Bars, Curve, Matrix, Path, Paths, Rise, Rises, Runs, Series
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from vbraille.analysis.input.sessions import Example, SessionTrials
    from vbraille.analysis.results import ResultTable, Row
    from vbraille.pictures.charts import Chart, Numbers


def interval_words(row: Row, kind: Kind, unit: str = "") -> str:
    """Words for a row's 95 % interval."""
    low, high = row.get("low"), row.get("high")
    if low is None or high is None:
        return "without an interval"
    return f"95 % interval {to_print(low, kind)} to {to_print(high, kind)}{unit}"


_SHARE = ("legibility", "low", "high")  # columns of a share with its interval
MOST_ERRORS = 12  # kinds of errors that are drawn


def legibility(table: ResultTable, averages: ResultTable) -> ReportFigure:
    """Bars of legibility by participant and condition: Lévesque 2009, figs. 4.7 and 4.9."""
    people, conditions = _distinct(table, "participant"), _distinct(table, "condition")
    at = {(row["participant"], row["condition"]): row for row in table.records()}
    strings = ("strings read right (%)", _SHARE, 100.0)
    panels: list[tuple[str, tuple[str, ...], float]] = [strings]
    if any(row["characters"] >= 2 * row["trials"] for row in at.values() if row["trials"]):
        panels.append(("characters read right (%)", ("character_legibility",), 100.0))
    if (table.frame["timed"] > 0).any():
        panels.append(("mean duration (s)", ("duration_mean_s",), 1.0))
    drawn = tuple(
        (
            label,
            tuple(
                _series(condition, [at[who, condition] for who in people], names, scale)
                for condition in conditions
            ),
        )
        for label, names, scale in panels
    )
    means = ", ".join(
        f"{row['condition']} {to_print(row['legibility'], Kind.PERCENT)} %"
        for row in averages.records()
        if row["legibility"] is not None
    )
    text = (
        f"Bars for each participant in each condition, with 95 % intervals of legibility. "
        f"Averages over participants: {means}."
    )
    return ReportFigure(
        "legibility",
        "Legibility and duration by participant and condition",
        text,
        table.name,
        Bars("Legibility and duration", "participant", tuple(people), drawn),
    )


def dots(table: ResultTable, own: ResultTable) -> ReportFigure:
    """Bars of legibility by number of dots: Lévesque 2009, fig. 4.8."""
    rows = table.records()
    points = _points(own.records(), "dots", [row["dots"] for row in rows], "legibility", 100.0)
    series = _series("all", rows, _SHARE, 100.0, points)
    shares = ", ".join(
        f"{row['dots']}: {to_print(row['legibility'], Kind.PERCENT)} %" for row in rows
    )
    return ReportFigure(
        "dots",
        "Legibility of characters by their number of dots",
        f"One bar a number of dots, the mean over participants, with 95 % intervals; a circle is "
        f"a participant (table {own.title}). {shares}.",
        table.name,
        Bars(
            "Legibility by number of dots",
            "dots of the character",
            tuple(str(row["dots"]) for row in rows),
            (("characters read right (%)", (series,)),),
        ),
    )


def errors(table: ResultTable, own: ResultTable) -> ReportFigure:
    """Bars of the kinds of errors: Lévesque 2009, fig. 4.8."""
    rows = table.records()[:MOST_ERRORS]
    kinds = [row["error"] for row in rows]
    points = _points(own.records(), "error", kinds, "share", 100.0)
    series = _series("all", rows, ("share",), 100.0, points)
    first = rows[0]
    part = "" if len(rows) == len(table.rows) else f", of the {len(rows)} most frequent"
    return ReportFigure(
        "errors",
        "Errors by dots added, removed and moved",
        f"One bar a kind of error{part}: its share of all errors; a circle is a participant's "
        f"share (table {own.title}). The most frequent is {first['error']}: {first['count']} "
        f"places, {to_print(first['share'], Kind.PERCENT)} % of all errors.",
        table.name,
        Bars("Errors by dots", "error", tuple(kinds), (("of all errors (%)", (series,)),)),
    )


def choices(table: ResultTable, preferred: ResultTable, own: ResultTable) -> Iterator[ReportFigure]:
    """Counts of the choices of each value, one figure for a parameter: Lévesque 2009, fig. 3.12."""
    for liked in preferred.records():
        name = liked["parameter"]
        rows = [row for row in table.records() if row["parameter"] == name]
        most = max(rows, key=lambda row: row["chosen"])
        said = liked["note"]
        if liked["preferred"] is not None:
            said = (
                f"The preferred value is {to_print(liked['preferred'], Kind.NUMBER)}, "
                f"{interval_words(liked, Kind.NUMBER)}."
            )
        values = [row["value"] for row in rows]
        whose = [row for row in own.records() if row["parameter"] == name]
        points = _points(whose, "value", values, "share", 100.0)
        series = _series("chosen", rows, ("share",), 100.0, points)
        yield ReportFigure(
            f"choices_{_file_name(name)}",
            f"How often each {_in_words(name)} was chosen",
            f"One bar a value: in which share of its comparisons it was chosen; a circle is a "
            f"participant (table {own.title}). Most often chosen was {most['value']:g}, "
            f"{times(most['chosen'])} of {most['presented']}. {said}",
            table.name,
            Bars(
                f"Choices of {_in_words(name)}",
                _in_words(name),
                tuple(f"{value:g}" for value in values),
                (("chosen (%)", (series,)),),
            ),
        )


def _points(
    records: Sequence[Row], group: str, groups: Sequence[object], value: str, scale: float
) -> tuple[Numbers, ...]:
    """Values of each participant, an array for each group; empty where there is one participant."""
    of: dict[str, dict[object, float]] = {}
    for row in records:
        of.setdefault(row["participant"], {})[row[group]] = scale * row[value]
    if len(of) < 2:
        return ()
    return tuple(tuple(own.get(each) for each in groups) for own in of.values())


def _series(
    name: str,
    rows: Sequence[Row],
    names: Sequence[str],
    scale: float,
    points: tuple[Numbers, ...] = (),
) -> Series:
    """Values of one kind, a column of rows, and the ends of their intervals, if there are any."""
    values, lows, highs = (
        *(tuple(_scaled(row.get(each), scale) for row in rows) for each in names),
        *((),) * (3 - len(names)),
    )
    return Series(name, values, lows, highs, points)


def _distinct(table: ResultTable, name: str) -> list[str]:
    return table.frame[name].unique().tolist()


def _scaled(value: float | None, scale: float) -> float | None:
    return None if value is None else scale * value


def _in_words(parameter: str) -> str:
    """Words for a parameter with its unit: "dot width (mm)" for dot_width_mm."""
    words, unit = parameter_words(parameter)
    return f"{words} ({unit.strip()})" if unit else words


def _file_name(name: str) -> str:
    """Name for the files of a figure: letters and digits of what it shows."""
    return "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in name)


MOST_ROWS = 30  # rows of a matrix that fits upon A4


def confusion(table: ResultTable) -> ReportFigure:
    """Matrix of counts: Lévesque 2009, tables 3.4, 3.5 and 4.1.

    If there are more rows than a page has room for, the figure shows those with the most errors.
    """
    shown = table.gathered()
    errors = table.wrong()
    text = "No answer was wrong."
    if errors:
        worst = sorted(errors, key=lambda error: -error[0])[:3]
        said = "; ".join(
            f"{row} for which {column} was answered, {times(n)}" for n, row, column in worst
        )
        text = f"{count(len(errors), 'kind')} of confusion. Most frequent: {said}."
    headings = [column.heading for column in shown.columns[1:]]
    rows, columns, part = list(shown.rows), list(range(len(headings))), ""
    if len(rows) > MOST_ROWS:
        rows, columns = _most_wrong(shown)
        part = (
            f" Of {len(shown)} rows the figure has the {len(rows)} with the most errors, and "
            f"the {len(columns)} most frequent answers to them."
        )
    names = [headings[at] for at in columns]
    known = {name: at for at, name in enumerate(names)}
    return ReportFigure(
        table.name,
        table.title,
        f"Rows are what was presented, columns what was answered; {UNREAD} is not read."
        f"{_other(shown, table)}{part} {text}",
        table.name,
        Matrix(
            table.title,
            "presented",
            "answered",
            tuple(str(row[0]) for row in rows),
            tuple(names),
            tuple(tuple(_whole(row[at + 1]) for at in columns) for row in rows),
            table.marks,
            tuple(known.get(str(row[0])) for row in rows),
        ),
    )


def _most_wrong(table: ResultTable) -> tuple[list[tuple], list[int]]:
    """Rows of a matrix with the most errors, in their order, and the columns they use most."""
    every = table.rows
    wrong = [
        sum(_whole(count) for at, count in enumerate(row) if at and not table.is_right(row, at))
        for row in every
    ]
    chosen = sorted(sorted(range(len(wrong)), key=lambda n: -wrong[n])[:MOST_ROWS])
    rows = [every[n] for n in chosen]
    used = [sum(_whole(row[at]) for row in rows) for at in range(1, len(table.columns))]
    columns = sorted(sorted(range(len(used)), key=lambda at: -used[at])[:MOST_ROWS])
    return rows, columns


def _other(shown: ResultTable, table: ResultTable) -> str:
    if shown is table:
        return ""
    number = len(table.columns) - len(shown.columns) + 1
    return f" {OTHER} gathers {number} rare answers that were never presented."


def _whole(value: object) -> int:
    return value if isinstance(value, int) else 0


MOST_RUNS = 24  # panels in one figure of curves
MOST_PAGES = 10  # figures of one kind
PATHS = Schema(
    "examples",
    "Trajectories of the trials that are drawn",
    "Of each reading pattern one trial: of all sessions, that whose duration is the median of "
    "theirs. At most 600 ticks of it.",
    (
        Column("pattern", "pattern", "reading pattern"),
        PARTICIPANT,
        SESSION,
        TRIAL,
        Column("presented", "string", "names of its cells"),
        Column("time_s", "time (s)", "since the trial began", Kind.NUMBER),
        Column("x_mm", "x (mm)", "place of the array's left column", Kind.NUMBER),
        Column("counts", "counts", "1 within the time that counts, else 0", Kind.COUNT),
    ),
)


def over_time(table: ResultTable, slopes: ResultTable) -> Iterator[ReportFigure]:
    """Single trials and their moving average, `MOST_RUNS` to a figure: Lévesque 2009, fig. 3.14."""
    whose = ["participant", "session", "condition"]
    runs = []
    several = len(table.frame["session"].unique()) > len(table.frame["participant"].unique())
    for (who, session, condition), rows in table.frame.groupby(whose, sort=False):
        average = rows["average"].astype(object).where(rows["average"].notna(), None)
        runs.append(
            Curve(
                f"{who}, {session}, {condition}" if several else f"{who}, {condition}",
                tuple(rows["number"].tolist()),
                tuple(rows["correct"].tolist()),
                tuple(average.tolist()),
            )
        )
    sure = [row for row in slopes.records() if row["p"] is not None and row["p"] < 0.05]
    said = "; ".join(
        f"{row['participant']}, {row['condition']}, by {to_print(row['slope'], Kind.PERCENT)} % in "
        f"10 trials"
        for row in sure
    )
    text = (
        f"A panel a participant and condition; dots are single trials, the curve is the average of "
        f"the past 10. Legibility changed with p below 0.05: {said or 'nowhere'}."
    )
    yield from _pages("over_time", "Legibility over time", text, table, runs, MOST_RUNS, Runs)


def examples(sessions: Sequence[SessionTrials]) -> tuple[ResultTable, ReportFigure] | None:
    """Trajectories, one for each pattern (Lévesque 2009, fig. 3.15); None if there are none."""
    chosen = list(_chosen(sessions))
    if not chosen:
        return None
    keys = cell_keys(session.protocol for session in sessions)
    rows = [
        {
            "pattern": example.pattern,
            "participant": example.participant,
            "session": session,
            "trial": example.trial,
            "presented": name_string(example.presented, keys),
            "time_s": time_s,
            "x_mm": x_mm,
            "counts": int(example.start_s <= time_s <= example.end_s),
        }
        for session, example in chosen
        for time_s, x_mm in zip(example.time_s.tolist(), example.left_mm.tolist(), strict=True)
    ]
    paths = tuple(
        Path(
            f"{example.pattern}: {example.participant}, {name_string(example.presented, keys)}",
            tuple(example.time_s.tolist()),
            tuple(example.left_mm.tolist()),
            example.start_s,
            example.end_s,
            example.span_mm,
            example.dots_mm,
        )
        for _, example in chosen
    )
    said = "; ".join(
        f"{example.pattern}: participant {example.participant} read "
        f"{name_string(example.presented, keys)} in "
        f"{to_print(example.end_s - example.start_s, Kind.TENTHS)} s (trial {example.trial} of "
        f"{session})"
        for session, example in chosen
    )
    table = PATHS.fill(rows)
    return table, ReportFigure(
        "trajectories",
        "Typical reading patterns",
        "Where the array was while a string was read, a trial of each pattern: a band from its "
        f"left column to its right one, dotted where the time does not count. {said}.",
        table.name,
        Paths("Typical reading patterns", paths),
    )


def _chosen(sessions: Sequence[SessionTrials]) -> Iterator[tuple[str, Example]]:
    """One example of each pattern: the one whose duration is in the middle."""
    found = [(session.name, example) for session in sessions for example in session.examples]
    for pattern in dict.fromkeys(sorted(example.pattern for _, example in found)):
        of = [pair for pair in found if pair[1].pattern == pattern]
        of.sort(key=lambda pair: (pair[1].end_s - pair[1].start_s, pair[0], pair[1].trial))
        yield of[(len(of) - 1) // 2]


MOST_RISES = 12  # in one figure
_POINTS = 80  # of a curve
_WHOSE = ("question", "participant", "protocol", "level")
_TOLD = 6  # thresholds that the text tells; the table has all


def rises(table: ResultTable, levels: ResultTable) -> Iterator[ReportFigure]:
    """Psychometric functions, `MOST_RISES` to a figure.

    Parameters
    ----------
    table, levels
        Tables of thresholds, and of answers by level.
    """
    answers: dict[tuple[str, ...], list[Row]] = {}
    for row in levels.records():
        answers.setdefault(tuple(row[name] for name in _WHOSE), []).append(row)
    drawn = [row for row in table.records() if tuple(row[n] for n in _WHOSE) in answers]
    panels = [_panel(row, answers[tuple(row[name] for name in _WHOSE)]) for row in drawn]
    known = [row for row in drawn if row["threshold"] is not None]
    said = "; ".join(
        f"{row['participant']}, {row['level']}: {to_print(row['threshold'], Kind.NUMBER)} "
        f"({to_print(row['low'], Kind.NUMBER)} to {to_print(row['high'], Kind.NUMBER)})"
        for row in known[:_TOLD]
    )
    more = "; the table has all" if len(known) > _TOLD else ""
    text = (
        "A panel for each participant and level; the more trials, the larger the dot, and the "
        f"curve is the psychometric function. Thresholds with their 95 % intervals: "
        f"{said or 'none'}{more}."
    )
    title = "Answers by level, and thresholds"
    yield from _pages("thresholds", title, text, levels, panels, MOST_RISES, Rises)


def _pages(
    name: str,
    title: str,
    text: str,
    table: ResultTable,
    panels: Sequence[Any],
    most: int,
    chart: Callable[[str, tuple[Any, ...]], Chart],
) -> Iterator[ReportFigure]:
    """Figures of many panels, so many to a figure; of more than `MOST_PAGES` the table has all."""
    pages = -(-len(panels) // most)
    if pages > MOST_PAGES:
        text += f" Of {pages} pages {MOST_PAGES} are drawn; the table has all."
    for page in range(min(pages, MOST_PAGES)):
        of_page = f"{title}, {page + 1} of {pages}" if pages > 1 else title
        yield ReportFigure(
            f"{name}_{page + 1}" if page else name,
            of_page,
            "As the figure before, of the participants that follow." if page else text,
            table.name,
            chart(of_page, tuple(panels[page * most : (page + 1) * most])),
        )


def _panel(row: Row, answers: list[Row]) -> Rise:
    answers = [answer for answer in answers if answer["value"] is not None]
    levels = tuple(answer["value"] for answer in answers)
    curve: tuple[tuple[float, float], ...] = ()
    threshold = None
    if row["threshold"] is not None:
        x = np.linspace(min(levels), max(levels), _POINTS)
        rising = SHAPES[SHAPE_OF[row["question"]]](
            x, np.array(row["threshold"]), np.array(row["spread"])
        )
        shares = row["guesses"] + (1 - row["guesses"] - row["lapses"]) * rising
        curve = tuple(zip(x.tolist(), shares.tolist(), strict=True))
        threshold = (row["threshold"], row["low"], row["high"])
    what = "difference of " if row["question"] != "detect" else ""
    return Rise(
        f"{row['participant']}, {row['question']}, {row['level']}",
        f"{what}{_in_words(row['level'])}",
        levels,
        tuple(answer["share"] for answer in answers),
        tuple(answer["trials"] for answer in answers),
        curve,
        threshold,
    )
