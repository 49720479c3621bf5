"""Sources of the live view: a device that is read now, or a recording."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from vbraille.live.messages import LetGo, PagePress, Point, Turn

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.live.messages import Map, Next, PlayedEvent

Steering = PagePress | Turn | Point | LetGo


class Viewer(Protocol):
    """View of a source by one page, with a cursor of its own."""

    def state(self, request: Next) -> tuple[int, bytes]:
        """Number of the state that belongs to what is asked for, and the state as JSON.

        It is asked before each `frame`, and while a frame is waited for; it must be cheap.
        """
        ...

    def frame(self, request: Next, *, again: bool = False) -> bytes | None:
        """Give the next frame, as `vbraille.live.framing.frame_bytes` makes it.

        Parameters
        ----------
        request
            What the page asked.
        again
            Whether the page is to have one in any case, even the one that it had last.

        Returns
        -------
        bytes | None
            The frame; None if there is none yet that the page has not had, and ``again`` is not
            set.
        """
        ...


class LiveSource(Protocol):
    """Source that a server shows."""

    @property
    def playback(self) -> bool:
        """Tell whether it is a recording, so that pages name times."""
        ...

    @property
    def length_s(self) -> float:
        """Length of the recording in seconds; 0 without one."""
        ...

    @property
    def moments(self) -> Sequence[PlayedEvent]:
        """Events of the recording, by time."""
        ...

    def viewer(self) -> Viewer:
        """Make the viewer of a page."""
        ...

    def map(self, request: Map) -> bytes:
        """Draw a map; the bytes of a file of the form that is asked for.

        It is called in a thread of its own, one map at a time.

        Raises
        ------
        VbrailleError
            If there is none to draw; the page is told the reason.
        """
        ...

    def ask(self, request: Steering) -> None:
        """Take what a page with the right to steer asks for.

        Raises
        ------
        VbrailleError
            If it cannot be done; the page is told the reason.
        """
        ...
