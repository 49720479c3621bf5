"""Reading of protocols, from the program's own folder or from a file."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
from msgspec import field

from vbraille.errors import InputError
from vbraille.sessions.planning.agreement import check_agreement
from vbraille.sessions.planning.design import ItemList
from vbraille.sessions.planning.factors import problem
from vbraille.sessions.planning.items import read_items, read_orders, read_words
from vbraille.sessions.planning.protocol import FORMAT, Protocol, ProtocolFile
from vbraille.sessions.planning.spellings import SpellingKeys, read_keys, spelled
from vbraille.toml.textfile import read_text
from vbraille.toml.tomlfile import TomlFile, which

if TYPE_CHECKING:
    from collections.abc import Callable

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
        folder = Path(spec).parent

        def beside(name: str) -> str:
            return read_text(str(folder / name), "file beside the protocol")

        return parse_protocol(read_text(spec, "protocol"), spec, beside=beside)

    def shipped(name: str) -> str:
        return _FOLDER.joinpath(name).read_bytes().decode("utf-8")

    return parse_protocol(builtin_text(spec), f"{spec}.toml", beside=shipped)


def parse_protocol(
    text: str,
    where: str,
    *,
    planned: bool = False,
    beside: Callable[[str], str] | None = None,
) -> Protocol:
    """Make a protocol from the text of its file, and check it.

    Parameters
    ----------
    text
        TOML text of the protocol.
    where
        Name of the file, for messages.
    planned
        Whether the protocol belongs to a session, whose plan has the cells of all texts: no
        braille table is asked for them again.
    beside
        Function that reads a file which stands beside the protocol, by its name; None if there is
        none.

    Raises
    ------
    InputError
        If the protocol cannot be used. One sentence says where, why, and what to do.
    """
    file = TomlFile(text, where)
    file.read(_Format)  # this comes first, since another format may have other keys
    keys = file.read(_Keyed, read_keys).keys
    written = _names_tables(file)
    tables = file.read(ProtocolFile, spelled(keys, written=written))
    files = _files(file, tables, beside)
    with file.checking():
        protocol = _resolved(tables, text, files, keys, written=written)
        check_agreement(protocol, planned=planned)
        if protocol.practice.trials and not protocol.practice.items:
            raise ValueError(
                f"[practice] has no items of its own, and those of the test would be given away; "
                f"give {'values' if protocol.parameter else 'strings'} that the test does not "
                f"have, or trials = 0"
            )
    return protocol


def _files(
    file: TomlFile, tables: ProtocolFile, beside: Callable[[str], str] | None
) -> dict[str, str]:
    """Texts of all files that a protocol names, by their names."""
    texts: dict[str, str] = {}
    for table in ("items", "practice", "order"):
        name = getattr(getattr(tables, table), "file", None)
        if name is None or name in texts:
            continue
        if beside is None:
            file.fail((table, "file"), f"is {name!r}, and nothing stands beside this protocol")
        try:
            texts[name] = beside(name)
        except (InputError, FileNotFoundError) as error:
            why = error if isinstance(error, InputError) else "there is no such file"
            file.fail((table, "file"), f"is {name!r}, which cannot be read: {why}")
    return texts


def _names_tables(file: TomlFile) -> bool:
    """Whether a protocol names braille tables, so that its strings are texts."""
    looks = file.read(_Looks)
    levels = [level for factor in _tables(looks.factors) for level in _tables(factor.get("levels"))]
    return any(
        "table" in look for look in (*_tables([looks.display]), *_tables(looks.conditions), *levels)
    )


def _tables(values: object) -> list[dict[str, Any]]:
    """Tables among the values of a list; none if it is no list."""
    return [each for each in values if isinstance(each, dict)] if isinstance(values, list) else []


def _resolved(
    tables: ProtocolFile,
    text: str,
    files: dict[str, str],
    keys: SpellingKeys,
    *,
    written: bool,
) -> Protocol:
    """Protocol with the items and orders of its files.

    Raises
    ------
    ValueError
        If tables do not go together.
    InputError
        If a file cannot be used.
    """
    design, items, practice, rows, orders = tables.design, tables.items, tables.practice, (), ()
    if isinstance(design, ItemList) != (items is not None):
        raise ValueError(
            "[items] is of kind = 'items' in [design]; give that, or leave it out"
            if items is not None
            else "[design] kind is 'items', and there is no table [items]; add it"
        )
    if isinstance(design, ItemList) and items is not None:
        if items.rule is None:
            assert items.file is not None
            rows = read_items(files[items.file], items.file, keys, written=written)
            strings = tuple(row.masks for row in rows)
        else:
            name, words = items.file, ()
            if name is not None:
                words = read_words(files[name], name, keys, written=written)
            elif written:
                raise ValueError(
                    "[items] rule is 'strings', which draws cells, and table makes cells of texts; "
                    "give words or a list, or leave table out"
                )
            try:
                strings = items.draw(words)
            except ValueError as error:
                raise ValueError(f"[items] {error}") from None
        design = design.strings_of(strings)
    assert not isinstance(design, ItemList)
    if practice.file is not None:
        practised = read_items(files[practice.file], practice.file, keys, written=written)
        own = tuple(row.masks for row in practised)
        practice = msgspec.structs.replace(practice, file=None, strings=own)
    said = problem(tables.factors, tables.cross, listed=bool(tables.listed))
    if said:
        raise ValueError(said)
    fields = msgspec.structs.asdict(tables) | {"design": design, "practice": practice}
    protocol = Protocol(**fields, text=text, files=files, item_rows=rows)
    if tables.order is not None and tables.order.file is not None:
        names = [condition.name for condition in protocol.conditions]
        file = tables.order.file
        orders = read_orders(files[file], file, names, protocol.groups)
        protocol = msgspec.structs.replace(protocol, order_rows=orders)
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


class _Looks(msgspec.Struct):
    """The tables that may name a braille table, whatever they hold: it is not checked yet."""

    display: object = None
    conditions: object = None
    factors: object = None


class _Keyed(msgspec.Struct):
    """The table ``[keys]``, which is read first because strings are spelled with it."""

    keys: SpellingKeys = field(default_factory=SpellingKeys)
