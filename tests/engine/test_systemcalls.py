"""System calls from compiled code, on real pipes: what they return, and that Python goes on."""

import errno
import os
import select
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress

import numba
import numpy as np
import pytest

from vbraille.engine import serialtick as libc

pytestmark = pytest.mark.skipif(
    numba.config.DISABLE_JIT, reason="only compiled code calls the C library"
)
LONG_NS = 60_000_000_000
SCRIPT = """
import os
import select
import numpy as np
from vbraille.engine import serialtick as libc
reader, writer = os.pipe()
os.write(writer, b"abc")
out = np.zeros(8, np.uint8)
print(libc.read(reader, out, 2), out.tobytes(), libc.read(-1, out, 0), end=" ")
print(sum(libc.read.stats.cache_hits.values()))
"""


@numba.njit
def clock_ns(clock):
    return libc.clock_ns(clock)


@pytest.fixture
def pipe():
    reader, writer = os.pipe()
    os.set_blocking(reader, False)
    os.set_blocking(writer, False)
    yield reader, writer
    for descriptor in (reader, writer):
        with suppress(OSError):  # the test may have closed it
            os.close(descriptor)


@pytest.fixture
def soon():
    """A signal in a moment."""
    heard = []
    before = signal.signal(signal.SIGALRM, lambda *_: heard.append(True))
    signal.setitimer(signal.ITIMER_REAL, 0.01, 0.01)  # again, in case compiling takes longer
    yield heard
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


def test_what_is_read_stands_where_it_was_asked_for(pipe):
    reader, writer = pipe
    out = np.zeros(8, np.uint8)
    os.write(writer, b"abcdefgh")
    assert libc.read(reader, out, 5) == 3
    assert out.tobytes() == b"\0\0\0\0\0abc"
    assert libc.read(reader, out[1:4], 0) == 3
    assert out.tobytes() == b"\0def\0abc"


def test_what_is_written_is_the_part_that_was_named(pipe):
    reader, writer = pipe
    assert libc.write(writer, np.frombuffer(b"abcdefgh", np.uint8), 2, 6) == 4
    assert os.read(reader, 100) == b"cdef"


def test_failures_are_negative_errors(pipe):
    reader, writer = pipe
    out = np.zeros(8, np.uint8)
    assert libc.read(reader, out, 0) == -errno.EAGAIN
    assert libc.read(writer, out, 0) == -errno.EBADF
    assert libc.write(reader, out, 0, 8) == -errno.EBADF
    while (taken := libc.write(writer, np.zeros(1 << 16, np.uint8), 0, 1 << 16)) > 0:
        pass
    assert taken == -errno.EAGAIN
    os.close(reader)
    assert libc.write(writer, out, 0, 8) == -errno.EPIPE


def test_the_end_of_a_file_is_no_bytes(pipe):
    reader, writer = pipe
    os.close(writer)
    assert libc.read(reader, np.zeros(8, np.uint8), 0) == 0
    assert libc.poll(reader, libc.POLLIN, LONG_NS) == select.POLLHUP


@pytest.mark.parametrize("start", [-1, 9, 1 << 40])
def test_no_memory_outside_an_array_is_read_or_written(pipe, start):
    reader, writer = pipe
    os.write(writer, b"abc")
    array = np.zeros(8, np.uint8)
    assert libc.read(reader, array, start) == -errno.EINVAL
    assert libc.write(writer, array, start, start + 1) == -errno.EINVAL
    assert libc.write(writer, array, 0, 9) == -errno.EINVAL
    assert libc.write(writer, array, 4, 3) == -errno.EINVAL
    assert os.read(reader, 100) == b"abc"


def test_polling_tells_what_has_happened(pipe):
    reader, writer = pipe
    assert libc.poll(reader, libc.POLLIN, 0) == 0
    assert libc.poll(reader, libc.POLLIN, -5) == 0
    begun_ns = time.monotonic_ns()
    assert libc.poll(reader, libc.POLLIN, 1_000_000) == 0
    assert time.monotonic_ns() - begun_ns >= 1_000_000
    os.write(writer, b"a")
    assert libc.poll(reader, libc.POLLIN, LONG_NS) == libc.POLLIN


def test_other_threads_run_while_one_waits(pipe):
    reader, writer = pipe
    thread = threading.Timer(0.01, os.write, (writer, b"a"))
    libc.poll(reader, libc.POLLIN, 0)  # compiled before that
    thread.start()
    assert libc.poll(reader, libc.POLLIN, LONG_NS) == libc.POLLIN
    thread.join()


def test_a_signal_ends_the_waiting(pipe, soon):
    assert libc.poll(pipe[0], libc.POLLIN, LONG_NS) == -errno.EINTR
    assert soon
    assert libc.sleep_until_ns(time.monotonic_ns() + LONG_NS) == -errno.EINTR


def test_a_sleep_ends_at_its_deadline_and_not_before():
    assert libc.sleep_until_ns(-1) == libc.sleep_until_ns(0) == 0
    deadline_ns = time.monotonic_ns() + 1_000_000
    assert libc.sleep_until_ns(deadline_ns) == 0
    assert time.monotonic_ns() >= deadline_ns


@pytest.mark.parametrize(
    ("clock", "of_python"),
    [
        (libc.CLOCK_MONOTONIC, time.monotonic_ns),
        (time.CLOCK_THREAD_CPUTIME_ID, time.thread_time_ns),
    ],
)
def test_the_clocks_are_those_of_python(clock, of_python):
    before = of_python()
    between = clock_ns(clock)
    assert before <= between <= of_python()


def test_another_process_uses_what_one_has_compiled():
    def said():
        return subprocess.run(
            [sys.executable, "-c", SCRIPT], check=True, capture_output=True, text=True
        ).stdout.rsplit(maxsplit=1)

    first, second = said(), said()
    filled = b"\0\0abc\0\0\0"
    assert first[0] == second[0] == f"3 {filled} {-errno.EBADF}"
    assert second[1] == "1"
