"""Whether an effect's contrasts vary alike and apart, as F supposes; how far from it they are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import chi2

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Sphericity:
    """What is known of sphericity. A value that cannot be found is None, and `note` says why.

    Parameters
    ----------
    epsilon
        Greenhouse and Geisser's epsilon.
    huynh_feldt
        Huynh and Feldt's epsilon: that of Greenhouse and Geisser is too small where sphericity
        nearly holds and participants are few.
    w, chi2, df
        Mauchly's W, the statistic that is about chi-square, and its degrees of freedom.
    p
        p of W, by the expansion that R's ``mauchly.test`` takes; too small where participants are
        few for the contrasts.
    note
        Why something is None; may be empty.
    """

    epsilon: float
    huynh_feldt: float
    w: float | None = None
    chi2: float | None = None
    df: int | None = None
    p: float | None = None
    note: str = ""


def sphericity(z: NDArray[np.float64], *, cells: int, one_factor: bool) -> Sphericity:
    """Epsilons and Mauchly's test of an effect.

    With S the covariance of d contrasts over n participants, Greenhouse and Geisser
    1959 estimate Box's (1954) ε = tr(S)² / (d tr(S²)); Huynh and Feldt 1976 take
    (n d ε - 2) / (d (n - 1 - d ε)), 1 at most; Mauchly 1940 tests W = |S| / (tr(S)/d)^d.

    Parameters
    ----------
    z : float64[n, d]
        Contrasts of each participant; they must not all be alike.
    cells
        Number of cells of the whole design, in which all factors are crossed.
    one_factor
        Whether the effect is a main effect.
    """
    n, d = z.shape
    if d == 1:
        only = "two levels" if one_factor else "one contrast"
        return Sphericity(1.0, 1.0, note=f"{only}: sphericity holds by itself")
    deviations = z - z.mean(axis=0)
    spread = np.linalg.svd(deviations, compute_uv=False) ** 2  # (n - 1) times S's eigenvalues
    shares = spread / spread.sum()
    epsilon = min(1.0, 1 / (d * float((shares**2).sum())))
    wide = huynh_feldt(epsilon, n, d)
    if n - 1 < d:
        return Sphericity(
            epsilon,
            wide,
            note=f"{n} participants are too few to test the sphericity of {d} contrasts",
        )
    if shares.min() <= 1e-12 * shares.max():
        return Sphericity(
            epsilon, wide, note="some contrasts follow from the others; sphericity cannot be tested"
        )
    log_w = min(0.0, float(np.log(d * shares).sum()))
    statistic, df, p = mauchly_p(log_w, n, d, cells)
    return Sphericity(epsilon, wide, math.exp(log_w), statistic, df, p)


def huynh_feldt(epsilon: float, n: int, d: int, groups: int = 1) -> float:
    """Huynh and Feldt's epsilon from Greenhouse and Geisser's.

    With N participants in g groups it is ((N - g + 1) d ε - 2) / (d (N - g - d ε)), which is what
    Lecoutre (1991) made of it: their own has N in place of N - g + 1, the same for one group. It
    is taken for 1 where it is larger, and for Greenhouse and Geisser's where it is smaller.

    Parameters
    ----------
    epsilon
        Greenhouse and Geisser's epsilon.
    n, d, groups
        Numbers of participants, contrasts and groups.
    """
    rank = epsilon * d  # 1 … n - groups; at its upper end the estimate is without bound
    left = n - groups
    if left < 2 or left - rank <= 1e-9:
        return epsilon if left < 2 else 1.0
    return max(epsilon, min(1.0, ((left + 1) * rank - 2) / (d * (left - rank))))


def mauchly_p(log_w: float, n: int, d: int, cells: int) -> tuple[float, int, float]:
    """Chi-square of W, its degrees of freedom, and p with the second-order term.

    P = P(χ²_f > z) + ω (P(χ²_{f+4} > z) - P(χ²_f > z)), Anderson 2003, 10.7.4, as R's
    ``mauchly.test`` has it: its ω has 3 times the number of cells where Anderson's has 3 d,
    which makes a difference in the fourth decimal.

    Parameters
    ----------
    log_w
        Natural logarithm of W.
    n, d
        Numbers of participants and contrasts, d below n.
    cells
        Number of cells of the whole design, in which all factors are crossed.
    """
    df = d * (d + 1) // 2 - 1
    scale = n - 1 - (2 * d**2 + d + 2) / (6 * d)  # ρ times n - 1
    statistic = -scale * log_w
    first, second = (float(chi2.sf(statistic, degrees)) for degrees in (df, df + 4))
    order = (d + 2) * (d - 1) * (d - 2) * (2 * d**3 + 6 * d**2 + 3 * cells + 2)
    p = first + order / (288 * (d * scale) ** 2) * (second - first)
    return statistic, df, min(max(p, 0.0), 1.0)
