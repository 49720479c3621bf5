"""``vbraille scene``: what a tactile picture holds, its file's form, and pictures of others."""

from __future__ import annotations

import sys
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.old.terminal import print_json, say_line
from vbraille.wording import spelled

if TYPE_CHECKING:
    import argparse

    from vbraille.feeling.loading import LoadedScene
    from vbraille.scene.checking import ElementReport, SceneReport


def run(arguments: argparse.Namespace) -> int:
    """Check or convert a picture, time its frames, or print the schema."""
    if arguments.action == "schema":
        from vbraille.scene.schema import schema_text

        sys.stdout.write(schema_text())
        return 0
    if arguments.action == "convert":
        return _convert(arguments)
    if arguments.action == "cost":
        from vbraille.cli.old.commands import scenecost

        return scenecost.run(arguments)
    return _check(arguments)


def _convert(arguments: argparse.Namespace) -> int:
    """Write a scene file made of a file of another program, and say what differs."""
    from vbraille.files import check_unused, write_file
    from vbraille.scene.converting import convert_scene

    path, out = Path(arguments.file), Path(arguments.out)
    check_unused(out, replace=arguments.force)
    made = convert_scene(path, out.parent, as_shown=arguments.as_shown)
    write_file(out, made.text.encode(), replace=arguments.force)
    for difference in made.differences:
        say_line(f"differs: {path} {difference}")
    say_line(f"elements: {made.elements}")
    say_line(f"differences: {len(made.differences)}")
    say_line(f"written: {out}")
    return 0


def _check(arguments: argparse.Namespace) -> int:
    from vbraille.feeling.checking import felt_advice
    from vbraille.feeling.loading import load_scene
    from vbraille.render import MODELS
    from vbraille.scene.checking import check_scene

    loaded = load_scene(arguments.file, MODELS["stress2"].style)
    report = check_scene(loaded.opened, loaded.boxes())
    report = replace(report, advice=(*report.advice, *felt_advice(loaded)))
    if arguments.json:
        print_json(_as_json(loaded, report))
    else:
        _say(loaded, report)
    return 0


def _say(loaded: LoadedScene, report: SceneReport) -> None:
    """Print the report, a line for each thing."""
    scene = loaded.opened.written
    for what, value in (("title", scene.title), ("description", scene.description)):
        if value:
            say_line(f"{what}: {' '.join(value.split())}")
    say_line(f"canvas: {scene.canvas.width_mm:g} × {scene.canvas.height_mm:g} mm")
    say_line(f"language: {scene.language}")
    say_line(f"elements: {len(report.elements)}, put together by {scene.operation}")
    for kind, number in report.kinds.items():
        say_line(f"{kind}: {number}")
    say_line(f"different textures: {report.textures}")
    for element in report.elements:
        say_line(_said(element))
    remarks = (
        *(f"file: {sentence}" for sentence in loaded.notes),
        *(f"vibration: {sentence}" for sentence in report.vibrations),
        *(f"advice: {sentence}" for sentence in report.advice),
    )
    for remark in remarks:
        say_line(spelled(remark))
    say_line(f"remarks: {len(remarks) or 'none'}")


def _said(element: ElementReport) -> str:
    box = element.box
    if box is None:
        where = "everywhere"
    elif box.is_empty:
        where = "nowhere"
    else:
        where = (
            f"{box.right - box.left:.1f} × {box.bottom - box.top:.1f} mm from "
            f"{box.left:.1f}, {box.top:.1f}"
        )
    hz = " and ".join(f"{one:g}" for one in element.vibration_hz)
    vibrates = f", vibrates at {hz} Hz" if hz else ""
    return f"{element.said()}: {where}{vibrates}, {element.place}"


def _as_json(loaded: LoadedScene, report: SceneReport) -> dict[str, object]:
    scene = loaded.opened.written
    elements = [
        {**asdict(one), "box": None if one.box is None or one.box.is_empty else one.box._asdict()}
        for one in report.elements
    ]
    return {
        "title": scene.title,
        "description": scene.description,
        "language": scene.language,
        "canvas": {"width_mm": scene.canvas.width_mm, "height_mm": scene.canvas.height_mm},
        "operation": scene.operation,
        **asdict(report),
        "elements": elements,
        "file": loaded.notes,
    }
