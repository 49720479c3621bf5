"""Where the Latero's array is, from its encoders and from where it was shown to be."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from vbraille.carriers import latero
from vbraille.devices.events import Placing

if TYPE_CHECKING:
    from collections.abc import Sequence

# The array's centre may be so far outside what it can reach, by the play of the arms.
BEYOND_MM: Final = 10.0


class ArmPlace:
    """Place of the array; unknown until its offsets are given or it is shown to be at reset.

    Parameters
    ----------
    offsets
        Counts of encoders 0, 1 and 2 at angle 0 of their joints; None if they are not known.

    Attributes
    ----------
    placing : Placing
        What is waited for before the place is known.
    """

    def __init__(self, offsets: Sequence[int] | None) -> None:
        self._encoders: tuple[int, ...] | None = None  # that were told last
        self.offsets = offsets
        self.placing = Placing.STOP if offsets is None else Placing.DONE

    def take(self, encoders: tuple[int, ...]) -> tuple[float, float, float] | None:
        """Take counts; give x and y in mm and θ in radians, or None if they are not known.

        x and y are those of the array's centre from the upper left of what it can reach. Where
        the arms cannot be, the place is not known any more.
        """
        self._encoders = encoders
        if self.offsets is None:
            return None
        joints = latero.joints_of(encoders, self.offsets)
        x_mm, y_mm, theta_rad = latero.pose_at(*joints)
        if not (
            -BEYOND_MM <= x_mm <= latero.WIDTH_MM + BEYOND_MM
            and -BEYOND_MM <= y_mm <= latero.HEIGHT_MM + BEYOND_MM
        ):
            self.forget()
            return None
        return (
            min(max(x_mm, 0.0), latero.WIDTH_MM),
            min(max(y_mm, 0.0), latero.HEIGHT_MM),
            theta_rad,
        )

    def set_zero(self) -> None:
        """Take the place for that of the reset: lower left, the third arm straight up."""
        if self._encoders is not None:
            self.offsets = latero.offsets_at(self._encoders)
            self.placing = Placing.DONE

    def forget(self) -> None:
        """Forget the offsets: the encoders do not count from there any more."""
        self.offsets, self.placing = None, Placing.STOP
