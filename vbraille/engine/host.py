"""The loop in a process of its own, seen from its parent."""

from __future__ import annotations

import json
import logging
import math
import mmap
import os
import select
import socket
import subprocess
import sys
import time
from collections import deque
from contextlib import suppress
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, Final, Self

from vbraille.devices.events import Back, Stalled, from_json
from vbraille.devices.registry import find_driver
from vbraille.display import Display
from vbraille.engine.engine import Watcher
from vbraille.engine.record import RingReader
from vbraille.errors import DeviceError, InputError, VbrailleError
from vbraille.files import open_memory, settings_path
from vbraille.logs import kept
from vbraille.simulation.specs import device_spec
from vbraille.simulation.steering import to_json

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.render.program import Program
    from vbraille.simulation.steering import HandOrder

OPEN_S: Final = 10.0  # that a driver may take to open its device
BOOT_S: Final = 60.0  # that a board may take besides, whose address says how long
_END_S: Final = 5.0  # that fading takes, and letting a device go that may be gone
_STALL_S: Final = 1.0  # after which a loop that has done no tick is held up by its driver
_LOOK_S: Final = 0.1  # between looks whether the process is still there
_MOST_BYTES: Final = 1 << 16
_log = logging.getLogger(__name__)


class HostDiedError(VbrailleError):
    """The host process ended without a word; `Host.start` begins another."""


class Host(Watcher):
    """An engine whose loop has a process of its own; a context manager.

    No other work of the program can hold up such a loop.

    Parameters
    ----------
    spec
        The device, as `vbraille.devices.open_device` takes it.
    wanted
        The actuators, travel and rate that pages are laid out for.
    hand, seed
        Hand that moves a simulated device, and seed of what is random in it; None for the hand of
        the spec.
    fits
        Whether the device must have those actuators; otherwise they are a wish, which a simulated
        device fulfils and a real one need not.
    often
        Whether the device must take frames at that rate; otherwise the loop goes at the device's
        own rate where that is lower.

    Attributes
    ----------
    counts : dict[str, int]
        Counts of what went wrong with the device, by name; known after `close`.
    lost : int
        Number of ticks that were never polled, because the parent was away for too long.
    calibration : dict or None
        What is made up for in the device's actuators, as `Calibration.to_json` says it; known once
        the device is open, and None if deflections are sent as they are.
    steered : bool
        Whether a simulated hand moves the device, and takes orders.
    """

    def __init__(
        self,
        spec: str,
        wanted: Display,
        *,
        hand: str | None = None,
        seed: int = 1,
        fits: bool = True,
        often: bool = True,
    ) -> None:
        super().__init__()
        self.counts: dict[str, int] = {}
        self.lost = 0
        self.calibration: dict[str, Any] | None = None
        self.steered = False
        self._spec = device_spec(spec, hand, seed)
        self._wanted = {"wanted": asdict(wanted), "fits": fits, "often": often}
        self._display: Display | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._shown: tuple[Program, int, float | None] | None = None
        self._order: HandOrder | None = None
        self._paused, self._switches = False, 0

    def launch(self) -> None:
        """Start the process without waiting for it; `start` waits, once other work is done.

        Raises
        ------
        InputError
            If there is no such kind of device.
        """
        find_driver(self._spec)  # before a process is begun for what is not there
        if self._process is not None:
            self.close()
        Watcher.__init__(self)
        self._ring: RingReader | None = None
        self._fault: VbrailleError | None = None
        self._events: list[Event] = []
        self._unsent: deque[tuple[bytes, list[int]]] = deque()
        self._at_driver = self._ended = self._stalled = self._paused = False
        self._ticked_s = 0.0  # when a poll last found a tick
        self._memory = open_memory("vbraille", 0)  # the ring's
        self._socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        descriptors = theirs.fileno(), self._memory
        self._process = subprocess.Popen(
            [sys.executable, "-m", "vbraille.engine.hostprocess"]
            + [str(number) for number in (*descriptors, os.getpid())],
            stdin=subprocess.DEVNULL,
            stdout=2,  # what a driver prints is no answer of the program
            pass_fds=descriptors,
        )
        theirs.close()
        self._socket.setblocking(False)
        _log.info("started process %d to drive %s", self._process.pid, self._spec)
        settings = str(settings_path().absolute())
        self._tell(device=self._spec, settings=settings, log=kept(), **self._wanted)

    def start(self) -> Display:
        """Start the process if need be, and wait until ticks run; again after its death.

        Raises
        ------
        VbrailleError
            If the device cannot be opened, or not in time, or is another than at the first start.
        """
        first = self._display
        if self._process is None or self._ended or self._process.poll() is not None:
            self.launch()
        elif self._ring is not None:
            return self.display
        # A driver may take so long, and its board as long as it boots.
        most_s = OPEN_S + (BOOT_S if "boot=" in self._spec else 0.0)
        until_s = math.inf
        while self._ring is None:
            select.select((self._socket,), (), (), _LOOK_S)
            if not self._hear() and self._ring is None:
                raise self._ended_by()
            if self._at_driver and until_s == math.inf:
                until_s = time.monotonic() + most_s
            if time.monotonic() > until_s:
                assert self._process is not None
                self._process.kill()
                self._fault = DeviceError(
                    f"the driver {self._spec.partition(':')[0]} did not open its device within "
                    f"{most_s:g} s; see whether the device is there and switched on, or tell the "
                    f"driver's author"
                )
                raise self._ended_by()
        if first not in (None, self._display):
            self.close()
            raise InputError(
                f"{self.display.name} is not the device that was there before; start again"
            )
        self._ticked_s = time.monotonic()
        if self._shown is not None:
            self.switches = self._switches
            self.show(*self._shown)
            if self._order is not None:
                self.give(self._order)
        return self.display

    @property
    def display(self) -> Display:
        """The actuators and the carriage of the device; known once the host is started."""
        if self._display is None:
            raise DeviceError("no device is open; start the host first")
        return self._display

    @property
    def paused(self) -> bool:
        """Tell whether the array is to rest."""
        return self._paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self._paused = paused
        self._tell(paused=paused)

    @property
    def switches(self) -> int:
        """States of a scene's switches; setting them takes effect with the next tick."""
        return self._switches

    @switches.setter
    def switches(self, switches: int) -> None:
        self._switches = switches
        self._tell(switches=switches)

    def show(self, picture: Program, line: int, end_mm: float | None = None) -> None:
        """Put a picture of a line under the hand.

        Parameters
        ----------
        picture
            Picture that is shown; it fades in.
        line
            Number of the line in the records, from 1.
        end_mm
            Right edge of the line's last dot; a `LineRead` event tells that the hand was there and
            is back. None for what ends nowhere.

        Raises
        ------
        ValueError
            If the picture was compiled for another array.
        """
        picture.check_shape(self.display.shape)
        self._shown = picture, line, end_mm
        self.wait_for(line, end_mm, self.display)
        memory = open_memory("vbraille-picture", max(picture.nbytes, 1))
        with os.fdopen(os.dup(memory), "wb") as out:
            out.write(picture.numbers.tobytes())
            out.write(picture.table.tobytes())
        sizes = picture.numbers.size, picture.table.size
        self._tell(memory, show={"line": line, "sizes": sizes})

    def give(self, order: HandOrder) -> None:
        """Tell a simulated hand what to do; nothing happens where a person moves the device."""
        if self.steered:
            self._order = order
            self._tell(hand=to_json(order).decode())

    def set_zero(self) -> None:
        """Say that the carriage is at the left stop now."""
        self._tell(zero=True)

    def reader(self) -> RingReader:
        """Make another reader of the records, for what watches beside; it only reads."""
        assert self._ring is not None, "it is started"
        return self._ring.another()

    def poll(self) -> NDArray[np.void]:
        """Give the records of all ticks since the last poll.

        Raises
        ------
        VbrailleError
            If the loop has ended: the fault of the device, or `HostDiedError`.
        """
        self._flush()
        alive = self._hear()
        if self._ring is None:
            raise self._ended_by()
        lost = self._ring.lost
        ticks = self._ring.drain()
        self.lost += self._ring.lost - lost
        self.watch(ticks, self.display)
        if not ticks.size and not alive:
            raise self._ended_by()
        now_s = time.monotonic()
        if ticks.size:
            self._ticked_s = now_s
            self._events += [Back()] * self._stalled
            self._stalled = False
        elif not self._stalled and now_s - self._ticked_s > _STALL_S:
            self._stalled = True  # its driver holds up the loop
            self._events.append(Stalled(now_s - self._ticked_s))
        return ticks

    def take_events(self) -> list[Event]:
        """Take the events of the device, its loop and its ticks since the last call."""
        events, self._events = self._events, []
        return events + self._take_found()

    def close(self) -> None:
        """Have the host bring the array to rest and end; further calls do nothing.

        Raises
        ------
        VbrailleError
            If the device could not be let go. An error that is under way is more, and goes on.
        """
        process = self._process
        if process is None:
            return
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_WR)  # the host takes this for the end
        code = self._reap()
        _log.info("process %d has ended: exit code %d", process.pid, code)
        while self._hear():
            pass
        # A host that still compiles may be ended like this; one whose end was told is told of once.
        well = self._ended or not self._at_driver or (code == 0 and self._fault is None)
        fault = None if well else self._ended_by()
        self._process = None
        self._socket.close()
        for descriptor in (self._memory, *(each for _, some in self._unsent for each in some)):
            os.close(descriptor)
        if fault is not None and sys.exc_info()[0] is None:
            raise fault

    def __enter__(self) -> Self:
        try:
            self.start()
        except BaseException:  # a signal, too
            self.close()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _tell(self, *descriptors: int, **what: object) -> None:
        """Send the host a message, with a descriptor that is closed once it is sent."""
        if self._process is not None:
            self._unsent.append((json.dumps(what).encode(), list(descriptors)))
            self._flush()

    def _flush(self) -> None:
        """Send what a host that is held up had no room for."""
        while self._process is not None and self._unsent:
            message, descriptors = self._unsent[0]
            try:
                socket.send_fds(self._socket, [message], descriptors)
            except BlockingIOError:
                return
            except OSError:
                pass  # the host has ended, and `_hear` will tell why
            for descriptor in descriptors:
                os.close(descriptor)
            self._unsent.popleft()

    def _hear(self) -> bool:
        """Take the host's messages; tell whether more may come."""
        assert self._process is not None
        # Asked before reading: all that a process said which has ended is there by then.
        ended = self._process.poll() is not None
        while True:
            try:
                message = self._socket.recv(_MOST_BYTES)
            except BlockingIOError:
                return not ended
            except OSError:
                return False
            if not message:
                return False
            self._take(json.loads(message))

    def _take(self, told: dict[str, Any]) -> None:
        self._at_driver = self._at_driver or "opening" in told
        if "ready" in told:
            display = self._display = Display(**told["ready"])
            self.calibration, self.steered = told["calibration"], told["steered"]
            memory = memoryview(mmap.mmap(self._memory, 0))
            self._ring = RingReader(memory, display.shape, told["ticks"])
        if told.get("event"):
            self._events.append(from_json(json.dumps(told["event"])))
        if "fault" in told:
            kind = InputError if told["code"] == InputError.exit_code else DeviceError
            self._fault = kind(told["fault"])
        self.counts = told.get("counts", self.counts)

    def _reap(self) -> int:
        """Wait for the process to end, kill it if that takes too long, and return its exit code."""
        assert self._process is not None
        try:
            return self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            if self._fault is None and self._at_driver:
                driver = self._spec.partition(":")[0]
                self._fault = DeviceError(
                    f"the driver {driver} did not let the device go within {_END_S:g} s, and was "
                    f"ended; switch the device off if it does not rest, and tell the driver's "
                    f"author"
                )
            return self._process.wait()

    def _ended_by(self) -> VbrailleError:
        """Reason why there is no host any more."""
        code = self._reap()
        self._ended = True
        # An exception that is kept would keep all frames of its traceback alive.
        fault, self._fault = self._fault, None
        if fault is not None:
            return fault
        how = f"killed by signal {-code}" if code < 0 else f"exit code {code}"
        return HostDiedError(f"the process that drives the device has ended ({how})")
