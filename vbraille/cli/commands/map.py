"""``vbraille map``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.terminal import say_line
from vbraille.errors import InputError
from vbraille.feeling.loading import load_scene
from vbraille.files import write_file
from vbraille.pictures import scenes
from vbraille.pictures.inkfiles import ink_bytes
from vbraille.pictures.scenewords import scene_lines, scene_text
from vbraille.render import MODELS
from vbraille.wording import count, nearest, spelled

if TYPE_CHECKING:
    import argparse

    from vbraille.pictures.ink import InkDrawing
    from vbraille.render.scene.assets import Assets
    from vbraille.scene.scene import Scene

_KINDS = ("png", "svg", "csv", "pdf", "gif")
_FRAMES, _MOST_FRAMES = 8, 500
_FINE_PIXELS_PER_MM = 12.0  # of drawings without grays, of which a PNG has edges
# When vibrations of 50 Hz are at their ends: an array that is drawn shows them best then.
_ARRAY_TIME_S = 0.005


def run(arguments: argparse.Namespace) -> int:
    """Draw a scene, and say what is shown."""
    out = Path(arguments.out)
    kind = _kind(out)
    _check(arguments, kind)
    if out.exists() and not arguments.force and not out.is_dir():
        raise InputError(f"{out} is there already; give another name with --out, or --force")
    loaded = load_scene(arguments.file, MODELS[arguments.model].style)
    scene, assets, title = loaded.scene, loaded.assets, loaded.title
    for note in loaded.notes:
        say_line(spelled(note), aside=True)
    if arguments.vibration == "sequence":
        content, said = _sequence(scene, assets, arguments, kind, title)
    elif arguments.abstract or arguments.raised:
        content, said = _drawing(scene, assets, arguments, kind, title)
    else:
        content, said = _map(scene, assets, arguments, kind, title)
    write_file(out, content, replace=arguments.force)
    for line in (f"drawn: {out}", *said, *scene_lines(scene)):
        say_line(line)
    return 0


def _kind(out: Path) -> str:
    kind = out.suffix.lower().removeprefix(".")
    if kind not in _KINDS:
        known = ", ".join(f".{kind}" for kind in _KINDS)
        what = f"ends in .{kind}, {nearest(kind, _KINDS)}" if kind else "has no suffix"
        raise InputError(f"--out {out} {what}; end its name in one of {known}")
    return kind


def _check(arguments: argparse.Namespace, kind: str) -> None:
    """Refuse options that do not go together."""
    sequence = arguments.vibration == "sequence"
    drawn = "--abstract" if arguments.abstract else "--raised" if arguments.raised else ""
    for wrong, problem in (
        (
            arguments.abstract and arguments.raised,
            "--abstract and --raised are two drawings; leave one of them out",
        ),
        (drawn and kind in ("csv", "gif"), f"{drawn} is no map; end --out in .svg, .pdf or .png"),
        (
            drawn and (arguments.array or arguments.axes or sequence),
            f"--array, --axes and --vibration sequence are for maps; leave out either these or "
            f"{drawn}",
        ),
        (
            arguments.sheet != "canvas" and not arguments.raised,
            "--sheet is for raised drawings; add --raised or leave it out",
        ),
        (
            sequence and kind not in ("png", "gif"),
            "a sequence is an animation; end --out in .png or .gif",
        ),
        (
            sequence and (arguments.array or arguments.axes),
            "--array and --axes are for one map; leave out either these or --vibration sequence",
        ),
        (
            not sequence and (arguments.frames is not None or arguments.parity is not None),
            "--frames and --parity are for --vibration sequence; add that or leave them out",
        ),
        (kind == "gif" and not sequence, "GIF is for --vibration sequence; end --out in .png"),
        (
            kind == "csv" and (arguments.array or arguments.axes),
            "CSV has the map's numbers alone; leave out --array and --axes",
        ),
    ):
        if wrong:
            raise InputError(problem)
    if arguments.frames is not None and not 2 <= arguments.frames <= _MOST_FRAMES:
        raise InputError(f"--frames is {arguments.frames}; it must be 2 to {_MOST_FRAMES}")


def _map(
    scene: Scene, assets: Assets, arguments: argparse.Namespace, kind: str, title: str
) -> tuple[bytes, list[str]]:
    per_mm = _per_mm(arguments)
    if kind == "csv":
        scenes.check_pixels(scene.canvas, per_mm, most=scenes.MOST_CSV_ROWS)
    over = ()
    said = []
    if arguments.array is not None:
        from vbraille.pictures import overmap

        display = MODELS[arguments.model].display
        place = overmap.ArrayPlace(*arguments.array)
        overmap.check_on_canvas(scene.canvas, display, place)
        frame = overmap.array_deflections(scene, assets, display, place, _ARRAY_TIME_S)
        over = overmap.array_marks(display, place, frame)
        said = [
            f"array: {MODELS[arguments.model].title}, centre at ({place.x_mm:g}, {place.y_mm:g}) "
            f"mm, turned by {place.angle_deg:g}°",
            f"bars: shifted to the {display.rest_side} at rest and away from it at full swing, "
            "farther than in truth",
            f"bars that vibrate: as they are {1000 * _ARRAY_TIME_S:g} ms after the beginning",
        ]
    deflections = scenes.map_deflections(scene, assets, per_mm, noise_seed=arguments.seed)
    rows, columns = deflections.shape
    said = [
        "shown: a deflection map, rest white and full swing black",
        f"pixels: {columns} × {rows}, {per_mm:g} a mm",
        f"vibration: as noise, seed {arguments.seed}",
        *said,
    ]
    if kind == "csv":
        said[0] = "shown: a deflection map, a row for each pixel with x, y and its deflection"
        return scenes.map_csv(deflections, per_mm), said
    if kind == "png" and not over and not arguments.axes:
        told = {"Title": title, "Description": _told(scene, said)}
        return scenes.png([scenes.grays(deflections)], per_mm, told), said
    from vbraille.pictures.overmap import map_drawing

    drawing = map_drawing(scene, deflections, over, axes=arguments.axes)
    return ink_bytes(_named(drawing, scene, title, said), kind, per_mm), said


def _sequence(
    scene: Scene, assets: Assets, arguments: argparse.Namespace, kind: str, title: str
) -> tuple[bytes, list[str]]:
    frames, parity = arguments.frames or _FRAMES, arguments.parity or 0
    period_s = scenes.slowest_s(scene)
    if period_s is None:
        raise InputError(
            f"nothing in {arguments.file} vibrates or moves, so that all maps would be the same; "
            "leave out --vibration sequence"
        )
    per_mm = _per_mm(arguments)
    scenes.check_pixels(scene.canvas, per_mm, frames)
    times = [period_s * number / frames for number in range(frames)]
    maps = [
        scenes.grays(
            scenes.map_deflections(
                scene, assets, per_mm, noise_seed=None, time_s=time_s, parity=parity
            )
        )
        for time_s in times
    ]
    rows, columns = maps[0].shape
    said = [
        f"shown: {count(frames, 'deflection map')}, rest white and full swing black",
        f"pixels: {columns} × {rows}, {per_mm:g} a mm",
        f"time between maps: {1000 * period_s / frames:.4g} ms, of one slowest swing of "
        f"{1000 * period_s:.4g} ms; each is shown for 100 ms",
        f"actuators: those of parity {parity}",
    ]
    text = _told(scene, said)
    if kind == "gif":
        return scenes.gif(maps, f"{title}. {text}"), said
    return scenes.png(maps, per_mm, {"Title": title, "Description": text}), said


def _drawing(
    scene: Scene, assets: Assets, arguments: argparse.Namespace, kind: str, title: str
) -> tuple[bytes, list[str]]:
    if arguments.raised:
        from vbraille.pictures.raised import raised_drawing

        sheet = None if arguments.sheet == "canvas" else arguments.sheet
        drawing = raised_drawing(scene, assets, sheet)
        said = ["shown: a raised drawing, black where the paper swells", *drawing.said]
    else:
        from vbraille.pictures.abstract import abstract_drawing

        drawing = abstract_drawing(scene, assets)
        said = ["shown: an abstract drawing, darker where it is stronger, dots where it vibrates"]
    per_mm = arguments.resolution or _FINE_PIXELS_PER_MM
    if kind == "png":
        scenes.check_pixels(scene.canvas, per_mm)
    return ink_bytes(_named(drawing, scene, title, said), kind, per_mm), said


def _per_mm(arguments: argparse.Namespace) -> float:
    return scenes.PIXELS_PER_MM if arguments.resolution is None else arguments.resolution


def _named(drawing: InkDrawing, scene: Scene, title: str, said: list[str]) -> InkDrawing:
    return replace(drawing, title=title, description=_told(scene, said))


def _told(scene: Scene, said: list[str]) -> str:
    """Text of a picture's file: how it is drawn, and what it holds."""
    return f"{'; '.join(said)}; {scene_text(scene)}"
