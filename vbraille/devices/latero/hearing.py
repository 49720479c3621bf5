"""What a Latero answers, and where that leads: the half of `LateroConversation` that hears.

It has no socket, no clock and no thread. Every request has a number, and only the newest answer
counts: a late one is dropped, and a lost one is counted and not waited for.
"""

from __future__ import annotations

import logging
from enum import Enum, auto
from typing import TYPE_CHECKING, Final

from vbraille.devices.events import (
    Back,
    Button,
    Notice,
    Placed,
    Placing,
    Silent,
    Unplugged,
)
from vbraille.devices.latero.armplace import ArmPlace
from vbraille.devices.latero.blades import Blades
from vbraille.devices.latero.datagrams import (
    BUTTONS,
    ENCODER_ERRORS,
    NO_IO,
    PAGE,
    POWERED_OFF,
    POWERED_ON,
    Answer,
    Foreign,
    RawAnswer,
    parse_answer,
)
from vbraille.devices.latero.debouncing import Debounced
from vbraille.devices.latero.numbering import LATE_NS, Fate, Numbering, not_before
from vbraille.devices.serial.notices import Notices
from vbraille.pose import Pose

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.devices.events import Event

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
    """Where the talk is."""

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


class LateroHearing:
    """Half of a talk that hears: a base of `LateroConversation`, not to be used by itself.

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
    numbering : Numbering
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
        self.numbering = Numbering(first)
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
        self._notices = Notices()
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
        # Power is switched on only by whoever switched it off: at the start, and after a rest.
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
        """Note that nobody knows the register that switches motor power."""
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
            self._may_power = False  # somebody else has switched it off
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

    def _fall_silent(self, silent_ns: int) -> None:
        if self.stage is not LateroStage.SILENT:
            if self.stage is not LateroStage.BLIND:
                self._tell(Silent(silent_ns / 1e6))
            self.blades.begin_ramp(self._now_ns)
            self._go(LateroStage.SILENT)
            self._let_go()
            self._versions = self.other_version
        elif self.other_version > self._versions and not self._told_version:
            self._told_version = True
            self._tell(Notice(VERSION, OTHER_VERSION))

    def _let_go(self) -> None:
        """Take the buttons for let go: nobody holds those of a device that is not there."""
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
        self._notices.add(event, self._now_ns)


def unpowered(answer: Answer) -> bool:
    """Whether an answer says that motor power is off."""
    return answer.controller & (POWERED_OFF | POWERED_ON) == POWERED_OFF
