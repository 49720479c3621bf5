"""A Latero on the network: its address, its socket, its watchdog process, and the talk with it."""

from __future__ import annotations

import mmap
import os
import re
import select
import socket
import subprocess
import sys
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

from vbraille.carriers.carrier import LATERO, LATERO_ARRAY
from vbraille.devices.base import Device, Particulars
from vbraille.devices.latero import watchdog
from vbraille.devices.latero.conversation import (
    NAME,
    OPENING,
    STALL_NS,
    LateroConversation,
    LateroStage,
    power_off,
)
from vbraille.devices.latero.watchdog import POWER
from vbraille.devices.latero.wire import NO_IO, PORT, full_request
from vbraille.errors import DeviceError, InputError
from vbraille.files import open_memory
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.devices.latero.wire import Answer
    from vbraille.display import Display, Pose

_U16, _U32 = 0xFFFF, 0xFFFF_FFFF
_EXAMPLE: Final = "latero:192.168.1.111"
NO_POWER: Final = "none"


@dataclass(frozen=True, slots=True)
class LateroAddress:
    """Address of a Latero, and what is known of it beforehand.

    Parameters
    ----------
    host
        Name or address of the Latero on the network.
    port
        UDP port; every Latero has 8900.
    offsets
        Counts of encoders 0, 1 and 2 at angle 0 of their joints; None if the reader shows the
        device where it is.
    power
        Register of the controller by which motor power is switched; None if it never is.
    trusted
        Whether the user said so; otherwise the Latero is asked first.
    """

    host: str
    port: int = PORT
    offsets: tuple[int, int, int] | None = None
    power: int | None = 0
    trusted: bool = False

    @property
    def text(self) -> str:
        """Host and port, as a reader knows them."""
        return f"{self.host}:{self.port}"


def parse_latero_address(text: str) -> LateroAddress:
    """Address of a text.

    Raises
    ------
    InputError
        If it is none, or an option is unknown or out of range.
    """
    place, _, query = text.partition("?")
    host, colon, port = place.partition(":")
    if not re.fullmatch(r"[A-Za-z0-9._-]{1,253}", host):
        raise InputError(f"latero: needs the name or the address of a host, as in {_EXAMPLE}")
    if colon and not (re.fullmatch(r"[0-9]{1,5}", port) and 1 <= int(port) <= _U16):
        raise InputError(f"port is {port!r}; it must be a whole number from 1 to {_U16}")
    address = LateroAddress(host, int(port) if colon else PORT)
    offsets, power, trusted = address.offsets, address.power, False
    for option in filter(None, query.split("&")):
        name, _, value = option.partition("=")
        if name == "offsets":
            offsets = _offsets(value)
        elif name == "power":
            power, trusted = _power(value), True
        else:
            raise InputError(f"there is no option {name!r} of a Latero; there is offsets and power")
    return LateroAddress(host, address.port, offsets, power, trusted)


def _offsets(text: str) -> tuple[int, int, int]:
    found = re.fullmatch(r"(-?[0-9]{1,10}),(-?[0-9]{1,10}),(-?[0-9]{1,10})", text)
    if found is None:
        raise InputError(
            f"offsets are {text!r}; give three whole numbers, the counts of encoders 0, 1 and 2 "
            f"at angle 0, such as offsets=4452,9928,2004"
        )
    first, second, third = (int(count) & _U32 for count in found.groups())
    return first, second, third


def _power(text: str) -> int | None:
    if text == NO_POWER:
        return None
    found = re.fullmatch(r"0x[0-9a-fA-F]{1,4}|[0-9]{1,5}", text)
    register = int(text, 16 if text.startswith("0x") else 10) if found else -1
    if not 0 <= register <= _U16:
        raise InputError(
            f"power is {text!r}; give the controller's register that switches motor power, 0 to "
            f"{_U16}, or {NO_POWER}"
        )
    return register


# It takes a few hundredths of a second; this is a machine with a lot to do.
_START_S: Final = 10.0
_END_S: Final = 2.0


class WatchdogProcess:
    """A watchdog that watches from now on, until `close`.

    Parameters
    ----------
    request
        FULL with all blades at rest, which the watchdog changes as it has to.
    off
        RAW that switches motor power off.
    socket
        Descriptor of a socket of the watchdog's own, connected to the Latero.
    kept
        Further descriptors that stay open as long as the watchdog lives.

    Attributes
    ----------
    board : Board
        Memory that is shared with the watchdog.

    Raises
    ------
    DeviceError
        If it does not begin to watch.
    """

    def __init__(self, request: bytes, off: bytes, socket: int, kept: Sequence[int] = ()) -> None:
        memory = open_memory("vbraille-latero", watchdog.MEMORY_BYTES)
        self._memory = mmap.mmap(memory, watchdog.MEMORY_BYTES)
        self.board = watchdog.Board(self._memory)
        self.board.full[:] = request
        self.board.off[:] = off
        lifeline, self._lifeline = os.pipe()
        try:
            self._process = subprocess.Popen(
                [
                    sys.executable,
                    "-I",
                    "-S",
                    watchdog.__file__,
                    *map(str, (memory, lifeline, socket)),
                ],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                pass_fds=(memory, lifeline, socket, *kept),
                cwd="/",
                start_new_session=True,  # what ends the driver's session does not end it
            )
        except OSError as error:
            os.close(self._lifeline)
            raise DeviceError(
                f"the Latero's watchdog cannot be started: {error.strerror}"
            ) from None
        finally:
            os.close(memory)
            os.close(lifeline)
        self._ended = os.pidfd_open(self._process.pid)
        self._look = select.poll()
        self._look.register(self._ended, select.POLLIN)
        self._wait()

    def _wait(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as said:
            ready, _, _ = select.select([said], (), (), _START_S)
            if not (ready and os.read(said.fileno(), 1)):
                self._process.kill()
                self.close()
                raise DeviceError(
                    "the Latero's watchdog does not begin to watch, and without it no person may "
                    "read on a Latero; try again"
                )

    @property
    def process_id(self) -> int:
        """Number of the watchdog's process."""
        return self._process.pid

    @property
    def alive(self) -> bool:
        """Tell whether the watchdog lives; this never waits."""
        return not self._look.poll(0)

    @property
    def trips(self) -> int:
        """Tell how often the watchdog has begun to bring the blades to rest."""
        return self.board.words[watchdog.TRIPS]

    def beat(self, now_ns: int) -> None:
        """Say that the driver lives; this never waits."""
        self.board.words[watchdog.BEAT] = now_ns

    def close(self, *, all_done: bool = True) -> None:
        """Have the watchdog end, and wait for that.

        Parameters
        ----------
        all_done
            Whether it has nothing to do; otherwise it brings the blades to rest before, and
            switches motor power off.
        """
        if all_done:
            self.board.words[watchdog.STATE] = watchdog.CLOSED
        os.close(self._lifeline)
        try:
            self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._ended)


DISPLAY: Final = replace(LATERO.under(LATERO_ARRAY), name=NAME, shown_near=True)
# A Latero answers in less; where it does not, the answer to the last frame is there.
AHEAD_NS: Final = 300_000
_ROOM_BYTES: Final = 256
# Answers that are taken at a time: those of a stopped client wait in the socket.
_MOST_ANSWERS: Final = 256
_STEP_S: Final = 0.001
_REST_STEPS: Final = 60
_LEAVE_STEPS: Final = 200


class LateroDevice(Device):
    """A Latero that has answered; `openlatero` begins the talk.

    Parameters
    ----------
    line
        Socket that is connected to the Latero, and does not block.
    conversation
        The talk with it, in which it has answered.
    watchdog
        The watchdog of it, which watches already.
    kept
        Socket that keeps other programs away; it is closed at the end.
    now_ns, pause
        Clock, and function that waits for a number of seconds.
    """

    display = DISPLAY
    acknowledges = True
    ahead_ns = AHEAD_NS

    def __init__(
        self,
        line: socket.socket,
        conversation: LateroConversation,
        watchdog: WatchdogProcess,
        kept: socket.socket,
        now_ns: Callable[[], int] = time.monotonic_ns,
        pause: Callable[[float], None] = time.sleep,
    ) -> None:
        self.conversation = conversation
        self.watchdog = watchdog
        self._line = line
        self._kept = kept
        self._now_ns = now_ns
        self._pause = pause
        self._room = bytearray(_ROOM_BYTES)
        self._view = memoryview(self._room)
        self._trips = watchdog.trips
        self._called_ns = now_ns()
        self._unsent = 0
        self._copy()

    def set_zero(self) -> None:
        """Take the place for the lower left corner with the third arm straight up."""
        self.conversation.set_zero(self._now_ns())
        self._copy()
        self._describe()

    def take_events(self) -> Sequence[Event]:
        """Events since the last call, each kind once a second at most."""
        return self.conversation.take_events(self._now_ns())

    def counts(self) -> Mapping[str, int]:
        """Counts of what went wrong so far, by name."""
        conversation = self.conversation
        numbering = conversation.numbering
        return {
            "frames not sent": self._unsent,
            "requests not answered": numbering.lost,
            "late answers": numbering.late,
            "doubled answers": numbering.doubled,
            "foreign datagrams": conversation.foreign + numbering.unasked,
            "watchdog trips": self.watchdog.trips,
            "reconnections": conversation.reconnections,
        }

    def read(self) -> Pose | None:
        """Newest sample since the last call, or None; this never waits.

        Raises
        ------
        DeviceError
            If the watchdog has ended, without which no person may read on a Latero.
        """
        now_ns = self._now_ns()
        if not self.watchdog.alive:
            raise DeviceError(
                f"the watchdog of the {NAME} has ended, and without it no person may read; the "
                f"blades go to rest, so begin again"
            )
        self._step(now_ns)
        self._copy()
        return self.conversation.take_pose()

    def ask(self) -> None:
        """Ask where the array is: the answer to the last frame would be a whole tick old."""
        now_ns = self._now_ns()
        self._mind_stall(now_ns)
        self.conversation.ask(now_ns)
        self._send_due(now_ns)

    def rest(self) -> None:
        """Bring the blades to rest, which takes 20 ms: a frame of rest would be a jump."""
        self.conversation.rest(self._now_ns())
        for _ in range(_REST_STEPS):
            self._step(self._now_ns())
            if self.conversation.blades.rests:
                return
            self._pause(_STEP_S)

    def _send(self, frame: NDArray[np.float64]) -> None:
        now_ns = self._now_ns()
        self._mind_stall(now_ns)
        self.conversation.show(frame, now_ns)
        self._send_due(now_ns)
        self.acknowledged_ns = None

    def _mind_stall(self, now_ns: int) -> None:
        """See whether this process was stopped for so long that the watchdog may have acted."""
        stopped = now_ns - self._called_ns >= STALL_NS
        self._called_ns = now_ns
        trips = self.watchdog.trips
        if trips != self._trips or (stopped and not self.conversation.blades.rests):
            self._trips = trips
            self.watchdog.beat(now_ns)
            self.conversation.stall(self.watchdog.board.levels, trips, now_ns)

    def _hear(self, now_ns: int) -> None:
        for _ in range(_MOST_ANSWERS):
            try:
                size = self._line.recv_into(self._room)
            except OSError:  # nothing has come, or no Latero is there
                return
            self.conversation.hear(self._view[:size], now_ns)
            if self.conversation.numbering.caught_up:  # what may be left is doubled or late
                return

    def _send_due(self, now_ns: int) -> None:
        conversation, board = self.conversation, self.watchdog.board
        while (request := conversation.due()) is not None:
            # The watchdog knows where the blades are before they are there.
            board.levels[:] = conversation.blades.view
            self.watchdog.beat(now_ns)
            try:
                self._line.send(request)
            except OSError:
                self._unsent += 1
                conversation.refused()
                return
            conversation.sent()

    def _copy(self) -> None:
        """Copy the values that `Device` promises from the conversation."""
        conversation = self.conversation
        self.rested = conversation.rested
        self.taking = conversation.taking
        self.placing = conversation.place.placing
        self.acknowledged_ns = conversation.acknowledged_ns
        self.watchdog_trips = self._trips
        if self.particulars is None:
            self._describe()

    def _describe(self) -> None:
        answer = self.conversation.answer
        if answer is not None:
            self.particulars = _particulars(answer, self.conversation.place.offsets)

    def _step(self, now_ns: int) -> None:
        """Hear what has come, see what time it is, and say what is due."""
        self._mind_stall(now_ns)
        self._hear(now_ns)
        self.conversation.tend(now_ns)
        self._send_due(now_ns)

    def _release(self) -> None:
        conversation = self.conversation
        try:
            silent = conversation.stage is LateroStage.SILENT
            conversation.leave(self._now_ns())
            for _ in range(_LEAVE_STEPS):
                self._step(self._now_ns())
                if conversation.left or (silent and conversation.blades.rests):
                    break
                self._pause(_STEP_S)
        finally:
            self.watchdog.close(all_done=conversation.left)
            self._line.close()
            self._kept.close()


def _particulars(answer: Answer, offsets: Sequence[int] | None) -> Particulars:
    """Tell what the Latero's status words say, and where its encoders are at angle 0."""
    where = "its offsets are not known before it is shown its lower left corner"
    if offsets is not None:
        where = f"offsets={','.join(map(str, offsets))}"
    return Particulars(
        protocol=(
            f"latero, controller {_version(answer.controller)}, "
            f"I/O interface {_version(answer.interface)}, {where}"
        ),
        buttons=2,
    )


def _version(status: int) -> str:
    """Version and revision that a status word tells."""
    return f"{status >> 8 & 0xF}.{status >> 4 & 0xF}"


ANSWER_S: Final = 1.5
# The watchdog of a client that was killed has a second to bring the blades to rest.
_ALONE_S: Final = 2.0
_LOOK_S: Final = 0.001
# Frames must come more often than the watchdog takes the client for dead.
LOWEST_RATE_HZ: Final = 40.0


def open_latero(
    address: str,
    wanted: Display | None,
    *,
    now_ns: Callable[[], int] = time.monotonic_ns,
    pause: Callable[[float], None] = time.sleep,
) -> LateroDevice:
    """Open ``latero:HOST[:PORT][?offsets=N,N,N&power=ADDRESS]``.

    Parameters
    ----------
    address
        What comes after ``latero:``.
    wanted
        Display that the page was laid out for, of which only the rate is looked at.
    now_ns, pause
        Clock, and function that waits for a number of seconds.

    Raises
    ------
    InputError
        If the address is none, or there is no such host.
    DeviceError
        If nothing answers there, something else does, or another program drives the Latero.
    """
    place = parse_latero_address(address)
    rate_hz = DISPLAY.rate_hz if wanted is None else wanted.rate_hz
    if rate_hz < LOWEST_RATE_HZ:
        raise InputError(
            f"the Latero's watchdog takes it to rest when frames are 50 ms apart, and {rate_hz:g} "
            f"a second are asked for; choose {setting('rate')} {LOWEST_RATE_HZ:g} or more"
        )
    found = _resolve(place)
    opened: list[socket.socket] = []
    watchdog = None
    try:
        kept = _keep_others_away(place, found, pause)
        opened.append(kept)
        line = _connect(place, found)
        opened.append(line)
        spare = _connect(place, found)  # the watchdog's
        opened.append(spare)
        conversation = LateroConversation(
            now_ns(),
            period_ns=round(1e9 / rate_hz),
            half_span_mm=DISPLAY.span_mm / 2,
            offsets=place.offsets,
            power=place.power,
            trusted=place.trusted,
        )
        register = place.power or 0
        watchdog = WatchdogProcess(
            bytes(full_request()), bytes(power_off(register)), spare.fileno(), [kept.fileno()]
        )
        spare.close()
        watchdog.beat(now_ns())
        device = LateroDevice(line, conversation, watchdog, kept, now_ns, pause)
        _greet(device, place, now_ns, pause)
        watchdog.board.words[POWER] = conversation.power is not None
    except BaseException:  # a signal's exception, too
        if watchdog is not None:
            watchdog.close()
        for one in opened:
            one.close()
        raise
    return device


def _resolve(place: LateroAddress) -> tuple[str, int]:
    """Address of the host; the Latero knows IPv4 only."""
    try:
        found = socket.getaddrinfo(place.host, place.port, socket.AF_INET, socket.SOCK_DGRAM)
    except (OSError, UnicodeError):
        raise InputError(
            f"there is no host {place.host}; give the Latero's name or address"
        ) from None
    return str(found[0][4][0]), place.port


def _keep_others_away(
    place: LateroAddress, found: tuple[str, int], pause: Callable[[float], None]
) -> socket.socket:
    """Socket that one program on this computer can have for a Latero, as long as it lives.

    Raises
    ------
    DeviceError
        If another program has it.
    """
    kept = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    name = f"\0vbraille-latero-{found[0]}:{found[1]}"
    for left in reversed(range(round(_ALONE_S / 0.05))):
        try:
            kept.bind(name)
        except OSError:
            if left:
                pause(0.05)
                continue
            kept.close()
            raise DeviceError(
                f"another program on this computer drives the Latero at {place.text}; end it, and "
                f"try again"
            ) from None
        break
    return kept


def _connect(place: LateroAddress, found: tuple[str, int]) -> socket.socket:
    """Socket that hears only the Latero."""
    line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        line.connect(found)
    except OSError as error:
        line.close()
        raise DeviceError(
            f"{place.text} cannot be reached ({error.strerror}); look at the network and its cable"
        ) from None
    line.setblocking(False)
    return line


def _greet(
    device: LateroDevice,
    place: LateroAddress,
    now_ns: Callable[[], int],
    pause: Callable[[float], None],
) -> None:
    """Ask until the Latero has answered, with its blades at rest.

    Raises
    ------
    DeviceError
        If it does not.
    """
    conversation = device.conversation
    begun_ns = now_ns()
    while True:
        device.read()
        answer = conversation.answer
        if conversation.stage not in OPENING and conversation.stage is not LateroStage.RAMPING:
            return
        if now_ns() - begun_ns > ANSWER_S * 1e9:
            if conversation.stage is LateroStage.RAMPING:
                return  # answers are lost on the way, and it will be seen
            if answer is not None and answer.interface == NO_IO:
                raise DeviceError(
                    f"the I/O interface of the Latero at {place.text} is unplugged or has no "
                    f"power; plug it in, and try again"
                )
            raise _no_answer(conversation, place)
        pause(_LOOK_S)


def _no_answer(conversation: LateroConversation, place: LateroAddress) -> DeviceError:
    if conversation.other_version:
        return DeviceError(
            f"the Latero at {place.text} speaks another version of its protocol than 1.1, which is "
            f"the only one that vbraille knows; it cannot be read on"
        )
    if conversation.numbering.unasked and not conversation.foreign:
        return DeviceError(
            f"the Latero at {place.text} does not repeat the numbers of requests, so that a late "
            f"answer cannot be told from a new one; it cannot be read on"
        )
    if conversation.foreign:
        return DeviceError(
            f"what answers at {place.text} is no Latero; choose another host or port"
        )
    return DeviceError(
        f"no Latero answers at {place.text}; see that it is on and on this network, or choose "
        f"another host or port"
    )
