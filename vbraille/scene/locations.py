"""A scene that was read: the values, the file and line of each element, and what was said."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, NoReturn

from vbraille.errors import InputError
from vbraille.toml import TomlFile

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from vbraille.scene.scene import Scene
    from vbraille.scene.traversal import Steps


@dataclass(frozen=True, slots=True)
class FoundScene:
    """Scene that a reader of a format of others gives back.

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


class ForeignFile(NamedTuple):
    """The name of a file of another format, and the lines of what was found in it."""

    where: str
    lines: Mapping[Steps, int]

    def fail(self, steps: Steps, problem: str) -> NoReturn:
        """Refuse the file for a problem at a place in the scene that it holds.

        Raises
        ------
        InputError
            In any case.
        """
        raise InputError(f"{_place(self, steps)}: {about(steps, problem)}")


SceneSource = ForeignFile | TomlFile


def _place(file: SceneSource, steps: Steps) -> str:
    """Name of a file, and the line of the nearest thing around a place that has one."""
    for depth in range(len(steps), 0, -1):
        if steps[:depth] in file.lines:
            return f"{file.where} line {file.lines[steps[:depth]]}"
    return file.where


@dataclass(frozen=True, slots=True)
class Locations:
    """Places where each element and named texture of a scene is written.

    Parameters
    ----------
    places
        Files, and places in them, by places of the scene.
    """

    places: dict[Steps, tuple[SceneSource, Steps]] = field(default_factory=dict)

    def of(self, steps: Steps) -> tuple[SceneSource, Steps] | None:
        """File that a place of the scene comes from, and the place in that file."""
        for depth in range(len(steps), 0, -1):
            if steps[:depth] in self.places:
                file, there = self.places[steps[:depth]]
                return file, (*there, *steps[depth:])
        return None

    def place(self, steps: Steps) -> str:
        """File and line of a place of the scene, or words for it if it comes from no file."""
        found = self.of(steps)
        return said(steps) if found is None else _place(*found)

    def fail(self, steps: Steps, problem: str) -> NoReturn:
        """Refuse the scene for a problem at a place in it, with the file and the line.

        Raises
        ------
        InputError
            In any case.
        """
        found = self.of(steps)
        if found is None:
            raise InputError(about(steps, problem))
        file, there = found
        file.fail(there, problem)


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
        The same as it is shown; see `vbraille.scene.resolving`. It has the same elements in the
        same order.
    locations
        Where its elements are written.
    warnings
        What was ignored, or means something else here, each in one sentence.
    """

    path: Path
    folder: Path
    written: Scene
    resolved: Scene
    locations: Locations
    warnings: tuple[str, ...] = ()

    @property
    def places(self) -> tuple[str, ...]:
        """File and line of each element."""
        return tuple(self.place(number) for number in range(len(self.written.elements)))

    def place(self, number: int) -> str:
        """File and line of an element by its number from 0, such as "house.scene line 12"."""
        return self.locations.place(("elements", number))


def said(steps: Steps) -> str:
    """Words for a place in a scene, which keys and indices lead to.

    >>> said(("elements", 3, "fill", "texture"))
    'elements, number 4 fill texture'
    """
    words = (f", number {step + 1}" if isinstance(step, int) else f" {step}" for step in steps)
    return "".join(words).strip()


def about(steps: Steps, problem: str) -> str:
    """Sentence about a place in a scene; the problem begins with a colon or a verb.

    >>> about(("elements", 0), "has no place")
    'elements, number 1 has no place'
    """
    return f"{said(steps)}{problem}" if problem.startswith(":") else f"{said(steps)} {problem}"
