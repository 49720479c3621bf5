"""Files of scenes: opened, whatever form they have."""

from __future__ import annotations

from pathlib import Path

from vbraille.scene.including import gather
from vbraille.scene.opened import OpenedScene
from vbraille.scene.resolving import resolve


def open_scene(path: str | Path) -> OpenedScene:
    """Open a scene: a scene file in TOML, a drawing in SVG, or a file of OpenLatero's.

    Parameters
    ----------
    path
        Path of the file. Its suffix says what it is, or else its beginning.

    Raises
    ------
    InputError
        If it cannot be read, or is not right; one sentence says where.
    """
    path = Path(path)
    gathered = gather(path)
    scene = gathered.scene(path)
    return OpenedScene(
        path=path,
        folder=path.parent,
        written=scene,
        resolved=resolve(scene, path.parent, gathered.origins),
        origins=gathered.origins,
        warnings=tuple(gathered.warnings),
    )
