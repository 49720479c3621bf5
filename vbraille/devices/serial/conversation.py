"""The host's end of a serial conversation: no port, no clock, no thread.

It is given the time, bytes that came and what is wanted; it gives places, events, and the
messages that are due, one after the other.

    conversation = Conversation(now_ns)
    while (message := conversation.due()) is not None:
        if port.write(message):
            conversation.sent()
        else:
            conversation.refused()
    pose = conversation.hear(port.read(), now_ns)

`Conversation` goes from stage to stage by `TRANSITIONS` and by nothing else: what happens in a
stage that has no row for it changes nothing. `docs/wire-protocol.md` prints the same table.

A device rests when it is told to, and by its watchdog, perhaps while the host was itself
stopped and could not hear of it. On its ramp to rest a FRAME would jump, and one from after
it too. So a host that has stopped, for whatever reason, sends none until the device has said
for the ramp's time that it rests. It then sends FRAMEs of rest, until the device says that it
has taken one: what that STATE and those after it tell is no older, and the array may fade in.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass
from enum import Enum, auto
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.devices.events import (
    Back,
    Fault,
    Notice,
    Notices,
    Placed,
    Placing,
    Silent,
    Stranger,
    Unplugged,
    WatchdogTripped,
)
from vbraille.devices.serial.hardware import (
    ButtonsAndKnobs,
    CarriagePlace,
    DeviceTime,
    Drive,
    changes,
    differences,
    info_of,
    misfit,
    particulars_of,
)
from vbraille.devices.serial.wire import (
    ANSWER_MS,
    DELIMITER,
    HELLO_PERIOD_MS,
    LOST_MS,
    NOTICES,
    RAMP_MS,
    SILENCE_MS,
    STALL_MS,
    WATCHDOG_MS,
    Decoder,
    Error,
    Hello,
    Info,
    OtherVersion,
    Rest,
    State,
    Watchdog,
    encode,
    unwrap,
)
from vbraille.display import Pose

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.base import Particulars
    from vbraille.devices.calibration import Calibration
    from vbraille.devices.events import Event
    from vbraille.devices.serial.wire import Heard
    from vbraille.display import Display

_log = logging.getLogger(__name__)
_NS_PER_MS: Final = 1_000_000
_STALL_NS: Final = STALL_MS * _NS_PER_MS
_SILENCE_NS: Final = SILENCE_MS * _NS_PER_MS
_LOST_NS: Final = LOST_MS * _NS_PER_MS
# Time in which a device whose timer goes makes several STATEs.
_PAUSE_US: Final = 10_000


# If frames have had nothing to feel for so long, nothing is shown: gaps between words are shorter.
IDLE_MS: Final = 5000
_HELLO: Final = DELIMITER + encode(Hello())  # the zero ends whatever was on the line before
_REST: Final = encode(Rest())
_U16: Final = 0xFFFF
_U32: Final = 0xFFFF_FFFF
_US_PER_S: Final = 1_000_000


class Stage(Enum):
    """Stage of a conversation; the value says it to those who read the protocol's page."""

    GREETING = "HELLO is due, and has not gone out yet"
    ASKED = "HELLO went out, and INFO is waited for"
    RAMPING = "the device goes to rest, or is told to; it is sent no FRAME"
    AT_REST = "the device is at rest; it is sent FRAMEs of rest until it has taken one"
    LIVE = "FRAMEs hold the actuators"
    IDLE_RAMPING = "there is nothing to feel, and the device goes to rest"
    IDLE = "there is nothing to feel, and the device is at rest"
    SILENT = "STATEs are missing; the device is told to rest"
    STRANGER = "what answered cannot be read on, and is told nothing more"
    GONE = "the port is gone"
    FAILED = "the device cannot go on, or none answered at the start"
    CLOSED = "the host has taken leave"


class Cause(Enum):
    """Cause that may lead from one stage to another."""

    ASKED = "HELLO has gone out"
    ANSWERED = "INFO came of a device that can be read on"
    TURNED_AWAY = "INFO came of another device, of another version, or one that cannot be"
    NO_ANSWER = "at the start, no INFO came for 3000 ms"
    HEARD = "STATE came"
    RAMPS = "STATE says *resting*, but not for long enough yet"
    RESTED = "STATEs have said *resting* for the ramp's time and a period"
    HELD = "STATE says that a FRAME holds the actuators that should not"
    TOOK = "STATE says that a FRAME of rest holds the actuators, sent since they rested"
    FELL = "STATE or WATCHDOG says that the device went to rest by itself"
    STALLED = "the host's last FRAME is 40 ms old"
    PLACE_LOST = "the place of the carriage is not known any more"
    NOTHING_TO_FEEL = "FRAMEs had nothing to feel for 5 s"
    FELT = "there is something to feel again"
    REST_WANTED = "the host wants rest"
    SILENCE = "STATE is missing for 100 ms"
    LOST = "STATE is missing for 500 ms"
    UNPLUGGED = "the port went away"
    PLUGGED_IN = "the port is back"
    FAULT = "the device says ERROR or *faulty*, or does not go to rest"
    CLOSED = "the host takes leave"


# What may happen to any device that has answered, wherever its actuators are.
_ANSWERED: Final = {
    Cause.SILENCE: Stage.SILENT,
    Cause.UNPLUGGED: Stage.GONE,
    Cause.FAULT: Stage.FAILED,
    Cause.CLOSED: Stage.CLOSED,
}

TRANSITIONS: Final[dict[Stage, dict[Cause, Stage]]] = {
    Stage.GREETING: {
        Cause.ASKED: Stage.ASKED,
        Cause.NO_ANSWER: Stage.FAILED,
        Cause.REST_WANTED: Stage.GREETING,
        Cause.UNPLUGGED: Stage.GONE,
        Cause.CLOSED: Stage.CLOSED,
    },
    Stage.ASKED: {
        Cause.ANSWERED: Stage.RAMPING,
        Cause.TURNED_AWAY: Stage.STRANGER,
        Cause.NO_ANSWER: Stage.FAILED,
        Cause.REST_WANTED: Stage.ASKED,
        Cause.UNPLUGGED: Stage.GONE,
        Cause.CLOSED: Stage.CLOSED,
    },
    Stage.RAMPING: {
        Cause.RESTED: Stage.AT_REST,
        Cause.TOOK: Stage.LIVE,
        Cause.STALLED: Stage.RAMPING,
        Cause.REST_WANTED: Stage.RAMPING,
        **_ANSWERED,
    },
    Stage.AT_REST: {
        Cause.RAMPS: Stage.RAMPING,
        Cause.HELD: Stage.RAMPING,
        Cause.TOOK: Stage.LIVE,
        Cause.STALLED: Stage.RAMPING,
        Cause.REST_WANTED: Stage.RAMPING,
        **_ANSWERED,
    },
    Stage.LIVE: {
        Cause.FELL: Stage.RAMPING,
        Cause.STALLED: Stage.RAMPING,
        Cause.PLACE_LOST: Stage.RAMPING,
        Cause.NOTHING_TO_FEEL: Stage.IDLE_RAMPING,
        Cause.REST_WANTED: Stage.RAMPING,
        **_ANSWERED,
    },
    Stage.IDLE_RAMPING: {
        Cause.RESTED: Stage.IDLE,
        Cause.FELT: Stage.RAMPING,
        Cause.REST_WANTED: Stage.IDLE_RAMPING,
        **_ANSWERED,
    },
    Stage.IDLE: {
        Cause.RAMPS: Stage.IDLE_RAMPING,
        Cause.HELD: Stage.IDLE_RAMPING,
        Cause.FELT: Stage.AT_REST,
        Cause.REST_WANTED: Stage.IDLE_RAMPING,
        **_ANSWERED,
    },
    Stage.SILENT: {
        Cause.HEARD: Stage.RAMPING,
        Cause.LOST: Stage.GREETING,
        Cause.REST_WANTED: Stage.SILENT,
        Cause.UNPLUGGED: Stage.GONE,
        Cause.FAULT: Stage.FAILED,
        Cause.CLOSED: Stage.CLOSED,
    },
    Stage.STRANGER: {
        Cause.UNPLUGGED: Stage.GONE,
        Cause.CLOSED: Stage.CLOSED,
    },
    Stage.GONE: {
        Cause.PLUGGED_IN: Stage.GREETING,
        Cause.CLOSED: Stage.CLOSED,
    },
    Stage.FAILED: {
        Cause.CLOSED: Stage.CLOSED,
    },
    Stage.CLOSED: {},
}

# Stages in which the device has answered, and what it says is of this conversation.
TALKING: Final = frozenset(
    {
        Stage.RAMPING,
        Stage.AT_REST,
        Stage.LIVE,
        Stage.IDLE_RAMPING,
        Stage.IDLE,
        Stage.SILENT,
    }
)
# Stages in which FRAMEs are wanted, and do not hold the actuators.
RESTING: Final = frozenset({Stage.RAMPING, Stage.AT_REST, Stage.FAILED})
# Stages in which the device is not there to be told that the host takes leave.
UNTOLD: Final = frozenset({Stage.STRANGER, Stage.GONE, Stage.CLOSED})
_GREETING: Final = frozenset({Stage.GREETING, Stage.ASKED})


class Delivery:
    """Knowledge of FRAMEs and rest in one conversation, which begins at rest.

    Parameters
    ----------
    rate_hz
        STATEs a second that the device sends; its ramp ends with a period.

    Attributes
    ----------
    rest_due : bool
        Whether the device must be told to rest: it may not know yet, or not have heard.
    sent_ns : int or None
        Time at which the last FRAME was sent; None if none was since the device was to rest.
    """

    def __init__(self, rate_hz: int) -> None:
        self.rest_due = False
        self.sent_ns: int | None = None
        self._sent = 0  # sequence of the FRAME sent last
        self._ramp_us = RAMP_MS * 1000 + -(-_US_PER_S // rate_hz)
        self._resting_us: int | None = None  # since when it says so, by its own clock
        self._resting_sequence = 0
        self._held_us: int | None = None  # since when a FRAME wrongly holds it, likewise
        self._told_ns: int | None = None
        self._offered: int | None = None  # sequence of the first FRAME of rest sent since

    def sent(self, sequence: int, now_ns: int, *, holding: bool) -> None:
        """Note that a FRAME was sent: one of rest, if FRAMEs are not holding the actuators."""
        if not holding and self._offered is None:
            self._offered = sequence
        self._sent, self.sent_ns = sequence, now_ns

    def told(self, now_ns: int) -> None:
        """Note that REST was sent."""
        self.rest_due, self._told_ns = False, now_ns

    def stop(self, *, tell: bool) -> None:
        """Begin to wait until the device is at rest; with `tell`, have it told to rest."""
        self.rest_due = tell
        self._resting_us = self._held_us = self._told_ns = self._offered = self.sent_ns = None

    def give_time(self, now_ns: int) -> None:
        """Leave going to rest to the device's watchdog for a while, before telling the device."""
        self._told_ns = now_ns + WATCHDOG_MS * _NS_PER_MS

    def stalled(self, now_ns: int) -> bool:
        """Tell whether FRAMEs are owed, and the last is so old that the device may rest by now."""
        return self.sent_ns is not None and now_ns - self.sent_ns >= _STALL_NS

    def judge(self, state: State, now_ns: int) -> Cause:
        """Cause that a STATE gives if the device is not known to be held by FRAMEs."""
        if state.resting:
            return self._rest_on(state)
        if self._has_taken(state.frame_sequence):
            self.rest_due = False
            return Cause.TOOK
        return self._mind_held(state.time_us, now_ns)

    def _rest_on(self, state: State) -> Cause:
        self.rest_due = False
        self._held_us = None
        if self._resting_us is None or state.frame_sequence != self._resting_sequence:
            self._resting_us, self._resting_sequence = state.time_us, state.frame_sequence
        rested_us = (state.time_us - self._resting_us) & _U32
        return Cause.RESTED if rested_us >= self._ramp_us else Cause.RAMPS

    def _has_taken(self, sequence: int) -> bool:
        """Tell whether the FRAME that holds the device is of rest, sent since it went to rest."""
        if self._offered is None:
            return False
        return (sequence - self._offered) & _U16 <= (self._sent - self._offered) & _U16

    def _mind_held(self, time_us: int, now_ns: int) -> Cause:
        """Cause if a FRAME holds it: REST is under way or lost, or an old FRAME came after it."""
        self._resting_us = None
        if self._held_us is None:
            self._held_us = time_us
        if self._told_ns is None or now_ns - self._told_ns >= RAMP_MS * _NS_PER_MS:
            self.rest_due = True
        stuck = (time_us - self._held_us) & _U32 >= LOST_MS * 1000
        return Cause.FAULT if stuck else Cause.HELD


class Trips:
    """Count of a watchdog's trips, by its reports and by STATEs, each trip once.

    Attributes
    ----------
    count : int
        Number of trips since the first WATCHDOG.
    disbelieved : int
        Number of reports that tell of more trips than there was time for.
    """

    def __init__(self) -> None:
        self.count = self.disbelieved = 0
        self._reported_ns = 0
        self._reported: int | None = None
        self._counted = False  # whether the trip that STATEs tell of was counted
        self._unreported = 0  # trips that only STATEs have told of

    @property
    def tripped(self) -> bool:
        """Tell whether the last STATE told of a trip."""
        return self._counted

    def restart(self) -> None:
        """Take the next report for the first one, since a conversation begins."""
        self._reported_ns, self._reported = 0, None
        self._counted, self._unreported = False, 0

    def take_report(self, watchdog: Watchdog, now_ns: int) -> bool:
        """Take a report; tell whether it has new trips that can be believed."""
        tripped = 0 if self._reported is None else (watchdog.trips - self._reported) & _U32
        # A trip takes a frame, and then its time without one; a device's clock may go a bit fast.
        elapsed_ms = (now_ns - self._reported_ns) // _NS_PER_MS
        believable = 1 + elapsed_ms * 5 // (WATCHDOG_MS * 4)
        self._reported, self._reported_ns = watchdog.trips, now_ns
        if tripped > believable:
            self.disbelieved += 1
            return False
        if not tripped:
            return False
        self.count += max(tripped - self._unreported, 0)
        self._unreported = 0
        self._counted = True
        return True

    def take_state(self, *, tripped: bool) -> None:
        """Note whether a STATE tells of a trip; count the trip if its report was lost."""
        if tripped and not self._counted:
            self.count += 1
            self._unreported += 1
        self._counted = tripped


class _Wish(Enum):
    """The kinds of messages that may be due."""

    REST = auto()
    HELLO = auto()
    FRAME = auto()


@dataclass(slots=True)
class States:
    """Knowledge of the STATEs that came.

    Parameters
    ----------
    heard_ns
        Time at which the last STATE came.
    sequence
        Sequence of the last STATE; None before the first of a conversation.
    missed, old
        Number of STATEs that never came, and of those that were dropped because they came twice, or
        after a newer one.
    """

    heard_ns: int
    sequence: int | None = None
    missed: int = 0
    old: int = 0


@dataclass(slots=True)
class Frames:
    """Knowledge of the FRAMEs that were sent.

    Parameters
    ----------
    felt_ns
        Time at which a FRAME last had anything to feel.
    sequence
        Sequence of the last FRAME.
    sent_ns
        Time at which the last FRAME was sent, if it is not acknowledged yet.
    acknowledged_ns
        How long after the last FRAME was wanted the device said that it has it; None if it did
        not.
    """

    felt_ns: int
    sequence: int = 0
    sent_ns: int | None = None
    acknowledged_ns: int | None = None


class Conversation:
    """A conversation with whatever answers, from HELLO until the host takes leave.

    Parameters
    ----------
    now_ns
        Time by a clock that does not go back.
    rate_hz
        FRAMEs a second that will be wanted; None for as many as the device is made for.

    Attributes
    ----------
    stage : Stage
        Stage of the conversation.
    display, info, particulars : Display, Info, Particulars, or None
        What the device said of itself first, and what it says in this conversation; None before.
    failure : Fault, Stranger or None
        Why the device cannot go on, or why none was found at the start.
    heard, speaks : bool
        Whether any bytes have come since the start, and any message from a device.
    drop_unsent : bool
        Whether bytes that wait to be sent must be dropped now; the port then sets it to False.
    no_room : bool
        Whether there was no room for the last FRAME.
    taking : bool
        Whether FRAMEs hold the actuators, or would if there were anything to feel. It is True for
        a device that is away: that the device is silent says enough.
    rested : int
        How often the actuators went to rest otherwise than by FRAMEs, so that all must fade in.
    reconnections : int
        How often the device was greeted again.
    decoder, states, frames, trips, controls, delivery, place, time, drive
        What is known of received bytes, STATEs, FRAMEs, the watchdog, buttons and knobs, rest, the
        carriage, the device's clock, and the actuators. `drive` is set once `info` is.
    """

    drive: Drive
    place: CarriagePlace
    delivery: Delivery

    def __init__(self, now_ns: int, rate_hz: float | None = None) -> None:
        self.stage = Stage.GREETING
        self.display: Display | None = None
        self.info: Info | None = None
        self.particulars: Particulars | None = None
        self.failure: Fault | Stranger | None = None
        self.heard = self.speaks = False
        self.drop_unsent = False
        self.taking = True
        self.rested = self.reconnections = 0
        self.decoder = Decoder()
        self.states = States(now_ns)
        self.frames = Frames(now_ns)
        self.trips = Trips()
        self.controls = ButtonsAndKnobs()
        self.time = DeviceTime()
        self._rate_hz = rate_hz
        self._calibration: Calibration | None = None
        self._notices = Notices()
        self._placing = Placing.DONE
        self._away = False  # from an event that says so to one that it is back
        self.no_room = False  # whether the last FRAME found no room on the line
        self._fell = False  # whether it is to be told that no frame reached it in time
        self._paused = (now_ns, "line")  # when STATEs came again after a pause, and what was late
        self._begun_ns = self._now_ns = self._hello_ns = now_ns
        self._leaving = self._frame_due = False
        self._offer: _Wish | None = None  # the message that was given last

    def hear(self, chunk: bytes, now_ns: int) -> Pose | None:
        """Take the bytes that have come, perhaps none; give the newest place that they tell."""
        self._now_ns = now_ns
        pose = None
        if chunk:
            self.heard = True
            for message in self.decoder.feed(chunk):
                if isinstance(message, State):
                    self.speaks = True
                    if self.stage in TALKING:
                        pose = self._take_state(message, now_ns)
                else:
                    self._take(message, now_ns)
            if self.decoder.bad_info:
                self._turn_away(Stranger(self._name, fault=self.decoder.bad_info), now_ns)
                self.decoder.bad_info = ""
        if self._fell:  # only the STATE that comes with its report tells what was late
            self._fell = False
            since_ns, late = self._paused
            late = late if now_ns - since_ns < _SILENCE_NS else "line"
            self._tell(WatchdogTripped(self.trips.count, late), now_ns)
        self._pass(now_ns)
        return pose

    def correct(self, calibration: Calibration | None) -> None:
        """Make up for what was found of the actuators, now and whenever the device is back."""
        self._calibration = calibration
        self.drive.correct(calibration)

    def _go(self, cause: Cause) -> bool:
        """Go to the stage that a cause leads to; tell whether it leads to one from here."""
        stage = TRANSITIONS[self.stage].get(cause)
        if stage is None:
            return False
        if stage is not self.stage:
            _log.debug("%s to %s: %s", self.stage.name, stage.name, cause.value)
            self.stage = stage
            self.taking = stage not in RESTING
        return True

    @property
    def _name(self) -> str:
        """Name of the device that reading began on; empty before."""
        return self.display.name if self.display is not None else ""

    def _take(self, message: Heard, now_ns: int) -> None:
        """Take a message other than STATE."""
        self.speaks = self.speaks or isinstance(message, Watchdog | Error)
        if isinstance(message, Info):
            if self.stage is not Stage.ASKED:
                pass  # it answers a HELLO from before
            else:
                self._take_info(message, now_ns)
        elif isinstance(message, OtherVersion):
            self._turn_away(Stranger(self._name, version=message.version), now_ns)
        elif self.stage not in TALKING:
            pass  # it belongs to an earlier conversation
        elif isinstance(message, Watchdog):
            if self.trips.take_report(message, now_ns) and self.stage is Stage.LIVE:
                self._fall(Cause.FELL, now_ns)
        elif isinstance(message, Error):
            if message.code < NOTICES:
                self._fail(Fault(self._name, message.code, message.text), now_ns)
            else:
                self._tell(Notice(message.code, message.text), now_ns)

    def _take_state(self, state: State, now_ns: int) -> Pose | None:
        states = self.states
        if states.sequence is not None:
            step = unwrap(state.sequence, states.sequence, 16) - states.sequence
            if step <= 0:
                states.old += 1
                return None
            states.missed += step - 1
            self._mind_pause(state, step, now_ns)
        states.sequence = state.sequence
        states.heard_ns = now_ns
        if self.stage is Stage.SILENT:
            self._go(Cause.HEARD)
            self.rested += 1
        if self._away:
            self._away = False
            self._tell(Back(), now_ns)
        if state.faulty:  # the ERROR that says why was lost
            self._fail(Fault(self._name), now_ns)
            return None
        for event in self.controls.take(state, now_ns):
            self._tell(event, now_ns)
        self.trips.take_state(tripped=state.tripped)
        if self.stage is not Stage.LIVE:
            cause = self.delivery.judge(state, now_ns)
            if cause is Cause.FAULT:
                self._fail(Fault(self._name, stuck=True), now_ns)
                return None
            self._go(cause)
        elif state.resting:
            self._fall(Cause.FELL, now_ns)
        frames = self.frames
        if frames.sent_ns is not None and state.frame_sequence == frames.sequence:
            frames.acknowledged_ns = now_ns - frames.sent_ns
            frames.sent_ns = None
        where = self.place.take(state)
        if self.place.placing is not self._placing:
            self._mind_placing(now_ns)
        time_ns = self.time.ns(state.time_us, now_ns)
        return None if where is None else Pose(time_ns, *where)

    def _mind_pause(self, state: State, step: int, now_ns: int) -> None:
        """Note what was late if STATEs come again; a device counts those that it cannot send."""
        assert self.info is not None
        if self.time.us is None:
            return
        passed_us = unwrap(state.time_us, self.time.us, 32) - self.time.us
        if passed_us >= _PAUSE_US:
            made_us = step * 1_000_000 // self.info.rate_hz
            self._paused = now_ns, "device" if 2 * made_us < passed_us else ""
        elif now_ns - self.states.heard_ns >= _PAUSE_US * 1000:
            self._paused = now_ns, "line"

    def _let_go(self, now_ns: int) -> None:
        """Take the buttons for let go: no hand holds those of a device that is not there."""
        for event in self.controls.let_go(now_ns):
            self._tell(event, now_ns)

    def _mind_placing(self, now_ns: int) -> None:
        if self.place.placing is not self._placing:
            self._placing = self.place.placing
            self._tell(Placed(self._placing), now_ns)

    def _take_info(self, info: Info, now_ns: int) -> None:
        display, fault = info_of(info), misfit(info)
        others = () if self.display is None else differences(self.display, display)
        if others:
            stranger = Stranger(self._name, name=display.name, differences=others)
            self._turn_away(stranger, now_ns)
        elif fault:
            self._turn_away(Stranger(self._name, fault=fault), now_ns)
        elif self._go(Cause.ANSWERED):
            self._begin(info, display, now_ns)

    def _begin(self, info: Info, display: Display, now_ns: int) -> None:
        """Begin to talk with a device, which is at rest."""
        before, self.info = self.info, info
        if before is not None:
            changed = changes(before, info)
            if changed is not None:
                self._tell(changed, now_ns)
            self.reconnections += 1
            self.rested += 1
        self.display = self.display or display
        self.particulars = particulars_of(info)
        self.states.heard_ns, self.states.sequence = now_ns, None
        self.frames.felt_ns = now_ns
        self.trips.restart()
        self.time.restart()
        self.delivery = Delivery(info.rate_hz)
        self.place = CarriagePlace(info)
        self.controls.fit(info.buttons, info.knobs)
        if before is None:
            self._placing = self.place.placing
        self._mind_placing(now_ns)
        own_hz = float(self.display.rate_hz)
        self.drive = Drive(info, now_ns, min(self._rate_hz or own_hz, own_hz))
        self.drive.correct(self._calibration)
        self._rest_frame = np.zeros((info.rows, info.columns))

    def _turn_away(self, stranger: Stranger, now_ns: int) -> None:
        """Say nothing more to a device that is not the one that reading began on."""
        if not self._go(Cause.TURNED_AWAY):
            return
        self._away = True
        self.failure = stranger
        if self.display is not None:
            self._tell(stranger, now_ns)

    def _fail(self, fault: Fault, now_ns: int) -> None:
        if self._go(Cause.FAULT):
            self.failure = fault
            self.delivery.stop(tell=False)
            self._tell(fault, now_ns)

    def _pass(self, now_ns: int) -> None:
        """Check how long nothing has come, and do what is due then."""
        if self.display is None:
            if now_ns - self._begun_ns >= ANSWER_MS * _NS_PER_MS:
                self._go(Cause.NO_ANSWER)
            return
        silent_ns = now_ns - self.states.heard_ns
        if silent_ns < _SILENCE_NS:
            return
        if self._go(Cause.SILENCE):
            self._stop(tell=True)
            self._tell_away(Silent(silent_ns / _NS_PER_MS), now_ns)
        if silent_ns >= _LOST_NS and self._go(Cause.LOST):
            self._hello_ns = now_ns

    def _fall(self, cause: Cause, now_ns: int) -> None:
        """Note that the device went to rest, or may have."""
        self._go(cause)
        self._stop(tell=False)
        self.frames.felt_ns = now_ns
        self.rested += 1
        if cause is Cause.STALLED:
            late = "line" if self.no_room else "host"
            self._tell(WatchdogTripped(self.trips.count, late), now_ns)
        else:
            self._fell = True

    def _stop(self, *, tell: bool) -> None:
        """Send no FRAME until the device is at rest, and drop what waits to be sent."""
        self.delivery.stop(tell=tell)
        self.drop_unsent = True

    def _tell(self, event: Event, now_ns: int) -> None:
        self._notices.add(event, now_ns)

    def _tell_away(self, event: Event, now_ns: int) -> None:
        if not self._away:
            self._tell(event, now_ns)
        self._away = True

    @property
    def steady(self) -> bool:
        """Tell whether FRAMEs hold the actuators, nothing else is due, and all is well."""
        return self.stage is Stage.LIVE and not (self.delivery.rest_due or self.drop_unsent)

    def take_events(self, now_ns: int) -> list[Event]:
        """Events since the last call, each kind once a second at most."""
        return list(self._notices.take(now_ns))

    def lose(self, now_ns: int) -> None:
        """Note that the port is gone."""
        if self._go(Cause.UNPLUGGED):
            self._let_go(now_ns)
            self._tell_away(Unplugged(), now_ns)

    def find(self, now_ns: int) -> None:
        """Note that the port is back; nothing that was said before goes on."""
        if self._go(Cause.PLUGGED_IN):
            self.decoder.feed(DELIMITER)  # what was begun will not be ended
            self._hello_ns = now_ns

    def mind_stall(self, now_ns: int) -> bool:
        """Have the device rest if the host was stopped for so long that it may rest; tell whether.

        What waits to be read is old in that case, and must all be read at once.
        """
        if self.stage not in TALKING or not self.delivery.stalled(now_ns):
            return False
        if self.stage is Stage.LIVE:
            self._fall(Cause.STALLED, now_ns)
        elif self._go(Cause.STALLED):
            self._stop(tell=False)
        self.delivery.give_time(now_ns)
        return True

    def show(self, frame: NDArray[np.float64], now_ns: int) -> None:
        """Have deflections shown, as far as the device is ready for them.

        Parameters
        ----------
        frame : float64[rows, columns]
            Deflections that the actuators are to have, in [0, 1].
        now_ns
            Time of the call, by the same clock.
        """
        self._now_ns = now_ns
        self.frames.acknowledged_ns = self.frames.sent_ns = None
        if self.stage not in TALKING or self.stage is Stage.SILENT:
            return
        if not self.place.known:
            if self._go(Cause.PLACE_LOST):
                self._stop(tell=True)
            return
        self.mind_stall(now_ns)
        if self.stage is Stage.LIVE:
            if self.drive.fill(frame, now_ns):
                self.frames.felt_ns = now_ns
            elif now_ns - self.frames.felt_ns >= IDLE_MS * _NS_PER_MS:
                self._go(Cause.NOTHING_TO_FEEL)
                self.delivery.stop(tell=True)
                return
        else:
            if frame.any():
                self._go(Cause.FELT)
            if self.stage is not Stage.AT_REST:
                return
            self.drive.rested(now_ns)
            self.drive.fill(self._rest_frame, now_ns)
            self.frames.felt_ns = now_ns
        self._frame_due = True

    def rest(self, now_ns: int) -> None:
        """Have the device told to rest: it ramps there, where a FRAME of rest would be a jump."""
        self._now_ns = now_ns
        if self._go(Cause.REST_WANTED):
            self.delivery.stop(tell=True)

    def set_zero(self, now_ns: int) -> None:
        """Take the carriage's place for the left stop: the reader says that it is there."""
        self.place.set_zero()
        self._mind_placing(now_ns)

    def close(self, now_ns: int) -> None:
        """End the conversation: the device is told to rest, if it is there to be told."""
        self._now_ns = now_ns
        there = self.stage not in UNTOLD
        if self._go(Cause.CLOSED):
            self._leaving, self._frame_due = there, False

    # Messages that go out.

    def due(self) -> bytes | None:
        """Next message that is to go out, whole; None if none is due.

        Call `sent` or `refused` before the next call, to tell what became of the message.
        """
        if self._frame_due:
            self._offer = _Wish.FRAME
            return self.drive.frame((self.frames.sequence + 1) & _U16)
        if self._leaving or (self._rest_due and self.stage not in UNTOLD):
            self._offer = _Wish.REST
            return _REST
        if self.stage in _GREETING and self._now_ns >= self._hello_ns:
            self._offer = _Wish.HELLO
            return _HELLO
        return None

    @property
    def _rest_due(self) -> bool:
        return self.info is not None and self.delivery.rest_due

    def sent(self) -> None:
        """Note that the message given last goes out now."""
        now_ns, frames = self._now_ns, self.frames
        if self._offer is _Wish.FRAME:
            self._frame_due = self.no_room = False
            frames.sequence = (frames.sequence + 1) & _U16
            frames.sent_ns = now_ns
            self.drive.sent(now_ns)
            holding = self.stage is Stage.LIVE
            self.delivery.sent(frames.sequence, now_ns, holding=holding)
        elif self._offer is _Wish.REST:
            self._leaving = False
            if self.info is not None:
                self.delivery.told(now_ns)
        else:
            self._hello_ns = now_ns + HELLO_PERIOD_MS * _NS_PER_MS
            self._go(Cause.ASKED)

    def refused(self) -> bool:
        """Note that there was no room for the message given last; tell whether a FRAME was lost.

        Any other message is due again when something comes in the next time.
        """
        self._frame_due = False
        lost = self._offer is _Wish.FRAME
        self.no_room = self.no_room or lost
        if lost:  # its sequence counts: the device is to know how far the next one goes on
            self.frames.sequence = (self.frames.sequence + 1) & _U16
        return lost
