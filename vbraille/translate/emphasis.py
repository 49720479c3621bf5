"""Emphasis as braille tables have it: a class of a table for each kind of mark."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.translate.source import MarkKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from vbraille.translate.source import Mark

# Names that tables give the classes. Few tables have the last two.
CLASSES = {
    MarkKind.ITALIC: "italic",
    MarkKind.BOLD: "bold",
    MarkKind.UNDERLINE: "underline",
    MarkKind.SUPERSCRIPT: "super",
    MarkKind.SUBSCRIPT: "sub",
}


def typeforms(
    marks: Iterable[Mark], places: NDArray[np.int64], form_of: Callable[[str], int]
) -> NDArray[np.uint16] | None:
    """Emphasis of each character, as liblouis takes it; None if none is emphasised.

    Parameters
    ----------
    marks
        Marks of the text; those that are no emphasis are left out.
    places : int64[n]
        Place of each character in the source, never decreasing.
    form_of
        Function that gives the bit that a table has for a class; 0 if it has no such class.

    Returns
    -------
    uint16[n] or None
        The bits of all classes that each character is in.
    """
    forms = None
    for mark in marks:
        name = CLASSES.get(mark.kind)
        bit = 0 if name is None else form_of(name)
        if not bit:
            continue
        start, stop = np.searchsorted(places, (mark.start, mark.end)).tolist()
        if start < stop:
            if forms is None:
                forms = np.zeros(places.size, np.uint16)
            forms[start:stop] |= bit
    return forms
