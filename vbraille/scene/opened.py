"""What the reading of a scene's file gives: the scene, where its elements stand, what was said."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from vbraille.scene.scene import Scene
    from vbraille.scene.walking import Steps


@dataclass(frozen=True, slots=True)
class FoundScene:
    """What a reader of a format of others gives back.

    Parameters
    ----------
    scene
        The scene; it may have uses and names.
    lines
        Lines of the file, from 1, of the elements: ``("elements", 0)`` is the first element, and
        ``("elements", 0, "parts", 2)`` a part of it.
    warnings
        What was ignored, or means something else here, each in one sentence that begins with
        "line N: " where there is a line.
    """

    scene: Scene
    lines: Mapping[Steps, int] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class OpenedScene:
    """A scene from a file.

    Parameters
    ----------
    path
        The file.
    folder
        Folder that the names of its images are seen from.
    written
        The scene with its uses and names, and with what it includes.
    resolved
        The same as it is shown, of `vbraille.scene.resolving`. It has the same elements in the same
        order.
    places
        Where each element is written: the file's name and line, such as "house.scene line 12".
    warnings
        What was ignored, or means something else here, each in one sentence.
    """

    path: Path
    folder: Path
    written: Scene
    resolved: Scene
    places: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
