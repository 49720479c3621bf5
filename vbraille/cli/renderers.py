"""A line to a renderer. Apart from `vbraille.cli.build`, since this imports numba."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.render.renderer import Renderer

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vbraille.cli.build import Page
    from vbraille.render import Mapping, Tuning


def build_renderer(
    masks: NDArray[np.uint8], page: Page, mapping: Mapping, tuning: Tuning
) -> Renderer:
    """One line, ready to be shown."""
    return Renderer(
        masks,
        array=page.model.array,
        profile=page.model.profile,
        mapping=mapping,
        geometry=page.geometry,
        tuning=tuning,
    )
