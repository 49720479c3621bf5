"""The client's end of the talk with a Latero: no socket, no clock, no thread.

It is given the time, datagrams that came and what is wanted; it gives places, events, and the
requests that are due, one after the other:

    conversation = LateroConversation(now_ns)
    conversation.hear(socket.recv(256), now_ns)
    conversation.tend(now_ns)
    while (request := conversation.due()) is not None:
        socket.send(request)
        conversation.sent()
    pose = conversation.take_pose()

Every request has a number, and only the newest answer counts: a late one is dropped, and a lost
one is counted and not waited for.
"""

from __future__ import annotations

import logging
from enum import Enum, auto
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.carriers import latero
from vbraille.devices.events import (
    Back,
    Button,
    Notice,
    Placed,
    Placing,
    Silent,
    Throttle,
    Unplugged,
    WatchdogTripped,
)
from vbraille.devices.latero.wire import (
    BLADES,
    BLADES_AT,
    BUTTONS,
    CONTROLLER,
    ENCODER_ERRORS,
    NO_IO,
    PAGE,
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

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.devices.events import Event

# The array's centre may be so far outside what it can reach, by the play of the arms.
BEYOND_MM: Final = 10.0


class ArmPlace:
    """Place of the array; unknown until its offsets are given or it is shown to be at reset.

    Parameters
    ----------
    offsets
        Counts of encoders 0, 1 and 2 at angle 0 of their joints; None if they are not known.

    Attributes
    ----------
    placing : Placing
        What is waited for before the place is known.
    """

    def __init__(self, offsets: Sequence[int] | None) -> None:
        self._encoders: tuple[int, ...] | None = None  # that were told last
        self.offsets = offsets
        self.placing = Placing.STOP if offsets is None else Placing.DONE

    def take(self, encoders: tuple[int, ...]) -> tuple[float, float, float] | None:
        """Take counts; give x and y in mm and θ in radians, or None if they are not known.

        x and y are those of the array's centre from the upper left of what it can reach. Where
        the arms cannot be, the place is not known any more.
        """
        self._encoders = encoders
        if self.offsets is None:
            return None
        joints = latero.joints_of(encoders, self.offsets)
        x_mm, y_mm, theta_rad = latero.pose_at(*joints)
        if not (
            -BEYOND_MM <= x_mm <= latero.WIDTH_MM + BEYOND_MM
            and -BEYOND_MM <= y_mm <= latero.HEIGHT_MM + BEYOND_MM
        ):
            self.forget()
            return None
        return (
            min(max(x_mm, 0.0), latero.WIDTH_MM),
            min(max(y_mm, 0.0), latero.HEIGHT_MM),
            theta_rad,
        )

    def set_zero(self) -> None:
        """Take the place for that of the reset: lower left, the third arm straight up."""
        if self._encoders is not None:
            self.offsets = latero.offsets_at(self._encoders)
            self.placing = Placing.DONE

    def forget(self) -> None:
        """Forget the offsets: the encoders do not count from there any more."""
        self.offsets, self.placing = None, Placing.STOP


DEBOUNCE_NS: Final = 5_000_000


class Debounced:
    """State of one button.

    Attributes
    ----------
    pressed : bool
        Whether the button is down, as far as that is certain.
    """

    def __init__(self) -> None:
        self.pressed = False
        self._reading = False
        self._since_ns = 0

    def take(self, reading: bool, now_ns: int) -> bool:
        """Take a reading, True while the contact is closed; tell whether `pressed` changes."""
        if reading != self._reading:
            self._reading, self._since_ns = reading, now_ns
            return False
        if reading == self.pressed or now_ns - self._since_ns < DEBOUNCE_NS:
            return False
        self.pressed = reading
        return True

    def let_go(self) -> bool:
        """Take the button for let go, as of a device that is away; tell whether that changes it."""
        was, self.pressed, self._reading = self.pressed, False, False
        return was


# Requests whose answers are still known to be late or doubled when they come.
KEPT: Final = 256
# An answer that took longer tells an old place: the author's client waits for so long.
LATE_NS: Final = 5_000_000
_U16: Final = 0xFFFF
_HALF: Final = 0x8000


def not_before(sequence: int, other: int) -> bool:
    """Tell whether a number is another one or comes after it, where numbers wrap at 16 bits."""
    return (sequence - other) & _U16 < _HALF


class Fate(Enum):
    """Judgement of an answer by its number."""

    NEW = "new"
    LATE = "late"  # it tells an old place, and is dropped
    DOUBLED = "doubled"  # the same answer came before
    UNASKED = "unasked"  # nothing was asked by this number


class RequestNumbering:
    """Requests that were sent, by their numbers; lost ones are not waited for.

    Parameters
    ----------
    first
        Number of the first request.

    Attributes
    ----------
    late, doubled, unasked : int
        How many answers were dropped, by what they were.
    next : int
        Number of the next request.
    lost : int
        How many requests were never answered, of those that are older than the last few.
    """

    def __init__(self, first: int = 1) -> None:
        self.late = self.doubled = self.unasked = 0
        self.next = first & _U16
        self._newest: int | None = None  # the newest request that was answered
        self._sent_ns = [0] * KEPT
        self._numbers = [-1] * KEPT
        self._open = [False] * KEPT
        self._sent = 0
        self.lost = 0

    @property
    def caught_up(self) -> bool:
        """Tell whether the newest request was answered, so that nothing newer can come."""
        return self._newest is not None and self._newest == (self.next - 1) & _U16

    def sent(self, now_ns: int) -> int:
        """Note that a request goes out now; give its number."""
        sequence = self.next
        at = sequence % KEPT
        self.lost += self._open[at]
        self._numbers[at], self._sent_ns[at], self._open[at] = sequence, now_ns, True
        self.next = (sequence + 1) & _U16
        return sequence

    def sent_ns(self, sequence: int) -> int:
        """Time at which a request went out whose answer is new."""
        return self._sent_ns[sequence % KEPT]

    def judge(self, sequence: int, now_ns: int, late_ns: int = LATE_NS) -> Fate:
        """Judge an answer by its number.

        Parameters
        ----------
        sequence
            Number that the answer bears.
        now_ns
            When it came, by the clock of `sent`.
        late_ns
            Time after its request from which an answer tells an old place.
        """
        at = sequence % KEPT
        if self._numbers[at] != sequence:
            return self._unknown(sequence)
        if not self._open[at]:
            self.doubled += 1
            return Fate.DOUBLED
        self._open[at] = False
        overtaken = self._newest is not None and not not_before(sequence, self._newest)
        if overtaken or now_ns - self._sent_ns[at] > late_ns:
            self.late += 1
            return Fate.LATE
        self._newest = sequence
        return Fate.NEW

    def _unknown(self, sequence: int) -> Fate:
        """Judge an answer to a request that is not kept: it was long ago, or never."""
        if not_before(self.next - 1, sequence) and self._numbers[sequence % KEPT] != -1:
            self.late += 1
            self.lost = max(self.lost - 1, 0)  # none is, if it was answered in time as well
            return Fate.LATE
        self.unasked += 1
        return Fate.UNASKED


ROWS: Final = 8
RAMP_NS: Final = 20_000_000
# How many frames far blades go at most until the Latero answers again: as docs/wire-protocol.md
# has it of a device, for a Latero shows what it gets at once.
_PACE: Final = 2
# The ramp goes on by no more than this in one step, so that a late step is no jump.
_MOST_STEP_NS: Final = 2_000_000


class Blades:
    """Levels that are sent; nothing outside 0 … `REST` ever is.

    Attributes
    ----------
    request : bytearray
        FULL with these levels.
    levels : uint8[64]
        View of the levels in the request, blade 8 · row + column.
    view : memoryview
        The same, for other memory to take them from.
    at_rest : bool
        Whether the ramp has come to its end; False from the next frame on, whatever that shows.
    """

    def __init__(self) -> None:
        self.request = full_request()
        whole = np.frombuffer(self.request, np.uint8)
        self.levels = whole[BLADES_AT : BLADES_AT + BLADES]
        self.at_rest = True
        self.view = memoryview(self.request)[BLADES_AT : BLADES_AT + BLADES]
        self._grid = self.levels.reshape(ROWS, ROWS)
        self._at = np.full(BLADES, float(REST))  # before they are rounded
        self._grid_at = self._at.reshape(ROWS, ROWS)
        self._stepped_ns = 0
        self._behind = 0  # by how many frames the levels are behind
        self._may_go = _PACE  # how many frames far they may go as yet

    @property
    def rests(self) -> bool:
        """Tell whether all levels are those of rest."""
        return bool(self.levels.min() == REST)

    def show(self, frame: NDArray[np.float64], *, heard: bool = True) -> None:
        """Go towards deflections; this allocates nothing.

        Parameters
        ----------
        frame : float64[8, 8]
            Deflections, in [0, 1].
        heard
            Whether the Latero has answered what was sent a frame ago. If not, it may not have got
            that: levels go on by two frames at most, and what comes after is caught up with.
        """
        self._behind += 1
        if heard:
            self._may_go = _PACE
        steps = min(self._behind, self._may_go)
        self._may_go -= steps
        wanted = REST - REST * frame
        self._grid_at += (wanted - self._grid_at) * (steps / self._behind)
        self._grid[:] = np.clip(np.rint(self._grid_at), 0, REST)
        self._behind -= steps
        self.at_rest = False

    def stand_at(self, levels: bytes | memoryview, now_ns: int) -> None:
        """Begin the ramp to rest at levels."""
        self._behind = 0
        self._at[:] = np.frombuffer(levels, np.uint8)
        np.minimum(self._at, float(REST), out=self._at)
        self._stepped_ns = now_ns

    def begin_ramp(self, now_ns: int) -> None:
        """Begin the ramp to rest at the levels that were sent last."""
        self._behind = 0
        self._at[:] = self.levels
        self._stepped_ns = now_ns

    def ramp(self, now_ns: int) -> None:
        """Go on along the ramp: a blade goes its whole way in 20 ms, or less of it in as long."""
        passed_ns = min(now_ns - self._stepped_ns, _MOST_STEP_NS)
        self._stepped_ns = now_ns
        np.add(self._at, REST * passed_ns / RAMP_NS, out=self._at)
        np.minimum(self._at, float(REST), out=self._at)
        np.copyto(self.levels, np.ceil(self._at), casting="unsafe")
        self.at_rest = self.rests


_log = logging.getLogger(__name__)
NAME: Final = "Latero"
# As in the serial protocol.
SILENCE_NS: Final = 100_000_000
STALL_NS: Final = 40_000_000
# How often it is asked without a frame to send, and a register is written or read again.
ASK_NS: Final = 5_000_000
RAW_NS: Final = 20_000_000
# How long a register is waited for at the start, and motor power before the reader is told.
PROBE_NS: Final = 200_000_000
# Without rest the ramp goes on, and is not to be late.
RAMP_ASK_NS: Final = 2_000_000
# Codes of notices.
POWER, PLACE, ENCODERS, VERSION = 1, 2, 3, 4


WHERE: Final = (
    "the near left corner of a Latero is the lower left one, with its third arm straight up: from "
    "the array it goes straight away from you"
)
NO_SWITCH: Final = (
    "how its motor power is switched is not known, so that it stays on; give power=ADDRESS"
)
OTHER_VERSION: Final = (
    "what answers now speaks another version of the Latero's protocol; reading goes on when the "
    "Latero is back"
)


class LateroStage(Enum):
    """Stage of the talk with a Latero."""

    ASKING = auto()  # nothing has answered yet
    PROBING = auto()  # it has, and is asked for the register of its motor power
    RAMPING = auto()  # the blades go to rest, and frames are not shown
    POWERING = auto()  # they are there, without power
    LIVE = auto()  # frames are shown
    SILENT = auto()  # nothing answers any more
    BLIND = auto()  # the Latero answers, and its I/O interface is away
    LEAVING = auto()  # the client takes leave


_TAKING: Final = frozenset({LateroStage.LIVE, LateroStage.SILENT, LateroStage.BLIND})
OPENING: Final = frozenset({LateroStage.ASKING, LateroStage.PROBING})


class LateroConversation:
    """The talk with a Latero.

    Parameters
    ----------
    now_ns
        Time by a clock that does not go back.
    period_ns
        Time between frames.
    half_span_mm
        Half of the distance between the array's outer columns: x is counted from there.
    offsets
        Counts of the encoders at angle 0, if they are known.
    power
        Register of the controller that switches motor power; None if it is never switched.
    trusted
        Whether that register is surely the one. Otherwise it is read first, and used only if it
        has the status word that each answer has.
    first
        Number of the first request.

    Attributes
    ----------
    stage : LateroStage
        Where the talk is.
    blades : Blades
        What is sent to the blades.
    numbering : RequestNumbering
        Requests and the answers to them.
    place : ArmPlace
        What is known of the arms.
    answer : Answer or None
        The last answer that counted.
    foreign, other_version : int
        How many datagrams came that are no answer of a Latero, and how many of them are of another
        version of the protocol.
    rested : int
        How often the blades went to rest otherwise than by frames, after which all must fade in.
    taking : bool
        Whether frames are shown, or would be if the Latero were there.
    acknowledged_ns : int or None
        How long after the last frame was sent its answer came.
    reconnections : int
        How often the Latero or its I/O interface came back.
    """

    def __init__(
        self,
        now_ns: int,
        *,
        period_ns: int = 1_000_000,
        half_span_mm: float = 0.0,
        offsets: Sequence[int] | None = None,
        power: int | None = None,
        trusted: bool = True,
        first: int = 1,
    ) -> None:
        self.stage = LateroStage.ASKING
        self.blades = Blades()
        self.numbering = RequestNumbering(first)
        self.place = ArmPlace(offsets)
        self.power = power
        self.answer: Answer | None = None
        self.foreign = self.other_version = 0
        self.rested = self.reconnections = 0
        self.taking = False
        self.acknowledged_ns: int | None = None
        self._trusted = trusted
        self._half_span_mm = half_span_mm
        self._late_ns = max(LATE_NS, 2 * period_ns)
        self._notices = Throttle()
        self._buttons = tuple(Debounced() for _ in BUTTONS)
        self._pose: Pose | None = None
        self._now_ns = self._heard_ns = self._begun_ns = self._tended_ns = now_ns
        self._asked_ns = self._shown_ns = self._raw_ns = now_ns - SILENCE_NS
        self._frame = -1  # number of the request that had the last frame
        self._resting: int | None = None  # number of the first that had all blades at rest
        self._full_due = False
        # Whether an answer has counted since the last frame, and between that and the one before.
        self._heard = self._heard_before = False
        self._offer: bytearray | None = None
        self._raw: bytearray | None = None
        # Power is switched on only where we switched it off: at the start, and after a rest.
        self._may_power = True
        self._told_power = self._told_version = False
        self._versions = 0  # datagrams of another version when the Latero fell silent

    # What comes in.

    def hear(self, datagram: bytes | bytearray | memoryview, now_ns: int) -> None:
        """Take a datagram that has come."""
        self._now_ns = now_ns
        answer = parse_answer(datagram)
        if isinstance(answer, Foreign):
            self.foreign += 1
            self.other_version += answer is Foreign.VERSION
            return
        # Where no frame is made of it, an old answer says what is to be known as well as a new one.
        matters = self.stage is LateroStage.LIVE and isinstance(answer, Answer)
        late_ns = self._late_ns if matters else SILENCE_NS
        if self.numbering.judge(answer.sequence, now_ns, late_ns) is not Fate.NEW:
            return
        self._heard_ns, self._heard = now_ns, True
        if isinstance(answer, RawAnswer):
            self._take_register(answer)
        else:
            self._take(answer)

    def take_pose(self) -> Pose | None:
        """Newest place since the last call, or None."""
        pose, self._pose = self._pose, None
        return pose

    def take_events(self, now_ns: int) -> list[Event]:
        """Events since the last call, each kind once a second at most."""
        return list(self._notices.take(now_ns))

    def _take(self, answer: Answer) -> None:
        """Take an answer that counts."""
        before, self.answer = self.answer, answer
        if answer.sequence == self._frame and self.acknowledged_ns is None:
            sent_ns = self.numbering.sent_ns(answer.sequence)
            self.acknowledged_ns = self._now_ns - sent_ns
        if self.stage is LateroStage.LEAVING:
            return
        if answer.interface == NO_IO:
            self._lose_interface()
            return
        if self.stage is LateroStage.ASKING:
            probes = self.power is not None and not self._trusted
            self._go(LateroStage.PROBING if probes else LateroStage.RAMPING)
            self._begun_ns = self._now_ns
            if self.place.placing is Placing.STOP:
                self._tell(Notice(PLACE, WHERE))
        elif self.stage in (LateroStage.SILENT, LateroStage.BLIND):
            self.reconnections += 1
            self._tell(Back())
            self._told_version = False
            self._stop()
        if before is not None and answer.interface & ~before.interface & ENCODER_ERRORS:
            self._tell(Notice(ENCODERS, "an encoder has lost steps; show its near left corner"))
        self._mind_power(answer)
        self._mind_buttons(answer.dio_in)
        self._mind_rest(answer)
        self._mind_place(answer)

    def _take_register(self, answer: RawAnswer) -> None:
        """Take what a register holds: if it is the status word, motor power is switched there."""
        if self.stage is LateroStage.PROBING and self.answer is not None:
            if (answer.data ^ self.answer.controller) & ~PAGE or not answer.data & ~PAGE:
                self._do_without_power()
            self._go(LateroStage.RAMPING)

    def _do_without_power(self) -> None:
        """Note that the register that switches motor power is unknown."""
        self.power = None
        self._tell(Notice(POWER, NO_SWITCH))

    def _lose_interface(self) -> None:
        """Note that encoders and buttons are not there any more."""
        if self.stage in OPENING or self.stage is LateroStage.BLIND:
            return
        if self.stage is not LateroStage.SILENT:
            self._tell(Unplugged())
        self.blades.begin_ramp(self._now_ns)
        self._go(LateroStage.BLIND)
        self._let_go()
        self.place.forget()  # encoders that had no power count from anywhere
        self._tell_place()

    def _mind_power(self, answer: Answer) -> None:
        off = unpowered(answer)
        if self.stage is LateroStage.LIVE and off:
            self._may_power = False  # it was switched off elsewhere
            self._stop()
        elif self.stage is LateroStage.POWERING and not off:
            self._told_power = False
            self._go_live()

    def _mind_buttons(self, dio_in: int) -> None:
        for n, (mask, button) in enumerate(zip(BUTTONS, self._buttons, strict=True), start=1):
            if button.take(not dio_in & mask, self._now_ns):
                self._tell(Button(n, button.pressed, at_ns=self._now_ns))

    def _mind_rest(self, answer: Answer) -> None:
        """Go on once the Latero has answered a request that had all blades at rest."""
        if self.stage is not LateroStage.RAMPING or self._resting is None:
            return
        if not not_before(answer.sequence, self._resting):
            return
        if unpowered(answer):
            self._begun_ns = self._now_ns
            self._go(LateroStage.POWERING)
        else:
            self._go_live()

    def _mind_place(self, answer: Answer) -> None:
        before = self.place.placing
        place = self.place.take(answer.encoders)
        if self.place.placing is not before:
            self._tell_place()
        if place is None:
            return
        x_mm, y_mm, theta_rad = place
        time_ns = self.numbering.sent_ns(answer.sequence)
        self._pose = Pose(time_ns, x_mm - self._half_span_mm, y_mm, theta_rad)

    def _go(self, stage: LateroStage) -> None:
        if stage is not self.stage:
            _log.debug("%s to %s", self.stage.name, stage.name)
        self.stage, self.taking = stage, stage in _TAKING

    def _go_live(self) -> None:
        self.rested += 1
        self._may_power = False
        self._go(LateroStage.LIVE)

    def _stop(self) -> None:
        """Take the blades to rest along the ramp, from where they are."""
        self.blades.begin_ramp(self._now_ns)
        self.blades.at_rest = False
        self._resting = None
        self._go(LateroStage.RAMPING)

    def _fall_silent(self) -> None:
        if self.stage is not LateroStage.SILENT:
            if self.stage is not LateroStage.BLIND:
                self._tell(Silent())
            self.blades.begin_ramp(self._now_ns)
            self._go(LateroStage.SILENT)
            self._let_go()
            self._versions = self.other_version
        elif self.other_version > self._versions and not self._told_version:
            self._told_version = True
            self._tell(Notice(VERSION, OTHER_VERSION))

    def _let_go(self) -> None:
        """Take the buttons for let go: no hand holds those of a device that is not there."""
        for n, button in enumerate(self._buttons, start=1):
            if button.let_go():
                self._tell(Button(n, pressed=False, at_ns=self._now_ns))

    def _tell_power(self) -> None:
        if not self._told_power:
            self._told_power = True
            self._tell(Notice(POWER, "its motor power is off; switch it on, and reading goes on"))

    def _tell_place(self) -> None:
        self._tell(Placed(self.place.placing))
        if self.place.placing is Placing.STOP:
            self._tell(Notice(PLACE, WHERE))

    def _tell(self, event: Event) -> None:
        self._notices.add(event)

    # What is wanted.

    def show(self, frame: NDArray[np.float64], now_ns: int) -> None:
        """Have deflections shown, float64[8, 8] in [0, 1], if the blades are ready for them."""
        self._now_ns = self._shown_ns = now_ns
        # An answer to what was asked since says that the last frame is there, but perhaps only now.
        heard = self.acknowledged_ns is not None or self._heard_before
        self._heard_before, self._heard = self._heard, False
        self.acknowledged_ns = None
        self._frame = -1
        if self.stage is LateroStage.LIVE:
            self.blades.show(frame, heard=heard)
        else:
            self.blades.ramp(now_ns)
        self._full_due = True

    def ask(self, now_ns: int) -> None:
        """Ask where the array is, by the frame that is shown, for the next one to be made."""
        self._now_ns = now_ns
        self._full_due = self.stage is LateroStage.LIVE

    def rest(self, now_ns: int) -> None:
        """Take the blades to rest along the ramp; frames after that fade in."""
        self._now_ns = now_ns
        if self.stage is LateroStage.LIVE:
            self._stop()

    def leave(self, now_ns: int) -> None:
        """Take leave: blades to rest, then motor power off, until both are answered."""
        self._now_ns = now_ns
        self._stop()
        self._go(LateroStage.LEAVING)

    @property
    def left(self) -> bool:
        """Tell whether the Latero has answered that its blades rest and its motor power is off."""
        answer = self.answer
        if answer is None or self._resting is None:
            return False
        unpowered_now = self.power is None or unpowered(answer)
        return unpowered_now and not_before(answer.sequence, self._resting)

    def stall(self, levels: bytes | memoryview, trips: int, now_ns: int) -> None:
        """Note that the client was stopped, so that the watchdog may have acted.

        Parameters
        ----------
        levels
            Levels at which the blades stand now.
        trips
            How often the watchdog has acted.
        now_ns
            Present time.
        """
        self._now_ns = now_ns
        self._begun_ns = self._heard_ns = now_ns  # what came meanwhile is judged by its own time
        if self.stage is LateroStage.LIVE:
            self._stop()
            self._tell(WatchdogTripped(trips))
        self._may_power = True  # the watchdog may have switched it off
        self._resting = None
        self.blades.stand_at(levels, now_ns)

    def set_zero(self, now_ns: int) -> None:
        """Take the place for that of the reset: the reader says that the array is there."""
        self._now_ns = now_ns
        before = self.place.placing
        self.place.set_zero()
        if self.place.placing is not before:
            self._tell(Placed(self.place.placing))

    def tend(self, now_ns: int) -> None:
        """Mind what time brings: silence, the ramp, and what must be asked again."""
        self._now_ns = now_ns
        if now_ns - self._tended_ns >= STALL_NS:
            self._heard_ns = self._begun_ns = now_ns  # no request went out meanwhile
        self._tended_ns = now_ns
        stage = self.stage
        if stage is LateroStage.PROBING and now_ns - self._begun_ns > PROBE_NS:
            self._do_without_power()
            self._go(LateroStage.RAMPING)
        elif stage not in OPENING and stage is not LateroStage.LEAVING:
            silent_ns = now_ns - self._heard_ns
            if silent_ns >= SILENCE_NS:
                self._fall_silent()
        if stage is LateroStage.POWERING and now_ns - self._begun_ns > PROBE_NS:
            self._tell_power()
        stage = self.stage
        if stage is LateroStage.LIVE:
            # What is felt is not held by asking for places: the watchdog takes it to rest.
            if now_ns - self._asked_ns >= ASK_NS and self.blades.rests:
                self._full_due = True
        elif now_ns - self._asked_ns >= (ASK_NS if self.blades.at_rest else RAMP_ASK_NS):
            self.blades.ramp(now_ns)
            self._full_due = True

    # What goes out.

    def due(self) -> bytearray | None:
        """Next request that is to go out; call `sent` or `refused` before the next call."""
        if self._full_due:
            self._offer = self.blades.request
        else:
            self._offer = self._raw = self._raw_due()
        if self._offer is not None:
            number(self._offer, self.numbering.next)
        return self._offer

    def sent(self) -> None:
        """Note that the request given last has gone out."""
        sequence = self.numbering.sent(self._now_ns)
        if self._offer is self._raw:
            self._raw_ns = self._now_ns
            return
        self._full_due = False
        self._asked_ns = self._now_ns
        if self._shown_ns == self._now_ns:
            self._frame = sequence
        if self.blades.at_rest and self._resting is None:
            self._resting = sequence

    def refused(self) -> None:
        """Note that the request given last could not be sent: it is dropped, not kept."""
        self._full_due = False
        self._raw_ns = self._now_ns

    def _raw_due(self) -> bytearray | None:
        """RAW that is due, as far as one is: what switches power is said until it is answered."""
        power, stage = self.power, self.stage
        if power is None or self._now_ns - self._raw_ns < RAW_NS:
            return None
        if stage is LateroStage.PROBING:
            return raw_request(READ | CONTROLLER, power)
        if stage is LateroStage.POWERING:
            on = raw_request(WRITE | CONTROLLER, power, POWERED_ON)
            return on if self._may_power else None
        if stage in _AWAY and self.blades.at_rest:
            self._may_power = True
            return power_off(power)
        return None


def unpowered(answer: Answer) -> bool:
    """Tell whether an answer says that motor power is off."""
    return answer.controller & (POWERED_OFF | POWERED_ON) == POWERED_OFF


_AWAY = frozenset({LateroStage.SILENT, LateroStage.BLIND, LateroStage.LEAVING})


def power_off(register: int) -> bytearray:
    """Request that switches motor power off."""
    return raw_request(WRITE | CONTROLLER, register, POWERED_OFF)
