"""Figures for the report and for a paper: straight matplotlib.

"Figure" numbers are those of Lévesque (2009).
"""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from pandas import DataFrame, Series

from vbraille.analysis.measures import LOGS, SHARES
from vbraille.analysis.primary import plain
from vbraille.analysis.tables import CELL

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from vbraille.analysis.primary import Result

# The same figure gives the same bytes.
STYLE: Any = {"svg.hashsalt": "vbraille", "axes.spines.top": False, "axes.spines.right": False}
MOST_RUNS = 24
ACROSS = 3
MOST_POINTS = 500
MOST_KINDS = 12
GREYS = (".85", ".6", ".35", ".1")


def means(result: Result) -> Figure:
    """Draw each cell's mean with its interval, and a line or points for each person."""
    shares = result.measure.scale == SHARES
    times = 100 if shares else 1
    shown = result.means
    at = np.arange(len(shown))
    figure = Figure(figsize=(1.5 + 1.1 * len(shown), 3.2))
    axes = figure.subplots()
    values = result.cells.to_numpy(float)
    if result.measure.scale == LOGS:
        values = np.exp(values)
        axes.set_yscale("log")
    axes.bar(at, times * shown["mean"], 0.6, color=".9", edgecolor="k")
    first = 0
    groups = Series("", result.cells.index) if result.groups is None else result.groups
    for _, own in groups.groupby(groups):
        people = values[result.cells.index.isin(own.index)]
        places = np.arange(first, first + values.shape[1])
        axes.plot(places, times * people.T, "o-", color=".45", mfc="w", ms=4, lw=0.7)
        first += values.shape[1]
    low, high = shown["mean"] - shown["low"], shown["high"] - shown["mean"]
    reach = times * np.stack([low, high])
    axes.errorbar(at, times * shown["mean"], reach, fmt="none", color="k", capsize=4, lw=1.5)
    axes.set_xticks(at, shown["cell"], rotation=0 if len(shown) < 5 else 45)
    axes.set_ylabel(result.measure.name + (" (%)" if shares else result.measure.unit))
    return figure


def confusion(counts: DataFrame) -> Figure:
    """Draw how often each was answered where another was presented, darker for more."""
    size = min(2 + 0.2 * counts.shape[1], 14), min(1.5 + 0.2 * counts.shape[0], 10)
    figure = Figure(figsize=size)
    axes = figure.subplots()
    axes.imshow(np.sqrt(counts.to_numpy(float)), cmap="Greys", aspect="auto")
    axes.set_xticks(range(counts.shape[1]), counts.columns, rotation=90, fontsize=6)
    axes.set_yticks(range(counts.shape[0]), counts.index, fontsize=6)
    axes.set_xlabel("answered")
    axes.set_ylabel("presented")
    return figure


def _panels(count: int, high: float) -> tuple[Figure, list[Axes]]:
    """Return a figure with some panels, three in a row."""
    down = -(-count // ACROSS)
    figure = Figure(figsize=(9, 1 + high * down))
    space = {"hspace": 0.7, "wspace": 0.1}
    grid = list(figure.subplots(down, ACROSS, sharey=True, squeeze=False, gridspec_kw=space).flat)
    for axes in grid[count:]:
        axes.remove()
    return figure, grid[:count]


def over_time(table: DataFrame) -> Figure:
    """Draw the moving average of each person in each condition, figure 3.14."""
    runs = list(table.groupby(["participant", "condition"], observed=True))[:MOST_RUNS]
    figure, panels = _panels(len(runs), 1.3)
    for axes, (names, run) in zip(panels, runs, strict=True):
        many = len(run) > MOST_POINTS
        axes.plot(run["number"], 100 * run["right"], ".", color=".65", ms=3, rasterized=many)
        axes.plot(run["number"], 100 * run["average"], "k", lw=1, rasterized=many)
        axes.set_title(", ".join(map(str, names)), fontsize=7)
    figure.supxlabel("trial")
    figure.supylabel("right (%), mean of the last 10")
    return figure


def _bars(labels: Series, parts: dict[str, Series], what: str, unit: str, reach=None) -> Figure:
    """Draw a bar, or a group of bars, for each label."""
    figure = Figure(figsize=(min(2 + 0.35 * len(labels) * len(parts), 12), 3))
    axes = figure.subplots()
    at = np.arange(len(labels))
    width = 0.8 / len(parts)
    for n, (name, values) in enumerate(parts.items()):
        off = (n - (len(parts) - 1) / 2) * width
        grey = GREYS[n % len(GREYS)]
        axes.bar(at + off, values, width, label=name, color=grey, edgecolor="k")
    if reach is not None:
        axes.errorbar(at, next(iter(parts.values())), reach, fmt="none", color="k", capsize=3)
    axes.set_xticks(at, labels.astype(str), rotation=0 if len(labels) < 9 else 90)
    axes.set_xlabel(what)
    axes.set_ylabel(unit)
    if len(parts) > 1:
        axes.legend(frameon=False, loc="upper left", bbox_to_anchor=(1, 1))
    return figure


def legibility(table: DataFrame) -> Figure:
    """Draw legibility by character of each person in each condition, figure 4.7."""
    wide = table.pivot(index="participant", columns="condition", values="character_legibility")
    parts = {str(name): 100 * wide[name] for name in wide}
    return _bars(wide.index.to_series(), parts, "participant", "characters right (%)")


def dots(table: DataFrame) -> Figure:
    """Draw legibility by the number of dots of a character, figure 4.8."""
    shares = 100 * table["legibility"]
    reach = [shares - 100 * table["low"], 100 * table["high"] - shares]
    return _bars(table["level"], {"": shares}, "dots", "characters right (%)", reach)


def errors(table: DataFrame) -> Figure:
    """Draw the most frequent errors by dots, figure 4.8."""
    shown = table.head(MOST_KINDS)
    kinds = [f"+{row.added} −{row.removed} moved {row.moved}" for row in shown.itertuples()]
    return _bars(Series(kinds), {"": 100 * shown["share"]}, "dots", "of all errors (%)")


def patterns(table: DataFrame) -> Figure:
    """Draw how many strings were read in each pattern, figure 3.15."""
    told = ("speed_", *CELL)
    parts = {name: table[name] for name in map(str, table) if not name.startswith(told)}
    return _bars(table[CELL].agg(", ".join, axis=1), parts, "participant, condition", "strings")


def choices(table: DataFrame) -> Figure:
    """Draw how often each value was chosen, figure 3.12."""
    shares = {"": 100 * table["share"]}
    return _bars(
        table["value"].map("{:g}".format), shares, table["parameter"].iloc[0], "chosen (%)"
    )


def levels(table: DataFrame) -> Figure:
    """Draw right answers and times by level, with their SD over people, figure 6.7."""
    figure = Figure(figsize=(8, 3))
    shares = 100 * table["share"], 100 * table["share_sd"], "right (%)"
    times = table["taken_s"], table["taken_sd_s"], "time (s)"
    for axes, (mean, sd, unit) in zip(figure.subplots(1, 2), (shares, times), strict=True):
        axes.errorbar(table["level"], mean, sd, fmt="ko-", capsize=3, mfc="w")
        axes.set_xlabel("level, with SD over people")
        axes.set_ylabel(unit)
    return figure


def answers(table: DataFrame) -> Figure:
    """Draw the distribution of answers to each name, figure 6.10."""
    figure, panels = _panels(len(table), 1.6)
    for axes, (name, row) in zip(panels, table.iterrows(), strict=True):
        greys = [".35" if column == name else ".85" for column in table]
        axes.bar(range(len(row)), 100 * row, color=greys, edgecolor="k")
        axes.set_xticks(range(len(row)), table.columns, rotation=90, fontsize=6)
        axes.set_title(str(name), fontsize=8)
    figure.supylabel("answers (%)")
    return figure


DRAWN = {
    "legibility": legibility,
    "dots": dots,
    "errors": errors,
    "over_time": over_time,
    "patterns": patterns,
    "choices": choices,
    "levels": levels,
    "answers_names": answers,
}
"""Figures by the names of the tables that they show; confusions have `confusion`."""


def draw(result: Result | None, tables: dict[str, DataFrame]) -> dict[str, bytes]:
    """Return the content of each figure by the name of its file; the means are a PNG as well."""
    files = {}
    with matplotlib.rc_context(STYLE):
        if result is not None and len(result.cells):
            figure = means(result)
            files["means.svg"] = _content(figure, "svg")
            files["means.png"] = _content(figure, "png")
        for name, table in tables.items():
            drawn = confusion if name.startswith("confusion") else DRAWN.get(name)
            if drawn is not None and len(table):
                files[f"{name}.svg"] = _content(drawn(table), "svg")
    return files


def _content(figure: Figure, form: str) -> bytes:
    content = io.BytesIO()
    when = {"Date": None} if form == "svg" else None
    figure.savefig(content, format=form, metadata=when, bbox_inches="tight", dpi=300)
    return content.getvalue()


def alt_of_means(result: Result) -> str:
    """Return the figure of the means in words."""
    times, unit = (100, " in percent") if result.measure.scale == SHARES else (1, "")
    parts = [
        f"{row['cell']} {plain(times * row['mean'])}" for row in result.means.to_dict("records")
    ]
    return f"Mean {result.measure.name}{unit}: {', '.join(parts)}."
