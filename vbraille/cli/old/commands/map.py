"""``vbraille map``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.old.terminal import say_line
from vbraille.errors import InputError
from vbraille.feeling.loading import load_scene
from vbraille.files import write_file, write_files
from vbraille.pictures import scenes
from vbraille.pictures.scenewords import scene_lines, scene_text
from vbraille.render import MODELS
from vbraille.scene.signals import Switch, packed
from vbraille.wording import count, setting, spelled

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.feeling.loading import LoadedScene
    from vbraille.files import Content
    from vbraille.pictures.arrows import Arrow
    from vbraille.pictures.drawings import ArrayOnMap, Figure
    from vbraille.scene.scene import Scene

_KINDS = ("png", "svg", "csv", "pdf", "gif")
_FRAMES, _MOST_FRAMES = 8, 500
_LEAST_RULERS_PER_MM = 1.0
_FINE_PIXELS_PER_MM = 12.0  # of outlines, of which a PNG has edges
# When vibrations of 50 Hz are at their ends: an array that is drawn shows them best then.
_ARRAY_TIME_S = 0.005
# What --signal cannot be drawn with.
_OF_PICTURES = "velocity", "arrows", "array", "rulers", "outline"
_SHOWN = "shown: a deflection map, rest white and full swing black"
_SHOWN_CSV = "shown: a deflection map, a row for each pixel with x, y and its deflection"


def run(arguments: argparse.Namespace) -> int:
    """Draw a scene, and say what is shown."""
    out = Path(arguments.out)
    kind = _kind(out)
    _check(arguments, kind)
    numbered = arguments.vibration == "sequence" and kind != "gif"
    if not arguments.force:
        _check_free(out, numbered=numbered)
    style = MODELS[arguments.model].style
    if arguments.outline:  # dots of braille without a texture, which is too fine for paper
        style = style.replace(texture=0.0)
    loaded = load_scene(arguments.file, style)
    for note in loaded.notes:
        say_line(spelled(note), aside=True)
    if arguments.signal:
        return _draw_signal(arguments, kind, loaded)
    drawing = _Drawing(arguments, kind, loaded)
    try:
        if numbered:
            said = drawing.write_numbered(out)
        else:
            content, said = drawing.draw()
            write_file(out, content, replace=arguments.force)
            said = [f"drawn: {out}", *said]
    except ValueError as error:  # patterns stand too deep in each other
        raise InputError(f"{arguments.file}: {error}") from None
    for line in (*said, *scene_lines(loaded.scene)):
        say_line(line)
    return 0


def _draw_signal(arguments: argparse.Namespace, kind: str, loaded: LoadedScene) -> int:
    """Draw a signal against the velocity of the hand, and say what is shown."""
    from vbraille.pictures import blending

    scene = loaded.scene
    drawn = blending.blending(scene, arguments.signal, _switches(arguments, scene))
    said = blending.blending_words(drawn)
    if kind == "csv":
        content = blending.blending_csv(drawn)
    else:
        from vbraille.pictures.drawings import drawing_bytes

        figure = blending.blending_figure(drawn)
        per_mm = arguments.resolution
        per_mm = scenes.PIXELS_PER_MM if per_mm is None else per_mm
        scenes.check_pixels(blending.SHEET, per_mm, most=scenes.MOST_PLACED_PIXELS)
        content = drawing_bytes(figure, kind, per_mm, loaded.title, "; ".join(said))
    write_file(Path(arguments.out), content, replace=arguments.force)
    for line in (f"drawn: {arguments.out}", *said):
        say_line(line)
    return 0


def _check_free(out: Path, *, numbered: bool) -> None:
    """Refuse to write over anything, before anything is drawn."""
    taken = _in_set(out) if numbered else [out] if out.exists() and not out.is_dir() else []
    if taken:
        raise InputError(f"{taken[0]} is there already; give another name with --out, or --force")


def _in_set(out: Path) -> list[Path]:
    """Files that are there with the names of a numbered set: F-001.png and so on for F.png."""
    numbers = (_file(out, number) for number in range(1, _MOST_FRAMES + 1))
    return [path for path in numbers if path.exists()]


def _file(out: Path, number: int) -> Path:
    return out.with_name(f"{out.stem}-{number:03}{out.suffix}")


def _kind(out: Path) -> str:
    kind = out.suffix.lower().removeprefix(".")
    if kind not in _KINDS:
        known = ", ".join(f".{kind}" for kind in _KINDS)
        what = f"ends in .{kind}" if kind else "has no suffix"
        raise InputError(f"--out {out} {what}; end its name in one of {known}")
    return kind


def _check(arguments: argparse.Namespace, kind: str) -> None:
    """Refuse options that do not go together."""
    sequence = arguments.vibration == "sequence"
    for wrong, problem in (
        (
            arguments.outline and kind in ("csv", "gif"),
            "--outline is no map; end --out in .svg, .pdf or .png",
        ),
        (
            arguments.outline and (arguments.array or arguments.rulers or sequence),
            "--array, --rulers and --vibration sequence are for maps; leave out either these or "
            "--outline",
        ),
        (
            kind == "gif" and (arguments.array or arguments.rulers),
            "an animation has maps alone; leave out --array and --rulers, or end --out in .png",
        ),
        (
            not sequence and (arguments.frames is not None or arguments.parity is not None),
            "--frames and --parity are for --vibration sequence; add that or leave them out",
        ),
        (kind == "gif" and not sequence, "GIF is for --vibration sequence; end --out in .png"),
        (
            kind == "csv" and (arguments.array or arguments.rulers or arguments.arrows),
            "CSV has the map's numbers alone; leave out --array, --arrows and --rulers",
        ),
        (
            kind == "gif" and (arguments.arrows or arguments.signal),
            "an animation has maps alone; end --out in .png, or leave out --arrows and --signal",
        ),
        (
            arguments.signal
            and (sequence or any(getattr(arguments, name) for name in _OF_PICTURES)),
            "--signal draws no picture, and all velocities; leave out "
            f"{', '.join(map(setting, _OF_PICTURES))} and {setting('vibration')}",
        ),
    ):
        if wrong:
            raise InputError(problem)
    if arguments.frames is not None and not 2 <= arguments.frames <= _MOST_FRAMES:
        raise InputError(f"--frames is {arguments.frames}; it must be 2 to {_MOST_FRAMES}")


def _switches(arguments: argparse.Namespace, scene: Scene) -> int:
    """States of the scene's switches that the options say, packed."""
    states = arguments.switch or {}
    switches = {
        one.key: len(one.levels) for one in scene.signals.values() if isinstance(one, Switch)
    }
    for key, state in states.items():
        if state >= switches.get(key, 0):
            there = f"has {switches[key]} states" if key in switches else "is none of this picture"
            raise InputError(f"--switch has {key}={state + 1}, and key {key} {there}")
    return packed(states, scene.signals)


def _scene_of(arguments: argparse.Namespace, scene: Scene) -> Scene:
    """Scene as it is under the hand, and in the states, that the options say."""
    switches = _switches(arguments, scene)
    if not scene.signals:
        return scene
    from vbraille.render.scene.compiling import settled  # loads the kernels

    return settled(scene, arguments.velocity or (0.0, 0.0), switches)


class _Drawing:
    """A scene as the options have it drawn.

    Parameters
    ----------
    arguments
        Parsed options of the command.
    kind
        Kind of file, such as "png".
    loaded
        The scene, with what it is made of.
    """

    def __init__(self, arguments: argparse.Namespace, kind: str, loaded: LoadedScene) -> None:
        self._arguments, self._kind = arguments, kind
        self._scene = _scene_of(arguments, loaded.scene)
        self._assets, self._title = loaded.assets, loaded.title
        self._arrows: list[Arrow] = []
        if arguments.arrows:
            from vbraille.pictures.arrows import arrows

            self._arrows = arrows(loaded.scene, loaded.boxes())
        self._frames, self._parity = arguments.frames or _FRAMES, arguments.parity or 0
        self._per_mm = arguments.resolution
        if arguments.outline:
            self._per_mm = arguments.resolution or _FINE_PIXELS_PER_MM
        elif self._per_mm is None:
            self._per_mm = scenes.PIXELS_PER_MM

    def draw(self) -> tuple[Content, list[str]]:
        """Make one file, and sentences on what it shows."""
        if self._arguments.outline:
            return self._outline()
        if self._arguments.vibration == "sequence":
            return self._animation()
        self._check_room()
        over, array_said = self._array(_ARRAY_TIME_S)
        deflections = scenes.map_deflections(
            self._scene, self._assets, self._per_mm, noise_seed=self._arguments.seed
        )
        said = [
            self._shown,
            self._pixels,
            f"vibration: as noise, seed {self._arguments.seed}",
            *array_said,
            *self._arrows_said,
        ]
        return self._content(deflections, over, said), said

    def write_numbered(self, out: Path) -> list[str]:
        """Write the maps of one period, a file each, and tell what there is to say."""
        frames = self._frames
        period_s = self._period_s()
        before = set(_in_set(out))
        array_said: list[str] = []

        def drawn() -> Iterator[tuple[Path, Content]]:
            for number, (time_s, deflections) in enumerate(self._maps(period_s), 1):
                over, array_said[:] = self._array(time_s)
                said = [
                    f"{_SHOWN}, number {number} of {frames}",
                    f"time: {1000 * time_s:.4g} ms after the beginning",
                    f"actuators: those of parity {self._parity}",
                    *array_said,
                    *self._arrows_said,
                ]
                yield _file(out, number), self._content(deflections, over, said)

        write_files(drawn(), replace=self._arguments.force)
        others = sorted(before - {_file(out, number + 1) for number in range(frames)})
        return [
            f"drawn: {frames} files, {_file(out, 1)} to {_file(out, frames)}",
            self._shown,
            *self._sequence_said(period_s),
            *array_said[:2],
            *self._arrows_said,
            *(f"left as it was: {path}, which is not of this sequence" for path in others),
        ]

    def _animation(self) -> tuple[bytes, list[str]]:
        period_s = self._period_s()
        maps = [scenes.grays(deflections) for _, deflections in self._maps(period_s)]
        said = [
            f"shown: {count(self._frames, 'deflection map')}, rest white and full swing black",
            *self._sequence_said(period_s, "; each is shown for 100 ms"),
        ]
        return scenes.gif(maps, f"{self._title}. {self._told(said)}"), said

    def _outline(self) -> tuple[bytes, list[str]]:
        from vbraille.pictures.drawings import outline_figure

        canvas = self._scene.canvas
        if self._kind == "png":
            scenes.check_pixels(canvas, self._per_mm)
        said = [
            "shown: an outline drawing, black where more than half of the strongest deflection is "
            "felt",
            f"paper: {canvas.width_mm:g} × {canvas.height_mm:g} mm, true to scale; print without "
            "scaling",
            *self._arrows_said,
        ]
        figure = outline_figure(self._scene, self._assets, self._arrows)
        return self._file_of(figure, said), said

    def _maps(self, period_s: float) -> Iterator[tuple[float, NDArray[np.float32]]]:
        """Times of a sequence, evenly over its period, with the map at each."""
        for number in range(self._frames):
            time_s = period_s * number / self._frames
            yield (
                time_s,
                scenes.map_deflections(
                    self._scene,
                    self._assets,
                    self._per_mm,
                    noise_seed=None,
                    time_s=time_s,
                    parity=self._parity,
                ),
            )

    def _period_s(self) -> float:
        """Period that a sequence shows: that of the slowest swing or movement.

        Raises
        ------
        InputError
            If nothing swings or moves, or the maps would have too many pixels.
        """
        period_s = scenes.slowest_s(self._scene)
        if period_s is None:
            raise InputError(
                f"nothing in {self._arguments.file} vibrates or moves, so that all maps would be "
                "the same; leave out --vibration sequence"
            )
        self._check_room(self._frames)
        return period_s

    def _check_room(self, maps: int = 1) -> None:
        """Refuse maps of too many pixels before the first is made."""
        most = scenes.MOST_PIXELS[self._kind]
        given = self._arguments
        if self._kind == "png" and (given.rulers or given.array or given.arrows):
            most = scenes.MOST_PLACED_PIXELS
        if self._kind == "png" and self._arguments.rulers and self._per_mm < _LEAST_RULERS_PER_MM:
            raise InputError(
                f"--resolution is {self._per_mm:g}, at which numbers of rulers are specks; give "
                f"{_LEAST_RULERS_PER_MM:g} or more, or end --out in .svg or .pdf"
            )
        scenes.check_pixels(self._scene.canvas, self._per_mm, maps, most)

    @property
    def _shown(self) -> str:
        return _SHOWN_CSV if self._kind == "csv" else _SHOWN

    @property
    def _arrows_said(self) -> list[str]:
        """Sentence on the arrows, if they are wanted."""
        if not self._arguments.arrows:
            return []
        hollow = sum(arrow.hollow for arrow in self._arrows)
        return [
            f"arrows: {len(self._arrows) - hollow} for what moves, and {hollow} hollow for the "
            "hand that a signal answers"
        ]

    @property
    def _pixels(self) -> str:
        columns, rows = scenes.check_pixels(self._scene.canvas, self._per_mm)
        return f"pixels: {columns} × {rows}, {self._per_mm:g} a mm"

    def _sequence_said(self, period_s: float, each: str = "") -> list[str]:
        """Sentences on the maps of a sequence and the times between them."""
        between_ms, period_ms = 1000 * period_s / self._frames, 1000 * period_s
        return [
            self._pixels,
            f"time between maps: {between_ms:.4g} ms, of one slowest swing of {period_ms:.4g} ms"
            f"{each}",
            f"actuators: those of parity {self._parity}",
        ]

    def _array(self, time_s: float) -> tuple[ArrayOnMap | None, list[str]]:
        """Put the array on the scene as it is at a time, if it is wanted, and say what is shown."""
        if self._arguments.array is None:
            return None, []
        from vbraille.pictures import drawings  # loads matplotlib

        model = MODELS[self._arguments.model]
        display = model.display
        place = drawings.ArrayPlace(*self._arguments.array)
        drawings.check_on_canvas(self._scene.canvas, display, place)
        return drawings.show_array(self._scene, self._assets, display, place, time_s), [
            f"array: {model.title}, centre at ({place.x_mm:g}, {place.y_mm:g}) mm, turned by "
            f"{place.angle_deg:g}°",
            f"bars: shifted to the {display.rest_side} at rest and away from it at full swing, "
            "farther than in truth",
            f"bars that vibrate: as they are {1000 * time_s:.4g} ms after the beginning",
        ]

    def _content(
        self, deflections: NDArray[np.float32], over: ArrayOnMap | None, said: list[str]
    ) -> Content:
        """Make the file of one map, with what is over it and around it."""
        axes = self._arguments.rulers
        if self._kind == "csv":
            return scenes.map_csv(deflections, self._per_mm)
        if self._kind == "png" and over is None and not (axes or self._arrows):
            told = {"Title": self._title, "Description": self._told(said)}
            return scenes.png(scenes.grays(deflections), self._per_mm, told)
        from vbraille.pictures.drawings import map_figure

        canvas = self._scene.canvas
        figure = map_figure(canvas, deflections, over, arrows=self._arrows, axes=axes)
        return self._file_of(figure, said)

    def _file_of(self, figure: Figure, said: list[str]) -> bytes:
        """Make the file of a figure of matplotlib."""
        from vbraille.pictures.drawings import drawing_bytes

        return drawing_bytes(figure, self._kind, self._per_mm, self._title, self._told(said))

    def _told(self, said: list[str]) -> str:
        """Text of a picture's file: how it is drawn, and what it holds."""
        return f"{'; '.join(said)}; {scene_text(self._scene)}"
