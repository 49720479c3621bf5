"""``vbraille map``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.terminal import say_line
from vbraille.errors import InputError
from vbraille.feeling.loading import load_scene
from vbraille.files import write_file, write_files
from vbraille.pictures import scenes
from vbraille.pictures.scenewords import scene_lines, scene_text
from vbraille.render import MODELS
from vbraille.wording import count, spelled

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.pictures.drawings import ArrayOnMap
    from vbraille.render.scene.assets import Assets
    from vbraille.scene.scene import Scene

_KINDS = ("png", "svg", "csv", "pdf", "gif")
_FRAMES, _MOST_FRAMES = 8, 500
_FINE_PIXELS_PER_MM = 12.0  # of outlines, of which a PNG has edges
# When vibrations of 50 Hz are at their ends: an array that is drawn shows them best then.
_ARRAY_TIME_S = 0.005
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
    scene, assets, title = loaded.scene, loaded.assets, loaded.title
    for note in loaded.notes:
        say_line(spelled(note), aside=True)
    draw = _map
    if arguments.vibration == "sequence":
        draw = _animation
    elif arguments.outline:
        draw = _outline
    try:
        if numbered:
            said = _numbered(scene, assets, arguments, kind, title)
        else:
            content, said = draw(scene, assets, arguments, kind, title)
            write_file(out, content, replace=arguments.force)
            said = [f"drawn: {out}", *said]
    except ValueError as error:  # patterns stand too deep in each other
        raise InputError(f"{arguments.file}: {error}") from None
    for line in (*said, *scene_lines(scene)):
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
            arguments.outline and (arguments.array or arguments.axes or sequence),
            "--array, --axes and --vibration sequence are for maps; leave out either these or "
            "--outline",
        ),
        (
            kind == "gif" and (arguments.array or arguments.axes),
            "an animation has maps alone; leave out --array and --axes, or end --out in .png",
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
    _check_room(scene, arguments, kind)
    over, array_said = _array(scene, assets, arguments, _ARRAY_TIME_S)
    per_mm = _per_mm(arguments)
    deflections = scenes.map_deflections(scene, assets, per_mm, noise_seed=arguments.seed)
    said = [
        _SHOWN if kind != "csv" else _SHOWN_CSV,
        _pixels_said(scene, per_mm),
        f"vibration: as noise, seed {arguments.seed}",
        *array_said,
    ]
    return _content(scene, arguments, kind, title, deflections, over, said), said


def _check_room(scene: Scene, arguments: argparse.Namespace, kind: str, maps: int = 1) -> None:
    """Refuse maps of too many pixels before the first is made."""
    most = scenes.MOST_CSV_ROWS if kind == "csv" else scenes.MOST_PIXELS
    scenes.check_pixels(scene.canvas, _per_mm(arguments), maps, most)


def _pixels_said(scene: Scene, per_mm: float) -> str:
    columns, rows = scenes.check_pixels(scene.canvas, per_mm)
    return f"pixels: {columns} × {rows}, {per_mm:g} a mm"


def _array(
    scene: Scene, assets: Assets, arguments: argparse.Namespace, time_s: float
) -> tuple[ArrayOnMap | None, list[str]]:
    """Put the array on the scene as it is at a time, if it is wanted, and say what is shown."""
    if arguments.array is None:
        return None, []
    from vbraille.pictures import drawings  # loads matplotlib

    display = MODELS[arguments.model].display
    place = drawings.ArrayPlace(*arguments.array)
    drawings.check_on_canvas(scene.canvas, display, place)
    return drawings.show_array(scene, assets, display, place, time_s), [
        f"array: {MODELS[arguments.model].title}, centre at ({place.x_mm:g}, {place.y_mm:g}) "
        f"mm, turned by {place.angle_deg:g}°",
        f"bars: shifted to the {display.rest_side} at rest and away from it at full swing, "
        "farther than in truth",
        f"bars that vibrate: as they are {1000 * time_s:.4g} ms after the beginning",
    ]


def _content(
    scene: Scene,
    arguments: argparse.Namespace,
    kind: str,
    title: str,
    deflections: NDArray[np.float32],
    over: ArrayOnMap | None,
    said: list[str],
) -> bytes:
    """Make the file of one map, with what is over it and around it."""
    per_mm = _per_mm(arguments)
    if kind == "csv":
        return scenes.map_csv(deflections, per_mm)
    if kind == "png" and over is None and not arguments.axes:
        told = {"Title": title, "Description": _told(scene, said)}
        return scenes.png(scenes.grays(deflections), per_mm, told)
    from vbraille.pictures.drawings import drawing_bytes, map_figure

    figure = map_figure(scene.canvas, deflections, over, axes=arguments.axes)
    return drawing_bytes(figure, kind, per_mm, title, _told(scene, said))


def _period_s(scene: Scene, arguments: argparse.Namespace) -> float:
    """Period that a sequence shows: that of the slowest swing or movement."""
    period_s = scenes.slowest_s(scene)
    if period_s is None:
        raise InputError(
            f"nothing in {arguments.file} vibrates or moves, so that all maps would be the same; "
            "leave out --vibration sequence"
        )
    return period_s


def _numbered(
    scene: Scene, assets: Assets, arguments: argparse.Namespace, kind: str, title: str
) -> list[str]:
    """Write the maps of one period, a file each, and tell what there is to say."""
    out, frames = Path(arguments.out), arguments.frames or _FRAMES
    period_s, parity = _period_s(scene, arguments), arguments.parity or 0
    _check_room(scene, arguments, kind, frames)
    per_mm = _per_mm(arguments)
    before = set(_in_set(out))
    array_said: list[str] = []

    def drawn() -> Iterator[tuple[Path, bytes]]:
        for number in range(frames):
            time_s = period_s * number / frames
            over, array_said[:] = _array(scene, assets, arguments, time_s)
            deflections = scenes.map_deflections(
                scene, assets, per_mm, noise_seed=None, time_s=time_s, parity=parity
            )
            said = [
                f"{_SHOWN}, number {number + 1} of {frames}",
                f"time: {1000 * time_s:.4g} ms after the beginning",
                f"actuators: those of parity {parity}",
                *array_said,
            ]
            content = _content(scene, arguments, kind, title, deflections, over, said)
            yield _file(out, number + 1), content

    write_files(drawn(), replace=arguments.force)
    others = sorted(before - {_file(out, number + 1) for number in range(frames)})
    left = [f"left as it was: {path}, which is not of this sequence" for path in others]
    return [
        f"drawn: {frames} files, {_file(out, 1)} to {_file(out, frames)}",
        _SHOWN_CSV if kind == "csv" else _SHOWN,
        _pixels_said(scene, per_mm),
        _between_said(period_s, frames),
        f"actuators: those of parity {parity}",
        *array_said[:2],
        *left,
    ]


def _between_said(period_s: float, frames: int) -> str:
    return (
        f"time between maps: {1000 * period_s / frames:.4g} ms, of one slowest swing of "
        f"{1000 * period_s:.4g} ms"
    )


def _animation(
    scene: Scene, assets: Assets, arguments: argparse.Namespace, kind: str, title: str
) -> tuple[bytes, list[str]]:
    frames, parity = arguments.frames or _FRAMES, arguments.parity or 0
    period_s = _period_s(scene, arguments)
    _check_room(scene, arguments, kind, frames)
    per_mm = _per_mm(arguments)
    maps = [
        scenes.grays(
            scenes.map_deflections(
                scene,
                assets,
                per_mm,
                noise_seed=None,
                time_s=period_s * number / frames,
                parity=parity,
            )
        )
        for number in range(frames)
    ]
    said = [
        f"shown: {count(frames, 'deflection map')}, rest white and full swing black",
        _pixels_said(scene, per_mm),
        f"{_between_said(period_s, frames)}; each is shown for 100 ms",
        f"actuators: those of parity {parity}",
    ]
    return scenes.gif(maps, f"{title}. {_told(scene, said)}"), said


def _outline(
    scene: Scene, assets: Assets, arguments: argparse.Namespace, kind: str, title: str
) -> tuple[bytes, list[str]]:
    from vbraille.pictures.drawings import drawing_bytes, outline_figure

    per_mm = arguments.resolution or _FINE_PIXELS_PER_MM
    if kind == "png":
        scenes.check_pixels(scene.canvas, per_mm)
    canvas = scene.canvas
    said = [
        "shown: an outline drawing, black where more than half of the strongest deflection is felt",
        f"paper: {canvas.width_mm:g} × {canvas.height_mm:g} mm, true to scale; print without "
        "scaling",
    ]
    figure = outline_figure(scene, assets)
    return drawing_bytes(figure, kind, per_mm, title, _told(scene, said)), said


def _per_mm(arguments: argparse.Namespace) -> float:
    return scenes.PIXELS_PER_MM if arguments.resolution is None else arguments.resolution


def _told(scene: Scene, said: list[str]) -> str:
    """Text of a picture's file: how it is drawn, and what it holds."""
    return f"{'; '.join(said)}; {scene_text(scene)}"
