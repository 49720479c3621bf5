"""The form of a scene's file."""

from __future__ import annotations

from vbraille.scene.patterns import AnyPattern, Operation
from vbraille.scene.scene import Canvas
from vbraille.scene.svg.looks import ClassLook
from vbraille.toml.tomlfile import Table


class SceneFile(Table, frozen=True, kw_only=True):
    """A scene as its file has it: a tactile picture, or a bank of textures that others include.

    Parameters
    ----------
    canvas
        Surface that the picture stands on; only a file that others include can be without.
    title, description
        What it shows, in a word and in sentences.
    language
        Language of its titles and labels, or a table of liblouis; "en" if nothing is said.
    operation
        How its elements are put together: "overwrite", by which each hides what it stands on, as
        in drawings, or one of the others that a group has.
    include
        Names of other scenes' files, seen from this one. Their elements stand before its own, and
        their names can be used here.
    classes
        What shapes of included SVG drawings become, by the name of their class, by the label that
        Inkscape gives them, or by their id.
    textures
        Patterns by name, which are shown where something uses them.
    elements
        The elements in order, the last on top.
    """

    canvas: Canvas | None = None
    title: str = ""
    description: str = ""
    language: str = ""
    operation: Operation = "overwrite"
    include: tuple[str, ...] = ()
    classes: dict[str, ClassLook] = {}  # noqa: RUF012 - msgspec copies an empty default
    textures: dict[str, AnyPattern] = {}  # noqa: RUF012 - msgspec copies an empty default
    elements: tuple[AnyPattern, ...] = ()
