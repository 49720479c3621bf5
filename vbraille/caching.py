"""Places for compiled kernels and lists of fonts, also for a user without a writable home.

numba refuses to compile for a cache that it cannot write, and matplotlib complains on
standard error. Both are given a private folder among the system's temporary files then; where
even that cannot be had, kernels are compiled anew by every process.
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

_log = logging.getLogger(__name__)
_PROCESSOR_VARIABLES = ("NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES", "NUMBA_ENABLE_AVX")
# What tells kinds of processors apart, of Intel's and AMD's and of ARM's; how fast one is does not.
_PROCESSOR_LINES = ("vendor_id", "cpu family", "model", "stepping", "flags", "Features", "CPU ")
# Libraries that numba would load for what no kernel here needs, and its modules that look for them:
# linear algebra, and declarations in C. Together they take a third of the time of loading it.
_LEFT_OUT = (("scipy.linalg", "numba.np.arraymath"), ("cffi", "numba.core.typing.cffi_utils"))
# The files that hold kernels, and what kernels call or take numbers from.
_ROOMS = ("render/**/*.py", "devices/**/*.py", "engine/*.py", "scene/signals.py")


@cache
def keep_compiled() -> bool:
    """Tell numba where to keep what it compiles, before it compiles anything; False if nowhere.

    That is the package's own ``__pycache__``, else the user's caches, else a private folder. In
    each, the folder is named by the source of all kernels: numba compares the file of a function
    only, and would go on using one that has a changed function of another file compiled into it.
    It is named by the processor, too, since what is compiled for another is of no use.
    """
    for library, wanted_by in _LEFT_OUT:
        _leave_out(library, wanted_by)
    folder = _compiled_folder()
    if folder is None:
        _log.info("nothing compiled can be kept, so that every process compiles again")
        return False
    _log.info("what is compiled is kept in %s", folder)
    from numba import config

    # Not in the environment, where a child process would take it for a wish of its user.
    config.CACHE_DIR = str(folder)  # pyright: ignore[reportAttributeAccessIssue]
    for other in folder.parent.glob("vbraille-compiled-*"):
        if not other.name.startswith(folder.name.rpartition("-")[0]):
            shutil.rmtree(other, ignore_errors=True)
    return True


def is_compiled() -> bool:
    """Tell whether the code that drives actuators is compiled already; compiling takes a minute."""
    folder = _compiled_folder()
    return folder is not None and any(folder.glob("*/serialtick.run-*.nbc"))


def compiling_note() -> str | None:
    """Sentence before a first reading, which takes a while; None if nothing is to compile."""
    if is_compiled():
        return None
    return "compiling: what drives the actuators, once, in up to a minute; then it begins"


@cache
def _compiled_folder() -> Path | None:
    """Find the folder for compiled code of this source; None if none can be written."""
    if given := os.environ.get("NUMBA_CACHE_DIR"):
        places = [Path(given)]
    else:
        places = [Path(__file__).parent / "__pycache__", _user_folder("CACHE", ".cache")]
    place = next(filter(_is_writable, places), None) or _private_folder()
    return None if place is None else place / f"vbraille-compiled-{_source()}-{_processor()}"


def _leave_out(library: str, wanted_by: str) -> None:
    """Keep a module of numba from importing a library; it can still be imported later.

    Parameters
    ----------
    library
        Name of the library; nothing is done where it has been imported already.
    wanted_by
        Module of numba that does without the library where there is none.
    """
    if library in sys.modules:
        return
    sys.modules[library] = None  # pyright: ignore[reportArgumentType]
    try:
        importlib.import_module(wanted_by)
    finally:
        del sys.modules[library]


def _source() -> str:
    """Name the source of all kernels, and their compiler, by its files' names, sizes and times."""
    root = Path(__file__).parent
    files = [file for room in _ROOMS for file in sorted(root.glob(room))]
    compiler = find_spec("numba")  # not imported, which takes long
    if compiler is not None and compiler.origin is not None:
        files.append(Path(compiler.origin))
    told = [(file.name, file.stat().st_size, file.stat().st_mtime_ns) for file in files]
    return sha256(repr(told).encode()).hexdigest()[:16]


def _processor() -> str:
    """Name the processor by what the system says of the first, or as numba's settings have it."""
    told = [os.uname().machine, *map(os.environ.get, _PROCESSOR_VARIABLES)]
    with suppress(OSError):
        first = Path("/proc/cpuinfo").read_text(errors="replace").partition("\n\n")[0]
        told += [line for line in first.splitlines() if line.startswith(_PROCESSOR_LINES)]
    return sha256(repr(told).encode()).hexdigest()[:8]


@cache
def keep_fonts() -> None:
    """Give matplotlib a folder for its list of fonts; to be called before it is imported."""
    # matplotlib's warnings go to a log, if one is kept, and not to a reader's terminal.
    logging.getLogger("matplotlib").addHandler(logging.NullHandler())
    usual = [_user_folder("CACHE", ".cache"), _user_folder("CONFIG", ".config")]
    if "MPLCONFIGDIR" in os.environ or all(_is_writable(place / "matplotlib") for place in usual):
        return
    folder = _private_folder()
    if folder is not None:
        _log.info("the list of fonts is kept in %s, for %s cannot be written", folder, usual[0])
        os.environ["MPLCONFIGDIR"] = str(folder)


def _user_folder(kind: str, name: str) -> Path:
    """Find the folder for a kind of the user's files, by the XDG base directory specification."""
    given = os.environ.get(f"XDG_{kind}_HOME")
    try:
        return Path(given) if given else Path.home() / name
    except RuntimeError:  # a user without a home
        return Path(os.devnull)


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
    try:
        folder = Path(tempfile.gettempdir()) / f"vbraille-{os.getuid()}"
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return None
    private = stat.S_ISDIR(found.st_mode) and stat.S_IMODE(found.st_mode) == 0o700
    return folder if private and found.st_uid == os.getuid() and _is_writable(folder) else None
