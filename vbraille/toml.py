"""Reads TOML into structs. An error names the file, the line and the key."""

from __future__ import annotations

import difflib
import math
import re
import tomllib
from functools import cached_property
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

import msgspec
from msgspec import inspect

from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

Kind = TypeVar("Kind")
# The keys of tables and the indices of items that lead to a value.
Path = tuple[str | int, ...]

_PART = r"""(?:[\w-]+|"[^"]*"|'[^']*')"""
_NAME = rf"{_PART}(?:\s*\.\s*{_PART})*"
_HEADER = re.compile(rf"\s*(\[\[?)\s*({_NAME})\s*\]")
_KEY = re.compile(rf"\s*({_NAME})\s*=")
_UNIT = re.compile(r"_(?:(?:mm|deg)(?:_s)?|hz|s)$")
_DEEP = re.compile(r"(?:[\w-]++[ \t]*+\.[ \t]*+){100}")
_STEP = re.compile(r"\.([\w-]+)|\[(\d+)\]")
_WORDS = {
    "int": "a whole number",
    "float": "a number",
    "bool": "true or false",
    "str": "a text in quotation marks",
    "array": "a list in brackets",
    "object": "a table",
}
_MOST_WHOLE = 2**63 - 1  # of TOML


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
        self.path: Path = tuple(int(step) if step.isdigit() else step for step in path.split("."))
        self.problem = problem


class TomlFile:
    """The text of a TOML file, with the file's name for messages.

    Raises
    ------
    InputError
        If the text is not TOML, or has a number that is not finite or control characters.
    """

    def __init__(self, text: str, where: str) -> None:
        self.text, self.where = text, where
        if _DEEP.search(text):  # tomllib takes time and memory by all parts before each
            raise InputError(f"{where} nests its tables too deep; make it flatter")
        try:
            self.tree = tomllib.loads(text)
        except (ValueError, RecursionError) as error:
            raise InputError(f"{where} is not TOML: {error}") from None
        for path, value in _leaves(self.tree, ()):
            if isinstance(value, str) and not re.sub(r"\s", " ", value).isprintable():
                self.fail(path, "has control characters; leave them out")
            if isinstance(value, float) and not math.isfinite(value):
                self.fail(path, f"is {value}; it must be a number")
            if isinstance(value, int) and abs(value) > _MOST_WHOLE:
                self.fail(path, "is too large a number")

    def read(self, kind: type[Kind], under: Path = ()) -> Kind:
        """Convert the file, or the part of it that a path leads to.

        Raises
        ------
        InputError
            If a key or a value cannot be used.
        """
        try:
            return msgspec.convert(self.at(under), kind)
        except msgspec.ValidationError as error:
            path, problem = _explain(error, kind, self.at(under))
            self.fail((*under, *path), problem)

    def names(self, *path: str | int) -> tuple[str, ...]:
        """Keys of a table of the file; none if it is not there.

        Raises
        ------
        InputError
            If there is something else than a table.
        """
        table = self.at(path)
        if table is not None and not isinstance(table, dict):
            self.fail(path, "must be a table")
        return tuple(table or ())

    def at(self, path: Path) -> Any:
        """Value at a path; None if there is none."""
        value: Any = self.tree
        try:
            for step in path:
                value = value[step]
        except (KeyError, IndexError, TypeError):
            return None
        return value

    @cached_property
    def lines(self) -> dict[Path, int]:
        """Lines of tables and keys, from 1, by the paths that lead to them."""
        return lines_of(self.text)

    def fail(self, path: Path, problem: str) -> NoReturn:
        """Refuse the file for the value at a path.

        Raises
        ------
        InputError
            In any case; the sentence names the line.
        """
        raise self.refused(path, problem)

    def refused(self, path: Path, problem: str) -> InputError:
        """Error on the value at a path, with the file and the line."""
        table = self.at(path)
        if isinstance(table, dict):
            path = (*path, *_key_said(problem, table))
        keys = [step for step in path if isinstance(step, str)]
        name = ""
        if keys and not _key_said(problem, keys[-1:]):
            number = f" {path[-1] + 1}" if isinstance(path[-1], int) else ""
            name = f"{keys[-1]}{number}: "
        return InputError(f"{self.where} line {line_of(self.text, path)}: {name}{problem}")


def read_toml(text: str, kind: type[Kind], where: str) -> Kind:
    """Convert a TOML text to a struct.

    Raises
    ------
    InputError
        If the text is not TOML, or a key or a value cannot be used.
    """
    return TomlFile(text, where).read(kind)


def located(text: str, where: str, error: WrongValue) -> InputError:
    """Return the error of a wrong value with the file and the line."""
    return TomlFile(text, where).refused(error.path, error.problem)


def words_of(key: str) -> str:
    """Words of a key, without its unit.

    >>> words_of("wave_angle_deg")
    'wave angle'
    """
    return _UNIT.sub("", key).replace("_", " ")


def which(name: str, names: Iterable[str]) -> str:
    """Return the end of a sentence on an unknown name: the nearest one, or all that there are."""
    known = sorted(names)
    near = difflib.get_close_matches(name, known, 1)
    return f"; did you mean {near[0]}?" if near else f"; known: {', '.join(known)}"


def lines_of(text: str) -> dict[Path, int]:
    """Line, from 1, of each table, item of an array of tables, and key, by its path."""
    found: dict[Path, int] = {}
    table: Path = ()
    counts: dict[Path, int] = {}  # index of the newest table under each [[name]]
    for number, line in enumerate(text.splitlines(), 1):
        if header := _HEADER.match(line):
            table = ()
            for part in re.findall(_PART, header[2]):
                table = (
                    *((*table, counts[table]) if table in counts else table),
                    part.strip("\"'"),
                )
            found.setdefault(table, number)
            if header[1] == "[[":
                counts[table] = counts.get(table, -1) + 1
            if table in counts:
                table = (*table, counts[table])
                found.setdefault(table, number)
        elif key := _KEY.match(line):
            parts = (part.strip("\"'") for part in re.findall(_PART, key[1]))
            found.setdefault((*table, *parts), number)
    return found


def line_of(text: str, path: Iterable[str | int]) -> int:
    """Line, from 1, of the value that a path leads to, or of what it is in."""
    lines, at = lines_of(text), tuple(path)
    while at and at not in lines:
        at = at[:-1]
    return lines.get(at, 1)


def _leaves(value: object, path: Path) -> Iterator[tuple[Path, object]]:
    """Go through all values that hold no others, with their paths."""
    left = [(path, value)]
    while left:
        path, value = left.pop()
        if isinstance(value, dict):
            left += [((*path, key), inner) for key, inner in value.items()]
        elif isinstance(value, list):
            left += [((*path, number), inner) for number, inner in enumerate(value)]
        else:
            yield path, value


def _key_said(problem: str, table: Iterable[str]) -> Path:
    """Key of a table whose words, without its unit, begin a problem; empty if none does."""
    for key in sorted(table, key=len, reverse=True):
        if re.match(rf"{re.escape(words_of(key))}(?!\w)", problem.replace("_", " ")):
            return (key,)
    return ()


def _explain(error: msgspec.ValidationError, kind: type, tree: Any) -> tuple[Path, str]:
    """Return the path to what is wrong, and the words for it."""
    message, _, steps = str(error).partition(" - at `$")
    path: Path = tuple(int(item) if item else key for key, item in _STEP.findall(steps))
    cause = error.__cause__
    if isinstance(cause, WrongValue):
        return path + cause.path, cause.problem
    if isinstance(cause, ValueError):
        return path, str(cause)
    if match := re.match(r"Object contains unknown field `(.*)`", message):
        return (
            *path,
            match[1],
        ), f"unknown key{which(match[1], _known_keys(kind, path, tree))}"
    if match := re.match(r"Object missing required field `(.*)`", message):
        return path, f"{match[1]} is missing"
    if match := re.match(r"Invalid (?:enum )?value (.*)", message):
        known = [str(each) for each in _known_values(kind, path)]
        return path, f"is {match[1]}{which(match[1].strip(chr(39)), known)}"
    message = re.sub(r"`(\w[^`]*)`", _plain, message)
    return path, message.replace("Expected", "must be").replace(", got", ", not")


def _plain(names: re.Match[str]) -> str:
    """Words for the types that msgspec names."""
    parts = names[1].split(" | ")
    return " or ".join(_WORDS.get(part, f"`{part}`") for part in parts if part != "null")


def _known_keys(kind: type, path: Path, tree: Any) -> list[str]:
    """Return the keys that the table at a path may have, by its kind if there are several."""
    for step in path:
        tree = tree[step]
    structs = [each for each in _types_at(kind, path) if isinstance(each, inspect.StructType)]
    own = [each for each in structs if not each.tag_field or tree.get(each.tag_field) == each.tag]
    tags = [each.tag_field for each in own if each.tag_field]
    return [*tags, *(field.encode_name for each in own for field in each.fields)]


def _known_values(kind: type, path: Path) -> list[Any]:
    """Return the values that a key may have, or the kinds that a table may be of."""
    values = [value for each in _types_at(kind, path) for value in getattr(each, "values", ())]
    tables = [each for each in _types_at(kind, path[:-1]) if isinstance(each, inspect.StructType)]
    return values or [each.tag for each in tables]


def _types_at(kind: type, path: Path) -> list[inspect.Type]:
    """Return the types that the value at a path may have, members of unions each by itself."""
    types = _members(inspect.type_info(kind))
    for step in path:
        below: list[inspect.Type] = []
        for each in types:
            if isinstance(each, inspect.StructType):
                below += [field.type for field in each.fields if field.encode_name == step]
            elif isinstance(each, inspect.DictType):
                below.append(each.value_type)
            elif isinstance(each, inspect.CollectionType):
                below.append(each.item_type)
        types = [member for each in below for member in _members(each)]
    return types


def _members(kind: inspect.Type) -> list[inspect.Type]:
    return [*kind.types] if isinstance(kind, inspect.UnionType) else [kind]
