"""Maps of what frames cost, with a histogram: Lévesque 2009, fig. 8.31."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import InputError
from vbraille.files import write_file
from vbraille.pictures.ink import InkArea, InkDrawing, InkLine, InkRaster, InkText
from vbraille.pictures.inkfiles import INK_KINDS, ink_bytes
from vbraille.pictures.overmap import tick_mm
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from vbraille.pictures.ink import InkMark

_LONGEST_MM = 160.0  # of a side of the map on the picture
_MARGIN_MM, _HEAD_MM, _BELOW_MM = 12.0, 9.0, 9.0
_RAMP_MM, _BARS_MM = 5.0, 55.0  # widths of the scale of grays and of the histogram
_LEAST_HIGH_MM = 45.0
_PALEST, _DARKEST = 230, 0  # grays of the lowest and of the highest cost
_BARS = 20
_HAIR_MM = 0.15
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
    if kind not in INK_KINDS:
        raise InputError(f"cannot draw to {path}: end its name in .png, .svg or .pdf")
    drawing = costs_drawing(mean_us, step_mm, title, frame_us)
    write_file(path, ink_bytes(drawing, kind, _PIXELS_PER_MM), replace=True)


def costs_drawing(
    mean_us: NDArray[np.float64],
    step_mm: float,
    title: str,
    frame_us: NDArray[np.float64],
) -> InkDrawing:
    """Make the drawing of `draw_costs`, whose arguments it has.

    Raises
    ------
    InputError
        If no square has a time.
    """
    known = mean_us[np.isfinite(mean_us)]
    if not known.size:
        raise InputError(
            f"no frame was on the canvas, so that there is nothing to draw; choose another "
            f"{setting('path')}"
        )
    low, high = float(known.min()), float(known.max())
    rows, columns = mean_us.shape
    scale = _LONGEST_MM / (max(rows, columns) * step_mm)
    width, height = columns * step_mm * scale, rows * step_mm * scale
    top, left = _HEAD_MM, _MARGIN_MM
    ramp_left = left + width + 6.0
    bars_left = ramp_left + _RAMP_MM + 20.0
    right = bars_left + _BARS_MM + 6.0
    bottom = top + max(height, _LEAST_HIGH_MM)
    grays = _grays(mean_us, low, high)
    edge = np.array(
        [(left, top), (left + width, top), (left + width, top + height), (left, top + height)]
    )
    marks: tuple[InkMark, ...] = (
        InkText(f"{title}: time of a frame", (left, 5.0), 3.6),
        InkRaster(grays, (left, top), width, height),
        InkLine((edge,), _HAIR_MM, closed=True),
        *_bar_of_mm(left, top + height + 3.0, scale, columns * step_mm),
        *_ramp(ramp_left, top, low, high),
        *_histogram(frame_us, bars_left, top),
    )
    words = costs_words(mean_us, step_mm)
    return InkDrawing(
        right, bottom + _BELOW_MM, marks, f"{title}: time of a frame", "; ".join(words)
    )


def costs_words(mean_us: NDArray[np.float64], step_mm: float) -> list[str]:
    """Tell what a map of costs shows, a line for each thing; `costs_drawing` has the arguments."""
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


def _grays(values: NDArray[np.float64], low: float, high: float) -> NDArray[np.uint8]:
    """Grays of costs, darker for more; white for what is not known."""
    shares = (values - low) / ((high - low) or 1.0)
    grays = _PALEST + (_DARKEST - _PALEST) * shares
    return np.where(np.isfinite(values), np.nan_to_num(grays), 255).round().astype(np.uint8)


def _bar_of_mm(left: float, top: float, scale: float, width_mm: float) -> Iterator[InkMark]:
    length = tick_mm(width_mm)
    yield InkLine((np.array([(left, top), (left + length * scale, top)]),), 0.8, round_ends=False)
    yield InkText(f"{length:g} mm", (left, top + 4.0), 2.8)


def _ramp(left: float, top: float, low: float, high: float) -> Iterator[InkMark]:
    """Draw the scale of grays, the highest cost above."""
    pixels = np.linspace(_DARKEST, _PALEST, 64).round().astype(np.uint8)[:, None]
    yield InkRaster(pixels, (left, top), _RAMP_MM, _LEAST_HIGH_MM)
    for share in (0.0, 0.5, 1.0):
        y = top + (1.0 - share) * (_LEAST_HIGH_MM - 2.5) + 2.3
        yield InkText(f"{low + share * (high - low):.3g} µs", (left + _RAMP_MM + 1.0, y), 2.8)


def _histogram(times: NDArray[np.float64], left: float, top: float) -> Iterator[InkMark]:
    low, high = float(times.min()), float(times.max())
    counts, edges = np.histogram(times, bins=_BARS, range=(low, max(high, low + 1e-3)))
    base, wide = top + _LEAST_HIGH_MM, _BARS_MM / _BARS
    tallest = _LEAST_HIGH_MM / counts.max()
    bars = []
    for number, count in enumerate(counts.tolist()):
        if count:
            x, y = left + number * wide, base - count * tallest
            bars.append(np.array([(x, base), (x, y), (x + 0.9 * wide, y), (x + 0.9 * wide, base)]))
    yield InkArea(tuple(bars), 0.3)
    yield InkLine((np.array([(left, base), (left + _BARS_MM, base)]),), _HAIR_MM)
    yield InkText(f"{edges[0]:.3g} µs", (left, base + 4.0), 2.8)
    yield InkText(f"{edges[-1]:.3g} µs", (left + _BARS_MM, base + 4.0), 2.8, centered=True)
    share = f"{counts.max() / times.size:.0%}"
    yield InkText(f"tallest bar: {share} of all", (left, base + 8.0), 2.8)
