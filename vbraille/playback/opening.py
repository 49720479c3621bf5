"""What is to be played, told by what it is and not by its name."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

from vbraille.errors import InputError
from vbraille.playback.playback import Playback
from vbraille.wording import printable

if TYPE_CHECKING:
    from vbraille.playback.reels import Reel

_HDF5: Final = b"\x89HDF\r\n\x1a\n"
_GZIP: Final = b"\x1f\x8b"


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
    return Playback(_reel(Path(path)))


def _reel(path: Path) -> Reel:
    start = _start(path)
    if start is None:
        from vbraille.playback.traced import Traced

        return Traced(path)
    if start == _HDF5:
        from vbraille.playback.rendered import Rendered

        return Rendered(path)
    if start[:2] == _GZIP and path.suffix == ".gz":
        from vbraille.playback.traced import Traced

        return Traced(path.parent, path.name)
    what = "is empty" if not start else "is no recording"
    raise InputError(
        f"{_named(path)} {what}; give what vbraille render wrote, or the directory of a session"
    )


def _start(path: Path) -> bytes | None:
    """Read the first bytes of a file; None if it is a directory."""
    try:
        if path.is_dir():
            return None
        if path.exists() and not path.is_file():  # a pipe would be waited for
            raise InputError(
                f"{_named(path)} is no file; give what vbraille render wrote, or the directory of "
                f"a session"
            )
        with path.open("rb") as file:
            return file.read(len(_HDF5))
    except FileNotFoundError:
        raise InputError(f"there is no file {_named(path)}; check the name") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"{_named(path)} cannot be read: {reason}") from None


def _named(path: Path) -> str:
    return printable(str(path))
