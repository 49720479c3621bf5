"""Findings on each actuator of a device, and deflections that make up for them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from vbraille.errors import check_range

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

State = Literal["ok", "weak", "dead"]
LEAST_GAIN: Final = 0.05
# Time in which inverted actuators go over to where the others rest, and back.
_TURN_S = 0.1


@dataclass(frozen=True, slots=True)
class Tried:
    """Findings on one actuator.

    Parameters
    ----------
    row, column
        Place of the actuator in the array, from 0; row 0 is far from the reader.
    state
        "ok", "weak" if it moves less than the others, or "dead" if it does not move.
    inverted
        Whether it moves the other way: level 0 has it where others are at full swing.
    gain
        Share of the full swing that it is driven with, 0.05 to 1.

    Raises
    ------
    ValueError
        If the gain is out of range.
    """

    row: int
    column: int
    state: State = "ok"
    inverted: bool = False
    gain: float = 1.0

    def __post_init__(self) -> None:
        check_range("gain", self.gain, LEAST_GAIN, 1)

    @property
    def place(self) -> tuple[int, int]:
        """Row and column, from 0."""
        return self.row, self.column


@dataclass(frozen=True, slots=True)
class Calibration:
    """Findings on the actuators of a device; one that was not tried is taken to be well.

    Parameters
    ----------
    device
        Name of the device, with its serial number if it has one.
    rows, columns
        Shape of its array.
    tried
        What was found, in the order in which it was.

    Raises
    ------
    ValueError
        If an actuator is not in the array, or is there twice.
    """

    device: str
    rows: int
    columns: int
    tried: tuple[Tried, ...] = ()

    def __post_init__(self) -> None:
        seen = set()
        for one in self.tried:
            if not (0 <= one.row < self.rows and 0 <= one.column < self.columns):
                raise ValueError(
                    f"row {one.row + 1}, column {one.column + 1} is not in an array of "
                    f"{self.rows} × {self.columns}"
                )
            if one.place in seen:
                raise ValueError(f"row {one.row + 1}, column {one.column + 1} is there twice")
            seen.add(one.place)

    def of(self, place: tuple[int, int]) -> Tried | None:
        """Tell what was found of an actuator; None if it was not tried."""
        return next((one for one in self.tried if one.place == place), None)

    def with_tried(self, found: Tried) -> Calibration:
        """Make a calibration with what was found of one more actuator, or found anew."""
        others = tuple(one for one in self.tried if one.place != found.place)
        return replace(self, tried=(*others, found))

    def without_last(self) -> Calibration:
        """Make a calibration without what was found last."""
        return replace(self, tried=self.tried[:-1])

    def places(self, state: State) -> list[tuple[int, int]]:
        """Row and column, from 0, of each actuator in a state."""
        return sorted(one.place for one in self.tried if one.state == state)

    @property
    def inverted(self) -> list[tuple[int, int]]:
        """Row and column, from 0, of each actuator that moves the other way and is not dead."""
        return sorted(one.place for one in self.tried if one.inverted and one.state != "dead")

    @property
    def whole(self) -> bool:
        """Tell whether every actuator was tried."""
        return len(self.tried) == self.rows * self.columns

    def scale(self) -> NDArray[np.float64]:
        """Tell what deflections are multiplied by; float64[rows, columns], -1 … 1.

        A dead actuator has 0, and an inverted one less than 0: its deflections count from 1 down.
        """
        scale = np.ones((self.rows, self.columns))
        for one in self.tried:
            gain = 0.0 if one.state == "dead" else one.gain
            scale[one.place] = -gain if one.inverted and gain else gain
        return scale

    def sentences(self) -> Iterator[str]:
        """Tell what was found, in sentences for people: "label: value"."""
        count = self.rows * self.columns
        yield f"actuators tried: {len(self.tried)} of {count}"
        named = (
            ("dead", self.places("dead")),
            ("weak", self.places("weak")),
            ("inverted", self.inverted),
        )
        for name, places in named:
            yield f"{name}: {_said(places)}"
        for one in sorted(self.tried, key=lambda one: one.place):
            if one.gain < 1 and one.state != "dead":
                yield f"gain of {_said([one.place])}: {100 * one.gain:.0f} %"

    def to_json(self) -> dict[str, Any]:
        """Tell what a session keeps of it; rows and columns count from 0."""
        return {
            "device": self.device,
            "tried": len(self.tried),
            "actuators": self.rows * self.columns,
            "scale": self.scale().tolist(),
            "dead": [list(place) for place in self.places("dead")],
            "weak": [list(place) for place in self.places("weak")],
        }


def _said(places: list[tuple[int, int]]) -> str:
    return "; ".join(f"row {row + 1}, column {column + 1}" for row, column in places) or "none"


class Correction:
    """Deflections on their way to the actuators of a device that does not correct them itself.

    What an actuator is sent is ``scale · deflection + offset``, with an offset of 1 where it is
    inverted. A change of these two is spread over some frames, and so is the way of an inverted
    actuator from where the device itself rests to where it must rest, and back.

    Parameters
    ----------
    shape
        Rows and columns of the array.
    frames
        Number of frames over which a change is spread.

    Attributes
    ----------
    scale, offset : float64[rows, columns]
        What deflections are multiplied by now, and what is then added.
    moving : bool
        Whether they are on their way to others.
    """

    def __init__(self, shape: tuple[int, int], frames: int) -> None:
        self.scale, self.offset = np.ones(shape), np.zeros(shape)
        self._wanted = np.ones(shape), np.zeros(shape)
        self._from = np.ones(shape), np.zeros(shape)
        self._to = np.ones(shape), np.zeros(shape)
        self._work, self._out = np.zeros(shape), np.zeros(shape)
        self._share, self._step = 1.0, 1.0 / max(frames, 1)
        self._left = False
        self._rested = 0

    @property
    def moving(self) -> bool:
        """Tell whether scale and offset are on their way."""
        return self._share < 1

    def aim(self, calibration: Calibration | None) -> None:
        """Go over to what a calibration says; None for deflections as they are."""
        scale, offset = self._wanted
        scale[:] = 1.0 if calibration is None else calibration.scale()
        offset[:] = scale < 0
        self._go(*self._wanted)

    def from_rest(self) -> None:
        """Begin where the device itself rests: it has gone there, and frames fade in from there."""
        np.maximum(self._wanted[0], 0.0, out=self.scale)
        self.offset.fill(0.0)
        self._go(*self._wanted)

    def leave(self) -> None:
        """Go back to where the device itself rests, until there is anything to feel."""
        if not self._left:
            self._go(np.maximum(self._wanted[0], 0.0), np.zeros_like(self.offset))
            self._left = True

    def of(self, frame: NDArray[np.float64], rested: int) -> NDArray[np.float64]:
        """Correct a frame.

        Parameters
        ----------
        frame : float64[rows, columns]
            Deflections that are wanted, in [0, 1].
        rested
            How often the device has gone to rest by itself so far.

        Returns
        -------
        float64[rows, columns]
            Deflections to send, in [0, 1]; the same array at each call.
        """
        if rested != self._rested:
            self._rested = rested
            self.from_rest()
        elif self._left and frame.any():
            self._go(*self._wanted)
        self.advance()
        out = self._out
        np.multiply(frame, self.scale, out=out)
        np.add(out, self.offset, out=out)
        np.clip(out, 0.0, 1.0, out=out)  # what rounding adds
        return out

    def advance(self) -> bool:
        """Go on by a frame; tell whether anything has changed."""
        if self._share >= 1:
            return False
        self._share = min(self._share + self._step, 1.0)
        for one, other, now in zip(self._from, self._to, (self.scale, self.offset), strict=True):
            np.subtract(other, one, out=self._work)
            np.multiply(self._work, self._share, out=self._work)
            np.add(one, self._work, out=now)
            if self._share >= 1:
                now[:] = other
        return True

    def _go(self, scale: NDArray[np.float64], offset: NDArray[np.float64]) -> None:
        """Set out from here to another scale and offset."""
        self._left = False
        self._from[0][:], self._from[1][:] = self.scale, self.offset
        self._to[0][:], self._to[1][:] = scale, offset
        self._share = 0.0


def correction_for(shape: tuple[int, int], rate_hz: float, slew_per_s: float = 0.0) -> Correction:
    """Make a correction for a device's rate, and for the fastest that its actuators may be moved.

    Parameters
    ----------
    shape
        Rows and columns of the array.
    rate_hz
        Frames a second.
    slew_per_s
        Largest number of full swings a second; 0 for no limit.
    """
    turn_s = max(_TURN_S, 1 / slew_per_s if slew_per_s else 0.0)
    return Correction(shape, round(turn_s * rate_hz))
