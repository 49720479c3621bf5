"""Pictures as stimuli: elements of a scene whose file stands beside the protocol.

A picture is named by the ids of its elements, with blanks between them. Elements without an id
belong to every picture of their scene.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

from msgspec import structs

from vbraille.errors import InputError
from vbraille.feeling.composing import compose
from vbraille.feeling.loading import check_fits, shown_at
from vbraille.render.labels import Assets
from vbraille.scene.patterns import Image, ImageDots, Label
from vbraille.scene.reading import open_text
from vbraille.scene.traversal import each
from vbraille.tomlfile import which

if TYPE_CHECKING:
    from vbraille.display import Display
    from vbraille.render.program import Program
    from vbraille.scene.locations import OpenedScene
    from vbraille.scene.scene import Canvas


@dataclass(frozen=True, slots=True)
class PictureScene:
    """A scene whose elements are pictures; `picture_scene` opens one."""

    _opened: OpenedScene

    @property
    def canvas(self) -> Canvas:
        """Canvas that the pictures stand on."""
        return self._opened.resolved.canvas

    def check(self, picture: str, display: Display) -> None:
        """Check that there is a picture of a name, and that a display has room for it.

        Raises
        ------
        ValueError
            If there is none.
        InputError
            If the canvas is too large.
        """
        check_fits(self._only(picture).resolved, display)

    def compile(self, picture: str, display: Display, contrast: float) -> Program:
        """Compile a picture for a display, with a factor of all deflections.

        Raises
        ------
        InputError
            If the display cannot show it.
        """
        loaded = shown_at(self._only(picture), Assets())
        return compose(loaded, display, rate_hz=display.rate_hz, contrast=contrast)

    def _only(self, picture: str) -> OpenedScene:
        """Scene with the elements of a picture alone."""
        names, opened = picture.split(), self._opened
        known = [element.id for element in opened.written.elements]
        for name in names:
            if name not in known:
                raise ValueError(f"{opened.path} has no element {name!r}{which(name, known)}")
        elements = tuple(
            element
            for element, name in zip(opened.resolved.elements, known, strict=True)
            if not name or name in names
        )
        return replace(opened, resolved=structs.replace(opened.resolved, elements=elements))


@lru_cache(16)
def picture_scene(text: str, name: str) -> PictureScene:
    """Open the scene of a file's text.

    Raises
    ------
    InputError
        If it is no scene, or has what other files or braille tables make.
    """
    opened = open_text(text, name)
    if any(isinstance(one, Image | ImageDots | Label) for one in each(*opened.written.elements)):
        raise InputError(
            f"{name} has images or labels, and pictures of a protocol are shapes, dots and "
            f"textures alone, so that a session needs no other file; leave them out"
        )
    return PictureScene(opened)
