"""The stages of a serial conversation, and all that leads from one to another.

`Conversation` moves by this table and by nothing else: what happens in a stage that has no row
for it changes nothing. `docs/wire-protocol.md` prints the same table.
"""

from __future__ import annotations

from enum import Enum
from typing import Final


class Stage(Enum):
    """Where a conversation is; the value says it to those who read the protocol's page."""

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
    """What may lead from one stage to another."""

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
