"""Tactile pictures in the engine: ticks, changes of pictures of some MB, and of one among 10,000.

python -m tests.benchmarks.bench_feel 5

measures each for 5 s.
"""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace as replace_fields

from tests.benchmarks.timing import Result
from vbraille.display import Pose
from vbraille.engine.host import Host
from vbraille.engine.record import Flag
from vbraille.feeling.composing import compose
from vbraille.feeling.loading import FileWatch, load_scene
from vbraille.reading.commands.scene import BOUND
from vbraille.reading.keyboard import POLL_S
from vbraille.reading.sceneview import SceneView
from vbraille.render import MODELS
from vbraille.render.compiling import compile_scene
from vbraille.render.program import Program
from vbraille.scene.converting import write_scene
from vbraille.scene.patterns import Circle, Fill, Group
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.strokes import Stroke
from vbraille.scene.textures import LinearGrating, RadialGrating, UniformVibration
from vbraille.simulation.specs import device_spec
from vbraille.simulation.steering import ReadPage, Steering

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

BLOCK_S = 20.0
SHAPES = 10_000
CHANGES = 15
LARGE_BYTES = 3_000_000
LOOK_S = 0.02  # between two looks at the file, as in vbraille feel
MODEL = MODELS["stress2-8x8"]
CANVAS = Canvas(width_mm=200, height_mm=200)
REACHED = Canvas(width_mm=200, height_mm=150)  # by the Tactograph's carriage
_CHANGED = int(Flag.CHANGED)
_GRATING = LinearGrating(ridge_mm=2, gap_mm=2)


def circles(count: int) -> tuple[Circle, ...]:
    """Filled circles side by side over the canvas."""
    across = round(count**0.5)
    pitch_mm = CANVAS.width_mm / across
    return tuple(
        Circle(
            center_mm=((n % across + 0.5) * pitch_mm, (n // across + 0.5) * pitch_mm),
            radius_mm=0.35 * pitch_mm,
            stroke=Stroke(width_mm=min(0.5, 0.2 * pitch_mm)),
            fill=Fill(texture=_GRATING),
        )
        for n in range(count)
    )


def nested() -> Group:
    """A composite of ten parts, everywhere."""
    parts = tuple(
        LinearGrating(ridge_mm=2 + 0.2 * n, gap_mm=2, wave_angle_deg=17.0 * n) for n in range(8)
    )
    return Group(
        operation="add",
        parts=(
            Group(operation="maximum", parts=parts),
            RadialGrating(ridge_mm=2, gap_mm=3, center_mm=(100, 100)),
            UniformVibration(frequency_hz=20, amplitude=0.3),
        ),
    )


def scenes() -> dict[str, Scene]:
    """Scenes whose ticks are compared with a line's."""
    return {
        "a grating": Scene(canvas=CANVAS, elements=(_GRATING,)),
        "a composite of ten parts": Scene(canvas=CANVAS, elements=(nested(),)),
        "10,000 circles": Scene(canvas=CANVAS, elements=circles(SHAPES)),
    }


def hosted(room: int) -> tuple[Host, Steering]:
    """A simulated device in a process of its own, whose hand sweeps over the canvas."""
    steering = Steering()
    host = Host(
        device_spec("sim", "sweep:60", 1, steering),
        replace(MODEL.display, rate_hz=1000.0),
        room,
        pass_fds=[steering.descriptor],
    )
    return host, steering


def felt(program: Program, seconds: float) -> NDArray[np.void]:
    """Records of ticks in which a hand goes over a picture."""
    host, steering = hosted(program.nbytes)
    with host:
        host.show(program, 1)
        steering.give(ReadPage(20, 10.0, 200.0))
        taken, end_s = [], time.monotonic() + seconds + 1.0
        while time.monotonic() < end_s:
            time.sleep(0.05)
            taken.append(host.poll())
    ticks = np.concatenate(taken)
    return ticks[ticks["tick"] > 1000]  # what is done once, at the start, is no part of it


def ticks_against_a_line(seconds: float) -> Iterator[Result]:
    """Work of a tick with each scene, 99 %, against a line of braille."""
    display = MODEL.display
    line = MODEL.style.render(np.arange(18, dtype=np.uint8) + 30, display)
    usual_us = np.percentile(felt(line, seconds)["work_ns"], 99) / 1000
    for name, scene in scenes().items():
        ticks = felt(compile_scene(scene, display), seconds)
        work_us = np.percentile(ticks["work_ns"], 99) / 1000
        yield Result(
            f"work of a tick with {name}, 99 %, against a line's",
            "≤ 2 ×",
            f"{work_us / usual_us:.2f} × ({work_us:.0f} µs)",
            work_us <= 2 * usual_us,
        )


def large(program: Program) -> Program:
    """The same program in 3 MB."""
    more = np.zeros(max(LARGE_BYTES - program.nbytes, 0) // 8)
    return Program(np.concatenate((program.numbers, more)), program.table)


def changes_of_large_pictures() -> Iterator[Result]:
    """Ticks that are lost when a picture of 3 MB takes the place of another, and how long it is."""
    one, other = (large(compile_scene(scene, MODEL.display)) for scene in (*scenes().values(),)[:2])
    host, steering = hosted(max(one.nbytes, other.nbytes))
    waited_ms, taken = [], []
    with host:
        host.show(one, 1)
        steering.give(ReadPage(20, 10.0, 200.0))
        _wait(host, 1.0)
        before = host.tally
        for number in range(CHANGES):
            begun_ns = time.monotonic_ns()
            host.show(other if number % 2 == 0 else one, 1)
            ticks = _wait(host, 0.3)
            taken.append(ticks)
            waited_ms.append(_faded_ms(ticks, begun_ns))
        after = host.tally
    ticks = np.concatenate(taken)
    lost = after.overruns - before.overruns
    late = after.late - before.late
    yield Result(
        f"ticks lost by own work at {CHANGES} changes of a picture of 3 MB",
        "0",
        f"{lost} ({late} late)",
        lost == 0,
    )
    most_us = ticks["work_ns"].max() / 1000
    yield Result(
        "work of a tick meanwhile, at most", "≤ 1 ms", f"{most_us:.0f} µs", most_us <= 1000
    )
    usual_us = np.percentile(ticks["work_ns"], 99) / 1000
    yield Result("the same, 99 %", "reported", f"{usual_us:.0f} µs", True)
    yield Result(
        "from showing 3 MB to the fade's first frame, median",
        "≤ 50 ms",
        f"{np.median(waited_ms):.1f} ms",
        float(np.median(waited_ms)) <= 50,
    )


def changes_of_one_shape() -> Iterator[Result]:
    """From a change of one shape of 10,000 to the fade's first frame."""
    elements = list(circles(SHAPES))
    begun = time.perf_counter()
    program = compile_scene(Scene(canvas=CANVAS, elements=tuple(elements)), MODEL.display)
    compiled_s = time.perf_counter() - begun
    yield Result("compiling 10,000 circles", "≤ 1 s", f"{compiled_s:.2f} s", compiled_s <= 1)
    host, steering = hosted(2 * program.nbytes)
    waited_ms, compiling_ms = [], []
    with host:
        host.show(program, 1)
        steering.give(ReadPage(20, 10.0, 200.0))
        _wait(host, 1.0)
        for number in range(CHANGES):
            changed = elements[number * 600]
            moved = changed.center_mm[0] + 0.1, changed.center_mm[1]
            begun_ns = time.monotonic_ns()
            elements[number * 600] = Circle(
                center_mm=moved, radius_mm=changed.radius_mm, stroke=changed.stroke
            )
            program = compile_scene(Scene(canvas=CANVAS, elements=tuple(elements)), MODEL.display)
            compiling_ms.append((time.monotonic_ns() - begun_ns) / 1e6)
            host.show(program, 1)
            waited_ms.append(_faded_ms(_wait(host, 0.3), begun_ns))
    yield Result(
        "from a change of one of 10,000 circles to the fade's first frame, median and at most",
        "reported",
        f"{np.median(waited_ms):.1f} ms, {max(waited_ms):.1f} ms "
        f"({np.median(compiling_ms):.1f} ms of it compiling; {program.nbytes / 1e6:.1f} MB)",
        True,
    )


def changes_of_a_file(shapes: int, bar_ms: float) -> Iterator[Result]:
    """From a change of one shape in a file, saved by an editor, to the fade's first frame."""
    elements = list(circles(shapes))
    with TemporaryDirectory() as folder:
        path = Path(folder, "a.scene")

        def save() -> int:
            path.write_text(write_scene(Scene(canvas=REACHED, elements=tuple(elements))))
            return time.monotonic_ns()

        save()
        loaded = load_scene(path, MODEL.style)
        program = compose(loaded, MODEL.display)
        host, steering = hosted(3 * program.nbytes)
        waited_ms = []
        with host:
            feeler = SceneView(
                loaded,
                SimpleNamespace(engine=host, pose=None, style=MODEL.style, steering=steering),
                rate_hz=1000.0,
                say=lambda _: None,
                bound=BOUND,
                room=3 * program.nbytes,
            )
            feeler.start(program)
            watch = FileWatch(path)
            steering.give(ReadPage(20, 10.0, 200.0))
            _wait(host, 1.0)
            for number in range(CHANGES):
                changed = elements[number * shapes // CHANGES]
                moved = changed.center_mm[0] + 0.1, changed.center_mm[1]
                elements[number * shapes // CHANGES] = replace_fields(changed, center_mm=moved)
                # Programs save at any moment between two looks.
                time.sleep(LOOK_S * number / CHANGES)
                begun_ns = save()
                taken = []
                while not watch.changed():
                    time.sleep(LOOK_S)
                    taken.append(host.poll())
                feeler.reload()
                taken.append(_wait(host, 0.3))
                waited_ms.append(_faded_ms(np.concatenate(taken), begun_ns))
    yield Result(
        f"from a change of one of {shapes} circles in a file to the fade's first frame, median",
        f"≤ {bar_ms:g} ms" if bar_ms < np.inf else "reported",
        f"{np.median(waited_ms):.1f} ms (least {min(waited_ms):.1f}, most {max(waited_ms):.1f})",
        float(np.median(waited_ms)) <= bar_ms,
    )


def zooms_and_pans(shapes: int, bar_ms: float) -> Iterator[Result]:
    """From a key that zooms or pans, as `vbraille feel` looks for it, to the fade's first frame."""
    with TemporaryDirectory() as folder:
        path = Path(folder, "a.scene")
        path.write_text(write_scene(Scene(canvas=REACHED, elements=circles(shapes))))
        loaded = load_scene(path, MODEL.style)
        program = compose(loaded, MODEL.display)
        host, steering = hosted(20 * program.nbytes)
        waited: dict[str, list[float]] = {"+": [], "]": []}
        with host:
            device = SimpleNamespace(engine=host, style=MODEL.style, steering=steering, held=False)
            device.pose = Pose(0, 100.0, 75.0)
            feeler = SceneView(
                loaded,
                device,
                rate_hz=1000.0,
                say=lambda _: None,
                bound=BOUND,
                room=20 * program.nbytes,
            )
            feeler.start(program)
            steering.give(ReadPage(20, 10.0, 200.0))
            _wait(host, 1.0)
            for key in ("+", "]", "+", "]", "+", "]", "+", "]", "0", "+", "]", "+", "]", "+", "]"):
                begun_ns = time.monotonic_ns()
                feeler.press(key)
                taken = []
                while feeler._making is not None:
                    time.sleep(POLL_S)
                    taken.append(host.poll())
                    feeler.attend(0.0)
                taken.append(_wait(host, 0.3))
                if key in waited:
                    waited[key].append(_faded_ms(np.concatenate(taken), begun_ns))
    for key, name, bar in (("+", "zooms", bar_ms), ("]", "pans", 20.0)):
        yield Result(
            f"from a key that {name} a picture of {shapes} circles to the first frame, median",
            f"≤ {bar:g} ms",
            f"{np.median(waited[key]):.1f} ms (most {max(waited[key]):.1f})",
            float(np.median(waited[key])) <= bar,
        )


def _wait(host: Host, seconds: float) -> NDArray[np.void]:
    """Let some time go by; the records of its ticks."""
    taken, end_s = [host.poll()], time.monotonic() + seconds
    while time.monotonic() < end_s:
        time.sleep(0.01)
        taken.append(host.poll())
    return np.concatenate(taken)


def _faded_ms(ticks: NDArray[np.void], begun_ns: int) -> float:
    """How long after a moment the first tick of a fade woke."""
    fading = (ticks["time_ns"] >= begun_ns) & ((ticks["flags"] & _CHANGED) != 0)
    return (int(ticks["time_ns"][fading.argmax()]) - begun_ns) / 1e6 if fading.any() else np.inf


def run(seconds: float = BLOCK_S) -> Iterator[Result]:
    """Measure all of it."""
    yield from ticks_against_a_line(seconds)
    yield from changes_of_large_pictures()
    yield from changes_of_one_shape()
    yield from changes_of_a_file(100, 100.0)
    yield from changes_of_a_file(1000, np.inf)
    yield from zooms_and_pans(300, 100.0)
    yield from zooms_and_pans(1000, 250.0)


if __name__ == "__main__":
    for result in run(float(sys.argv[1]) if sys.argv[1:] else BLOCK_S):
        print(result.row(), flush=True)
