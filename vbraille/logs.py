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


class _OneLine(logging.Formatter):
    """Formats a record as one line."""

    def format(self, record: logging.LogRecord) -> str:
        """Join the lines of a record."""
        return " ".join(super().format(record).split("\n"))


def keep(where: str) -> None:
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
    path = Path(where).absolute()
    try:
        handler = logging.StreamHandler(sys.stderr)
        if where != "-":
            handler = logging.FileHandler(path, encoding="utf-8", errors="backslashreplace")
    except OSError as error:
        raise InputError(f"the log {where} cannot be written: {error.strerror}") from None
    handler.setFormatter(_OneLine(_FORMAT, "%Y-%m-%d %H:%M:%S"))
    handler.set_name(where if where == "-" else str(path))
    logging.raiseExceptions = False  # a full disk must not stop a reader
    logger = logging.getLogger("vbraille")
    logger.addHandler(handler)
    logger.setLevel(logging.DEBUG)
    logger.propagate = False


def kept() -> str | None:
    """Place of this process's log, so that processes it starts may share it; None if none."""
    names = (handler.name for handler in logging.getLogger("vbraille").handlers)
    return next(filter(None, names), None)


def print_traceback(error: BaseException) -> None:
    """Print the traceback of a fault on standard error, if VBRAILLE_TRACEBACK is set."""
    if os.environ.get("VBRAILLE_TRACEBACK"):
        with suppress(OSError):
            traceback.print_exception(error)
