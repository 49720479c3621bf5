"""Scenes of other formats made into scene files of our own, and how these are written."""

from __future__ import annotations

import json
import os
import re
import textwrap
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from msgspec.structs import fields, replace

from vbraille.errors import InputError
from vbraille.scene.reading import form_of, read_foreign, with_files
from vbraille.scene.traversal import mapped
from vbraille.toml import Table
from vbraille.wording import printable

if TYPE_CHECKING:
    from vbraille.scene.locations import FoundScene
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.scene import Scene
    from vbraille.scene.traversal import Steps

    Comments = Mapping[Steps, tuple[str, ...]]

LONGEST = 72  # columns of a line, where that can be
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_fields = cache(fields)


def write_scene(scene: Scene, comments: Comments | None = None) -> str:
    """Text of a scene's file; tomlkit would take a second for each 30,000 numbers of a drawing.

    Parameters
    ----------
    scene
        The scene, without what it includes.
    comments
        Lines of comments by the keys that lead to what they are about: ``("elements", 0)`` for the
        first element, ``("elements", 0, "parts", 2)`` for a part of it, and none for the whole
        file.
    """
    text = "\n".join(_lines("", _plain(scene), (), "", comments or {}))
    return text.strip("\n").replace("\n\n\n", "\n\n") + "\n"


def _plain(value: Any) -> Any:
    """Make dictionaries and lists of a value, without what is as usual."""
    if isinstance(value, Table):
        kind = type(value).__struct_config__
        plain = {kind.tag_field: kind.tag} if kind.tag_field else {}
        for field in _fields(type(value)):
            own = getattr(value, field.name)
            if own not in (field.default, {}):
                plain[field.encode_name] = _plain(own)
        return plain
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return int(value)
    return value


def _lines(
    header: str, table: dict[str, Any], steps: Steps, name: str, comments: Comments
) -> list[str]:
    """Lines of a table with its header, after an empty one, and of the tables in it."""
    lines: list[str] = []
    below: list[str] = []
    for key, value in table.items():
        there, line = (*steps, key), f"{key} = {_text(value)}"
        whole = name + (key if _BARE_KEY.fullmatch(key) else _text(key))
        is_small = steps[1:] and there not in comments and len(line) <= LONGEST
        if _is_tables(value):
            for number, item in enumerate(value):
                below += _lines(f"[[{whole}]]", item, (*there, number), f"{whole}.", comments)
        elif not isinstance(value, dict):
            lines += _laid(f"{key} = ", value)
        elif is_small and not any(
            isinstance(one, dict) or _is_tables(one) for one in value.values()
        ):
            lines.append(line)
        else:
            below += _lines(f"[{whole}]", value, there, f"{whole}.", comments)
    about = [f"# {line}".rstrip() for line in comments.get(steps, ())]
    is_said = lines or not below or header.startswith("[[") or about
    return [*(["", *about, header] if is_said else []), *lines, *below]


def _is_tables(value: object) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], dict)


def _laid(before: str, value: object, after: str = "", indent: str = "") -> list[str]:
    """Lines of a value that is no table: one, or one for each item if it is too long."""
    line = f"{indent}{before}{_text(value)}{after}"
    if len(line) <= LONGEST or not isinstance(value, list):
        return [line]
    items = [line for item in value for line in _laid("", item, ",", f"{indent}  ")]
    return [f"{indent}{before}[", *items, f"{indent}]{after}"]


def _text(value: object) -> str:
    """Text of a value on one line, which but for tables is as in JSON."""
    if isinstance(value, dict):
        items = ", ".join(f"{key} = {_text(item)}" for key, item in value.items())
        return f"{{ {items} }}" if items else "{}"
    return json.dumps(value, ensure_ascii=False)


class ConvertedScene(NamedTuple):
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

    Comments say what differs, and where each element comes from.

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
    found = read_foreign(path, form, as_shown=as_shown)
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

    def seen(pattern: AnyPattern) -> AnyPattern:
        return mapped(
            pattern, lambda one: with_files(one, lambda name: _relative(start / name, there))
        )

    return replace(
        scene,
        elements=tuple(map(seen, scene.elements)),
        textures={name: seen(texture) for name, texture in scene.textures.items()},
    )


def _relative(file: Path, folder: Path) -> str:
    """Name of a file from a folder; its whole path only where no other name leads there."""
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # another drive
        return file.as_posix()


def _comments(path: Path, found: FoundScene) -> Comments:
    """Comments on the file, with all that differs, and on the line that each element is from."""
    said = [f"Converted from {path.name}.", *found.warnings]
    lines = [
        line
        for one in said
        for line in textwrap.wrap(
            printable(one), LONGEST - 2, break_long_words=False, break_on_hyphens=False
        )
    ]
    comments: dict[Steps, tuple[str, ...]] = {(): tuple(lines)}
    return comments | {steps: (f"From line {line}.",) for steps, line in found.lines.items()}
