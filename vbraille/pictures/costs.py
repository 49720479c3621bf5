"""Maps of what frames cost, with a histogram: Lévesque 2009, fig. 8.31."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from vbraille.errors import InputError
from vbraille.files import write_file
from vbraille.pictures.drawings import KINDS, drawing_bytes
from vbraille.pictures.figurefiles import styled
from vbraille.wording import setting

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

_INCHES = 10.0, 4.0
_PALEST = 0.9  # gray of the lowest cost; the highest is black
_BARS = 20
_PIXELS_PER_MM = 6.0


def draw_costs(
    mean_us: NDArray[np.float64],
    step_mm: float,
    path: Path,
    *,
    title: str,
    frame_us: NDArray[np.float64],
) -> None:
    """Draw a map of what a frame costs at each place, and a histogram, into a file.

    Parameters
    ----------
    mean_us : float64[rows, columns]
        Mean time of a frame in each square of the canvas, from its upper left corner; NaN where
        there was none.
    step_mm
        Side of a square.
    path
        The file, whose suffix is .png, .svg or .pdf; it is replaced if it is there.
    title
        What was rendered.
    frame_us : float64[n]
        Times that the histogram counts, one or more.

    Raises
    ------
    InputError
        If the suffix is another one, no square has a time, or the file cannot be made.
    VbrailleError
        If the disk cannot take the file.
    """
    kind = path.suffix.lower().removeprefix(".")
    if kind not in KINDS:
        raise InputError(f"cannot draw to {path}: end its name in .png, .svg or .pdf")
    figure = costs_figure(mean_us, step_mm, title, frame_us)
    words = "; ".join(costs_words(mean_us, step_mm))
    content = drawing_bytes(figure, kind, _PIXELS_PER_MM, f"{title}: time of a frame", words)
    write_file(path, content, replace=True)


def costs_figure(
    mean_us: NDArray[np.float64], step_mm: float, title: str, frame_us: NDArray[np.float64]
) -> Figure:
    """Make the figure of `draw_costs`, whose arguments it has.

    Raises
    ------
    InputError
        If no square has a time.
    """
    if not np.isfinite(mean_us).any():
        raise InputError(
            f"no frame was on the canvas, so that there is nothing to draw; choose another "
            f"{setting('path')}"
        )
    rows, columns = mean_us.shape
    with styled():
        figure = Figure(figsize=_INCHES)
        FigureCanvasAgg(figure)
        place, bars = figure.subplots(1, 2, width_ratios=(3, 2))
        grays = LinearSegmentedColormap.from_list("costs", [str(_PALEST), "0"])
        image = place.imshow(
            np.ma.masked_invalid(mean_us),
            cmap=grays,
            extent=(0, columns * step_mm, rows * step_mm, 0),
            interpolation="none",
        )
        place.set(xlabel="mm", ylabel="mm")
        figure.colorbar(image, ax=place, label="µs")
        bars.hist(
            frame_us, bins=_BARS, color="0.3", weights=np.full(frame_us.size, 100 / frame_us.size)
        )
        bars.set(xlabel="µs", ylabel="% of the frames")
        figure.suptitle(f"{title}: time of a frame")
        figure.draw_without_rendering()
    return figure


def costs_words(mean_us: NDArray[np.float64], step_mm: float) -> list[str]:
    """Tell what a map of costs shows, a line for each thing; `costs_figure` has the arguments."""
    known = mean_us[np.isfinite(mean_us)]
    row, column = np.unravel_index(np.nanargmax(mean_us), mean_us.shape)
    x, y = (float(at + 0.5) * step_mm for at in (column, row))
    return [
        f"squares: {mean_us.shape[1]} × {mean_us.shape[0]} of {step_mm:g} mm, darker where a frame "
        "takes longer, white where none was",
        f"least: {known.min():.2f} µs",
        f"median: {np.median(known):.2f} µs",
        f"most: {known.max():.2f} µs, around ({x:g}, {y:g}) mm",
    ]
