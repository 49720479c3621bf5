"""Bytes of files of other programs, which are no larger than they may be."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path


def read_bytes(path: Path, most: int) -> bytes:
    """Content of a file of another program.

    Raises
    ------
    InputError
        If it is not there, no file, empty, larger than ``most`` bytes, or cannot be read.
    """
    try:
        if path.is_dir():
            raise InputError(f"{path} is a directory; give the name of a file in it")
        if not path.exists():
            raise InputError(f"{path} does not exist; check its name")
        if not path.is_file():
            raise InputError(f"{path} is no ordinary file; give one that is")
        with path.open("rb") as file:
            content = file.read(most + 1)
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}") from None
    except ValueError:  # a name with a null character
        raise InputError(f"{str(path)!r} is no name of a file; mend it") from None
    if len(content) > most:
        raise InputError(f"{path} is larger than {most >> 20} MB; make it smaller")
    if not content:
        raise InputError(f"{path} is empty; give another file")
    return content
