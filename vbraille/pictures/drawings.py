"""Drawings of scenes, true to scale: maps with rulers and an array, and outlines."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

from vbraille.errors import InputError
from vbraille.pictures.figurefiles import styled
from vbraille.pictures.scenes import MM_PER_INCH, grays, map_places
from vbraille.scene.traversal import vibrations
from vbraille.wording import setting

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.render.labels import Assets
    from vbraille.scene.scene import Canvas, Scene

# Margins of a picture with rulers, in mm: left, right, above and below.
_MARGINS_MM = 11.0, 3.0, 2.0, 9.0
_BAR_SHARES = 0.3, 0.7  # of the pitches, where the size of contactors is not known
_LINE_POINTS = 0.8
# How far a bar is drawn from the middle of its place to either side, as a share of the pitch: as
# far as bars can go without touching; true deflections would be too small to be seen.
_SHIFT = 0.3
_CORNERS = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
# Most pixels that outlines are found from; the library takes 24 bytes for each.
_OUTLINE_PER_MM, _OUTLINE_PIXELS = 8.0, 2_500_000
# Times over a swing of 50 Hz, the fastest that there is: what vibrates is up at one of them.
_UP_S = (0.0, 0.005, 0.01, 0.015)


class ArrayOnMap(NamedTuple):
    """An array on a map.

    Parameters
    ----------
    display
        The array.
    x_mm, y_mm, angle_deg
        Place of its centre, and how far it is turned against the clock, as in `vbraille.display`.
    deflections : float[rows, columns]
        Deflections of its actuators, from 0 to 1.
    """

    display: Display
    x_mm: float
    y_mm: float
    angle_deg: float
    deflections: NDArray[np.floating]

    def placed(self, offsets_mm: NDArray[np.float64]) -> NDArray[np.float64]:
        """Turn offsets from the array's centre, and put them on the canvas; float64[…, 2] both."""
        angle = math.radians(self.angle_deg)
        turn = np.array([(math.cos(angle), -math.sin(angle)), (math.sin(angle), math.cos(angle))])
        return offsets_mm @ turn + (self.x_mm, self.y_mm)

    def actuators_mm(self) -> NDArray[np.float64]:
        """Offsets of the actuators from the centre; float64[rows × columns, 2]."""
        right = self.display.column_offsets_mm() - self.display.span_mm / 2
        down = self.display.row_offsets_mm() - self.display.depth_mm / 2
        return np.stack(np.meshgrid(right, down), axis=-1).reshape(-1, 2)

    def bars_mm(self) -> NDArray[np.float64]:
        """Corners of the bars that stand for contactors, shifted by their deflections.

        A bar at rest stands as far to the side of rest as it can, one at full swing as far to the
        other; the shift is larger than the true one.

        Returns
        -------
        float64[rows × columns, 4, 2]
            x and y in mm.
        """
        display = self.display
        wide, tall = display.contactor_mm or (
            _BAR_SHARES[0] * display.column_pitch_mm,
            _BAR_SHARES[1] * display.row_pitch_mm,
        )
        side = 1.0 if display.rest_side == "right" else -1.0
        middles = self.actuators_mm()
        middles[:, 0] += (
            side * _SHIFT * display.column_pitch_mm * (1 - 2 * self.deflections.ravel())
        )
        size = min(wide, 0.4 * display.column_pitch_mm), tall
        return self.placed(middles[:, None] + _CORNERS * size)


def check_on_canvas(canvas: Canvas, shown: ArrayOnMap) -> None:
    """Check that all actuators of an array are on a canvas.

    Raises
    ------
    InputError
        If one is not.
    """
    places = shown.placed(shown.actuators_mm())
    size = canvas.width_mm, canvas.height_mm
    if not ((places >= 0) & (places <= size)).all():
        raise InputError(
            f"the array is not on the canvas at {shown.x_mm:g},{shown.y_mm:g}: {setting('array')} "
            f"is its centre, and all of it must be from 0,0 to {size[0]:g},{size[1]:g} mm"
        )


def map_figure(
    canvas: Canvas,
    deflections: NDArray[np.floating],
    array: ArrayOnMap | None = None,
    *,
    rulers: tuple[float, float, float, float] | None = None,
    unit: str = "mm",
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
    rulers
        Numbers of the rulers at the left, right, bottom and top; None for no rulers.
    unit
        Unit of the rulers.
    """
    size = 0.0, canvas.width_mm, canvas.height_mm, 0.0
    figure, axes = _sheet(canvas, _MARGINS_MM if rulers else (0.0, 0.0, 0.0, 0.0))
    if rulers:
        axes.set_axis_on()
        axes.spines[:].set_visible(True)
        axes.tick_params(labelsize=7)
        axes.set_xlabel(unit, fontsize=7, loc="right", labelpad=1)
    left, right, bottom, top = rulers or size
    axes.set(xlim=(left, right), ylim=(bottom, top))
    axes.imshow(
        np.repeat(grays(deflections)[..., None], 3, axis=2),  # which is drawn as it is
        alpha=1.0,  # without which a PNG of it takes twice the memory
        extent=(left, right, bottom, top),
        interpolation="none",
        aspect="auto",
    )
    if array is not None:
        display = array.display
        around = (
            display.span_mm + 1.4 * display.column_pitch_mm,
            display.depth_mm + (1.4 * display.row_pitch_mm),
        )
        for polygons, fill, edge, width in (
            ([array.placed(_CORNERS * around)], "none", "white", 2 * _LINE_POINTS),
            ([array.placed(_CORNERS * around)], "none", "black", _LINE_POINTS),
            ([*array.bars_mm()], "black", "white", _LINE_POINTS),
        ):
            axes.add_collection(
                PolyCollection(polygons, facecolors=fill, edgecolors=edge, lw=width)
            )
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
    figure, axes = _sheet(scene.canvas, (0.0, 0.0, 0.0, 0.0))
    contours = felt_contours(scene, assets)
    if contours:
        # Contours of holes run the other way round, so that one filled path leaves the holes.
        whole = Outline.make_compound_path(*(Outline(c, closed=True) for c in contours))
        # Not `add_patch`, which looks for the limits of the axes at each point of it.
        axes.add_artist(PathPatch(whole, facecolor="black", edgecolor="none"))
    return figure


def felt_contours(scene: Scene, assets: Assets) -> list[NDArray[np.float64]]:
    """Closed lines in mm around what is felt at more than half of the strongest deflection.

    Returns
    -------
    list of float64[n, 2]
        Contours; those of holes run the other way round.
    """
    from contourpy import contour_generator

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
    x, y = (np.concatenate([[at[0] - 1 / per_mm], at, [at[-1] + 1 / per_mm]]) for at in (x, y))
    # A plateau at exactly the half would be all steps of rounding.
    lines = contour_generator(x, y, rimmed).lines(0.51 * strongest)
    edge = canvas.width_mm, canvas.height_mm
    return [np.clip(np.asarray(line), 0.0, edge) for line in lines]


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
