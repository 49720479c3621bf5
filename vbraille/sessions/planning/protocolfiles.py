"""Where protocols are read from: the program's own folder, or a file."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from vbraille.errors import InputError
from vbraille.sessions.planning.tomlfile import which

_FOLDER = resources.files("vbraille.sessions.planning").joinpath("protocols")
_MOST_BYTES = 1_000_000


def builtin_names() -> list[str]:
    """Names of the protocols that come with the program."""
    files = _FOLDER.iterdir()
    return sorted(f.name.removesuffix(".toml") for f in files if f.name.endswith(".toml"))


def builtin_text(name: str) -> str:
    """TOML of a protocol that comes with the program.

    Raises
    ------
    InputError
        If there is none of that name; it names the nearest.
    """
    names = builtin_names()
    if name not in names:
        raise InputError(
            f"there is no protocol {name!r}{which(name, names)}; "
            f"that of a file ends in .toml, or has a / in it"
        )
    return _FOLDER.joinpath(f"{name}.toml").read_bytes().decode("utf-8")


def read_file(path: str) -> str:
    """Text of a protocol's file, without a byte-order mark.

    Raises
    ------
    InputError
        If it cannot be read, is far too large or is not UTF-8.
    """
    try:
        with Path(path).open("rb") as file:
            content = file.read(_MOST_BYTES + 1)
    except FileNotFoundError:
        raise InputError(f"there is no file {path}; check the name") from None
    except IsADirectoryError:
        raise InputError(f"{path} is a directory; give a protocol in it") from None
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{path} cannot be read: {reason}") from None
    if len(content) > _MOST_BYTES:
        raise InputError(f"{path} is too large for a protocol; give a TOML file")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"{path} is not UTF-8 in line {line}; save it as UTF-8") from None
