"""Reading of protocols, from the program's own folder or from a file."""

from __future__ import annotations

from importlib import resources

import msgspec
from msgspec import field

from vbraille.errors import InputError
from vbraille.sessions.planning.protocol import FORMAT, Protocol, ProtocolFile
from vbraille.sessions.planning.spellings import SpellingKeys, read_keys, spelled
from vbraille.toml.textfile import read_text
from vbraille.toml.tomlfile import TomlFile, which

_FOLDER = resources.files("vbraille.sessions.planning").joinpath("protocols")


def builtin_names() -> list[str]:
    """Names of the protocols that come with the program."""
    files = _FOLDER.iterdir()
    return sorted(f.name.removesuffix(".toml") for f in files if f.name.endswith(".toml"))


def builtin_text(name: str) -> str:
    """TOML text of a protocol that comes with the program.

    Raises
    ------
    InputError
        If there is no protocol of that name; the message suggests the nearest name.
    """
    names = builtin_names()
    if name not in names:
        raise InputError(
            f"there is no protocol {name!r}{which(name, names)}; "
            f"that of a file ends in .toml, or has a / in it"
        )
    return _FOLDER.joinpath(f"{name}.toml").read_bytes().decode("utf-8")


def load_protocol(spec: str) -> Protocol:
    """Read a protocol.

    Parameters
    ----------
    spec
        Name of a protocol that comes with the program; or the path of a file, if it ends in
        ``.toml`` or has a ``/`` in it.

    Raises
    ------
    InputError
        If there is no such protocol, or it cannot be used.
    """
    if spec.endswith(".toml") or "/" in spec:
        return parse_protocol(read_text(spec, "protocol"), spec)
    return parse_protocol(builtin_text(spec), f"{spec}.toml")


def parse_protocol(text: str, where: str, *, planned: bool = False) -> Protocol:
    """Make a protocol from the text of its file, and check it.

    Parameters
    ----------
    text
        TOML text of the protocol.
    where
        Name of the file, for messages.
    planned
        Whether the protocol belongs to a session, whose plan has been made. If so, what version
        0.1 allowed is still allowed: blanks and dot numbers in strings, and practice with the
        test's items.

    Raises
    ------
    InputError
        If the protocol cannot be used. One sentence says where, why, and what to do.
    """
    file = TomlFile(text, where)
    file.read(_Format)  # this comes first, since another format may have other keys
    keys = file.read(_Keyed, read_keys).keys
    tables = file.read(ProtocolFile, spelled(keys, planned=planned))
    with file.checking():
        protocol = Protocol(**msgspec.structs.asdict(tables), text=text)
        if protocol.practice.trials and not protocol.practice.items and not planned:
            raise ValueError(
                f"[practice] has no items of its own, and those of the test would be given away; "
                f"give {'values' if protocol.parameter else 'strings'} that the test does not "
                f"have, or trials = 0"
            )
    return protocol


class _Format(msgspec.Struct):
    """The one key that files of every format have."""

    format: int

    def __post_init__(self) -> None:
        if self.format != FORMAT:
            raise ValueError(
                f"format is {self.format}, and this vbraille knows format {FORMAT}; "
                f"use a vbraille that knows it"
            )


class _Keyed(msgspec.Struct):
    """The table ``[keys]``, which is read first because strings are spelled with it."""

    keys: SpellingKeys = field(default_factory=SpellingKeys)
