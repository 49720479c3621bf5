"""The host process: it runs the loop, its device and its mailbox, and nothing else.

`vbraille.engine.spawning` starts it, and `vbraille.engine.host` sends it two lines of JSON on
standard input: which device to open, and, perhaps when that has been answered, how much memory to
share. It answers with lines of JSON on what was standard output, which it keeps to itself: what a
driver prints goes to standard error. Whatever happens to its parent, it brings the array to rest
before it ends; and if a driver keeps it from ending, the system ends it.
"""

from __future__ import annotations

import ctypes
import fcntl
import json
import logging
import os
import select
import signal
import sys
import time
from contextlib import suppress
from dataclasses import asdict, replace
from io import FileIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vbraille.devices import opened_device
from vbraille.devices.calibrations import correct_by_kept
from vbraille.devices.events import EVERY_NS, Notices, is_known, shortened, to_json
from vbraille.display import Display
from vbraille.engine.clock import ManualClock, RealClock
from vbraille.engine.loop import Loop
from vbraille.engine.mailbox import Extent, attach, divide
from vbraille.engine.realtime import go_real_time
from vbraille.errors import DeviceError, VbrailleError
from vbraille.logs import keep, print_traceback, want_tracebacks
from vbraille.render.program import nothing
from vbraille.simulation.simulated import SimulatedDevice

if TYPE_CHECKING:
    from io import RawIOBase
    from types import FrameType

    from vbraille.devices import Device
    from vbraille.devices.events import Event
    from vbraille.engine.mailbox import Mailbox

_PARENT_S = (
    signal.SIGINT,
    signal.SIGHUP,
    signal.SIGPIPE,
    signal.SIGTSTP,
    signal.SIGTTIN,
    signal.SIGTTOU,
)
_ANY = Display("any array", rows=1, columns=2, column_pitch_mm=1.0, row_pitch_mm=1.0)
_WARM_TICKS = 200
_REHEARSAL_S = 0.05
# Characters of a fault or of a text of an event, each up to 12 bytes of JSON; those of an event of
# several texts that are no Latin. A pipe takes this many bytes whole or not.
_MOST_SAID = 300
_MOST_OF_SEVERAL = 60
_WHOLE_BYTES = 4096
_PR_SET_PDEATHSIG = 1
_log = logging.getLogger(__name__)


class Channel:
    """The line to the parent: this process's standard output, which no other code gets."""

    def __init__(self) -> None:
        # Neither a driver nor a program that it starts may get at it; 0 to 2 are not for it.
        self._descriptor = fcntl.fcntl(1, fcntl.F_DUPFD_CLOEXEC, 3)
        try:
            os.dup2(2, 1)
        except OSError:  # there is no standard error
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        sys.stdout = os.fdopen(1, "w", buffering=1, closefd=False, errors="backslashreplace")

    def say(self, **said: Any) -> None:
        """Send the parent a line; one that the pipe has no room for is lost."""
        if said.get("fault"):
            said["fault"] = str(said["fault"])[:_MOST_SAID]
        self._write(json.dumps(said).encode())

    def tell(self, event: Event) -> None:
        """Send the parent an event, its texts cut to what there is room for."""
        line = b""
        for most in (_MOST_SAID, _MOST_OF_SEVERAL):
            line = json.dumps({"event": to_json(shortened(event, most))}).encode()
            if len(line) < _WHOLE_BYTES:
                break
        self._write(line)

    def _write(self, line: bytes) -> None:
        with suppress(OSError):
            os.write(self._descriptor, line + b"\n")

    def never_wait(self) -> None:
        """From now on lose a line rather than wait for room."""
        os.set_blocking(self._descriptor, False)


class OrderedLoop:
    """The loop of a host process, which does what its mailbox says.

    Parameters
    ----------
    loop
        The loop to run.
    mailbox
        Mailbox in which the parent says what to show.
    parent
        Number of the parent's process; the loop ends when that does.
    """

    def __init__(self, loop: Loop, mailbox: Mailbox, parent: int) -> None:
        self.loop = loop
        self._mailbox = mailbox
        self._parent = parent
        self._ended = False
        self._zeroed = 0
        self._taken = 0
        mailbox.keep_room()

    def end(self, _signal: int, _frame: FrameType | None) -> None:
        """Handle a signal: the loop ends after this tick."""
        self._ended = True

    @property
    def wanted(self) -> bool:
        """Tell whether to go on: no order to stop has come, and the parent lives."""
        return not (self._ended or self._mailbox.stopped) and os.getppid() == self._parent

    def run(self) -> None:
        """Do what is new in the mailbox, then some ticks, until it is time to end."""
        mailbox, loop = self._mailbox, self.loop
        # Looked at before the mailbox: what comes meanwhile ends the ticks that follow.
        mailbox.obeyed[:] = mailbox.orders
        if mailbox.published != self._taken:
            posted = mailbox.take_piece()
            if posted is None:
                mailbox.obeyed[:] = -1  # look at it again, a tick later
            else:
                self._taken = posted.number
                loop.show(posted.program, posted.line)
        if mailbox.paused != loop.paused:
            loop.paused = mailbox.paused
        if mailbox.switches != loop.switches:
            loop.switches = mailbox.switches
        if mailbox.zeroed != self._zeroed:
            self._zeroed = mailbox.zeroed
            loop.device.set_zero()
        loop.run(mailbox)


def warm_up(info: Display, extent: Extent) -> None:
    """Compile and run once all that a tick calls, on a device in memory and a manual clock."""
    clock = ManualClock()
    with SimulatedDevice(info, clock.now_ns) as device:
        mailbox, ring = divide(memoryview(bytearray(extent.total_bytes)), extent)
        loop = Loop(device, clock, ring=ring)
        loop.show(nothing(info))
        hosted = OrderedLoop(loop, mailbox, 0)
        for _ in range(_WARM_TICKS):
            hosted.run()
        loop.load()
        loop.fade_to_rest()


def rehearse(device: Device, rate_hz: float) -> None:
    """Call once everything that a tick calls of a driver; the array rests meanwhile."""
    loop = Loop(device, RealClock(), rate_hz=rate_hz)
    for _ in range(max(2, round(_REHEARSAL_S * rate_hz))):
        loop.tick()


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


def pass_on(loop: Loop, notices: Notices, channel: Channel) -> None:
    """Tell the parent the events of a loop and its device; equal ones at most once a second.

    Raises
    ------
    DeviceError
        If a driver tells something that is no event.
    """
    now_ns = loop.clock.now_ns()
    for event in loop.take_events():
        if not is_known(event):
            raise DeviceError(
                f"{loop.device.display.name} tells {event!r}, which is no event of "
                f"vbraille.devices.events; tell the author of its driver"
            )
        # Drivers may tell all they have to by one code; only what is alike stands for another.
        # Where a knob was is of no use once it is elsewhere.
        alike = event.kind and not event.tells_place
        notices.add(event, now_ns, replace(event, times=1) if alike else event.kind)
    for event in notices.take(now_ns):
        channel.tell(event)


def wait_for_line(orders: RawIOBase, device: Device, rate_hz: float) -> bytes:
    """Wait for the parent's next line; poses that the device sends meanwhile are dropped."""
    while not select.select([orders], [], [], 1 / rate_hz)[0]:
        device.read()
    return orders.readline()


def run(orders: RawIOBase, descriptor: int, parent: int, channel: Channel) -> None:
    """Open the device, drive it until the parent has had enough, and bring it to rest.

    Raises
    ------
    VbrailleError
        If the device cannot be opened, or fails.
    """
    end_after(parent)
    begun_ns = time.monotonic_ns()
    # What it is to drive is not told yet: any array will do.
    warm_up(_ANY, Extent(_ANY.rows, _ANY.columns, 0, _WARM_TICKS))
    compiled_ms = (time.monotonic_ns() - begun_ns) / 1e6
    told = orders.readline()
    if not told:
        return  # the parent has gone, or given up
    config = json.loads(told)
    if config["log"] is not None:
        keep(config["log"])
    if config["verbose"]:
        want_tracebacks()
    wanted = Display(**config["wanted"])
    _log.info("compiled, or loaded what was, in %.0f ms", compiled_ms)
    how = {name: config[name] for name in ("fits", "often")}
    channel.say(opening=True)
    with opened_device(config["device"], wanted, **how) as device:
        rate_hz = min(wanted.rate_hz, device.display.rate_hz)
        corrected = correct_by_kept(Path(config["settings"]), device)
        channel.say(opened=asdict(device.display), calibration=corrected and corrected.to_json())
        told = wait_for_line(orders, device, rate_hz)
        if not told:
            return  # the parent has gone, or given up
        extent = Extent(**json.loads(told))
        mailbox, ring = divide(attach(descriptor, extent), extent)
        os.close(descriptor)
        refused = go_real_time()
        rehearse(device, rate_hz)
        loop = Loop(device, RealClock(), rate_hz=rate_hz, ring=ring)
        hosted = OrderedLoop(loop, mailbox, parent)
        signal.signal(signal.SIGTERM, hosted.end)
        channel.say(ready=True, event=refused and to_json(refused))
        _log.info("ready: %s", "in real time" if refused is None else refused)
        channel.never_wait()
        notices = Notices()
        try:
            loop.restart_clock()
            while hosted.wanted:
                hosted.run()
                pass_on(loop, notices, channel)
        finally:
            _log.info("ending after %d ticks", loop.tally.ticks)
            ring.publish()
            with suppress(DeviceError):
                loop.fade_to_rest()
            pass_on(loop, notices, channel)
            for event in notices.take(loop.clock.now_ns() + EVERY_NS):
                channel.tell(event)
            channel.say(counts={str(name): int(n) for name, n in device.counts().items()})


def main() -> int:
    """Run as the child of the program that reads the answers."""
    # Keys of the terminal and its end are the parent's to hear: a host that stopped with its parent
    # would leave the actuators where they are.
    for number in _PARENT_S:
        signal.signal(number, signal.SIG_IGN)
    channel = Channel()
    try:
        # Without a buffer, so that waiting for the descriptor misses no line.
        with FileIO(sys.stdin.fileno(), closefd=False) as orders:
            run(orders, int(sys.argv[1]), int(sys.argv[2]), channel)
    except VbrailleError as error:
        channel.say(fault=str(error), code=error.exit_code)
        return error.exit_code
    except Exception as error:
        print_traceback(error)
        what = f"{type(error).__name__}: {error}"
        channel.say(
            fault=f"a fault of vbraille's own, which its authors want to hear of: {what}", code=1
        )
        return 1
    return 0
