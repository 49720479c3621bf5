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

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vbraille.sessions.simulated.skin import FeltFrames

# Frames, float[n, rows, columns], of a picture at x, y (mm), θ (rad) and times (s), float64[n].
PictureFrames = Callable[..., NDArray[np.floating]]

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


def _impression(frames: NDArray[np.floating]) -> NDArray[np.float64]:
    """Means and standard deviations, float64[2, m, ...], of frames [m, samples, ...]."""
    return np.stack([frames.mean(axis=1), frames.std(axis=1)])


def differences(felt: FeltFrames, known: Sequence[PictureFrames]) -> NDArray[np.float64]:
    """Differences between what was felt and what each picture would give; float64[pictures]."""
    at = moments(felt)
    ticks = at.ravel()
    places = (felt.x_mm, felt.y_mm, felt.theta_rad, felt.time_s)
    poses = [np.zeros(ticks.size) if each is None else each[ticks] for each in places]
    impression = _impression(felt.frames[at])
    found = []
    for frames_of in known:
        thought = _impression(frames_of(*poses).reshape(*at.shape, *felt.frames.shape[1:]))
        found.append(np.sqrt(np.mean((thought - impression) ** 2)) if at.size else 0.0)
    return np.array(found)


def name_one(apart: NDArray[np.float64], noise: float, random: np.random.Generator) -> int:
    """Number of the picture that differs least from what was felt, with noise."""
    unit = float(apart.mean())
    drawn = random.standard_normal(apart.size)
    if unit == 0 or np.ptp(apart) == 0:
        return int(drawn.argmin())
    return int((apart / unit + noise * drawn).argmin())


class FeltPicture(NamedTuple):
    """A trial with a picture as the simulated person feels it.

    Parameters
    ----------
    apart : float64[pictures]
        How much each known picture differs from what was felt.
    names
        Their names.
    """

    apart: NDArray[np.float64]
    names: Sequence[str]

    def named(self, noise: float, random: np.random.Generator) -> str:
        """Return the name of the picture that is felt most like it."""
        return self.names[name_one(self.apart, noise, random)]
