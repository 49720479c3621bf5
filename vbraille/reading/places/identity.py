"""Which file is which book: by what the system says of it, else by all its bytes."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from stat import S_ISREG
from threading import Thread
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

# A file up to this size is hashed at once, in some milliseconds.
QUICK_BYTES = 2_000_000
_READ_BYTES = 1 << 20


@dataclass(frozen=True, slots=True)
class Fingerprint:
    """What the system says of a file, which is trusted as long as all of it is the same."""

    size: int
    mtime_ns: int
    inode: int


def fingerprint(path: Path) -> Fingerprint | None:
    """What the system says of a file; None if it says nothing of it, or if it is no plain file."""
    try:
        stat = path.stat()
    except (OSError, ValueError):
        return None
    if not S_ISREG(stat.st_mode):
        return None
    return Fingerprint(stat.st_size, stat.st_mtime_ns, stat.st_ino)


def digest_of(path: Path) -> str | None:
    """SHA-256 of a file in hexadecimal; None if it cannot be read."""
    digest = hashlib.sha256()
    try:
        with path.open("rb") as file:
            while read := file.read(_READ_BYTES):
                digest.update(read)
    except OSError:
        return None
    return digest.hexdigest()


class Digesting:
    """The hash of a large file, made beside all else.

    Attributes
    ----------
    digest : str or None
        SHA-256 in hexadecimal, once it is known; None if the file changed meanwhile.
    """

    def __init__(self, path: Path) -> None:
        self.digest: str | None = None
        self._path = path
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    def wait(self, seconds: float) -> None:
        """Wait until it is known, but not longer than some seconds."""
        self._thread.join(seconds)

    def _run(self) -> None:
        before = fingerprint(self._path)
        digest = digest_of(self._path)
        if fingerprint(self._path) == before:
            self.digest = digest
