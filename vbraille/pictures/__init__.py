"""The figures of Lévesque 2009, as numbers and as pictures.

`series` computes a `FigureTable` of numbers for each picture, `draw`
makes a figure of it. `charts` says what charts of results hold, and
`drawcharts` draws them. `scenes` makes deflection maps of tactile pictures, `drawings` drawings of
them, `blending` plots of their signals. `figurefiles`, `draw`, `drawcharts`, `drawings` and
`blending` import matplotlib, and so are not imported here.
"""

from vbraille.caching import keep_fonts
from vbraille.pictures.series import (
    FigureTable,
    mapping,
    page,
    profile,
    strain,
    wave,
    write_csv,
)

keep_fonts()

__all__ = [
    "FigureTable",
    "mapping",
    "page",
    "profile",
    "strain",
    "wave",
    "write_csv",
]
