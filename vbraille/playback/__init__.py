"""Recordings and sessions played back in the live view.

`open_recording` makes a source for `vbraille.live.server` of a file of `vbraille render`, of a
session's directory or of one of its traces, told by what it is and not by its name.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

from vbraille.errors import InputError
from vbraille.wording import printable

if TYPE_CHECKING:
    from vbraille.playback.recorded import Playback

_HDF5: Final = b"\x89HDF\r\n\x1a\n"
_GZIP: Final = b"\x1f\x8b"
_GIVE: Final = "give what vbraille render wrote, or the directory of a session"


def open_recording(path: Path | str) -> Playback:
    """Open what `vbraille render` wrote, a session's directory, or a trace in one.

    Parameters
    ----------
    path
        Path of the file or the directory.

    Returns
    -------
    Playback
        A source for `vbraille.live.server.LiveServer`.

    Raises
    ------
    InputError
        If there is no such file, it is something else, a newer vbraille made it, or the session
        runs.
    VbrailleError
        If it cannot be read, or is damaged beyond use.
    """
    recording = _open(Path(path))
    recording.locate(0.0)  # there is a whole frame, which later calls find at the worst
    return recording


def _open(path: Path) -> Playback:
    start = _start(path)
    if start == _HDF5:
        # It loads h5py, which is not needed to play a session.
        from vbraille.playback.rendered import Rendered

        return Rendered(path)
    is_trace = start is not None and start[:2] == _GZIP and path.suffix == ".gz"
    if start is None or is_trace:
        from vbraille.playback.sessiontrace import SessionRecording

        return SessionRecording(path.parent, path.name) if is_trace else SessionRecording(path)
    what = "is no recording" if start else "is empty"
    raise InputError(f"{_named(path)} {what}; {_GIVE}")


def _start(path: Path) -> bytes | None:
    """Read the first bytes of a file, which tell what it is; None if it is a directory."""
    try:
        if path.is_dir():
            return None
        if path.exists() and not path.is_file():  # a pipe would be waited for
            raise InputError(f"{_named(path)} is no file; {_GIVE}")
        with path.open("rb") as file:
            return file.read(len(_HDF5))
    except FileNotFoundError:
        raise InputError(f"there is no file {_named(path)}; check the name") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"{_named(path)} cannot be read: {reason}") from None


def _named(path: Path) -> str:
    return printable(str(path))
