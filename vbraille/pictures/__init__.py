"""The figures of Lévesque 2009, as numbers and as pictures.

`series`, `surface` and `resolving` compute a `FigureTable` of numbers for each picture, `draw`
makes a figure of it. `charts` says what charts of results hold, and
`drawcharts` draws them. `scenes` makes deflection maps of tactile pictures, `drawings` drawings of
them. `figurefiles`, `draw`, `drawcharts`, `drawings` and `costs` import matplotlib, and so are not
imported here.
"""

from vbraille.caching import keep_fonts
from vbraille.pictures.resolving import resolution, resolution_words
from vbraille.pictures.series import mapping, profile, strain, wave
from vbraille.pictures.surface import page
from vbraille.pictures.table import FigureTable, write_csv

keep_fonts()

__all__ = [
    "FigureTable",
    "mapping",
    "page",
    "profile",
    "resolution",
    "resolution_words",
    "strain",
    "wave",
    "write_csv",
]
