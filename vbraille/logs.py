"""The log for developers, which the program keeps where it is asked to.

Modules write to it by `logging`. Each line is written at once and whole, so that several processes
may share a file. Ticks are not logged; changes of state are, such as a device that was opened or a
process that ended.
"""

from __future__ import annotations

import logging
import os
import sys
import traceback
from contextlib import suppress
from pathlib import Path

from vbraille.errors import InputError

_FORMAT = "%(asctime)s.%(msecs)03d %(process)d %(levelname)s %(name)s: %(message)s"
# If this is set in the environment, faults print their tracebacks.
_TRACEBACKS = "VBRAILLE_TRACEBACK"


class _OneLine(logging.Formatter):
    """Formats a record as one line."""

    def format(self, record: logging.LogRecord) -> str:
        """Join the lines of a record."""
        return " ".join(super().format(record).split("\n"))


def keep(where: str) -> logging.Handler:
    """Keep a log of all that vbraille's modules write, from now on.

    Parameters
    ----------
    where
        A file, which is appended to, or "-" for standard error.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    try:
        handler = (
            logging.StreamHandler(sys.stderr)
            if where == "-"
            else logging.FileHandler(
                Path(where).absolute(), encoding="utf-8", errors="backslashreplace"
            )
        )
    except OSError as error:
        raise InputError(f"the log {where} cannot be written: {error.strerror}") from None
    handler.setFormatter(_OneLine(_FORMAT, "%Y-%m-%d %H:%M:%S"))
    handler.set_name(where if where == "-" else str(Path(where).absolute()))
    logging.raiseExceptions = False  # a full disk must not stop a reader
    logger = logging.getLogger("vbraille")
    logger.addHandler(handler)
    logger.setLevel(logging.DEBUG)
    logger.propagate = False
    return handler


def kept() -> str | None:
    """Place of this process's log, so that processes it starts may share it; None if none."""
    names = (handler.name for handler in logging.getLogger("vbraille").handlers)
    return next(filter(None, names), None)


def stop(handler: logging.Handler) -> None:
    """Stop keeping the log that `keep` began."""
    logger = logging.getLogger("vbraille")
    logger.removeHandler(handler)
    with suppress(OSError):
        handler.close()
    if not logger.handlers:
        logger.setLevel(logging.NOTSET)
        logger.propagate = True


def want_tracebacks() -> None:
    """Have faults print their tracebacks from now on, in this process and those it starts."""
    os.environ[_TRACEBACKS] = "1"


def tracebacks_wanted() -> bool:
    """Tell whether faults print their tracebacks."""
    return bool(os.environ.get(_TRACEBACKS))


def print_traceback(error: BaseException) -> None:
    """Print the traceback of a fault on standard error, if tracebacks are wanted."""
    if tracebacks_wanted():
        with suppress(OSError):
            traceback.print_exception(error)
