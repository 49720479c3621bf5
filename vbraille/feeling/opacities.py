"""How much single patterns of a scene hide at a place."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.render.scene.canvas import SceneMap
from vbraille.scene.scene import Scene

if TYPE_CHECKING:
    from vbraille.render.scene.assets import Assets
    from vbraille.scene.patterns import AnyPattern

_KEPT: Final = 100  # patterns


class Opacities:
    """How much patterns hide at a place, in compiled code, which thousands of dots do not hold up.

    A pattern is compiled when it is asked for first; those that were asked for last are kept.

    Parameters
    ----------
    scene
        The scene that the patterns stand in.
    assets
        Bitmaps of its images and cells of its labels.
    """

    def __init__(self, scene: Scene, assets: Assets) -> None:
        self._scene, self._assets = scene, assets
        # By identity: to compare patterns of thousands of dots takes long. They are held, too, so
        # that no other can have the same.
        self._maps: dict[int, tuple[AnyPattern, SceneMap]] = {}

    def at(self, pattern: AnyPattern, x_mm: float, y_mm: float) -> float:
        """Tell how much of what lies below a pattern it hides at a place: 0 … 1."""
        _, shown = self._maps.pop(id(pattern), None) or (pattern, self._map_of(pattern))
        self._maps[id(pattern)] = pattern, shown
        if len(self._maps) > _KEPT:
            del self._maps[next(iter(self._maps))]
        return float(shown.opacity(np.array([x_mm]), np.array([y_mm]))[0, 0])

    def _map_of(self, pattern: AnyPattern) -> SceneMap:
        return SceneMap(Scene(canvas=self._scene.canvas, elements=(pattern,)), self._assets)
