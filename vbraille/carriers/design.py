"""Resolution and reach of two arms, and how long they must be for a page.

The equations are those of Lévesque 2009, 7.4 and A.20-A.74. The scan has lost the signs and Greek
letters of many; where they are not ours to see, they are set as continuity and geometry force them,
and each function says so. Distances r are from the first joint, β is the angle of the second.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.carriers import tactograph
from vbraille.carriers.planar import Arms
from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

# One count of an encoder of 65,536 a turn: 19.775″, which the source rounds to 19.8″.
COUNT_RAD: Final = 2 * math.pi / tactograph.COUNTS_A_TURN
PRINTED_COUNT_RAD: Final = math.radians(19.8 / 3600)
# Ratios k = b / a among which the best is looked for, and longest first arm that is tried.
RATIOS: Final = (0.3, 1.2)
LONGEST_MM: Final = 5000.0


def bend_error_mm(arms: Arms, bend_rad: float, count_rad: float = COUNT_RAD) -> float:
    """Error in mm that one count too many or too few in each joint makes at most (eq. A.63).

    The inequality of the printed condition is the wrong way round: A.51 says cos β > -k, which is
    β < arccos(-k). The minus sign is lost in the scan.
    """
    k = arms.ratio
    if k > 1 or math.cos(bend_rad) > -k:
        return arms.first_mm * count_rad * math.sqrt(4 * k * k + 4 * k * math.cos(bend_rad) + 1)
    return arms.first_mm * count_rad


def error_mm(
    arms: Arms, r_mm: NDArray[np.float64], count_rad: float = COUNT_RAD
) -> NDArray[np.float64]:
    """Resolution: the largest error, in mm, that a count makes at distances (eq. 7.4, A.64).

    Parameters
    ----------
    r_mm
        Distances from the first joint that the arms reach, in mm; float64 of any shape.
    count_rad
        Angle of one count of either joint's encoder.
    """
    a_mm, k = arms.first_mm, arms.ratio
    far = np.sqrt(np.maximum(2 * r_mm**2 + a_mm**2 * (2 * k * k - 1), 0.0))
    near = (r_mm <= a_mm * math.sqrt(max(1 - k * k, 0.0))) & (k <= 1)
    return count_rad * np.where(near, a_mm, far)


@dataclass(frozen=True, slots=True)
class Demands:
    """Demands on arms: a page, and what must not touch what (A, "Linkage optimization").

    Parameters
    ----------
    width_mm, height_mm
        Size of the page, w and h, behind whose middle the first joint is.
    least_bend_rad, most_bend_rad
        Bounds of β.
    least_mm
        R_min, the least distance of the array from the first joint.
    clearance_mm
        D, the least distance of the array's centre from the first arm.
    """

    width_mm: float = tactograph.PAGE_MM[0]
    height_mm: float = tactograph.PAGE_MM[1]
    least_bend_rad: float = math.radians(20)
    most_bend_rad: float = math.radians(160)
    least_mm: float = tactograph.NEAR_MM
    clearance_mm: float = 50.0


LETTER: Final = Demands()


def annulus_mm(arms: Arms, demands: Demands = LETTER) -> tuple[float, float]:
    """Least and largest distance that the array may have from the first joint (eq. A.71-A.73).

    The inner minus signs of A.70 are lost in the scan; by fig. A.4c the array stands D beside the
    first arm, √(b² - D²) back from its end. The least distance is infinite if the second arm is
    shorter than D.
    """
    a_mm, b_mm, k, aside_mm = arms.first_mm, arms.second_mm, arms.ratio, demands.clearance_mm
    if b_mm < aside_mm:
        beside_mm = math.inf
    else:
        beside_mm = math.hypot(aside_mm, a_mm - math.sqrt(b_mm * b_mm - aside_mm * aside_mm))
    return (
        max(_bent_mm(a_mm, k, demands.most_bend_rad), demands.least_mm, beside_mm),
        _bent_mm(a_mm, k, demands.least_bend_rad),
    )


def _bent_mm(a_mm: float, k: float, bend_rad: float) -> float:
    """Distance of the arms' end at an angle of the second joint (eq. A.68)."""
    return a_mm * math.sqrt(k * k + 2 * k * math.cos(bend_rad) + 1)


def page_height_mm(arms: Arms, demands: Demands = LETTER) -> float:
    """Height of the largest page of the width that is demanded; below 0 if there is none (A.74).

    Its near side is as near to the first joint as the arms go, at y = r_min.
    """
    least_mm, most_mm = annulus_mm(arms, demands)
    half_mm = demands.width_mm / 2
    if most_mm < half_mm:
        return -math.inf
    return math.sqrt(most_mm * most_mm - half_mm * half_mm) - least_mm


def shortest(ratio: float, demands: Demands = LETTER) -> Arms:
    """The shortest arms of a ratio k = b / a that reach all that is demanded (A.71 with A.74).

    Raises
    ------
    InputError
        If none with a first arm below 5 m do.
    """
    from scipy.optimize import brentq

    def spare_mm(a_mm: float) -> float:
        arms = Arms(a_mm, ratio * a_mm)
        return max(page_height_mm(arms, demands) - demands.height_mm, -1e6)

    # Arms that are too short do not reach, so that the least length is where that first changes.
    lengths_mm = np.geomspace(1.0, LONGEST_MM, 200)
    enough = next((n for n, a_mm in enumerate(lengths_mm) if spare_mm(float(a_mm)) >= 0), 0)
    if not enough:
        raise InputError(
            f"no arms of the ratio {ratio:g} reach a page of {demands.width_mm:g} × "
            f"{demands.height_mm:g} mm; give another ratio"
        )
    low_mm, high_mm = float(lengths_mm[enough - 1]), float(lengths_mm[enough])
    a_mm = float(brentq(spare_mm, low_mm, high_mm, xtol=1e-10))  # pyright: ignore[reportArgumentType]
    return Arms(a_mm, ratio * a_mm)


@dataclass(frozen=True, slots=True)
class ResolutionSpan:
    """Resolution of arms at the nearest and at the farthest place of the page, in mm."""

    arms: Arms
    best_mm: float
    worst_mm: float


def span(arms: Arms, demands: Demands = LETTER, count_rad: float = COUNT_RAD) -> ResolutionSpan:
    """Resolution of arms at both ends of the page that they reach nearest to the first joint."""
    near_mm, _ = annulus_mm(arms, demands)
    far_mm = math.hypot(demands.width_mm / 2, near_mm + demands.height_mm)
    best_mm, worst_mm = error_mm(arms, np.array([near_mm, far_mm]), count_rad)
    return ResolutionSpan(arms, float(best_mm), float(worst_mm))


def best_ratio(
    of: Callable[[ResolutionSpan], float], demands: Demands = LETTER, count_rad: float = COUNT_RAD
) -> ResolutionSpan:
    """The shortest arms whose resolution is best, at the near or at the far end of the page.

    Parameters
    ----------
    of
        What is to be least: the best or the worst resolution of a span (fig. 7.10b, A.7a).
    """
    from scipy.optimize import minimize_scalar

    ratios = np.linspace(*RATIOS, 91)
    found = [of(span(shortest(float(k), demands), demands, count_rad)) for k in ratios]
    place = int(np.clip(np.argmin(found), 1, ratios.size - 2))
    around = (float(ratios[place - 1]), float(ratios[place + 1]))
    ratio = minimize_scalar(
        lambda k: of(span(shortest(float(k), demands), demands, count_rad)),
        bounds=around,
        method="bounded",
        options={"xatol": 1e-6},
    ).x
    return span(shortest(float(ratio), demands), demands, count_rad)
