"""``vbraille scene``: what a tactile picture holds, its file's form, and pictures of others."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from typing import TYPE_CHECKING

from vbraille.cli.terminal import say_line

if TYPE_CHECKING:
    import argparse
    from collections.abc import Mapping

    from vbraille.scene.bounds import Box
    from vbraille.scene.checking import ElementReport, SceneReport
    from vbraille.scene.opened import OpenedScene
    from vbraille.scene.patterns import Image, Label


def run(arguments: argparse.Namespace) -> int:
    """Check or convert a picture, or print the schema."""
    if arguments.action == "schema":
        from vbraille.scene.schema import schema_text

        sys.stdout.write(schema_text())
        return 0
    if arguments.action == "convert":
        from vbraille.cli.commands import scene_convert

        return scene_convert.run(arguments)
    return _check(arguments)


def _check(arguments: argparse.Namespace) -> int:
    from vbraille.scene.checking import check_scene
    from vbraille.scene.reading import open_scene

    opened = open_scene(arguments.file)
    known, labels = _known(opened)
    report = check_scene(opened, known)
    if arguments.json:
        print(json.dumps(_as_json(opened, report, labels), ensure_ascii=False, indent=2))
        return 0
    _say(opened, report, labels)
    return 0


def _known(opened: OpenedScene) -> tuple[Mapping[Image | Label, Box], list[str]]:
    """Boxes of images and labels, which are made as they will be felt; what is said of labels."""
    from vbraille.scene.images import load_bitmaps
    from vbraille.scene.patterns import Label
    from vbraille.scene.walking import each

    scene = opened.resolved
    boxes: dict[Image | Label, Box] = {}
    for image, bitmap in load_bitmaps(scene, opened.folder).items():
        left, top = bitmap.place_mm
        if not bitmap.outside:
            boxes[image] = Box(left, top, left + bitmap.width_mm, top + bitmap.height_mm)
    if not any(isinstance(pattern, Label) for pattern in each(*scene.elements)):
        return boxes, []
    from vbraille.labelling import label_warnings, write_labels  # loads liblouis
    from vbraille.render import MODELS
    from vbraille.render.scene.brailleplaces import box_of

    written = write_labels(scene, MODELS["stress2"].style, opened.places)
    boxes |= {label: box_of(label, cells) for label, cells in written.items()}
    return boxes, label_warnings(scene, written, opened.places)


def _say(opened: OpenedScene, report: SceneReport, labels: list[str]) -> None:
    """Print the report, a line for each thing."""
    scene = opened.written
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
    for heading, sentences in (
        ("ignored or changed", opened.warnings),
        ("vibration", report.vibrations),
        ("label", labels),
        ("advice", report.advice),
    ):
        for sentence in sentences:
            say_line(f"{heading}: {sentence}")
    said = len(opened.warnings) + len(report.vibrations) + len(labels) + len(report.advice)
    say_line(f"remarks: {said}" if said else "remarks: none, it is as it should be")


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


def _as_json(opened: OpenedScene, report: SceneReport, labels: list[str]) -> dict[str, object]:
    scene = opened.written
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
        "ignored": opened.warnings,
        "labels": labels,
    }
