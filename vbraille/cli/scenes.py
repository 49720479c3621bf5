"""Scenes for commands: opened, with all that they take from elsewhere, and what is said of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from vbraille.cli.terminal import say_line
from vbraille.labelling import label_warnings, write_labels
from vbraille.render.scene.assets import Assets
from vbraille.scene.images import load_bitmaps
from vbraille.scene.reading import open_scene
from vbraille.wording import spelled

if TYPE_CHECKING:
    from vbraille.render.braille.style import BrailleStyle
    from vbraille.scene.opened import OpenedScene


class PreparedScene(NamedTuple):
    """A scene from a file, and its bitmaps and labels."""

    opened: OpenedScene
    assets: Assets


def prepare_scene(file: str, style: BrailleStyle) -> PreparedScene:
    """Open a scene, load its images and translate its labels; stderr is told of what is odd.

    Parameters
    ----------
    file
        Path of the scene's file.
    style
        Style of the braille in it.

    Raises
    ------
    InputError
        If the file, an image or a label cannot be used; one sentence says where.
    """
    opened = open_scene(file)
    scene = opened.resolved
    places = [opened.place(number) for number in range(len(scene.elements))]
    written = write_labels(scene, style, places)
    assets = Assets(load_bitmaps(scene, opened.folder), written)
    for warning in (*opened.warnings, *label_warnings(scene, written, places)):
        say_line(spelled(warning), aside=True)
    return PreparedScene(opened, assets)
