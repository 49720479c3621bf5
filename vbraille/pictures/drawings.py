"""Drawings of scenes, true to scale: maps with axes, outlines, and maps of what frames cost."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple
from xml.sax.saxutils import escape

import numpy as np
from matplotlib.collections import PathCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

from vbraille.errors import InputError
from vbraille.pictures.figurefiles import styled, to_bytes
from vbraille.pictures.scenes import grays, map_places
from vbraille.pictures.words import plain
from vbraille.scene.traversal import vibrations
from vbraille.wording import setting

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.render.labels import Assets
    from vbraille.scene.scene import Canvas, Scene


KINDS = ("svg", "pdf", "png")
MM_PER_INCH = 25.4
_POINTS_PER_MM = 72 / MM_PER_INCH
# Margins of a picture with axes, in mm: left, right, above and below.
_MARGINS_MM = 11.0, 3.0, 2.0, 9.0
_BAR_SHARES = 0.3, 0.7  # of the pitches, where the size of contactors is not known
_HAIR_MM = 0.15
# How far a bar is drawn from the middle of its place to either side, as a share of the pitch: as
# far as bars can go without touching; true deflections would be too small to be seen.
_SHIFT = 0.3
_OUTLINE_PER_MM, _OUTLINE_PIXELS = 8.0, 4_200_000
_BAND_ROWS = 256
# Times over a swing of 50 Hz, the fastest that there is: what vibrates is up at one of them.
_UP_S = (0.0, 0.005, 0.01, 0.015)


class ArrayPlace(NamedTuple):
    """Place of an array on a picture: its centre in mm, and how far it is turned, in degrees.

    The angle turns it against the clock, as in `vbraille.display`.
    """

    x_mm: float
    y_mm: float
    angle_deg: float = 0.0


class ArrayOnMap(NamedTuple):
    """An array on a map.

    Parameters
    ----------
    display, place
        The array, and where it is.
    deflections : float64[rows, columns]
        Deflections of its actuators, from 0 to 1.
    """

    display: Display
    place: ArrayPlace
    deflections: NDArray[np.float64]


def actuators_mm(display: Display, place: ArrayPlace) -> NDArray[np.float64]:
    """Places of an array's actuators on the canvas, by the convention of `vbraille.display`.

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
    x, y = np.moveaxis(actuators_mm(display, place), -1, 0)
    inside = (x >= 0) & (x <= canvas.width_mm) & (y >= 0) & (y <= canvas.height_mm)
    if not (all(map(math.isfinite, place)) and inside.all()):
        raise InputError(
            f"the array is not on the canvas at {place.x_mm:g},{place.y_mm:g}: {setting('array')} "
            f"is its centre, and all of it must be from 0,0 to "
            f"{canvas.width_mm:g},{canvas.height_mm:g} mm"
        )


def show_array(
    scene: Scene, assets: Assets, display: Display, place: ArrayPlace, time_s: float
) -> ArrayOnMap:
    """Put an array on a scene.

    Parameters
    ----------
    scene, assets
        A resolved scene, and what it takes from image files and labels.
    display, place
        The array, and where it is.
    time_s
        Time for what vibrates or moves.
    """
    from vbraille.render.compiling import SceneMap  # loads the kernels

    drawn = SceneMap(scene, assets)
    places, frame = actuators_mm(display, place), np.empty(display.shape)
    for (row, column), _ in np.ndenumerate(frame):
        x, y = places[row, column]
        frame[row, column] = drawn.deflections(
            np.array([x]), np.array([y]), time_s=time_s, parity=(row + column) % 2
        )[0, 0]
    return ArrayOnMap(display, place, frame)


def bars_mm(shown: ArrayOnMap) -> NDArray[np.float64]:
    """Corners of the bars that stand for contactors, shifted by their deflections.

    A bar at rest stands as far to the side of rest as it can, one at full swing as far to the
    other; the shift is larger than the true one.

    Returns
    -------
    float64[rows × columns, 4, 2]
        x and y in mm.
    """
    display = shown.display
    wide, tall = _bar_size_mm(display)
    side = 1.0 if display.rest_side == "right" else -1.0
    shifts = side * _SHIFT * display.column_pitch_mm * (1.0 - 2.0 * shown.deflections)
    right = display.column_offsets_mm() - display.span_mm / 2
    down = display.row_offsets_mm() - display.depth_mm / 2
    middles = np.stack(np.meshgrid(right, down), axis=-1)
    middles[..., 0] += shifts
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * (wide / 2, tall / 2)
    return _turned(middles.reshape(-1, 1, 2) + corners, shown.place)


def map_figure(
    canvas: Canvas,
    deflections: NDArray[np.floating],
    array: ArrayOnMap | None = None,
    *,
    axes: bool = False,
) -> Figure:
    """Draw a deflection map true to scale, with what is wanted over it and around it.

    Parameters
    ----------
    canvas
        The canvas that the map covers.
    deflections : floating[rows, columns]
        Deflections of the scene.
    array
        An array over the map.
    axes
        Whether there are axes in mm.
    """
    figure, place = _sheet(canvas, _MARGINS_MM if axes else (0.0, 0.0, 0.0, 0.0))
    place.set_axis_on()
    for spine in place.spines.values():
        spine.set_visible(axes)
    if not axes:
        place.set_axis_off()
    place.tick_params(labelsize=7)
    if axes:
        place.set_xlabel("mm", fontsize=7, loc="right", labelpad=1)
    place.imshow(
        np.repeat(grays(deflections)[..., None], 3, axis=2),  # which is drawn as it is
        alpha=1.0,  # without which a PNG of it takes twice the memory
        extent=(0, canvas.width_mm, canvas.height_mm, 0),
        interpolation="none",
        aspect="auto",
    )
    if array is not None:
        _draw_array(place, array)
    return figure


def outline_figure(scene: Scene, assets: Assets) -> Figure:
    """Draw what is felt in black on white, for eyes and for paper that swells where it is black.

    Black is where a finger feels more than half of the scene's strongest deflection, with all that
    vibrates up. Strokes that meet are joined, since the drawing follows what is felt.

    Parameters
    ----------
    scene, assets
        A resolved scene, and what it takes from image files and labels.
    """
    canvas = scene.canvas
    figure, place = _sheet(canvas, (0.0, 0.0, 0.0, 0.0))
    contours = felt_contours(scene, assets)
    if contours:
        # Contours of holes run the other way round, so that one filled path leaves the holes.
        whole = Outline.make_compound_path(*(Outline(c, closed=True) for c in contours))
        # Not `add_patch`, which looks for the limits of the axes at each point of it.
        place.add_artist(PathPatch(whole, facecolor="black", edgecolor="none"))
    return figure


def felt_contours(scene: Scene, assets: Assets) -> list[NDArray[np.float64]]:
    """Closed lines in mm around what is felt at more than half of the strongest deflection.

    Returns
    -------
    list of float64[n, 2]
        Contours; those of holes run the other way round.
    """
    from vbraille.render.compiling import SceneMap  # loads the kernels

    canvas = scene.canvas
    area = canvas.width_mm * canvas.height_mm
    per_mm = min(_OUTLINE_PER_MM, math.sqrt(_OUTLINE_PIXELS / area))
    x, y = map_places(canvas, per_mm)
    drawn = SceneMap(scene, assets)
    vibrates = any(True for element in scene.elements for _ in vibrations(element))
    # A rim at rest closes what goes beyond the canvas, at its edge.
    rimmed = np.zeros((y.size + 2, x.size + 2), np.float32)
    felt = rimmed[1:-1, 1:-1]
    for time_s in _UP_S if vibrates else _UP_S[:1]:
        np.maximum(felt, drawn.deflections(x, y, time_s=time_s, parity=0), out=felt)
    strongest = float(felt.max())
    if strongest <= 0:
        return []
    step = 1 / per_mm
    x, y = (np.concatenate([[at[0] - step], at, [at[-1] + step]]) for at in (x, y))
    # A plateau at exactly the half would be all steps of rounding.
    lines = _contours(x, y, rimmed, 0.51 * strongest)
    edge = np.array([canvas.width_mm, canvas.height_mm])
    return [np.clip(line, 0.0, edge) for line in lines]


def _contours(
    x: NDArray[np.float64], y: NDArray[np.float64], values: NDArray[np.floating], level: float
) -> list[NDArray[np.float64]]:
    """Closed lines of a level, which the rim of the values is below: float64[n, 2] each.

    They are found in bands of rows, since the library takes three numbers of eight bytes a value.
    Lines that go from one band into the next end there at the same place in both.
    """
    from contourpy import contour_generator

    closed: list[NDArray[np.float64]] = []
    begun: dict[tuple[float, float], list[NDArray[np.float64]]] = {}
    for first in range(0, y.size - 1, _BAND_ROWS):
        rows = slice(first, first + _BAND_ROWS + 1)
        for found in contour_generator(x, y[rows], values[rows]).lines(level):
            line = np.asarray(found)
            if (line[0] == line[-1]).all():
                closed.append(line)
            else:
                begun.setdefault(tuple(line[0]), []).append(line)
    while begun:
        first_place = next(iter(begun))
        parts: list[NDArray[np.float64]] = []
        place = first_place
        while not parts or place != first_place:
            several = begun[place]
            parts.append(several.pop())
            if not several:
                del begun[place]
            place = tuple(parts[-1][-1])
        closed.append(np.concatenate(parts))
    return closed


def drawing_bytes(
    figure: Figure, kind: str, pixels_per_mm: float, title: str, description: str
) -> bytes:
    """Make the file of a drawing, with its title and description in it.

    Parameters
    ----------
    figure
        The drawing.
    kind
        What the file is, one of `KINDS`.
    pixels_per_mm
        Resolution of a PNG.
    title, description
        What it shows, in a word and in sentences; in an SVG screen readers say them.
    """
    title, description = plain(title), plain(description)
    about = "Subject" if kind == "pdf" else "Description"
    told = {key: text for key, text in (("Title", title), (about, description)) if text.strip()}
    content = to_bytes(figure, kind, told, pixels_per_mm * MM_PER_INCH)
    if kind != "svg":
        return content
    words = (
        f' role="img" aria-labelledby="title description">\n <title id="title">{escape(title)}'
        f'</title>\n <desc id="description">{escape(description)}</desc>'
    )
    end = content.index(b">", content.index(b"<svg "))
    return content[:end] + words.encode() + content[end + 1 :]


def _sheet(canvas: Canvas, margins_mm: tuple[float, float, float, float]) -> tuple[Figure, Axes]:
    """Make paper of the canvas's size and its margins, with axes in mm of the canvas, y down."""
    left, right, above, below = margins_mm
    width, height = canvas.width_mm + left + right, canvas.height_mm + above + below
    with styled():
        figure = Figure(figsize=(width / MM_PER_INCH, height / MM_PER_INCH), facecolor="white")
        figure.set_layout_engine("none")
        axes = figure.add_axes(
            (left / width, below / height, canvas.width_mm / width, canvas.height_mm / height)
        )
    axes.set_axis_off()
    axes.set(xlim=(0, canvas.width_mm), ylim=(canvas.height_mm, 0), aspect="auto")
    return figure, axes


def _draw_array(axes: Axes, shown: ArrayOnMap) -> None:
    """Draw a frame, a line in the middle of each contactor's place, and the bars."""
    display, place = shown.display, shown.place
    _, tall = _bar_size_mm(display)
    half = np.array(
        [display.span_mm + 1.4 * display.column_pitch_mm, display.depth_mm + tall + 0.8]
    )
    frame = _turned(np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half / 2, place)
    ends = actuators_mm(display, ArrayPlace(0, 0)).reshape(-1, 1, 2)
    middles = _turned(ends + np.array([(0, -tall / 2), (0, tall / 2)]), place)
    bars = bars_mm(shown)
    hair = _HAIR_MM * _POINTS_PER_MM
    for color, width in (("white", 4 * hair), ("black", 2 * hair)):
        axes.add_collection(PolyCollection([frame], facecolors="none", edgecolors=color, lw=width))
    lines = [Outline(line) for line in middles]
    axes.add_collection(PathCollection(lines, facecolors="none", edgecolors="0.5", linewidths=hair))
    axes.add_collection(
        PolyCollection([*bars], facecolors="black", edgecolors="white", lw=2 * hair)
    )


def _bar_size_mm(display: Display) -> tuple[float, float]:
    wide, tall = display.contactor_mm or (
        _BAR_SHARES[0] * display.column_pitch_mm,
        _BAR_SHARES[1] * display.row_pitch_mm,
    )
    return min(wide, 0.4 * display.column_pitch_mm), tall


def _turned(offsets_mm: NDArray[np.floating], place: ArrayPlace) -> NDArray[np.float64]:
    """Turn offsets from the array's centre, and put them on the canvas; float64[…, 2] both."""
    angle = math.radians(place.angle_deg)
    cosine, sine = math.cos(angle), math.sin(angle)
    x, y = offsets_mm[..., 0], offsets_mm[..., 1]
    return np.stack(
        [place.x_mm + x * cosine + y * sine, place.y_mm + y * cosine - x * sine], axis=-1
    )
