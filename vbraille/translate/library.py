"""The library liblouis: found, and called by one thread that is given up if a call never ends.

liblouis is not thread-safe, so that one thread makes all calls. From some texts it never returns
(3.24: addresses of the web after some dashes), and nothing can end a call but the end of its
thread: that is stopped for ever, and another takes its place. liblouis begins each call anew and
looks at nothing that an earlier one left behind.
"""

from __future__ import annotations

import atexit
import ctypes
import os
import signal
import time
from queue import Empty, SimpleQueue
from threading import Lock, Thread, current_thread
from typing import TYPE_CHECKING, Any, Generic, TypeVar, cast

from vbraille.errors import VbrailleError

if TYPE_CHECKING:
    from collections.abc import Callable

_Value = TypeVar("_Value")

_NAMES = (
    "liblouis.so.20",
    "liblouis.so",
    "liblouis.20.dylib",
    "/opt/homebrew/lib/liblouis.dylib",
    "/usr/local/lib/liblouis.dylib",
    "/home/linuxbrew/.linuxbrew/lib/liblouis.so",
)
# Far more than any text takes, even on machines ten times as slow as is usual.
_TEXT_S, _CHARACTER_S = 0.3, 1e-4
_LOOK_S = 0.05  # how often it is looked whether a call has taken too long
_STOP = signal.SIGRTMAX - 3  # a signal that nothing else sends


class EndlessError(VbrailleError):
    """A call of liblouis that has not returned in its time, and never will."""


def _open() -> ctypes.CDLL:
    """Load liblouis: what its own Python binding has loaded, or else the shared library alone."""
    try:
        import louis

        # What this frees at the end of the process, a call may still be reading.
        atexit.unregister(louis.liblouis.lou_free)
        return louis.liblouis
    except (ImportError, AttributeError):  # none, or the package of that name on PyPI, an empty one
        pass
    for name in _NAMES:
        try:
            return ctypes.CDLL(name)
        except OSError:
            continue
    raise VbrailleError(
        "liblouis is missing, which makes braille of text; install it: apt install python3-louis, "
        "dnf install liblouis, pacman -S liblouis, or brew install liblouis"
    )


LIBRARY = _open()


class _Job(Generic[_Value]):
    """Work for the thread, with the processor time that it may take in seconds."""

    def __init__(self, work: Callable[[], _Value], limit_s: float) -> None:
        self.work = work
        self.limit_s = limit_s
        self.answer: SimpleQueue[tuple[_Value | None, BaseException | None]] = SimpleQueue()


class _Caller(Thread):
    """The thread that calls liblouis."""

    def __init__(self, jobs: SimpleQueue[_Job[Any]]) -> None:
        super().__init__(name="liblouis", daemon=True)
        self._jobs = jobs
        self.job: _Job[Any] | None = None
        self.begun_s = 0.0

    def run(self) -> None:
        # Stopped, it must not be woken by a signal that is for another thread.
        signal.pthread_sigmask(signal.SIG_SETMASK, signal.valid_signals() - {_STOP})
        while True:
            job = self._jobs.get()
            self.begun_s = time.thread_time()
            self.job = job
            try:
                answer = job.work(), None
            except BaseException as error:
                answer = None, error
            self.job = None
            job.answer.put(answer)
            del job, answer

    def stop_late(self) -> bool:
        """Stop for ever if the call that is made takes too long; tell whether it does."""
        job, begun_s = self.job, self.begun_s
        if job is None or self.ident is None:
            return False
        clock = time.pthread_getcpuclockid(self.ident)
        if time.clock_gettime(clock) - begun_s < job.limit_s or self.job is not job:
            return False
        signal.pthread_kill(self.ident, _STOP)
        job.answer.put((None, EndlessError("liblouis does not come to an end")))
        return True


class _Calls:
    """The thread that calls liblouis now, and what it is to do."""

    def __init__(self) -> None:
        self._jobs: SimpleQueue[_Job[Any]] = SimpleQueue()
        self._caller: _Caller | None = None
        self._changing = Lock()
        # The signal's handler is a function that never returns.
        libc = ctypes.CDLL(None)
        libc.signal.argtypes = [ctypes.c_int, ctypes.c_void_p]
        libc.signal(_STOP, ctypes.cast(libc.pause, ctypes.c_void_p))

    def call(self, work: Callable[[], _Value], limit_s: float) -> _Value:
        if current_thread() is self._caller:
            return work()
        if self._caller is None:
            self._begin()
        job = _Job(work, limit_s)
        self._jobs.put(job)
        while True:
            try:
                value, error = job.answer.get(timeout=_LOOK_S)
            except Empty:
                self._look()
                continue
            if error is not None:
                raise error
            return cast("_Value", value)

    def _begin(self) -> None:
        with self._changing:
            if self._caller is None:
                caller = _Caller(self._jobs)
                caller.start()
                self._caller = caller

    def _look(self) -> None:
        with self._changing:
            if self._caller is not None and self._caller.stop_late():
                self._caller = None
        if self._caller is None:
            self._begin()


_calls = _Calls()


def _begin_anew() -> None:
    global _calls
    _calls = _Calls()  # a forked process has no thread but one


os.register_at_fork(after_in_child=_begin_anew)


def limit_s(characters: int) -> float:
    """Processor time that the translation of so many characters may take, in seconds."""
    return _TEXT_S + _CHARACTER_S * characters


def call(work: Callable[[], _Value], limit_s: float = 60.0) -> _Value:
    """Do something that calls liblouis, in the one thread that may.

    To change threads takes as long as to translate a line: much is better done at once. Work may
    do parts of itself by this function, whose limits then do not count.

    Parameters
    ----------
    work
        Function that calls liblouis. No other thread may change what it changes.
    limit_s
        Longest processor time, in seconds.

    Raises
    ------
    EndlessError
        If it takes longer.
    """
    return _calls.call(work, limit_s)
