"""Figures of bars: what was read right, by whom and how, and which of two was chosen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.analysis.findings import interval_words
from vbraille.analysis.input.trials import times
from vbraille.analysis.results import ReportFigure
from vbraille.analysis.schemas import Kind, to_print
from vbraille.pictures.charts import Bars, Series

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.analysis.schemas import ResultTable, Row
    from vbraille.pictures.charts import Numbers

MOST_ERRORS = 12  # kinds of errors that are drawn


def legibility(table: ResultTable, averages: ResultTable) -> ReportFigure:
    """Bars of legibility by participant and condition: Lévesque 2009, figs. 4.7 and 4.9."""
    people = _distinct(table, "participant")
    conditions = _distinct(table, "condition")
    at = {(row["participant"], row["condition"]): row for row in table.records()}
    panels = [("strings read right (%)", "legibility", 100.0)]
    if any(len_ > 1 for len_ in _places(table)):
        panels.append(("characters read right (%)", "character_legibility", 100.0))
    if (table.frame["timed"] > 0).any():
        panels.append(("mean duration (s)", "duration_mean_s", 1.0))

    def bars(condition: str, name: str, scale: float) -> Series:
        lows, highs = (
            tuple(_scaled(at[who, condition][end], scale) for who in people)
            if name == "legibility"
            else ()
            for end in ("low", "high")
        )
        values = tuple(_scaled(at[who, condition][name], scale) for who in people)
        return Series(condition, values, lows, highs)

    drawn = tuple(
        (label, tuple(bars(condition, name, scale) for condition in conditions))
        for label, name, scale in panels
    )
    known = [row for row in table.records() if row["trials"]]
    best, worst = (extreme(known, key=lambda row: row["legibility"]) for extreme in (max, min))
    means = ", ".join(
        f"{row['condition']} {to_print(row['legibility'], Kind.PERCENT)} %"
        for row in averages.records()
        if row["legibility"] is not None
    )
    text = (
        f"Bars for each participant in each condition, with 95 % intervals of legibility. Most "
        f"strings were read right by {_whose(best)}, fewest by {_whose(worst)}. Averages over "
        f"participants: {means}."
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
    series = Series(
        "all",
        *(
            tuple(_scaled(row[name], 100.0) for row in rows)
            for name in ("legibility", "low", "high")
        ),
        points=_points(own.records(), "dots", [row["dots"] for row in rows], "legibility", 100.0),
    )
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
    series = Series(
        "all",
        tuple(100 * row["share"] for row in rows),
        points=_points(own.records(), "error", kinds, "share", 100.0),
    )
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
    """How often each value was chosen, one figure for a parameter: Lévesque 2009, fig. 3.12."""
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
        series = Series(
            "chosen",
            tuple(100 * row["share"] for row in rows),
            points=_points(whose, "value", values, "share", 100.0),
        )
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


def level_means(table: ResultTable, own: ResultTable) -> Iterator[ReportFigure]:
    """Means of the levels with intervals and each participant's own, one figure for a factor."""
    for factor in _distinct(table, "factor"):
        rows = [row for row in table.records() if row["factor"] == factor]
        whose = [row for row in own.records() if row["factor"] == factor]
        levels = list(dict.fromkeys(row["level"] for row in rows))
        panels = []
        for measure in dict.fromkeys(row["measure"] for row in rows):
            of = {row["level"]: row for row in rows if row["measure"] == measure}
            share = measure.startswith("legibility")
            scale = 100.0 if share else 1.0
            ends = (
                tuple(_scaled(of[level][end], scale) if level in of else None for level in levels)
                for end in ("mean", "low", "high")
            )
            points = _points(
                [row for row in whose if row["measure"] == measure], "level", levels, "mean", scale
            )
            label = f"{measure} (%)" if share else measure
            panels.append((label, (Series("mean", *ends, points=points),)))
        said = "; ".join(
            f"{row['measure']}, {row['level']}: {_printed(row)} ({_interval(row)})"
            for row in rows
            if row["mean"] is not None
        )
        yield ReportFigure(
            f"means_{_file_name(factor)}",
            f"Means by {factor}",
            f"Bars are means over participants with 95 % intervals, circles the participants' own "
            f"means (table {own.title}), joined within each. {said}.",
            table.name,
            Bars(f"Means by {factor}", factor, tuple(levels), tuple(panels)),
        )


def _printed(row: Row) -> str:
    if row["measure"].startswith("legibility"):
        return f"{to_print(row['mean'], Kind.PERCENT)} %"
    return to_print(row["mean"], Kind.NUMBER)


def _interval(row: Row) -> str:
    if row["measure"].startswith("legibility"):
        return interval_words(row, Kind.PERCENT, " %")
    return interval_words(row, Kind.NUMBER)


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


def _places(table: ResultTable) -> list[int]:
    """Mean number of places in a string, for each row that has any."""
    return [row["characters"] // row["trials"] for row in table.records() if row["trials"]]


def _distinct(table: ResultTable, name: str) -> list[str]:
    return table.frame[name].unique().tolist()


def _scaled(value: float | None, scale: float) -> float | None:
    return None if value is None else scale * value


def _whose(row: Row) -> str:
    return (
        f"{row['participant']} in {row['condition']}, {to_print(row['legibility'], Kind.PERCENT)} %"
    )


def _in_words(parameter: str) -> str:
    """Words for a parameter with its unit: "dot width (mm)" for dot_width_mm."""
    unit = " (mm)" if parameter.endswith("_mm") else ""
    return parameter.removesuffix("_mm").replace("_", " ") + unit


def _file_name(name: str) -> str:
    """Name for the files of a figure: letters and digits of what it shows."""
    return "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in name)
