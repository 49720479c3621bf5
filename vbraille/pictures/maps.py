"""Files of a tactile picture for the eye and for paper: maps, outlines, and plots of signals."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.pictures import scenes
from vbraille.pictures.scenewords import scene_lines, scene_text
from vbraille.scene.signals import Switch, packed
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.files import Content
    from vbraille.pictures.drawings import ArrayOnMap
    from vbraille.pictures.loading import LoadedScene
    from vbraille.render import Model
    from vbraille.scene.scene import Scene

KINDS = ("png", "svg", "csv", "pdf", "gif")
MOST_FRAMES = 500
_LEAST_RULERS_PER_MM = 1.0  # at which numbers can be read
_FINE_PER_MM = 12.0  # of outlines, of which a PNG has edges
# When vibrations of 50 Hz are at their ends: an array that is drawn shows them best then.
_ARRAY_TIME_S = 0.005


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

    def __post_init__(self) -> None:
        over = bool(self.array) or self.rulers
        if self.outline and (over or self.frames or self.kind in ("csv", "gif")):
            raise InputError("an outline is drawn by itself, as .svg, .pdf or .png")
        if self.kind in ("csv", "gif") and over:
            raise InputError(f"a .{self.kind} file has the map alone; choose .png, .svg or .pdf")
        if self.kind == "gif" and not self.frames:
            raise InputError(f"a .gif file is an animation; add {setting('frames')}")

    @property
    def resolution(self) -> float:
        """Pixels a mm."""
        if self.per_mm is None:
            return _FINE_PER_MM if self.outline else scenes.PIXELS_PER_MM
        return self.per_mm


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
    """Draw a picture: an outline, a map, or the maps of a swing.

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
        If the picture has no such switch, nothing of it swings, or the file would be too large.
    """
    scene = _as_felt(loaded.scene, request)
    drawing = _Drawing(loaded, scene, request)
    if request.outline:
        files: list[tuple[Path, Content]] = [(path, drawing.outline())]
    elif not request.frames:
        files = [(path, drawing.map())]
    elif request.kind == "gif":
        files = [(path, drawing.animation(request.frames))]
    else:
        files = [
            (path.with_name(f"{path.stem}-{number:03}{path.suffix}"), content)
            for number, content in enumerate(drawing.sequence(request.frames), 1)
        ]
    names = str(path) if len(files) == 1 else f"{files[0][0]} to {files[-1][0]}"
    return files, [f"drawn: {names}", *drawing.said, *scene_lines(scene)]


def draw_signal(loaded: LoadedScene, name: str, request: MapRequest) -> tuple[Content, list[str]]:
    """Draw how a signal of a picture answers to the velocity of the hand, as a polar plot.

    Raises
    ------
    InputError
        If there is no such signal or switch.
    """
    from vbraille.pictures import blending
    from vbraille.pictures.drawings import drawing_bytes

    switches = _packed(loaded.scene, request)
    drawn = blending.blending(loaded.scene, name, switches)
    said = blending.blending_words(drawn)
    if request.kind == "csv":
        return blending.blending_csv(drawn), said
    scenes.check_pixels(blending.SHEET, request.resolution, most=scenes.MOST_PLACED_PIXELS)
    figure = blending.blending_figure(drawn)
    told = "; ".join(said)
    return drawing_bytes(figure, request.kind, request.resolution, loaded.title, told), said


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


def _as_felt(scene: Scene, request: MapRequest) -> Scene:
    """Scene under a hand of the request's velocity, with its switches."""
    switches = _packed(scene, request)
    if not scene.signals:
        return scene
    from vbraille.render.compiling import settled  # loads the kernels

    return settled(scene, request.velocity, switches)


class _Drawing:
    """A scene that is drawn; `said` gathers lines on what is shown."""

    def __init__(self, loaded: LoadedScene, scene: Scene, request: MapRequest) -> None:
        self._assets, self._title = loaded.assets, loaded.title
        self._scene, self._request = scene, request
        self._per_mm = request.resolution
        self.said: list[str] = []

    def outline(self) -> bytes:
        from vbraille.pictures.drawings import outline_figure

        canvas = self._scene.canvas
        if self._request.kind == "png":
            scenes.check_pixels(canvas, self._per_mm)
        size = f"{canvas.width_mm:g} × {canvas.height_mm:g} mm"
        self.said = [
            "shown: an outline, black where more than half of the strongest deflection is felt",
            f"paper: {size}, true to scale; print without scaling",
        ]
        return self._file(outline_figure(self._scene, self._assets))

    def map(self) -> Content:
        self._check_room()
        over = self._array(_ARRAY_TIME_S)
        seed = self._request.seed
        deflections = scenes.map_deflections(
            self._scene, self._assets, self._per_mm, noise_seed=seed
        )
        array, self.said = self.said, [*self._shown(), f"vibration: as noise, seed {seed}"]
        self.said += array
        return self._content(deflections, over)

    def animation(self, frames: int) -> bytes:
        maps = [scenes.grays(deflections) for _, deflections in self._maps(frames)]
        return scenes.gif(maps, f"{self._title}. {self._told()}")

    def sequence(self, frames: int) -> list[Content]:
        contents = []
        for time_s, deflections in self._maps(frames):
            said = self.said
            over = self._array(time_s)
            contents.append(self._content(deflections, over))
            self.said = said
        return contents

    def _maps(self, frames: int) -> Iterator[tuple[float, NDArray[np.float32]]]:
        """Times of a sequence, evenly over its period, with the map at each."""
        period_s = scenes.slowest_s(self._scene)
        if period_s is None:
            raise InputError("nothing in the picture vibrates or moves; leave out --frames")
        self._check_room(frames)
        between = f"{1000 * period_s / frames:.4g} ms"
        self.said = [
            *self._shown(),
            f"maps: {frames}, {between} apart, of one slowest swing of {1000 * period_s:.4g} ms",
        ]
        for number in range(frames):
            time_s = period_s * number / frames
            how = {"noise_seed": None, "time_s": time_s}
            yield time_s, scenes.map_deflections(self._scene, self._assets, self._per_mm, **how)

    def _check_room(self, maps: int = 1) -> None:
        """Refuse maps of too many pixels before the first is made."""
        request = self._request
        most = scenes.MOST_PIXELS[request.kind]
        if request.kind == "png" and (request.rulers or request.array):
            most = scenes.MOST_PLACED_PIXELS
        if request.kind == "png" and request.rulers and self._per_mm < _LEAST_RULERS_PER_MM:
            raise InputError(
                f"{setting('resolution')} is {self._per_mm:g}, too coarse for the numbers of "
                f"rulers; give {_LEAST_RULERS_PER_MM:g} or more, or choose .svg or .pdf"
            )
        scenes.check_pixels(self._scene.canvas, self._per_mm, maps, most)

    def _shown(self) -> list[str]:
        columns, rows = scenes.check_pixels(self._scene.canvas, self._per_mm)
        what = (
            "a row for each pixel"
            if self._request.kind == "csv"
            else "rest white, full swing black"
        )
        pixels = f"pixels: {columns} × {rows}, {self._per_mm:g} a mm"
        return [f"shown: a deflection map, {what}", pixels]

    def _array(self, time_s: float) -> ArrayOnMap | None:
        """Put the array on the scene as it is at a time, if it is wanted."""
        if not self._request.array:
            return None
        from vbraille.pictures import drawings  # loads matplotlib

        model = self._request.model
        place = drawings.ArrayPlace(*self._request.array)
        drawings.check_on_canvas(self._scene.canvas, model.display, place)
        self.said = [
            *self.said,
            f"array: {model.title}, centre at {place.x_mm:g}, {place.y_mm:g} mm, turned by "
            f"{place.angle_deg:g}°, {1000 * time_s:.4g} ms after the start",
        ]
        return drawings.show_array(self._scene, self._assets, model.display, place, time_s)

    def _content(self, deflections: NDArray[np.float32], over: ArrayOnMap | None) -> Content:
        """Make the file of one map, with what is over it and around it."""
        kind, rulers = self._request.kind, self._request.rulers
        if kind == "csv":
            return scenes.map_csv(deflections, self._per_mm)
        if kind == "png" and over is None and not rulers:
            told = {"Title": self._title, "Description": self._told()}
            return scenes.png(scenes.grays(deflections), self._per_mm, told)
        from vbraille.pictures.drawings import map_figure

        return self._file(map_figure(self._scene.canvas, deflections, over, axes=rulers))

    def _file(self, figure: Any) -> bytes:
        from vbraille.pictures.drawings import drawing_bytes

        kind = self._request.kind
        return drawing_bytes(figure, kind, self._per_mm, self._title, self._told())

    def _told(self) -> str:
        """Description in the picture's file: how it is drawn, and what it holds."""
        return f"{'; '.join(self.said)}; {scene_text(self._scene)}"
