"""Where compiled kernels and lists of fonts are kept, also for a user without a writable home.

numba refuses to compile for a cache that it cannot write, and matplotlib complains on
standard error. Both are given a private folder among the system's temporary files then; where
even that cannot be had, kernels are compiled anew by every process.
"""

from __future__ import annotations

import logging
import os
import stat
import tempfile
from functools import cache
from pathlib import Path

_log = logging.getLogger(__name__)


@cache
def keep_compiled() -> bool:
    """Whether numba can keep what it compiles; to be called before anything is compiled.

    numba's own places are the packages' ``__pycache__`` and the user's cache. Where it can
    write neither, it is told of the private folder.
    """
    if given := os.environ.get("NUMBA_CACHE_DIR"):
        usual = [Path(given)]
    else:
        usual = [Path(__file__).parent / "__pycache__", _user_folder("CACHE", ".cache") / "numba"]
    if any(map(_is_writable, usual)):
        _log.info("what is compiled is kept in %s", next(filter(_is_writable, usual)))
        return True
    folder = _private_folder()
    if folder is None:
        _log.info("nothing compiled can be kept, so that every process compiles again")
        return False
    _log.info("what is compiled is kept in %s, for %s cannot be written", folder, usual[-1])
    from numba import config

    os.environ["NUMBA_CACHE_DIR"] = str(folder)
    config.reload_config()
    return True


@cache
def keep_fonts() -> None:
    """Give matplotlib a folder for its list of fonts; to be called before it is imported."""
    # matplotlib's warnings go to whoever keeps a log, and not to a reader's terminal.
    logging.getLogger("matplotlib").addHandler(logging.NullHandler())
    usual = [_user_folder("CACHE", ".cache"), _user_folder("CONFIG", ".config")]
    if "MPLCONFIGDIR" in os.environ or all(_is_writable(place / "matplotlib") for place in usual):
        return
    folder = _private_folder()
    if folder is not None:
        _log.info("the list of fonts is kept in %s, for %s cannot be written", folder, usual[0])
        os.environ["MPLCONFIGDIR"] = str(folder)


def _user_folder(kind: str, name: str) -> Path:
    """Folder of a user's files of a kind, by the XDG base directory specification."""
    given = os.environ.get(f"XDG_{kind}_HOME")
    try:
        return Path(given) if given else Path.home() / name
    except RuntimeError:  # a user without a home
        return Path(os.devnull)


def _is_writable(folder: Path) -> bool:
    """Whether files can be made in a folder, which is made if it is not there."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True


def _private_folder() -> Path | None:
    """Folder among the temporary files that nobody else can write to; None if there is none.

    Code is loaded from it: a folder that somebody else has made there is never used.
    """
    try:
        folder = Path(tempfile.gettempdir()) / f"vbraille-{os.getuid()}"
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return None
    private = stat.S_ISDIR(found.st_mode) and stat.S_IMODE(found.st_mode) == 0o700
    return folder if private and found.st_uid == os.getuid() and _is_writable(folder) else None
