"""The system calls of a tick, for compiled code: read, write, wait and the clocks.

Only functions that numba compiles without Python's lock (``nogil``) call them. Each is a function
of the C library, which the process has loaded anyway: its name is looked up when compiled code is
loaded, so that the code can be kept on disk. A call that fails returns the negative number of its
error (``-errno.EAGAIN``), as calls of the system do. An interrupted call is not begun again
(``-errno.EINTR``): Python has to run the signal's handler first.
"""

import errno

import numpy as np
from numba import njit, types
from numba.np.numpy_support import carray

from vbraille.caching import keep_compiled

# Numbers of Linux, where pointers, sizes and seconds have 64 bits.
CLOCK_MONOTONIC = 1
POLLIN = 0x0001
POLLERR = 0x0008
POLLHUP = 0x0010
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
        POLLIN to wait for bytes; POLLERR and POLLHUP are waited for in any case.
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
