"""Files that elements of scenes come from, and how a message names a place in each."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NoReturn

from vbraille.errors import InputError
from vbraille.scene.naming import about

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from vbraille.scene.opened import FoundScene
    from vbraille.scene.walking import Steps
    from vbraille.toml.tomlfile import TomlFile


class TomlOrigin:
    """A scene file in TOML.

    Parameters
    ----------
    file
        The file.
    """

    def __init__(self, file: TomlFile) -> None:
        self._file = file

    @property
    def where(self) -> str:
        """Name of the file."""
        return self._file.where

    @cached_property
    def _lines(self) -> dict[Steps, int]:
        return self._file.lines()

    def place(self, steps: Steps) -> str:
        """Name of the file, and the line of a place in it."""
        return _place(self.where, self._lines, steps)

    def fail(self, steps: Steps, problem: str) -> NoReturn:
        """Refuse the file for a problem at a place in it.

        Raises
        ------
        InputError
            In any case.
        """
        self._file.fail(steps, problem)


class ForeignOrigin:
    """A file of another format, which was read into a scene.

    Parameters
    ----------
    path
        The file.
    found
        What was read.
    """

    def __init__(self, path: Path, found: FoundScene) -> None:
        self.where, self._found = str(path), found

    def place(self, steps: Steps) -> str:
        """Name of the file, and the line of a place if it is known."""
        return _place(self.where, self._found.lines, steps)

    def fail(self, steps: Steps, problem: str) -> NoReturn:
        """Refuse the file for a problem at a place in the scene that it holds.

        Raises
        ------
        InputError
            In any case.
        """
        raise InputError(f"{self.place(steps)}: {about(steps, problem)}")


def _place(where: str, lines: Mapping[Steps, int], steps: Steps) -> str:
    """Name of a file, and the line of the nearest thing around a place that has one."""
    for depth in range(len(steps), 0, -1):
        if steps[:depth] in lines:
            return f"{where} line {lines[steps[:depth]]}"
    return where
