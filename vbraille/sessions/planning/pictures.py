"""Pictures as stimuli: elements of a scene whose file stands beside the protocol.

A picture is named by the ids of its elements, with blanks between them. Elements without an id
belong to every picture of their scene.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from msgspec import structs

from vbraille.errors import InputError
from vbraille.pictures.composing import compose
from vbraille.pictures.loading import check_fits, shown_at
from vbraille.render.labels import Assets
from vbraille.render.program import Program
from vbraille.scene.locations import OpenedScene
from vbraille.scene.patterns import Image, ImageDots, Label
from vbraille.scene.reading import open_text
from vbraille.scene.traversal import each
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.trial import Stimulus
from vbraille.toml import which


def check_picture(protocol: Protocol, stimulus: Stimulus) -> None:
    """Check that there is a picture, and that the display has room for it.

    Raises
    ------
    ValueError
        If there is none.
    InputError
        If the scene or its canvas cannot be used.
    """
    if not protocol.display_model.display.height_mm:
        raise ValueError("the model's carriage goes along one line only; give 'pantograph'")
    check_fits(picture(protocol, stimulus).resolved, protocol.display_model.display)


def compile_picture(protocol: Protocol, opened: OpenedScene, contrast: float) -> Program:
    """Compile a picture for the protocol's display."""
    display = protocol.display_model.display
    loaded = shown_at(opened, Assets())
    return compose(loaded, display, rate_hz=display.rate_hz, contrast=contrast)


def picture(protocol: Protocol, stimulus: Stimulus) -> OpenedScene:
    """Return the scene with the elements of a picture alone.

    Raises
    ------
    ValueError
        If the scene lacks one.
    InputError
        If the scene cannot be used.
    """
    scene, wanted = stimulus.look.scene or "", stimulus.picture.split()
    opened = _scene(protocol.files[scene], scene)
    known = [element.id for element in opened.written.elements]
    for name in wanted:
        if name not in known:
            raise ValueError(f"{scene} has no element {name!r}{which(name, filter(None, known))}")
    pairs = zip(opened.written.elements, opened.resolved.elements, strict=True)
    shown = tuple(resolved for own, resolved in pairs if not own.id or own.id in wanted)
    return replace(opened, resolved=structs.replace(opened.resolved, elements=shown))


@lru_cache(maxsize=16)
def _scene(content: bytes, name: str) -> OpenedScene:
    opened = open_text(content.decode("utf-8"), name)
    if any(isinstance(one, Image | ImageDots | Label) for one in each(*opened.written.elements)):
        raise InputError(f"{name} has images or labels; pictures of a protocol are shapes and dots")
    return opened
