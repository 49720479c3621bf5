"""``vbraille scene``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from vbraille.cli import options
from vbraille.cli.printing import say, show

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.pictures.checking import ElementReport, SceneReport
    from vbraille.pictures.loading import LoadedScene


@click.group(cls=options.Group)
def command() -> None:
    """Tactile pictures are scenes, drawings in SVG, or files of OpenLatero."""


@command.action("scene check texts/scenes/house.scene", options.file, options.json)
def check(file: str, json: bool) -> None:
    """List the elements of a picture, and what is hard to feel."""
    from dataclasses import asdict

    from vbraille.pictures.checking import check_scene
    from vbraille.pictures.loading import load_scene
    from vbraille.render import MODELS

    loaded = load_scene(file, MODELS["stress2"].style)
    report = check_scene(loaded)
    scene = loaded.opened.written
    elements = [
        {**asdict(one), "box": None if one.box is None or one.box.is_empty else one.box._asdict()}
        for one in report.elements
    ]
    found = {
        "title": scene.title,
        "description": scene.description,
        "language": scene.language,
        "canvas": {"width_mm": scene.canvas.width_mm, "height_mm": scene.canvas.height_mm},
        "operation": scene.operation,
        **asdict(report),
        "elements": elements,
        "file": loaded.notes,
    }
    show(_lines(loaded, report), found, as_json=json)


@command.action(
    "scene convert umbrella.gen --out umbrella.scene",
    options.file,
    options.out(required=True, metavar="NEW", help="Scene file to write."),
    options.option("--as-shown", is_flag=True, help="Convert what OpenLatero shows, where that "
                   "differs from its file."),
    options.force,
)  # fmt: skip
def convert(file: str, out: str, as_shown: bool, force: bool) -> None:
    """Convert a drawing or a file of OpenLatero to a scene."""
    from vbraille.files import check_unused, write_file
    from vbraille.scene.converting import convert_scene

    path = Path(out)
    check_unused(path, replace=force)
    made = convert_scene(Path(file), path.parent, as_shown=as_shown)
    write_file(path, made.text.encode(), replace=force)
    for difference in made.differences:
        say(f"differs: {file} {difference}")
    say(f"elements: {made.elements}")
    say(f"differences: {len(made.differences)}")
    say(f"written: {path}")


@command.action("scene schema > scene.schema.json")
def schema() -> None:
    """Print the JSON Schema of scene files, for editors."""
    from vbraille.scene.schema import schema_text

    click.echo(schema_text(), nl=False)


def _lines(loaded: LoadedScene, report: SceneReport) -> Iterator[str]:
    """A line for each thing of a report."""
    scene = loaded.opened.written
    for label, value in (("title", scene.title), ("description", scene.description)):
        if value:
            yield f"{label}: {' '.join(value.split())}"
    yield f"canvas: {scene.canvas.width_mm:g} × {scene.canvas.height_mm:g} mm"
    yield f"language: {scene.language}"
    yield f"elements: {len(report.elements)}, combined by {scene.operation}"
    yield from (f"{kind}: {number}" for kind, number in report.kinds.items())
    yield f"different textures: {report.textures}"
    yield from map(_described, report.elements)
    yield from (f"file: {note}" for note in loaded.notes)
    yield from (f"advice: {sentence}" for sentence in report.advice)
    yield f"remarks: {len(loaded.notes) + len(report.advice) or 'none'}"


def _described(element: ElementReport) -> str:
    box = element.box
    if box is None:
        where = "everywhere"
    elif box.is_empty:
        where = "nowhere"
    else:
        size = f"{box.right - box.left:.1f} × {box.bottom - box.top:.1f} mm"
        where = f"{size} from {box.left:.1f}, {box.top:.1f}"
    hz = " and ".join(f"{one:g}" for one in element.vibration_hz)
    vibrates = f", vibrates at {hz} Hz" if hz else ""
    return f"{element.said()}: {where}{vibrates}, {element.place}"
