"""A place for compiled kernels, also for a user without a writable home.

numba compares only the file that a function stands in, and would go on using one that has a changed
function of another file compiled into it. So the folder for all kernels is named by the source of
all of them; numba itself tells processors apart.
"""

from __future__ import annotations

import importlib
import logging
import os
import shutil
import stat
import sys
import tempfile
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path

# Libraries that numba would load for what no kernel here needs, and its modules that look for them:
# linear algebra, and declarations in C. Together they take a third of the time of loading it.
_LEFT_OUT = (("scipy.linalg", "numba.np.arraymath"), ("cffi", "numba.core.typing.cffi_utils"))
# The files that hold kernels, and what kernels call or take numbers from.
_ROOMS = (
    "render/**/*.py",
    "devices/levels.py",
    "engine/ticks.py",
    "engine/constants.py",
    "engine/record.py",
    "scene/signals.py",
)


@cache
def keep_compiled() -> bool:
    """Tell numba where to keep what it compiles, before it compiles anything; False if nowhere."""
    for library, wanted_by in _LEFT_OUT:
        _leave_out(library, wanted_by)
    folder = _compiled_folder()
    if folder is None:
        return False
    from numba import config

    # Not in the environment, where a child process would take it for a wish of its user.
    config.CACHE_DIR = str(folder)  # pyright: ignore[reportAttributeAccessIssue]
    for other in folder.parent.glob("vbraille-compiled-*"):
        if other != folder:
            shutil.rmtree(other, ignore_errors=True)
    return True


def is_compiled() -> bool:
    """Tell whether the code that drives actuators is compiled; compiling takes a minute."""
    folder = _compiled_folder()
    return folder is not None and any(folder.glob("engine*/*.nbc"))


def compiling_note() -> str | None:
    """Sentence before a first reading, which takes a while; None if nothing is to compile."""
    if is_compiled():
        return None
    return "compiling what drives the actuators; this takes up to a minute, once"


def keep_fonts() -> None:
    """Keep matplotlib from printing where it keeps its list of fonts, without a writable home."""
    logging.getLogger("matplotlib").addHandler(logging.NullHandler())


@cache
def _compiled_folder() -> Path | None:
    """Folder for compiled code of this source; None if none can be written."""
    if given := os.environ.get("NUMBA_CACHE_DIR"):
        places = [Path(given)]
    else:
        places = [Path(__file__).parent / "__pycache__"]
        with suppress(RuntimeError):  # a user without a home
            caches = os.environ.get("XDG_CACHE_HOME")
            places.append(Path(caches) if caches else Path.home() / ".cache")
    place = next(filter(_is_writable, places), None) or _private_folder()
    return None if place is None else place / f"vbraille-compiled-{_source()}"


def _leave_out(library: str, wanted_by: str) -> None:
    """Keep a module of numba from importing a library; it can still be imported later."""
    if library in sys.modules:
        return
    sys.modules[library] = None  # pyright: ignore[reportArgumentType]
    try:
        importlib.import_module(wanted_by)
    finally:
        del sys.modules[library]


def _source() -> str:
    """Name the source of all kernels, and their compiler, by files' names, sizes and times."""
    root = Path(__file__).parent
    files = [file for room in _ROOMS for file in sorted(root.glob(room))]
    compiler = find_spec("numba")  # not imported, which takes long
    if compiler is not None and compiler.origin is not None:
        files.append(Path(compiler.origin))
    told = [(file.name, file.stat().st_size, file.stat().st_mtime_ns) for file in files]
    return sha256(repr(told).encode()).hexdigest()[:16]


def _is_writable(folder: Path) -> bool:
    """Tell whether files can be made in a folder, which is made first if it is not there."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True


def _private_folder() -> Path | None:
    """Make a temporary folder that only this user can write to; None if that is not possible.

    Code is loaded from it, so a folder there that another user has made is never used.
    """
    folder = Path(tempfile.gettempdir()) / f"vbraille-{os.getuid()}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return None
    private = stat.S_ISDIR(found.st_mode) and stat.S_IMODE(found.st_mode) == 0o700
    return folder if private and found.st_uid == os.getuid() and _is_writable(folder) else None
