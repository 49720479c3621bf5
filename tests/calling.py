"""The program's `main` called in this process, which stays as it was."""

import os
import signal
import sys
from contextlib import contextmanager

from vbraille.signals import SIGNALS


@contextmanager
def as_before():
    """Bring signals, the environment and what prints faults back afterwards."""
    handlers = {number: signal.getsignal(number) for number in (*SIGNALS, signal.SIGALRM)}
    hook, environment = sys.unraisablehook, dict(os.environ)
    try:
        yield
    finally:
        sys.unraisablehook = hook
        for number, handler in handlers.items():
            signal.signal(number, handler)
        os.environ.clear()
        os.environ.update(environment)
