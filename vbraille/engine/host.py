"""The loop in a process of its own, seen from its parent."""

from __future__ import annotations

import json
import os
import select
import subprocess
import sys
from contextlib import suppress
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, Self

from vbraille.devices import DeviceInfo
from vbraille.engine import shared
from vbraille.engine.engine import place_of
from vbraille.engine.tally import Tally
from vbraille.errors import DeviceError, InputError, VbrailleError

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.engine.mailbox import Mailbox
    from vbraille.engine.ring import Ring
    from vbraille.render.renderer import Renderer

# Fading takes 0.1 s; a driver may have to wait for a device that is gone.
_END_S = 5.0
# How long to wait for an answer before looking whether there is a process that could give it.
_LOOK_S = 0.1


class HostDiedError(VbrailleError):
    """The host process ended without a word; `Host.start` begins another."""


class Host:
    """An `Engine` whose loop no other work of the program holds up. A context manager.

    Parameters
    ----------
    device
        Spec, as of `vbraille.devices.open_device`.
    wanted
        The actuators, travel and rate that the page was laid out for.
    cells
        Most cells of a line.

    Attributes
    ----------
    newest : record or None
        The last tick polled.
    counts : dict[str, int]
        What went wrong with the device, by name; known after `close`.
    lost : int
        Ticks that were never polled: the parent was away for too long.
    """

    def __init__(self, device: str, wanted: DeviceInfo, cells: int) -> None:
        ticks = round(shared.RING_S * wanted.rate_hz)
        self.newest: np.void | None = None
        self.counts: dict[str, int] = {}
        self.lost = 0
        self._device = device
        self._wanted = wanted
        self._extent = shared.Extent(wanted.rows, wanted.columns, cells, ticks)
        self._info: DeviceInfo | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._mailbox: Mailbox
        self._ring: Ring
        self._shown: tuple[Renderer, int, float] | None = None
        self._notes: list[str] = []
        self._heard = b""
        self._fault: VbrailleError | None = None
        self._before = Tally()
        self._lost_before = 0
        self._paused = False
        self._launched = False

    def start(self) -> None:
        """Start the process, and wait until it has opened the device; again after its death.

        Raises
        ------
        VbrailleError
            If the device cannot be opened.
        """
        if not self._launched:
            self.launch()
        self._launched = False
        while self._info is None:
            select.select((self._answers(),), (), (), _LOOK_S)
            if not self._hear():
                raise self._end()
        if self._shown is not None:
            self._mailbox.post(*self._shown)

    def launch(self) -> None:
        """Start the process and wait for nothing: `start` does, when there is no more to do.

        The system ends the process with the thread that calls this.
        """
        self.close()
        self._launched = True
        if self.newest is not None:
            self._before, self._lost_before = self.tally, self.lost
        self._info = self._fault = self.newest = None
        self._paused = False
        self._heard = b""
        descriptor = shared.create(self._extent)
        try:
            self._mailbox, self._ring = shared.divide(
                shared.attach(descriptor, self._extent), self._extent
            )
            self._process = subprocess.Popen(
                [sys.executable, "-m", "vbraille.engine.hosted", str(descriptor)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                pass_fds=(descriptor,),
            )
            os.set_blocking(self._answers(), False)
        finally:
            os.close(descriptor)
        config = {
            "device": self._device,
            "wanted": asdict(self._wanted),
            "extent": asdict(self._extent),
            "parent": os.getpid(),
        }
        assert self._process.stdin is not None
        with suppress(BrokenPipeError), self._process.stdin as stdin:
            stdin.write(json.dumps(config).encode() + b"\n")

    @property
    def process_id(self) -> int | None:
        """The host process."""
        return None if self._process is None else self._process.pid

    @property
    def info(self) -> DeviceInfo:
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
        """Where the array's left column was at the last poll; None before it is known."""
        return place_of(self.newest)

    @property
    def paused(self) -> bool:
        """Whether the array is to rest."""
        return self._paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self._paused = self._mailbox.paused = paused

    def show(self, picture: Renderer, line: int, end_mm: float) -> None:
        """Put a picture of a line under the hand; see `Engine`."""
        self._shown = picture, line, end_mm
        self._mailbox.post(picture, line, end_mm)

    def set_zero(self) -> None:
        """Say that the carriage is at the left stop now."""
        self._mailbox.zero()

    def poll(self) -> NDArray[np.void]:
        """Records of all ticks since the last poll.

        Raises
        ------
        VbrailleError
            If the loop has ended: the device's fault, or `HostDiedError`.
        """
        alive = self._hear()
        ticks = self._ring.drain()
        self.lost = self._lost_before + self._ring.lost
        if ticks.size:
            self.newest = ticks[-1]
        if not alive and not ticks.size:
            raise self._end()
        return ticks

    def take_notes(self) -> Sequence[str]:
        """What the device has to say since the last call, a sentence each."""
        notes, self._notes = self._notes, []
        return notes

    def close(self) -> None:
        """Have the host bring the array to rest and end; further calls do nothing."""
        process = self._process
        if process is None:
            return
        self._mailbox.stop()
        self._reap()
        while self._hear():
            pass
        if process.stdout is not None:
            process.stdout.close()
        self._process = None
        del self._mailbox, self._ring  # whose memory holds a descriptor

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
        if "ready" in answer:
            self._info = DeviceInfo(**answer["ready"])
        if answer.get("note"):
            self._notes.append(answer["note"])
        if "fault" in answer:
            kind = InputError if answer["code"] == InputError.exit_code else DeviceError
            self._fault = kind(answer["fault"])
        self.counts = answer.get("counts", self.counts)

    def _end(self) -> VbrailleError:
        """Why there is no host any more."""
        code = self._reap()
        fault, self._fault = self._fault, None  # kept, it would keep all that raises it
        if fault is not None:
            return fault
        how = f"killed by signal {-code}" if code < 0 else f"exit code {code}"
        return HostDiedError(f"the process that drives the device has ended ({how})")
