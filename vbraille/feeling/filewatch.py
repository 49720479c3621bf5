"""Whether a file has changed, asked now and then."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

_EVERY_S: Final = 0.5


class FileWatch:
    """Sees whether a file has changed; it looks twice a second at most.

    A change is told once the file has been the same for a look, so that one which is just being
    written is read when it is whole.

    Parameters
    ----------
    path
        The file.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._known = self._stamp()
        self._seen = self._known
        self._next_s = 0.0

    def changed(self, now_s: float) -> bool:
        """Tell whether the file is another than at the last change that was told."""
        if now_s < self._next_s:
            return False
        self._next_s = now_s + _EVERY_S
        stamp = self._stamp()
        same, self._seen = stamp == self._seen, stamp
        if stamp is None or stamp == self._known or not same:
            return False
        self._known = stamp
        return True

    def _stamp(self) -> tuple[int, int, int] | None:
        """What tells one state of the file from another; None if there is no file."""
        try:
            found = self._path.stat()
        except OSError:
            return None
        return found.st_mtime_ns, found.st_size, found.st_ino
