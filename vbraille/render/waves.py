"""How kernels are compiled, and the sine and cosine that they use.

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
