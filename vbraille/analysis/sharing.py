"""Work of one kind that a second processor shares: sessions to read, figures to draw.

The results are those that one process makes, in the same order. Processes are forks, which need no
time to load anything; so there are none where forks are not safe, beside other threads.
"""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import signal
import threading
from concurrent.futures.process import BrokenProcessPool, ProcessPoolExecutor
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

Item = TypeVar("Item")
Found = TypeVar("Found")
_FEWEST = 4  # pieces of work for which a second process is begun
_MOST_PROCESSES = 4
_PR_SET_PDEATHSIG = 1


def shared(function: Callable[[Item], Found], items: Sequence[Item]) -> Iterator[Found]:
    """Call a function with each item, in several processes where there are several processors.

    Parameters
    ----------
    function
        Function that is found by its name in its module.
    items
        What it is called with; items, results and errors must be picklable.

    Yields
    ------
    Found
        Results, in the order of the items.
    """
    done = 0
    if len(items) >= _FEWEST and (processes := _processes()) > 1:
        context = multiprocessing.get_context("fork")
        pool = ProcessPoolExecutor(processes, context, _belong_to, (os.getpid(),))
        try:
            for found in pool.map(function, items):
                yield found
                done += 1
        except BrokenProcessPool:  # one was ended from outside: the rest is done here
            pass
        finally:
            pool.shutdown(cancel_futures=True)
    for item in items[done:]:
        yield function(item)


def _processes() -> int:
    """Number of processes that may share the work; 1 where none may be forked."""
    alone = threading.active_count() == 1 and multiprocessing.parent_process() is None
    if not alone or not hasattr(os, "sched_getaffinity"):
        return 1
    return min(len(os.sched_getaffinity(0)), _MOST_PROCESSES)


def _belong_to(parent: int) -> None:
    """Leave signals to the process that this one works for, and end when it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL))
    if os.getppid() != parent:  # the parent was gone before that
        os._exit(1)
