"""Programs of scenes, and the frames that they give."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.render import work
from vbraille.render.compiling import compile_scene, highest_hz
from vbraille.render.program import Program
from vbraille.scene.patterns import Group

if TYPE_CHECKING:
    from vbraille.display import Display
    from vbraille.pictures.loading import LoadedScene

_COMPILED: Final = ("multiply", "add", "maximum", "overwrite")  # others are a group's


def compose(
    loaded: LoadedScene,
    display: Display,
    *,
    rate_hz: float = 1000.0,
    contrast: float = 1.0,
    own_y_mm: float | None = None,
) -> Program:
    """Compile a scene for a display.

    Parameters
    ----------
    loaded
        The scene.
    display
        Display that it is felt on.
    rate_hz
        Frames a second.
    contrast
        Factor of all its deflections, from 0 to 1.
    own_y_mm
        Height of the canvas that an array is at whose carriage measures no y; None for the middle.

    Raises
    ------
    InputError
        If the scene cannot be shown at this rate, or stands too deep in itself.
    """
    scene = loaded.scene
    whole = contrast == 1.0 and scene.operation in _COMPILED
    if not whole and scene.elements:
        group = Group(operation=scene.operation, parts=scene.elements, amplitude=contrast)
        scene = replace(scene, operation="maximum", elements=(group,))
    try:
        program = compile_scene(scene, display, loaded.assets, rate_hz=rate_hz)
    except ValueError as error:
        for number, element in enumerate(loaded.scene.elements):
            try:
                highest_hz(element, number + 1, rate_hz)
            except ValueError as too_fast:
                raise InputError(f"{loaded.place(number)}: {too_fast}") from None
        raise InputError(f"{loaded.opened.path}: {error}") from None
    height_mm = scene.canvas.height_mm / 2 if own_y_mm is None else own_y_mm
    program.numbers[work.OWN_Y] = height_mm
    return program


def viewed(
    program: Program, own_y_mm: float, origin_mm: tuple[float, float] = (0.0, 0.0)
) -> Program:
    """Make the same program of a scene for an array that is elsewhere on the canvas.

    Parameters
    ----------
    program
        The program.
    own_y_mm
        Height of an array whose carriage measures no y.
    origin_mm
        Place of the canvas that is under the array where its carriage is at 0, 0.
    """
    numbers = program.numbers.copy()
    numbers[work.OWN_Y] = own_y_mm
    numbers[work.ORIGIN_X], numbers[work.ORIGIN_Y] = origin_mm
    return Program(numbers, program.table)
