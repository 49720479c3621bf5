"""Priority for the thread that drives actuators, as far as the system allows it."""

from __future__ import annotations

import ctypes
import gc
import os
import resource
from contextlib import suppress

from vbraille.devices.events import NotInTime

# Above other programs, below the kernel's own threads (50).
PRIORITY = 40
_MCL_CURRENT, _MCL_FUTURE = 1, 2


def go_real_time() -> NotInTime | None:
    """Have this thread run by SCHED_FIFO in locked memory, without garbage collection.

    Returns
    -------
    NotInTime or None
        What the system does not allow; None if it allows everything.
    """
    _keep_awake()
    refused = []
    if not come_first(PRIORITY):
        refused.append("priority")
    if not _lock_memory():
        refused.append("memory")
    return NotInTime(tuple(refused)) if refused else None


def come_first(priority: int) -> bool:
    """Have this thread run by SCHED_FIFO, without garbage collection; tell if the system allows it.

    Parameters
    ----------
    priority
        Priority of the thread: of two that have something to do, the higher number runs.
    """
    gc.freeze()  # garbage, too: looking for it would take a tenth of a second
    gc.disable()
    try:
        # Threads that a driver starts are not first in line: RESET_ON_FORK.
        policy = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
        os.sched_setscheduler(0, policy, os.sched_param(priority))
    except OSError:
        return False
    return True


def _keep_awake() -> None:
    """Keep processors from deep sleep, from which they wake slowly, while this process lives."""
    with suppress(OSError):
        descriptor = os.open("/dev/cpu_dma_latency", os.O_WRONLY)
        os.write(descriptor, bytes(4))  # µs; it holds as long as the descriptor is open


def _lock_memory() -> bool:
    if os.geteuid() != 0 and resource.getrlimit(resource.RLIMIT_MEMLOCK)[0] != -1:
        # What is locked now might just fit; later allocations would then fail for want of room.
        return False
    return ctypes.CDLL(None).mlockall(_MCL_CURRENT | _MCL_FUTURE) == 0
