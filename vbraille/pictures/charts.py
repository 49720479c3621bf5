"""Charts of results, as plain numbers and words; `drawcharts` draws them."""

from __future__ import annotations

from dataclasses import dataclass

Numbers = tuple[float | None, ...]


@dataclass(frozen=True, slots=True)
class Series:
    """Values of one kind, one for each group; None where a group has none.

    Parameters
    ----------
    name
        What the legend calls it.
    values
        One value for each group.
    lows, highs
        Ends of each value's interval; empty for none.
    points
        The values of each participant, one for each group; empty for none.
    """

    name: str
    values: Numbers
    lows: Numbers = ()
    highs: Numbers = ()
    points: tuple[Numbers, ...] = ()


@dataclass(frozen=True, slots=True)
class Bars:
    """Bars side by side: a panel for each measure, a group for each label, a bar for each series.

    Parameters
    ----------
    title
        Title of the figure.
    across
        Label of the groups' axis.
    groups
        Labels of the groups.
    panels
        For each panel, from the top, the label of the values' axis and the series.
    """

    title: str
    across: str
    groups: tuple[str, ...]
    panels: tuple[tuple[str, tuple[Series, ...]], ...]


@dataclass(frozen=True, slots=True)
class Curve:
    """Trials in their order: one line of `Runs`.

    Parameters
    ----------
    name
        What the line is called, such as a participant.
    trials
        Numbers of the trials, from 1.
    correct
        1 for each trial answered rightly, 0 for each other.
    average
        Mean over the past trials, from 0 to 1; None before there are enough.
    """

    name: str
    trials: tuple[int, ...]
    correct: tuple[int, ...]
    average: Numbers


@dataclass(frozen=True, slots=True)
class Runs:
    """Legibility over time, a panel for each run: Lévesque 2009, fig. 3.14."""

    title: str
    runs: tuple[Curve, ...]


@dataclass(frozen=True, slots=True)
class Path:
    """Path of the array in a trial: one panel of `Paths`.

    Parameters
    ----------
    name
        What the panel shows.
    time_s, x_mm
        Times, and places of the array's left column then.
    start_s, end_s
        Times between which the trial counts.
    span_mm
        Distance from the left column to the right one.
    dots_mm
        Centres of the dots.
    """

    name: str
    time_s: tuple[float, ...]
    x_mm: tuple[float, ...]
    start_s: float
    end_s: float
    span_mm: float
    dots_mm: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Paths:
    """Typical reading patterns, a panel for each: Lévesque 2009, fig. 3.15."""

    title: str
    paths: tuple[Path, ...]


@dataclass(frozen=True, slots=True)
class Matrix:
    """Counts in rows and columns, larger ones off the diagonal framed: Lévesque 2009, table 4.1.

    Parameters
    ----------
    title
        Title of the figure.
    down, across
        What the rows are, and what the columns are.
    rows, columns
        Labels of the rows and of the columns.
    counts
        Whole numbers, a tuple for each row.
    marks
        Errors above the first have a thin frame, above the second a thick one.
    diagonal
        For each row, the column that is right; None if there is none.
    """

    title: str
    down: str
    across: str
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    counts: tuple[tuple[int, ...], ...]
    marks: tuple[int, ...]
    diagonal: tuple[int | None, ...]


@dataclass(frozen=True, slots=True)
class Rise:
    """Shares of answers that rise with a level: one panel of `Rises`.

    Parameters
    ----------
    name
        What the panel shows, such as a participant.
    across
        Label of the levels' axis, with the unit.
    levels, shares, trials
        Levels, the share of answers at each, 0 to 1, and how many answers that is of.
    curve
        Levels and shares of the curve that was fitted; empty for none.
    threshold
        Threshold and the ends of its interval; None if there is no curve.
    """

    name: str
    across: str
    levels: tuple[float, ...]
    shares: tuple[float, ...]
    trials: tuple[int, ...]
    curve: tuple[tuple[float, float], ...] = ()
    threshold: tuple[float, float, float] | None = None


@dataclass(frozen=True, slots=True)
class Rises:
    """Psychometric functions, a panel for each participant and level."""

    title: str
    rises: tuple[Rise, ...]


Chart = Bars | Runs | Paths | Matrix | Rises
