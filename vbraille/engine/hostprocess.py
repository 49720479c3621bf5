"""The host process: it runs the loop and its device, and nothing else.

`vbraille.engine.host` starts it with a socket, on which each message is a JSON object: what to
open, then orders; back come what was opened, events and faults. A picture comes as a descriptor of
its memory. Records of ticks go into a ring in shared memory, which this process makes as large as
the array needs. Whatever happens to the parent, the array is brought to rest; and if a driver keeps
this process from ending, the system ends it.
"""

from __future__ import annotations

import ctypes
import gc
import json
import logging
import mmap
import os
import signal
import socket
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from vbraille.devices import calibration, opened_device
from vbraille.devices.events import Throttle, is_known
from vbraille.display import Display
from vbraille.engine.clock import ManualClock, RealClock
from vbraille.engine.loop import Loop
from vbraille.engine.realtime import go_real_time
from vbraille.engine.record import RING_S, Ring
from vbraille.errors import DeviceError, VbrailleError
from vbraille.logs import keep, print_traceback
from vbraille.render.program import Program, nothing
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.simulation.steering import from_json

# What a terminal does is the parent's to hear: a host that stopped with its parent would leave the
# actuators where they are.
_PARENTS = (
    signal.SIGINT,
    signal.SIGHUP,
    signal.SIGPIPE,
    signal.SIGTSTP,
    signal.SIGTTIN,
    signal.SIGTTOU,
)
MOST_BYTES = 1 << 16  # of a message
_MOST_SAID = 2000  # characters of a fault
_WARM_TICKS = 200
_REHEARSAL_S = 0.05
_PR_SET_PDEATHSIG = 1
_ANY = Display("any array", rows=1, columns=2, column_pitch_mm=1.0, row_pitch_mm=1.0)
_log = logging.getLogger(__name__)


class Parent:
    """The socket to the parent.

    Attributes
    ----------
    ended : bool
        Whether the parent wants no more, or is gone.
    loop : Loop or None
        Loop that obeys orders; there is one once the device is open.
    """

    def __init__(self, descriptor: int) -> None:
        self._socket = socket.socket(fileno=descriptor)
        self.ended = False
        self.loop: Loop | None = None
        self._throttle = Throttle()

    def say(self, **said: Any) -> None:
        """Send the parent a message; one that there is no room for is lost."""
        with suppress(OSError):
            self._socket.send(msgspec.json.encode(said))

    def first(self) -> dict[str, Any]:
        """Wait for the first message; empty if the parent is gone."""
        told = self._socket.recv(MOST_BYTES)
        self._socket.setblocking(False)
        return json.loads(told or b"{}")

    def obey(self) -> None:
        """Do what the parent wants; to be called when there may be something."""
        try:
            told, descriptors, _, _ = socket.recv_fds(self._socket, MOST_BYTES, 1)
        except BlockingIOError:
            return
        except OSError:
            told, descriptors = b"", []
        loop = self.loop
        if not told or loop is None:
            self.ended = True
            return
        for order, value in json.loads(told).items():
            match order:
                case "show":
                    loop.show(_program(descriptors[0], *value["sizes"]), value["line"])
                case "paused" | "switches":
                    setattr(loop, order, value)
                case "zero":
                    loop.device.set_zero()
                case "hand" if isinstance(loop.device, SimulatedDevice):
                    loop.device.obey(from_json(value.encode()))

    def fileno(self) -> int:
        """Descriptor that can be read when the parent wants something."""
        return self._socket.fileno()

    def pass_on(self, now_ns: int) -> None:
        """Tell the events of the loop and its device, not the same more than once a second.

        Raises
        ------
        DeviceError
            If a driver tells something that is no event.
        """
        assert self.loop is not None
        for event in self.loop.take_events():
            if not is_known(event):
                raise DeviceError(
                    f"{self.loop.device.display.name} tells {event!r}, which is no event of "
                    f"vbraille.devices.events; tell the author of its driver"
                )
            self._throttle.add(event)
        for event in self._throttle.take(now_ns):
            self.say(event=event)


def _program(descriptor: int, numbers: int, table: int) -> Program:
    """Picture in the memory of a descriptor, which is closed; nothing is copied."""
    memory = mmap.mmap(descriptor, max(8 * numbers + 2 * table, 1))
    os.close(descriptor)
    return Program(
        np.frombuffer(memory, np.float64, numbers),
        np.frombuffer(memory, np.uint16, table, 8 * numbers),
    )


def warm_up(info: Display) -> None:
    """Load, or compile, all that a tick calls, on a device in memory and a manual clock."""
    clock = ManualClock()
    with SimulatedDevice(info, clock.now_ns) as device:
        loop = Loop(device, clock)
        loop.show(nothing(info), 0)
        for _ in range(_WARM_TICKS):
            loop.tick()
        loop.fade_to_rest()


def end_after(parent: int) -> None:
    """Have the system end this process some seconds after its parent, whatever a driver does.

    A driver may wait for ever, in Python or in C, when it is opened or let go. So no code of
    this process is asked: when the parent is gone the system sends SIGQUIT, whose handler is
    the C library's own `alarm`. That takes the signal's number, 3, as seconds until SIGALRM,
    which ends the process. Till then the loop has time to bring the array to rest.
    """
    signal.signal(signal.SIGALRM, signal.SIG_DFL)  # a parent may have it ignored
    signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGALRM, signal.SIGQUIT))
    library = ctypes.CDLL(None)
    library.signal(int(signal.SIGQUIT), library.alarm)
    library.prctl(_PR_SET_PDEATHSIG, int(signal.SIGQUIT))
    if os.getppid() != parent:  # the parent was gone before that
        signal.raise_signal(signal.SIGQUIT)


def run(parent: Parent, memory: int) -> None:
    """Open the device, drive it until the parent has had enough, and bring it to rest.

    Raises
    ------
    VbrailleError
        If the device cannot be opened, or fails.
    """
    warm_up(_ANY)  # what it is to drive is not told yet: any array will do
    told = parent.first()
    if not told:
        return
    if told["log"] is not None:
        keep(told["log"])
    wanted = Display(**told["wanted"])
    parent.say(opening=True)
    with opened_device(told["device"], wanted, fits=told["fits"], often=told["often"]) as device:
        display = device.display
        rate_hz = min(wanted.rate_hz, display.rate_hz)
        found = calibration.load(Path(told["settings"]), device)
        if found is not None:
            device.calibrate(found)
        ticks = round(RING_S * rate_hz)
        size = Ring.bytes_needed(display.shape, ticks)
        os.ftruncate(memory, size)
        ring = Ring(memoryview(mmap.mmap(memory, size)), display.shape, ticks)
        os.close(memory)
        refused = go_real_time()
        rehearsal = Loop(device, RealClock(), rate_hz=rate_hz)  # what is first called takes longer
        for _ in range(max(2, round(_REHEARSAL_S * rate_hz))):
            rehearsal.tick()
        parent.loop = loop = Loop(device, RealClock(), rate_hz=rate_hz, ring=ring, orders=parent)
        signal.signal(signal.SIGTERM, lambda *_: setattr(parent, "ended", True))
        parent.say(
            ready=display,
            ticks=ticks,
            calibration=found,
            steered=isinstance(device, SimulatedDevice),
            event=refused,
        )
        _log.info("ready: %s", refused or "in real time")
        try:
            loop.restart_clock()
            while not parent.ended:
                loop.tick()
                parent.pass_on(loop.clock.now_ns())
        finally:
            _log.info("ending after %d ticks", loop.now["tick"])
            with suppress(DeviceError):
                loop.fade_to_rest()
            parent.pass_on(1 << 62)
            parent.say(counts={str(name): int(n) for name, n in device.counts().items()})


def main() -> int:
    """Run as the child of the program that reads the answers."""
    gc.disable()  # all that it loads stays
    for number in _PARENTS:
        signal.signal(number, signal.SIG_IGN)
    end_after(int(sys.argv[3]))
    parent = Parent(int(sys.argv[1]))
    try:
        run(parent, int(sys.argv[2]))
    except Exception as error:
        said, code = str(error), 1
        if isinstance(error, VbrailleError):
            code = error.exit_code
        else:
            print_traceback(error)
            what = f"{type(error).__name__}: {error}"
            said = f"internal error, please report it: {what}"
        parent.say(fault=said[:_MOST_SAID], code=code)
        return code
    return 0


if __name__ == "__main__":
    sys.exit(main())
