"""A Latero on the network: the talk with it, its watchdog's process, and how both begin.

Every request has a number, and only the newest answer counts: a late one is dropped, and a lost
one is counted and not waited for. Frames are sent while `taking`. Whatever ends that (silence, a
stop of this process, motor power that goes, `rest`, `close`), it is the watchdog that brings the
blades to rest; then the Latero is asked again, with its blades at rest, until it answers so.
"""

from __future__ import annotations

import mmap
import os
import re
import select
import socket
import subprocess
import sys
import time
from contextlib import ExitStack, suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple
from urllib.parse import parse_qsl

import numpy as np

from vbraille.carriers import latero
from vbraille.carriers.carrier import LATERO, LATERO_ARRAY
from vbraille.devices.base import Device, Particulars
from vbraille.devices.events import (
    Back,
    Notice,
    Placed,
    Placing,
    Silent,
    Unplugged,
    WatchdogTripped,
    moved,
)
from vbraille.devices.latero import watchdog as blade_watchdog
from vbraille.devices.latero.watchdog import ACTING, AFTER, BEAT, POWER, TRIPS
from vbraille.devices.latero.wire import (
    BLADES,
    BLADES_AT,
    BUTTONS,
    CONTROLLER,
    ENCODER_ERRORS,
    NO_IO,
    PAGE,
    PORT,
    POWERED_OFF,
    POWERED_ON,
    READ,
    REST,
    WRITE,
    Answer,
    Foreign,
    RawAnswer,
    full_request,
    number,
    parse_answer,
    raw_request,
)
from vbraille.display import Pose
from vbraille.errors import DeviceError, InputError
from vbraille.files import open_memory
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.display import Display

_MS: Final = 1_000_000
_U16: Final = 0xFFFF
DISPLAY: Final = replace(LATERO.under(LATERO_ARRAY), name="Latero", shown_near=True)
# Frames must come more often than the watchdog takes the client for dead.
LOWEST_RATE_HZ: Final = 40.0
# A Latero answers in less; where it does not, the answer to the last frame is there.
AHEAD_NS: Final = 300_000
LATE_NS: Final = 5 * _MS  # an answer that took longer tells an old place
SILENCE_NS: Final = 100 * _MS
STALL_NS: Final = 40 * _MS  # after which the watchdog may act
LOST_NS: Final = 250 * _MS  # after which an answer is not expected any more
ASK_NS, RAW_NS = 5 * _MS, 20 * _MS  # how often it is asked without a frame, and about a register
DEBOUNCE_NS: Final = 5 * _MS
ANSWER_S, PROBE_S = 1.5, 0.2
_TRIES: Final = 10  # to switch motor power on, before the reader is told
# How many frames far blades go at most until the Latero answers again: as docs/wire-protocol.md
# has it of a device, for a Latero shows what it gets at once.
_PACE: Final = 2
# The array's centre may be so far outside what it can reach, by the play of the arms.
BEYOND_MM: Final = 10.0
_MOST_ANSWERS: Final = 256  # that are taken at a time: those of a stopped client wait
_END_S: Final = 2.0  # that the watchdog may take to bring blades to rest

# Notices, each by its code.
POWER_OFF, PLACE, ENCODERS = 1, 2, 3
NO_SWITCH: Final = "how to switch its motor power is unknown, and it stays on; give power=ADDRESS"
WHERE: Final = (
    "the near left corner of a Latero is the lower left one, with its third arm straight up: from "
    "the array it goes straight away from you"
)


class LateroAddress(NamedTuple):
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
    offsets: tuple[int, ...] | None = None
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
        raise InputError(
            "latero: needs the name or the address of a host, as in latero:192.168.1.111"
        )
    if colon and not 1 <= _whole(port) <= _U16:
        raise InputError(f"port is {port!r}; it must be a whole number from 1 to {_U16}")
    offsets, power = None, 0
    options = dict(parse_qsl(query, keep_blank_values=True))
    for name, value in options.items():
        if name == "offsets" and re.fullmatch(r"-?[0-9]{1,10}(,-?[0-9]{1,10}){2}", value):
            offsets = tuple(int(count) & 0xFFFF_FFFF for count in value.split(","))
        elif name == "power" and (value == "none" or 0 <= _whole(value) <= _U16):
            power = None if value == "none" else _whole(value)
        else:
            raise InputError(
                f"a Latero has no option {name}={value}; give offsets=N,N,N, three whole numbers, "
                f"the counts of encoders 0, 1 and 2 at angle 0, or power=N, the controller's "
                f"register that switches motor power, 0 to {_U16}, or power=none"
            )
    port_number = _whole(port) if colon else PORT
    return LateroAddress(host, port_number, offsets, power, "power" in options)


def _whole(text: str) -> int:
    """Number that a text is; -1 if it is none."""
    try:
        return int(text, 16 if "x" in text else 10)
    except ValueError:
        return -1


class WatchdogProcess:
    """A watchdog that watches from now on, until `close`.

    Parameters
    ----------
    socket
        Descriptor of a socket of the watchdog's own, connected to the Latero.
    register
        Register by which motor power is switched off.
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

    def __init__(self, socket: int, register: int, *kept: int) -> None:
        memory = open_memory("vbraille-latero", blade_watchdog.MEMORY_BYTES)
        self.board = blade_watchdog.Board(mmap.mmap(memory, blade_watchdog.MEMORY_BYTES))
        self.board.full[:] = full_request()
        self.board.off[:] = raw_request(WRITE | CONTROLLER, register, POWERED_OFF)
        lifeline, self._lifeline = os.pipe()
        given = memory, lifeline, socket
        self._process = subprocess.Popen(
            [sys.executable, "-I", "-S", blade_watchdog.__file__, *map(str, given)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            pass_fds=(*given, *kept),
            cwd="/",
            start_new_session=True,  # what ends the driver's session does not end it
        )
        os.close(memory)
        os.close(lifeline)
        assert self._process.stdout is not None
        with self._process.stdout as said:
            # A machine may have a lot to do.
            ready, _, _ = select.select([said], (), (), 10.0)
            if not (ready and os.read(said.fileno(), 1)):
                self._process.kill()
                self.close()
                raise DeviceError(
                    "the Latero's watchdog does not begin to watch, and without it no person may "
                    "read on a Latero; try again"
                )

    @property
    def alive(self) -> bool:
        """Tell whether the watchdog lives; this never waits."""
        return self._process.poll() is None

    def rest(self) -> None:
        """Have the blades brought to rest; nothing may be sent until that is done."""
        self.board.words[ACTING] = 1
        with suppress(OSError):  # a watchdog that has ended is found by the next read
            os.write(self._lifeline, b"r")

    def close(self) -> None:
        """Have the watchdog bring the blades to rest, if any was shown, and end; wait for it."""
        os.close(self._lifeline)
        try:
            self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def not_before(sequence: int, other: int) -> bool:
    """Tell whether a number is another one or comes after it, where numbers wrap at 16 bits."""
    return (sequence - other) & _U16 < 0x8000


class Requests:
    """Requests that were sent, by their numbers; lost ones are not waited for.

    Attributes
    ----------
    next : int
        Number of the next request.
    newest : int
        Number of the newest request that was answered.
    lost, late, unasked : int
        How many requests were not answered; how many answers were dropped because they came late
        or twice; and how many because nothing was asked by their number.
    """

    def __init__(self) -> None:
        self.next = 0x4000
        self.newest = self.next - 1
        self.lost = self.late = self.unasked = 0
        self._open: dict[int, int] = {}  # times of those that are not answered, by their numbers

    def sent(self, now_ns: int) -> None:
        """Note that the next request goes out now."""
        for sequence, sent_ns in list(self._open.items()):
            if now_ns - sent_ns <= LOST_NS:
                break
            del self._open[sequence]
            self.lost += 1
        self._open[self.next] = now_ns
        self.next = (self.next + 1) & _U16

    def answered(self, sequence: int, now_ns: int, late_ns: int = LATE_NS) -> int | None:
        """Take the number of an answer; give when its request went out, or None to drop it."""
        sent_ns = self._open.pop(sequence, None)
        if sent_ns is None and (self.next - 1 - sequence) & _U16 >= 0x4000:
            self.unasked += 1
        elif sent_ns is None or now_ns - sent_ns > late_ns or not not_before(sequence, self.newest):
            self.late += 1
        else:
            self.newest = sequence
            return sent_ns
        return None


class LateroDevice(Device):
    """A Latero; `open_latero` makes it begin.

    Parameters
    ----------
    line
        Socket that is connected to the Latero, and does not block.
    watchdog
        The watchdog of it, which watches already.
    address
        What is known of it.
    period_ns
        Time between frames.
    now_ns, pause
        Clock, and function that waits for a number of seconds.

    Attributes
    ----------
    answer : Answer or None
        The last answer that counted.
    requests : Requests
        Requests and the answers to them.
    foreign : dict
        How many datagrams came that are no answer of a Latero, by what they are.
    power : int or None
        Register of the controller that switches motor power; None if it is never switched.
    """

    display = DISPLAY
    acknowledges = True
    ahead_ns = AHEAD_NS

    def __init__(
        self,
        line: socket.socket,
        watchdog: WatchdogProcess,
        address: LateroAddress,
        period_ns: int = _MS,
        now_ns: Callable[[], int] = time.monotonic_ns,
        pause: Callable[[float], None] = time.sleep,
    ) -> None:
        self.watchdog, self.power = watchdog, address.power
        self.requests = Requests()
        self.answer: Answer | None = None
        self.foreign = dict.fromkeys(Foreign, 0)
        self.taking = False
        self.placing = Placing.DONE if address.offsets else Placing.STOP
        self._address, self._offsets = address, address.offsets
        self._line, self._now_ns, self._pause = line, now_ns, pause
        self._late_ns = max(LATE_NS, 2 * period_ns)
        self._events: list[Event] = []
        self._pose: Pose | None = None
        self._room = bytearray(256)
        self._full = full_request()
        self._blades = memoryview(self._full)[BLADES_AT : BLADES_AT + BLADES]
        self._levels = np.frombuffer(self._blades, np.uint8).reshape(8, 8)
        self._at = np.full((8, 8), float(REST))  # levels before they are rounded
        self._behind, self._may_go = 0, _PACE  # by how many frames they are behind, and may go on
        self._frames = self.requests.next, self.requests.next  # numbers of the last two frames
        self._called_ns = self._heard_ns = now_ns()
        self._asked_ns = self._raw_ns = self._called_ns - SILENCE_NS
        self._since = self.requests.next  # the first request with all blades at rest
        self._raw: bytearray | None = None  # RAW that is repeated
        self._register: RawAnswer | None = None
        self._probed = False  # whether it is known how motor power is switched
        # Power is switched on only where we switched it off: at the start, and after a rest.
        self._may_power, self._tries = True, 0
        self._away: Event | None = None  # why nothing can be read
        self._held = self._pressed = 0  # buttons, a bit each: as they are read, and debounced
        self._held_ns = 0
        self._reconnections = self._unsent = self.watchdog_trips = 0

    def greet(self) -> None:
        """Ask until the Latero has answered, with its blades at rest.

        Raises
        ------
        DeviceError
            If it does not.
        """
        if not self._until(lambda: self.answer and self.answer.interface != NO_IO, ANSWER_S):
            raise self._no_answer()
        assert self.answer is not None
        if self.power is not None and not self._address.trusted:
            # Motor power is switched where the status word is, which each answer has.
            self._raw = raw_request(READ | CONTROLLER, self.power)
            self._until(lambda: self._register is not None, PROBE_S)
            content = 0 if self._register is None else self._register.data & ~PAGE
            if not content or content != self.answer.controller & ~PAGE:
                self.power = None
                self._events.append(Notice(POWER_OFF, NO_SWITCH))
            self._raw = None
        self.watchdog.board.words[POWER] = self.power is not None
        self._probed = True
        self._since = self.requests.next
        if self.placing is Placing.STOP:
            self._events.append(Notice(PLACE, WHERE))
        # Where answers are lost on the way, it will be seen.
        self._until(lambda: self.taking or self._tries > 0, ANSWER_S)

    def _until(self, true: Callable[[], object], seconds: float) -> bool:
        """Ask until something is true, for some seconds at most; tell whether it is."""
        until_ns = self._now_ns() + round(seconds * 1e9)
        while not true():
            if self._now_ns() > until_ns:
                return False
            self._pause(0.001)
            self.read()
        return True

    def _no_answer(self) -> DeviceError:
        where = self._address.text
        if self.answer is not None:
            return DeviceError(
                f"the I/O interface of the Latero at {where} is unplugged or has no power; plug it "
                f"in, and try again"
            )
        if self.foreign[Foreign.VERSION]:
            return DeviceError(
                f"the Latero at {where} speaks another version of its protocol than 1.1, which is "
                f"the only one that vbraille knows; it cannot be read on"
            )
        if self.foreign[Foreign.OTHER]:
            return DeviceError(f"what answers at {where} is no Latero; choose another host or port")
        if self.requests.unasked:
            return DeviceError(
                f"the Latero at {where} does not repeat the numbers of requests, so that a late "
                f"answer cannot be told from a new one; it cannot be read on"
            )
        return DeviceError(
            f"no Latero answers at {where}; see that it is on and on this network, or choose "
            f"another host or port"
        )

    @property
    def particulars(self) -> Particulars | None:  # type: ignore[override]
        """Tell where its encoders are at angle 0."""
        where = "its offsets are unknown until it is shown its lower left corner"
        if self._offsets is not None:
            where = f"offsets={','.join(map(str, self._offsets))}"
        return Particulars(f"latero, {where}", buttons=2)

    @property
    def tripped_ms(self) -> float | None:  # type: ignore[override]
        """Time from the last request to when the watchdog last tripped."""
        return self.watchdog.board.words[AFTER] / _MS if self.watchdog_trips else None

    def set_zero(self) -> None:
        """Take the place for the lower left corner with the third arm straight up."""
        if self.answer is not None:
            self._place_by(latero.offsets_at(self.answer.encoders))

    def take_events(self) -> list[Event]:
        """Events since the last call."""
        events, self._events = self._events, []
        return events

    def counts(self) -> Mapping[str, int]:
        """Counts of what went wrong so far, by name."""
        requests = self.requests
        return {
            "frames not sent": self._unsent,
            "requests not answered": requests.lost,
            "late or doubled answers": requests.late,
            "foreign datagrams": sum(self.foreign.values()) + requests.unasked,
            "watchdog trips": self.watchdog.board.words[TRIPS],
            "reconnections": self._reconnections,
        }

    def read(self) -> Pose | None:
        """Newest pose since the last call, or None; this never waits.

        Raises
        ------
        DeviceError
            If the watchdog has ended, without which no person may read on a Latero.
        """
        if not self.watchdog.alive:
            raise DeviceError(
                "the watchdog of the Latero has ended, and without it no person may read; the "
                "blades go to rest, so begin again"
            )
        now_ns = self._now_ns()
        self._mind_watchdog(now_ns)
        with suppress(OSError):  # nothing has come, or no Latero is there
            for _ in range(_MOST_ANSWERS):
                size = self._line.recv_into(self._room)
                self._hear(memoryview(self._room)[:size], now_ns)
        if self._away is None and self.answer and now_ns - self._heard_ns >= SILENCE_NS:
            self._lose(Silent(), now_ns)
        # What is felt is not held by asking for places: the watchdog takes it to rest.
        resting = not self.taking or self._levels.min() == REST
        if resting and now_ns - self._asked_ns >= ASK_NS:
            self._say(self._full, now_ns)
        if self._raw is not None and now_ns - self._raw_ns >= RAW_NS:
            self._raw_ns = now_ns
            self._say(self._raw, now_ns)
        pose, self._pose = self._pose, None
        return pose

    def ask(self) -> None:
        """Ask where the array is: the answer to the last frame would be a whole tick old."""
        now_ns = self._now_ns()
        self._mind_watchdog(now_ns)
        if self.taking:
            self._say(self._full, now_ns)

    def rest(self) -> None:
        """Have the blades brought to rest along a ramp: a frame of rest would be a jump."""
        self._stop()

    def _send(self, frame: NDArray[np.float64]) -> bool:
        """Go towards deflections.

        Where the Latero has not answered what was sent a frame ago it may not have got that:
        levels go on by two frames at most, and what comes after is caught up with.
        """
        now_ns = self._now_ns()
        self._mind_watchdog(now_ns)
        if not self.taking:
            return False
        before, last = self._frames
        if not_before(self.requests.newest, before):
            self._may_go = _PACE
        self._behind += 1
        steps = min(self._behind, self._may_go)
        self._at += (REST - REST * frame - self._at) * (steps / self._behind)
        self._levels[:] = np.clip(np.rint(self._at), 0, REST)
        self._behind -= steps
        self._may_go -= steps
        self._frames = last, self.requests.next
        return self._say(self._full, now_ns)

    def _mind_watchdog(self, now_ns: int) -> None:
        """See whether the watchdog has acted, or may have, while this process was stopped."""
        stopped = now_ns - self._called_ns >= STALL_NS
        self._called_ns = now_ns
        words = self.watchdog.board.words
        if stopped or words[ACTING]:
            self._heard_ns = now_ns  # no request went out meanwhile
        if words[TRIPS] != self.watchdog_trips:
            self.watchdog_trips = words[TRIPS]
            self._events.append(WatchdogTripped(self.watchdog_trips))
            self._stop()
        elif stopped and self.taking and self._levels.min() < REST:
            self._stop()

    def _say(self, request: bytearray, now_ns: int) -> bool:
        """Send a request, unless the watchdog is at work; tell whether it went out."""
        board = self.watchdog.board
        if board.words[ACTING]:
            return False
        # The watchdog knows where the blades are before they are there.
        board.levels[:] = self._blades
        if self.taking:
            board.words[BEAT] = now_ns
        if request is self._full:
            self._asked_ns = now_ns
        number(request, self.requests.next)
        try:
            self._line.send(request)
        except OSError:
            self._unsent += 1
            return False
        self.requests.sent(now_ns)
        return True

    def _stop(self, *, may_power: bool = True) -> None:
        """Have the watchdog bring the blades to rest; what comes after that fades in."""
        self.taking, self._may_power, self._tries, self._raw = False, may_power, 0, None
        self._levels[:] = REST
        self._at[:] = REST
        self._behind = 0
        self._since = self.requests.next
        self.watchdog.rest()

    def _lose(self, why: Event, now_ns: int) -> None:
        """Note that the Latero, or its I/O interface, is not there any more."""
        if self._away is None:
            self._events.append(why)
            self._stop()
            self._press(0, now_ns)  # no hand holds the buttons of a device that is away
        self._away = why

    def _hear(self, datagram: memoryview, now_ns: int) -> None:
        """Take a datagram that has come."""
        answer = parse_answer(datagram)
        if isinstance(answer, Foreign):
            self.foreign[answer] += 1
            return
        # Where no frame is made of it, an old answer says what is to be known as well as a new one.
        late_ns = self._late_ns if self.taking and isinstance(answer, Answer) else SILENCE_NS
        sent_ns = self.requests.answered(answer.sequence, now_ns, late_ns)
        if sent_ns is None:
            return
        self._heard_ns = now_ns
        if isinstance(answer, RawAnswer):
            self._register = answer
            return
        before, self.answer = self.answer, answer
        if answer.sequence == self._frames[1]:
            self.acknowledged_ns = now_ns - sent_ns
        if answer.interface == NO_IO:
            self._lose(Unplugged(), now_ns)
            self._place_by(None)  # encoders that had no power count from anywhere
            return
        if self._away is not None:
            self._away = None
            self._reconnections += 1
            self._events.append(Back())
        if before is not None and answer.interface & ~before.interface & ENCODER_ERRORS:
            self._events.append(
                Notice(ENCODERS, "an encoder has lost steps; show its near left corner")
            )
        self._mind_power(answer)
        held = sum((not answer.dio_in & mask) << bit for bit, mask in enumerate(BUTTONS))
        if held != self._held:
            self._held, self._held_ns = held, now_ns
        elif now_ns - self._held_ns >= DEBOUNCE_NS:
            self._press(held, now_ns)
        self._locate(answer, sent_ns)

    def _mind_power(self, answer: Answer) -> None:
        """Show frames once the blades are at rest and have power, and as long as they have."""
        off = answer.controller & (POWERED_OFF | POWERED_ON) == POWERED_OFF
        if self.taking:
            if off:
                self._stop(may_power=False)  # it was switched off elsewhere
            return
        resting = not_before(answer.sequence, self._since) and self._probed
        if not resting or self.watchdog.board.words[ACTING]:
            return
        if not off:
            self.taking, self._raw = True, None
            self.rested += 1
            return
        if self._may_power and self.power is not None:
            self._raw = raw_request(WRITE | CONTROLLER, self.power, POWERED_ON)
        self._tries += 1
        if self._tries == (_TRIES * RAW_NS // ASK_NS if self._raw else 1):
            why = "its motor power is off; switch it on, and reading goes on"
            self._events.append(Notice(POWER_OFF, why))

    def _press(self, held: int, now_ns: int) -> None:
        """Tell of buttons that were pressed or let go."""
        self._events += moved(self._pressed, held, len(BUTTONS), now_ns)
        self._held = self._pressed = held

    def _locate(self, answer: Answer, sent_ns: int) -> None:
        """Make a pose of the encoders; where the arms cannot be, it is not known any more."""
        if self._offsets is None:
            return
        joints = latero.joints_of(answer.encoders, self._offsets)
        x_mm, y_mm, theta_rad = latero.pose_at(*joints)
        within_mm = [min(max(x_mm, 0.0), latero.WIDTH_MM), min(max(y_mm, 0.0), latero.HEIGHT_MM)]
        if max(abs(x_mm - within_mm[0]), abs(y_mm - within_mm[1])) > BEYOND_MM:
            self._place_by(None)
            return
        self._pose = Pose(sent_ns, within_mm[0] - DISPLAY.span_mm / 2, within_mm[1], theta_rad)

    def _place_by(self, offsets: tuple[int, ...] | None) -> None:
        """Take the encoders' counts at angle 0; None if they are not known any more."""
        self._offsets = offsets
        placing = Placing.STOP if offsets is None else Placing.DONE
        if placing is self.placing:
            return
        self.placing = placing
        self._events.append(Placed(placing))
        if placing is Placing.STOP:
            self._events.append(Notice(PLACE, WHERE))

    def _release(self) -> None:
        try:
            if not self.watchdog.alive:  # then it is for this process to do
                act = blade_watchdog.speaking(self.watchdog.board, self._line.fileno())
                act.begin(self._now_ns())
                while act.acting:
                    act.step(self._now_ns())
                    self._pause(0.001)
            self.watchdog.close()
        finally:
            self._line.close()


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
    try:  # the Latero knows IPv4 only
        found = socket.getaddrinfo(place.host, place.port, socket.AF_INET, socket.SOCK_DGRAM)
    except (OSError, UnicodeError):
        raise InputError(
            f"there is no host {place.host}; give the Latero's name or address"
        ) from None
    peer = found[0][4]
    with ExitStack() as opened:
        kept = opened.enter_context(_keep_others_away(place, f"{peer[0]}:{peer[1]}", pause))
        line, spare = (opened.enter_context(_connect(place, peer)) for _ in range(2))
        # The first and the last are the watchdog's from now on, and stay open as long as it lives.
        watchdog = WatchdogProcess(spare.fileno(), place.power or 0, kept.fileno())
        opened.callback(watchdog.close)
        device = LateroDevice(line, watchdog, place, round(1e9 / rate_hz), now_ns, pause)
        device.greet()
        opened.pop_all()
    kept.close()
    spare.close()
    return device


def _keep_others_away(
    place: LateroAddress, name: str, pause: Callable[[float], None]
) -> socket.socket:
    """Socket that one program on this computer can have for a Latero, as long as it lives.

    Raises
    ------
    DeviceError
        If another program has it.
    """
    kept = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    for _ in range(round(_END_S / 0.05)):  # as the watchdog of a client that was killed has
        with suppress(OSError):
            kept.bind(f"\0vbraille-latero-{name}")
            return kept
        pause(0.05)
    kept.close()
    raise DeviceError(
        f"another program on this computer drives the Latero at {place.text}; end it, and try again"
    )


def _connect(place: LateroAddress, peer: tuple) -> socket.socket:
    """Socket that hears only the Latero."""
    line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        line.connect(peer)
    except OSError as error:
        line.close()
        raise DeviceError(
            f"{place.text} cannot be reached ({error.strerror}); look at the network and its cable"
        ) from None
    line.setblocking(False)
    return line
