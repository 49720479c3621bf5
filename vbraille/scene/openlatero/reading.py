"""A file of OpenLatero's as a scene, with what is said about it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.scene.filebytes import read_bytes
from vbraille.scene.locations import FoundScene
from vbraille.scene.openlatero import groups, images, shapes, textures
from vbraille.scene.openlatero.context import SURFACE_MM, GenContext, Kinds
from vbraille.scene.openlatero.elements import MOST_BYTES, Remarks, read_tree
from vbraille.scene.patterns import Group
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.traversal import placed_children

if TYPE_CHECKING:
    from vbraille.scene.openlatero.elements import GenElement
    from vbraille.scene.patterns import AnyPattern, Operation
    from vbraille.scene.traversal import Steps

PATTERNS = Kinds(shapes.ROWS | images.ROWS | groups.ROWS)
TEXTURES = textures.ROWS


def read_gen(path: str | Path, *, as_shown: bool = False) -> FoundScene:
    """Read a file of OpenLatero's, a scene or a texture.

    Parameters
    ----------
    path
        Path of the file.
    as_shown
        Whether the scene is to be as OpenLatero shows it, where that is not what the file says:
        vibration of what is down, and changes of tiles.

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
    remarks = Remarks()
    root = read_tree(read_bytes(path, MOST_BYTES), str(path), remarks)
    context = GenContext(path.parent, as_shown, PATTERNS, TEXTURES)
    made = _made(root, context, path)
    for element in root.unasked():
        what = f"{element.path or element.name} {element.attribute('type')}".strip()
        element.say(f"{what} is not known here, and ignored")
    operation, elements = _spread(made)
    scene = Scene(
        canvas=Canvas(width_mm=SURFACE_MM[0], height_mm=SURFACE_MM[1]),
        title=_title(path),
        operation=operation,
        elements=elements,
        signals=context.signals,
    )
    return FoundScene(scene, _lines(scene, context), remarks.listed())


def _made(root: GenElement, context: GenContext, path: Path) -> AnyPattern | None:
    """Pattern that a file holds: the group of a scene, or a texture."""
    generator = root.one("Generator")
    if generator is None:
        pattern = root.one("Pattern")
        if pattern is None:
            raise InputError(
                f"{path} holds no Generator and no Pattern; give a scene or texture of OpenLatero's"
            )
        return context.pattern(pattern)
    if generator.attribute("type") != "Canvas":
        generator.say("its type is not Canvas, but it is read as one")
    group = generator.one("Pattern")
    if group is None:
        generator.say("it holds no Pattern, so the scene is empty")
        return None
    if group.attribute("type") == "Group":
        return context.pattern(group)
    if context.as_shown:
        group.say("this is taken as a Group, as OpenLatero does")
        return groups.joined(
            group, [context.pattern(part) for part in group.every("Pattern")], context
        )
    group.say("this is shown, although OpenLatero takes it as a Group")
    return context.pattern(group)


def _spread(made: AnyPattern | None) -> tuple[Operation, tuple[AnyPattern, ...]]:
    """Parts of what a file holds, and how they are put together, as a scene has them."""
    if made is None:
        return "maximum", ()
    if not isinstance(made, Group) or made.by is not None or made.weights is not None:
        return "maximum", (made,)
    if made.amplitude != 1.0 or made.inverted or made.vibration is not None or made.factor:
        return "maximum", (made,)
    return made.operation, made.parts


def _title(path: Path) -> str:
    """Title for a file: its name, as far as it can be said."""
    return "".join(c for c in path.stem if c.isprintable())


def _lines(scene: Scene, context: GenContext) -> dict[Steps, int]:
    """Lines of the elements of a scene, and of the patterns in them."""
    lines: dict[Steps, int] = {}
    left: list[tuple[Steps, AnyPattern]] = [
        (("elements", number), element) for number, element in enumerate(scene.elements)
    ]
    while left:
        steps, pattern = left.pop()
        element = context.element_of(pattern)
        if element is not None:
            lines[steps] = element.line
        left += [((*steps, *inner), part) for inner, part in placed_children(pattern)]
    return lines
