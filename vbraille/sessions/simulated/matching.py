"""A simulated person who knows some pictures, and says which of them was felt.

The person is given frames, poses and times. At moments that are spread evenly over the
exploration each actuator is felt for 20 ms, a period of the strongest vibration: the mean and the
standard deviation of its deflection, so that a vibration is felt by its strength and not by its
phase. Each known picture is thought of under the same poses, and the one whose frames differ least,
by the root of the mean square over moments and actuators, is named. Normal noise is added to each
difference, in units of their mean over the pictures; where nothing tells pictures apart, a draw
decides.

This is the best that frames can tell to one who knows exactly where the array is. People do not:
they have to find out where their finger is, and remember it. No number of the model was fitted to
anybody, and it claims nothing about people; it is for trying protocols out.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vbraille.sessions.simulated.observer import FeltFrames

MOMENTS = 48
_WINDOW_S = 0.02
_SAMPLES = 5  # of a moment, 4 ms apart


def moments(felt: FeltFrames) -> NDArray[np.intp]:
    """Ticks at which an exploration is felt; intp[m, samples], with m at most `MOMENTS`."""
    known = np.flatnonzero(np.isfinite(felt.x_mm))
    if not known.size:
        return np.zeros((0, _SAMPLES), np.intp)
    ends = felt.time_s[known[0]], felt.time_s[known[-1]] - _WINDOW_S
    starts = np.linspace(ends[0], max(ends), MOMENTS)
    steps = np.arange(_SAMPLES) * (_WINDOW_S / _SAMPLES)
    at = np.searchsorted(felt.time_s[known], starts[:, None] + steps).clip(max=known.size - 1)
    return known[at]


def differences(felt: FeltFrames, known: Sequence[Any]) -> NDArray[np.float64]:
    """Return how much each of some programs differs from what was felt; float64[pictures]."""
    at = moments(felt)
    if not at.size:
        return np.zeros(len(known))
    places = (felt.x_mm, felt.y_mm, felt.theta_rad, felt.time_s)
    poses = [np.zeros(at.size) if each is None else each[at.ravel()] for each in places]
    frames = felt.frames[at]
    given = _impression(frames)
    thought = [_impression(program.poses(*poses)[1].reshape(frames.shape)) for program in known]
    return np.array([np.sqrt(np.mean((each - given) ** 2)) for each in thought])


def _impression(frames: NDArray[np.floating]) -> NDArray[np.float64]:
    """Means and standard deviations, float64[2, m, ...], of frames [m, samples, ...]."""
    return np.stack([frames.mean(axis=1), frames.std(axis=1)])


def most_like(
    apart: NDArray[np.float64], names: Sequence[str], noise: float, random: np.random.Generator
) -> str:
    """Return the name of the picture that differs least from what was felt, with noise."""
    drawn = random.standard_normal(apart.size)
    if np.ptp(apart) > 0:
        drawn = apart / apart.mean() + noise * drawn
    return names[int(drawn.argmin())]
