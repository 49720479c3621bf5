"""A device made of software at a pseudo-terminal: a controller, a hand, and what goes wrong.

simulator = Simulator(display, parse_hand("slow"), Port(), say=print)
simulator.run(stopped=lambda: False)
"""

from __future__ import annotations

import math
import random
import select
import time
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Final

from vbraille.simulation.carriage import Carriage
from vbraille.simulation.controller import Controller, info_of
from vbraille.simulation.controls import Controls

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from vbraille.display import Display
    from vbraille.simulation.hand import Hand
    from vbraille.simulation.pty import Port
    from vbraille.simulation.steering import Area

_NS_PER_S: Final = 1_000_000_000
_NS_PER_US: Final = 1000
_TICK_NS: Final = 1_000_000
UNPLUGGED_S: Final = 0.3
_KEYS_EVERY: Final = 20  # ticks
_OFF_PLACE_MM: Final = 5000.0
_LATE_WATCHDOG_MS: Final = 200
_KNOB_TOP: Final = 255
_NEVER_NS: Final = 1 << 62


class Defect(StrEnum):
    """Ways in which a device may be built wrong, so that it is not fit to be read on."""

    NO_ACKNOWLEDGEMENT = "no-acknowledgement"  # it takes FRAMEs without saying so
    OFF_PLACE = "off-place"  # its carriage is 5 m away from where it can be
    SLOW_CLOCK = "slow-clock"  # its clock goes at half speed
    NO_WATCHDOG = "no-watchdog"
    LATE_WATCHDOG = "late-watchdog"  # its watchdog takes 200 ms


@dataclass(frozen=True, slots=True)
class Faults:
    """Ways in which the device and its line misbehave.

    Parameters
    ----------
    drop, corrupt
        Chances of a line, in either direction, to be lost or to have a bit turned over.
    hold_ms
        How long bytes are held back, each way, as a USB adapter does that sends them in bulk.
    boot_s
        How long the board starts after its port is opened, which resets it.
    unplug_every_s
        Time after a greeting until the device is unplugged, for `UNPLUGGED_S`; 0 is never.
    defect
        Way in which the device is built wrong; None if it is built right.
    seed
        Seed of the random draws.
    """

    drop: float = 0.0
    corrupt: float = 0.0
    hold_ms: float = 0.0
    boot_s: float = 0.0
    unplug_every_s: float = 0.0
    defect: Defect | None = None
    seed: int = 1


class _Way:
    """A way along the line, from one end to the other; what comes is whole messages."""

    def __init__(self, faults: Faults, seed: int) -> None:
        self._faults, self._random = faults, random.Random(seed)
        self.clear()

    def clear(self) -> None:
        """Lose all that is under way."""
        self._begun = b""
        self._held: list[tuple[int, bytes]] = []  # each with when it arrives

    def put(self, chunk: bytes, now_ns: int) -> None:
        """Send bytes along it."""
        *lines, self._begun = (self._begun + chunk).split(b"\0")
        hold_ns = round(self._faults.hold_ms * 1e6)
        # What is held goes out together when its time is over, as it does in a USB adapter.
        due_ns = -(-now_ns // hold_ns) * hold_ns if hold_ns else now_ns
        self._held += [(due_ns, self._spoilt(line + b"\0")) for line in lines]

    def take(self, now_ns: int) -> bytes:
        """Return the bytes that have arrived."""
        arrived = b"".join(line for due_ns, line in self._held if due_ns <= now_ns)
        self._held = [(due_ns, line) for due_ns, line in self._held if due_ns > now_ns]
        return arrived

    def _spoilt(self, line: bytes) -> bytes:
        if self._random.random() < self._faults.drop:
            return b""
        spoilt = bytearray(line)
        if self._random.random() < self._faults.corrupt:
            spoilt[self._random.randrange(len(spoilt))] ^= 1 << self._random.randrange(8)
        return bytes(spoilt)


class Simulator:
    """A device at a port, in real time.

    Parameters
    ----------
    display
        What the device is.
    hand
        Hand that moves its carriage, once a FRAME was taken.
    port
        Pseudo-terminal at which a host finds the device.
    say
        Function that is told what happens, a sentence at a time.
    faults
        Ways in which the device misbehaves.
    placed
        Whether its encoders know where the carriage is; otherwise it waits for ZERO.
    area
        Lines of the page that the hand reads, on a carriage of two axes; None where it reads lines
        as wide as the travel.
    controls
        Moves its buttons and knobs, by the time since a host first greeted it; None for none.
    keys
        Function that gives the keys typed since its last call, which move buttons and knobs.

    Attributes
    ----------
    controller : Controller
        Controller that drives the device.
    """

    def __init__(
        self,
        display: Display,
        hand: Hand,
        port: Port,
        *,
        say: Callable[[str], None],
        faults: Faults | None = None,
        placed: bool = True,
        area: Area | None = None,
        controls: Controls | None = None,
        keys: Callable[[], Iterable[str]] = tuple,
    ) -> None:
        self._faults = faults or Faults()
        self._info, self._placed = info_of(display), placed
        self._carriage = Carriage(display, hand, area)
        self._port, self._say, self._keys = port, say, keys
        self._controls = controls or Controls()
        self._in, self._out = _Way(self._faults, self._faults.seed), _Way(self._faults, -1)
        self._begun_ns = time.monotonic_ns()
        self._ticks = 0
        self._greeted_ns: int | None = None  # for the first time
        self._was_open = False
        # When it is unplugged or plugged in, and has started.
        self._plug_ns, self._started_ns = _NEVER_NS, 0
        self._start()

    def _start(self) -> None:
        """Make the controller anew, with nothing under way."""
        self.controller = controller = Controller(self._info, placed=self._placed)
        self._greetings = self._trips = 0
        self._in.clear()
        self._out.clear()
        defect = self._faults.defect
        controller.acknowledges = defect is not Defect.NO_ACKNOWLEDGEMENT
        if defect is Defect.NO_WATCHDOG:
            controller.watchdog_ms = None
        elif defect is Defect.LATE_WATCHDOG:
            controller.watchdog_ms = _LATE_WATCHDOG_MS

    @property
    def now_us(self) -> int:
        """Time by the controller's clock."""
        us = (time.monotonic_ns() - self._begun_ns) // 1000
        return us // 2 if self._faults.defect is Defect.SLOW_CLOCK else us

    def run(self, stopped: Callable[[], bool]) -> None:
        """Run the device until it is told to stop; a late tick is not caught up on.

        Raises
        ------
        InputError
            If the port's link cannot be made again.
        """
        due_ns = time.monotonic_ns()
        while not stopped():
            due_ns = max(due_ns + _TICK_NS, time.monotonic_ns())
            self._listen_until(due_ns)
            self._go_wrong(time.monotonic_ns())
            self._tick()
            self._note()

    def _listen_until(self, due_ns: int) -> None:
        """Take what the host sends until a time."""
        while (left_ns := due_ns - time.monotonic_ns()) > 0:
            port = self._port.descriptor
            if port is None or not self._port.is_open:
                time.sleep(left_ns / _NS_PER_S)
                return
            if not select.select((port,), (), (), left_ns / _NS_PER_S)[0]:
                return
            self._in.put(self._port.read(), time.monotonic_ns())
            self._hear()

    def _hear(self) -> None:
        now_ns = time.monotonic_ns()
        chunk = self._in.take(now_ns)
        if now_ns >= self._started_ns:
            self.controller.receive(chunk)

    def _go_wrong(self, now_ns: int) -> None:
        """Start the board anew or unplug the device, as its faults say."""
        if self._faults.boot_s:
            was_open, self._was_open = self._was_open, self._port.is_open
            if self._was_open and not was_open:
                self._start()
                self._started_ns = now_ns + round(self._faults.boot_s * _NS_PER_S)
                self._say("the board starts")
        if now_ns < self._plug_ns:
            return
        if self._port.descriptor is None:
            self._port.plug()
            self._plug_ns = _NEVER_NS
            self._say(f"plugged in again: {self._port.path}")
        else:
            self._port.unplug()
            self.controller.hang_up()
            self._in.clear()
            self._out.clear()
            self._plug_ns = now_ns + round(UNPLUGGED_S * _NS_PER_S)
            self._say("unplugged")

    def _tick(self) -> None:
        self._hear()
        controller, now_us = self.controller, self.now_us
        way_mm, y_mm, theta_rad = self._carriage.at(now_us * _NS_PER_US)
        off_mm = _OFF_PLACE_MM if self._faults.defect is Defect.OFF_PLACE else 0.0
        counts = self._info["counts_per_mm"]
        controller.x = round((way_mm + off_mm) * counts[0])
        controller.y = round(y_mm * counts[-1])
        controller.turn = round(theta_rad / math.tau * self._info["counts_per_turn"])
        controller.buttons = self._controls.buttons
        controller.knobs = [round(knob * _KNOB_TOP) for knob in self._controls.knobs]
        line, now_ns = controller.tick(now_us), time.monotonic_ns()
        if line and now_ns >= self._started_ns:
            self._out.put(line, now_ns)
        if message := self._out.take(now_ns):
            self._port.send(message)

    def _note(self) -> None:
        """Tell what has happened, and move the hand, the buttons and the knobs."""
        controller, now_ns = self.controller, time.monotonic_ns()
        if controller.greetings != self._greetings:
            self._greetings = controller.greetings
            self._greeted_ns = self._greeted_ns or now_ns
            self._say("greeted by a host")
            if self._faults.unplug_every_s:
                self._plug_ns = now_ns + round(self._faults.unplug_every_s * _NS_PER_S)
        if controller.trips != self._trips:
            self._trips = controller.trips
            self._say(f"watchdog: trip {self._trips}")
        if controller.frames:
            self._carriage.set_out()
        since_s = (now_ns - (self._greeted_ns or now_ns)) / _NS_PER_S
        self._controls.advance(since_s if self._greeted_ns else -1.0)
        self._ticks += 1
        for key in self._keys() if self._ticks % _KEYS_EVERY == 0 else ():
            if said := self._controls.type(key, since_s):
                self._say(said)
