"""Braille in a picture: labels as cells, by the tables and the lines that books have.

A label's text is translated as a paragraph of a book is; each of its lines is a paragraph of its
own, and is broken where it is wider than the label may be.
"""

from __future__ import annotations

import itertools
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import InputError
from vbraille.layout import wrap
from vbraille.render.labels import Written, corners_mm
from vbraille.scene.patterns import Label, Tile
from vbraille.scene.traversal import each
from vbraille.translate import Block, BrailleTable, find_table
from vbraille.wording import count, printable

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from vbraille.render.braille.style import BrailleStyle
    from vbraille.scene.scene import Scene

_MOST_SAID = 24  # characters of a label's text in a sentence
_TOUCHING_MM = 1e-6
# Labels of a picture are compared with each other; a file may have a million.
_MOST_COMPARED = 400


def write_labels(
    scene: Scene, style: BrailleStyle, places: Sequence[str] = ()
) -> dict[Label, Written]:
    """Translate the labels of a scene, wherever in it they stand, and break their lines.

    Parameters
    ----------
    scene
        A resolved scene.
    style
        Distances, profile and tuning of their dots.
    places
        Words for where each element of the scene is written, such as "house.scene line 12";
        without them sentences number the elements.

    Raises
    ------
    InputError
        If there is no such language or table, a label has nothing that braille can show, or is
        narrower than a cell; the sentence names the element.
    """
    written: dict[Label, Written] = {}
    for label, name in _labels(scene, places):
        if label in written:
            continue
        try:
            written[label] = write_label(label, style, scene.language)
        except InputError as error:
            raise InputError(f"{name}: {error}") from None
    return written


def write_label(label: Label, style: BrailleStyle, language: str = "en") -> Written:
    """Translate a label and break its lines.

    Parameters
    ----------
    label
        The label.
    style
        Distances, profile and tuning of its dots.
    language
        Language or table where the label has none of its own.

    Raises
    ------
    InputError
        If there is no such language or table, the label has nothing that braille can show, or is
        narrower than a cell.
    """
    table = _table(label.table or language)
    width = _cells_across(label, style)
    lines: list[NDArray[np.uint8]] = []
    for text in label.text.splitlines():
        paragraph = Block(" ".join(text.split()))
        cells = table.translate(paragraph.text)
        lines += [line.masks for line in wrap(paragraph, cells, width or max(len(cells), 1))]
    while lines and not lines[-1].any():
        lines.pop()
    if not lines:
        raise InputError("text holds nothing that braille can show; write something else")
    return Written(tuple(lines), style)


def label_warnings(
    scene: Scene, written: Mapping[Label, Written], places: Sequence[str] = ()
) -> list[str]:
    """Say which labels cannot be read as they stand.

    Parameters
    ----------
    scene
        A resolved scene.
    written
        The cells of its labels, from `write_labels`.
    places
        Words for where each element is written; see `write_labels`.

    Returns
    -------
    list of str
        One sentence for each label that reaches beyond the canvas, or has characters that its
        table does not know, and for each two of which one stands on the other.
    """
    said: list[str] = []
    standing: list[tuple[str, NDArray[np.float64]]] = []
    tiles = (tile for tile in each(*scene.elements) if isinstance(tile, Tile))
    tiled = {part for part in each(*tiles) if isinstance(part, Label)}
    for label, name in _labels(scene, places):
        # Characters that were written as a mark.
        table = _table(label.table or scene.language)
        unknown = {sign for line in label.text.splitlines() for sign in table.unknown(line)}
        if unknown:
            said.append(
                f"{name} has {count(len(unknown), 'character')} that its table does not know: "
                f"{printable(' '.join(sorted(unknown)))}; give it another table"
            )
        if label in tiled:
            continue  # it has no one place
        corners = corners_mm(label, written[label])
        right_mm, bottom_mm = scene.canvas.width_mm, scene.canvas.height_mm
        far_mm = max(max(-x, x - right_mm, -y, y - bottom_mm) for x, y in corners)
        if far_mm > _TOUCHING_MM:
            said.append(
                f"{name} reaches {far_mm:.1f} mm beyond the canvas; move it, or make it narrower"
            )
        standing.append((name, np.array(corners)))
    for (lower, below), (upper, above) in itertools.combinations(standing[:_MOST_COMPARED], 2):
        if not _apart(above, below):
            said.append(f"{upper} stands on {lower}; move one of them")
    return said


def _labels(scene: Scene, places: Sequence[str]) -> Iterator[tuple[Label, str]]:
    """Labels of a scene, in order, each with the words that name it."""
    for number, element in enumerate(scene.elements):
        place = places[number] if number < len(places) else f"elements, number {number + 1}"
        for pattern in each(element):
            if isinstance(pattern, Label):
                yield pattern, f"{place}, label {_said(pattern)}"


def _said(label: Label) -> str:
    """Words for a label: its id, or else its text."""
    text = " ".join(label.id.split() or label.text.split())
    return repr(text if len(text) <= _MOST_SAID else f"{text[: _MOST_SAID - 1]}…")


@cache
def _table(name: str) -> BrailleTable:
    """Table by its own name or by a language; names of tables have a dot in them, or a folder."""
    return BrailleTable(name if {".", "/", ","} & set(name) else find_table(name))


def _cells_across(label: Label, style: BrailleStyle) -> int | None:
    """Number of cells that fit into the width of a label; None if it is one line."""
    if label.width_mm is None:
        return None
    least_mm = style.geometry.extent_mm(1)
    if label.width_mm < least_mm - _TOUCHING_MM:
        raise InputError(
            f"width is {label.width_mm:g} mm; a cell takes {least_mm:g} mm, so make it wider"
        )
    more_mm = label.width_mm - least_mm + _TOUCHING_MM
    return 1 + int(more_mm / style.geometry.cell_pitch_mm)


def _apart(one: NDArray[np.float64], other: NDArray[np.float64]) -> bool:
    """Tell whether a side of one of two rectangles has the other one wholly beyond it."""
    for corners in (one, other):
        for axis in (corners[1] - corners[0], corners[3] - corners[0]):
            ways = sorted((place @ axis for place in (one, other)), key=lambda way: way.min())
            room = _TOUCHING_MM * float(np.hypot(*axis))
            if ways[0].max() <= ways[1].min() + room:
                return True
    return False
