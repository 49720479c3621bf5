"""What charts of results hold: plain numbers and words, without a drawing."""

from __future__ import annotations

from dataclasses import dataclass

Numbers = tuple[float | None, ...]


@dataclass(frozen=True, slots=True)
class Series:
    """Values of one kind, a group each; None where there is none.

    Parameters
    ----------
    name
        What the legend calls it.
    values
        A value a group.
    lows, highs
        Ends of each value's interval; empty for none.
    points
        A row a participant, with a value a group; empty if none are drawn.
    """

    name: str
    values: Numbers
    lows: Numbers = ()
    highs: Numbers = ()
    points: tuple[Numbers, ...] = ()


@dataclass(frozen=True, slots=True)
class Bars:
    """Bars side by side: a panel a measure, a group a label, a bar a series.

    Parameters
    ----------
    title
        The title of the figure.
    across
        Label of the groups' axis.
    groups
        The label of each group.
    panels
        Label of the values' axis, and the series, of each panel; from the top.
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
        Whose.
    trials
        Numbers, from 1.
    correct
        0 or 1 of each.
    average
        Over the past trials, from 0 to 1; None before there are enough.
    """

    name: str
    trials: tuple[int, ...]
    correct: tuple[int, ...]
    average: Numbers


@dataclass(frozen=True, slots=True)
class Runs:
    """Legibility over time, a panel a run: Lévesque 2009, fig. 3.14."""

    title: str
    runs: tuple[Curve, ...]


@dataclass(frozen=True, slots=True)
class Path:
    """Where the array was in a trial: one panel of `Paths`.

    Parameters
    ----------
    name
        What the panel shows.
    time_s, x_mm
        When the array's left column was where.
    start_s, end_s
        Between these the trial counts.
    span_mm
        How far it is from the array's left column to its right one.
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
    """Typical reading patterns, a panel each: Lévesque 2009, fig. 3.15."""

    title: str
    paths: tuple[Path, ...]


@dataclass(frozen=True, slots=True)
class Matrix:
    """Counts in rows and columns, larger ones off the diagonal framed: Lévesque 2009, table 4.1.

    Parameters
    ----------
    title
        The title of the figure.
    down, across
        What rows and columns are.
    rows, columns
        The labels of the rows and of the columns.
    counts
        int, a tuple a row.
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


Chart = Bars | Runs | Paths | Matrix
