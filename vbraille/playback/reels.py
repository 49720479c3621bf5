"""What is played back: frames by the piece, so that memory holds seconds of them and not hours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from vbraille.live.messages import LineShown

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from vbraille.live.messages import PlayedEvent, ViewState
    from vbraille.render.program import Program

# What is known of each frame, by the names of `vbraille.live.framing.FrameHeader`.
PLAYED = np.dtype(
    [
        ("flags", "u4"),
        ("line", "u4"),
        ("part", "u4"),
        ("late", "u4"),
        ("tick", "f8"),
        ("time_s", "f8"),  # seconds from the start of the recording
        ("x_mm", "f8"),
        ("y_mm", "f8"),
        ("theta_rad", "f8"),
        ("vx_mm_s", "f8"),
        ("share", "f8"),
        ("scene", "i8"),  # number of what a page shows beside the frames
    ]
)


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """Some frames that follow each other.

    Parameters
    ----------
    ticks : `PLAYED`[n]
        What is known of each frame beside its deflections; times never go back.
    frames : float32[n, rows, columns]
        Deflections, 0 … 1; NaN where they are not known.
    """

    ticks: NDArray[np.void]
    frames: NDArray[np.float32]

    def __len__(self) -> int:
        """Count the frames."""
        return self.ticks.size

    def index(self, at_s: float) -> int:
        """Index of the last frame that is not later than a time; 0 if all are."""
        return max(int(np.searchsorted(self.ticks["time_s"], at_s, "right")) - 1, 0)


class Reel(Protocol):
    """Recorded frames, of which any can be taken out.

    Attributes
    ----------
    length_s : float
        Length in seconds.
    moments : list[PlayedEvent]
        What happened, by time.
    notes : list[str]
        Sentences for whoever plays it, such as on damage.
    """

    length_s: float
    moments: list[PlayedEvent]
    notes: list[str]

    def find(self, at_s: float) -> int:
        """Number of the piece that has the frame of a time: the last one that is not later."""
        ...

    def piece(self, number: int) -> Piece:
        """Read a piece, which may be empty where the recording is damaged."""
        ...

    def state(self, scene: int) -> ViewState:
        """Make what a page shows beside the frames of a scene; its number is left 0."""
        ...

    def program(self, scene: int) -> tuple[Program, str] | None:
        """Compile what is under the hand in a scene, and its title; None if that is not known."""
        ...


def line_shown(
    number: int, masks: Iterable[int], top_mm: float = 0.0, *, under: bool = False
) -> LineShown:
    """Describe a recorded line of cells, whose text is not recorded."""
    cells = [int(mask) for mask in masks]
    return LineShown(number, "", 0.0, top_mm, cells, [(0, 0)] * len(cells), under)
