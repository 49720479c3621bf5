"""Scenes of other formats made into scene files of our own."""

from __future__ import annotations

import os
import re
import textwrap
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.scene.dots import ImageDots
from vbraille.scene.including import form_of
from vbraille.scene.patterns import Image
from vbraille.scene.walking import with_children
from vbraille.scene.writing import LONGEST, write_scene

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vbraille.scene.opened import FoundScene
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.scene import Scene
    from vbraille.scene.walking import Steps

_LINE = re.compile(r"line (\d+)")


@dataclass(frozen=True, slots=True)
class ConvertedScene:
    """A scene file made of one of another format.

    Parameters
    ----------
    text
        Text of the file.
    elements
        Number of elements in it.
    differences
        What was ignored, or means something else here, each in one sentence.
    """

    text: str
    elements: int
    differences: tuple[str, ...]


def convert_scene(path: Path, folder: Path, *, as_shown: bool = False) -> ConvertedScene:
    """Make a scene file of a file of another format, OpenLatero's or SVG.

    Comments say where each element comes from, and what differs.

    Parameters
    ----------
    path
        The file.
    folder
        Folder that the new file will stand in; the names of images are seen from there.
    as_shown
        Whether a scene of OpenLatero's is to be as OpenLatero shows it, where that is not what the
        file says.

    Raises
    ------
    InputError
        If the file cannot be read, is not right, or is a scene file already.
    """
    form = form_of(path)
    if form == "toml":
        raise InputError(f"{path} is a scene file, or none at all; give a .gen, .tx or .svg file")
    if as_shown and form != "gen":
        raise InputError(f"{path} is not OpenLatero's; leave --as-shown out")
    found = _read(path, form, as_shown)
    scene = seen_from(found.scene, path.parent, folder)
    return ConvertedScene(
        write_scene(scene, _comments(path, found)), len(scene.elements), found.warnings
    )


def seen_from(scene: Scene, old: Path, new: Path) -> Scene:
    """Scene whose images are named as they are seen from another folder.

    Parameters
    ----------
    scene
        The scene.
    old, new
        Folder that the names are seen from, and the folder that they are to be seen from.
    """
    start, there = old.resolve(), new.resolve()
    if start == there:
        return scene

    def moved(_: Steps, pattern: AnyPattern) -> AnyPattern:
        if isinstance(pattern, Image | ImageDots):
            pattern = replace(pattern, file=_relative(start / pattern.file, there))
        return with_children(pattern, moved)

    return replace(
        scene,
        elements=tuple(moved((), element) for element in scene.elements),
        textures={name: moved((), texture) for name, texture in scene.textures.items()},
    )


def _relative(file: Path, folder: Path) -> str:
    """Name of a file from a folder; its whole path only where no other name leads there."""
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # another drive
        return file.as_posix()


def _read(path: Path, form: str, as_shown: bool) -> FoundScene:
    if form == "svg":
        from vbraille.scene.svg.reading import read_svg  # loads the library for SVG

        return read_svg(path)
    from vbraille.scene.openlatero import read_gen  # loads the library for XML

    return read_gen(path, as_shown=as_shown)


def _comments(path: Path, found: FoundScene) -> dict[Steps, tuple[str, ...]]:
    """Comments on the file and on its elements: where they come from, and what differs."""
    comments: dict[Steps, list[str]] = {(): [f"Converted from {_printed(path.name)}."]}
    for steps, line in found.lines.items():
        comments[steps] = [f"From line {line}."]
    for warning in found.warnings:
        comments[_about(warning, found.lines)] += textwrap.wrap(
            _printed(warning), LONGEST - 2, break_long_words=False, break_on_hyphens=False
        )
    return {steps: tuple(lines) for steps, lines in comments.items()}


def _about(warning: str, lines: Mapping[Steps, int]) -> Steps:
    """Element of the scene that a warning is about: the last that begins at its line or before."""
    found = _LINE.match(warning)
    line = int(found[1]) if found else 0
    before = [(at, steps) for steps, at in lines.items() if len(steps) == 2 and at <= line]
    return max(before)[1] if before else ()


def _printed(text: str) -> str:
    return "".join(c if c.isprintable() else "?" for c in text)
