"""Scenes written as files: TOML that a person reads with a finger, line by line.

Every table has one key on a line, in a fixed order, and what is as usual is left out. A file that
is read again gives the same scene.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING

import msgspec
from msgspec import structs

from vbraille.scene.pattern import Pattern
from vbraille.scene.patterns import Group
from vbraille.toml.tomlfile import Table

if TYPE_CHECKING:
    from vbraille.scene.scene import Scene
    from vbraille.scene.walking import Steps

LONGEST = 72  # columns of a line, where that can be
# Keys that come first: what a table is, and what people call it.
_FIRST = ("id", "title", "description")
# Keys that all patterns have, which change what the others describe.
_LAST = ("amplitude", "inverted", "vibration")
_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def write_scene(scene: Scene, comments: Mapping[Steps, tuple[str, ...]] | None = None) -> str:
    """Text of a scene's file.

    Parameters
    ----------
    scene
        The scene, without what it includes.
    comments
        Lines of comments by the keys that lead to what they are about: ``("elements", 0)`` for the
        first element, ``("elements", 0, "parts", 2)`` for a part of it, and none for the whole
        file.
    """
    said = comments or {}
    top = _commented(said.get((), ()))
    lines = [*top, *([""] if top else []), *_lines(scene, (), "", said)]
    return "\n".join(lines).lstrip("\n") + "\n"


def _lines(
    table: Table, steps: Steps, name: str, comments: Mapping[Steps, tuple[str, ...]]
) -> list[str]:
    """Lines of a table, without its header, and of the tables in it."""
    kind = type(table).__struct_config__
    lines = [f"{kind.tag_field} = {_text(str(kind.tag))}"] if kind.tag_field else []
    below: list[str] = []

    def add(header: str, inner: Table, there: Steps, whole: str) -> None:
        below.extend(["", *_commented(comments.get(there, ())), header])
        below.extend(_lines(inner, there, whole, comments))

    for key, value in _said(table):
        whole = f"{name}.{key}" if name else key
        if isinstance(value, Table):
            inline = _inline(key, value) if steps and (*steps, key) not in comments else None
            if inline is not None:
                lines.append(inline)
            else:
                add(f"[{whole}]", value, (*steps, key), whole)
        elif isinstance(value, Mapping):
            for item, inner in value.items():
                inside = f"{whole}.{_key(item)}"
                add(f"[{inside}]", inner, (*steps, key, item), inside)
        elif isinstance(value, tuple) and any(isinstance(item, Table) for item in value):
            for number, item in enumerate(value):
                add(f"[[{whole}]]", item, (*steps, key, number), whole)
        else:
            lines += _valued(key, value)
    return lines + below


def _said(table: Table) -> list[tuple[str, object]]:
    """Keys and values of a table that are not as usual, in the order in which they stand."""
    said: dict[str, object] = {}
    for name, key, usual in _fields(type(table)):
        value = getattr(table, name)
        if value == usual and not (isinstance(table, Group) and name == "operation"):
            continue
        said[key] = value
    first = [key for key in _FIRST if key in said]
    last = [key for key in _LAST if key in said and isinstance(table, Pattern)]
    middle = [key for key in said if key not in (*first, *last)]
    middle.sort(key=lambda key: _depth(said[key]))
    return [(key, said[key]) for key in (*first, *middle, *last)]


@cache
def _fields(kind: type[Table]) -> list[tuple[str, str, object]]:
    """Names of a table's fields, their keys and what they are as usual."""
    return [
        (
            field.name,
            field.encode_name,
            field.default
            if field.default_factory is msgspec.NODEFAULT
            else field.default_factory(),
        )
        for field in structs.fields(kind)
    ]


def _depth(value: object) -> int:
    """How far down a value stands in its table: what a thing is, its looks, what is in it."""
    if isinstance(value, Table):
        return 1
    if isinstance(value, Mapping):
        return 2
    return 3 if isinstance(value, tuple) and any(isinstance(v, Table) for v in value) else 0


def _valued(key: str, value: object) -> list[str]:
    """Lines of a key whose value is no table: one, or one for each item if it is too long."""
    return _laid(f"{key} = ", value, "")


def _laid(before: str, value: object, after: str, indent: str = "") -> list[str]:
    line = f"{indent}{before}{_value(value)}{after}"
    if len(line) <= LONGEST or not isinstance(value, tuple):
        return [line]
    items = [line for item in value for line in _laid("", item, ",", f"{indent}  ")]
    return [f"{indent}{before}[", *items, f"{indent}]{after}"]


def _inline(key: str, table: Table) -> str | None:
    """Line of a key whose value is a small table; None if that stands better by itself."""
    said = _said(table)
    if any(_depth(value) for _, value in said):
        return None
    kind = type(table).__struct_config__
    parts = [f"{kind.tag_field} = {_text(str(kind.tag))}"] if kind.tag_field else []
    parts += [f"{name} = {_value(value)}" for name, value in said]
    line = f"{key} = {{ {', '.join(parts)} }}" if parts else f"{key} = {{}}"
    return line if len(line) <= LONGEST else None


def _commented(lines: tuple[str, ...]) -> list[str]:
    return [f"# {line}".rstrip() for line in lines]


def _value(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, tuple):
        return f"[{', '.join(map(_value, value))}]"
    assert isinstance(value, int | float)
    return _number(value)


def _number(value: float) -> str:
    """A number as plainly as it can be, with all that it is."""
    whole = int(value)
    return str(whole) if whole == value and abs(whole) < 10**15 else repr(value)


def _text(value: str) -> str:
    return '"' + "".join(_ESCAPES.get(c) or _character(c) for c in value) + '"'


def _character(character: str) -> str:
    code = ord(character)
    return character if code >= 0x20 and code != 0x7F else f"\\u{code:04x}"


def _key(name: str) -> str:
    plain = name and all(c.isascii() and (c.isalnum() or c in "-_") for c in name)
    return name if plain else _text(name)
