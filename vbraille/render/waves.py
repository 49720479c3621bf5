"""Compilation of kernels, and the curves that they share."""

import math

import numpy as np
from numba import njit

from vbraille.caching import keep_compiled

# cos πd as a polynomial of d², good to 1e-14: the library's cosine keeps a loop from becoming
# vector instructions.
_C0, _C1, _C2, _C3, _C4, _C5, _C6, _C7, _C8, _C9, _C10 = (
    (-1) ** n * math.pi ** (2 * n) / math.factorial(2 * n) for n in range(11)
)

compiled = njit(cache=keep_compiled(), error_model="numpy", fastmath={"contract"}, nogil=True)
inlined = njit(inline="always", error_model="numpy", fastmath={"contract"})


@inlined
def cos_pi(q):
    """Compute cos π d from q = d² ≤ 1/4."""
    high = _C5 + q * (_C6 + q * (_C7 + q * (_C8 + q * (_C9 + q * _C10))))
    return _C0 + q * (_C1 + q * (_C2 + q * (_C3 + q * (_C4 + q * high))))


@inlined
def hump(d):
    """Compute the ridge ½ + ½ cos 2πd, which is 0 from |d| = ½ on."""
    q = d * d
    cosine = cos_pi(q if q < 0.25 else 0.25)
    return cosine * cosine if q < 0.25 else 0.0


@inlined
def fall(u):
    """Compute the edge ½ + ½ cos πu, which is 1 up to u = 0 and 0 from u = 1 on."""
    return hump(0.5 * (u if u > 0.0 else 0.0))


@inlined
def ridge(place, cycle, length):
    """Compute the ridge ½ - ½ cos 2πu of a grating, u = place / length, and the gap after it."""
    return hump((place - cycle * np.floor(place / cycle)) / length - 0.5)


@compiled
def phase(frequency, time):
    """Compute sin 2πft, the swing of a vibration: Lévesque 2009, eqs. 8.1 and 8.2.

    Without a time, which is NaN then, noise takes its place, which comes with the signs.
    """
    return math.sin(2.0 * math.pi * frequency * time) if time == time else 1.0


@inlined
def swung(amplitude, swing):
    """Compute the share δ¹ that a vibration leaves."""
    return 1.0 - 0.5 * amplitude * (1.0 - swing)
