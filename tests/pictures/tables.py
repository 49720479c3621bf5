from dataclasses import replace

from vbraille.braille.cells import Cells
from vbraille.layout import Line
from vbraille.pictures.series import mapping, page, profile, strain, wave
from vbraille.render import STRESS2, VBD, Tuning
from vbraille.translate import Block

NO_TEXT = Block("")


def make_line(braille, number=1, indent=0):
    return Line(NO_TEXT, number - 1, indent, Cells.from_unicode(braille), 0, 0)


def with_style(model, **changes):
    """A model that is read in a style a little different from its own."""
    return replace(model, style=replace(model.style, **changes))


def make_page(lines, model=STRESS2, x_mm=0.0):
    model = with_style(model, tuning=Tuning())
    return page(lines, model, x_mm=x_mm)


TABLES = [
    profile(VBD),
    mapping(STRESS2.style),
    wave(VBD),
    strain(VBD.style.geometry, VBD.style.tuning),
    make_page([make_line("⠵⠁"), make_line("⠃", number=2)], x_mm=3.0),
]
