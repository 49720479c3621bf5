"""The system calls of a tick, for compiled code: read, write, wait and the clocks.

Only functions that numba compiles without Python's lock (``nogil``) call them. Each is a function
of the C library, which the process has loaded anyway: its name is looked up when compiled code is
loaded, so that the code can be kept on disk. A call that fails returns the negative number of its
error (``-errno.EAGAIN``), as calls of the system do. An interrupted call is not begun again
(``-errno.EINTR``): Python has to run the signal's handler first.
"""

import errno
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic

from vbraille.caching import keep_compiled

# Numbers of Linux, where pointers, sizes and seconds have 64 bits.
CLOCK_MONOTONIC = 1
POLLIN = 0x0001
POLLERR = 0x0008
POLLHUP = 0x0010
_TIMER_ABSTIME = 1
_INVALID = -errno.EINVAL
_NS_PER_S = 1_000_000_000

_BYTE, _I16, _I32, _I64 = (ir.IntType(bits) for bits in (8, 16, 32, 64))
_ADDRESS = _BYTE.as_pointer()
_TIMESPEC = ir.LiteralStructType((_I64, _I64))
_POLLFD = ir.LiteralStructType((_I32, _I16, _I16))


def _intrinsic(typed: Callable[..., Any]) -> Any:
    """Make an intrinsic; type checkers would take it for the function that makes it."""
    return intrinsic(typed)


def _call(builder, name, result, *given):
    """Call a function of the C library."""
    function = builder.module.globals.get(name)
    if function is None:
        kind = ir.FunctionType(result, [value.type for value in given])
        function = ir.Function(builder.module, kind, name)
    return builder.call(function, given)


def _local(builder, kind):
    """Make room on the stack, on entry to the function: made in a loop it would grow each time."""
    with builder.goto_entry_block():
        return builder.alloca(kind)


def _field(builder, struct, number):
    return builder.gep(struct, (_I32(0), _I32(number)), inbounds=True)


def _set_time(builder, ns):
    """Put a time, which must not be negative, into a struct timespec."""
    time = _local(builder, _TIMESPEC)
    builder.store(builder.udiv(ns, _I64(_NS_PER_S)), _field(builder, time, 0))
    builder.store(builder.urem(ns, _I64(_NS_PER_S)), _field(builder, time, 1))
    return time


def _or_error(builder, result):
    """Take the result of a call, or -errno if it failed; int64."""
    if result.type != _I64:
        result = builder.sext(result, _I64)
    # Each thread has its errno, and no call comes between: it is that of this call.
    where = _call(builder, "__errno_location", _I32.as_pointer())
    error = builder.neg(builder.sext(builder.load(where), _I64))
    return builder.select(builder.icmp_signed("<", result, _I64(0)), error, result)


def _transfer(name):
    """Make a call that moves bytes between a descriptor and memory."""

    def typed(_context, _descriptor, _address, _size):
        def generate(_context, builder, _signature, given):
            descriptor, address, size = given
            address = builder.inttoptr(address, _ADDRESS)
            return _or_error(builder, _call(builder, name, _I64, descriptor, address, size))

        return types.int64(types.int32, types.uintp, types.int64), generate

    typed.__name__ = typed.__qualname__ = f"_{name}"
    return _intrinsic(typed)


_read = _transfer("read")
_write = _transfer("write")


@_intrinsic
def clock_ns(_context, _clock):
    """Tell the time by a clock, int64, ns; its number is an int32, such as CLOCK_MONOTONIC."""

    def generate(_context, builder, _signature, given):
        time = _local(builder, _TIMESPEC)
        _call(builder, "clock_gettime", _I32, given[0], time)
        seconds = builder.mul(builder.load(_field(builder, time, 0)), _I64(_NS_PER_S))
        return builder.add(seconds, builder.load(_field(builder, time, 1)))

    return types.int64(types.int32), generate


@_intrinsic
def _sleep(_context, _deadline_ns):
    def generate(_context, builder, _signature, given):
        time = _set_time(builder, given[0])
        none = ir.Constant(_TIMESPEC.as_pointer(), None)
        clock, absolute = _I32(CLOCK_MONOTONIC), _I32(_TIMER_ABSTIME)
        # Unlike the others, this call returns its error itself.
        error = _call(builder, "clock_nanosleep", _I32, clock, absolute, time, none)
        return builder.neg(builder.sext(error, _I64))

    return types.int64(types.int64), generate


@_intrinsic
def _poll(_context, _descriptor, _events, _wait_ns):
    def generate(_context, builder, _signature, given):
        descriptor, events, wait_ns = given
        asked = _local(builder, _POLLFD)
        builder.store(descriptor, _field(builder, asked, 0))
        builder.store(events, _field(builder, asked, 1))
        builder.store(_I16(0), _field(builder, asked, 2))
        time = _set_time(builder, wait_ns)
        mask = ir.Constant(_ADDRESS, None)
        result = _call(builder, "ppoll", _I32, asked, _I64(1), time, mask)
        found = builder.sext(builder.load(_field(builder, asked, 2)), _I64)
        happened = builder.icmp_signed(">", result, _I32(0))
        return builder.select(happened, found, _or_error(builder, result))

    return types.int64(types.int32, types.int16, types.int64), generate


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
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
    return _read(descriptor, out.ctypes.data + start, out.size - start)


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def write(descriptor, source, start, end):
    """Write ``source[start:end]``, contiguous; return how many bytes were taken, or -errno."""
    if start < 0 or start > end or end > source.size:
        return _INVALID
    return _write(descriptor, source.ctypes.data + start, end - start)


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def sleep_until_ns(deadline_ns):
    """Wait until a time of the monotonic clock; return 0, or -errno: -EINTR after a signal."""
    return _sleep(max(deadline_ns, 0))


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
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
    return _poll(descriptor, events, max(wait_ns, 0))
