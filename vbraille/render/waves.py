"""Compilation of kernels, and the sines, cosines and other curves that they use.

The library's sine keeps a loop from becoming vector instructions; polynomials do not. They are good
to 1e-14.
"""

import math

from numba import njit

from vbraille.caching import keep_compiled

_C = [(-1) ** n * math.pi ** (2 * n) / math.factorial(2 * n) for n in range(11)]
_C0, _C1, _C2, _C3, _C4, _C5, _C6, _C7, _C8, _C9, _C10 = _C
_S = [(-1) ** n * math.pi ** (2 * n + 1) / math.factorial(2 * n + 1) for n in range(10)]
_T0, _T1, _T2, _T3, _T4, _T5, _T6, _T7, _T8, _T9 = _S
# The arc tangent of a number from 0 to 1, over that number, by its square; good to 6e-12.
_A = (
    0.999999999988737,
    -0.3333333295166559,
    0.19999978337002627,
    -0.14285225625340942,
    0.11105306907877156,
    -0.09049180114773323,
    0.07495266091119122,
    -0.06022205218890622,
    0.043646729133535726,
    -0.02600614172204219,
    0.011427729645781122,
    -0.003195461834616629,
    0.00041923393867625194,
)
_A0, _A1, _A2, _A3, _A4, _A5, _A6, _A7, _A8, _A9, _A10, _A11, _A12 = _A
_HALF_PI = math.pi / 2

compiled = njit(cache=keep_compiled(), error_model="numpy", fastmath={"contract"}, nogil=True)
inlined = njit(inline="always", error_model="numpy", fastmath={"contract"})


@inlined
def cos_pi(q):
    """Compute cos π d from q = d² ≤ 1/4."""
    high = _C5 + q * (_C6 + q * (_C7 + q * (_C8 + q * (_C9 + q * _C10))))
    return _C0 + q * (_C1 + q * (_C2 + q * (_C3 + q * (_C4 + q * high))))


@inlined
def sin_pi(d, q):
    """Compute sin π d from d and q = d² ≤ 1/4."""
    high = _T5 + q * (_T6 + q * (_T7 + q * (_T8 + q * _T9)))
    return d * (_T0 + q * (_T1 + q * (_T2 + q * (_T3 + q * (_T4 + q * high)))))


@inlined
def hump(d):
    """Compute the ridge ½ + ½ cos 2πd, which is 0 from |d| = ½ on; good to 1e-11."""
    q = d * d
    q = q if q < 0.25 else 0.25
    high = _C5 + q * (_C6 + q * (_C7 + q * _C8))
    cosine = _C0 + q * (_C1 + q * (_C2 + q * (_C3 + q * (_C4 + q * high))))
    return cosine * cosine if q < 0.25 else 0.0


@inlined
def fall(u):
    """Compute the edge ½ + ½ cos πu, which is 1 up to u = 0 and 0 from u = 1 on."""
    u = u if u > 0.0 else 0.0
    return hump(0.5 * u)


@inlined
def wave(u):
    """Compute cos 2πu for any u."""
    return 2.0 * hump(u - math.floor(u + 0.5)) - 1.0


@inlined
def angle(x, y):
    """Angle of a direction, from -π to π, as ``atan2(y, x)``; 0 where there is none."""
    a, b = abs(x), abs(y)
    larger = a if a > b else b
    smaller = a if a < b else b
    t = smaller / (larger if larger > 0.0 else 1.0)
    q = t * t
    high = _A7 + q * (_A8 + q * (_A9 + q * (_A10 + q * (_A11 + q * _A12))))
    high = _A3 + q * (_A4 + q * (_A5 + q * (_A6 + q * high)))
    value = t * (_A0 + q * (_A1 + q * (_A2 + q * high)))
    value = _HALF_PI - value if b > a else value
    value = math.pi - value if x < 0.0 else value
    return -value if y < 0.0 else value


HALF_SINE = 0.0  # of `Profile`; of the other profiles 1 - 6 of eqs. 4.1-4.3


@inlined
def dot_swing(half_sine, e0, e1, e2, e3, e4, e5, d, q):
    """Compute the swing of a dot at d = (place - its middle) / its width, q = d² ≤ 1/4."""
    sine = cos_pi(q)  # sin(πu/W), u from the dot's left edge
    y = sine * sine
    if half_sine:
        # Lévesque 2009, 3.2, with sin 8θ = 8 sin θ cos θ (1 - 10y + 24y² - 16y³)
        cosine = -sin_pi(d, q)
        value = sine * (e0 + e1 * cosine * (1.0 + y * (-10.0 + y * (24.0 - 16.0 * y))))
    else:
        # eqs. 4.1-4.3 on [0, 1]: c = cos πp, and cos kπp = T_k(c), which is odd
        c = 2.0 * y - 1.0
        z = c * c
        value = 0.5 + c * (e0 + z * (e1 + z * (e2 + z * (e3 + z * (e4 + z * e5)))))
    value = value if value > 0.0 else 0.0
    return value if value < 1.0 else 1.0
