"""A scene: a canvas with a title, and the elements of a tactile picture on it."""

from __future__ import annotations

from typing import Annotated

from vbraille.scene.measures import MOST_MM, Measured, limits
from vbraille.scene.patterns import AnyPattern, Operation, Pattern
from vbraille.scene.signals import AnySignal
from vbraille.toml import Table

Side = Annotated[float, limits(1.0, MOST_MM, " mm")]


class Canvas(Measured, frozen=True, kw_only=True):
    """The surface that a scene stands on; its origin is the top left, x right, y down.

    Parameters
    ----------
    width_mm, height_mm
        Size of the canvas, 1 to 10,000 mm.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    width_mm: Side
    height_mm: Side


class Scene(Table, frozen=True, kw_only=True):
    """A tactile picture.

    Parameters
    ----------
    canvas
        Surface that it stands on.
    title, description
        What it shows, in a word and in sentences.
    language
        Language of its titles and labels, or a table of liblouis.
    operation
        How its elements are put together: "overwrite", by which each hides what it stands on, as
        in drawings, or one of the others that a group has.
    signals
        Numbers by name, by which patterns answer to the hand, to keys and to time.
    textures
        Patterns by name, for `Use`.
    elements
        The elements in order, the last on top.

    Raises
    ------
    ValueError
        If the canvas or an element is something else.
    """

    canvas: Canvas
    title: str = ""
    description: str = ""
    language: str = "en"
    operation: Operation = "overwrite"
    signals: dict[str, AnySignal] = {}  # noqa: RUF012 - msgspec copies an empty default
    textures: dict[str, AnyPattern] = {}  # noqa: RUF012 - msgspec copies an empty default
    elements: tuple[AnyPattern, ...] = ()

    def __post_init__(self) -> None:
        # Files are read by these types; a program may give anything.
        if not isinstance(self.canvas, Canvas):
            raise ValueError(f"canvas is {self.canvas!r:.40}; it must be a Canvas")
        if not isinstance(self.elements, tuple | list):
            raise ValueError(f"elements are {self.elements!r:.40}; they must be patterns, in order")
        for element in self.elements:
            if not isinstance(element, Pattern):
                raise ValueError(f"an element is {element!r:.40}; it must be a pattern")
