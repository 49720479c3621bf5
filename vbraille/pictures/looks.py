"""How abstract and raised drawings look: the least sizes of what is on the paper.

An abstract drawing is for eyes, and is as fine as it is. A raised one is for fingers, on swell
paper or from an embosser. Its sizes follow what guidelines of tactile graphics have in common (the
Guidelines and Standards for Tactile Graphics of the Braille Authority of North America, 2010, and
Lévesque 2009, 8.2.1): lines that are thick enough to swell, blank space around whatever lies on
something else, few textures, and braille at its standard distances. The numbers are ours, within
what these say: lines of 0.75 mm at least, blanks of 2 mm, dots of 1.5 mm.
"""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True, slots=True)
class InkLook:
    """Sizes of a drawing in mm of the canvas.

    Parameters
    ----------
    raised
        Whether it is for fingers: black and white only.
    line_mm, gap_mm
        Least width of a line, and of the blank between two.
    halo_mm
        Blank around what lies on something else.
    dot_mm
        Diameter of the dots that stand for vibration.
    label_dot_mm
        Diameter of a dot of braille; None for that of the label.
    scale
        Millimetres of the paper to one of the canvas, by which the others were divided.
    """

    raised: bool
    line_mm: float
    gap_mm: float
    halo_mm: float
    dot_mm: float
    label_dot_mm: float | None
    scale: float = 1.0

    def on_paper(self, scale: float) -> InkLook:
        """Make the look of a drawing that is scaled afterwards, with the same sizes on paper."""
        label = None if self.label_dot_mm is None else self.label_dot_mm / scale
        return replace(
            self,
            line_mm=self.line_mm / scale,
            gap_mm=self.gap_mm / scale,
            halo_mm=self.halo_mm / scale,
            dot_mm=self.dot_mm / scale,
            label_dot_mm=label,
            scale=scale,
        )

    def ink(self, strength: float) -> float:
        """Gray for a strength from 0 to 1: darker for more; raised drawings have black alone."""
        return 0.0 if self.raised else 1.0 - 0.75 * strength


ABSTRACT = InkLook(
    raised=False, line_mm=0.15, gap_mm=0.0, halo_mm=0.0, dot_mm=0.5, label_dot_mm=None
)
RAISED = InkLook(raised=True, line_mm=0.75, gap_mm=2.0, halo_mm=2.0, dot_mm=1.5, label_dot_mm=1.5)
