"""Scenes of OpenLatero's: groups, toggles, images and sounds, and the file that holds them."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.scene.filebytes import read_bytes
from vbraille.scene.imagefiles import intensities_of
from vbraille.scene.locations import FoundScene
from vbraille.scene.measures import MOST_MM
from vbraille.scene.openlatero.elements import (
    MOST_BYTES,
    PATTERNS,
    Context,
    Element,
    makes,
    number,
    pattern_of,
    place,
    read_root,
)
from vbraille.scene.openlatero.textures import joined
from vbraille.scene.patterns import Group, Image
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import Switch
from vbraille.scene.textures import Uniform
from vbraille.scene.traversal import placed_children
from vbraille.sounds import read_sound

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from vbraille.scene.patterns import AnyPattern, Operation
    from vbraille.scene.traversal import Steps

# The surface that the pictures stand on, which no file says.
SURFACE_MM = (289.9, 230.1875)
_LEAST_SIZE_MM = 0.1


@makes(PATTERNS, "Group")
def _group(element: Element) -> AnyPattern | None:
    if not element.Pattern:
        element.say("it has no patterns; left out")
        return None
    return joined(element.operation, [pattern_of(part) for part in element.Pattern])


@makes(PATTERNS, "Toggle")
def _toggle(element: Element) -> AnyPattern | None:
    """Two patterns that a key swaps, as a button does there."""
    if len(element.Pattern) != 2:
        element.say(f"a toggle is of 2 patterns, and this has {len(element.Pattern)}; left out")
        return None
    layers: list[AnyPattern] = []
    for leaf, name, levels in zip(
        element.Pattern, ("first", "second"), ((1.0, 0.0), (0.0, 1.0)), strict=True
    ):
        part = pattern_of(leaf)
        factor = element.context.signal(name, Switch(title="button", levels=levels))
        if part is not None and part.factor:
            part = Group(operation="maximum", parts=(part,))
        layers += [] if part is None else [replace(part, factor=factor)]
    return Group(operation="maximum", parts=tuple(layers)) if layers else None


@makes(PATTERNS, "Image")
def _image(element: Element) -> AnyPattern | None:
    """A picture as the mask of a texture."""
    leaf, mask = element.Pattern, element.mask
    if not leaf.there:
        element.say("it has no texture, and OpenLatero ends at it; left out")
        return None
    texture = pattern_of(leaf)
    if texture is None:
        element.say("there is nothing of its texture to show; left out")
        return None
    kind = leaf.attribute("type")
    if kind != "Texture":
        element.say(f"it is the mask of a {kind}, as the file says; OpenLatero does not show it")
    image = _masked(mask)
    if image is None:
        return None
    if not image.nearest:
        mask.say("between pixels it is bilinear here, and the nearest pixel counts there")
    return replace(image, texture=None if texture == Uniform() else texture)


@makes(PATTERNS, "Audio")
def _audio(element: Element) -> AnyPattern | None:
    """Masks that are not felt, each with the sound of those that are in it."""
    found: list[AnyPattern] = []
    for sound in element.sound:
        name, folder = sound.audiofile.text, element.context.folder
        try:
            if not name:
                raise InputError("its sound is not named")
            read_sound(folder / name)
        except InputError as error:
            sound.say(f"{_in(folder, error)}; left out")
            continue
        image = _masked(sound.mask)
        if image is not None:
            found.append(replace(image, amplitude=0.0, sound=name, title=Path(name).stem))
    return Group(operation="maximum", parts=tuple(found)) if found else None


def _masked(mask: Element) -> Image | None:
    """Picture of a mask where it is; None if there is none."""
    file, context = mask.imgfile, mask.context
    name = _found(file)
    channel = "alpha" if file.attribute("type") == "alpha" else "gray"
    if not name:
        mask.say("its picture is not named; left out")
        return None
    sizes: list[tuple[int, int]] = []

    def seen(columns: int, rows: int, _: object) -> tuple[int, int]:
        sizes.append((columns, rows))
        return 1, 1

    try:
        intensities_of(context.folder / name, channel, seen)
    except (InputError, OSError, ValueError) as error:
        file.say(f"its picture is left out: {_in(context.folder, error)}")
        return None
    columns, rows = sizes[0]
    # Usually the largest size that fits on the surface in the picture's shape.
    high = min(SURFACE_MM[1], SURFACE_MM[0] * rows / columns)
    fitting = (high * columns / rows, high)
    whole = fitting if mask.reference_maximized else SURFACE_MM
    width, height = map(_extent_mm, (mask.width, mask.height), fitting, whole)
    left, top = (SURFACE_MM[0] - width) / 2, (SURFACE_MM[1] - height) / 2
    if mask.position.there and mask.position.text != "centered":
        left, top = place(mask.position, (left, top))
    blur = 2.0 * math.sqrt(width / columns * height / rows) if mask.blur else 0.0
    if mask.blur and not context.as_shown:
        mask.say("its blur is of 2 pixels of the picture, as mm here, and does not end at 4 pixels")
    return Image(
        **mask.here,
        file=name,
        # To the nanometre, since people read it.
        place_mm=(round(left, 6), round(top, 6)),
        width_mm=round(width, 6),
        height_mm=round(height, 6),
        channel=channel,
        blur_mm=round(blur, 6),
        nearest=context.as_shown,
    )


def _found(file: Element) -> str:
    """Name of a picture as it is seen from the file."""
    name, folder = file.text, file.context.folder
    beside = name.rpartition("/")[2]
    # OpenLatero itself writes "/mask.png" for a picture that stands beside the scene.
    if name == f"/{beside}" and not Path(name).is_file() and (folder / beside).is_file():
        file.say(f"{name} is not there, and {beside} beside this file is taken")
        return beside
    return name


def _extent_mm(element: Element, fitting: float, whole: float) -> float:
    """Width or height that an element tells of, in mm or as a share of the whole."""
    if not element.there:
        return fitting
    if element.attribute("units") != "%":
        return number(element, fitting, "mm", _LEAST_SIZE_MM)
    return whole * number(element, 1.0, "share", _LEAST_SIZE_MM / whole, MOST_MM / whole)


def _in(folder: Path, error: Exception) -> str:
    """Message about a file, with its name as it is seen from the scene."""
    return str(error).replace(f"{folder}/", "")


def read_gen(path: str | Path, *, as_shown: bool = False) -> FoundScene:
    """Read a file of OpenLatero's, a scene or a texture.

    Parameters
    ----------
    path
        Path of the file.
    as_shown
        Whether the scene is to be as OpenLatero shows it, where that is not what the file says.

    Returns
    -------
    FoundScene
        The scene, lines of its elements, and what was ignored or is shown differently. Whatever
        cannot be shown is left out.

    Raises
    ------
    InputError
        If the file cannot be read, or is none of OpenLatero's.
    """
    path = Path(path)
    context = Context(path.parent, as_shown)
    root = read_root(read_bytes(path, MOST_BYTES), str(path), context)
    part = root.Generator.Pattern if root.Generator.there else root.Pattern
    if root.Generator.there and not part.there:
        root.Generator.say("it holds no Pattern, so the scene is empty")
    elif not part.there:
        raise InputError(
            f"{path} holds no Generator and no Pattern; give a scene or texture of OpenLatero's"
        )
    shown = pattern_of(part) if part.there else None
    operation: Operation = "maximum"
    elements = () if shown is None else (shown,)
    if isinstance(shown, Group) and (
        (shown.by, shown.factor, shown.amplitude, shown.inverted, shown.vibration)
        == (None, "", 1.0, False, None)
    ):  # which is the scene itself
        operation, elements = shown.operation, shown.parts
    scene = Scene(
        canvas=Canvas(width_mm=SURFACE_MM[0], height_mm=SURFACE_MM[1]),
        title="".join(c for c in path.stem if c.isprintable()),
        operation=operation,
        elements=elements,
        signals=context.signals,
    )
    placed: list[tuple[Steps, AnyPattern]] = [
        (("elements", number), element) for number, element in enumerate(elements)
    ]
    return FoundScene(scene, dict(_lines(placed, context)), context.remarks.listed())


def _lines(
    placed: Iterable[tuple[Steps, AnyPattern]], context: Context
) -> Iterator[tuple[Steps, int]]:
    """Lines of patterns, and of those in them."""
    for steps, part in placed:
        if id(part) in context.made:
            yield steps, context.made[id(part)][1]
        inner = (((*steps, *more), child) for more, child in placed_children(part))
        yield from _lines(inner, context)
