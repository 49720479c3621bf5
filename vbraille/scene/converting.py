"""Scenes of other formats made into scene files of our own, and how these are written."""

from __future__ import annotations

import os
import re
import textwrap
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
from msgspec import structs
from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.scene.pattern import Pattern
from vbraille.scene.patterns import Group, Image, ImageDots
from vbraille.scene.reading import form_of
from vbraille.scene.traversal import with_children
from vbraille.toml import Table

if TYPE_CHECKING:
    from vbraille.scene.locations import FoundScene
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.scene import Scene
    from vbraille.scene.traversal import Steps


LONGEST = 72  # columns of a line, where that can be
# Keys that come first: what a table is, and what people call it.
_FIRST = ("id", "title", "description")
# Keys that all patterns have, which change what the others describe.
_LAST = ("amplitude", "inverted", "vibration", "factor")
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
    """Tell how far down a value stands in its table: what a thing is, its looks, what is in it."""
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


_LINE = re.compile(r"line (\d+)")


@dataclass(frozen=True, slots=True)
class ConvertedScene:
    """A scene file made of one of another format.

    Parameters
    ----------
    text
        Text of the file.
    elements
        Number of elements in it.
    differences
        What was ignored, or means something else here, each in one sentence.
    """

    text: str
    elements: int
    differences: tuple[str, ...]


def convert_scene(path: Path, folder: Path, *, as_shown: bool = False) -> ConvertedScene:
    """Make a scene file of a file of another format, OpenLatero's or SVG.

    Comments say where each element comes from, and what differs.

    Parameters
    ----------
    path
        The file.
    folder
        Folder that the new file will stand in; the names of images are seen from there.
    as_shown
        Whether a scene of OpenLatero's is to be as OpenLatero shows it, where that is not what the
        file says.

    Raises
    ------
    InputError
        If the file cannot be read, is not right, or is a scene file already.
    """
    form = form_of(path)
    if form == "toml":
        raise InputError(f"{path} is a scene file, or none at all; give a .gen, .tx or .svg file")
    if as_shown and form != "gen":
        raise InputError(f"{path} is not OpenLatero's; leave --as-shown out")
    found = _read(path, form, as_shown)
    scene = seen_from(found.scene, path.parent, folder)
    return ConvertedScene(
        write_scene(scene, _comments(path, found)), len(scene.elements), found.warnings
    )


def seen_from(scene: Scene, old: Path, new: Path) -> Scene:
    """Scene whose images and sounds are named as they are seen from another folder.

    Parameters
    ----------
    scene
        The scene.
    old, new
        Folder that the names are seen from, and the folder that they are to be seen from.
    """
    start, there = old.resolve(), new.resolve()
    if start == there:
        return scene

    def moved(_: Steps, pattern: AnyPattern) -> AnyPattern:
        if pattern.sound:
            pattern = replace(pattern, sound=_relative(start / pattern.sound, there))
        if isinstance(pattern, Image | ImageDots):
            pattern = replace(pattern, file=_relative(start / pattern.file, there))
        return with_children(pattern, moved)

    return replace(
        scene,
        elements=tuple(moved((), element) for element in scene.elements),
        textures={name: moved((), texture) for name, texture in scene.textures.items()},
    )


def _relative(file: Path, folder: Path) -> str:
    """Name of a file from a folder; its whole path only where no other name leads there."""
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # another drive
        return file.as_posix()


def _read(path: Path, form: str, as_shown: bool) -> FoundScene:
    if form == "svg":
        from vbraille.scene.svg.drawing import read_svg  # loads the library for SVG

        return read_svg(path)
    from vbraille.scene.openlatero import read_gen  # loads the library for XML

    return read_gen(path, as_shown=as_shown)


def _comments(path: Path, found: FoundScene) -> dict[Steps, tuple[str, ...]]:
    """Comments on the file and on its elements: where they come from, and what differs."""
    comments: dict[Steps, list[str]] = {(): [f"Converted from {_printed(path.name)}."]}
    for steps, line in found.lines.items():
        comments[steps] = [f"From line {line}."]
    for warning in found.warnings:
        comments[_about(warning, found.lines)] += textwrap.wrap(
            _printed(warning), LONGEST - 2, break_long_words=False, break_on_hyphens=False
        )
    return {steps: tuple(lines) for steps, lines in comments.items()}


def _about(warning: str, lines: Mapping[Steps, int]) -> Steps:
    """Element of the scene that a warning is about: the last that begins at its line or before."""
    found = _LINE.match(warning)
    line = int(found[1]) if found else 0
    before = [(at, steps) for steps, at in lines.items() if len(steps) == 2 and at <= line]
    return max(before)[1] if before else ()


def _printed(text: str) -> str:
    return "".join(c if c.isprintable() else "?" for c in text)
