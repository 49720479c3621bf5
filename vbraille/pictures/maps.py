"""Files of a tactile picture for the eye and for paper: maps, outlines, and plots of signals."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from vbraille.errors import InputError
from vbraille.pictures import scenes
from vbraille.pictures.scenewords import WAYS, scene_lines, signal_words
from vbraille.pictures.words import plain
from vbraille.scene.scene import Canvas
from vbraille.scene.signals import Direction, Pulse, Speed, Switch, made_of, ordered, packed
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from vbraille.files import Content
    from vbraille.pictures.loading import LoadedScene
    from vbraille.render import Model
    from vbraille.scene.scene import Scene
    from vbraille.scene.signals import AnySignal

KINDS = ("png", "svg", "csv", "pdf", "gif")
_LEAST_RULERS_PER_MM = 1.0  # at which numbers can be read
_FINE_PER_MM = 12.0  # of outlines, of which a PNG has edges
# When vibrations of 50 Hz are at their ends: an array that is drawn shows them best then.
_ARRAY_TIME_S = 0.005
_SIGNAL_MM, _SIGNAL_STEPS = 90.0, 121  # side of a plot of a signal, and its velocities along it
_BEYOND = 1.25  # times the greatest speed at which the signal still changes
_USUAL_MM_S = 20.0  # edge of the plot of a signal that no speed changes
_TOLD_SPEEDS = 5
_ALIKE = 5e-3  # what words with two decimals do not tell apart


@dataclass(frozen=True, slots=True)
class MapRequest:
    """Request for a drawing of a picture.

    Parameters
    ----------
    kind
        Kind of file, one of `KINDS`.
    model
        Display whose array is drawn.
    per_mm
        Pixels a mm; None for 4, or 12 of an outline.
    seed
        Seed of the noise that stands for vibration.
    frames
        Number of maps over the slowest swing or movement; None for one map.
    velocity
        Velocity of the hand along x and y in mm/s, for what answers to it.
    switches
        State, from 0, of the switch of each key.
    array
        Place of an array over the map: x and y in mm, and an angle in degrees; empty for none.
    rulers
        Whether rulers in mm stand around the map.
    outline
        Whether what is felt is drawn in black on white, instead of a map.
    signal
        Name of the signal whose answer to the hand's velocity is drawn, instead of a map.
    """

    kind: str
    model: Model
    per_mm: float | None = None
    seed: int = 1
    frames: int | None = None
    velocity: tuple[float, float] = (0.0, 0.0)
    switches: Mapping[int, int] = field(default_factory=dict[int, int])
    array: tuple[float, ...] = ()
    rulers: bool = False
    outline: bool = False
    signal: str = ""

    def __post_init__(self) -> None:
        over = bool(self.array) or self.rulers
        if self.outline and (over or self.frames or self.kind in ("csv", "gif")):
            raise InputError("an outline is drawn alone, as .svg, .pdf or .png")
        if self.kind in ("csv", "gif") and over:
            raise InputError(f"a .{self.kind} file has the map alone; choose .png, .svg or .pdf")
        if self.signal and self.kind == "gif":
            raise InputError("a signal is drawn as .png, .svg, .pdf or .csv")
        if self.kind == "gif" and not self.frames:
            raise InputError(f"a .gif file is an animation; add {setting('frames')}")

    @property
    def resolution(self) -> float:
        """Pixels a mm."""
        return self.per_mm or (_FINE_PER_MM if self.outline else scenes.PIXELS_PER_MM)


def kind_of(path: Path) -> str:
    """Kind of file that a name ends in.

    Raises
    ------
    InputError
        If it is none of `KINDS`.
    """
    kind = path.suffix.lower().removeprefix(".")
    if kind not in KINDS:
        known = ", ".join(f".{kind}" for kind in KINDS)
        raise InputError(f"{path} is not a name for a picture; end it in one of {known}")
    return kind


def draw_map(
    loaded: LoadedScene, request: MapRequest, path: Path
) -> tuple[list[tuple[Path, Content]], list[str]]:
    """Draw a picture: an outline, a map, the maps of a swing, or how a signal answers the hand.

    Parameters
    ----------
    loaded
        The picture.
    request
        What is drawn.
    path
        Name of the file; maps of a swing have numbered names beside it, unless they are a GIF.

    Returns
    -------
    list[tuple[Path, Content]], list[str]
        Content of each file, and lines on what they show.

    Raises
    ------
    InputError
        If the picture has no such switch or signal, nothing of it swings or answers, or the file
        would be too large.
    """
    switches = _packed(loaded.scene, request)
    if request.signal:
        content, said = _signal(loaded, request, switches)
        return [(path, content)], [f"drawn: {path}", *said]
    if loaded.scene.signals:
        from vbraille.render.compiling import settled  # loads the kernels

        loaded = replace(loaded, scene=settled(loaded.scene, request.velocity, switches))
    contents, said = (_outline if request.outline else _maps)(loaded, request)
    paths = [path]
    if len(contents) > 1:
        numbers = range(1, len(contents) + 1)
        paths = [path.with_name(f"{path.stem}-{number:03}{path.suffix}") for number in numbers]
    names = str(path) if len(paths) == 1 else f"{paths[0]} to {paths[-1]}"
    lines = [f"drawn: {names}", *said, *scene_lines(loaded.scene)]
    return list(zip(paths, contents, strict=True)), lines


def _outline(loaded: LoadedScene, request: MapRequest) -> tuple[list[Content], list[str]]:
    """Draw an outline; the file, and lines on it."""
    from vbraille.pictures.drawings import outline_figure

    canvas = loaded.scene.canvas
    if request.kind == "png":
        scenes.check_pixels(canvas, request.resolution)
    said = [
        "shown: an outline, black where more than half of the strongest deflection is felt",
        f"paper: {canvas.width_mm:g} × {canvas.height_mm:g} mm, true to scale; print without "
        "scaling",
    ]
    return [_file(loaded, request, outline_figure(loaded.scene, loaded.assets), said)], said


def _maps(loaded: LoadedScene, request: MapRequest) -> tuple[list[Content], list[str]]:
    """Draw a map, or the maps of a swing evenly over it; the files, and lines on them."""
    scene, per_mm = loaded.scene, request.resolution
    columns, rows = _check_room(scene.canvas, request)
    what = "a row for each pixel" if request.kind == "csv" else "rest white, full swing black"
    said = [f"shown: a deflection map, {what}", f"pixels: {columns} × {rows}, {per_mm:g} a mm"]
    if not request.frames:
        drawn = scenes.map_deflections(scene, loaded.assets, per_mm, noise_seed=request.seed)
        said.append(f"vibration: as noise, seed {request.seed}")
        content, more = _map(loaded, request, drawn, _ARRAY_TIME_S, said)
        return [content], [*said, *more]
    period_s = scenes.slowest_s(scene)
    if period_s is None:
        raise InputError("nothing in the picture vibrates or moves; leave out --frames")
    said.append(
        f"maps: {request.frames}, {1000 * period_s / request.frames:.4g} ms apart, of one slowest "
        f"swing of {1000 * period_s:.4g} ms"
    )
    times = [period_s * number / request.frames for number in range(request.frames)]
    drawn = (
        scenes.map_deflections(scene, loaded.assets, per_mm, noise_seed=None, time_s=time_s)
        for time_s in times
    )
    if request.kind == "gif":
        told = f"{loaded.title}. {_told(loaded, said)}"
        return [scenes.gif([scenes.grays(one) for one in drawn], told)], said
    return [
        _map(loaded, request, one, time_s, said)[0]
        for one, time_s in zip(drawn, times, strict=True)
    ], said


def _check_room(canvas: Canvas, request: MapRequest) -> tuple[int, int]:
    """Columns and rows of a map; maps of too many pixels are refused before the first is made."""
    most, per_mm = scenes.MOST_PIXELS[request.kind], request.resolution
    if request.kind == "png" and (request.rulers or request.array):
        most = scenes.MOST_PLACED_PIXELS
    if request.kind == "png" and request.rulers and per_mm < _LEAST_RULERS_PER_MM:
        raise InputError(
            f"{setting('resolution')} is {per_mm:g}, too coarse for the numbers of "
            f"rulers; give {_LEAST_RULERS_PER_MM:g} or more, or choose .svg or .pdf"
        )
    return scenes.check_pixels(canvas, per_mm, request.frames or 1, most)


def _map(
    loaded: LoadedScene,
    request: MapRequest,
    deflections: NDArray[np.float32],
    time_s: float,
    said: list[str],
) -> tuple[Content, list[str]]:
    """Make the file of one map, with what is over it and around it; and lines on the array."""
    if request.kind == "csv":
        places = scenes.map_places(loaded.scene.canvas, request.resolution)
        return scenes.map_csv("x_mm,y_mm,deflection", *places, deflections), []
    if request.kind == "png" and not request.array and not request.rulers:
        told = {"Title": loaded.title, "Description": _told(loaded, said)}
        return scenes.png(scenes.grays(deflections), request.resolution, told), []
    from vbraille.pictures import drawings  # loads matplotlib
    from vbraille.pictures.composing import compose

    canvas, over, more = loaded.scene.canvas, None, list[str]()
    if request.array:
        x, y, angle = (*request.array, 0.0)[:3]
        display = request.model.display
        over = drawings.ArrayOnMap(display, x, y, angle, np.zeros(display.shape))
        drawings.check_on_canvas(canvas, over)
        at = np.array([x]), np.array([y])
        frames = compose(loaded, display).poses(*at, math.radians(angle), time_s)[1]
        over = over._replace(deflections=frames[0])
        more = [
            f"array: {request.model.title}, centre at {x:g}, {y:g} mm, turned by {angle:g}°, "
            f"{1000 * time_s:.4g} ms after the start"
        ]
    rulers = (0.0, canvas.width_mm, canvas.height_mm, 0.0) if request.rulers else None
    figure = drawings.map_figure(canvas, deflections, over, rulers=rulers)
    return _file(loaded, request, figure, [*said, *more]), more


def _file(loaded: LoadedScene, request: MapRequest, figure: Any, said: list[str]) -> bytes:
    from vbraille.pictures.figurefiles import to_bytes

    per_inch = request.resolution * scenes.MM_PER_INCH
    return to_bytes(figure, request.kind, loaded.title, _told(loaded, said), per_inch)


def _told(loaded: LoadedScene, said: list[str]) -> str:
    """Description in the picture's file: how it is drawn, and what it holds."""
    return "; ".join([*said, *scene_lines(loaded.scene)])


def _packed(scene: Scene, request: MapRequest) -> int:
    """States of switches as a scene takes them.

    Raises
    ------
    InputError
        If there is no such switch or state.
    """
    known = {one.key: len(one.levels) for one in scene.signals.values() if isinstance(one, Switch)}
    for key, state in request.switches.items():
        if state >= known.get(key, 0):
            what = f"has {known[key]} states" if key in known else "is not a switch of this picture"
            raise InputError(f"{setting('switch')} {key}={state + 1}: key {key} {what}")
    return packed(dict(request.switches), scene.signals)


def _signal(loaded: LoadedScene, request: MapRequest, switches: int) -> tuple[Content, list[str]]:
    """Draw how a signal answers to each velocity of the hand: Lévesque 2009, 9.6.

    The picture is a grid of velocities as the canvas has them, right at the right and down below,
    with rest in the middle.
    """
    from vbraille.render.compiling import SceneMap  # loads the kernels

    name, signals = request.signal, loaded.scene.signals
    if name not in signals:
        known = ", ".join(map(plain, signals)) or "none"
        raise InputError(f"the picture has no signal {plain(name)!r}; its signals are: {known}")
    within = dict(_within(signals, name))
    answering = [one for one in within.values() if isinstance(one, Speed | Direction)]
    if not answering:
        raise InputError(f"signal {plain(name)!r} does not depend on the velocity of the hand")
    pulses = [one for one, signal in signals.items() if isinstance(signal, Pulse)]
    steady = {**signals, **dict.fromkeys(pulses, Switch(levels=(1.0, 1.0)))}
    shown = SceneMap(msgspec.structs.replace(loaded.scene, signals=steady, elements=()))
    number = [one.name for one in ordered(steady)].index(name)

    def value(x_mm_s: float, y_mm_s: float) -> float:
        return shown.signal_values(0.0, (x_mm_s, y_mm_s), switches)[number]

    edge = _BEYOND * max(map(_fastest, answering)) or _USUAL_MM_S
    said = [
        f"shown: signal {plain(name)} against the velocity of the hand, white 0 and black 1; "
        "a hand at rest is in the middle, one that goes to the right at the right",
        f"edge: {edge:g} mm/s",
        *(f"signal {plain(one)}: {signal_words(signal)}" for one, signal in within.items()),
    ]
    if not within.keys().isdisjoint(pulses):
        said.append("time: pulses are taken as 1")
    angles = [math.tau * way / len(WAYS) for way in range(len(WAYS))]
    for speed in np.linspace(0.0, edge, _TOLD_SPEEDS).tolist():
        values = [value(speed * math.cos(angle), speed * math.sin(angle)) for angle in angles]
        around = ", ".join(f"{way} {one:.2f}" for way, one in zip(WAYS, values, strict=True))
        if max(values) - min(values) < _ALIKE:
            around = f"{values[0]:.2f}" + (" in all directions" if speed else "")
        said.append(f"at {speed:g} mm/s: {around}")
    speeds = np.linspace(-edge, edge, _SIGNAL_STEPS)
    grid = np.array([[value(x, y) for x in speeds.tolist()] for y in speeds.tolist()], np.float32)
    if request.kind == "csv":
        return scenes.map_csv("x_mm_s,y_mm_s,value", speeds, speeds, grid), said
    from vbraille.pictures.drawings import map_figure  # loads matplotlib

    canvas = Canvas(width_mm=_SIGNAL_MM, height_mm=_SIGNAL_MM)
    scenes.check_pixels(canvas, request.resolution, most=scenes.MOST_PLACED_PIXELS)
    figure = map_figure(canvas, grid, rulers=(-edge, edge, edge, -edge), unit="mm/s")
    return _file(loaded, request, figure, said), said


def _within(signals: Mapping[str, AnySignal], name: str) -> Iterator[tuple[str, AnySignal]]:
    """Names and values of a signal and of those that it is made of."""
    yield name, signals[name]
    for one in made_of(signals[name]):
        yield from _within(signals, one)


def _fastest(signal: Speed | Direction) -> float:
    """Speed of the hand above which a signal changes no more, mm/s."""
    if isinstance(signal, Speed):
        return signal.below_mm_s + signal.transition_mm_s
    return signal.below_mm_s + signal.slow_transition_mm_s
