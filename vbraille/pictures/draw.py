"""Figures of the tables, made with matplotlib and without its pyplot.

Everything is told apart by place, line style or fill, so that it can be read in grey.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle

from vbraille.pictures.figurefiles import FAINT, MIDDLE, save, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from vbraille.pictures.series import FigureTable

__all__ = ["draw", "save"]

DEFLECTION = "deflection (of full swing)"
SWING = -0.05, 1.1  # limits of an axis of deflections, whatever the contrast
BANDS = "deflection from rest (grey) to full swing (dotted)"
BAND = 1.25  # from one curve's rest to the next one's, in full swings


def draw(table: FigureTable) -> Figure:
    """Draw a table by its kind."""
    with styled():
        return DRAWINGS[table.kind](table)


def profile(table: FigureTable) -> Figure:
    """Draw fig. 4.3: a panel for each level of texture."""
    names = [name for name in table.columns if name != "u_mm"]
    figure = Figure(figsize=(1 + 2.7 * len(names), 3.6))
    panels = figure.subplots(1, len(names), sharey=True, squeeze=False)[0]
    for axes, name in zip(panels, names, strict=True):
        axes.plot(table["u_mm"], table[name], color="black")
        axes.set_title(f"T = {name.removeprefix('deflection_T')} %")
        axes.set_xlim(table["u_mm"][0], table["u_mm"][-1])
        axes.grid(color=FAINT, linewidth=0.6)
    panels[0].set(ylabel=DEFLECTION, ylim=SWING)
    figure.supxlabel("from the dot's left edge, u (mm)")
    figure.suptitle(table.title)
    return figure


def mapping(table: FigureTable) -> Figure:
    """Draw fig. 4.5: a panel for each method, a curve for each row of actuators."""
    methods = list(dict.fromkeys(table["method"].tolist()))
    across = min(3, len(methods))
    down = -(-len(methods) // across)
    figure = Figure(figsize=(1 + 2.8 * across, 0.8 + 3.2 * down))
    grid = figure.subplots(down, across, sharex=True, sharey=True, squeeze=False)
    for axes in grid.flat[len(methods) :]:
        axes.set_axis_off()
    for axes, method in zip(grid.flat, methods, strict=False):
        chosen = table.where("method", method)
        _curves(axes, chosen["x_mm"], _numbered(chosen, "deflection_row_"))
        axes.set_title(method)
    figure.supxlabel("actuator's place, x (mm)")
    figure.supylabel(f"actuator row, 0 the far one; {BANDS}")
    figure.suptitle(table.title)
    return figure


def wave(table: FigureTable) -> Figure:
    """Draw figs. 3.8 and 3.9: the array at four positions, and each column along all of them."""
    series = _numbered(table, "deflection_column_")
    figure = Figure(figsize=(8, 8.5))
    panels = figure.subplot_mosaic([[*"abcd"], ["curves"] * 4], height_ratios=(1, 3))
    curves = panels["curves"]
    _curves(curves, table["x_mm"], series)
    columns = np.arange(len(series))
    for number, letter in enumerate("abcd"):
        at, axes = (2 * number + 1) * len(table) // 8, panels[letter]
        x = table["x_mm"][at]
        axes.vlines(columns, 0, series[:, at], color="black", linewidth=2.5)
        axes.plot(columns, series[:, at], "o", color="black", markersize=3)
        axes.set(xlabel="column", ylim=SWING)
        axes.set_title(f"{letter}: x = {x:.2f} mm".replace("-", "−"))
        axes.tick_params(labelleft=letter == "a")
        curves.axvline(x, color=MIDDLE, linestyle="dashed", linewidth=1)
        curves.text(x, 1, f" {letter}", transform=curves.get_xaxis_transform())
    panels["a"].set_ylabel("deflection\n(of full swing)")
    curves.set_xlabel("carriage position, x (mm): left column from the dot's left edge")
    curves.set_ylabel(f"column, 0 the left one; {BANDS}")
    figure.suptitle(table.title)
    return figure


def strain(table: FigureTable) -> Figure:
    """Draw fig. 3.10: two neighbours above, the strain between them below, for each dot width."""
    widths = np.unique(table["dot_width_mm"])
    figure = Figure(figsize=(1 + 2.8 * len(widths), 5.4))
    grid = figure.subplots(2, len(widths), sharex=True, sharey="row", squeeze=False)
    for (upper, lower), width in zip(grid.T, widths, strict=True):
        chosen = table.where("dot_width_mm", width)
        x, pitch = chosen["x_mm"], chosen["pitch_mm"][0]
        upper.plot(x, chosen["deflection_right"], color="black", label="right, i + 1")
        upper.plot(x, chosen["deflection_left"], color=MIDDLE, linestyle="dashed", label="left, i")
        upper.set_title(f"W = {width:g} mm {_against(width, pitch)}")
        lower.axhline(0, color=FAINT)
        for sign, name, side in ((1, "1/ε ", "top"), (-1, "−1/ε ", "bottom")):
            lower.axhline(sign / pitch, color=MIDDLE, linestyle="dotted")
            lower.text(x[-1], sign / pitch, name, ha="right", va=side)
        lower.plot(x, chosen["strain_per_mm"], color="black")
        lower.set_xlim(x[0], x[-1])
    grid[0, 0].set(ylabel=DEFLECTION, ylim=SWING)
    grid[1, 0].set_ylabel("strain (full swings per mm)")
    grid[0, 0].legend(loc="upper right")
    figure.supxlabel("left actuator from the dot's left edge, x (mm)")
    figure.suptitle(table.title)
    return figure


def page(table: FigureTable) -> Figure:
    """Draw the lines with the array's outline, and below it the array with its deflections."""
    dots, actuators = table.where("what", "dot"), table.where("what", "actuator")
    x, y, pitch = actuators["x_mm"], actuators["y_mm"], actuators["width_mm"][0]
    rows = np.unique(y)
    tall = rows[1] - rows[0] if rows.size > 1 else pitch
    array = _Box(x.min() - pitch / 2, x.max() + pitch / 2, y.min() - tall / 2, y.max() + tall / 2)
    lines = _Box(
        min(array.left, 0) - 12,  # room for the lines' numbers
        max(array.right, dots["x_mm"].max(initial=0)) + 4,
        min(array.far, 0) - 4,
        max(array.near, dots["y_mm"].max(initial=0)) + 4,
    )
    around = _Box(
        array.left - 2 * pitch, array.right + 2 * pitch, array.far - tall, array.near + tall
    )
    heights = min(9 * lines.steepness, 40), min(9 * around.steepness, 4.5)  # inches
    figure = Figure(figsize=(10, 2.2 + sum(heights)))
    whole, close = figure.subplots(2, 1, height_ratios=heights)
    for axes, box in ((whole, lines), (close, around)):
        axes.set(xlabel="along the line, x (mm)", ylabel="y (mm)", aspect="equal")
        axes.set(xlim=(box.left, box.right), ylim=(box.near, box.far))

    _dots(whole, dots, raised="black", share=1 / 3)
    frame = (array.left, array.far), array.right - array.left, array.near - array.far
    whole.add_patch(Rectangle(*frame, fill=False, linewidth=1.2))
    for number in np.unique(dots["line"]):
        middle = dots.where("line", number)["y_mm"].mean()
        whole.text(lines.left + 6, middle, str(number), ha="center", va="center")
    whole.set_title("the lines, their numbers at the left; the frame is the array")

    _dots(close, dots, raised=FAINT, share=1)
    places = list(zip(x - 0.3 * pitch, y + 0.35 * tall, actuators["deflection"], strict=True))
    boxes = [Rectangle((u, v), 0.6 * pitch, -0.7 * tall) for u, v, _ in places]
    fills = [Rectangle((u, v), 0.6 * pitch, -0.7 * tall * d) for u, v, d in places]
    _patches(close, boxes, "white", "black")
    _patches(close, fills, "black", "black")
    close.set_title(
        "the array: each box is filled up to the deflection (empty: rest, full: full swing)"
    )
    figure.suptitle(table.title)
    return figure


DRAWINGS = {
    "profile": profile,
    "mapping": mapping,
    "wave": wave,
    "strain": strain,
    "page": page,
}


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


def _curves(axes: Axes, x_mm: NDArray, series: NDArray) -> None:
    """Draw curves one below the other, each above a line of its own at deflection 0."""
    rest = -BAND * np.arange(len(series))
    axes.hlines(rest, x_mm[0], x_mm[-1], color=FAINT, linewidth=0.8)
    axes.hlines(rest + 1, x_mm[0], x_mm[-1], color=MIDDLE, linewidth=0.6, linestyle="dotted")
    axes.plot(x_mm, series.T + rest, color="black")
    axes.set_yticks(rest, [str(number) for number in range(len(series))])
    axes.set_xlim(x_mm[0], x_mm[-1])


def _numbered(table: FigureTable, prefix: str) -> NDArray:
    return np.array([table[name] for name in table.columns if name.startswith(prefix)])


def _against(width_mm: float, pitch_mm: float) -> str:
    if width_mm > 2 * pitch_mm:
        return "> 2ε"
    return "> ε" if width_mm > pitch_mm else "= ε" if width_mm == pitch_mm else "< ε"


def _dots(axes: Axes, dots: FigureTable, raised: str, share: float) -> None:
    """Draw the dots of the page: raised ones filled, the others as small rings."""
    places = zip(dots["x_mm"], dots["y_mm"], dots["width_mm"] / 2, dots["raised"], strict=True)
    circles = [(Circle((x, y), r if up else share * r), up) for x, y, r, up in places]
    _patches(axes, [circle for circle, up in circles if not up], "none", MIDDLE)
    _patches(axes, [circle for circle, up in circles if up], raised, "black")


def _patches(axes: Axes, patches: list, fill: str, edge: str) -> None:
    axes.add_collection(PatchCollection(patches, facecolor=fill, edgecolor=edge, linewidth=0.6))


class _Box(NamedTuple):
    """A part of the surface, in mm; y grows towards the reader."""

    left: float
    right: float
    far: float
    near: float

    @property
    def steepness(self) -> float:
        """Height of the box divided by its width."""
        return (self.near - self.far) / (self.right - self.left)
