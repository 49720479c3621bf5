"""Figures of the charts of results, made with matplotlib and without its pyplot.

Everything is told apart by place, hatch, line style or grey, so that it can be read in print.
"""

from __future__ import annotations

import math
import textwrap
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from vbraille.pictures.charts import Bars, Matrix, Paths, Rises, Runs
from vbraille.pictures.figurefiles import FAINT, MIDDLE, styled
from vbraille.pictures.words import plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.typing import ColorType
    from numpy.typing import NDArray

    from vbraille.pictures.charts import Chart, Curve, Numbers, Path, Rise, Series

# Fill and hatch of each series' bars: light enough for the black of their error bars.
FILLS: tuple[tuple[ColorType, str], ...] = (
    ("white", ""),
    ("0.8", ""),
    ("white", "////"),
    ("0.6", ""),
    ("white", "...."),
    ("0.8", r"\\\\"),
)
MISSING = "n/a"
SHADE = "0.85"  # of the band in `Paths`, of the diagonal in `Matrix`
_INCHES = 0.085  # across a character of a label
_LABEL = 24  # characters of a line of a label
_SAMPLES = 500  # of a path: more than a panel has pixels to show
_DOT = {"color": MIDDLE, "linewidth": 2.6, "solid_capstyle": "round", "snap": False}
_PERCENT = (0, 50, 100)
_JOINED = 12  # groups: points of more are joined by lines that no eye can follow
# Width and height of a panel, in inches, by how many stand side by side: all fit upon A4.
_PANELS = ((5.7, 3.0), (2.9, 2.2), (1.9, 1.7), (1.4, 1.4))
_WIDEST = 9.0  # inches, of bars: A4 across
_MATRIX = 5.8, 8.2  # inches of its columns and rows: with its labels within A4's margins of 20 mm


def draw_chart(chart: Chart) -> Figure:
    """Draw a chart; characters in its words that no picture can show are spelled."""
    with styled():
        match chart:
            case Bars():
                figure = _bars(chart)
            case Runs():
                figure = _runs(chart)
            case Paths():
                figure = _paths(chart)
            case Matrix():
                figure = _matrix(chart)
            case Rises():
                figure = _rises(chart)
        width = int(9 * figure.get_figwidth())  # characters
        figure.suptitle("\n".join(textwrap.wrap(plain(chart.title), width)))
        # Placed once, and not at each saving: that takes longer than the drawing.
        ConstrainedLayoutEngine().execute(figure)
    return figure


def _bars(chart: Bars) -> Figure:
    """Draw figs. 3.12, 4.7, 4.8 and 4.9: a panel for each measure."""
    groups = [plain(group) for group in chart.groups]
    most = max((len(series) for _, series in chart.panels), default=1)
    across = 0.13 * (most + 1) if most > 1 else 0.3  # inches a group needs for its bars
    width = min(max(len(groups) * across, 5.5), _WIDEST)
    # Labels lie, in lines, where they have room: upright ones are harder to read.
    room = int(0.95 * width / max(len(groups), 1) / _INCHES)  # characters
    upright = any(len(word) > room for group in groups for word in group.split())
    groups = [_lines(group, 2 * _LABEL if upright else room) for group in groups]
    figure = _figure(1 + width, 1.6 + 2.6 * len(chart.panels))
    panels = figure.subplots(len(chart.panels), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (label, several) in zip(panels, chart.panels, strict=True):
        for number, series in enumerate(several):
            _draw_series(axes, series, number, 0.8 / len(several))
        axes.set_ylabel("\n".join(textwrap.wrap(plain(label), 30)))
        axes.grid(axis="y", color=FAINT, linewidth=0.6)
        axes.set_axisbelow(True)
        axes.set_xlim(-0.6, len(groups) - 0.4)
        if all(value is None for series in several for value in series.values):
            axes.set(ylim=(0, 1), yticks=[])
    panels[-1].set_xticks(range(len(groups)), groups, rotation=90 if upright else 0)
    panels[-1].set_xlabel(plain(chart.across))
    names = dict.fromkeys(series.name for _, several in chart.panels for series in several)
    if most > 1:
        keys = [_fill(number) for number in range(len(names))]
        _legend(figure, keys, [_lines(name, 2 * _LABEL) for name in names])
    return figure


def _draw_series(axes: Axes, series: Series, number: int, width: float) -> None:
    """Draw the bars of one series beside those of the others; all together are 0.8 wide."""
    values = _numbers(series.values)
    at = np.arange(values.size) - 0.4 + (number + 0.5) * width
    known = np.isfinite(values)
    fill, hatch = FILLS[number % len(FILLS)]
    axes.bar(at[known], values[known], width, color=fill, hatch=hatch, edgecolor="black")
    if series.lows and series.highs:
        lows, highs = _numbers(series.lows), _numbers(series.highs)
        spread = np.maximum([values - lows, highs - values], 0)
        whole = np.isfinite(spread).all(axis=0)
        axes.errorbar(
            at[whole],
            values[whole],
            spread[:, whole],
            fmt="none",
            ecolor="black",
            elinewidth=0.9,
            capsize=2.5,
        )
    _draw_points(axes, series, at, width)
    for x in at[~known]:
        axes.annotate(
            MISSING, (x, 0), (0, 3), textcoords="offset points", rotation=90, ha="center", size=8
        )


def _draw_points(axes: Axes, series: Series, at: NDArray, width: float) -> None:
    """Draw each participant's values upon the bars, joined where a group has one bar."""
    for number, points in enumerate(series.points):
        # Beside each other in the middle half of the bar, so that like values are seen apart.
        aside = ((number + 0.5) / len(series.points) - 0.5) * width / 2
        axes.plot(
            at + aside,
            _numbers(points),
            color=MIDDLE,
            linewidth=0.5 if width > 0.5 and at.size <= _JOINED else 0,
            marker="o",
            markersize=3.2,
            markerfacecolor="white",
            markeredgecolor="black",
            markeredgewidth=0.7,
            zorder=3,
        )


def _fill(number: int) -> Patch:
    fill, hatch = FILLS[number % len(FILLS)]
    return Patch(facecolor=fill, hatch=hatch, edgecolor="black")


def _runs(chart: Runs) -> Figure:
    """Draw fig. 3.14: a panel for each run, a dot for each trial."""
    figure, panels = _grid(len(chart.runs), most=4, across="trial", sharey=True)
    room = int(figure.get_figwidth() / min(4, len(chart.runs)) / _INCHES)
    for axes, run in zip(panels, chart.runs, strict=True):
        _draw_run(axes, run)
        axes.set_title(_lines(run.name, max(room - 4, 10)), size="small")
    panels[0].set_yticks(_PERCENT)
    panels[0].set_ylim(-8, 108)
    figure.supylabel("legibility (%)")
    dot = Line2D([], [], marker="o", markersize=3, linestyle="none", color=MIDDLE)
    curve = Line2D([], [], color="black")
    _legend(figure, [dot, curve], ["a trial: right at 100 %, wrong at 0 %", "moving average"])
    return figure


def _draw_run(axes: Axes, run: Curve) -> None:
    # Dots are short strokes with round ends: one path, where marks were thousands.
    dots = np.repeat(np.array(run.trials, float), 3) + np.tile(
        [-0.05, 0.05, math.nan], len(run.trials)
    )
    axes.plot(dots, np.repeat(100 * _numbers(run.correct), 3), **_DOT)
    axes.plot(run.trials, 100 * _numbers(run.average), color="black")
    axes.grid(axis="y", color=FAINT, linewidth=0.6)


def _paths(chart: Paths) -> Figure:
    """Draw fig. 3.15: where the array was, from left to right, over time from below upwards."""
    figure, panels = _grid(
        len(chart.paths), most=3, across="place on the line, x (mm)", sharey=False
    )
    for axes, path in zip(panels, chart.paths, strict=True):
        _draw_path(axes, path)
        axes.set_title(_lines(path.name, 24), size="small")
    figure.supylabel("time (s)")
    keys = [
        Patch(facecolor=SHADE, edgecolor="black"),
        Line2D([], [], color="black", linestyle="dotted"),
        Line2D([], [], color=MIDDLE, linestyle="dashed", linewidth=0.8),
    ]
    _legend(figure, keys, ["the array, left to right column", "not of the trial", "a dot's centre"])
    return figure


def _draw_path(axes: Axes, path: Path) -> None:
    for dot in path.dots_mm:
        axes.axvline(dot, color=MIDDLE, linestyle="dashed", linewidth=0.8)
    time, x = np.asarray(path.time_s), np.asarray(path.x_mm)
    if not time.size:
        return
    # The trial's ends are samples of their own, so that the parts meet there.
    ends = [t for t in (path.start_s, path.end_s) if time[0] <= t <= time[-1]]
    kept = np.union1d(time[:: -(-time.size // _SAMPLES)], [time[-1], *ends])
    x = np.interp(kept, time, x)
    axes.fill_betweenx(kept, x, x + path.span_mm, color=SHADE, linewidth=0, zorder=0)
    for part, line in (
        (kept <= path.start_s, "dotted"),
        ((kept >= path.start_s) & (kept <= path.end_s), "solid"),
        (kept >= path.end_s, "dotted"),
    ):
        if part.any():
            for edge in (x, x + path.span_mm):
                axes.plot(edge[part], kept[part], color="black", linestyle=line)
    axes.set_ylim(kept[0], max(kept[-1], kept[0] + 1e-3))


def _rises(chart: Rises) -> Figure:
    """Draw psychometric functions: a dot for each level, larger for more trials."""
    labels = {_lines(rise.across, 18) for rise in chart.rises}
    one = len(labels) == 1
    figure, panels = _grid(
        len(chart.rises), most=3, across=min(labels) if one else "", sharey=True, sharex=one
    )
    most = max(number for rise in chart.rises for number in rise.trials)
    for axes, rise in zip(panels, chart.rises, strict=True):
        _draw_rise(axes, rise, most)
        axes.set_title(_lines(rise.name, 24), size="small")
        if not one:
            axes.set_xlabel(_lines(rise.across, 18))
    panels[0].set_yticks(_PERCENT)
    panels[0].set_ylim(-4, 104)
    figure.supylabel("yes, or right (%)")
    dot = Line2D([], [], marker="o", markersize=4, linestyle="none", color=MIDDLE)
    bar = Line2D([], [], color="black", marker="|", markersize=8)
    curve = Line2D([], [], color="black")
    words = ["answers at a level", "fitted", "threshold with its 95 % interval, at the bottom"]
    _legend(figure, [dot, curve, bar], words)
    return figure


def _draw_rise(axes: Axes, rise: Rise, most: int) -> None:
    sizes = 30 * np.asarray(rise.trials) / most + 4
    axes.scatter(rise.levels, 100 * np.asarray(rise.shares), sizes, color=MIDDLE, zorder=2)
    axes.grid(axis="y", color=FAINT, linewidth=0.6)
    if rise.curve:
        levels, shares = np.asarray(rise.curve).T
        axes.plot(levels, 100 * shares, color="black")
    if rise.threshold is not None:
        threshold, low, high = rise.threshold
        axes.plot([low, high], [0, 0], color="black")
        axes.plot([threshold], [0], marker="|", markersize=8, color="black")


def _matrix(chart: Matrix) -> Figure:
    """Draw tables 3.4, 3.5 and 4.1: presented from the top down, answered from the left."""
    rows, columns = (
        [_lines(label, 2 * _LABEL) for label in labels] for labels in (chart.rows, chart.columns)
    )
    wide, high = (
        least / max(len(some), 1) for least, some in zip(_MATRIX, (columns, rows), strict=True)
    )
    cell = min(max(min(wide, high), 0.15), 0.6)  # inches
    longest = max((len(line) for label in columns for line in label.split("\n")), default=0)
    upright = longest * _INCHES > 0.9 * cell
    row_longest = max((len(line) for label in rows for line in label.split("\n")), default=0)
    beside = 0.6 + row_longest * _INCHES
    above = 1.5 + (longest * _INCHES if upright else 0.2)
    figure = _figure(max(len(columns) * cell + beside, 4.5), len(rows) * cell + above)
    axes = figure.subplots()
    axes.set(xlim=(0, len(columns)), ylim=(len(rows), 0), aspect="equal")
    axes.hlines(range(len(rows) + 1), 0, len(columns), color=FAINT, linewidth=0.6)
    axes.vlines(range(len(columns) + 1), 0, len(rows), color=FAINT, linewidth=0.6)
    size = _digits_size(3, cell)
    shaded: list[Rectangle] = []
    framed: dict[float, list[Rectangle]] = {}
    for down, (counts, right) in enumerate(zip(chart.counts, chart.diagonal, strict=True)):
        for across, count in enumerate(counts):
            if across == right:
                shaded.append(_cell(down, across))
            elif frame := _frame(count, chart.marks):
                framed.setdefault(frame, []).append(_cell(down, across))
            if count:
                text = str(count)
                own = min(_digits_size(len(text), cell), size)
                axes.text(across + 0.5, down + 0.5, text, ha="center", va="center", size=own)
    # Frames of one kind are drawn in one go: they are hundreds.
    axes.add_collection(PatchCollection(shaded, color=SHADE, linewidth=0), autolim=False)
    for frame, cells in framed.items():
        look = {"facecolor": "none", "edgecolor": "black", "linewidth": frame}
        axes.add_collection(PatchCollection(cells, **look), autolim=False)
    for within in (*axes.texts, *axes.collections):
        within.set_in_layout(False)  # hundreds, that need no room of their own
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0, labelsize=min(size + 1.5, 11))
    axes.xaxis.tick_top()
    axes.xaxis.set_label_position("top")
    axes.set_xticks(np.arange(len(columns)) + 0.5, columns, rotation=90 if upright else 0)
    axes.set_yticks(np.arange(len(rows)) + 0.5, rows)
    axes.set(xlabel=plain(chart.across), ylabel=plain(chart.down))
    return figure


def _digits_size(digits: int, cell: float) -> float:
    """Find the size in points at which a number fits into a cell; a digit is 0.64 em wide."""
    return min(cell * 72 * 0.85 / (digits * 0.64), 11.0)


def _frame(count: int, marks: tuple[int, ...]) -> float:
    """Choose the width of the frame of an error's count, in points; 0 is none."""
    return (0.0, 0.9, 2.6)[min(sum(count > mark for mark in marks), 2)]


def _cell(down: int, across: int) -> Rectangle:
    """Make a frame just within a cell, so that the frames of neighbours stay apart."""
    inset = 0.08
    return Rectangle((across + inset, down + inset), 1 - 2 * inset, 1 - 2 * inset)


def _figure(width: float, height: float) -> Figure:
    """Make a figure of a size in inches, whose parts `draw_chart` places."""
    return Figure(figsize=(width, height), constrained_layout=False)


def _grid(
    panels: int, most: int, across: str, sharey: bool, sharex: bool = True
) -> tuple[Figure, list[Axes]]:
    """Make a figure with a grid of panels, so many side by side; the lowest are labelled."""
    columns = min(most, max(math.ceil(math.sqrt(panels)), 1) if most > 3 else panels)
    wide, high = _PANELS[columns - 1]
    rows = -(-panels // columns)
    figure = _figure(1 + wide * columns, 1.6 + high * rows)
    grid = figure.subplots(rows, columns, sharex=sharex, sharey=sharey, squeeze=False)
    for axes in grid.flat[panels:]:
        axes.set_axis_off()
    for axes in grid.flat[max(panels - columns, 0) : panels]:
        axes.tick_params(labelbottom=True)
        axes.set_xlabel(across)
    return figure, list(grid.flat[:panels])


def _legend(figure: Figure, keys: list, words: list[str]) -> None:
    """Explain below the panels what is drawn."""
    width = sum(map(len, words)) * _INCHES + 0.9 * len(words)
    columns = max(1, int(len(words) * min(1, figure.get_figwidth() / width)))
    figure.legend(keys, words, loc="outside lower center", ncols=columns, frameon=False)


def _lines(text: str, width: int) -> str:
    """Break a label into lines of so many characters."""
    return "\n".join(textwrap.wrap(plain(text), max(width, 4)))


def _numbers(values: Numbers | tuple[int, ...]) -> NDArray[np.float64]:
    """Make an array, in which NaN stands for None."""
    return np.array([math.nan if value is None else value for value in values])
