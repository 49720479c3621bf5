"""The log for developers, which the program keeps where it is asked to.

Modules write to it by `logging`. Each line is written at once and whole, so that several processes
may share a file. Ticks are not logged; changes of state are, such as a device that was opened or a
process that ended.
"""

from __future__ import annotations

import logging
import os
import traceback
from contextlib import suppress
from pathlib import Path

from vbraille.errors import InputError
from vbraille.wording import setting

_FORMAT = "%(asctime)s.%(msecs)03d %(process)d %(levelname)s %(name)s: %(message)s"
_STDERR = "-"
_STDERR_DESCRIPTOR = 2
# If this is set to anything, in the environment, faults print their tracebacks: --verbose sets it,
# and processes that are started inherit it.
_TRACEBACKS = "VBRAILLE_TRACEBACK"


class LineHandler(logging.Handler):
    """Write each record as one line, by one system call.

    Parameters
    ----------
    where
        A file, which is appended to, or "-" for standard error.
    """

    def __init__(self, where: str) -> None:
        super().__init__()
        self.where = where
        self._descriptor = _STDERR_DESCRIPTOR
        if where != _STDERR:
            flags = os.O_WRONLY | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC
            self._descriptor = os.open(where, flags, 0o666)
        self.setFormatter(logging.Formatter(_FORMAT, "%Y-%m-%d %H:%M:%S"))

    def emit(self, record: logging.LogRecord) -> None:
        """Write a line; one that cannot be written is lost, and ends nothing."""
        line = " ".join(self.format(record).split("\n"))
        with suppress(OSError):  # a full disk, or a closed output, must not stop a reader
            os.write(self._descriptor, line.encode(errors="backslashreplace") + b"\n")

    def close(self) -> None:
        """Close the file."""
        super().close()
        if self.where != _STDERR and self._descriptor != _STDERR_DESCRIPTOR:
            os.close(self._descriptor)
            self._descriptor = _STDERR_DESCRIPTOR


def keep(where: str) -> LineHandler:
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
    if where != _STDERR:
        where = str(Path(where).absolute())
    try:
        handler = LineHandler(where)
    except OSError as error:
        raise InputError(
            f"no log can be kept in {where}: {error.strerror}; choose another {setting('log')}"
        ) from None
    logger = logging.getLogger("vbraille")
    logger.addHandler(handler)
    logger.setLevel(logging.DEBUG)
    logger.propagate = False
    return handler


def kept() -> str | None:
    """Tell where this process keeps its log, so that processes it starts may; None if nowhere."""
    for handler in logging.getLogger("vbraille").handlers:
        if isinstance(handler, LineHandler):
            return handler.where
    return None


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


def stop(handler: LineHandler) -> None:
    """Stop keeping the log that `keep` began."""
    logger = logging.getLogger("vbraille")
    logger.removeHandler(handler)
    handler.close()
    if not logger.handlers:
        logger.setLevel(logging.NOTSET)
        logger.propagate = True
