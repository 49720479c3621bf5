"""Files of scenes: opened, whatever form they have."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from vbraille.errors import InputError
from vbraille.scene.including import gather
from vbraille.scene.opened import FoundScene, OpenedScene
from vbraille.scene.resolving import resolve, said

if TYPE_CHECKING:
    from vbraille.scene.walking import Steps

_HEAD_BYTES = 4096
_SUFFIXES = {".svg": "svg", ".svgz": "svg", ".gen": "gen", ".tx": "gen"}


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
    form = _form(path)
    if form == "toml":
        gathered = gather(path)
        scene = gathered.scene(path)
        resolved = resolve(scene, path.parent, gathered.fail)
        return OpenedScene(path, path.parent, scene, resolved, gathered.places())
    found = _read_other(path, form)

    def fail(steps: Steps, problem: str) -> NoReturn:
        raise InputError(f"{_place(path, found, steps)}: {said(steps)} {problem}")

    return OpenedScene(
        path,
        path.parent,
        found.scene,
        resolve(found.scene, path.parent, fail),
        tuple(_place(path, found, ("elements", n)) for n in range(len(found.scene.elements))),
        tuple(f"{path}{'' if w.startswith('line ') else ':'} {w}" for w in found.warnings),
    )


def _read_other(path: Path, form: str) -> FoundScene:
    """Read a file of a format of others."""
    if form == "svg":
        from vbraille.scene.svgscene import read_svg  # loads the library for SVG

        return read_svg(path)
    from vbraille.scene.openlatero import read_gen  # loads the library for XML

    return read_gen(path)


def _form(path: Path) -> str:
    """Form of a file, by its suffix or its beginning."""
    form = _SUFFIXES.get(path.suffix.lower())
    if form is not None:
        return form
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD_BYTES)
    except (OSError, ValueError):
        return "toml"  # whose reader says what is wrong
    if not head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<"):
        return "toml"
    return "svg" if b"<svg" in head or b":svg" in head else "gen"


def _place(path: Path, found: FoundScene, steps: Steps) -> str:
    """File, and line if it is known, of a place in a scene."""
    for depth in range(len(steps), 0, -1):
        if steps[:depth] in found.lines:
            return f"{path} line {found.lines[steps[:depth]]}"
    return str(path)
