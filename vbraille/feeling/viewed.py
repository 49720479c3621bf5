"""A picture that is felt, as pages of the live view are told of it, whenever something changes."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, Any

from vbraille.live.messages import SceneShown
from vbraille.reading.viewed import View

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.devices.events import Event
    from vbraille.feeling.feeler import Feeler
    from vbraille.feeling.loading import LoadedScene
    from vbraille.live.messages import PagePress, Turn
    from vbraille.reading.device import OpenDevice
    from vbraille.reading.viewed import Said


class FeltView(View):
    """A picture that is felt on a device.

    Parameters
    ----------
    device
        Device that the picture is felt on.
    feeler
        Who feels it.
    said, facts
        As for a `View`.
    """

    def __init__(
        self,
        device: OpenDevice,
        feeler: Feeler,
        said: Said,
        facts: Iterable[tuple[str, str]] = (),
    ) -> None:
        super().__init__(device, feeler, said, facts)
        self._feeler = feeler
        self._drawn: tuple[LoadedScene, SceneShown] | None = None

    def obey(self, asked: PagePress | Turn) -> None:
        """Pass over what a page asks for: it can be the hand, but nothing can be turned."""

    def see(self, events: Iterable[Event]) -> None:
        """Take note of events of the device, all of which are said."""

    def _compared(self) -> tuple[object, ...]:
        return self._feeler.loaded, self._feeler.under

    def _parts(self) -> dict[str, Any]:
        under, loaded = self._feeler.under, self._feeler.loaded
        return {
            "title": loaded.title,
            "place": "" if under is None else f"here: {under.name}",
            "scene": self._scene(loaded),
        }

    def _scene(self, loaded: LoadedScene) -> SceneShown:
        """Picture from above, which is drawn once."""
        if self._drawn is None or self._drawn[0] is not loaded:
            # Only a live view waits for what draws it.
            from vbraille.pictures.scenes import small_png

            drawn = base64.b64encode(small_png(loaded.scene, loaded.assets)).decode()
            self._drawn = loaded, scene_shown(loaded, f"data:image/png;base64,{drawn}")
        return self._drawn[1]


def scene_shown(loaded: LoadedScene, image: str) -> SceneShown:
    """Words and size of a scene for a page, with the address of its image."""
    scene = loaded.scene
    return SceneShown(
        loaded.title, scene.description, scene.canvas.width_mm, scene.canvas.height_mm, image
    )
