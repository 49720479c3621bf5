"""Reads TOML into structs. An error names the file, the line and the key."""

from __future__ import annotations

import difflib
import math
import re
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any, TypeVar

import msgspec
from msgspec import inspect

from vbraille.errors import InputError

Kind = TypeVar("Kind")
Path = list[str | int]

_HEADER = re.compile(r"\s*(\[\[?)\s*([\w.-]+)\s*\]\]?\s*(?:#.*)?$")
_KEY = re.compile(r"\s*([\w-]+)\s*=")
_STEP = re.compile(r"\.([\w-]+)|\[(\d+)\]")
_WORDS = {
    "`int`": "a whole number",
    "`float`": "a number",
    "`bool`": "true or false",
    "`str`": "a text in quotation marks",
    "`array`": "a list in brackets",
    "`object`": "a table",
}


class Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A table of a TOML file. Its fields are the keys that the table may have."""


class WrongValue(ValueError):
    """A value that contradicts another one.

    Parameters
    ----------
    path
        Keys that lead to the value, such as "design.blocks".
    problem
        What is wrong, as the end of a sentence that begins with the last key.
    """

    def __init__(self, path: str, problem: str) -> None:
        super().__init__(f"{path}: {problem}")
        self.path: Path = [int(step) if step.isdigit() else step for step in path.split(".")]
        self.problem = problem


def read_toml(text: str, kind: type[Kind], where: str) -> Kind:
    """Convert a TOML text to a struct.

    Raises
    ------
    InputError
        If the text is not TOML, or a key or a value cannot be used.
    """
    try:
        tree = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise InputError(f"{where} is not TOML: {error}") from None
    for path, value in _leaves(tree, []):
        if isinstance(value, float) and not math.isfinite(value):
            raise _refused(text, where, path, f"is {value}; it must be a number")
        if isinstance(value, str) and not value.replace("\n", " ").isprintable():
            raise _refused(text, where, path, "has control characters; leave them out")
    try:
        return msgspec.convert(tree, kind)
    except msgspec.ValidationError as error:
        raise _refused(text, where, *_explain(error, kind, tree)) from None


def located(text: str, where: str, error: WrongValue) -> InputError:
    """Return the error of a wrong value with the file and the line."""
    return _refused(text, where, error.path, error.problem)


def which(name: str, names: Iterable[str]) -> str:
    """Return the end of a sentence on an unknown name: the nearest one, and all that there are."""
    known = sorted(names)
    near = difflib.get_close_matches(name, known, 1)
    return f"; did you mean {near[0]}?" if near else f"; known: {', '.join(known)}"


def _refused(text: str, where: str, path: Path, problem: str) -> InputError:
    keys = [step for step in path if isinstance(step, str)]
    key = f"{keys[-1]}: " if keys else ""
    return InputError(f"{where} line {line_of(text, path)}: {key}{problem}")


def _leaves(value: object, path: Path) -> Iterator[tuple[Path, object]]:
    """Go through all values that hold no others, with their paths."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _leaves(inner, [*path, key])
    elif isinstance(value, list):
        for number, inner in enumerate(value):
            yield from _leaves(inner, [*path, number])
    else:
        yield path, value


def line_of(text: str, path: Path) -> int:
    """Return the line, from 1, of the key that a path leads to, or of the table that it is in."""
    found = 1
    table: Path = []
    counts: Counter[str] = Counter()
    for number, line in enumerate(text.splitlines(), 1):
        if header := _HEADER.match(line):
            table = list(header[2].split("."))
            if header[1] == "[[":
                table.append(counts[header[2]])
                counts[header[2]] += 1
            here = table
        elif key := _KEY.match(line):
            here = [*table, key[1]]
        else:
            continue
        if here == path[: len(here)]:
            found = number
    return found


def _explain(error: msgspec.ValidationError, kind: type, tree: object) -> tuple[Path, str]:
    """Return the path to what is wrong, and the words for it."""
    message, _, steps = str(error).partition(" - at `$")
    path: Path = [int(item) if item else key for key, item in _STEP.findall(steps)]
    if isinstance(error.__cause__, WrongValue):
        return path + error.__cause__.path, error.__cause__.problem
    if match := re.match(r"Object contains unknown field `(.*)`", message):
        near = which(match[1], _known_keys(kind, path, tree))
        return [*path, match[1]], f"there is no such key{near}"
    if match := re.match(r"Object missing required field `(.*)`", message):
        return path, f"{match[1]} is missing"
    if match := re.match(r"Invalid (?:enum )?value (.*)", message):
        known = [str(each) for each in _known_values(kind, path)]
        return path, f"is {match[1]}" + which(match[1].strip("'"), known)
    message = message.replace(" | null", "")
    for word, plain in _WORDS.items():
        message = message.replace(word, plain)
    return path, message.replace("Expected", "must be").replace(", got", ", and is")


def _known_keys(kind: type, path: Path, tree: Any) -> list[str]:
    """Return the keys that the table at a path may have, if it is of one of several kinds."""
    for step in path:
        tree = tree[step]
    structs = [each for each in _types_at(kind, path) if isinstance(each, inspect.StructType)]
    own = [each for each in structs if not each.tag_field or tree.get(each.tag_field) == each.tag]
    return [field.encode_name for each in own for field in each.fields]


def _known_values(kind: type, path: Path) -> list[str]:
    """Return the values that a key may have, or the kinds that a table may be of."""
    values = []
    for each in _types_at(kind, path):
        values += each.values if isinstance(each, inspect.LiteralType) else []
    tables = [each for each in _types_at(kind, path[:-1]) if isinstance(each, inspect.StructType)]
    return values or [each.tag for each in tables]


def _types_at(kind: type, path: Path) -> list[inspect.Type]:
    """Return the types that the value at a path may have."""
    types = [inspect.type_info(kind)]
    for step in path:
        below = []
        for each in _plain_types(types):
            if isinstance(each, inspect.StructType):
                below += [field.type for field in each.fields if field.encode_name == step]
            elif hasattr(each, "item_type"):
                below.append(each.item_type)
        types = below
    return _plain_types(types)


def _plain_types(types: list[inspect.Type]) -> list[inspect.Type]:
    """Return the types, with the members of unions in place of the unions."""
    found = []
    for each in types:
        found += each.types if isinstance(each, inspect.UnionType) else [each]
    return found
