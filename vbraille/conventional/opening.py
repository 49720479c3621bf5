"""Why a file of a display could not be opened, in words for people."""

from __future__ import annotations

import errno
from pathlib import Path

from vbraille.conventional.driver import DisplayGoneError


def not_opened(fault: OSError, path: str, kind: str) -> DisplayGoneError:
    """Make the error that says why a file could not be opened, and what helps.

    Parameters
    ----------
    fault
        What the system said.
    path
        Path of the file.
    kind
        What the file should be, such as "serial port".
    """
    if fault.errno in (errno.ENOENT, errno.ENXIO, errno.ENODEV, errno.ENOTDIR):
        return DisplayGoneError(f"there is no {kind} {path}; plug the display in, or give its path")
    if fault.errno in (errno.EACCES, errno.EPERM):
        return DisplayGoneError(f"you may not open {path}; {_let_in(path)}")
    if fault.errno in (errno.EBUSY, errno.EAGAIN):
        return DisplayGoneError(f"{path} is busy; end the other program that uses it")
    return DisplayGoneError(f"{path} is no {kind}; give the path of the display")


def _let_in(path: str) -> str:
    try:
        group = Path(path).group()
    except (OSError, KeyError):
        group = "root"
    if group == "root":
        return "give it a group of yours by a udev rule, as docs/conventional.md says"
    return f"add yourself to the group {group} (sudo usermod -aG {group} $USER) and log in again"
