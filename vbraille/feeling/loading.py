"""A scene from its file, with all that it needs to be felt: bitmaps, labels, its program."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from vbraille.errors import InputError
from vbraille.labelling import label_warnings, write_labels
from vbraille.render.scene.labels import Assets, corners_mm
from vbraille.scene.bounds import Box, around
from vbraille.scene.images import load_bitmaps
from vbraille.scene.patterns import Image, Label
from vbraille.scene.reading import open_scene
from vbraille.scene.traversal import each

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from vbraille.display import Display
    from vbraille.render.braille.style import BrailleStyle
    from vbraille.scene.locations import OpenedScene
    from vbraille.scene.scene import Scene

_EDGE_MM = 0.05  # by so much a canvas may be larger than a carriage goes


@dataclass(frozen=True, slots=True, eq=False)
class LoadedScene:
    """A scene that was read from a file, with all that it takes from elsewhere.

    Parameters
    ----------
    opened
        The scene, and where it was written.
    assets
        Bitmaps of its images and cells of its labels.
    notes
        What was ignored, or cannot be felt as it stands, each in one sentence.
    """

    opened: OpenedScene
    assets: Assets
    notes: tuple[str, ...] = field(default=())

    @property
    def scene(self) -> Scene:
        """The scene as it is shown."""
        return self.opened.resolved

    @property
    def title(self) -> str:
        """Title of the scene, or the name of its file."""
        return self.scene.title or self.opened.path.name

    def boxes(self) -> Mapping[Image | Label, Box]:
        """Boxes of its images and labels, which `vbraille.scene.bounds` cannot know."""
        found: dict[Image | Label, Box] = {
            label: around(corners_mm(label, written))
            for label, written in self.assets.written.items()
        }
        for image, bitmap in self.assets.bitmaps.items():
            if not bitmap.outside:
                left, top = bitmap.place_mm
                found[image] = Box(left, top, left + bitmap.width_mm, top + bitmap.height_mm)
        return found


def load_scene(path: Path | str, style: BrailleStyle) -> LoadedScene:
    """Read a scene with its images, and translate its labels.

    Parameters
    ----------
    path
        Scene file, SVG, or a file of OpenLatero's.
    style
        How the braille of its labels is shown.

    Raises
    ------
    InputError
        If one of the files cannot be used, or a label cannot be written.
    """
    return with_assets(open_scene(path), style)


def with_assets(opened: OpenedScene, style: BrailleStyle) -> LoadedScene:
    """Load the images of a scene that was opened, and translate its labels; see `load_scene`."""
    scene = opened.resolved
    kinds = {type(pattern) for pattern in each(*scene.elements)}
    if kinds.isdisjoint((Image, Label)):  # Places take as long as all the rest of it.
        return LoadedScene(opened, Assets(), opened.warnings)
    places = opened.places
    bitmaps = load_bitmaps(scene, opened.folder, places)
    if Label not in kinds:
        return LoadedScene(opened, Assets(bitmaps), opened.warnings)
    written = write_labels(scene, style, places)
    notes = (*opened.warnings, *label_warnings(scene, written, places))
    return LoadedScene(opened, Assets(bitmaps, written), notes)


def check_fits(scene: Scene, display: Display) -> None:
    """Compare a scene's canvas with how far the carriage of a display goes.

    Raises
    ------
    InputError
        If some of the canvas could not be reached.
    """
    canvas = scene.canvas
    beyond = canvas.width_mm > display.travel_mm + _EDGE_MM
    workspace = f"{display.travel_mm:g} mm"
    if display.height_mm:
        beyond = beyond or canvas.height_mm > display.height_mm + _EDGE_MM
        workspace = f"{display.travel_mm:g} × {display.height_mm:g} mm"
    if beyond:
        raise InputError(
            f"the scene's canvas is {canvas.width_mm:g} × {canvas.height_mm:g} mm, and the "
            f"carriage of {display.name} goes {workspace}; make the canvas smaller, or take "
            f"another device"
        )


_Stamp = tuple[int, int, int]
_QUIET_NS: Final = 10_000_000


class FileWatch:
    """Sees whether a file has changed, by one look at its directory entry each time.

    A change is told once the file has been quiet for 10 ms, or is the same at two looks, and is
    not empty, so that one which is just being written is read when it is whole.

    Parameters
    ----------
    path
        The file.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._known = self._stamp()
        self._seen = self._known

    def changed(self) -> bool:
        """Tell whether the file is another than at the last change that was told."""
        stamp = self._stamp()
        same, self._seen = stamp == self._seen, stamp
        if stamp is None or stamp == self._known:
            return False
        written_ns, size, _ = stamp
        if size == 0 or not (same or time.time_ns() - written_ns > _QUIET_NS):
            return False
        self._known = stamp
        return True

    def _stamp(self) -> _Stamp | None:
        """Give the stamp that tells states of the file apart; None if there is no file."""
        try:
            found = self._path.stat()
        except OSError:
            return None
        return found.st_mtime_ns, found.st_size, found.st_ino
