"""What a scene takes from elsewhere: bitmaps of image files, and cells of labels."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.render.braille.style import BrailleStyle
    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.patterns import Image, Label


@dataclass(frozen=True, slots=True, eq=False)
class Written:
    """A label as cells, and how they are shown.

    Parameters
    ----------
    lines : tuple of uint8[n]
        Dot masks of the cells of each line.
    style
        Distances, profile and tuning of its dots.
    """

    lines: tuple[NDArray[np.uint8], ...]
    style: BrailleStyle


@dataclass(frozen=True, slots=True)
class Assets:
    """What is needed beside a scene to compile it.

    Parameters
    ----------
    bitmaps
        Intensities of each image of the scene.
    written
        Cells of each label of the scene.
    """

    bitmaps: Mapping[Image, Bitmap] = field(default_factory=dict)
    written: Mapping[Label, Written] = field(default_factory=dict)
