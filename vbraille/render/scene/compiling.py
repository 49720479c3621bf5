"""Scenes, compiled for a display, or for rasters of the whole canvas.

`vbraille.render.machine.words` has what their programs say.
"""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from vbraille.render import work
from vbraille.render.machine import signalkernels, words
from vbraille.render.program import Program, head
from vbraille.render.scene.grid import TileGrid, assemble, flatten
from vbraille.render.scene.labels import Assets
from vbraille.render.scene.nodes import NodeKind, joined
from vbraille.render.scene.trees import ONE, deflection, layer, mask
from vbraille.render.work import ProgramKind
from vbraille.scene.patterns import Group, Moving
from vbraille.scene.signals import Direction, Inverse, Product, Pulse, Speed, Switch, ordered
from vbraille.scene.traversal import drawn_vibrations, driving, each

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.render.scene.grid import Flat
    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.scene import Scene
    from vbraille.scene.signals import OrderedSignal

_KINDS = {
    "multiply": NodeKind.MULTIPLY,
    "add": NodeKind.ADD,
    "maximum": NodeKind.MAXIMUM,
    "overwrite": NodeKind.OVER,
}


_AT_REST = {"high": signalkernels.HIGH, "low": signalkernels.LOW, "keep": signalkernels.KEEP}
_SHAPES = {
    "sine": signalkernels.SINE,
    "square": signalkernels.SQUARE,
    "ramp": signalkernels.RAMP,
}


def compile_scene(
    scene: Scene,
    display: Display,
    assets: Assets | None = None,
    *,
    rate_hz: float = 1000.0,
    pruned: bool = True,
) -> Program:
    """Compile a scene for a display.

    Parameters
    ----------
    scene
        A resolved scene: without `Use` and `ImageDots`.
    display
        Display that shows it.
    assets
        Bitmaps of its images and cells of its labels.
    rate_hz
        Frames a second, of which a vibration may take half.
    pruned
        Whether what an actuator cannot touch is left out; only tests and benchmarks do without.

    Raises
    ------
    ValueError
        If a frequency is above half of the rate, or patterns stand too deep in each other.
    """
    moves_hz = [
        highest_hz(element, number, rate_hz) for number, element in enumerate(scene.elements, 1)
    ]
    moves_hz += [1.0 / one.period_s for one in scene.signals.values() if isinstance(one, Pulse)]
    flat = flatten_scene(scene, assets or Assets())
    radius_mm = 0.5 * math.hypot(display.span_mm, display.depth_mm)
    grid = TileGrid.over(scene.canvas, radius_mm, pruned)
    numbers = head(display, ProgramKind.SCENE, words.GRID)
    numbers[words.COLUMN_MM] = display.column_pitch_mm
    numbers[words.ROW_MM] = display.row_pitch_mm
    numbers[work.FREQUENCY] = max(moves_hz, default=0.0)
    numbers[work.AMPLITUDE] = numbers[work.FREQUENCY] > 0.0
    numbers[words.SIGNALS : words.GRID] = signal_numbers(scene)
    return Program(*assemble(numbers, scene.canvas, grid, flat))


def flatten_scene(scene: Scene, assets: Assets) -> Flat | None:
    """Make plain arrays of a scene; None if there is nothing in it.

    Raises
    ------
    ValueError
        If patterns stand too deep in each other, or elements cannot be put together by the scene's
        operation.
    """
    if scene.operation not in _KINDS:
        raise ValueError(
            f'operation = "{scene.operation}" is for groups; put the elements into one'
        )
    if not scene.elements:
        return None
    assets = _with_signals(scene, assets)
    node = layer if scene.operation == "overwrite" else deflection
    elements = tuple(node(element, assets) for element in scene.elements)
    return flatten(joined(_KINDS[scene.operation], elements))


def _with_signals(scene: Scene, assets: Assets) -> Assets:
    """Assets of a scene, with the numbers of its signals by their names."""
    if not scene.signals:
        return assets
    numbers = {
        one.name if one.signal is not None else f"∫{one.name}": number
        for number, one in enumerate(ordered(scene.signals, driving(*scene.elements)))
    }
    return replace(assets, signals=numbers)


def signal_numbers(scene: Scene) -> NDArray[np.float64]:
    """Numbers of a scene's signals, as `signalkernels` takes them; float64[GRID - SIGNALS].

    Raises
    ------
    ValueError
        If there are more than 8 with the integrals of those that are the speed of a motion.
    """
    order = ordered(scene.signals, driving(*scene.elements)) if scene.signals else []
    if len(order) > work.MOST_SIGNALS:
        raise ValueError(
            f"there are {len(order)} signals, where each that is the speed of a motion counts "
            f"twice; there can be {work.MOST_SIGNALS}"
        )
    numbers = np.zeros(words.GRID - words.SIGNALS)
    numbers[0] = len(order)
    rows = numbers[1:].reshape(work.MOST_SIGNALS, words.SIGNAL_NUMBERS)
    for row, one in zip(rows, order, strict=False):
        own = _signal(one)
        row[: len(own)] = own
    return numbers


def _signal(one: OrderedSignal) -> tuple[float, ...]:
    """Numbers of a signal: its kind, and what `signalkernels` says of that."""
    match one.signal:
        case Speed() as speed:
            end = speed.below_mm_s + speed.transition_mm_s
            return (signalkernels.SPEED, speed.below_mm_s, end, speed.delay_s)
        case Direction() as way:
            angle = math.remainder(math.radians(way.angle_deg), 2.0 * math.pi)
            slow = way.below_mm_s, way.below_mm_s + way.slow_transition_mm_s
            last = way.tolerance_deg + way.transition_deg
            away = math.radians(way.tolerance_deg), math.radians(last)
            rest = _AT_REST[way.at_rest]
            return (signalkernels.DIRECTION, angle, *slow, *away, float(way.axis), rest)
        case Switch() as switch:
            count = float(len(switch.levels))
            return (signalkernels.SWITCH, switch.fade_s, count, *switch.levels)
        case Pulse() as clock:
            return (signalkernels.CLOCK, _SHAPES[clock.shape], clock.period_s)
        case Product():
            return (signalkernels.PRODUCT, float(len(one.of)), *map(float, one.of))
        case Inverse():
            return (signalkernels.INVERSE, 1.0, float(one.of[0]))
    return (signalkernels.INTEGRAL, 1.0, float(one.of[0]))


def settled(scene: Scene, velocity_mm_s: Point = (0.0, 0.0), switches: int = 0) -> Scene:
    """Make the scene as it is under a hand that goes on at one velocity: Lévesque 2009, 9.6.

    Signals by the hand and by switches are as they have become then, and change no more.

    Parameters
    ----------
    scene
        A resolved scene.
    velocity_mm_s, switches
        The velocity, and states of the switches, as `vbraille.scene.signals.packed` has them.
    """
    values = SceneMap(scene).signal_values(0.0, velocity_mm_s, switches)
    signals = {
        one.name: Switch(levels=(value, value))
        for one, value in zip(ordered(scene.signals), values.tolist(), strict=False)
        if isinstance(one.signal, Speed | Direction | Switch)
    }
    return msgspec.structs.replace(scene, signals={**scene.signals, **signals})


def highest_hz(pattern: AnyPattern, number: int, rate_hz: float) -> float:
    """Find the highest frequency of what moves in an element by itself; 0 if nothing does.

    Parameters
    ----------
    pattern, number
        The element, and its number in the scene, from 1.
    rate_hz
        Frames a second that show it.

    Raises
    ------
    ValueError
        If a frequency is above half of the rate, so that it would be shown as another.
    """
    highest = 0.0
    for part in each(pattern):
        for hz in _frequencies(part):
            if hz > rate_hz / 2:
                name = part.id or pattern.id
                named = f'"{name}"' if name else f"number {number}"
                raise ValueError(
                    f"element {named} moves at {hz:g} Hz; it can be at most half of the rate, "
                    f"{rate_hz / 2:g} Hz"
                )
            highest = max(highest, hz)
    return highest


def _frequencies(pattern: AnyPattern) -> Iterator[float]:
    """Frequencies of a pattern itself, without those that stand in it."""
    for vibration in (pattern.vibration, *drawn_vibrations(pattern)):
        if vibration is not None and vibration.amplitude > 0.0:
            yield vibration.frequency_hz
    yield from (flow.flow_hz for flow in pattern.flows)
    if isinstance(pattern, Moving) and any(pattern.velocity_mm_s):
        yield _MOVING_HZ


_THREADS = 2
_MOVING_HZ = 1.0  # of what moves at any length of its waves
_Numbers = tuple["NDArray[np.float64]", "NDArray[np.uint16]", TileGrid]


class SceneMap:
    """A scene as a whole, for pictures of it.

    Parameters
    ----------
    scene
        A resolved scene: without `Use` and `ImageDots`.
    assets
        Bitmaps of its images and cells of its labels.

    Raises
    ------
    ValueError
        If patterns stand too deep in each other.
    """

    def __init__(self, scene: Scene, assets: Assets | None = None) -> None:
        self._scene, self._assets = scene, assets or Assets()
        self._shown: _Numbers | None = None
        self._hiding: _Numbers | None = None

    def deflections(
        self,
        x_mm: NDArray[np.float64],
        y_mm: NDArray[np.float64],
        *,
        time_s: float = 0.0,
        parity: int = 0,
        noise_seed: int | None = None,
        velocity_mm_s: Point = (0.0, 0.0),
        switches: int = 0,
    ) -> NDArray[np.float32]:
        """Compute the deflections of actuators at the places of a raster: Lévesque 2009, 8.3.3.

        Parameters
        ----------
        x_mm, y_mm : float64[w], float64[h]
            Places of its columns and lines on the canvas.
        time_s
            Time since the scene was first shown, in seconds.
        parity
            0 for actuators whose column and row are both even or both odd, 1 for the others.
        noise_seed
            Seed of the noise that stands for vibrations; None shows them as they are at the time.
            Gratings that travel stand where they do at first then.
        velocity_mm_s, switches
            Velocity of the hand for as long as signals remember, and states of the switches, as
            `vbraille.scene.signals.packed` has them.

        Returns
        -------
        float32[h, w]
            Deflections, 0 … 1; 0 beyond the canvas.
        """
        if self._shown is None:
            self._shown = self._assemble(flatten_scene(self._scene, self._assets))
        given = self.signal_values(time_s, velocity_mm_s, switches)
        return _raster(self._shown, x_mm, y_mm, time_s, parity, noise_seed, given)

    def opacity(
        self,
        x_mm: NDArray[np.float64],
        y_mm: NDArray[np.float64],
        *,
        time_s: float = 0.0,
        parity: int = 0,
        noise_seed: int | None = None,
        velocity_mm_s: Point = (0.0, 0.0),
        switches: int = 0,
        every_layer: bool = False,
    ) -> NDArray[np.float32]:
        """Compute the opacity mask of the scene at the places of a raster: Lévesque 2009, 8.4.5.

        The arguments are those of `deflections`, and whether all signals are 1, so that every layer
        is there; only the mask of a blend that is chosen by what moves depends on the time. A scene
        of one element has the mask of that.

        Returns
        -------
        float32[h, w]
            Opacity, 0 … 1; 0 beyond the canvas.
        """
        if self._hiding is None:
            self._hiding = self._assemble(self._mask())
        given = self.signal_values(time_s, velocity_mm_s, switches)
        if every_layer:
            given[: work.MOST_SIGNALS] = 1.0
        return _raster(self._hiding, x_mm, y_mm, time_s, parity, noise_seed, given)

    def _mask(self) -> Flat | None:
        elements = self._scene.elements
        if not elements:
            return None
        whole = Group(operation=self._scene.operation, parts=elements)
        assets = _with_signals(self._scene, self._assets)
        tree = mask(elements[0] if len(elements) == 1 else whole, assets)
        return flatten(ONE if tree is None else tree)

    def signal_values(
        self, time_s: float, velocity_mm_s: Point, switches: int
    ) -> NDArray[np.float64]:
        """Compute the signals, in their order; then NaN, as no array has a centre: float64[10]."""
        at = np.zeros(work.AT)
        if self._scene.signals:
            at[work.TIME], at[work.SWITCHES] = time_s, switches
            at[work.VX], at[work.VY] = velocity_mm_s
            numbers = self._head()
            signalkernels.begin(numbers, at)
            signalkernels.compute(numbers, at, 0.0)
        return np.append(at[work.SIGNAL : work.MEMORY], (math.nan, math.nan))

    def _head(self) -> NDArray[np.float64]:
        head = np.zeros(words.GRID)
        head[work.KIND] = ProgramKind.SCENE
        head[words.SIGNALS :] = signal_numbers(self._scene)
        return head

    def _assemble(self, flat: Flat | None) -> _Numbers:
        head = self._head()
        grid = TileGrid.over(self._scene.canvas, 0.0)
        return (*assemble(head, self._scene.canvas, grid, flat), grid)


def _raster(
    compiled: _Numbers,
    x_mm: NDArray[np.float64],
    y_mm: NDArray[np.float64],
    time_s: float,
    parity: int,
    noise_seed: int | None,
    given: NDArray[np.float64],
) -> NDArray[np.float32]:
    # Importing kernels loads numba, which only a process that makes pictures has to wait for.
    from vbraille.render.machine import showkernels

    numbers, table, grid = compiled
    x_mm, y_mm = np.ascontiguousarray(x_mm, np.float64), np.ascontiguousarray(y_mm, np.float64)
    out = np.empty((y_mm.size, x_mm.size), np.float32)
    if out.size == 0:
        return out
    noise = np.empty((0, 0), np.float32)
    if noise_seed is not None:
        noise = np.random.default_rng(noise_seed).random(out.shape, np.float32) * 2 - 1
    columns = showkernels.runs(_tiles(x_mm, grid.left_mm, grid.tile_mm, grid.columns))
    lines = showkernels.runs(_tiles(y_mm, grid.top_mm, grid.tile_mm, grid.rows))
    time = math.nan if noise_seed is not None else time_s

    def fill(some: NDArray[np.int64]) -> None:
        rows = np.zeros((words.SCRATCH_ROWS, showkernels.LANES))
        rows[words.GIVEN_ROW, : given.size] = given
        sign = -1.0 if parity else 1.0
        showkernels.raster(numbers, table, rows, x_mm, y_mm, columns, some, sign, noise, time, out)

    # Neighbouring lines cost alike, so the threads take turns.
    with ThreadPoolExecutor(_THREADS) as threads:
        for done in [threads.submit(fill, lines[n::_THREADS].copy()) for n in range(_THREADS)]:
            done.result()
    return out


def _tiles(places_mm: NDArray[np.float64], first_mm: float, tile_mm: float, count: int):
    tiles = np.floor((places_mm - first_mm) / tile_mm)
    return np.where((tiles >= 0) & (tiles < count), tiles, -1)
