"""The loop in a process of its own, seen from its parent."""

from __future__ import annotations

import json
import logging
import os
import select
import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any, Self

from vbraille.devices.events import Back, Stalled, from_json
from vbraille.display import Display
from vbraille.engine.engine import place_of
from vbraille.engine.mailbox import RING_S, Extent, attach, watch
from vbraille.engine.record import RingReader, Tally
from vbraille.engine.spawning import spawn
from vbraille.errors import DeviceError, InputError, VbrailleError
from vbraille.files import settings_path
from vbraille.logs import kept, tracebacks_wanted

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.engine.mailbox import Mailbox
    from vbraille.engine.record import RingReader
    from vbraille.engine.spawning import Spawned
    from vbraille.render.program import Program

# Opening may take a second or two; a controller that starts up, or a name that must be found, more.
OPEN_S = 10.0
OPENING = "open its device"
# Fading takes 0.1 s; a driver may have to wait for a device that is gone.
_END_S = 5.0
# A loop that has done no tick for so long is held up by its driver.
_STALL_S = 1.0
# How long to wait for an answer before looking whether there is a process that could give it.
_LOOK_S = 0.1
_log = logging.getLogger(__name__)


class HostDiedError(VbrailleError):
    """The host process ended without a word; `Host.start` begins another."""


def too_slow(device: str, what: str) -> DeviceError:
    """Fault of a driver that has not opened its device, or done a first tick, in `OPEN_S`."""
    return DeviceError(
        f"the driver {device.partition(':')[0]} did not {what} within {OPEN_S:g} s; see whether "
        f"the device is there and switched on, or tell the driver's author"
    )


class Host:
    """An `Engine` whose loop has a process of its own; it is a context manager.

    No other work of the program can hold up such a loop.

    Parameters
    ----------
    device
        The device's spec, as `vbraille.devices.open_device` takes it.
    wanted
        The actuators, travel and rate that the page was laid out for. If ``room`` is None they
        are a wish, which a simulated device fulfils and a real one need not.
    room
        Bytes of the largest picture; None if pictures are made for the device that is found:
        `open` it, then tell `fit`, then `start`.
    often
        Whether the device must take frames at that rate; otherwise the loop goes at the device's
        own rate where that is lower.
    pass_fds
        Descriptors that the process inherits, for its device: the spec names them.
    spawned
        Process that was begun for the first start, with those descriptors; None to begin it then.

    Attributes
    ----------
    newest : record or None
        Record of the last tick polled.
    counts : dict[str, int]
        Counts of what went wrong with the device, by name; known after `close`.
    lost : int
        Number of ticks that were never polled, because the parent was away for too long.
    calibration : dict or None
        What is made up for in the device's actuators, as `Calibration.to_json` says it; known once
        the device is open, and None if deflections are sent as they are.
    on_share : callable or None
        Function that is called, at each start, with a descriptor of the memory that is shared,
        which is closed after the call, and what decides its size; for others who watch.
    """

    def __init__(
        self,
        device: str,
        wanted: Display,
        room: int | None = None,
        *,
        often: bool = True,
        pass_fds: Sequence[int] = (),
        spawned: Spawned | None = None,
    ) -> None:
        self.newest: np.void | None = None
        self.counts: dict[str, int] = {}
        self.lost = 0
        self.calibration: dict[str, Any] | None = None
        self.on_share: Callable[[int, Extent], None] | None = None
        self._device = device
        self._wanted = wanted
        self._room = room
        self._often = often
        self._pass_fds = tuple(pass_fds)
        self._spawned = spawned
        self._info: Display | None = None
        self._first: Display | None = None  # what the device was at the first start
        self._process: subprocess.Popen[bytes] | None = None
        self._descriptor: int | None = None  # shared memory that is not mapped here yet
        self._mailbox: Mailbox | None = None
        self._ring: RingReader | None = None
        self._shown: tuple[Program, int] | None = None
        self._events: list[Event] = []
        self._heard = b""
        self._fault: VbrailleError | None = None
        self._before = Tally()
        self._lost_before = 0
        self._paused = False
        self._switches = 0
        self._launched = self._ready = False
        self._at_driver = False  # whether all is compiled and loaded, and the driver has its turn
        self._ended = False  # whether its end was told
        self._empty_s: float | None = None  # since when polls have found no tick
        self._stalled = False

    def open(self) -> Display:
        """Start the process, wait until it has opened the device, and tell what that device is.

        The device is read, and sent nothing, until `start`.

        Raises
        ------
        VbrailleError
            If the device cannot be opened, or not in time, or is another than at the first start.
        """
        if not self._launched:
            self.launch()
        self._wait(lambda: self._info is not None, OPENING)
        assert self._info is not None
        if self._first not in (None, self._info):
            raise InputError(f"{self._info.name} is another device than before; start anew with it")
        return self._info

    def fit(self, display: Display, room: int) -> None:
        """Say how many bytes a picture may take at most, and what the device must be."""
        self._wanted = replace(display, rate_hz=self._wanted.rate_hz)
        self._room = room
        if self._launched:
            self._share()

    def start(self) -> None:
        """Start the process, and wait until it has opened the device; again after its death.

        Raises
        ------
        VbrailleError
            If the device cannot be opened, or not in time, or is another than at the first start.
        """
        self._first = self.open()
        self._wait(lambda: self._ready, "do a first tick")
        self._launched = False
        if self._shown is not None:
            self._posted.switches = self._switches
            self._posted.post(*self._shown)

    def launch(self) -> None:
        """Start the process without waiting for it; `start` waits, once other work is done.

        The system ends the process with the thread that calls this.
        """
        if self._process is not None:
            self.close()
        self._launched = True
        if self.newest is not None:
            self._before, self._lost_before = self.tally, self.lost
        self._info = self._fault = self.newest = None
        self._paused = self._ready = False
        self._at_driver = self._ended = self._stalled = False
        self._empty_s = None
        self._heard = b""
        spawned, self._spawned = self._spawned or spawn(self._pass_fds), None
        spawned.taken = True
        self._process, self._descriptor = spawned.process, spawned.descriptor
        _log.info("started process %d to drive %s", self._process.pid, self._device)
        os.set_blocking(self._answers(), False)
        self._tell(
            device=self._device,
            wanted=asdict(self._wanted),
            fits=self._room is not None,
            often=self._often,
            log=kept(),
            verbose=tracebacks_wanted(),
            settings=str(settings_path().absolute()),
        )
        if self._room is not None:
            self._share()

    def _share(self) -> None:
        """Share memory for pictures and records, whose size is known by now."""
        assert self._descriptor is not None
        assert self._room is not None
        wanted = self._wanted
        ticks = round(RING_S * wanted.rate_hz)
        extent = Extent(wanted.rows, wanted.columns, self._room, ticks)
        memory = attach(self._descriptor, extent)
        if self.on_share is not None:
            self.on_share(self._descriptor, extent)
        self._forget_memory()
        self._mailbox, self._ring = watch(memory, extent)
        self._tell(**asdict(extent))

    def _tell(self, **what: object) -> None:
        """Send the host a line on its standard input."""
        assert self._process is not None
        assert self._process.stdin is not None
        with suppress(BrokenPipeError):  # the host has ended, and `_hear` will tell why
            self._process.stdin.write(json.dumps(what).encode() + b"\n")
            self._process.stdin.flush()

    @property
    def _posted(self) -> Mailbox:
        """The mailbox to which orders go; there is one once the host is started."""
        if self._mailbox is None:
            raise DeviceError("no device is open; start the host first")
        return self._mailbox

    @property
    def _driver(self) -> str:
        """Name of the driver in sentences."""
        return self._device.partition(":")[0]

    def reader(self) -> RingReader:
        """Make another reader of the records, for a live view."""
        if self._ring is None:
            raise DeviceError("no device is open; start the host first")
        return self._ring.another()

    @property
    def process_id(self) -> int | None:
        """Number of the host process."""
        return None if self._process is None else self._process.pid

    @property
    def display(self) -> Display:
        """The actuators and the carriage of the device; known once the host is started."""
        if self._info is None:
            raise DeviceError("no device is open; start the host first")
        return self._info

    @property
    def tally(self) -> Tally:
        """Counts of what the loops have done, up to the last poll, over all starts of the host."""
        return self._before if self.newest is None else self._before + Tally.of(self.newest)

    @property
    def x_mm(self) -> float | None:
        """Place of the array's centre at the last poll; None before it is known."""
        return place_of(self.newest)

    @property
    def paused(self) -> bool:
        """Tell whether the array is to rest."""
        return self._paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self._paused = self._posted.paused = paused

    @property
    def switches(self) -> int:
        """States of a scene's switches; setting them takes effect with the next tick."""
        return self._switches

    @switches.setter
    def switches(self, switches: int) -> None:
        self._switches = self._posted.switches = switches

    def show(self, picture: Program, line: int) -> None:
        """Put a picture of a line under the hand; see `Engine`.

        Raises
        ------
        ValueError
            If the picture was compiled for another array, or is larger than there is room for.
        """
        picture.check_shape(self.display.shape)
        self._shown = picture, line
        self._posted.post(picture, line)

    def set_zero(self) -> None:
        """Say that the carriage is at the left stop now."""
        self._posted.zero()

    def poll(self) -> NDArray[np.void]:
        """Give the records of all ticks since the last poll.

        Raises
        ------
        VbrailleError
            If the loop has ended: the fault of the device, or `HostDiedError`.
        """
        alive = self._hear()
        if self._ring is None:
            raise self._end()
        ticks = self._ring.drain()
        self.lost = self._lost_before + self._ring.lost
        if ticks.size:
            self.newest = ticks[-1]
        elif not alive:
            raise self._end()
        self._look(ticks.size > 0)
        return ticks

    def _look(self, ticked: bool) -> None:
        """Tell once that the driver holds up the loop, and once that it does no more."""
        now_s = time.monotonic()
        if ticked:
            self._empty_s = None
            if self._stalled:
                self._stalled = False
                self._events.append(Back())
        elif self._empty_s is None:
            self._empty_s = now_s
        elif not self._stalled and now_s - self._empty_s > _STALL_S:
            self._stalled = True
            self._events.append(Stalled(1e3 * (now_s - self._empty_s)))

    def take_events(self) -> Sequence[Event]:
        """Take the events of the device and its host since the last call."""
        events, self._events = self._events, []
        return events

    def close(self) -> None:
        """Have the host bring the array to rest and end; further calls do nothing.

        Raises
        ------
        VbrailleError
            If the device could not be let go. An error that is under way is more, and goes on.
        """
        process = self._process
        if process is None:
            if self._spawned is not None:
                self._spawned.end()
                self._spawned = None
            return
        if self._mailbox is not None:
            self._mailbox.stop()
        if process.stdin is not None:
            with suppress(BrokenPipeError):
                process.stdin.close()  # a host that still waits to be told more ends by this, too
        code = self._reap()
        _log.info("process %d has ended: exit code %d", process.pid, code)
        while self._hear():
            pass
        # A host that still compiles may be ended like this; one whose end was told is told of once.
        well = self._ended or not self._at_driver or (code == 0 and self._fault is None)
        fault = None if well else self._end()
        if process.stdout is not None:
            process.stdout.close()
        self._process = None
        self._forget_memory()
        if fault is not None:
            _log.info("closing failed: %s", fault)
            if sys.exc_info()[0] is None:
                raise fault

    def _forget_memory(self) -> None:
        self._mailbox = self._ring = None  # the view of shared memory holds a descriptor
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None

    def __enter__(self) -> Self:
        try:
            self.start()
        except BaseException:  # a signal, too
            self.close()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _answers(self) -> int:
        assert self._process is not None
        assert self._process.stdout is not None
        return self._process.stdout.fileno()

    def _wait(self, done: Callable[[], bool], what: str) -> None:
        """Wait until the driver has done something; if it never will, raise the reason."""
        assert self._process is not None
        until_s = None
        while not done():
            select.select((self._answers(),), (), (), _LOOK_S)
            if not self._hear():
                raise self._end()
            if not self._at_driver:
                continue
            if until_s is None:
                until_s = time.monotonic() + OPEN_S
            elif time.monotonic() > until_s:
                self._process.kill()
                self._fault = too_slow(self._device, what)
                raise self._end()

    def _hear(self) -> bool:
        """Take the host's answers; tell whether more may come.

        No more come once the process has ended and all that it said was read, even if the pipe is
        still open: a program that a driver started may hold its other end.
        """
        assert self._process is not None
        # Asked before reading: all that a process said which has ended is there by then.
        ended = self._process.poll() is not None
        try:
            said = os.read(self._answers(), 1 << 16)
        except BlockingIOError:
            return not ended
        *lines, self._heard = (self._heard + said).split(b"\n")
        for line in lines:
            self._take(json.loads(line))
        return bool(said)

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

    def _take(self, answer: dict[str, Any]) -> None:
        if "opened" in answer:
            self._info = Display(**answer["opened"])
            self.calibration = answer["calibration"]
        self._at_driver = self._at_driver or "opening" in answer
        self._ready = self._ready or "ready" in answer
        if answer.get("event"):
            self._events.append(from_json(answer["event"]))
        if "fault" in answer:
            kind = InputError if answer["code"] == InputError.exit_code else DeviceError
            self._fault = kind(answer["fault"])
        self.counts = answer.get("counts", self.counts)

    def _end(self) -> VbrailleError:
        """Reason why there is no host any more."""
        code = self._reap()
        self._ended = True
        # An exception that is kept would keep all frames of its traceback alive.
        fault, self._fault = self._fault, None
        if fault is not None:
            return fault
        how = f"killed by signal {-code}" if code < 0 else f"exit code {code}"
        return HostDiedError(f"the process that drives the device has ended ({how})")
