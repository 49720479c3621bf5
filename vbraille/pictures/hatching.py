"""Textures as lines and dots of ink, true to scale in direction and wavelength.

A ridge is drawn where it is above half of its height, which is half of its length wide in its
middle (eq. 8.4 of Lévesque 2009). Where blanks would be too narrow for a finger, ridges are left
out, every so many, so that the direction stays right and the wavelength a multiple.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import InputError
from vbraille.pictures.ink import InkArea, InkDiscs, InkLine
from vbraille.pictures.scenewords import wave_angle_deg
from vbraille.scene.fitting import axial_cycle
from vbraille.scene.textures import (
    AxialGrating,
    Gradual,
    LinearGrating,
    RadialGrating,
    TurnPeak,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.pictures.ink import PlainMark
    from vbraille.pictures.looks import InkLook
    from vbraille.scene.scene import Canvas
    from vbraille.scene.textures import Peak

AnyGrating = LinearGrating | RadialGrating | AxialGrating

_MOST_LINES = 20_000
_MOST_DOTS = 50_000
_ROUND_DEG = 3.0  # of the edges that stand for a circle
_POINT_MM = 0.001  # of a dash whose round ends make it a dot
_FINE = 20_001  # places at which a distortion is looked up


def grating_marks(
    grating: AnyGrating, canvas: Canvas, look: InkLook, gray: float
) -> Iterator[PlainMark]:
    """Draw a grating all over a canvas.

    Raises
    ------
    InputError
        If it has more ridges on the canvas than anybody could see.
    """
    if isinstance(grating, LinearGrating):
        return _linear(grating, canvas, look, gray)
    if isinstance(grating, AxialGrating):
        return _axial(grating, canvas, look, gray)
    return _radial(grating, canvas, look, gray)


def vibration_discs(canvas: Canvas, look: InkLook, gray: float) -> InkDiscs:
    """Draw vibration all over a canvas: dots in rows, of which every second one is shifted.

    Raises
    ------
    InputError
        If there would be more dots than anybody could see.
    """
    pitch = look.dot_mm + look.gap_mm if look.raised else 3 * look.dot_mm
    across = np.arange(pitch / 2, canvas.width_mm + pitch, pitch)
    down = np.arange(pitch / 2, canvas.height_mm + pitch, pitch)
    if across.size * down.size > _MOST_DOTS:
        raise InputError(
            f"the canvas of {canvas.width_mm:g} × {canvas.height_mm:g} mm is too large to draw "
            "vibration on it as dots; make a map without --abstract and --raised"
        )
    x, y = np.meshgrid(across, down)
    x[1::2] -= pitch / 2
    return InkDiscs(np.stack([x.ravel(), y.ravel()], axis=-1), look.dot_mm / 2, gray)


def _linear(
    grating: LinearGrating, canvas: Canvas, look: InkLook, gray: float
) -> Iterator[PlainMark]:
    angle = math.radians(wave_angle_deg(grating))
    travel = np.array([math.cos(angle), math.sin(angle)])
    along = np.array([-travel[1], travel[0]])
    start = np.array(grating.start_mm)
    corners = np.array([(x, y) for x in (0.0, canvas.width_mm) for y in (0.0, canvas.height_mm)])
    places, sides = (corners - start) @ travel, (corners - start) @ along
    middles, widths = _ridges(grating, places.min(), places.max(), look)
    ends = np.array([sides.min(), sides.max()])
    for group, width in _by_width(middles, widths):
        lines = start + group[:, None, None] * travel + ends[:, None] * along
        yield _ridge_line(grating, tuple(lines), width, gray, look, closed=False)


def _radial(
    grating: RadialGrating, canvas: Canvas, look: InkLook, gray: float
) -> Iterator[PlainMark]:
    center = np.array(grating.center_mm)
    corners = np.array([(x, y) for x in (0.0, canvas.width_mm) for y in (0.0, canvas.height_mm)])
    farthest = np.hypot(*(corners - center).T).max()
    middles, widths = _ridges(grating, 0.0, farthest, look, least_mm=0.0)
    turns = np.radians(np.arange(0.0, 360.0, _ROUND_DEG))
    ring = np.stack([np.cos(turns), np.sin(turns)], axis=-1)
    for group, width in _by_width(middles, widths):
        rings = tuple(center + radius * ring for radius in group)
        yield _ridge_line(grating, rings, width, gray, look, closed=True)


def _axial(
    grating: AxialGrating, canvas: Canvas, look: InkLook, gray: float
) -> Iterator[PlainMark]:
    cycle = axial_cycle(grating)
    center = np.array(grating.center_mm)
    corners = np.array([(x, y) for x in (0.0, canvas.width_mm) for y in (0.0, canvas.height_mm)])
    farthest = np.hypot(*(corners - center).T).max() * 1.1
    middle, half = cycle.ridge / 2, cycle.ridge / 4
    if grating.inverted:
        middle, half = (cycle.ridge + cycle.length) / 2, cycle.length / 2 - cycle.ridge / 4
    number = max(round(360.0 / cycle.length), 1)
    turns = middle + cycle.length * np.arange(number, dtype=np.float64)
    turns = _warped_back(turns, grating.distortion, 0.0, 360.0)
    # Spokes begin where both they and the blanks between them are wide enough.
    blank = math.radians(max(cycle.length - 2 * half, 0.1))
    first = max(look.line_mm / (2 * math.radians(half)), look.gap_mm / blank, grating.fade_mm[1])
    wedges = []
    for turn in turns[np.isfinite(turns)]:
        edges = np.radians(grating.start_deg + turn + np.array([-half, half]))
        near, far = (
            center + radius * np.stack([np.cos(edges), np.sin(edges)], axis=-1)
            for radius in (first, farthest)
        )
        wedges.append(np.array([near[0], near[1], far[1], far[0]]))
    if wedges and first < farthest:
        yield InkArea(tuple(wedges), gray)


def _ridge_line(
    grating: LinearGrating | RadialGrating,
    contours: tuple[NDArray[np.float64], ...],
    width_mm: float,
    gray: float,
    look: InkLook,
    *,
    closed: bool,
) -> InkLine:
    dashes = None
    if grating.vibration is not None:
        width_mm = min(width_mm, look.dot_mm)
        dashes = dotted(width_mm, look)
    return InkLine(contours, width_mm, gray, closed, dashes, round_ends=dashes is not None)


def dotted(width_mm: float, look: InkLook, length_mm: float | None = None) -> tuple[float, float]:
    """Dashes that are round dots, of lines that vibrate; a whole number of them in a length."""
    pitch_mm = width_mm + max(look.gap_mm, width_mm)
    if length_mm is not None:
        pitch_mm = length_mm / max(math.floor(length_mm / pitch_mm), 1)
    return _POINT_MM, pitch_mm - _POINT_MM


def _ridges(
    grating: LinearGrating | RadialGrating,
    low_mm: float,
    high_mm: float,
    look: InkLook,
    least_mm: float = -math.inf,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Middles of the ridges that are drawn between two places along the wave, and their widths."""
    ridge, length = grating.ridge_mm, grating.ridge_mm + grating.gap_mm
    middle, width = ridge / 2, ridge / 2
    if grating.inverted:
        middle, width = (ridge + length) / 2, length - ridge / 2
    low, high = _warped(np.array([low_mm, high_mm]), grating.distortion)
    numbers = np.arange(
        math.floor((low - middle) / length), math.ceil((high - middle) / length) + 1
    )
    if numbers.size > _MOST_LINES:
        raise InputError(
            f"a grating has {numbers.size} ridges on the canvas, too many to draw them as lines; "
            "make a map without --abstract and --raised"
        )
    places = middle + length * numbers
    edges = places[:, None] + np.array([-width / 2, 0.0, width / 2])
    edges = _warped_back(edges, grating.distortion, low_mm - length, high_mm + length)
    middles, widths = edges[:, 1], np.maximum(edges[:, 2] - edges[:, 0], look.line_mm)
    if look.raised:
        widths = np.minimum(widths, np.maximum(look.line_mm, 2 * look.gap_mm))
    kept, end = [], -math.inf
    for number, (at, wide) in enumerate(zip(middles.tolist(), widths.tolist(), strict=True)):
        if at > least_mm and at - wide / 2 >= end + look.gap_mm:
            kept.append(number)
            end = at + wide / 2
    inside = [n for n in kept if low_mm - length <= middles[n] <= high_mm + length]
    return middles[inside], widths[inside]


def _by_width(
    middles: NDArray[np.float64], widths: NDArray[np.float64]
) -> Iterator[tuple[NDArray[np.float64], float]]:
    """Put ridges together that are of one width, to a hundredth of a mm."""
    rounded = np.maximum(np.round(widths, 2), 0.01)
    for width in np.unique(rounded).tolist():
        yield middles[rounded == width], width


def _warped(x: NDArray[np.float64], distortion: Gradual | Peak | None) -> NDArray[np.float64]:
    """X' of eqs. 8.5 and 8.6 (mended), as an integral of the frequency's factor."""
    if distortion is None:
        return x
    return _bent(x, distortion)


def _bent(x: NDArray[np.float64], distortion: Gradual | Peak | TurnPeak) -> NDArray[np.float64]:
    more = distortion.factor - 1.0
    if isinstance(distortion, Gradual):
        u = np.clip(x - distortion.start_mm, 0.0, None)
        length = distortion.length_mm
        return x + more * np.where(u < length, u * u / (2 * length), u - length / 2)
    if isinstance(distortion, TurnPeak):
        center, length = distortion.center_deg, distortion.length_deg
    else:
        center, length = distortion.center_mm, distortion.length_mm
    u = x - center
    below = np.clip(length + u, 0.0, None) ** 2
    above = 2 * length * length - np.clip(length - u, 0.0, None) ** 2
    return x + more * np.where(u <= 0.0, below, above) / (2 * length)


def _warped_back(
    places: NDArray[np.float64],
    distortion: Gradual | Peak | TurnPeak | None,
    low: float,
    high: float,
) -> NDArray[np.float64]:
    """Where x' has given values; x' grows, and so has an inverse."""
    if distortion is None:
        return places
    x = np.linspace(low, high, _FINE)
    return np.interp(places, _bent(x, distortion), x, left=math.nan, right=math.nan)
