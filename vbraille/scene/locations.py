"""A scene that was read: the values, the file and line of each element, and what was said."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, NoReturn

from vbraille.errors import InputError
from vbraille.toml import TomlFile

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from vbraille.scene.scene import Scene
    from vbraille.scene.traversal import Steps

_MOST_LINES = 5  # that one remark names


class FoundScene(NamedTuple):
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
    lines: Mapping[Steps, int]
    warnings: tuple[str, ...]


class Remarks:
    """Remarks on a file of another format, with the lines and elements for which they hold."""

    def __init__(self) -> None:
        self._places: dict[str, list[tuple[int, str]]] = defaultdict(list)

    def note(self, remark: str, line: int, name: str) -> None:
        """Keep a remark on an element, by its line and its name."""
        self._places[remark].append((line, name))

    def said(self) -> tuple[str, ...]:
        """All remarks by their first lines, each once.

        >>> remarks = Remarks()
        >>> for line in (9, 4):
        ...     remarks.note("its icon is ignored", line, "Circle")
        >>> remarks.said()
        ('line 4, Circle: its icon is ignored (and line 9)',)
        """
        sentences: list[str] = []
        for remark, places in sorted(self._places.items(), key=lambda one: min(one[1])):
            line, name = min(places)
            others = sorted({other for other, _ in places} - {line})
            more = len(others) - _MOST_LINES
            listed = ", ".join(map(str, others[:_MOST_LINES]))
            rest = f" and {more} more" if more > 0 else ""
            also = f" (and line{'s' if others[1:] else ''} {listed}{rest})" if others else ""
            sentences.append(f"line {line}, {name}: {remark}{also}")
        return tuple(sentences)


class ForeignFile(NamedTuple):
    """The name of a file of another format, and the lines of what was found in it."""

    where: str
    lines: Mapping[Steps, int]


class Locations(dict["Steps", "tuple[ForeignFile | TomlFile, Steps]"]):
    """Files, and places in them, of the elements, textures and signals of a scene."""

    def place(self, steps: Steps) -> str:
        """File and line of a place of the scene, or words for it if it comes from no file."""
        file, there = self._of(steps)
        if file is None:
            return said(steps)
        while there and there not in file.lines:
            there = there[:-1]
        return f"{file.where} line {file.lines[there]}" if there else file.where

    def fail(self, steps: Steps, problem: str) -> NoReturn:
        """Refuse the scene for a problem at a place in it, with the file and the line.

        Raises
        ------
        InputError
            In any case.
        """
        file, there = self._of(steps)
        if isinstance(file, TomlFile):
            file.fail(there, problem)
        about = f"{said(there)}{'' if problem.startswith(':') else ' '}{problem}"
        raise InputError(f"{self.place(steps)}: {about}" if file else about)

    def _of(self, steps: Steps) -> tuple[ForeignFile | TomlFile | None, Steps]:
        """File that a place of the scene comes from, and the place in that file."""
        for depth in range(len(steps), 0, -1):
            if steps[:depth] in self:
                file, there = self[steps[:depth]]
                return file, (*there, *steps[depth:])
        return None, steps


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
        The same as it is shown; see `vbraille.scene.reading`. It has the same elements in the
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
    locations: Locations = field(default_factory=Locations)
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
