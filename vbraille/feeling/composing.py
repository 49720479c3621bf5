"""Programs of scenes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from vbraille.errors import InputError
from vbraille.render import work
from vbraille.render.program import Program
from vbraille.render.scene.compiling import SceneCompiler
from vbraille.render.scene.frequencies import highest_hz
from vbraille.scene.patterns import Group
from vbraille.scene.scene import Scene

if TYPE_CHECKING:
    from vbraille.display import Display
    from vbraille.feeling.loading import LoadedScene

_COMPILED: Final = ("multiply", "add", "maximum", "overwrite")  # others are a group's


class Composer:
    """Makes programs of scenes that follow each other, as somebody works on a picture.

    What has not changed from one to the next is not compiled again.

    Parameters
    ----------
    display
        Display that the scenes are felt on.
    rate_hz
        Frames a second.
    """

    def __init__(self, display: Display, *, rate_hz: float = 1000.0) -> None:
        self._compiler = SceneCompiler(display, rate_hz=rate_hz)
        self._rate_hz = rate_hz

    def compose(
        self, loaded: LoadedScene, *, contrast: float = 1.0, own_y_mm: float | None = None
    ) -> Program:
        """Compile a scene.

        Parameters
        ----------
        loaded
            The scene.
        contrast
            Factor of all its deflections, from 0 to 1.
        own_y_mm
            Height of the canvas that an array is at whose carriage measures no y; None for the
            middle.

        Raises
        ------
        InputError
            If the scene cannot be shown at this rate, or stands too deep in itself.
        """
        scene = loaded.scene
        whole = contrast == 1.0 and scene.operation in _COMPILED
        if not whole and scene.elements:
            group = Group(operation=scene.operation, parts=scene.elements, amplitude=contrast)
            scene = Scene(canvas=scene.canvas, operation="maximum", elements=(group,))
        try:
            program = self._compiler.compile(scene, loaded.assets)
        except ValueError as error:
            self._refuse_too_fast(loaded)
            raise InputError(f"{loaded.opened.path}: {error}") from None
        height_mm = scene.canvas.height_mm / 2 if own_y_mm is None else own_y_mm
        program.numbers[work.OWN_Y] = height_mm
        return program

    def _refuse_too_fast(self, loaded: LoadedScene) -> None:
        """Say which element moves too fast for the rate, and where it is written."""
        for number, element in enumerate(loaded.scene.elements):
            try:
                highest_hz(element, number + 1, self._rate_hz)
            except ValueError as error:
                raise InputError(f"{loaded.opened.place(number)}: {error}") from None


def compose(loaded: LoadedScene, display: Display, *, rate_hz: float = 1000.0) -> Program:
    """Compile one scene for a display; see `Composer.compose`."""
    return Composer(display, rate_hz=rate_hz).compose(loaded)


def at_height(program: Program, y_mm: float) -> Program:
    """Make the same program for an array that is at another height where it measures none."""
    numbers = program.numbers.copy()
    numbers[work.OWN_Y] = y_mm
    return Program(numbers, program.table)
