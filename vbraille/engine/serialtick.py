"""The steady tick of a serial device as one compiled function, some ticks at a time.

It waits for a STATE, with the deadline as the fallback; takes it, advances, makes the FRAME, writes
it and fills the record, with the same functions that `Loop.tick` and `SerialDevice` come to:
`vbraille.devices.serial.kernels` and `vbraille.engine.ticks`. Anything else ends it: an order
in the mailbox, a signal, bytes that are no STATE, a rest, a fault. Python then gets what had been
received, and does that tick.

The system calls of a tick are functions of the C library, which the process has loaded anyway:
each name is looked up when compiled code is loaded, so that the code can be kept on disk. Only what
numba compiles without Python's lock (``nogil``) calls them. A call that fails returns the negative
number of its error (``-errno.EAGAIN``), as calls of the system do. An interrupted call is not begun
again (``-errno.EINTR``): Python has to run the signal's handler first.
"""

from __future__ import annotations

import errno

import numpy as np
from numba import njit, types
from numba.np.numpy_support import carray

from vbraille.caching import keep_compiled
from vbraille.devices.serial import kernels
from vbraille.engine.record import LATE, LATENESS, OVERRUNS, WORK
from vbraille.engine.ticks import POSE_THETA, POSE_X, POSE_Y, POSED, advance

# Numbers of Linux, where pointers, sizes and seconds have 64 bits.
CLOCK_MONOTONIC = 1
POLLIN = 0x0001
_TIMER_ABSTIME = 1
_INVALID = -errno.EINVAL
_NS_PER_S = 1_000_000_000

_int, _long, _address = types.int32, types.int64, types.uintp
_read = types.ExternalFunction("read", _long(_int, _address, _long))
_write = types.ExternalFunction("write", _long(_int, _address, _long))
_ppoll = types.ExternalFunction("ppoll", _int(_address, _long, _address, _address))
_gettime = types.ExternalFunction("clock_gettime", _int(_int, _address))
_nanosleep = types.ExternalFunction("clock_nanosleep", _int(_int, _int, _address, _address))
_errno = types.ExternalFunction("__errno_location", types.CPointer(_int)())
_compiled = njit(cache=keep_compiled(), error_model="numpy", nogil=True)


@_compiled
def _or_error(result):
    """Take the result of a call, or -errno if it failed; int64."""
    # Each thread has its errno, and no call comes between: it is that of this call.
    return np.int64(result) if result >= 0 else -np.int64(carray(_errno(), 1)[0])


@_compiled
def clock_ns(clock):
    """Tell the time by a clock, int64, ns; its number is an int32, such as CLOCK_MONOTONIC."""
    time = np.empty(2, np.int64)
    _gettime(clock, time.ctypes.data)
    return time[0] * _NS_PER_S + time[1]


@_compiled
def read(descriptor, out, start):
    """Read what has come into ``out[start:]``.

    Parameters
    ----------
    descriptor : int64
        The descriptor of an open file that does not block.
    out : uint8[bytes]
        Memory for the bytes, contiguous.
    start : int64
        Index in ``out`` at which to begin.

    Returns
    -------
    int64
        Number of bytes read, 0 at the end of the file; -errno if reading fails, -EINVAL if
        ``start`` is outside ``out``.
    """
    if start < 0 or start > out.size:
        return _INVALID
    return _or_error(_read(descriptor, out.ctypes.data + start, out.size - start))


@_compiled
def write(descriptor, source, start, end):
    """Write ``source[start:end]``, contiguous; return how many bytes were taken, or -errno."""
    if start < 0 or start > end or end > source.size:
        return _INVALID
    return _or_error(_write(descriptor, source.ctypes.data + start, end - start))


@_compiled
def sleep_until_ns(deadline_ns):
    """Wait until a time of the monotonic clock; return 0, or -errno: -EINTR after a signal."""
    time = np.empty(2, np.int64)
    time[0], time[1] = divmod(max(deadline_ns, 0), _NS_PER_S)
    # Unlike the others, this call returns its error itself.
    return -np.int64(_nanosleep(CLOCK_MONOTONIC, _TIMER_ABSTIME, time.ctypes.data, 0))


@_compiled
def poll(descriptor, events, wait_ns):
    """Wait for an event on a descriptor, for so long at most.

    Parameters
    ----------
    descriptor : int64
        The descriptor of an open file.
    events : int64
        1 (POLLIN) to wait for bytes; errors and the line's end are waited for in any case.
    wait_ns : int64
        How long to wait at most, in ns; 0 or less looks and does not wait.

    Returns
    -------
    int64
        What has happened, as bits; 0 if nothing has; -errno if that fails: -EINTR after a signal.
    """
    room = np.empty(3, np.int64)  # struct timespec, and struct pollfd: descriptor, events, result
    room[0], room[1] = divmod(max(wait_ns, 0), _NS_PER_S)
    room[2] = (descriptor & 0xFFFF_FFFF) | events << 32
    count = _ppoll(room.ctypes.data + 16, 1, room.ctypes.data, 0)
    return (room[2] >> 48) & 0xFFFF if count > 0 else _or_error(count)


# Reasons why it ended, apart from DONE.
DONE, ORDERS, UNSTEADY, NOWHERE, UNMADE, TORN, GONE = range(7)
# Places of the whole numbers that it is told, and that it tells.
(
    DESCRIPTOR,
    MOST,  # ticks to do
    DEADLINE,  # deadline of the next tick, ns
    PERIOD,  # period of the ticks, ns
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
TOLD = 15  # how many numbers there are in all
# A truth of a type: `True` itself would have ticks compiled for it and for all others.
_TAKING = np.bool_(True)
_EAGAIN, _EINTR = -errno.EAGAIN, -errno.EINTR


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def _changed(orders, known):
    """Tell whether there is anything new in the mailbox."""
    for word in range(orders.size):  # noqa: SIM110
        if orders[word] != known[word]:
            return True
    return False


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def _receive(told, received, now, talk, work):
    """Read what has come and take its STATEs; return their number, and a reason to stop, if any."""
    size = read(told[DESCRIPTOR], received, told[HELD])
    if size in (_EAGAIN, _EINTR):
        return 0, DONE
    if size <= 0:
        return 0, GONE
    told[HELD] += size
    consumed, states = kernels.take(received, told[HELD], now, talk, work)
    if consumed == kernels.SOMETHING_ELSE:
        return 0, UNSTEADY
    told[HELD] -= consumed
    for at in range(told[HELD]):
        received[at] = received[consumed + at]
    return states, DONE


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def _wait(told, received, talk, work):
    """Wait for a tick to begin; return when it woke, how many STATEs came, and a reason to stop.

    With a guard, the time about the deadline in which a STATE may begin the tick, a STATE that
    comes earlier is taken and waits. Without a guard the tick begins at its deadline.
    """
    earliest, last = told[DEADLINE] - told[GUARD], told[DEADLINE] + told[GUARD]
    states = 0
    if told[GUARD] == 0:
        if sleep_until_ns(earliest) == _EINTR:
            return 0, 0, ORDERS
        now = clock_ns(CLOCK_MONOTONIC)
        states, why = _receive(told, received, now, talk, work)
        return now, states, why
    while True:
        now = clock_ns(CLOCK_MONOTONIC)
        if now >= last:
            return now, states, DONE
        happened = poll(told[DESCRIPTOR], POLLIN, last - now)
        if happened == _EINTR:
            return 0, states, ORDERS
        if happened == 0:
            continue
        now = clock_ns(CLOCK_MONOTONIC)
        if happened & POLLIN == 0:
            return now, states, GONE
        more, why = _receive(told, received, now, talk, work)
        states += more
        if why != DONE:
            return now, states, why
        if states > 0:
            if now >= earliest:
                return now, states, DONE
            if sleep_until_ns(earliest) == _EINTR:
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
    """Do ticks until there is something for Python to do; return the reason.

    Parameters
    ----------
    told : int64[TOLD]
        What this function is told and what it tells, each at the place named above.
    orders, known : int64[8]
        Words of the mailbox, and their values when they were last obeyed.
    received : uint8[bytes]
        Bytes that were received and not consumed come first; the rest is room for more.
    work, out : uint8[bytes]
        Room to work in, and for a FRAME as it goes over the line.
    talks, actuators
        The state of the conversation, an array of one record, and how FRAMEs are made; see
        `vbraille.devices.serial.kernels`.
    state and on
        See `vbraille.engine.ticks.advance`; the last three belong to a ring, and ``published``
        tells its readers how many records there are.

    Returns
    -------
    int64
        DONE, or the reason why a tick is left to Python: ORDERS if there is an order or a signal;
        UNSTEADY if what was received is more than STATEs; NOWHERE if the array cannot be where it
        is said to be; UNMADE if the FRAME is still to be made or written; GONE if the line is
        gone. TORN, after a FRAME that went out in part, leaves no tick: that one is done.
    """
    size = ints.shape[0]
    talk = talks[0]
    for _ in range(told[MOST]):
        told[WOKEN] = 0  # the tick has not begun yet
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
        poses[0, POSE_Y] = talk.y_mm
        poses[0, POSE_THETA] = talk.theta_rad
        if why != DONE:
            return why
        # Taking a STATE looks after these two; where nothing came, they are looked after here.
        if kernels.stalled(talk, now) or kernels.silent(talk, now):
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
            _TAKING,
            ints,
            floats,
            frames,
            slot,
        )
        if done == 0:
            return NOWHERE
        ends = kernels.make(output, now, talk, actuators, out)
        if ends == kernels.SOMETHING_ELSE:
            return UNMADE
        written = write(told[DESCRIPTOR], out, 0, ends)
        if written > 0:
            kernels.sent(now, talk, actuators)
        elif written == _EAGAIN:
            kernels.unsent(talk)
            told[UNSENT] += 1
        else:
            return UNMADE  # Python writes it, and sees what is wrong with the line
        # The next STATE is a period from this one; without one, ticks keep to their deadlines.
        told[DEADLINE] = (now if states > 0 and told[GUARD] > 0 else deadline) + told[PERIOD]
        after = clock_ns(CLOCK_MONOTONIC)
        state[0]["done_ns"] = after
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
