"""Signals against the velocity of the hand, as polar plots: Lévesque 2009, 9.6, figs. 9.9-9.11."""

from __future__ import annotations

import io
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import msgspec
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from vbraille.errors import InputError
from vbraille.pictures.figurefiles import MIDDLE, styled
from vbraille.pictures.scenewords import WAYS, signal_words
from vbraille.pictures.words import plain
from vbraille.scene.scene import Canvas
from vbraille.scene.signals import Direction, Pulse, Speed, Switch, made_of, ordered

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.projections.polar import PolarAxes
    from numpy.typing import NDArray

    from vbraille.scene.scene import Scene
    from vbraille.scene.signals import AnySignal

_SPEEDS, _ANGLES = 61, 144  # of the plot; its last speed is the outer edge
_BEYOND = 1.25  # times the greatest speed at which the signal still changes
_USUAL_MM_S = 20.0  # outer edge of a signal that no speed changes
_TOLD_SPEEDS = 5
_ALIKE = 5e-3  # what words with two decimals do not tell apart
SHEET = Canvas(width_mm=90.0, height_mm=98.0)
_MM_PER_INCH = 25.4


@dataclass(frozen=True, slots=True, eq=False)
class Blending:
    """Values of a signal under a hand that goes on at each velocity.

    Parameters
    ----------
    name
        Name of the signal.
    notes
        Sentences on the signal: how it is made, and what the values leave out.
    speeds_mm_s : float64[s]
        Speeds, from 0 on.
    angles_deg : float64[a]
        Directions of the hand, from +x (right) towards +y (down).
    values : float64[s, a]
        Values, from 0 to 1.
    """

    name: str
    notes: tuple[str, ...]
    speeds_mm_s: NDArray[np.floating]
    angles_deg: NDArray[np.floating]
    values: NDArray[np.float64]


def blending(scene: Scene, name: str, switches: int = 0) -> Blending:
    """Compute a signal of a scene at all velocities of the hand, for a hand that goes on so.

    Parameters
    ----------
    scene
        A resolved scene.
    name
        Name of the signal.
    switches
        States of the switches, as `vbraille.scene.signals.packed` has them.

    Raises
    ------
    InputError
        If there is no such signal, or the hand does not change it.
    """
    from vbraille.render.compiling import SceneMap  # loads the kernels

    signals = scene.signals
    if name not in signals:
        known = ", ".join(map(plain, signals)) or "none"
        raise InputError(f"the picture has no signal {plain(name)!r}; its signals are: {known}")
    within = dict(_within(signals, name))
    answering = [one for one in within.values() if isinstance(one, Speed | Direction)]
    if not answering:
        raise InputError(f"signal {plain(name)!r} does not depend on the velocity of the hand")
    steady = {
        one: Switch(levels=(1.0, 1.0)) if isinstance(signal, Pulse) else signal
        for one, signal in signals.items()
    }
    shown = SceneMap(msgspec.structs.replace(scene, signals=steady, elements=()))
    number = [one.name for one in ordered(steady)].index(name)
    speeds = np.linspace(0.0, _BEYOND * max(map(_fastest, answering)) or _USUAL_MM_S, _SPEEDS)
    angles = np.arange(_ANGLES) * (360.0 / _ANGLES)
    values = np.array(
        [
            [
                shown.signal_values(0.0, _velocity(speed, angle), switches)[number]
                for angle in angles
            ]
            for speed in speeds
        ]
    )
    notes = [f"signal {plain(one)}: {signal_words(signal)}" for one, signal in within.items()]
    if any(isinstance(one, Pulse) for one in within.values()):
        notes.append("time: pulses are taken as 1")
    return Blending(name, tuple(notes), speeds, angles, values)


def _within(signals: dict[str, AnySignal], name: str) -> Iterator[tuple[str, AnySignal]]:
    """Names and values of a signal and of those that it is made of."""
    yield name, signals[name]
    for one in made_of(signals[name]):
        yield from _within(signals, one)


def _fastest(signal: Speed | Direction) -> float:
    """Speed of the hand above which a signal changes no more, mm/s."""
    if isinstance(signal, Speed):
        return signal.below_mm_s + signal.transition_mm_s
    return signal.below_mm_s + signal.slow_transition_mm_s


def _velocity(speed_mm_s: float, angle_deg: float) -> tuple[float, float]:
    angle = math.radians(angle_deg)
    return speed_mm_s * math.cos(angle), speed_mm_s * math.sin(angle)


def blending_words(shown: Blending) -> list[str]:
    """Tell what a plot shows, a line for each thing, with the values at some speeds."""
    lines = [
        f"shown: signal {plain(shown.name)} against the velocity of the hand, white 0 and black 1; "
        "a hand at rest is in the middle, one that goes to the right at the right",
        f"edge: {shown.speeds_mm_s[-1]:g} mm/s",
        *shown.notes,
    ]
    eighth = shown.angles_deg.size // len(WAYS)
    for row in np.linspace(0, shown.speeds_mm_s.size - 1, _TOLD_SPEEDS).astype(int):
        values = shown.values[row, ::eighth]
        if np.ptp(shown.values[row]) < _ALIKE:
            said = f"{values[0]:.2f}" if row == 0 else f"{values[0]:.2f} in all directions"
        else:
            said = ", ".join(f"{way} {value:.2f}" for way, value in zip(WAYS, values, strict=True))
        lines.append(f"at {shown.speeds_mm_s[row]:g} mm/s: {said}")
    return lines


def blending_csv(shown: Blending) -> bytes:
    """Write a plot as CSV: a row for each velocity with its speed, direction and value."""
    speeds, angles = np.meshgrid(shown.speeds_mm_s, shown.angles_deg, indexing="ij")
    written = io.StringIO()
    rows = np.stack((speeds.ravel(), angles.ravel(), shown.values.ravel()), axis=-1)
    np.savetxt(written, rows, "%.6g", ",", header="speed_mm_s,direction_deg,value", comments="")
    return written.getvalue().encode()


def blending_figure(shown: Blending) -> Figure:
    """Draw a polar plot of velocity, true to the canvas: right at the right, down below."""
    with styled():
        figure = Figure(figsize=(SHEET.width_mm / _MM_PER_INCH, SHEET.height_mm / _MM_PER_INCH))
        FigureCanvasAgg(figure)
        axes = cast("PolarAxes", figure.add_subplot(projection="polar"))
        axes.set(theta_direction=-1, rmax=shown.speeds_mm_s[-1])
        angles = np.radians(np.append(shown.angles_deg, 360.0))
        axes.pcolormesh(
            angles,
            shown.speeds_mm_s,
            np.column_stack((shown.values, shown.values[:, 0])),
            cmap="gray_r",
            vmin=0.0,
            vmax=1.0,
            shading="gouraud",
            rasterized=True,
        )
        axes.set_xticks(np.radians(np.arange(0, 360, 90)), ["right", "down", "left", "up"])
        axes.grid(color=MIDDLE, linewidth=0.5)
        axes.set_rlabel_position(-22.5)
        axes.tick_params(axis="y", labelcolor="0", labelsize=8)
        for label in axes.get_yticklabels():
            label.set_bbox({"facecolor": "1", "edgecolor": "none", "pad": 0.8})
        figure.suptitle(f"{plain(shown.name)}: black 1, white 0; mm/s")
        figure.draw_without_rendering()
    return figure
