"""Maps of a share over two things that were varied, a panel for each value of all others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from vbraille.pictures.figurefiles import styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ACROSS = 3  # panels side by side


@dataclass(frozen=True, slots=True)
class MapPanel:
    """A panel of a map: its title, and shares 0…1 by row and column, None where none is known."""

    title: str
    shares: tuple[tuple[float | None, ...], ...]


@dataclass(frozen=True, slots=True)
class ShareMap:
    """Shares over two axes.

    Parameters
    ----------
    title
        Title of the figure.
    down, across
        What the rows and the columns are.
    rows, columns
        Labels of the rows, from the top, and of the columns.
    panels
        The panels, at least one.
    """

    title: str
    down: str
    across: str
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    panels: tuple[MapPanel, ...]


def draw_map(chart: ShareMap) -> Figure:
    """Draw a map: darker is more, and each field says its share in percent."""
    across = min(len(chart.panels), _ACROSS)
    down = -(-len(chart.panels) // across)
    size = (
        max(len(chart.columns) * 0.7 + 1.4, 4.8 if across == 1 else 3.2),
        max(len(chart.rows) * 0.45 + 1.2, 2.0),
    )
    with styled():
        figure = Figure(figsize=(size[0] * across, size[1] * down + 0.5))
        FigureCanvasAgg(figure)
        places = figure.subplots(down, across, squeeze=False).ravel()
        for axes, panel in zip(places, chart.panels, strict=False):
            _panel(axes, chart, panel)
        for axes in places[len(chart.panels) :]:
            axes.set_axis_off()
        figure.suptitle(chart.title)
        figure.draw_without_rendering()
    return figure


def _panel(axes: Axes, chart: ShareMap, panel: MapPanel) -> None:
    shares = [[float("nan") if share is None else share for share in row] for row in panel.shares]
    axes.imshow(shares, cmap="Greys", vmin=0, vmax=1, aspect="auto")
    axes.set_title(panel.title)
    axes.set(xlabel=chart.across, ylabel=chart.down)
    axes.set_xticks(range(len(chart.columns)), chart.columns)
    axes.set_yticks(range(len(chart.rows)), chart.rows)
    for row, values in enumerate(panel.shares):
        for column, share in enumerate(values):
            if share is not None:
                shade = "white" if share > 0.5 else "black"
                text = f"{100 * share:.0f}"
                axes.text(column, row, text, ha="center", va="center", color=shade)
