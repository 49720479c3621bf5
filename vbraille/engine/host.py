"""The loop in a process of its own, seen from its parent."""

from __future__ import annotations

import json
import logging
import os
import select
import subprocess
import sys
from contextlib import suppress
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any, Self

from vbraille.devices.events import from_json
from vbraille.display import Display
from vbraille.engine import shared
from vbraille.engine.engine import place_of
from vbraille.engine.ring import RingReader
from vbraille.engine.tally import Tally
from vbraille.errors import DeviceError, InputError, VbrailleError
from vbraille.logs import kept

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.engine.mailbox import Mailbox
    from vbraille.engine.ring import RingReader
    from vbraille.render.program import Program

# Fading takes 0.1 s; a driver may have to wait for a device that is gone.
_END_S = 5.0
# How long to wait for an answer before looking whether there is a process that could give it.
_LOOK_S = 0.1
_log = logging.getLogger(__name__)


class HostDiedError(VbrailleError):
    """The host process ended without a word; `Host.start` begins another."""


class Host:
    """An `Engine` whose loop no other work of the program holds up. A context manager.

    Parameters
    ----------
    device
        Spec, as of `vbraille.devices.open_device`.
    wanted
        The actuators, travel and rate that the page was laid out for. With no room given they are
        a wish, which a simulated device fulfils; a real one is what it is.
    room
        Bytes of the largest picture; None if pictures are made for the device that is found:
        `open` it, then tell `fit`, then `start`.
    pass_fds
        Descriptors that the process inherits, for its device: the spec names them.

    Attributes
    ----------
    newest : record or None
        The last tick polled.
    counts : dict[str, int]
        What went wrong with the device, by name; known after `close`.
    lost : int
        Ticks that were never polled: the parent was away for too long.
    """

    def __init__(
        self,
        device: str,
        wanted: Display,
        room: int | None = None,
        *,
        pass_fds: Sequence[int] = (),
    ) -> None:
        self.newest: np.void | None = None
        self.counts: dict[str, int] = {}
        self.lost = 0
        self._device = device
        self._wanted = wanted
        self._room = room
        self._pass_fds = tuple(pass_fds)
        self._info: Display | None = None
        self._first: Display | None = None  # what the device was at the first start
        self._process: subprocess.Popen[bytes] | None = None
        self._descriptor: int | None = None  # of memory that nobody has a view of yet
        self._mailbox: Mailbox | None = None
        self._ring: RingReader | None = None
        self._shown: tuple[Program, int] | None = None
        self._events: list[Event] = []
        self._heard = b""
        self._fault: VbrailleError | None = None
        self._before = Tally()
        self._lost_before = 0
        self._paused = False
        self._launched = self._ready = False

    def open(self) -> Display:
        """Start the process, and wait until it has opened the device: what that is like.

        The device is read, and sent nothing, until `start`.

        Raises
        ------
        VbrailleError
            If the device cannot be opened, or is another than at the first start.
        """
        if not self._launched:
            self.launch()
        while self._info is None:
            self._wait()
        if self._first not in (None, self._info):
            raise InputError(f"{self._info.name} is another device than before; start anew with it")
        return self._info

    def fit(self, display: Display, room: int) -> None:
        """Have pictures of so many bytes at most, for a device that is as this says."""
        self._wanted = replace(display, rate_hz=self._wanted.rate_hz)
        self._room = room
        if self._launched:
            self._share()

    def start(self) -> None:
        """Start the process, and wait until it has opened the device; again after its death.

        Raises
        ------
        VbrailleError
            If the device cannot be opened, or is another than at the first start.
        """
        self._first = self.open()
        while not self._ready:
            self._wait()
        self._launched = False
        if self._shown is not None:
            self._posted.post(*self._shown)

    def launch(self) -> None:
        """Start the process and wait for nothing: `start` does, when there is no more to do.

        The system ends the process with the thread that calls this.
        """
        self.close()
        self._launched = True
        if self.newest is not None:
            self._before, self._lost_before = self.tally, self.lost
        self._info = self._fault = self.newest = None
        self._paused = self._ready = False
        self._heard = b""
        self._descriptor = shared.create()
        self._process = subprocess.Popen(
            [sys.executable, "-m", "vbraille.engine.hosted", str(self._descriptor)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            pass_fds=(self._descriptor, *self._pass_fds),
        )
        _log.info("started process %d to drive %s", self._process.pid, self._device)
        os.set_blocking(self._answers(), False)
        self._tell(
            device=self._device,
            wanted=asdict(self._wanted),
            fits=self._room is not None,
            parent=os.getpid(),
            log=kept(),
        )
        if self._room is not None:
            self._share()

    def _share(self) -> None:
        """Share memory for lines and records, now that it is known how much."""
        assert self._descriptor is not None
        assert self._room is not None
        wanted = self._wanted
        ticks = round(shared.RING_S * wanted.rate_hz)
        extent = shared.Extent(wanted.rows, wanted.columns, self._room, ticks)
        memory = shared.attach(self._descriptor, extent)
        self._forget_memory()
        self._mailbox, self._ring = shared.watch(memory, extent)
        self._tell(**asdict(extent))

    def _tell(self, **what: object) -> None:
        """Tell the host something on its standard input, in a line."""
        assert self._process is not None
        assert self._process.stdin is not None
        with suppress(BrokenPipeError):  # it has ended, and says why
            self._process.stdin.write(json.dumps(what).encode() + b"\n")
            self._process.stdin.flush()

    @property
    def _posted(self) -> Mailbox:
        """The mailbox, which is there once the host was started."""
        if self._mailbox is None:
            raise DeviceError("no device is open; start the host first")
        return self._mailbox

    @property
    def process_id(self) -> int | None:
        """The number of the host's process."""
        return None if self._process is None else self._process.pid

    @property
    def display(self) -> Display:
        """What the device says of itself; known once started."""
        if self._info is None:
            raise DeviceError("no device is open; start the host first")
        return self._info

    @property
    def tally(self) -> Tally:
        """What its loops have done, as far as they were polled."""
        return self._before if self.newest is None else self._before + Tally.of(self.newest)

    @property
    def x_mm(self) -> float | None:
        """Where the array's centre was at the last poll; None before it is known."""
        return place_of(self.newest)

    @property
    def paused(self) -> bool:
        """Whether the array is to rest."""
        return self._paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self._paused = self._posted.paused = paused

    def show(self, picture: Program, line: int) -> None:
        """Put a picture of a line under the hand; see `Engine`.

        Raises
        ------
        ValueError
            If it was compiled for another array, or is larger than there is room for.
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
            If the loop has ended: the device's fault, or `HostDiedError`.
        """
        alive = self._hear()
        if self._ring is None:
            raise self._end()
        ticks = self._ring.drain()
        self.lost = self._lost_before + self._ring.lost
        if ticks.size:
            self.newest = ticks[-1]
        if not alive and not ticks.size:
            raise self._end()
        return ticks

    def take_events(self) -> Sequence[Event]:
        """What the device and its host have to tell since the last call."""
        events, self._events = self._events, []
        return events

    def close(self) -> None:
        """Have the host bring the array to rest and end; further calls do nothing."""
        process = self._process
        if process is None:
            return
        if self._mailbox is not None:
            self._mailbox.stop()
        if process.stdin is not None:
            with suppress(BrokenPipeError):
                process.stdin.close()  # one that waits to be told more ends, too
        code = self._reap()
        _log.info("process %d has ended: exit code %d", process.pid, code)
        while self._hear():
            pass
        if process.stdout is not None:
            process.stdout.close()
        self._process = None
        self._forget_memory()

    def _forget_memory(self) -> None:
        self._mailbox = self._ring = None  # whose memory holds a descriptor
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

    def _wait(self) -> None:
        """Wait for an answer, for a moment; raise why there is no host if it has ended."""
        select.select((self._answers(),), (), (), _LOOK_S)
        if not self._hear():
            raise self._end()

    def _hear(self) -> bool:
        """Take the host's answers; whether more may come.

        None come once the process has ended and all that it said was read: somebody else, whom
        a driver started, may hold the other end of the pipe for as long as he likes.
        """
        assert self._process is not None
        ended = self._process.poll() is not None  # asked first: whatever it said is there then
        try:
            said = os.read(self._answers(), 1 << 16)
        except BlockingIOError:
            return not ended
        *lines, self._heard = (self._heard + said).split(b"\n")
        for line in lines:
            self._take(json.loads(line))
        return bool(said)

    def _reap(self) -> int:
        """Wait for the process's end, and bring it about if it takes too long; its exit code."""
        assert self._process is not None
        try:
            return self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            return self._process.wait()

    def _take(self, answer: dict[str, Any]) -> None:
        if "opened" in answer:
            self._info = Display(**answer["opened"])
        self._ready = self._ready or "ready" in answer
        if answer.get("event"):
            self._events.append(from_json(answer["event"]))
        if "fault" in answer:
            kind = InputError if answer["code"] == InputError.exit_code else DeviceError
            self._fault = kind(answer["fault"])
        self.counts = answer.get("counts", self.counts)

    def _end(self) -> VbrailleError:
        """The error that says why there is no host any more."""
        code = self._reap()
        fault, self._fault = self._fault, None  # kept, it would keep all that raises it
        if fault is not None:
            return fault
        how = f"killed by signal {-code}" if code < 0 else f"exit code {code}"
        return HostDiedError(f"the process that drives the device has ended ({how})")
