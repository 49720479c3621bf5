"""Tactile pictures: loaded, told, checked, and drawn as maps; and the source's figures as plots.

`loading` reads a picture with all that it needs, `composing` compiles it, `index` tells what is
under the finger, `checking` advises its author. `maps` draws pictures, `series` has the numbers of
plots and `draw` draws them. `figurefiles`, `draw` and `drawings` load matplotlib.
"""

from vbraille.caching import keep_fonts

keep_fonts()
