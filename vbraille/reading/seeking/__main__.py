"""The process that looks through a book while somebody reads it."""

from __future__ import annotations

import ctypes
import fcntl
import os
import signal
import sys
from contextlib import suppress

from vbraille.reading.seeking.pipes import Incoming, Outgoing
from vbraille.reading.seeking.working import Worker, wait

_NICE = 10  # the loop of the display and the reader's keys come first
_PR_SET_PDEATHSIG = 1


def main() -> None:
    """Work until standard input ends, which it does at the latest with the parent."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)  # a terminal tells all; the parent ends this process
    with suppress(OSError, AttributeError):  # where there is no such call, the pipe's end is enough
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL))
    if os.getppid() != int(sys.argv[1]):
        return
    with suppress(OSError):
        os.nice(_NICE)
    # Nobody else writes into the pipe, whatever a library prints.
    said = fcntl.fcntl(1, fcntl.F_DUPFD_CLOEXEC, 3)
    os.dup2(2, 1)
    with suppress(BrokenPipeError):
        Worker(Incoming(0), Outgoing(said)).run(wait)


if __name__ == "__main__":
    main()
