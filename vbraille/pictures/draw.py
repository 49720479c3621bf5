"""Figures of the tables, made with matplotlib and without its pyplot.

Everything is told apart by place or fill, so that it can be read in grey.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from vbraille.pictures.figurefiles import FAINT, MIDDLE, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from vbraille.pictures.series import FigureTable

_BAND = 1.25  # from one curve's rest to the next one's, in full swings
_ACROSS = 3  # panels side by side
_TALLEST = 40.0  # inches
_LINE = 0.6  # points


def draw(table: FigureTable) -> Figure:
    """Draw a table by its kind."""
    with styled():
        figure = _page(table) if table.kind == "page" else _curves(table)
        figure.suptitle(table.title)
    return figure


def _curves(table: FigureTable) -> Figure:
    """Draw figs. 3.8-3.10, 4.3 and 4.5: curves one below the other, each above its own rest."""
    along, *names = (name for name in table.columns if name != table.panels)
    panels = list(dict.fromkeys(table[table.panels].tolist())) if table.panels else [""]
    across = min(_ACROSS, len(panels))
    down = -(-len(panels) // across)
    height = 1.2 + 0.45 * len(names) * _BAND
    figure = Figure(figsize=(max(1 + 2.8 * across, 7), 1 + down * height))
    grid = figure.subplots(down, across, sharex=True, sharey=True, squeeze=False)
    for axes in grid.flat[len(panels) :]:
        axes.set_axis_off()
    # What is no share of a full swing is drawn as a share of its own greatest.
    scales = {name: max(1.0, float(np.abs(table[name]).max())) for name in names}
    for axes, panel in zip(grid.flat, panels, strict=False):
        chosen = table.where(table.panels, panel) if table.panels else table
        x = chosen[along]
        for number, name in enumerate(names):
            rest = -_BAND * number
            axes.axhline(rest, color=FAINT, linewidth=0.8)
            axes.axhline(rest + 1, color=MIDDLE, linewidth=0.6, linestyle="dotted")
            axes.plot(x, chosen[name] / scales[name] + rest, color="black")
        axes.set_xlim(x[0], x[-1])
        axes.set_title(
            f"{table.panels.removesuffix('_mm').replace('_', ' ')} {panel}" if table.panels else ""
        )
    labels = [
        name.removeprefix("deflection_").replace("_", " ")
        + (f" ÷ {scale:.3g}" if scale > 1 else "")
        for name, scale in scales.items()
    ]
    grid[0, 0].set_yticks(-_BAND * np.arange(len(names)), labels)
    figure.supxlabel(f"{along.removesuffix('_mm')} (mm)")
    figure.supylabel("from rest (grey) to full swing (dotted)")
    return figure


def _page(table: FigureTable) -> Figure:
    """Draw the lines with the array on one of them, and below it the array by itself.

    Each box of an actuator is filled up to its deflection.
    """
    dots, actuators = table.where("what", "dot"), table.where("what", "actuator")
    x, y, pitch = actuators["x_mm"], actuators["y_mm"], actuators["width_mm"][0]
    tall = max(np.diff(y), default=0.0) or pitch
    around = (x.min() - 2 * pitch, x.max() + 2 * pitch, y.min() - tall, y.max() + tall)
    whole = (
        min(around[0], -12),  # room for the lines' numbers
        max(around[1], dots["x_mm"].max(initial=0) + 4),
        min(around[2], -4),
        max(around[3], dots["y_mm"].max(initial=0) + 4),
    )
    heights = [
        min(9 * (bottom - top) / (right - left), most)
        for (left, right, top, bottom), most in ((whole, _TALLEST), (around, 4.5))
    ]
    figure = Figure(figsize=(10, 2.2 + sum(heights)))
    panels = figure.subplots(2, 1, height_ratios=heights)
    for axes, (left, right, top, bottom) in zip(panels, (whole, around), strict=True):
        for raised, edge, fill in ((0, FAINT, "none"), (1, MIDDLE, FAINT)):
            some = dots.where("raised", raised)
            centers = zip(some["x_mm"], some["y_mm"], strict=True)
            rings = [*map(Circle, centers, some["width_mm"] / 2)]
            axes.add_collection(PatchCollection(rings, ec=edge, fc=fill, lw=_LINE))
        for share, fill in ((1.0, "white"), (actuators["deflection"], "black")):
            up, foot = -0.7 * tall * share, y + 0.35 * tall
            axes.bar(x, up, 0.6 * pitch, foot, color=fill, ec="black", lw=_LINE)
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
        axes.set(xlabel="along the line, x (mm)", ylabel="y (mm)")
    for number in np.unique(dots["line"]):
        middle = dots.where("line", number)["y_mm"].mean()
        panels[0].text(whole[0] + 6, middle, str(int(number)), ha="center", va="center")
    panels[0].set_title("the lines, their numbers at the left, and the array")
    panels[1].set_title("the array: each box is filled up to the deflection")
    return figure


def plot_frames(
    positions_mm: NDArray[np.float64], frames: NDArray[np.floating], title: str, axes: Axes | None
) -> Axes:
    """Draw the deflections of frames along a line, an actuator a row.

    Parameters
    ----------
    positions_mm : float64[n]
        Places of the array's centre.
    frames : float[n, rows, columns]
        Deflections, 0 (white) … 1 (black).
    title
        Title of the axes.
    axes
        Axes to draw on; None for new ones.
    """
    if axes is None:
        axes = Figure(figsize=(8, 3), layout="constrained").subplots()
    actuators = frames.reshape(len(frames), -1)
    axes.imshow(
        actuators.T,
        cmap="gray_r",
        vmin=0.0,
        vmax=1.0,
        aspect="auto",
        interpolation="nearest",
        extent=(positions_mm[0], positions_mm[-1], actuators.shape[1] + 0.5, 0.5),
    )
    axes.set(title=title, xlabel="centre of the array (mm)", ylabel="actuator")
    return axes
