"""A device in memory, whose carriage a simulated hand moves."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qsl

import numpy as np
from msgspec.structs import replace

from vbraille.devices.base import Device
from vbraille.devices.events import Button, HandDone, HandHeld, Knob
from vbraille.display import Pose
from vbraille.errors import InputError, check_range
from vbraille.simulation.carriage import Carriage
from vbraille.simulation.controls import MOST_BUTTONS, Controls, parse_moves
from vbraille.simulation.hand import STILL_S, Still
from vbraille.simulation.specs import parse_hand
from vbraille.simulation.steering import GlideTo, Hold, LetGo, ReadLine, ReadPage
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.simulation.controls import ControlEvent
    from vbraille.simulation.hand import Hand
    from vbraille.simulation.motion import Motion
    from vbraille.simulation.steering import HandOrder

NS_PER_S = 1_000_000_000
HELD_MM_S = 1000.0  # speed at which a hand goes to where it is put
# A person who holds the hand tells its place some 60 times a second: the hand glides from one place
# to the next for so long, rather than jump there and stand still.
GLIDE_S = 0.012


class SimulatedDevice(Device):
    """A device without hardware; a hand moves its carriage in the time of a clock.

    The encoders count, levels are as coarse as the device says, and the actuators rest on close, as
    on other devices. The carriage has the axes that the device says: y from the top of the page
    down, and the angle without steps.

    Parameters
    ----------
    info
        What the device is to be.
    now_ns
        Clock by which the hand moves, in nanoseconds.
    hand
        Hand that moves the carriage, as `obey` is told; `move` moves it as well.
    presses
        Presses of its buttons, in seconds since the device was opened; `press` and
        `turn` do more of the same at once.

    Attributes
    ----------
    hand : Hand or None
        As it was given.
    levels : int64[rows, columns]
        Levels that were last sent to the actuators, 0 … info.levels - 1.
    frames : int
        Number of frames received.
    """

    def __init__(
        self,
        info: Display,
        now_ns: Callable[[], int] = time.monotonic_ns,
        hand: Hand | None = None,
        presses: Sequence[ControlEvent] = (),
    ) -> None:
        self.display = info
        self.hand = hand
        self.levels = np.zeros(info.shape, np.int64)
        self.frames = 0
        self._now_ns, self._opened_ns = now_ns, now_ns()
        self._controls = Controls(presses)
        self._carriage = Carriage(info, hand, now_ns=self._opened_ns)
        self._course = self._carriage.course
        self._events: list[Event] = []
        self._held_ns: int | None = None  # when a person who holds the hand last moved it
        self._left: Motion | None = None  # what the hand had not done yet when it was taken
        self._ordered = False  # whether an order is not done yet

    def go_by(self, now_ns: Callable[[], int]) -> None:
        """Use another clock from now on; a motion goes on from where it has come to."""
        gone_ns = now_ns() - self._now_ns()
        self._course.begun_ns += gone_ns
        self._opened_ns += gone_ns
        self._now_ns = now_ns

    def press(self, button: int, *, pressed: bool = True) -> None:
        """Press a button, 1 to 8, or let it go."""
        check_range("button", button, 1, MOST_BUTTONS)
        self._events.append(Button(button, pressed=pressed, at_ns=self._now_ns()))

    def turn(self, knob: int, value: float) -> None:
        """Turn a knob, counted from 1, to a position from 0 to 1."""
        check_range("position of a knob", value, 0, 1)
        self._events.append(Knob(knob, value))

    def take_events(self) -> Sequence[Event]:
        """Return moves of buttons and knobs since the last call, and what the hand has done."""
        now_ns = self._now_ns()
        if self._ordered and self._course.is_over(now_ns):
            self._ordered = False
            self._events.append(HandDone(now_ns))
        for move in self._controls.advance((now_ns - self._opened_ns) / NS_PER_S):
            if move.knob:
                self.turn(move.number, move.value)
            else:
                self.press(move.number, pressed=bool(move.value))
        told, self._events = self._events, []
        return told

    def obey(self, order: HandOrder) -> None:
        """Have the hand follow an order from now on; a person who holds it goes first."""
        now_ns = self._now_ns()
        if isinstance(order, Hold):
            self._be_held(order, now_ns)
        elif isinstance(order, LetGo):
            if self._held_ns is not None:
                self._held_ns = None
                self._events.append(HandHeld(held=False))
                if self._left is not None:
                    self.move(self._left)
        elif self._held_ns is None:
            self._ordered = True
            self._do(order, now_ns)

    def _be_held(self, at: Hold, now_ns: int) -> None:
        """Have the hand go where a person holds it."""
        since_s = GLIDE_S
        if self._held_ns is None:
            self._events.append(HandHeld(held=True))
            self._left = self._course.rest(now_ns)
        else:
            since_s = min((now_ns - self._held_ns) / NS_PER_S, GLIDE_S)
        self._held_ns = now_ns
        info = self.display
        way_mm = min(max(at.x_mm + info.span_mm / 2, 0.0), info.travel_mm)
        y_mm = min(max(at.y_mm, 0.0), info.height_mm)
        self._course.go_to((way_mm - info.span_mm, y_mm, at.theta_rad), now_ns, HELD_MM_S, since_s)

    def until_done(self, times_ns: NDArray[np.int64]) -> int:
        """Return the number of given times that come until the hand has done its order.

        The time at which it is done counts too. All times count if there is no order or it takes
        longer.
        """
        done = np.asarray(self._course.is_over(times_ns))
        return int(done.argmax()) + 1 if self._ordered and done.any() else times_ns.size

    def _do(self, order: HandOrder, now_ns: int) -> None:
        """Have the hand follow an order; a recorded hand sets out with the first and goes on."""
        hand, home_mm, here = self.hand, -self.display.span_mm, self._course.at(now_ns)
        if hand is None or not hand.goes_on:
            self._carriage.stop()
        if isinstance(order, GlideTo):
            to = order.x_mm + home_mm / 2, order.y_mm, here[2]
            self._course.go_to(to, now_ns, order.speed_mm_s)
        elif isinstance(hand, Still):
            self._course.go_to(here, now_ns, least_s=STILL_S)
        elif hand is not None and hand.goes_on:
            self._carriage.set_out()
            self._carriage.at(now_ns)
        elif hand is not None and isinstance(order, ReadLine):
            self.move(hand.read_line(home_mm, order.end_mm))
        elif hand is not None and isinstance(order, ReadPage):
            self.move(hand.read_page(replace(order, start_mm=home_mm)))

    def move(self, motion: Motion) -> None:
        """Move the hand along a motion from now on; it first goes to where the motion begins."""
        self._course.follow(motion, self._now_ns())

    def read(self) -> Pose | None:
        """Return the pose of the carriage now, to the nearest count of its encoders."""
        now_ns = self._now_ns()
        if self.frames:  # as long as no order comes it reads over the whole travel
            self._carriage.set_out()
        return Pose(now_ns, *map(float, self._poses(self._carriage.at(now_ns))))

    def poses_at(self, times_ns: NDArray[np.int64]) -> tuple[Any, Any, Any]:
        """Return x and y in mm, and θ in radians, at each of an array of times."""
        return self._poses(self._carriage.places_at(times_ns))

    def _poses(self, places: tuple[Any, Any, Any]) -> tuple[Any, Any, Any]:
        way_mm, y_mm, theta_rad = places
        counts = self.display.counts_per_mm
        x_mm = np.rint(way_mm * counts) / counts - self.display.span_mm / 2
        return x_mm, np.rint(y_mm * counts) / counts, theta_rad

    def _send(self, frame: NDArray[np.float64]) -> None:
        np.rint(frame * (self.display.levels - 1), out=self.levels, casting="unsafe")
        self.frames += 1

    def _release(self) -> None:
        """Do nothing: there is nothing to release."""


def open_simulated(address: str, wanted: Display | None) -> SimulatedDevice:
    """Open ``sim:?hand=HAND&seed=N&press=1@2.5s,2@4s``, as the page wants it.

    Raises
    ------
    InputError
        If the address holds anything else, or no display is wanted.
    """
    if wanted is None:
        raise InputError(
            f"a simulated device is made for a model; say which, with {setting('model')}"
        )
    given = dict(parse_qsl(address.removeprefix("?"), keep_blank_values=True))
    seed, hand, presses = given.pop("seed", "1"), given.pop("hand", ""), given.pop("press", "")
    if given or not seed.isdecimal() or (address and not address.startswith("?")):
        raise InputError(f"there is no device sim:{address}; give sim, or sim:?hand=HAND&seed=N")
    moved = parse_hand(hand, int(seed), pointed=True) if hand else None
    return SimulatedDevice(wanted, hand=moved, presses=parse_moves(presses))
