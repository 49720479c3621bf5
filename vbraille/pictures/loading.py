"""A scene from its file, with all that it needs to be felt: bitmaps, labels, its program."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from vbraille.errors import InputError
from vbraille.labelling import label_warnings, write_labels
from vbraille.render.labels import Assets, corners_mm
from vbraille.scene.geometry import Box, around
from vbraille.scene.images import load_bitmaps
from vbraille.scene.patterns import Image, Label
from vbraille.scene.reading import open_scene
from vbraille.scene.traversal import each
from vbraille.scene.zooming import levels, zoomed
from vbraille.sounds import read_sound

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from vbraille.display import Display
    from vbraille.render.braille.style import BrailleStyle
    from vbraille.scene.bitmap import Bitmap
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
    scene
        The scene as it is shown, with what is there at its zoom.
    numbers
        Numbers of the elements in the file, from 0.
    notes
        What was ignored, or cannot be felt as it stands, each in one sentence.
    zoom
        Zoom of the scene; 1 as the file has it.
    """

    opened: OpenedScene
    assets: Assets
    scene: Scene
    numbers: tuple[int, ...]
    notes: tuple[str, ...] = ()
    zoom: float = 1.0

    @property
    def title(self) -> str:
        """Title of the scene, or the name of its file."""
        return self.scene.title or self.opened.path.name

    def place(self, number: int) -> str:
        """File and line of an element as it is shown, by its number from 0."""
        return self.opened.place(self.numbers[number])

    def zoomed(self, zoom: float) -> LoadedScene:
        """Make the scene, which is as its file has it, at a zoom; see `vbraille.scene.zooming`.

        Images are read again: the nearer one is, the more of them is to be felt.

        Raises
        ------
        InputError
            If it would be too large or too small, or an image cannot be read any more.
        """
        if zoom == 1.0:
            return self
        return shown_at(self.opened, self.assets, self.notes, zoom)

    def boxes(self) -> Mapping[Image | Label, Box]:
        """Boxes of its images and labels, which `vbraille.scene.geometry` cannot know."""
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
    _read_sounds(opened)
    kinds = {type(pattern) for pattern in each(*scene.elements)}
    if kinds.isdisjoint((Image, Label)):  # Places take as long as all the rest of it.
        return shown_at(opened, Assets(), opened.warnings)
    places = opened.places
    bitmaps = load_bitmaps(scene, opened.folder, places)
    if Label not in kinds:
        return shown_at(opened, Assets(bitmaps), opened.warnings)
    written = write_labels(scene, style, places)
    notes = dict.fromkeys(opened.warnings)
    for zoom in (1.0, *levels(*scene.elements)):
        made = zoomed(scene, zoom, bitmaps)
        there = {new: written[old] for new, old in made.labels.items()}
        notes |= dict.fromkeys(label_warnings(made.scene, there, [places[n] for n in made.numbers]))
    return shown_at(opened, Assets(bitmaps, written), tuple(notes))


def _read_sounds(opened: OpenedScene) -> None:
    """Refuse files of sound that cannot be played."""
    for number, element in enumerate(opened.resolved.elements):
        for pattern in each(element):
            if pattern.sound:
                try:
                    read_sound(opened.folder / pattern.sound)
                except InputError as error:
                    raise InputError(f"{opened.place(number)}: {error}") from None


def shown_at(
    opened: OpenedScene, assets: Assets, notes: tuple[str, ...] = (), zoom: float = 1.0
) -> LoadedScene:
    """Make a scene at a zoom, of the assets that it has as its file has it.

    Raises
    ------
    InputError
        If it would be too large or too small, or an image cannot be read any more.
    """
    try:
        made = zoomed(opened.resolved, zoom, assets.bitmaps)
    except ValueError as error:
        raise InputError(f"{opened.path} at a zoom of {zoom:g}: {error}") from None
    written = {new: assets.written[old] for new, old in made.labels.items()}
    bitmaps: Mapping[Image, Bitmap] = {new: assets.bitmaps[old] for new, old in made.images.items()}
    if zoom != 1.0 and bitmaps:
        bitmaps = load_bitmaps(made.scene, opened.folder)
    # Others are there at other zooms.
    known = Assets({**assets.bitmaps, **bitmaps}, {**assets.written, **written})
    return LoadedScene(opened, known, made.scene, made.numbers, notes, zoom)


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
