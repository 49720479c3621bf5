"""Two arms in a plane, and a third that may stand on them: joint angles to places and back.

Angles are in radians and grow from x towards y; the origin is the first joint. The symbols are
those of Lévesque 2009, appendix A, where the scan has lost the Greek letters, so that the names of
the angles are ours: α is the first joint, β the second, a and b the arms, k = b / a, and r the
distance of the arms' end from the first joint. The arms bend to one side only: β > 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from vbraille.errors import InputError

# Rounding may bring a place that the stretched arms just reach this far out of their reach.
_ROUNDING_MM = 1e-9


@dataclass(frozen=True, slots=True)
class Arms:
    """Two arms, one on the other, of which the first turns about the origin.

    Parameters
    ----------
    first_mm, second_mm
        Lengths a and b of the arms, in mm.

    Raises
    ------
    ValueError
        If a length is not above 0.
    """

    first_mm: float
    second_mm: float

    def __post_init__(self) -> None:
        if not (0 < self.first_mm < math.inf and 0 < self.second_mm < math.inf):
            raise ValueError(
                f"arms are {self.first_mm:g} and {self.second_mm:g} mm; they must be above 0"
            )

    @property
    def ratio(self) -> float:
        """Length of the second arm as a share of the first: k = b / a."""
        return self.second_mm / self.first_mm

    def forward(self, alpha_rad: float, beta_rad: float) -> tuple[float, float]:
        """Place of the arms' end, in mm, at the angles of the joints (eq. A.1, 7.1)."""
        both_rad = alpha_rad + beta_rad
        return (
            self.first_mm * math.cos(alpha_rad) + self.second_mm * math.cos(both_rad),
            self.first_mm * math.sin(alpha_rad) + self.second_mm * math.sin(both_rad),
        )

    def inverse(self, x_mm: float, y_mm: float) -> tuple[float, float]:
        """Angles of the joints at which the arms' end is at a place (eq. A.15, 7.2).

        The scan has lost the signs of the equations and the bars of their fractions; they are set
        so that the equations undo eq. A.1, as the geometry forces. These are the same equations
        with arctangents in place of arccosines, which are inexact where the arms are nearly
        stretched or folded.

        Raises
        ------
        InputError
            If the arms do not reach there.
        """
        a_mm, b_mm = self.first_mm, self.second_mm
        r_mm = math.hypot(x_mm, y_mm)
        # (2ab)² sin²β, by Heron's formula; 2ab cos β by the law of cosines (eq. A.11).
        square = (
            ((a_mm + b_mm) - r_mm)
            * ((a_mm + b_mm) + r_mm)
            * (r_mm - abs(a_mm - b_mm))
            * (r_mm + abs(a_mm - b_mm))
        )
        if not square >= 0:
            over_mm = max(r_mm - (a_mm + b_mm), abs(a_mm - b_mm) - r_mm)
            if not over_mm <= _ROUNDING_MM:
                raise InputError(
                    f"arms of {a_mm:g} and {b_mm:g} mm do not reach a place {r_mm:.1f} mm away; "
                    f"they reach {abs(a_mm - b_mm):.1f} to {a_mm + b_mm:.1f} mm"
                )
            square = 0.0
        beta_rad = math.atan2(math.sqrt(square), r_mm * r_mm - a_mm * a_mm - b_mm * b_mm)
        bent_rad = math.atan2(b_mm * math.sin(beta_rad), a_mm + b_mm * math.cos(beta_rad))
        return math.atan2(y_mm, x_mm) - bent_rad, beta_rad

    def jacobian(
        self, alpha_rad: float, beta_rad: float
    ) -> tuple[tuple[float, float], tuple[float, float]]:
        """Way of the arms' end for small turns of the joints (eq. A.18, 7.3).

        Returns
        -------
        rows x and y, columns α and β
            Derivatives, in mm a radian. The minus signs, lost in the scan, follow from eq. A.1.
        """
        both_rad = alpha_rad + beta_rad
        x_by_beta = -self.second_mm * math.sin(both_rad)
        y_by_beta = self.second_mm * math.cos(both_rad)
        return (
            (-self.first_mm * math.sin(alpha_rad) + x_by_beta, x_by_beta),
            (self.first_mm * math.cos(alpha_rad) + y_by_beta, y_by_beta),
        )


@dataclass(frozen=True, slots=True)
class ThreeArms:
    """Two arms, and a third one on them that holds the array and turns with it.

    Parameters
    ----------
    arms
        The first two arms.
    third_mm
        Length of the third arm, in mm; 0 if the array turns about the end of the second.
    """

    arms: Arms
    third_mm: float

    def forward(self, first: float, second: float, third: float) -> tuple[float, float, float]:
        """Place of the array, in mm, and the direction of the third arm, at three joint angles."""
        x_mm, y_mm = self.arms.forward(first, second)
        whole_rad = first + second + third
        return (
            x_mm + self.third_mm * math.cos(whole_rad),
            y_mm + self.third_mm * math.sin(whole_rad),
            whole_rad,
        )

    def inverse(self, x_mm: float, y_mm: float, whole_rad: float) -> tuple[float, float, float]:
        """Three joint angles at which the array is at a place and the third arm has a direction.

        Raises
        ------
        InputError
            If the arms do not reach there.
        """
        first, second = self.arms.inverse(
            x_mm - self.third_mm * math.cos(whole_rad), y_mm - self.third_mm * math.sin(whole_rad)
        )
        return first, second, whole_rad - first - second
