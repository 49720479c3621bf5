"""Texts of files that people write, read whole or refused in one sentence."""

from __future__ import annotations

from pathlib import Path

from vbraille.errors import InputError

_MOST_BYTES = 1_000_000


def read_text(path: str | Path, what: str, most_bytes: int = _MOST_BYTES) -> str:
    """Text of a file, without a byte-order mark.

    Parameters
    ----------
    path
        Path of the file.
    what
        What the file is to be, such as "protocol".
    most_bytes
        Size of the largest file that is read.

    Raises
    ------
    InputError
        If the file cannot be read, is far too large or is not UTF-8.
    """
    try:
        with Path(path).open("rb") as file:
            content = file.read(most_bytes + 1)
    except FileNotFoundError:
        raise InputError(f"there is no file {path}; check the name") from None
    except IsADirectoryError:
        raise InputError(f"{path} is a directory; give a {what} in it") from None
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{path} cannot be read: {reason}") from None
    if len(content) > most_bytes:
        most = f"{most_bytes / 1e6:g} MB at most"
        raise InputError(f"{path} is too large for a {what}; give a TOML file of {most}")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"{path} is not UTF-8 in line {line}; save it as UTF-8") from None
