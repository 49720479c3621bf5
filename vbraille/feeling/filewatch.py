"""Whether a file has changed, asked again and again."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

_Stamp = tuple[int, int, int]
_QUIET_NS: Final = 10_000_000


class FileWatch:
    """Sees whether a file has changed, by one look at its directory entry each time.

    A change is told once the file has been quiet for 10 ms, or is the same at two looks, and is
    not empty, so that one which is just being written is read when it is whole.

    Parameters
    ----------
    path
        The file.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._known = self._stamp()
        self._seen = self._known

    def changed(self) -> bool:
        """Tell whether the file is another than at the last change that was told."""
        stamp = self._stamp()
        same, self._seen = stamp == self._seen, stamp
        if stamp is None or stamp == self._known:
            return False
        written_ns, size, _ = stamp
        if size == 0 or not (same or time.time_ns() - written_ns > _QUIET_NS):
            return False
        self._known = stamp
        return True

    def _stamp(self) -> _Stamp | None:
        """What tells one state of the file from another; None if there is no file."""
        try:
            found = self._path.stat()
        except OSError:
            return None
        return found.st_mtime_ns, found.st_size, found.st_ino
