"""Bytes of files and pipes as streams that can be read more than once."""

from __future__ import annotations

import os
from contextlib import ExitStack
from pathlib import Path
from typing import BinaryIO

from vbraille.errors import InputError

CHUNK_BYTES = 65_536


def open_file(path: Path | str) -> BinaryIO:
    """Open a file for reading; what cannot be read twice, such as a pipe, is kept first.

    Raises
    ------
    InputError
        If it is missing, unreadable or a directory.
    """
    path = Path(path)
    try:
        stream = path.open("rb")
        # A pipe cannot be read twice, and a file of /proc does not say how long it is.
        if not stream.seekable() or (path.is_file() and not path.stat().st_size):
            with stream:
                return _kept(stream)
    except FileNotFoundError:
        raise InputError(f"there is no file {path}; check the name") from None
    except IsADirectoryError:
        raise InputError(f"{path} is a directory; give a text file in it") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{path} cannot be read: {reason}") from None
    return stream


def keep_stream(stream: BinaryIO, name: str) -> BinaryIO:
    """Read all that a stream gives, such as standard input, into a temporary file.

    Parameters
    ----------
    stream
        Bytes to read to their end, which may be more than memory holds.
    name
        Name of the stream in messages.

    Raises
    ------
    InputError
        If the stream cannot be read, or what it gives cannot be kept.
    """
    try:
        return _kept(stream)
    except OSError as error:
        raise InputError(f"{name} cannot be read: {error.strerror or error}") from None


def _kept(stream: BinaryIO) -> BinaryIO:
    """Temporary file with all that a stream gives, since a text is read more than once."""
    from tempfile import TemporaryFile

    with ExitStack() as opened:
        kept = opened.enter_context(TemporaryFile())
        # Python's buffer is bypassed, which asks a terminal for more after its end was typed.
        while chunk := os.read(stream.fileno(), CHUNK_BYTES):
            kept.write(chunk)
        kept.flush()
        opened.pop_all()  # closing it is left to the caller
    return kept
