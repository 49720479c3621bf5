"""Signals of scenes, as kernels: Lévesque 2009, eqs. 9.6-9.10.

They are computed once a tick. A signal has `SIGNAL_NUMBERS` numbers in the program, the first of
which is its kind. What it was before is in its memory, one number behind the values in ``at``.
"""

import math

from vbraille.render.instructions import SIGNAL_NUMBERS, SIGNAL_ROWS, SIGNALS
from vbraille.render.waves import compiled
from vbraille.render.work import (
    MEMORY,
    MOST_SIGNALS,
    SIGNAL,
    SWITCHES,
    TIME,
    VX,
    VY,
)
from vbraille.scene.signals import SWITCH_BITS

# Kinds, and the numbers of each.
SPEED, DIRECTION, SWITCH, CLOCK, PRODUCT, INVERSE, INTEGRAL = map(float, range(7))
# Of SPEED: begin and end of the fall, and the delay. Of DIRECTION: the same two of slow hands after
# the angle, two angles of the fall, whether it is an axis, and what is at rest. Of SWITCH: the time
# of a fade, how many levels there are, and these. Of CLOCK: shape and period. Of the others: how
# many signals they are made of, and the numbers of these.
HIGH, LOW, KEEP = 0.0, 1.0, 2.0
SINE, SQUARE, RAMP = 0.0, 1.0, 2.0
_LONG_S = 1e9


@compiled
def begin(numbers, at):
    """Have signals remember that all has been for long as it is, when a picture is first shown."""
    for n in range(int(numbers[SIGNALS])):
        kind = numbers[SIGNAL_ROWS + SIGNAL_NUMBERS * n]
        at[MEMORY + n] = 0.0
        if kind == SPEED:
            at[MEMORY + n] = _LONG_S
        elif kind == DIRECTION:
            at[MEMORY + n] = 1.0
        elif kind == SWITCH:
            at[MEMORY + n] = math.nan


@compiled
def _falling(value, first, last):
    """Fall of eqs. 9.6 and 9.8: 1 below the first, 0 from the last on."""
    if value < first:
        return 1.0
    return (last - value) / (last - first) if value < last else 0.0


@compiled
def compute(numbers, at, passed_s):
    """Compute the values of all signals at the velocity, time and switches of ``at``."""
    for n in range(int(numbers[SIGNALS])):
        row = SIGNAL_ROWS + SIGNAL_NUMBERS * n
        kind, memory, value = numbers[row], MEMORY + n, 0.0
        if kind == SPEED:
            speed = math.hypot(at[VX], at[VY])
            if speed >= numbers[row + 2]:
                at[memory] = 0.0
            else:
                value = _falling(speed, numbers[row + 1], numbers[row + 2])
                at[memory] += passed_s
                delay = numbers[row + 3]
                if at[memory] < 2.0 * delay:  # eq. 9.7
                    value *= max(at[memory] - delay, 0.0) / delay
        elif kind == DIRECTION:
            away = abs(math.atan2(at[VY], at[VX]) - numbers[row + 1])
            away = min(away, 2.0 * math.pi - away)
            if numbers[row + 6] != 0.0:
                away = min(away, math.pi - away)
            value = _falling(away, numbers[row + 4], numbers[row + 5])
            slow = _falling(math.hypot(at[VX], at[VY]), numbers[row + 2], numbers[row + 3])
            rest = numbers[row + 7]
            if rest == HIGH or (rest == KEEP and at[memory] != 0.0):
                value = max(value, slow)
                at[memory] = 1.0 if value > 0.0 else 0.0
            else:
                value = min(value, 1.0 - slow)
                at[memory] = 0.0 if value < 1.0 else 1.0
        elif kind == SWITCH:
            state = int(at[SWITCHES]) >> (SWITCH_BITS * n) & ((1 << SWITCH_BITS) - 1)
            state = min(state, int(numbers[row + 2]) - 1)
            value = numbers[row + 3 + state]
            most = passed_s / numbers[row + 1] if numbers[row + 1] > 0.0 else 1.0
            if at[memory] == at[memory]:
                value = at[memory] + min(max(value - at[memory], -most), most)
            at[memory] = value
        elif kind == CLOCK:
            turns = at[TIME] / numbers[row + 2]
            turns -= math.floor(turns)
            if numbers[row + 1] == SINE:
                value = 0.5 - 0.5 * math.cos(2.0 * math.pi * turns)
            elif numbers[row + 1] == SQUARE:
                value = 0.0 if turns < 0.5 else 1.0
            else:
                value = turns
        elif kind == PRODUCT:
            value = 1.0
            for k in range(int(numbers[row + 1])):
                value *= at[SIGNAL + int(numbers[row + 2 + k])]
        elif kind == INVERSE:
            value = 1.0 - at[SIGNAL + int(numbers[row + 2])]
        else:
            at[memory] += passed_s * at[SIGNAL + int(numbers[row + 2])]
            value = at[memory]
        at[SIGNAL + n] = value


@compiled
def shut_gates(numbers, values):
    """Tell which gates the values of signals shut: bits as `words.SHUT_BY` has them."""
    gates = 0
    for n in range(int(numbers[SIGNALS])):
        if values[n] == 0.0:
            gates |= 1 << n
        elif values[n] == 1.0:
            gates |= 1 << (MOST_SIGNALS + n)
    return gates
