"""Costs of a picture's frames: time against place and velocity, and the share of each element.

Lévesque 2009, 8.5.2: the time of a whole frame as a function of where the display is, on a path
(fig. 8.30), as a histogram and as a map (fig. 8.31). Budgets are 8.5.3's. Signals have what a frame
costs depend on the hand's velocity, too (9.6, fig. 9.14).
"""

from __future__ import annotations

import io
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from msgspec.structs import replace

from vbraille.feeling.index import label_of
from vbraille.render import kernels, work
from vbraille.render.program import scratch_for
from vbraille.render.scene.compiling import compile_scene
from vbraille.scene.bounds import bounds

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.feeling.loading import LoadedScene
    from vbraille.feeling.paths import PosedPath
    from vbraille.render.program import Program
    from vbraille.scene.scene import Canvas

# A millisecond for 64 actuators: Lévesque 2009, 8.5.3.
FRAME_BUDGET_US: Final = 1000.0
ACTUATOR_BUDGET_US: Final = FRAME_BUDGET_US / 64
# A batch is long against the clock's resolution, and short on the way: 1 mm at 60 mm/s.
BATCH_FRAMES: Final = 16
REPEATS: Final = 7
_CLOCK_LOOKS: Final = 200
_MAP_MM: Final = 2.0
_MOST_TILES: Final = 500
_MOST_ELEMENTS: Final = 200
_BARS: Final = 12
_BLOCK_FRAMES: Final = 16_384
_SPEEDS: Final = 5  # classes in words, and in pictures squares to either side of rest
_PLANE: Final = 9
_LEAST_SPEED_MM_S: Final = 1.0  # of the fastest class
# Directions of the hand, a quarter turn each around the angle from +x towards +y.
_DIRECTIONS: Final = ("right", "down", "left", "up")


@dataclass(frozen=True, slots=True, eq=False)
class Costs:
    """Time of a frame at places on a path.

    Parameters
    ----------
    x_mm, y_mm : float64[n]
        Middle of the places of each batch of frames.
    vx_mm_s, vy_mm_s : float64[n]
        Velocity of the hand there.
    frame_us : float64[n]
        Time of a frame there: the median of repeats, each of which is a batch's time divided by
        its frames.
    actuators
        Number of actuators in a frame.
    resolution_us
        Smallest difference that the clock tells, divided by the frames of a batch.
    """

    x_mm: NDArray[np.float64]
    y_mm: NDArray[np.float64]
    vx_mm_s: NDArray[np.float64]
    vy_mm_s: NDArray[np.float64]
    frame_us: NDArray[np.float64]
    actuators: int
    resolution_us: float

    @property
    def actuator_us(self) -> float:
        """Mean time of an actuator."""
        return float(self.frame_us.mean()) / self.actuators


@dataclass(frozen=True, slots=True)
class VelocityCost:
    """Cost of frames under a hand that goes in a direction, at speeds of a class.

    Parameters
    ----------
    from_mm_s, to_mm_s
        The speeds.
    direction
        Direction, within 45° to either side: "right", "down", "left" or "up".
    mean_us, most_us
        Mean and greatest time of a frame.
    """

    from_mm_s: float
    to_mm_s: float
    direction: str
    mean_us: float
    most_us: float


@dataclass(frozen=True, slots=True)
class ElementCost:
    """Share of an element in the time of frames.

    Parameters
    ----------
    name
        Title or id of the element, or its number.
    mean_us
        How much longer a frame takes with it than without it, on average over the path.
    most_us
        The same at the place where that is most.
    """

    name: str
    mean_us: float
    most_us: float


@dataclass(frozen=True, slots=True, eq=False)
class CostMap:
    """Mean cost of a frame per place of the canvas, or per velocity of the hand.

    Parameters
    ----------
    mean_us : float64[rows, columns]
        Mean over the frames in each square; NaN where there were none.
    step
        Side of a square, in mm or mm/s. The first square of places begins at the upper left corner
        of the canvas; rest is in the middle of those of velocities.
    """

    mean_us: NDArray[np.float64]
    step: float


def measure(program: Program, path: PosedPath, repeats: int = REPEATS) -> Costs:
    """Time the frames of a program along a path, in batches, in compiled code.

    The frames of a batch follow each other on the path, as a hand would have them. All batches are
    timed one after the other, and then all again, so that what disturbs the machine for a moment
    falls on one of the repeats.

    Parameters
    ----------
    program
        The picture.
    path
        Path of the array; frames that do not fill a batch are left out.
    repeats
        How often each batch is timed.

    Raises
    ------
    ValueError
        If the path has less than one batch of frames.
    """
    at = _batches_of(path)
    _remember(program, at)
    # A call that makes no frame takes time, too, which is no part of what frames cost.
    empty_ns = np.median(_time_ns(program, at[:1, :0], _CLOCK_LOOKS))
    taken_ns = np.median(_time_ns(program, at, repeats), axis=0)
    middle = at.mean(axis=1)
    return Costs(
        middle[:, work.X],
        middle[:, work.Y],
        middle[:, work.VX],
        middle[:, work.VY],
        np.maximum(taken_ns - empty_ns, 0) / BATCH_FRAMES / 1000,
        program.shape[0] * program.shape[1],
        _resolution_ns() / BATCH_FRAMES / 1000,
    )


def _batches_of(path: PosedPath) -> NDArray[np.float64]:
    """Put the poses of a path into batches, as float64[batches, frames, AT] of `work`'s columns.

    Raises
    ------
    ValueError
        If the path has less than one batch of frames.
    """
    batches = path.t_s.size // BATCH_FRAMES
    if not batches:
        raise ValueError(f"a path of {path.t_s.size} frames is too short to be timed")
    count = batches * BATCH_FRAMES
    at = np.zeros((count, work.AT))
    at[0, work.MEMORY] = np.nan  # so that the first begins with what signals are at first
    at[:, work.X], at[:, work.Y] = path.x_mm[:count], path.y_mm[:count]
    at[:, work.THETA], at[:, work.TIME] = path.theta_rad[:count], path.t_s[:count]
    at[:, work.VX : work.VY + 1] = path.velocity_mm_s[:count]
    return at.reshape(batches, BATCH_FRAMES, work.AT)


def _remember(program: Program, at: NDArray[np.float64]) -> None:
    """Fill in the signals at each pose and what they remember, so that a batch can begin anywhere.

    Parameters
    ----------
    program
        The picture.
    at : float64[batches, frames, AT]
        Poses, as `_batches_of` has them.
    """
    rows = at.reshape(-1, work.AT)
    scratch = scratch_for(program.shape, program.kind)
    for start in range(0, len(rows), _BLOCK_FRAMES):
        block = rows[max(start - 1, 0) : start + _BLOCK_FRAMES]  # after the last one before
        parts, out = np.zeros(len(block), np.int64), np.empty((len(block), *program.shape), "f4")
        kernels.poses(program.numbers, program.table, scratch, block, parts, out)


def _time_ns(program: Program, at: NDArray[np.float64], repeats: int) -> NDArray[np.int64]:
    """Time the frames of a program, batch by batch.

    Parameters
    ----------
    program
        The program.
    at : float64[batches, frames, AT]
        Poses, as `_batches_of` has them.
    repeats
        How often each batch is timed.

    Returns
    -------
    int64[repeats, batches]
        Time of each batch in ns.
    """
    batches, frames, _ = at.shape
    parts = np.zeros(frames, np.int64)
    out = np.empty((frames, *program.shape), np.float32)
    scratch = scratch_for(program.shape, program.kind)
    taken_ns = np.empty((repeats, batches), np.int64)
    numbers, table = program.numbers, program.table
    kernels.poses(numbers, table, scratch, at[0], parts, out)  # compiled, or loaded
    now_ns = time.perf_counter_ns
    for repeat in range(repeats):
        for batch in range(batches):
            begun_ns = now_ns()
            kernels.poses(numbers, table, scratch, at[batch], parts, out)
            taken_ns[repeat, batch] = now_ns() - begun_ns
    return taken_ns


def _resolution_ns() -> int:
    """Smallest step of the clock that is seen."""
    steps = []
    for _ in range(_CLOCK_LOOKS):
        first = now = time.perf_counter_ns()
        while now == first:
            now = time.perf_counter_ns()
        steps.append(now - first)
    return min(steps)


def cost_map(costs: Costs, canvas: Canvas, step_mm: float = _MAP_MM) -> CostMap:
    """Compute the mean cost of a path in each square of the canvas: Lévesque 2009, fig. 8.31.

    Parameters
    ----------
    costs
        What was measured.
    canvas
        The canvas.
    step_mm
        Side of a square; it is larger where there would be more than 500 of them in a row.
    """
    step_mm = max(step_mm, canvas.width_mm / _MOST_TILES, canvas.height_mm / _MOST_TILES)
    columns = int(np.ceil(canvas.width_mm / step_mm))
    rows = int(np.ceil(canvas.height_mm / step_mm))
    edges = np.arange(rows + 1) * step_mm, np.arange(columns + 1) * step_mm
    return CostMap(_means(costs.y_mm, costs.x_mm, edges, costs.frame_us), step_mm)


def velocity_map(costs: Costs) -> CostMap:
    """Compute the mean cost of a path in each square of velocities: Lévesque 2009, fig. 9.14b."""
    step_mm_s = 2 * _fastest(costs) / (_PLANE - 1)
    edges = (np.arange(_PLANE + 1) - _PLANE / 2) * step_mm_s
    means = _means(costs.vy_mm_s, costs.vx_mm_s, (edges, edges), costs.frame_us)
    return CostMap(means, step_mm_s)


def _means(
    down: NDArray[np.float64],
    right: NDArray[np.float64],
    edges: tuple[NDArray[np.floating], NDArray[np.floating]],
    values: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Means of values in each square of a plane; NaN where there are none."""
    sums, *_ = np.histogram2d(down, right, edges, weights=values)
    counts, *_ = np.histogram2d(down, right, edges)
    with np.errstate(invalid="ignore"):
        return sums / counts


def _fastest(costs: Costs) -> float:
    """Greatest speed of the hand along an axis, mm/s."""
    velocities = np.abs((costs.vx_mm_s, costs.vy_mm_s))
    return max(float(velocities.max()), _LEAST_SPEED_MM_S)


def costs_by_velocity(costs: Costs) -> list[VelocityCost]:
    """Costs by classes of speed, and by direction within each; classes without frames are none."""
    speeds = np.hypot(costs.vx_mm_s, costs.vy_mm_s)
    width = max(float(speeds.max()), _LEAST_SPEED_MM_S) / _SPEEDS
    turns = np.arctan2(costs.vy_mm_s, costs.vx_mm_s) / (np.pi / 2)
    quarters = np.rint(turns).astype(int) % len(_DIRECTIONS)
    classes = np.minimum(speeds // width, _SPEEDS - 1)
    found = []
    for number in range(_SPEEDS):
        for quarter, direction in enumerate(_DIRECTIONS):
            frame_us = costs.frame_us[(classes == number) & (quarters == quarter)]
            if frame_us.size:
                mean_us, most_us = float(frame_us.mean()), float(frame_us.max())
                ends = number * width, (number + 1) * width
                found.append(VelocityCost(*ends, direction, mean_us, most_us))
    return found


def histogram(costs: Costs) -> list[tuple[float, float, float]]:
    """Lower and upper end in µs, and share of the frames, of each bar of a histogram."""
    low, high = float(costs.frame_us.min()), float(costs.frame_us.max())
    shares, edges = np.histogram(costs.frame_us, bins=_BARS, range=(low, max(high, low + 1e-3)))
    return [
        (float(begin), float(end), float(n) / costs.frame_us.size)
        for begin, end, n in zip(edges[:-1], edges[1:], shares, strict=True)
    ]


def to_csv(costs: Costs) -> str:
    """Write costs as CSV, with the place and the velocity of each."""
    written = io.StringIO()
    names = "x_mm", "y_mm", "vx_mm_s", "vy_mm_s", "frame_us"
    rows = np.stack([getattr(costs, name) for name in names], axis=-1)
    np.savetxt(written, rows, "%.4f", ",", header=",".join(names), comments="")
    return written.getvalue()


def costs_of_elements(
    loaded: LoadedScene, display: Display, path: PosedPath, rate_hz: float, repeats: int = REPEATS
) -> Iterator[ElementCost]:
    """Time frames with and without each element of a scene, of the first 200 elements.

    An element is taken out of the scene for that; what it hid is then shown, and costs instead. It
    is timed where the array comes near it, and counts for nothing elsewhere.

    Parameters
    ----------
    loaded
        The scene.
    display
        Display that it is rendered for.
    path
        Path of the array.
    rate_hz
        Frames a second.
    repeats
        How often each batch of frames is timed.
    """
    scene, known = loaded.scene, loaded.boxes()
    whole = compile_scene(scene, display, loaded.assets, rate_hz=rate_hz)
    reach_mm = float(np.hypot(display.span_mm, display.depth_mm)) / 2
    batches = path.t_s.size // BATCH_FRAMES
    for number, element in enumerate(scene.elements[:_MOST_ELEMENTS]):
        box = bounds(element, known)
        near = path
        if box is not None:
            near = path.only(
                (path.x_mm >= box.left - reach_mm)
                & (path.x_mm <= box.right + reach_mm)
                & (path.y_mm >= box.top - reach_mm)
                & (path.y_mm <= box.bottom + reach_mm)
            )
        name = label_of(element) or f"number {number + 1}"
        if near.t_s.size < BATCH_FRAMES:
            yield ElementCost(name, 0.0, 0.0)
            continue
        others = scene.elements[:number] + scene.elements[number + 1 :]
        less = replace(scene, elements=others)
        without = compile_scene(less, display, loaded.assets, rate_hz=rate_hz)
        more_us = measure(whole, near, repeats).frame_us - measure(without, near, repeats).frame_us
        yield ElementCost(name, float(more_us.sum()) / batches, float(more_us.max()))
