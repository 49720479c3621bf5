"""Deflection maps with more on them: the array at a place (Lévesque 2009, fig. 8.3), axes in mm."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.errors import InputError
from vbraille.pictures.ink import InkArea, InkDrawing, InkLine, InkRaster, InkText, shifted
from vbraille.pictures.scenes import grays
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.pictures.ink import InkMark
    from vbraille.render.scene.assets import Assets
    from vbraille.scene.scene import Canvas, Scene

_LEFT_MM, _TOP_MM, _SPARE_MM = 11.0, 2.0, 3.0  # margins of a picture with axes
_BELOW_MM = 9.0
_TICKS_MM = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0)
_MOST_TICKS = 12
_BAR_SHARES = 0.3, 0.7  # of the pitches, where the size of contactors is not known
_HAIR_MM = 0.15
# How far a bar is drawn from the middle of its place to either side, as a share of the pitch: as
# far as bars can go without touching; true deflections would be too small to be seen.
_SHIFT = 0.3


class ArrayPlace(NamedTuple):
    """Where an array stands on a picture: its centre in mm, and how far it is turned, in degrees.

    The angle turns it against the clock, as in `vbraille.pose`.
    """

    x_mm: float
    y_mm: float
    angle_deg: float = 0.0


def actuators_mm(display: Display, place: ArrayPlace) -> NDArray[np.float64]:
    """Places of an array's actuators on the canvas, by the convention of `vbraille.pose`.

    Returns
    -------
    float64[rows, columns, 2]
        x and y in mm.
    """
    right = display.column_offsets_mm() - display.span_mm / 2
    down = display.row_offsets_mm() - display.depth_mm / 2
    return _turned(np.stack(np.meshgrid(right, down), axis=-1), place)


def check_on_canvas(canvas: Canvas, display: Display, place: ArrayPlace) -> None:
    """Check that all actuators of an array are on a canvas.

    Raises
    ------
    InputError
        If one is not, or the place is no number.
    """
    values = (place.x_mm, place.y_mm, place.angle_deg)
    x, y = np.moveaxis(actuators_mm(display, place), -1, 0)
    inside = (x >= 0) & (x <= canvas.width_mm) & (y >= 0) & (y <= canvas.height_mm)
    if not (all(map(math.isfinite, values)) and inside.all()):
        raise InputError(
            f"the array is not on the canvas at {place.x_mm:g},{place.y_mm:g}: {setting('array')} "
            f"is its centre, and all of it must be from 0,0 to "
            f"{canvas.width_mm:g},{canvas.height_mm:g} mm"
        )


def array_deflections(
    scene: Scene, assets: Assets, display: Display, place: ArrayPlace, time_s: float
) -> NDArray[np.float64]:
    """Deflections of the actuators of an array that stands on a scene.

    Parameters
    ----------
    scene, assets
        A resolved scene, and what it takes from image files and labels.
    display, place
        The array, and where it is.
    time_s
        Time for what vibrates or moves.

    Returns
    -------
    float64[rows, columns]
        Deflections from 0 to 1.
    """
    from vbraille.render.scene.canvas import SceneMap  # loads the kernels

    drawn = SceneMap(scene, assets)
    places, frame = actuators_mm(display, place), np.empty(display.shape)
    for (row, column), _ in np.ndenumerate(frame):
        x, y = places[row, column]
        parity = (row + column) % 2
        frame[row, column] = drawn.deflections(
            np.array([x]), np.array([y]), time_s=time_s, parity=parity
        )[0, 0]
    return frame


def array_marks(
    display: Display, place: ArrayPlace, deflections: NDArray[np.floating]
) -> tuple[InkMark, ...]:
    """Draw an array: a frame, and a bar for each contactor, shifted by its deflection.

    A bar at rest stands as far to the side of rest as it can, one at full swing as far to the
    other, with a line where the middle is; the shift is larger than the true one.

    Parameters
    ----------
    display, place
        The array, and where it is.
    deflections : floating[rows, columns]
        Deflections from 0 to 1.
    """
    wide, tall = display.contactor_mm or (
        _BAR_SHARES[0] * display.column_pitch_mm,
        _BAR_SHARES[1] * display.row_pitch_mm,
    )
    side = 1.0 if display.rest_side == "right" else -1.0
    shifts = side * _SHIFT * display.column_pitch_mm * (1.0 - 2.0 * deflections)
    wide = min(wide, 0.4 * display.column_pitch_mm)
    edge = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    half = np.array(
        [display.span_mm + 1.4 * display.column_pitch_mm, display.depth_mm + tall + 0.8]
    )
    frame = _turned(edge * half / 2, place)
    bars, middles = [], []
    rows, columns = display.shape
    for row, column in np.ndindex(rows, columns):
        x = column * display.column_pitch_mm - display.span_mm / 2
        y = row * display.row_pitch_mm - display.depth_mm / 2
        bar = np.array([x + shifts[row, column], y]) + edge * np.array([wide, tall]) / 2
        bars.append(_turned(bar, place))
        middle = np.array([(x, y - tall / 2), (x, y + tall / 2)])
        middles.append(_turned(middle, place))
    return (
        InkLine((frame,), 4 * _HAIR_MM, gray=1.0, closed=True),
        InkLine((frame,), 2 * _HAIR_MM, closed=True),
        InkLine(tuple(middles), _HAIR_MM, gray=0.5, round_ends=False),
        InkLine(tuple(bars), 2 * _HAIR_MM, gray=1.0, closed=True),
        InkArea(tuple(bars), gray=0.0),
    )


def map_drawing(
    scene: Scene,
    deflections: NDArray[np.floating],
    over: tuple[InkMark, ...] = (),
    *,
    axes: bool = False,
) -> InkDrawing:
    """Make a drawing of a deflection map, with something over it and axes if they are wanted.

    Parameters
    ----------
    scene
        The scene, for its canvas and its words.
    deflections : floating[rows, columns]
        Deflections of the scene.
    over
        Marks in mm of the canvas.
    axes
        Whether there are axes in mm and a scale bar.
    """
    canvas = scene.canvas
    raster = InkRaster(grays(deflections), (0.0, 0.0), canvas.width_mm, canvas.height_mm)
    marks, width, height = (raster, *over), canvas.width_mm, canvas.height_mm
    if axes:
        width, height = width + _LEFT_MM + _SPARE_MM, height + _TOP_MM + _BELOW_MM
        moved = (shifted(mark, (_LEFT_MM, _TOP_MM)) for mark in marks)
        marks = (*moved, *_axes(canvas))
    return InkDrawing(width, height, marks, title=scene.title, description=scene.description)


def _axes(canvas: Canvas) -> Iterator[InkMark]:
    """Draw the canvas's edge, ticks with their numbers at the left and below, and a scale bar."""
    left, top = _LEFT_MM, _TOP_MM
    right, bottom = left + canvas.width_mm, top + canvas.height_mm
    edge = np.array([(left, top), (right, top), (right, bottom), (left, bottom)])
    yield InkLine((edge,), _HAIR_MM, closed=True)
    step = tick_mm(max(canvas.width_mm, canvas.height_mm))
    ticks = []
    for along in np.arange(0.0, canvas.width_mm + 1e-9, step).tolist():
        ticks.append(np.array([(left + along, bottom), (left + along, bottom + 1.0)]))
        yield InkText(f"{along:g}", (left + along, bottom + 4.0), 2.5, centered=True)
    for down in np.arange(0.0, canvas.height_mm + 1e-9, step).tolist():
        ticks.append(np.array([(left - 1.0, top + down), (left, top + down)]))
        yield InkText(f"{down:g}", (left - 5.0, top + down + 0.9), 2.5, centered=True)
    yield InkLine(tuple(ticks), _HAIR_MM, round_ends=False)
    bar = np.array([(left, bottom + 6.5), (left + step, bottom + 6.5)])
    yield InkLine((bar,), 0.8, round_ends=False)
    yield InkText(f"{step:g} mm", (left + step + 1.5, bottom + 7.4), 2.5)


def tick_mm(length_mm: float) -> float:
    """Distance of ticks along an axis, a round number of mm with at most a dozen ticks."""
    fits = (tick for tick in _TICKS_MM if length_mm / tick <= _MOST_TICKS)
    return next(fits, _TICKS_MM[-1])


def _turned(offsets_mm: NDArray[np.floating], place: ArrayPlace) -> NDArray[np.float64]:
    """Turn offsets from the array's centre, and put them on the canvas; float64[…, 2] both."""
    angle = math.radians(place.angle_deg)
    cosine, sine = math.cos(angle), math.sin(angle)
    x, y = offsets_mm[..., 0], offsets_mm[..., 1]
    return np.stack(
        [place.x_mm + x * cosine + y * sine, place.y_mm + y * cosine - x * sine], axis=-1
    )
