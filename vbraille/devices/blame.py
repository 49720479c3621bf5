"""Whose fault it is: an exception of somebody else's driver, as a sentence with file and line."""

from __future__ import annotations

import os
import sys
import sysconfig
from contextlib import contextmanager
from pathlib import Path
from traceback import extract_tb
from typing import TYPE_CHECKING, NoReturn

from vbraille.errors import DeviceError, VbrailleError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from importlib.metadata import EntryPoint

# If this is set to anything, tracebacks are let through for whoever mends the driver.
TRACEBACK = "VBRAILLE_TRACEBACK"
_OURS = str(Path(__file__).parents[1])
_PYTHON = sysconfig.get_path("stdlib")
_PACKAGES = sysconfig.get_path("purelib")


@contextmanager
def naming(driver: EntryPoint) -> Iterator[None]:
    """Turn whatever a driver raises into a `DeviceError` with the driver's name, file and line.

    What vbraille's own drivers raise passes unchanged, and so does an error that is a sentence.

    Raises
    ------
    DeviceError
        For any other exception of the driver; the error names the driver.
    """
    try:
        yield
    except VbrailleError:
        raise
    except (Exception, SystemExit) as error:
        if driver.module.partition(".")[0] == "vbraille" or os.environ.get(TRACEBACK):
            raise
        _blame(driver, error)


def _blame(driver: EntryPoint, error: Exception | SystemExit) -> NoReturn:
    where = _place(driver, error)
    if where is None and isinstance(error, OSError):
        raise error  # perhaps an error of our own output
    what = f"{type(error).__name__}: {' '.join(str(error).split())}".removesuffix(": ")
    if where is None:
        where = f"{driver.value}; no line of its own was at work"
    raise DeviceError(
        f"the driver {driver.name}, which is not vbraille's own, has a fault ({what}) "
        f"at {where}; tell whoever wrote it, or set {TRACEBACK}=1 to see more"
    ) from error


def _place(driver: EntryPoint, error: BaseException) -> str | None:
    """File and line of the driver where it was at work last; None if it was not at work."""
    if isinstance(error, SyntaxError) and error.filename:
        return f"{error.filename}, line {error.lineno}"
    lines = [(line.filename, line.lineno) for line in extract_tb(error.__traceback__)]
    home = _home(driver)
    at_work = [line for line in lines if home is not None and line[0].startswith(home)]
    if not at_work:  # a package that the driver calls, or the driver itself while it is loaded
        ours = max(number for number, (name, _) in enumerate(lines) if name.startswith(_OURS))
        # What found the driver is not always Python's own: a package may bring its backport.
        finder = sys.modules[type(driver).__module__].__file__
        others = [line for line in lines[ours + 1 :] if line[0] != finder]
        at_work = [line for line in others if not _is_python(line[0])]
    if not at_work:
        return None
    name, number = at_work[-1]
    return f"{name}, line {number}"


def _is_python(name: str) -> bool:
    """Whether a file belongs to Python itself."""
    library = name.startswith(_PYTHON) and not name.startswith(_PACKAGES)
    return library or name.startswith("<frozen")


def _home(driver: EntryPoint) -> str | None:
    """Folder of a driver that is a package; file of a driver that is a module."""
    module = sys.modules.get(driver.module.partition(".")[0])
    name = getattr(module, "__file__", None)
    if name is None:
        return None
    return str(Path(name).parent) if hasattr(module, "__path__") else name
