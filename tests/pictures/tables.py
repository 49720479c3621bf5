import numpy as np

from vbraille.page import Line
from vbraille.pictures import mapping, page, profile, strain, wave
from vbraille.render import STRESS2, VBD, Tuning
from vbraille.translate.cells import Cells
from vbraille.translate.paragraphs import Paragraph

NO_TEXT = Paragraph(np.zeros(0, np.uint32), np.zeros(0, np.int64), 0, False, frozenset())


def make_line(braille, number=1, indent=0):
    return Line(number, indent, Cells.from_unicode(braille), NO_TEXT, 0, 0)


def make_page(lines, model=STRESS2, **changes):
    settings = {
        "mapping": model.style.mapping,
        "geometry": model.style.geometry,
        "tuning": Tuning(),
        "x_mm": 0.0,
        **changes,
    }
    return page(lines, model=model, **settings)


TABLES = [
    profile(VBD, VBD.style.geometry, VBD.style.tuning),
    mapping(STRESS2.style.geometry, STRESS2.style.tuning),
    wave(VBD, VBD.style.geometry, VBD.style.tuning),
    strain(VBD.style.geometry, VBD.style.tuning),
    make_page([make_line("⠵⠁"), make_line("⠃", number=2)], x_mm=3.0),
]
