"""Vibration, gratings, distortions and images in plain numpy, straight from the equations.

Lévesque 2009, 8.3 to 8.4.2. It is slow and plain on purpose; the tests hold the kernels to it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vbraille.scene.bitmap import WHOLE
from vbraille.scene.geometry import Cycle, axial_cycle
from vbraille.scene.patterns import Gradual, Peak

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.patterns import AxialGrating, LinearGrating, RadialGrating, Vibration

Values = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class ActuatorPlaces:
    """Places of actuators on the canvas at one moment.

    Parameters
    ----------
    x_mm, y_mm : float64[n]
        The places.
    sign : float64[n]
        1 where the parities of an actuator's column and row are the same, else -1.
    time_s
        The moment, in seconds since the scene was first shown.
    signals
        Values of the scene's signals by name, and of their integrals by ∫ and the name.
    """

    x_mm: Values
    y_mm: Values
    sign: Values
    time_s: float
    signals: Mapping[str, float] = field(default_factory=dict)

    def moved_s(self, velocity_by: str) -> float:
        """Time by which something has moved whose speed may follow a signal."""
        return self.signals[f"∫{velocity_by}"] if velocity_by else self.time_s

    def from_point(self, x_mm: float, y_mm: float) -> tuple[Values, Values]:
        """Vectors from a point to the places."""
        return self.x_mm - x_mm, self.y_mm - y_mm

    def wrapped(
        self, origin_mm: tuple[float, float], width_mm: float, height_mm: float
    ) -> ActuatorPlaces:
        """Places within their tile: p mod (w, h), Lévesque 2009, 8.4.1."""
        dx, dy = self.from_point(*origin_mm)
        return replace(self, x_mm=np.mod(dx, width_mm), y_mm=np.mod(dy, height_mm))


# Vibration


def vibration(at: ActuatorPlaces, frequency_hz: float) -> Values:
    """Compute δ_vib of eq. 8.1: neighbours swing against each other about the middle."""
    return 0.5 + 0.5 * at.sign * math.sin(math.tau * frequency_hz * at.time_s)


def share_left(at: ActuatorPlaces, swing: Vibration) -> Values:
    """Compute δ¹_vib of eq. 8.3, by which other deflections are multiplied."""
    return (1 - swing.amplitude) + swing.amplitude * vibration(at, swing.frequency_hz)


def vibrated(deflection: Values, at: ActuatorPlaces, swing: Vibration | None) -> Values:
    """Let what is up vibrate, δ δ¹_vib, or what is down, 1 - (1 - δ) δ¹_vib: 8.4.1, fig. 8.10."""
    if swing is None:
        return deflection
    if swing.of == "high":
        return deflection * share_left(at, swing)
    return 1 - (1 - deflection) * share_left(at, swing)


# Gratings


def ridges(x: Values, cycle: Cycle) -> Values:
    """Compute g(x) of eq. 8.4 with k = 1: a ridge, which begins at 0, and a gap after it."""
    u = np.mod(x, cycle.length)
    return np.where(u < cycle.ridge, 0.5 - 0.5 * np.cos(math.tau * u / cycle.ridge), 0.0)


def moved_on(x: Values, cycle: Cycle, velocity: float, time_s: float) -> Values:
    """Move ridges to larger x: eq. 9.2 with its sign turned, x - v (t mod λ/|v|)."""
    if velocity == 0:
        return x
    return x - velocity * math.fmod(time_s, cycle.length / abs(velocity))


def gradual(x: Values, factor: float, start: float, length: float) -> Values:
    """Compute x' of eq. 8.5: the frequency grows from 1 at x0 = start to K at x0 + L."""
    k, x0 = factor, start
    return np.select(
        [x <= x0, x <= x0 + length],
        [x, x + (k - 1) * (x - x0) ** 2 / (2 * length)],
        k * x - (k - 1) * (x0 + length / 2),
    )


def peak(x: Values, factor: float, center: float, length: float) -> Values:
    """Compute x' of eq. 8.6, with - 2 L x_c where the print has a plus.

    The frequency grows from 1 at x_c - L to K at x_c, and falls to 1 again at x_c + L.
    """
    k, xc = factor, center
    x0, x1 = xc - length, xc + length
    falling = k * x + (k - 1) * (length**2 - 2 * length * xc - (x - xc) ** 2) / (2 * length)
    return np.select(
        [x <= x0, x <= xc, x <= x1],
        [x, x + (k - 1) * (x - x0) ** 2 / (2 * length), falling],
        x + (k - 1) * length,
    )


def distorted(x: Values, distortion: Gradual | Peak | None) -> Values:
    """Distort a wave's abscissa."""
    if distortion is None:
        return x
    if isinstance(distortion, Gradual):
        return gradual(x, distortion.factor, distortion.start_mm, distortion.length_mm)
    return peak(x, distortion.factor, distortion.center_mm, distortion.length_mm)


def linear_grating(grating: LinearGrating, at: ActuatorPlaces) -> Values:
    """Compute a linear grating: x is the abscissa along the direction of travel, 8.4.1."""
    angle = math.radians(grating.travel_deg)
    dx, dy = at.from_point(*grating.start_mm)
    cycle = Cycle(grating.ridge_mm, grating.gap_mm)
    x = distorted(dx * math.cos(angle) + dy * math.sin(angle), grating.distortion)
    return ridges(moved_on(x, cycle, grating.velocity_mm_s, at.moved_s(grating.velocity_by)), cycle)


def radial_grating(grating: RadialGrating, at: ActuatorPlaces) -> Values:
    """Compute a radial grating: x is the distance from its centre, 8.4.1."""
    cycle = Cycle(grating.ridge_mm, grating.gap_mm)
    x = distorted(np.hypot(*at.from_point(*grating.center_mm)), grating.distortion)
    return ridges(moved_on(x, cycle, grating.velocity_mm_s, at.moved_s(grating.velocity_by)), cycle)


def axial_grating(grating: AxialGrating, at: ActuatorPlaces) -> Values:
    """Compute an axial grating: x is the angle round its centre, in degrees, 8.4.1.

    Near the centre it goes over linearly into ``middle`` between the radii at which the arc of its
    shortest cycle is as long as ``fade_mm`` says; the source only says that it fades.
    """
    dx, dy = at.from_point(*grating.center_mm)
    cycle = axial_cycle(grating)
    x = np.mod(np.degrees(np.arctan2(dy, dx)) - grating.start_deg, 360.0)
    shortest = cycle.length
    if grating.distortion is not None:
        turn = grating.distortion
        x = peak(x, turn.factor, turn.center_deg, turn.length_deg)
        shortest /= max(1.0, turn.factor)
    g = ridges(moved_on(x, cycle, grating.velocity_deg_s, at.moved_s(grating.velocity_by)), cycle)
    arc_mm = math.radians(shortest) * np.hypot(dx, dy)
    start_mm, end_mm = grating.fade_mm
    share = np.clip((arc_mm - start_mm) / (end_mm - start_mm), 0.0, 1.0)
    return (1 - share) * grating.middle + share * g


# Images


def intensity(bitmap: Bitmap, at: ActuatorPlaces) -> Values:
    """Compute the intensity of a bitmap: 8.4.2.

    It is bilinear between the middles of its pixels, or that of the nearest.
    """
    rows, columns = bitmap.intensities.shape
    framed = np.full((rows + 2, columns + 2), round(bitmap.outside * WHOLE))
    framed[1:-1, 1:-1] = bitmap.intensities
    framed = framed / WHOLE
    dx, dy = at.from_point(*bitmap.place_mm)
    if bitmap.nearest:
        i = np.floor(dy / bitmap.height_mm * rows).astype(int)
        j = np.floor(dx / bitmap.width_mm * columns).astype(int)
        return framed[np.clip(i + 1, 0, rows + 1), np.clip(j + 1, 0, columns + 1)]
    # The pixel with its middle at (0, 0) is the first of the frame around them.
    u = np.clip(dx / bitmap.width_mm * columns + 0.5, 0, columns + 1)
    v = np.clip(dy / bitmap.height_mm * rows + 0.5, 0, rows + 1)
    i = np.minimum(v.astype(int), rows)
    j = np.minimum(u.astype(int), columns)
    down, right = v - i, u - j
    above = (1 - right) * framed[i, j] + right * framed[i, j + 1]
    below = (1 - right) * framed[i + 1, j] + right * framed[i + 1, j + 1]
    return (1 - down) * above + down * below
