"""The loop in a process of its own, seen from its parent."""

from __future__ import annotations

import json
import logging
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
from urllib.parse import parse_qs

from vbraille.devices.events import Back, Stalled, from_json
from vbraille.devices.registry import find_driver
from vbraille.display import Display
from vbraille.engine.engine import EndOfLine, Watcher
from vbraille.engine.record import RingReader, Tally
from vbraille.errors import DeviceError, InputError, VbrailleError
from vbraille.files import open_memory, settings_path
from vbraille.logs import kept
from vbraille.simulation.specs import device_spec
from vbraille.simulation.steering import to_json

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.render.program import Program
    from vbraille.simulation.steering import HandOrder

OPEN_S: Final = 10.0  # that a driver may take to open its device, beside the start of its board
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
        self._wanted = wanted
        self._fits, self._often = fits, often
        self._display: Display | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._socket: socket.socket | None = None
        self._memory = -1  # descriptor of the ring's memory
        self._ring: RingReader | None = None
        self._ring_of: tuple[memoryview, tuple[int, int], int] | None = None
        self._unsent: deque[tuple[bytes, int | None]] = deque()
        self._shown: tuple[Program, int, float | None] | None = None
        self._order: HandOrder | None = None
        self._events: list[Event] = []
        self._fault: VbrailleError | None = None
        self._before, self._lost_before = Tally(), 0  # of earlier starts
        self._paused = False
        self._switches = 0
        self._started = self._at_driver = self._ended = self._stalled = False
        self._ticked_s = 0.0  # when a poll last found a tick

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
        self._before, self._lost_before = self.tally, self.lost
        Watcher.__init__(self)
        self._ring = self._ring_of = self._fault = None
        self._started = self._at_driver = self._ended = self._stalled = False
        self._paused = False
        self._unsent.clear()
        self._memory = open_memory("vbraille", 0)
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
        self._tell(
            device=self._spec,
            wanted=asdict(self._wanted),
            fits=self._fits,
            often=self._often,
            log=kept(),
            settings=str(settings_path().absolute()),
        )

    def start(self) -> Display:
        """Start the process if need be, and wait until ticks run; again after its death.

        Raises
        ------
        VbrailleError
            If the device cannot be opened, or not in time, or is another than at the first start.
        """
        first = self._display
        running = self._process is not None and self._process.poll() is None
        if running and self._started and not self._ended:
            return self.display
        if not running or self._started or self._ended:
            self.launch()
        until_s = None
        while not self._started:
            select.select((self._channel,), (), (), _LOOK_S)
            if not self._hear() and not self._started:
                raise self._ended_by()
            if self._at_driver and until_s is None:
                until_s = time.monotonic() + OPEN_S + self._boot_s()
            if until_s is not None and time.monotonic() > until_s:
                assert self._process is not None
                self._process.kill()
                self._fault = too_slow(self._spec)
                raise self._ended_by()
        if first not in (None, self._display):
            self.close()
            raise InputError(f"{self.display.name} is another device than before; start anew")
        self._ticked_s = time.monotonic()
        if self._shown is not None:
            self.switches = self._switches
            self.show(*self._shown)
            if self._order is not None:
                self.give(self._order)
        return self.display

    def _boot_s(self) -> float:
        """Time that the spec gives a board to start."""
        try:
            return float(parse_qs(self._spec.partition("?")[2])["boot"][0])
        except (KeyError, ValueError):
            return 0.0

    @property
    def _driver(self) -> str:
        return self._spec.partition(":")[0]

    @property
    def _channel(self) -> int:
        assert self._socket is not None
        return self._socket.fileno()

    @property
    def process_id(self) -> int | None:
        """Number of the host process."""
        return None if self._process is None else self._process.pid

    @property
    def display(self) -> Display:
        """The actuators and the carriage of the device; known once the host is started."""
        if self._display is None:
            raise DeviceError("no device is open; start the host first")
        return self._display

    @property
    def tally(self) -> Tally:
        """Counts of what the loops have done, up to the last poll, over all starts of the host."""
        newest = self.newest
        return self._before if newest is None else self._before + Tally.of(newest)

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
        self._shown, self._line = (picture, line, end_mm), line
        self._end = None if end_mm is None else EndOfLine(self.display.span_mm, end_mm)
        memory = open_memory("vbraille-picture", max(picture.nbytes, 1))
        for part, at in ((picture.numbers, 0), (picture.table, picture.numbers.nbytes)):
            _write(memory, part.tobytes(), at)
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
        if self._ring_of is None:
            raise DeviceError("no device is open; start the host first")
        return RingReader(*self._ring_of)

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
        ticks = self._ring.drain()
        self.lost = self._lost_before + self._ring.lost
        self.watch(ticks, self.display)
        if not ticks.size and not alive:
            raise self._ended_by()
        self._look(ticks.size > 0)
        return ticks

    def _look(self, ticked: bool) -> None:
        """Tell once that the driver holds up the loop, and once that it does no more."""
        now_s = time.monotonic()
        if ticked:
            self._ticked_s = now_s
            if self._stalled:
                self._events.append(Back())
            self._stalled = False
        elif not self._stalled and now_s - self._ticked_s > _STALL_S:
            self._stalled = True
            self._events.append(Stalled(now_s - self._ticked_s))

    def take_events(self) -> Sequence[Event]:
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
        if process is None or self._socket is None:
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
        for _, descriptor in self._unsent:
            if descriptor is not None:
                os.close(descriptor)
        self._unsent.clear()
        if self._memory >= 0:
            os.close(self._memory)
            self._memory = -1
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

    def _tell(self, descriptor: int | None = None, **what: object) -> None:
        """Send the host a message, with a descriptor that is closed once it is sent."""
        self._unsent.append((json.dumps(what).encode(), descriptor))
        self._flush()

    def _flush(self) -> None:
        """Send what a host that is held up had no room for."""
        if self._socket is None:
            return
        while self._unsent:
            message, descriptor = self._unsent[0]
            try:
                socket.send_fds(self._socket, [message], [] if descriptor is None else [descriptor])
            except BlockingIOError:
                return
            except OSError:
                pass  # the host has ended, and `_hear` will tell why
            if descriptor is not None:
                os.close(descriptor)
            self._unsent.popleft()

    def _hear(self) -> bool:
        """Take the host's messages; tell whether more may come."""
        assert self._socket is not None
        assert self._process is not None
        # Asked before reading: all that a process said which has ended is there by then.
        ended = self._process.poll() is not None
        for _ in range(1000):
            try:
                message = self._socket.recv(_MOST_BYTES)
            except BlockingIOError:
                return not ended
            except OSError:
                return False
            if not message:
                return False
            self._take(json.loads(message))
        return True

    def _take(self, told: dict[str, Any]) -> None:
        self._at_driver = self._at_driver or "opening" in told
        if "ready" in told:
            display = self._display = Display(**told["ready"])
            self.calibration, self.steered = told["calibration"], told["steered"]
            memory = mmap.mmap(self._memory, 0)
            self._ring_of = memoryview(memory), display.shape, told["ticks"]
            self._ring = RingReader(*self._ring_of)
            self._started = True
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
                self._fault = DeviceError(
                    f"the driver {self._driver} did not let the device go within {_END_S:g} s, "
                    f"and was ended; switch the device off if it does not rest, and tell the "
                    f"driver's author"
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


def too_slow(spec: str) -> DeviceError:
    """Fault of a driver that has not opened its device in `OPEN_S`."""
    return DeviceError(
        f"the driver {spec.partition(':')[0]} did not open its device within {OPEN_S:g} s; see "
        f"whether the device is there and switched on, or tell the driver's author"
    )


def _write(descriptor: int, content: bytes, at: int) -> None:
    done = 0
    while done < len(content):
        done += os.pwrite(descriptor, content[done:], at + done)
