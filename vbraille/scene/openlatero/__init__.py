"""OpenLatero's files, scenes (``.gen``) and textures (``.tx``), read leniently as our scenes.

OpenLatero is the open software of the author of the thesis, and its files are the content that
there is. What a file says is told with its line wherever it differs from what is shown here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.files import read_bytes
from vbraille.scene.locations import FoundScene
from vbraille.scene.openlatero.elements import MOST_BYTES, Context, read_root
from vbraille.scene.openlatero.making import SURFACE_MM, pattern_of
from vbraille.scene.patterns import Group
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.traversal import lines_of

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.scene.patterns import AnyPattern, Operation


def read_gen(path: Path, *, as_shown: bool = False) -> FoundScene:
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
    context = Context(path.parent, as_shown)
    root = read_root(read_bytes(path, "scene", MOST_BYTES), str(path), context)
    part = root.Generator.Pattern if root.Generator.there else root.Pattern
    if root.Generator.there and not part.there:
        root.Generator.say("it holds no Pattern, so the scene is empty")
    elif not part.there:
        raise InputError(
            f"{path} holds no Generator and no Pattern; give a scene or texture of OpenLatero's"
        )
    shown = pattern_of(part) if part.there else None
    operation: Operation = "maximum"
    elements: tuple[AnyPattern, ...] = () if shown is None else (shown,)
    if isinstance(shown, Group) and shown.by is None:
        alone = Group(operation=shown.operation, parts=shown.parts)
        if shown == alone:  # it is the scene itself
            operation, elements = shown.operation, shown.parts
    scene = Scene(
        canvas=Canvas(width_mm=SURFACE_MM[0], height_mm=SURFACE_MM[1]),
        title="".join(c for c in path.stem if c.isprintable()),
        operation=operation,
        elements=elements,
        signals=context.signals,
    )
    return FoundScene(scene, lines_of(elements, context.made), context.remarks.said())
