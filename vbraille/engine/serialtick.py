"""The steady tick of a serial device as one compiled function, some ticks at a time.

It waits for a STATE, with the deadline as the fallback; takes it, advances, makes the FRAME, writes
it and fills the record, with the same functions that `Loop.tick` and `SerialDevice` come to:
`vbraille.devices.serial.steady` and `vbraille.engine.ticks`. Whatever is anything else ends it: an
order in the mailbox, a signal, bytes that are no STATE, a rest, a fault. What it had received is
then given to Python, which does that tick.
"""

from __future__ import annotations

import errno

from numba import njit

from vbraille import libc
from vbraille.caching import keep_compiled
from vbraille.devices.serial import steady
from vbraille.engine.record import LATE, LATENESS, OVERRUNS, WORK
from vbraille.engine.ticks import POSE_X, POSED, advance

# Why it ended, beside that the ticks asked for are done.
DONE, ORDERS, UNSTEADY, NOWHERE, UNMADE, TORN, GONE = range(7)
# What it is told and tells, in whole numbers.
(
    DESCRIPTOR,
    MOST,  # ticks to do
    DEADLINE,  # of the next tick, ns
    PERIOD,  # of the ticks, ns
    GUARD,  # how much before or after its deadline a STATE may have a tick begin, ns
    HELD,  # bytes received and not consumed
    APPENDED,  # records filled so far
    LATE_SO_FAR,
    OVERRUNS_SO_FAR,
    UNSENT,  # FRAMEs that found no room so far
    RESTED,  # how often the device has gone to rest
    WOKEN,  # when the tick that Python is to do woke, ns; 0 if it has not begun
    LATENESS_OF_IT,
    WRITTEN,  # bytes that went out of a FRAME that was torn
    SIZE,  # bytes of that FRAME
) = range(15)
TOLD = 15  # numbers, in all
_EAGAIN, _EINTR = -errno.EAGAIN, -errno.EINTR


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def _changed(orders, known):
    """Whether there is anything new in the mailbox."""
    for word in range(orders.size):  # noqa: SIM110
        if orders[word] != known[word]:
            return True
    return False


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def _receive(told, received, now, talk, work):
    """Read what has come and take its STATEs; how many there were, and why it is not all well."""
    size = libc.read(told[DESCRIPTOR], received, told[HELD])
    if size in (_EAGAIN, _EINTR):
        return 0, DONE
    if size <= 0:
        return 0, GONE
    told[HELD] += size
    consumed, states = steady.take(received, told[HELD], now, talk, work)
    if consumed == steady.SOMETHING_ELSE:
        return 0, UNSTEADY
    told[HELD] -= consumed
    for at in range(told[HELD]):
        received[at] = received[consumed + at]
    return states, DONE


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def _wait(told, received, talk, work):
    """Wait for a tick to begin; when it woke, how many STATEs came, and why there is none.

    With a guard, a STATE that comes about the deadline has the tick begin; one that comes before
    is taken, and waits for it. Without one, the tick begins at its deadline.
    """
    earliest, last = told[DEADLINE] - told[GUARD], told[DEADLINE] + told[GUARD]
    states = 0
    if told[GUARD] == 0:
        if libc.sleep_until_ns(earliest) == _EINTR:
            return 0, 0, ORDERS
        now = libc.clock_ns(libc.CLOCK_MONOTONIC)
        states, why = _receive(told, received, now, talk, work)
        return now, states, why
    while True:
        now = libc.clock_ns(libc.CLOCK_MONOTONIC)
        if now >= last:
            return now, states, DONE
        happened = libc.poll(told[DESCRIPTOR], libc.POLLIN, last - now)
        if happened == _EINTR:
            return 0, states, ORDERS
        if happened == 0:
            continue
        now = libc.clock_ns(libc.CLOCK_MONOTONIC)
        if happened & libc.POLLIN == 0:
            return now, states, GONE
        more, why = _receive(told, received, now, talk, work)
        states += more
        if why != DONE:
            return now, states, why
        if states > 0:
            if now >= earliest:
                return now, states, DONE
            if libc.sleep_until_ns(earliest) == _EINTR:
                return 0, states, ORDERS


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def run(
    told,
    orders,
    known,
    received,
    work,
    out,
    talks,
    actuators,
    state,
    window_ns,
    window_mm,
    velocities,
    output,
    held,
    target,
    at,
    numbers,
    table,
    scratch,
    times_ns,
    poses,
    published,
    ints,
    floats,
    frames,
):
    """Do ticks until there is something for Python to do; why that is.

    Parameters
    ----------
    told : int64[TOLD]
        What it is told and tells, by the names above.
    orders, known : int64[8]
        Words of the mailbox, and what they were when they were last obeyed.
    received : uint8[bytes]
        What was received and not consumed, at its beginning; room for more.
    work, out : uint8[bytes]
        Room to work in, and for a FRAME as it goes over the line.
    talks, actuators
        The conversation, an array of one record, and what FRAMEs are made with; see
        `vbraille.devices.serial.steady`.
    state and on
        See `vbraille.engine.ticks.advance`; the last three are a ring's, and ``published``
        tells its readers how many records there are.

    Returns
    -------
    int64
        DONE, or why a tick is left to Python: ORDERS or a signal; UNSTEADY, for what was received
        is not for here; NOWHERE, for the array cannot be where it is said to be; UNMADE, for the
        FRAME is still to be made or written; TORN, for a part of it went out, which is no tick that
        is left; GONE, for the line is.
    """
    size = ints.shape[0]
    talk = talks[0]
    for _ in range(told[MOST]):
        told[WOKEN] = 0  # of a tick that has not begun yet
        if _changed(orders, known):
            return ORDERS
        now, states, why = _wait(told, received, talk, work)
        if why == ORDERS:
            return ORDERS
        deadline = told[DEADLINE]
        lateness = now - deadline if told[GUARD] == 0 else max(now - deadline - told[GUARD], 0)
        told[WOKEN], told[LATENESS_OF_IT] = now, lateness
        # A STATE that was taken is not lost with the tick that Python does.
        times_ns[0, 0], times_ns[0, 1] = now, talk.device_ns
        poses[0, POSED] = 1.0 if states > 0 else 0.0
        poses[0, POSE_X] = talk.x_mm
        if why != DONE:
            return why
        # Where nothing came at all, nothing was taken, and so nobody has minded these two.
        if steady.stalled(talk, now) or steady.silent(talk, now):
            return UNSTEADY
        slot = told[APPENDED] % size
        published[0] = told[APPENDED]
        done = advance(
            state,
            window_ns,
            window_mm,
            velocities,
            output,
            held,
            target,
            at,
            numbers,
            table,
            scratch,
            times_ns,
            poses,
            told[RESTED],
            True,
            ints,
            floats,
            frames,
            slot,
        )
        if done == 0:
            return NOWHERE
        ends = steady.make(output, now, talk, actuators, out)
        if ends == steady.SOMETHING_ELSE:
            return UNMADE
        written = libc.write(told[DESCRIPTOR], out, 0, ends)
        if written > 0:
            steady.sent(now, talk, actuators)
        elif written == _EAGAIN:
            told[UNSENT] += 1
        else:
            return UNMADE  # Python writes it, and sees what is wrong with the line
        # The next STATE is a period from this one; without one, ticks keep to their deadlines.
        told[DEADLINE] = (now if states > 0 and told[GUARD] > 0 else deadline) + told[PERIOD]
        after = libc.clock_ns(libc.CLOCK_MONOTONIC)
        behind = after - told[DEADLINE]
        if behind >= told[PERIOD]:
            missed = behind // told[PERIOD]
            told[LATE_SO_FAR] += missed
            told[DEADLINE] += missed * told[PERIOD]
        ints[slot, LATENESS] = lateness
        ints[slot, WORK] = after - now
        ints[slot, LATE] = told[LATE_SO_FAR]
        ints[slot, OVERRUNS] = told[OVERRUNS_SO_FAR]
        told[APPENDED] += 1
        told[WOKEN] = 0  # this tick is done, whatever ends them
        if written > 0 and written < ends:
            told[WRITTEN], told[SIZE] = written, ends
            return TORN
    return DONE
