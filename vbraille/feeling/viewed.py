"""A picture that is felt, as pages of the live view are told of it, whenever something changes."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, Final

from vbraille.devices.base import Placing
from vbraille.live.messages import SceneShown, ViewState
from vbraille.live.states import array_shown

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.devices.events import Event
    from vbraille.feeling.feeler import Feeler
    from vbraille.feeling.loading import LoadedScene
    from vbraille.reading.opened import OpenDevice
    from vbraille.reading.viewed import Said

_PLACES: Final = {
    Placing.DONE: "feeling",
    Placing.MARK: "place: the carriage has to pass its mark",
    Placing.STOP: "place: the carriage has to be shown its place",
}


class FeltView:
    """A picture that is felt on a device, as the state of the live view.

    Parameters
    ----------
    device
        Device that the picture is felt on.
    feeler
        Who feels it.
    said
        What was said.
    facts
        Name and value of whatever else is to be shown.

    Attributes
    ----------
    standing : str
        Sentence on why nothing is felt, such as that the program is stopped; empty if it is.
    """

    def __init__(
        self,
        device: OpenDevice,
        feeler: Feeler,
        said: Said,
        facts: Iterable[tuple[str, str]] = (),
    ) -> None:
        self.standing = ""
        self._device = device
        self._feeler = feeler
        self._said = said
        self._facts = list(facts)
        self._number = 0
        self._told: tuple[object, ...] = ()
        self._drawn: tuple[LoadedScene, SceneShown] | None = None

    def see(self, events: Iterable[Event]) -> None:
        """Take note of events of the device, all of which are said."""

    def changed(self) -> ViewState | None:
        """State of the picture; None if it is what it was at the last call."""
        device, feeler = self._device, self._feeler
        now = (
            *(id(feeler.loaded), feeler.under, feeler.done, device.paused, device.placing),
            *(device.held, self._said.count, self.standing),
        )
        if now == self._told:
            return None
        self._told = now
        self._number += 1
        said = self._said.last
        return ViewState(
            number=self._number,
            title=feeler.loaded.title,
            array=array_shown(device.display),
            place="" if feeler.under is None else f"here: {feeler.under.name}",
            paused=device.paused,
            simulated=device.pointer is not None,
            held=device.held,
            device=self.standing or ("feeling is over" if feeler.done else self._placed()),
            said=said,
            said_before=self._said.count - len(said),
            facts=self._facts,
            done=feeler.done,
            scene=self._scene(feeler.loaded),
        )

    def _placed(self) -> str:
        if self._device.paused and self._device.placing is Placing.DONE:
            return "paused"
        return _PLACES[self._device.placing]

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
