"""Signals of scenes, as kernels: Lévesque 2009, eqs. 9.6-9.10.

They are computed once a tick. A signal has `SIGNAL_NUMBERS` numbers in the program, the first of
which is its kind. What it was before is in its memory, one number behind the values in ``at``.
"""

import math

from vbraille.render.waves import compiled
from vbraille.render.work import (
    MEMORY,
    MOST_SIGNALS,
    SIGNAL,
    SIGNAL_NUMBERS,
    SIGNAL_ROWS,
    SIGNALS,
    SWITCHES,
    TIME,
    VX,
    VY,
)
from vbraille.scene.signals import SWITCH_BITS

# Kinds, and the numbers of each.
SPEED, DIRECTION, SWITCH, CLOCK, PRODUCT, INTEGRAL = map(float, range(6))
# Of SPEED: begin and end of the fall, and the delay. Of DIRECTION: the same two of slow hands, the
# angle, two angles of the fall, whether it is an axis, and what is at rest. Of SWITCH: the time of
# a fade, how many levels there are, and these. Of CLOCK: shape and period. Of PRODUCT: factor, what
# is added, how many signals it is made of, and the numbers of these. Of INTEGRAL: the signal.
AT_REST = ("high", "low", "keep")
SHAPES = ("sine", "square", "ramp")
_HIGH, _KEEP, _SINE, _SQUARE = 0.0, 2.0, 0.0, 1.0  # of these
_LONG_S = 1e9


@compiled
def begin(numbers, at):
    """Have signals remember that all has been for long as it is, when a picture is first shown."""
    for n in range(int(numbers[SIGNALS])):
        at[MEMORY + n] = math.nan


@compiled
def _falling(value, first, last):
    """Fall of eqs. 9.6 and 9.8: 1 below the first, 0 from the last on."""
    return min(max((last - value) / (last - first), 0.0), 1.0)


@compiled
def compute(numbers, at, passed_s):
    """Compute the values of all signals at the velocity, time and switches of ``at``."""
    speed = math.hypot(at[VX], at[VY])
    for n in range(int(numbers[SIGNALS])):
        first = SIGNAL_ROWS + SIGNAL_NUMBERS * n
        kind, own = numbers[first], numbers[first + 1 : first + SIGNAL_NUMBERS]
        before = at[MEMORY + n]
        is_first = before != before
        if kind == SPEED:
            value, delay = _falling(speed, own[0], own[1]), own[2]
            before = _LONG_S if is_first else before + passed_s
            before = before if speed < own[1] else 0.0
            if before < 2.0 * delay:  # eq. 9.7
                value *= max(before - delay, 0.0) / delay
        elif kind == DIRECTION:
            away = abs(math.atan2(at[VY], at[VX]) - own[2])
            away = min(away, 2.0 * math.pi - away)
            if own[5] != 0.0:
                away = min(away, math.pi - away)
            value, slow = _falling(away, own[3], own[4]), _falling(speed, own[0], own[1])
            if own[6] == _HIGH or (own[6] == _KEEP and before != 0.0):
                value = max(value, slow)
                before = 1.0 if value > 0.0 else 0.0
            else:
                value = min(value, 1.0 - slow)
                before = 0.0 if value < 1.0 else 1.0
        elif kind == SWITCH:
            state = int(at[SWITCHES]) >> (SWITCH_BITS * n) & ((1 << SWITCH_BITS) - 1)
            value = own[2 + min(state, int(own[1]) - 1)]
            most = passed_s / own[0] if own[0] > 0.0 else 1.0
            if not is_first:
                value = before + min(max(value - before, -most), most)
            before = value
        elif kind == CLOCK:
            turns = at[TIME] / own[1]
            value = turns - math.floor(turns)
            if own[0] == _SINE:
                value = 0.5 - 0.5 * math.cos(2.0 * math.pi * value)
            elif own[0] == _SQUARE:
                value = 0.0 if value < 0.5 else 1.0
        elif kind == PRODUCT:
            value = own[0]
            for k in range(int(own[2])):
                value *= at[SIGNAL + int(own[3 + k])]
            value += own[1]
        else:
            value = passed_s * at[SIGNAL + int(own[0])] + (0.0 if is_first else before)
            before = value
        at[SIGNAL + n] = value
        at[MEMORY + n] = before


@compiled
def shut_gates(numbers, values):
    """Tell which gates the values of signals shut: a bit for each that is 0, then for each at 1."""
    gates = 0
    for n in range(int(numbers[SIGNALS])):
        if values[n] == 0.0:
            gates |= 1 << n
        elif values[n] == 1.0:
            gates |= 1 << (MOST_SIGNALS + n)
    return gates
