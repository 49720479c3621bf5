"""A page of braille with a figure in it: both are one picture."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from vbraille.errors import InputError
from vbraille.render.labels import Assets, Written
from vbraille.scene.geometry import Box, bounds
from vbraille.scene.patterns import Fill, Group, Image, Label, Polygon, Uniform
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import renamed
from vbraille.scene.traversal import each, moved, with_signals

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.render.braille.style import BrailleStyle
    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.signals import AnySignal

PAGE = "page"  # id of the label that has the text of the page
FIGURE = "figure"  # id of the group that the figure is
# What a figure shows beyond its rectangle is cut off over this distance.
_EDGE_MM = 1.0


class FigureAt(NamedTuple):
    """A figure, the place of its canvas's top left corner on a page, and what it takes along."""

    figure: Scene
    place_mm: Point
    assets: Assets


def page_with_figures(
    lines: Sequence[NDArray[np.uint8]],
    style: BrailleStyle,
    figures: Sequence[FigureAt],
) -> tuple[Scene, Assets]:
    """Make one picture of a page of braille and the figures that stand on it.

    The page's canvas is that of `BrailleStyle.render_page`: line n takes y from n to n + 1 line
    pitches, with its dots around the middle, and each actuator shows what lies under it. A figure
    hides what it stands on as far as its elements do, so lines leave room for it; nothing of it is
    felt beyond the rectangle of its canvas.

    Parameters
    ----------
    lines : sequence of uint8[cells]
        Dot masks of each line of the page; those that a figure stands on are empty, or short.
    style
        Distances, profile and tuning of the dots.
    figures
        Figures with their places, one at least.

    Returns
    -------
    Scene, Assets
        The picture, with title and description of its first figure.

    Raises
    ------
    InputError
        If the page has no cells, or a figure would be farther than 10 m from the page's corner.
    """
    cells = max((len(masks) for masks in lines), default=0)
    if cells == 0:
        raise InputError("a page without cells has no figure in it; show the figure alone")
    geometry = style.geometry
    down_mm = geometry.line_pitch_mm / 2 - geometry.row_spacing_mm - geometry.dot_width_mm / 2
    text = Label(id=PAGE, text=PAGE, place_mm=(0.0, down_mm))
    width_mm = geometry.extent_mm(cells)
    height_mm = len(lines) * geometry.line_pitch_mm
    elements: tuple[AnyPattern, ...] = (text,)
    bitmaps: dict[Image, Bitmap] = {}
    written: dict[Label, Written] = {text: Written(tuple(lines), style)}
    signals: dict[str, AnySignal] = {}
    for number, (figure, place_mm, assets) in enumerate(figures):
        names = {name: f"{number} {name}" for name in figure.signals}
        signals |= {names[name]: renamed(one, names) for name, one in figure.signals.items()}
        try:
            parts = tuple(
                with_signals(moved(element, place_mm), names) for element in figure.elements
            )
        except ValueError as error:
            raise InputError(f"the figure cannot stand there: {error}") from None
        given = _moved_assets(figure.elements, parts, assets)
        if parts:
            elements += (_figure(figure, parts, place_mm, given),)
        bitmaps |= given.bitmaps
        written |= given.written
        width_mm = max(width_mm, place_mm[0] + figure.canvas.width_mm)
        height_mm = max(height_mm, place_mm[1] + figure.canvas.height_mm)
    first = figures[0].figure
    scene = Scene(
        canvas=Canvas(width_mm=width_mm, height_mm=height_mm),
        title=first.title,
        description=first.description,
        language=first.language,
        elements=elements,
        signals=signals,
    )
    return scene, Assets(bitmaps, written)


def _figure(figure: Scene, parts: tuple[AnyPattern, ...], place_mm: Point, assets: Assets) -> Group:
    """All of a figure as one pattern, which is at rest beyond the rectangle of its canvas."""
    left, top = place_mm
    canvas = Box(left, top, left + figure.canvas.width_mm, top + figure.canvas.height_mm)
    whole = Group(operation=figure.operation, parts=parts)
    shown: tuple[AnyPattern, ...] = (whole,)
    reach = bounds(whole, assets.boxes())
    if reach is None or canvas.joined(reach) != canvas:
        right, bottom = canvas.right, canvas.bottom
        corners = ((left, top), (right, top), (right, bottom), (left, bottom))
        fill = Fill(texture=Uniform(), fade_mm=_EDGE_MM)
        shown = (whole, Polygon(vertices_mm=corners, fill=fill))
    return Group(
        id=FIGURE,
        title=figure.title,
        description=figure.description,
        operation="multiply",
        parts=shown,
    )


def _moved_assets(
    before: tuple[AnyPattern, ...], after: tuple[AnyPattern, ...], assets: Assets
) -> Assets:
    """Find the bitmaps and cells of patterns that were moved."""
    bitmaps: dict[Image, Bitmap] = {}
    written: dict[Label, Written] = {}
    for old, new in zip(each(*before), each(*after), strict=True):
        if isinstance(old, Label) and isinstance(new, Label):
            written[new] = assets.written[old]
        elif isinstance(old, Image) and isinstance(new, Image):
            bitmap = assets.bitmaps[old]
            right_mm = new.place_mm[0] - old.place_mm[0]
            down_mm = new.place_mm[1] - old.place_mm[1]
            x_mm, y_mm = bitmap.place_mm
            bitmaps[new] = replace(bitmap, place_mm=(x_mm + right_mm, y_mm + down_mm))
    return Assets(bitmaps, written)
