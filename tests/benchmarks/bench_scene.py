"""Tactile pictures: what a frame, a tick, a map and compiling them take."""

from __future__ import annotations

import statistics
from time import perf_counter, perf_counter_ns
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from tests.benchmarks.scenes import (
    CANVAS,
    DISPLAY,
    along_teeth,
    answering,
    hidden,
    masked,
    nested,
    shapes,
    short_lines,
    ten_parts,
    through_tens,
    toothed,
    within_ten,
    without_signals,
)
from tests.benchmarks.timing import Result, ratio, seconds
from vbraille.engine.clock import ManualClock
from vbraille.engine.loop import Loop
from vbraille.render.compiling import SceneMap, compile_scene
from vbraille.render.labels import Assets
from vbraille.render.program import nothing
from vbraille.scene.patterns import PathShape
from vbraille.simulation.simulated import SimulatedDevice

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.render.program import Program
    from vbraille.scene.scene import Scene

FEW, MANY = 100, 10_000
TEETH = 50, 98  # of a comb of nearly as many segments, and the steps of each
PLACES = 1000
SWEEPS = 11
TICKS = 5000
SIGNAL_PAIRS = 5
PIXELS = 1000


def run() -> Iterator[Result]:
    """Measure, and compare with what is asked for."""
    yield frame_from_python(masked(), "two gratings through an image mask", 15, 3)
    yield frame_from_python(nested(), "ten parts in each other under every actuator", 60, 12)
    yield from many()
    yield outline()
    yield from compiling()
    yield maps()
    yield ticks()
    yield from signals()
    yield moving()


def moving() -> Result:
    """A frame of ten parts that move, about one place, against the same that stand still."""
    places = np.random.default_rng(3).uniform(-12, 12, (PLACES, 2))
    places += np.array((CANVAS.width_mm, CANVAS.height_mm)) / 2
    moving, still = (compile_scene(ten_parts(speed), DISPLAY) for speed in (20.0, 0.0))
    (x_mm, y_mm), time_s = places.T.copy(), np.linspace(5.0, 6.0, PLACES)

    def frames(program: Program) -> Callable[[], object]:
        return lambda: program.poses(x_mm, y_mm, 0.0, time_s)

    share, least = ratio(frames(moving), frames(still), pairs=101)
    return Result(
        "a frame of a picture of ten moving parts, against the same parts still",
        "≤ 1.3 ×",
        f"{share:.2f} ×, {least / PLACES * 1e6:.2f} µs",
        share <= 1.3,
    )


def signals() -> Iterator[Result]:
    """Ticks of a picture with signals against the same without, and of one whose layers are off."""
    with_eight, without = (
        compile_scene(scene, DISPLAY) for scene in (answering(), without_signals(answering()))
    )
    share = statistics.median(
        tick_ns(with_eight, 50) / tick_ns(without, 50) for _ in range(SIGNAL_PAIRS)
    )
    what = "one tick of a picture with 8 signals, half of the ticks, against the same without"
    yield Result(what, "≤ 1.15 ×", f"{share:.2f} ×", share <= 1.15)
    scene = without_signals(answering())
    off = compile_scene(hidden(scene, 4), DISPLAY)
    gone = compile_scene(msgspec.structs.replace(scene, elements=scene.elements[:4]), DISPLAY)
    share = statistics.median(tick_ns(off, 50) / tick_ns(gone, 50) for _ in range(SIGNAL_PAIRS))
    what = "one tick of a picture of 8 layers, 4 of them off, against one without these"
    yield Result(what, "≤ 1.03 ×", f"{share:.2f} ×", share <= 1.03)


def frame_from_python(
    scene: tuple[Scene, Assets], what: str, most: float, most_us: float
) -> Result:
    program = compile_scene(*scene_first(scene))
    random = np.random.default_rng(1)
    places = random.uniform((10, 10), (CANVAS.width_mm - 10, CANVAS.height_mm - 10), (PLACES, 2))
    pairs, out = places.tolist(), np.zeros(DISPLAY.shape)

    def frames() -> None:
        frame = program.frame
        for x_mm, y_mm in pairs:
            frame(x_mm, out, y_mm=y_mm)

    def fills() -> None:
        fill = out.fill
        for _ in pairs:
            fill(0)

    share, least = ratio(frames, fills, pairs=51)
    least_us = least / PLACES * 1e6
    return Result(
        f"one frame from Python, 8 × 8, of {what}, against `out.fill(0)`",
        f"≤ {most} ×, ≤ {most_us} µs",
        f"{share:.1f} ×, {least_us:.2f} µs",
        share <= most and least_us <= most_us,
    )


def scene_first(scene: tuple[Scene, Assets]) -> tuple[Scene, object, Assets]:
    return scene[0], DISPLAY, scene[1]


def poses_of(program: Program, places: np.ndarray) -> Callable[[], object]:
    x_mm, y_mm = places.T.copy()
    return lambda: program.poses(x_mm, y_mm)


def many() -> Iterator[Result]:
    """Many shapes against few: along a path, and at places that no hand goes to one by one."""
    ten, lots = (compile_scene(shapes(count), DISPLAY) for count in (10, MANY))
    within, corners = through_tens(MANY)
    share, least = ratio(
        follow(lots, within, corners), follow(ten, within, 0 * corners), pairs=SWEEPS
    )
    yield Result(
        f"a frame of a picture of {MANY:,} shapes, against one of 10, along a finger's path that "
        "goes once through all of them (the same path through the ten, again and again)",
        "≤ 1.1 ×",
        f"{share:.2f} ×, {least / len(within) / len(corners) * 1e6:.2f} µs",
        share <= 1.1,
    )
    share, least = ratio(
        poses_of(lots, within_ten(MANY, PLACES)), poses_of(ten, within_ten(10, PLACES)), pairs=101
    )
    yield Result(
        "the same at random places all over it, which are seldom in the nearer caches",
        "no bar",
        f"{share:.2f} ×, {least / PLACES * 1e6:.2f} µs",
        True,
    )


def outline() -> Result:
    """One filled path of many segments against one of few, along the same path of a finger."""
    few, many = (compile_scene(toothed(*size), DISPLAY) for size in ((1, 3), TEETH))
    within, corners = along_teeth(*TEETH)
    share, least = ratio(
        follow(many, within, corners), follow(few, within, 0 * corners), pairs=SWEEPS
    )
    return Result(
        f"a frame of one filled path of {segments_of(toothed(*TEETH)):,} segments, against one of "
        f"{segments_of(toothed(1, 3))}, along a finger's path that goes once along all of it",
        "≤ 1.1 ×",
        f"{share:.2f} ×, {least / len(within) / len(corners) * 1e6:.2f} µs",
        share <= 1.1,
    )


def segments_of(scene: Scene) -> int:
    """Tell how many places a scene's only path goes through."""
    (path,) = scene.elements
    assert isinstance(path, PathShape)
    return len(path.contours_mm[0])


def follow(program: Program, within: np.ndarray, corners: np.ndarray) -> Callable[[], object]:
    """Frames along a path within each ten of a picture's shapes."""

    def frames() -> None:
        for corner in corners:
            x_mm, y_mm = (within + corner).T
            program.poses(x_mm, y_mm)

    return frames


def compiling_s(scene: Scene) -> float:
    return statistics.median(seconds(lambda: compile_scene(scene, DISPLAY)) for _ in range(5))


def compiling() -> Iterator[Result]:
    scene = shapes(MANY)
    compile_scene(shapes(10), DISPLAY)
    taken = compiling_s(scene)
    yield Result(f"compiling a picture of {MANY:,} shapes", "≤ 1 s", f"{taken:.2f} s", taken <= 1)
    for size in (TEETH, (2 * TEETH[0], 5 * TEETH[1])):
        comb = toothed(*size)
        taken = compiling_s(comb)
        yield Result(
            f"compiling one filled path of {segments_of(comb):,} segments",
            "≤ 1 s" if size == TEETH else "no bar",
            f"{taken:.2f} s",
            taken <= 1 or size != TEETH,
        )
    scene, out, each = shapes(FEW), np.zeros(DISPLAY.shape), []
    for n in range(21):
        elements = list(scene.elements)
        elements[n] = msgspec.structs.replace(elements[n], amplitude=0.5)
        scene = msgspec.structs.replace(scene, elements=tuple(elements))
        begun = perf_counter()
        compile_scene(scene, DISPLAY).frame(50.0, out, y_mm=50.0)
        each.append(perf_counter() - begun)
    taken_ms = statistics.median(each) * 1e3
    yield Result(
        f"from a change of one of {FEW} shapes to the first frame",
        "≤ 100 ms",
        f"{taken_ms:.0f} ms",
        taken_ms <= 100,
    )


def maps() -> Result:
    """Deflection maps of all of the scenes; the slowest counts."""
    scenes = (masked(), nested(), (short_lines(), Assets()), (shapes(MANY), Assets()))
    times = []
    for scene, assets in scenes:
        shown = SceneMap(scene, assets)
        x_mm = (np.arange(PIXELS) + 0.5) * scene.canvas.width_mm / PIXELS
        y_mm = (np.arange(PIXELS) + 0.5) * scene.canvas.height_mm / PIXELS
        shown.deflections(x_mm[:1], y_mm[:1])
        times.append(min(seconds(lambda: shown.deflections(x_mm, y_mm)) for _ in range(5)))  # noqa: B023
    slowest = max(times)
    return Result(
        f"deflection map of {PIXELS} × {PIXELS}, the slowest of {len(scenes)} pictures",
        "≤ 0.3 s",
        f"{slowest:.2f} s",
        slowest <= 0.3,
    )


def ticks() -> Result:
    """Ticks of the engine with each picture, against those with a line."""
    line_ns = tick_ns(nothing(DISPLAY))
    scenes = (masked(), nested(), (short_lines(), Assets()), (shapes(MANY), Assets()))
    shares = [tick_ns(compile_scene(scene, DISPLAY, assets)) / line_ns for scene, assets in scenes]
    return Result(
        f"one tick of the engine with any of {len(scenes)} pictures, 99th percentile, "
        "against one with a line",
        "≤ 2 ×",
        f"{max(shares):.2f} ×",
        max(shares) <= 2,
    )


def tick_ns(program: Program, percentile: float = 99) -> float:
    """Percentile of the time of a tick with a program; the least of three runs."""
    clock = ManualClock()
    with SimulatedDevice(DISPLAY, clock.now_ns) as device:
        loop = Loop(device, clock)
        loop.show(program)
        taken = np.empty((3, TICKS))
        for row in taken:
            for n in range(TICKS):
                clock.advance_ns(1_000_000)
                begun = perf_counter_ns()
                loop.tick()
                row[n] = perf_counter_ns() - begun
        return float(np.percentile(taken, percentile, axis=1).min())
