"""The numbers behind the map of what the Tactograph resolves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.carriers import design, tactograph
from vbraille.pictures.table import FigureTable

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Grid of the map, whose steps are some 5 mm, and ratios b / a for which arms are made.
_ACROSS, _DOWN = 57, 44
_RATIOS = np.arange(30, 121) / 100
_UM_PER_MM = 1000.0


def resolution() -> FigureTable:
    """Compute how finely the Tactograph measures over its page, and how other arms would.

    Lévesque 2009, figs. 7.10 and 7.11 with eqs. 7.4 and A.65-A.74, for counts of 19.8″, as the
    source rounds them: an error of one count in one or both joints moves the array by so much at
    most.

    Returns
    -------
    Table
        ``what`` is place or ratio. A place has ``x_mm`` and ``y_mm`` from the first joint (x to the
        right, y over the tray), ``resolution_um``, and ``on_canvas``, 1 where the array can go
        with its larger disc. A ratio has ``ratio`` b / a, ``first_arm_mm``, the shortest first
        arm that reaches the page, and ``best_um`` and ``worst_um``, the resolution at the nearest
        and the farthest place of the page. What a row does not have is NaN.
    """
    width_mm, height_mm = tactograph.PAGE_MM
    x_mm, y_mm = (
        places.ravel()
        for places in np.meshgrid(
            np.linspace(-width_mm / 2, width_mm / 2, _ACROSS),
            tactograph.NEAR_MM + np.linspace(0, height_mm, _DOWN),
        )
    )
    error_mm = design.error_mm(tactograph.ARMS, np.hypot(x_mm, y_mm), design.PRINTED_COUNT_RAD)
    left_mm, far_mm = tactograph.arms_at(0.0, 0.0)
    right_mm, near_mm = tactograph.arms_at(tactograph.WIDTH_MM, tactograph.HEIGHT_MM)
    on_canvas = (x_mm >= left_mm) & (x_mm <= right_mm) & (y_mm >= far_mm) & (y_mm <= near_mm)
    made = [
        design.span(design.shortest(float(ratio)), count_rad=design.PRINTED_COUNT_RAD)
        for ratio in _RATIOS
    ]
    of_places = {
        "x_mm": x_mm,
        "y_mm": y_mm,
        "resolution_um": error_mm * _UM_PER_MM,
        "on_canvas": on_canvas.astype(np.float64),
    }
    of_ratios = {
        "ratio": _RATIOS,
        "first_arm_mm": np.array([span.arms.first_mm for span in made]),
        "best_um": np.array([span.best_mm for span in made]) * _UM_PER_MM,
        "worst_um": np.array([span.worst_mm for span in made]) * _UM_PER_MM,
    }
    columns: dict[str, NDArray] = {"what": np.repeat(["place", "ratio"], [x_mm.size, len(made)])}
    for name, values in of_places.items():
        columns[name] = np.concatenate((values, np.full(len(made), np.nan)))
    for name, values in of_ratios.items():
        columns[name] = np.concatenate((np.full(x_mm.size, np.nan), values))
    arms = tactograph.ARMS
    title = f"Tactograph: arms of {arms.first_mm:g} and {arms.second_mm:g} mm, counts of 19.8″"
    return FigureTable("resolution", title, columns)


def resolution_words() -> list[str]:
    """What the map shows, in lines for who does not see it."""
    arms, count_rad = tactograph.ARMS, design.PRINTED_COUNT_RAD
    width_mm, height_mm = tactograph.PAGE_MM
    whole = design.span(arms, count_rad=count_rad)
    half_mm = tactograph.WIDTH_MM / 2
    _, near_mm = tactograph.arms_at(0.0, 0.0)
    far_mm = float(np.hypot(half_mm, near_mm + tactograph.HEIGHT_MM))
    best_mm, worst_mm = design.error_mm(arms, np.array([near_mm, far_mm]), count_rad)
    near = design.best_ratio(lambda span: span.best_mm, count_rad=count_rad)
    far = design.best_ratio(lambda span: span.worst_mm, count_rad=count_rad)
    return [
        f"over a page of {width_mm:g} × {height_mm:g} mm: {_um(whole.best_mm)} µm at the middle of "
        f"its far side, next to the first joint, to {_um(whole.worst_mm)} µm at its near corners",
        f"over the canvas of {tactograph.WIDTH_MM:g} × {tactograph.HEIGHT_MM:g} mm: "
        f"{_um(float(best_mm))} to {_um(float(worst_mm))} µm",
        "where it is alike: on arcs round the first joint, worse with the distance",
        f"finest at the nearest place: {_um(near.best_mm)} µm, with a second arm "
        f"{near.arms.ratio:.2f} times as long as a first arm of {near.arms.first_mm:.2f} mm",
        f"finest at the farthest place: {_um(far.worst_mm)} µm, with a second arm "
        f"{far.arms.ratio:.2f} times as long as a first arm of {far.arms.first_mm:.2f} mm",
    ]


def _um(error_mm: float) -> str:
    return f"{error_mm * _UM_PER_MM:.1f}"
