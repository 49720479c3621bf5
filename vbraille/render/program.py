"""A picture, compiled for the kernels: plain arrays that say what actuators do at every pose."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.render import work
from vbraille.render.work import ProgramKind

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.display import Display

_BLOCK = 64  # number of places whose swings stay in the processor's nearest cache


class Program:
    """A picture, compiled; it does not change once it is made.

    The engine shows it without knowing what it is a picture of: a program is plain arrays, which
    go through shared memory and files as they are.

    Parameters
    ----------
    numbers : float64[n]
        Numbers at the places that `vbraille.render.work` names; they begin alike for every kind.
    table : uint16[m]
        Table in which the kernel of this kind looks things up.

    Attributes
    ----------
    kind : ProgramKind
        Kind of the picture.
    shape : tuple[int, int]
        Rows and columns of the display that the program was compiled for.
    scratch : float64[m, n]
        Room to work in, for one kernel at a time.
    """

    __slots__ = ("_at", "_fill", "_last", "kind", "numbers", "scratch", "shape", "table")

    def __init__(self, numbers: NDArray[np.float64], table: NDArray[np.uint16]) -> None:
        self.numbers = numbers
        self.table = table
        self.kind = ProgramKind(int(numbers[work.KIND]))
        rows, columns = self.shape = int(numbers[work.ROWS]), int(numbers[work.COLUMNS])
        # A line's path is made of several places at once; a scene has room for its instructions.
        places = max(rows, _BLOCK) * columns
        more = numbers[work.INSTRUCTIONS] // places + 1 if self.kind is ProgramKind.SCENE else 0
        self.scratch = np.zeros((work.LIVE_ROW + int(more), places))
        self._at = np.zeros(work.AT)
        self._last: NDArray[np.float64] | None = None  # at which the last frame of a way was made
        self._fill = None  # the kernel, which loads numba

    @property
    def nbytes(self) -> int:
        """Number of bytes that the program takes in memory."""
        return self.numbers.nbytes + self.table.nbytes

    @property
    def own_y_mm(self) -> float:
        """Place on the canvas, along y, of an array whose carriage measures no y."""
        return float(self.numbers[work.OWN_Y])

    def check_shape(self, shape: tuple[int, int]) -> None:
        """Compare the program's shape with that of the display that is to show it.

        Raises
        ------
        ValueError
            If the program was compiled for another array.
        """
        if self.shape != shape:
            raise ValueError(
                f"the picture is for {self.shape[0]} × {self.shape[1]} actuators; "
                f"the device has {shape[0]} × {shape[1]}"
            )

    def frame(
        self,
        x_mm: float,
        out: NDArray[np.floating],
        *,
        y_mm: float | None = None,
        theta_rad: float = 0.0,
        part: int = 0,
        time_s: float = 0.0,
    ) -> None:
        """Fill one frame, however far the array is turned.

        Signals of a scene are as under a hand that stands still, with all switches as at first.

        Parameters
        ----------
        x_mm
            Place of the array's centre. A place that is not on the picture gives the idle frame,
            and so does NaN.
        out : float64[rows, columns]
            Deflections, 0 … 1.
        y_mm
            Place of the array's centre down the page, which matters where each actuator shows
            what lies under it; None for that of a carriage that measures no y.
        theta_rad
            Angle by which the array is turned, in radians.
        part
            Number of the part of the picture that is shown: a line of a page.
        time_s
            The picture's own time, in seconds since its start.

        Raises
        ------
        ValueError
            If ``out`` has another shape than the array.
        """
        if self._fill is None:
            # Importing kernels loads numba, which only a process that makes frames waits for.
            from vbraille.render import kernels

            self._fill = kernels.frame
        at = self._at
        at[work.X], at[work.THETA], at[work.TIME] = x_mm, theta_rad, time_s
        at[work.Y] = self.own_y_mm if y_mm is None else y_mm
        if self.kind is ProgramKind.SCENE:
            from vbraille.render import signalkernels

            signalkernels.begin(self.numbers, at)
            signalkernels.compute(self.numbers, at, 0.0)
        self._fill(self.numbers, self.table, self.scratch, part, at, out)

    def path(self, x_mm: NDArray[np.float64]) -> NDArray[np.float32]:
        """Fill the frames of a line for many places; much faster than `frame` for each.

        Parameters
        ----------
        x_mm : float64[n]
            Places of the array's centre.

        Returns
        -------
        float32[n, rows, columns]
            Deflections, 0 … 1.

        Raises
        ------
        ValueError
            If the picture is no line.
        """
        from vbraille.render import kernels

        if self.kind is not ProgramKind.LINE:
            raise ValueError(f"a {self.kind.name.lower()} has no frames along a line")
        x_mm = np.ascontiguousarray(x_mm, np.float64)
        out = np.empty((x_mm.size, *self.shape), np.float32)
        kernels.path(self.numbers, self.table, self.scratch, x_mm, out)
        return out

    def poses(
        self,
        x_mm: NDArray[np.float64],
        y_mm: NDArray[np.float64],
        theta_rad: NDArray[np.float64] | float = 0.0,
        time_s: NDArray[np.float64] | float = 0.0,
        velocity_mm_s: NDArray[np.float64] | float = 0.0,
        switches: NDArray[np.int64] | int = 0,
        *,
        going_on: bool = False,
    ) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """Fill the frames of a way over the canvas.

        Parameters
        ----------
        x_mm, y_mm, theta_rad : float64[n]
            Places of the array's centre, and angles by which the array is turned.
        time_s : float64[n]
            The picture's own time at each, in seconds since its start.
        velocity_mm_s : float64[n, 2]
            Velocity of the array along x and y.
        switches : int64[n]
            States of a scene's switches, as `vbraille.scene.signals.packed` has them.
        going_on
            Whether the way goes on where the last call's ended, and signals remember that.

        Returns
        -------
        int64[n], float32[n, rows, columns]
            Parts that belong under the array, and deflections, 0 … 1. Where one part follows
            another nothing fades: fades take time, and are left to the engine.
        """
        from vbraille.render import kernels

        at = np.zeros((x_mm.size, work.AT))
        at[:, work.X], at[:, work.Y], at[:, work.THETA] = x_mm, y_mm, theta_rad
        at[:, work.TIME] = time_s
        at[:, work.VX : work.VY + 1] = velocity_mm_s
        at[:, work.SWITCHES] = switches
        at[:1, work.MEMORY :] = np.nan
        before = 0
        if going_on and self._last is not None:
            at = np.concatenate([self._last, at])
            before = 1
        parts = np.zeros(len(at), np.int64)
        out = np.empty((len(at), *self.shape), np.float32)
        made = np.empty(self.shape)
        kernels.poses(self.numbers, self.table, self.scratch, at, made, parts, out)
        self._last = at[-1:].copy() if len(at) else self._last
        return parts[before:], out[before:]


def head(
    display: Display, kind: ProgramKind, places: int, own_y_mm: float = 0.0
) -> NDArray[np.float64]:
    """Make the numbers of a program that does not move by itself, of a given size."""
    numbers = np.zeros(places)
    numbers[work.KIND] = kind
    numbers[work.OWN_Y] = own_y_mm
    numbers[work.TILT] = math.inf
    numbers[work.ROWS], numbers[work.COLUMNS] = display.shape
    numbers[work.COLUMN_PITCH] = display.column_pitch_mm
    numbers[work.ROW_PITCH] = display.row_pitch_mm
    return numbers


def nothing(display: Display) -> Program:
    """Make a line without a dot, for times when there is nothing to show."""
    places = work.CELLS + work.CELL_NUMBERS + 2 * display.rows
    numbers = head(display, ProgramKind.LINE, places)
    numbers[work.CELLS :][[work.CELL_PITCH, work.DOT_WIDTH, work.APART]] = 1.0
    return Program(numbers, np.zeros(4, np.uint16))
