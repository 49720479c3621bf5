# ruff: noqa: D102
"""The live view as readings and sessions had it, until both call `vbraille.live.view`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Self

from vbraille.errors import VbrailleError
from vbraille.live.messages import LetGo, Point
from vbraille.live.view import LiveView
from vbraille.simulation.steering import BeAt
from vbraille.wording import spelled

if TYPE_CHECKING:
    from vbraille.engine.record import RingReader
    from vbraille.live.messages import PagePress, Turn, ViewState
    from vbraille.simulation.steering import Pointer


class Monitor:
    """A live view that a function launches, and that holds a simulated hand by memory."""

    def __init__(
        self,
        *,
        host: str | None = None,
        port: int | None = None,
        pointer: Pointer | None = None,
        blind: bool = False,
        steers: bool = True,
    ) -> None:
        self._view = LiveView(host=host, port=port, blind=blind, steers=steers)
        self._pointer = pointer
        self._notes: list[str] = []
        self._open = False

    def launch(self) -> None:
        try:
            self._view.__enter__()
            self._open = True
            self._notes += self._view.addresses
        except VbrailleError as error:
            self._notes.append(spelled(f"live view: {error}"))

    def share(self, ticks: RingReader) -> None:
        self._view.watch(ticks)

    def tell(self, state: ViewState) -> None:
        self._view.tell(state)

    def take(self) -> list[PagePress | Turn]:
        asked = self._view.take()
        for one in asked:
            if self._pointer is not None and isinstance(one, Point):
                self._pointer.hold(BeAt(one.x_mm, one.y_mm, one.theta_rad))
            elif self._pointer is not None and isinstance(one, LetGo):
                self._pointer.let_go()
        return [one for one in asked if not isinstance(one, Point | LetGo)]

    def notes(self) -> list[str]:
        notes, self._notes = self._notes + self._view.notes(), []
        return notes

    def close(self) -> None:
        if self._open:
            self._view.__exit__()

    def __enter__(self) -> Self:
        self.launch()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
