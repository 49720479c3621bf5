"""What runs in the host process: the loop, its device and its mailbox, and nothing else.

`vbraille.engine.host` starts it, with two lines of JSON on standard input: which
device to open, and, perhaps when that has been answered, how much memory to share. It
answers with lines of JSON on standard output. Whatever happens to its parent,
it brings the array to rest before it ends.
"""

from __future__ import annotations

import json
import os
import select
import signal
import sys
from contextlib import suppress
from dataclasses import asdict
from io import FileIO
from typing import TYPE_CHECKING, Any

from vbraille.devices import DeviceInfo, open_device
from vbraille.devices.simulated import SimulatedDevice
from vbraille.engine import shared
from vbraille.engine.clock import ManualClock, RealClock
from vbraille.engine.loop import Loop
from vbraille.engine.posted import PostedPicture
from vbraille.engine.realtime import go_real_time
from vbraille.errors import DeviceError, VbrailleError

if TYPE_CHECKING:
    from io import RawIOBase
    from types import FrameType

    from vbraille.devices import Device
    from vbraille.engine.mailbox import Mailbox

_PARENT_S = (
    signal.SIGINT,
    signal.SIGHUP,
    signal.SIGPIPE,
    signal.SIGTSTP,
    signal.SIGTTIN,
    signal.SIGTTOU,
)
_WARM_TICKS = 200
_REHEARSAL_S = 0.05


class Hosted:
    """The loop of a host process, as its mailbox says.

    Parameters
    ----------
    loop
        To run.
    mailbox
        What is to be done.
    extent
        What is shared.
    parent
        Process that must live.
    """

    def __init__(self, loop: Loop, mailbox: Mailbox, extent: shared.Extent, parent: int) -> None:
        self.loop = loop
        self._mailbox = mailbox
        self._parent = parent
        self._ended = False
        self._zeroed = 0
        self._taken = 0
        self._line = 0
        # The one under the hand, and the one that comes next.
        self._pictures = [PostedPicture(extent.shape, extent.cells) for _ in range(2)]

    def end(self, _signal: int, _frame: FrameType | None) -> None:
        """Take a signal: end after this tick."""
        self._ended = True

    @property
    def wanted(self) -> bool:
        """Whether to go on: told to by nobody else, and the parent lives."""
        return not (self._ended or self._mailbox.stopped) and os.getppid() == self._parent

    def tick(self) -> None:
        """Do what is new in the mailbox, then a tick."""
        mailbox, loop = self._mailbox, self.loop
        if mailbox.published != self._taken:
            picture = self._pictures[0]
            if mailbox.take(picture):
                self._pictures.reverse()
                self._taken = picture.number
                loop.show(picture, picture.line)
                if picture.line != self._line:
                    self._line = picture.line
                    loop.device.follow(picture.end_mm)
        if mailbox.paused != loop.paused:
            loop.paused = mailbox.paused
        if mailbox.zeroed != self._zeroed:
            self._zeroed = mailbox.zeroed
            loop.device.set_zero()
        loop.tick()


def warm_up(info: DeviceInfo, extent: shared.Extent) -> None:
    """Compile and run once all that a tick calls, on a device and a clock of no consequence."""
    clock = ManualClock()
    with SimulatedDevice(info, clock.now_ns) as device:
        mailbox, ring = shared.divide(memoryview(bytearray(extent.total_bytes)), extent)
        loop = Loop(device, clock, ring=ring)
        picture = PostedPicture(extent.shape, extent.cells)
        loop.show(picture)
        loop.warm_up()
        hosted = Hosted(loop, mailbox, extent, 0)
        for _ in range(_WARM_TICKS):
            hosted.tick()
        loop.fade_to_rest()


def rehearse(device: Device, rate_hz: float) -> None:
    """Call once all that a driver does in a tick; the array rests meanwhile."""
    loop = Loop(device, RealClock(), rate_hz=rate_hz)
    for _ in range(max(2, round(_REHEARSAL_S * rate_hz))):
        loop.tick()


def answer(**said: Any) -> None:
    """Say something to the parent; what it has no room for is lost."""
    with suppress(OSError):
        os.write(sys.stdout.fileno(), json.dumps(said).encode() + b"\n")


def wait_for_line(orders: RawIOBase, device: Device, rate_hz: float) -> bytes:
    """Next line of the parent's; what the device says meanwhile is taken, and not used."""
    while not select.select([orders], [], [], 1 / rate_hz)[0]:
        device.read()
    return orders.readline()


def run(orders: RawIOBase, descriptor: int) -> None:
    """Open the device, drive it until it is enough, and rest it.

    Raises
    ------
    VbrailleError
        If the device cannot be opened, or fails.
    """
    config = json.loads(orders.readline())
    wanted = DeviceInfo(**config["wanted"])
    warm_up(wanted, shared.Extent(wanted.rows, wanted.columns, 1, _WARM_TICKS))
    with open_device(config["device"], wanted, fits=config["fits"]) as device:
        answer(opened=asdict(device.info))
        told = wait_for_line(orders, device, wanted.rate_hz)
        if not told:
            return  # nobody wants it any more
        extent = shared.Extent(**json.loads(told))
        mailbox, ring = shared.divide(shared.attach(descriptor, extent), extent)
        os.close(descriptor)
        note = go_real_time()
        rehearse(device, wanted.rate_hz)
        loop = Loop(device, RealClock(), rate_hz=wanted.rate_hz, ring=ring)
        hosted = Hosted(loop, mailbox, extent, config["parent"])
        signal.signal(signal.SIGTERM, hosted.end)
        answer(ready=True, note=note)
        os.set_blocking(sys.stdout.fileno(), False)
        try:
            loop.restart_clock()
            while hosted.wanted:
                hosted.tick()
                _say_notes(device)
        finally:
            ring.publish()
            with suppress(DeviceError):
                loop.fade_to_rest()
            _say_notes(device)
            answer(counts=dict(device.counts()))


def _say_notes(device: Device) -> None:
    for note in device.take_notes():
        answer(note=note)


def main() -> int:
    """Run as the child of a program that reads what is answered."""
    # Keys of the terminal and its end are the parent's to hear: a host that stopped with its parent
    # would leave the actuators where they are.
    for number in _PARENT_S:
        signal.signal(number, signal.SIG_IGN)
    try:
        with FileIO(
            sys.stdin.fileno(), closefd=False
        ) as orders:  # without a buffer, to be waited for
            run(orders, int(sys.argv[1]))
    except VbrailleError as error:
        answer(fault=str(error), code=error.exit_code)
        return error.exit_code
    except Exception as error:
        if os.environ.get("VBRAILLE_TRACEBACK"):
            raise
        what = f"{type(error).__name__}: {error}"
        answer(
            fault=f"a fault of vbraille's own, which its authors want to hear of: {what}", code=1
        )
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
