"""A line, compiled for the kernels: one frame, or a whole path of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import chebyshev

from vbraille.render import kernels, work
from vbraille.render.models import Profile
from vbraille.render.reference import half_sine_peak

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.geometry import Geometry
    from vbraille.render.arrays import ActuatorArray
    from vbraille.render.mappings import Mapping
    from vbraille.render.tuning import Tuning

_BLOCK = 64  # positions whose places and swings stay in the processor's nearest cache


class Renderer:
    """What the actuators do along one line; nothing of it changes once made.

    Parameters
    ----------
    masks : uint8[cells]
        The line, dot masks; bit 0 is dot 1.
    array
        The actuators.
    profile
        How a dot swings.
    mapping
        Which dots each row shows; rows that it does not name rest.
    geometry
        Where the dots are.
    tuning
        Texture and contrast.
    anchor_mm
        How far right of the left column the point of the array is whose places are given: half of
        the array's width if nothing is said, which is its centre. Sessions and recordings of
        before 22 November 2026 have places of the left column: 0 shows them bit for bit.

    Raises
    ------
    ValueError
        If the mapping needs more rows than the array has.
    """

    __slots__ = ("_gains", "_work", "array")

    def __init__(
        self,
        masks: NDArray[np.uint8],
        *,
        array: ActuatorArray,
        profile: Profile,
        mapping: Mapping,
        geometry: Geometry,
        tuning: Tuning,
        anchor_mm: float | None = None,
    ) -> None:
        if mapping.rows > array.rows:
            raise ValueError(
                f"mapping {mapping.name} needs {mapping.rows} actuator rows; "
                f"the array has {array.rows}"
            )
        self.array = array
        self._work = np.zeros((3, max(_BLOCK * array.columns, work.IDLE + array.rows)))
        parameters = self._work[0]
        parameters[work.CELLS_PER_MM] = 1 / geometry.cell_pitch_mm
        parameters[work.CELL_PITCH] = geometry.cell_pitch_mm
        parameters[work.COLUMN_PITCH] = array.column_pitch_mm
        parameters[work.COLUMNS] = array.columns
        parameters[work.ANCHOR] = array.span_mm / 2 if anchor_mm is None else anchor_mm
        parameters[work.DOTS_PER_MM] = 1 / geometry.dot_width_mm
        parameters[work.DOT_SPACING] = geometry.dot_spacing_mm
        parameters[work.PROFILE] = profile
        parameters[work.OVERLAP] = geometry.dot_width_mm > min(
            geometry.dot_spacing_mm, geometry.cell_gap_mm
        )
        parameters[work.SHAPE : work.SHAPE + 6] = _shape(profile, tuning)
        idle = np.zeros(array.rows)
        idle[: mapping.rows] = mapping.idle()
        parameters[work.IDLE : work.IDLE + array.rows] = idle
        slots = np.zeros((len(masks) + 2, 2), np.uint16)
        slots[1:-1] = mapping.row_bits()[masks]
        shown = slots.ravel() >> np.arange(array.rows, dtype=np.uint16)[:, None] & 1
        self._gains = tuning.contrast * (1 - 2 * idle)[:, None] * shown

    @property
    def parameters(self) -> NDArray[np.float64]:
        """What the kernels know of the line's shape, float64[IDLE + rows]; see `kernels`."""
        return self._work[0, : work.IDLE + self.array.rows]

    @property
    def gains(self) -> NDArray[np.float64]:
        """What the kernels know of its dots, float64[rows, 2 · (cells + 2)]."""
        return self._gains

    def frame(self, x_mm: float, out: NDArray[np.floating]) -> None:
        """Fill one frame.

        Parameters
        ----------
        x_mm
            Where the array's centre is; anything that is not on the line, NaN
            among it, gives the idle frame.
        out : float[rows, columns]
            Deflections, 0 … 1. It need not be contiguous, but each new kind of
            array is compiled for, once, in some seconds.

        Raises
        ------
        ValueError
            If ``out`` has not the shape of the array.
        """
        kernels.frame(self._work, self._gains, x_mm, out)

    def path(
        self, x_mm: NDArray[np.float64], out: NDArray[np.float32] | None = None
    ) -> NDArray[np.float32]:
        """Fill the frames of a path of positions.

        Parameters
        ----------
        x_mm : float64[n]
            Where the array's centre is.
        out : float32[n, rows, columns], optional
            Where to put them; made if not given.

        Returns
        -------
        float32[n, rows, columns]
            Deflections, 0 … 1.

        Raises
        ------
        ValueError
            If ``out`` has not that shape.
        """
        x_mm = np.ascontiguousarray(x_mm, np.float64)
        shape = (x_mm.size, *self.array.shape)
        if out is None:
            out = np.empty(shape, np.float32)
        elif out.shape != shape:
            raise ValueError(f"the frames have shape {out.shape}; it must be {shape}")
        kernels.path(self._work, self._gains, x_mm, out)
        return out


def _shape(profile: Profile, tuning: Tuning) -> NDArray[np.float64]:
    """Coefficients by which the kernels compute a dot's profile; float64[6]."""
    shape = np.zeros(6)
    if profile is Profile.HALF_SINE:
        shape[0] = 1 / half_sine_peak(tuning.texture)
        shape[1] = tuning.texture * shape[0]  # a = T / 8, and sin 8θ brings a factor of 8
    else:
        odd = chebyshev.cheb2poly([0] * tuning.cycles + [1])[1::2]  # of T_k, k odd
        shape[: odd.size] = tuning.texture * odd / 2
        shape[0] += (1 - tuning.texture) / 2
    return shape
