"""A device made of software: a controller at a pseudo-terminal, a hand, and what goes wrong.

simulator = Simulator(info, parse_hand("device"), Port(), say=print)
simulator.run(stopped=lambda: False)
"""

from __future__ import annotations

import math
import random
import select
import time
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Final

from vbraille.devices.serial.wire import DELIMITER, MOST_FRAME_BYTES, Encoder
from vbraille.errors import check_range
from vbraille.simulation.carriage import Carriage
from vbraille.simulation.controls import Controls
from vbraille.simulation.firmware import WATCHDOG_US, Controller

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from vbraille.devices.serial.wire import Info
    from vbraille.simulation.hand import Area, Hand
    from vbraille.simulation.pty import Port
    from vbraille.simulation.recorded import Recorded

NS_PER_S: Final = 1_000_000_000
# Time between stalls, and time for which the device is unplugged.
STALL_EVERY_S: Final = 1.0
UNPLUGGED_S: Final = 0.3
KEYS_EVERY_US: Final = 20_000  # soon enough for a finger
# Error in place of a carriage that is off its place, and delay of a late watchdog.
_OFF_PLACE_MM = 5000.0
_LATE_TIMES = 4


class Defect(StrEnum):
    """Ways in which a device may be built wrong, so that it is not fit to be read on."""

    NO_ACKNOWLEDGEMENT = "no-acknowledgement"  # it takes FRAMEs without saying so
    NO_ACTUATORS = "no-actuators"  # all of them are disabled
    OFF_PLACE = "off-place"  # its carriage is 5 m away from where it can be
    SLOW_CLOCK = "slow-clock"  # its clock goes at half speed
    NO_WATCHDOG = "no-watchdog"
    LATE_WATCHDOG = "late-watchdog"  # its watchdog takes 200 ms, not 50


@dataclass(frozen=True, slots=True)
class Faults:
    """Ways in which the device misbehaves.

    Parameters
    ----------
    drop, corrupt
        Chances of a message, in either direction, to be lost or to have a bit turned over.
    stall_s
        How long the device does nothing, `STALL_EVERY_S` after the last such time; 0 is never.
        Its watchdog and its ramp, which are hardware, go on.
    unplug_every_s
        Time after a greeting until the device is unplugged, for `UNPLUGGED_S`; 0 is never.
    defect
        Way in which the device is built wrong; None if it is built right.
    seed
        Seed of the random draws.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    drop: float = 0.0
    corrupt: float = 0.0
    stall_s: float = 0.0
    unplug_every_s: float = 0.0
    defect: Defect | None = None
    seed: int = 1

    def __post_init__(self) -> None:
        for name in ("drop", "corrupt"):
            check_range(name, getattr(self, name), 0, 1)
        for name in ("stall_s", "unplug_every_s"):
            if not 0 <= getattr(self, name) < math.inf:
                raise ValueError(f"{name} is {getattr(self, name):g}; it must be 0 or more")


class Spoiler:
    """Loses and corrupts messages."""

    def __init__(self, faults: Faults) -> None:
        self._faults = faults
        self._random = random.Random(faults.seed)
        self._spoils = faults.drop > 0 or faults.corrupt > 0
        self._begun = b""

    def spoil(self, message: bytes) -> bytes:
        """Tell what is left of a message; empty if it is lost."""
        if not self._spoils or message == DELIMITER:
            return message
        lost, corrupted = self._random.random(), self._random.random()
        if lost < self._faults.drop:
            return b""
        if corrupted < self._faults.corrupt:
            spoilt = bytearray(message)
            spoilt[self._random.randrange(len(spoilt))] ^= 1 << self._random.randrange(8)
            return bytes(spoilt)
        return message

    def spoil_stream(self, chunk: bytes) -> bytes:
        """Tell what is left of a stream's bytes; a message is held back until it has come whole."""
        if not self._spoils:
            return chunk
        *messages, begun = split(self._begun + chunk)
        # Bytes without an end are no message, and must not be held for ever.
        self._begun, passed = (begun, b"") if len(begun) <= MOST_FRAME_BYTES else (b"", begun)
        return b"".join(map(self.spoil, messages)) + passed

    def forget(self) -> None:
        """Forget a message that has come in part."""
        self._begun = b""


def split(chunk: bytes) -> list[bytes]:
    """Messages with their delimiters, and last the bytes after them, which may be none."""
    *messages, begun = chunk.split(DELIMITER)
    return [*(message + DELIMITER for message in messages), begun]


class Simulator:
    """A device at a port, in real time.

    Parameters
    ----------
    info
        What the device says of itself.
    hand
        Hand that moves its carriage.
    port
        Pseudo-terminal at which a host finds the device.
    say
        Function that is told what happens, a sentence at a time.
    faults
        Ways in which the device misbehaves.
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
    states_sent, states_dropped : int
        Numbers of STATEs since the device was greeted: those sent, and those due that were not.
    """

    def __init__(
        self,
        info: Info,
        hand: Hand | Recorded,
        port: Port,
        *,
        say: Callable[[str], None],
        faults: Faults | None = None,
        area: Area | None = None,
        controls: Controls | None = None,
        keys: Callable[[], Iterable[str]] = tuple,
    ) -> None:
        self._faults = faults or Faults()
        self._controls = controls or Controls()
        self._keys = keys
        self._greeted_us: int | None = None  # for the first time
        defect = self._faults.defect
        if defect is Defect.NO_ACTUATORS:
            info = replace(info, enabled=bytes(info.rows * info.columns))
        self.controller = Controller(info)
        self.controller.acknowledges = defect is not Defect.NO_ACKNOWLEDGEMENT
        if defect is Defect.NO_WATCHDOG:
            self.controller.watchdog_us = None
        elif defect is Defect.LATE_WATCHDOG:
            self.controller.watchdog_us = _LATE_TIMES * WATCHDOG_US
        self.states_sent = self.states_dropped = 0
        span_mm = (info.columns - 1) * info.column_pitch_nm / 1e6
        self._carriage = Carriage(
            hand,
            span_mm,
            info.travel_um / 1000,
            height_mm=info.height_um / 1000,
            turns=info.counts_per_turn > 0,
            area=area,
        )
        self._port = port
        self._say = say
        self._spoiler = Spoiler(self._faults)
        self._begun_ns = time.monotonic_ns()
        self._seeks_mark = info.encoder is Encoder.INDEX
        self._greetings = self._frames = self._trips = 0
        self._stalled = False
        self._turn_us = round(STALL_EVERY_S * 1e6)  # when the device stalls, or goes on
        self._keys_us = 0  # when keys are looked for again
        self._plug_us = 0  # when the device is unplugged, or plugged in again

    @property
    def now_us(self) -> int:
        """Time by the controller's clock."""
        us = (time.monotonic_ns() - self._begun_ns) // 1000
        return us // 2 if self._faults.defect is Defect.SLOW_CLOCK else us

    def run(self, stopped: Callable[[], bool]) -> None:
        """Run the device until it is told to stop; a late tick is skipped, not caught up on.

        Raises
        ------
        InputError
            If the port's link cannot be made again.
        """
        period_ns = NS_PER_S / self.controller.info.rate_hz
        begun_ns, tick = time.monotonic_ns(), 0
        while not stopped():
            tick += 1
            late_ns = self._listen_until(begun_ns + tick * period_ns)
            missed = int(late_ns // period_ns)
            if missed:
                tick += missed
                self.controller.skip(missed)
                self.states_dropped += missed * self.controller.greeted
            self._tick()

    def _listen_until(self, deadline_ns: float) -> float:
        """Take what the host sends until a time, at least once; give how late it is then."""
        while True:
            left_s = max(deadline_ns - time.monotonic_ns(), 0.0) / NS_PER_S
            port = self._port.descriptor
            if self._stalled or port is None:
                time.sleep(left_s)
            elif select.select((port,), (), (), left_s)[0]:
                self._take(self._spoiler.spoil_stream(self._port.read()))
            late_ns = time.monotonic_ns() - deadline_ns
            if late_ns >= 0:
                return late_ns

    def _take(self, chunk: bytes) -> None:
        now_us, controller = self.now_us, self.controller
        for answer in split(controller.receive(chunk, now_us))[:-1]:
            self._send(answer)
        if controller.greetings != self._greetings:
            self._greetings, self._frames = controller.greetings, controller.frames
            self._plug_us = now_us + round(self._faults.unplug_every_s * 1e6)
            self._say("greeted by a host")
            self._greeted_us = now_us if self._greeted_us is None else self._greeted_us
            if controller.info.encoder is Encoder.INCREMENTAL:
                self._carriage.go_back(now_us)
        self._follow_frames()

    def _follow_frames(self) -> None:
        """Have the hand set out once a FRAME has been taken."""
        if self.controller.frames != self._frames:
            self._frames = self.controller.frames
            self._carriage.set_out()

    def _tick(self) -> None:
        now_us, controller = self.now_us, self.controller
        at = self._carriage.at(now_us)
        if self._faults.defect is Defect.OFF_PLACE:
            at = at._replace(way_mm=at.way_mm + _OFF_PLACE_MM)
        self._move_controls(now_us)
        *messages, _ = split(controller.tick(now_us, *at))
        if controller.greeted and self._seeks_mark and not controller.placed:
            # Once more where this computer stood still while the mark was crossed.
            self._carriage.cross(controller.mark_mm, now_us)
        self._follow_frames()
        if messages:  # the last message is STATE
            sent = [self._send(message) for message in messages][-1]
            self.states_sent += sent
            self.states_dropped += not sent
        self._report_watchdog()
        if self._faults.stall_s and now_us >= self._turn_us:
            self._stalled = not self._stalled
            turn_s = self._faults.stall_s if self._stalled else STALL_EVERY_S
            self._turn_us = now_us + round(turn_s * 1e6)
        plugged = self._port.descriptor is not None
        if (
            self._faults.unplug_every_s
            and now_us >= self._plug_us
            and (controller.greeted or not plugged)
        ):
            self._plug(now_us)

    def _move_controls(self, now_us: int) -> None:
        """Have buttons and knobs stand as the script and the keys have moved them."""
        controls, controller = self._controls, self.controller
        since_s = 0.0
        if self._greeted_us is not None:
            since_s = (now_us - self._greeted_us) / 1e6
            controls.advance(since_s)
        if now_us >= self._keys_us:
            self._keys_us = now_us + KEYS_EVERY_US
            for key in self._keys():
                if said := controls.type(key, since_s):
                    self._say(said)
        controller.buttons = controls.buttons
        controller.knobs[:] = controls.knobs[: len(controller.knobs)]

    def _send(self, message: bytes) -> bool:
        spoilt = b"" if self._stalled else self._spoiler.spoil(message)
        return bool(spoilt) and self._port.send(spoilt)

    def _report_watchdog(self) -> None:
        controller = self.controller
        if controller.trips == self._trips or not controller.at_rest:
            return
        self._trips = controller.trips
        assert controller.rest_after_us is not None
        self._say(
            f"watchdog: trip {self._trips}, at rest {controller.rest_after_us / 1000:.1f} ms "
            f"after the last frame"
        )

    def _plug(self, now_us: int) -> None:
        """Unplug the device, or plug it in again."""
        if self._port.descriptor is None:
            self._port.plug()
            self._say(f"plugged in again: {self._port.path}")
        else:
            self._port.unplug()
            self.controller.hang_up()
            self._spoiler.forget()
            self._say("unplugged")
            self._plug_us = now_us + round(UNPLUGGED_S * 1e6)
