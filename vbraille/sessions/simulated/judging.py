"""How the simulated reader answers questions other than which cells these are.

It goes by one number of a stimulus: a length in mm, or how strong its strongest dot is felt, in
units of E₀ (`vbraille.sessions.simulated.observer`); `vbraille.sessions.running.reader` says
which. Where it is asked which of two it likes, it takes the one nearer to the length that it was
told, or the stronger one. Noise is normal. It says yes, or different,
beyond one standard deviation of its noise, so that it gives a false alarm in 16 % of trials with
nothing. On a scale it puts strengths of 0 to 1 evenly from end to end, and as a magnitude it gives
the strength times the modulus. How sure it is it cannot tell: its confidence is the middle of the
scale. All this is for trying out protocols, and claims nothing about people.
"""

from __future__ import annotations

import math

import numpy as np

from vbraille.sessions.simulated.observer import LEAST_FELT, TIE, Touch

LEAST_MAGNITUDE = 1e-3  # smallest magnitude given, as a share of the modulus: none may be 0


def strength(touch: Touch, first: int, stop: int) -> float:
    """Strength of the strongest dot of some cells, in units of E₀; 0 if the hand was on none."""
    felt = touch.evidence[first:stop]
    return 0.0 if np.isnan(felt).all() else float(np.nanmax(felt))


def detects(felt: float, noise: float, random: np.random.Generator) -> bool:
    """Whether the reader says that there was something, of this strength."""
    return felt + noise * float(random.standard_normal()) > max(noise, LEAST_FELT)


def differ(
    first: float, second: float, unit: float, noise: float, random: np.random.Generator
) -> bool:
    """Whether the reader takes two values for different.

    Parameters
    ----------
    first, second
        What was felt; NaN for what was not.
    unit
        Unit that noise is given in: the nominal length in mm, or 1 for strengths.
    noise
        Standard deviation of the noise of each.
    random
        Generator that draws the noise.
    """
    if math.isnan(first) or math.isnan(second):
        return math.isnan(first) != math.isnan(second)
    off = (first - second) / unit + noise * math.sqrt(2) * float(random.standard_normal())
    return abs(off) > max(noise * math.sqrt(2), TIE)


def larger(
    first: float, second: float, unit: float, noise: float, random: np.random.Generator
) -> int:
    """Which of two values the reader takes for the larger: 1 or 2; see `differ`."""
    drawn = noise * unit * random.standard_normal(2)
    one, two = (-math.inf if math.isnan(felt) else felt for felt in (first, second))
    return 2 if two + drawn[1] > one + drawn[0] else 1


def nearer(
    first: float, second: float, nominal: float, noise: float, random: np.random.Generator
) -> int:
    """Which of two lengths the reader takes for the one nearer to a length: 1 or 2; 1 if equal.

    Noise is in units of that length, and so is what counts as equal without noise.
    """
    drawn = noise * nominal * random.standard_normal(2)
    off = [
        math.inf if math.isnan(felt) else abs(felt + more - nominal)
        for felt, more in zip((first, second), drawn, strict=True)
    ]
    return 2 if off[1] < off[0] - (0.0 if noise else TIE * nominal) else 1


def rate(felt: float, least: int, most: int, noise: float, random: np.random.Generator) -> int:
    """Step of a scale that the reader gives a strength."""
    share = min(max(felt + noise * float(random.standard_normal()), 0.0), 1.0)
    return least + round(share * (most - least))


def magnitude(felt: float, modulus: float, noise: float, random: np.random.Generator) -> float:
    """Magnitude that the reader gives a strength, with noise on its logarithm; above 0."""
    share = max(felt, LEAST_MAGNITUDE) * math.exp(noise * float(random.standard_normal()))
    return modulus * max(share, LEAST_MAGNITUDE)
