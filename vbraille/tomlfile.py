"""Reading of TOML into typed values, or into one sentence that says what is wrong and where."""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

import msgspec
from msgspec import inspect

from vbraille.errors import InputError
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator

# The keys of tables and the indices of items that lead from the whole file to one value.
Path = tuple[str | int, ...]

_TOKEN = re.compile(
    r"""
    (?P<nothing>[ \t\r]+|\#[^\n]*)
    |"{3}(?:[^\\]|\\.)*?"{3}"{0,2}|'{3}.*?'{3}'{0,2}  # of several lines
    |"(?:[^"\\\n]|\\.)*"|'[^'\n]*'
    |[\n\[\]{},=.]
    |[^\s\[\]{},=.\#"']+
    """,
    re.VERBOSE | re.DOTALL,
)


def lines_of(text: str, about: Path | None = None) -> dict[Path, int]:
    r"""Line numbers, from 1, of keys, tables and items by their paths; braces are not looked into.

    Parameters
    ----------
    text
        A TOML text that `tomllib` can read; for other texts the result means nothing.
    about
        Path that is asked for: items of other keys' lists are left out then. None for all.

    Examples
    --------
    >>> lines_of('size = 3\n[[box]]\nnames = [\n  "a",\n  "b",\n]')["box", 0, "names", 1]
    5
    """
    lines: dict[Path, int] = {}
    tables: Counter[Path] = Counter()  # number of tables under each [[name]] so far
    table: Path = ()
    for statement in _statements(text):
        tokens = [token for token, _ in statement]
        header = tokens[0] == "["
        path: Path = () if header else table
        for token in tokens[: len(tokens) if header else tokens.index("=")]:
            if token in "[].":
                continue
            if path in tables:
                path = (*path, tables[path] - 1)
            path = (*path, _unquoted(token))
            lines.setdefault(path, statement[0][1])
        if not header:
            if about is None or path == about[: len(path)]:
                _add_items(lines, path, statement[tokens.index("=") + 1 :])
            continue
        if tokens[1] == "[":
            tables[path] += 1
            path = (*path, tables[path] - 1)
        lines[path] = statement[0][1]
        table = path
    return lines


def _statements(text: str) -> Iterator[list[tuple[str, int]]]:
    """Tokens, with their lines, of each header and of each key with its value."""
    statement: list[tuple[str, int]] = []
    depth, line = 0, 1
    for match in _TOKEN.finditer(f"{text}\n"):
        token = match[0]
        if token == "\n":
            if statement and not depth:
                yield statement
                statement = []
        elif match["nothing"] is None:
            statement.append((token, line))
            depth += (token in "[{") - (token in "]}")
        line += token.count("\n")


def _add_items(lines: dict[Path, int], path: Path, value: list[tuple[str, int]]) -> None:
    """Add the lines of the items of a list, and of the lists in it."""
    places: list[int] = []  # indices of the items that are open, outermost first
    for token, line in value:
        if token in "]}":
            places.pop()
        elif token == "," and places:
            places[-1] += 1
        else:
            lines.setdefault((*path, *places), line)
        if token in "[{":
            places.append(0)


def _unquoted(key: str) -> str:
    return tomllib.loads(f"key = {key}")["key"] if key[0] in "\"'" else key


_Value = TypeVar("_Value")

# TOML readers differ on larger numbers, and no number of a protocol is so large.
_MOST_WHOLE = 2**63 - 1
# Levels of tables and lists, and parts of a key. Each costs `tomllib` time and memory by those
# before it, so that a small file could take all there is.
_MOST_LEVELS = 100
_DEEP_KEY = re.compile(
    r"""(?:^|[\[{,])[ \t]*+(?:(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+)"""
    rf"{{{_MOST_LEVELS}}}",
    re.MULTILINE,
)
_LONGEST_QUOTE = 60
_MOST_STEPS = 8  # of the way to a place that a sentence says whole
# Spaces without a break, which French has before its marks and Python does not call printable.
_SPACES = {0xA0: " ", 0x202F: " "}
# Names that msgspec has for types, and what a file must have where such a type is wanted.
_WANTED = {
    "int": "a whole number",
    "float": "a number",
    "bool": "true or false",
    "str": "a string, in quotation marks",
    "array": "a list, in brackets",
    "object": "a table",
}
_EXPECTED = re.compile(r"Expected `([^`]*)`(?: of .*length (\d+))?, got")
_UNIT = re.compile(r"_(?:(?:mm|deg)(?:_s)?|hz)$")
_STEP = re.compile(r"\.(\w+)|\[(\d+)\]")
_ABOUT = re.compile(r"(?:\[{1,2}(\w+)\]{1,2} )?(?:number (\d+) )?(.*)", re.DOTALL)


class Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A table of a TOML file, whose fields are the keys that the table may have.

    A table checks its values in ``__post_init__``. If its `ValueError` is about one key, the
    message begins with the words of that key, so that the line of the file can be found.
    """


class TomlFile:
    """The text of a TOML file, together with the file's name.

    Parameters
    ----------
    text
        Text of the file.
    where
        Name of the file, for messages.
    several_lines
        Whether its strings may have several lines.

    Raises
    ------
    InputError
        If the text is not TOML, nests too deep, or has a string with control characters or a
        number that is far too large.
    """

    def __init__(self, text: str, where: str, *, several_lines: bool = False) -> None:
        self._text, self._where = text, where
        if deep := _DEEP_KEY.search(text):
            line = text.count("\n", 0, deep.end()) + 1
            parts = f"a key has more than {_MOST_LEVELS} parts"
            raise InputError(f"{where} line {line}: {parts}; make it shorter")
        try:
            self._tree = tomllib.loads(text)
        except RecursionError:
            raise InputError(f"{where} is not TOML: its brackets nest too deep; mend it") from None
        except ValueError as error:
            raise InputError(f"{where} is not TOML: {error}; mend it there") from None
        if _levels(self._tree) > _MOST_LEVELS:
            raise InputError(f"{where} nests its tables too deep; make it flatter")
        spaces = {**_SPACES, 0x0A: " "} if several_lines else _SPACES
        for path, value in _leaves(self._tree):
            if not _is_good(value, spaces):
                lines = "text" if several_lines else "one line"
                what = f"{lines} without control characters"
                self._refuse(path, what if isinstance(value, str) else "a smaller number")

    def read(
        self,
        kind: type[_Value],
        dec_hook: Callable[[type, Any], Any] | None = None,
        under: Path = (),
    ) -> _Value:
        """Convert the file, or a part of it, to a value of a type, which checks itself.

        Parameters
        ----------
        kind
            Type of the value, such as a `Table`.
        dec_hook
            Function that makes values of types which msgspec does not know.
        under
            Keys that lead to the part, which is there; none for the whole file.

        Raises
        ------
        InputError
            If a key is missing or not known, or a value has the wrong type or is out of range.
        """
        try:
            return msgspec.convert(self._at(under), kind, dec_hook=dec_hook)
        except msgspec.ValidationError as error:
            message, _, steps = str(error).rpartition(" - at `$")
            if not message:  # msgspec names no place if it is the value as a whole
                message, steps = steps, ""
            found = tuple(int(item) if item else key for key, item in _STEP.findall(steps))
            path = (*under, *found)
            if isinstance(error.__cause__, ValueError):
                colon = "" if isinstance(self._at(path), dict) else ": "
                self.fail(path, f"{colon}{error.__cause__}")
            self._explain(path, message, _types_at(kind, found))

    def names(self, *path: str | int) -> tuple[str, ...]:
        """Keys of a table of the file; none if it is not there.

        Raises
        ------
        InputError
            If there is something else than a table.
        """
        table = self._at(path)
        if table is not None and not isinstance(table, dict):
            self._refuse(path, "a table")
        return tuple(table or ())

    def is_table(self, *path: str | int) -> bool:
        """Tell whether there is a table at a place of the file."""
        return isinstance(self._at(path), dict)

    @property
    def where(self) -> str:
        """Name of the file."""
        return self._where

    def lines(self) -> dict[Path, int]:
        """Lines of keys, tables and items, from 1, by the keys that lead to them."""
        return lines_of(self._text)

    @contextmanager
    def checking(self) -> Iterator[None]:
        """Add the file and the line to the message of a `ValueError` about the file as a whole.

        The message must begin with the table that it is about, such as ``[design]`` or ``[[fields]]
        number 2``, followed by the words of the key. For a key in no table it begins with those.

        Raises
        ------
        InputError
            If a `ValueError` was raised within.
        """
        try:
            yield
        except ValueError as error:
            about = _ABOUT.fullmatch(str(error))
            table, item, problem = about.groups() if about else (None, None, "")
            path = (*([table] if table else []), *([int(item) - 1] if item else []))
            raise InputError(f"{self._line(path, problem)}: {error}") from None

    def _explain(self, path: Path, message: str, types: list[inspect.Type]) -> NoReturn:
        """Raise a sentence that says in plain words what msgspec found."""
        value = self._at(path)
        expected = _EXPECTED.match(message)
        if message.startswith("Object missing"):
            self.fail(path, f"lacks {message.split('`')[1]}; add it")
        if message.startswith("Object contains unknown") and isinstance(value, dict):
            self._fail_unknown(path, value, [t for t in types if isinstance(t, inspect.StructType)])
        literals = dict.fromkeys(t.values for t in types if isinstance(t, inspect.LiteralType))
        names = [str(name) for values in literals for name in values]
        if message.startswith("Invalid"):
            self.fail(path, f"is {quote(value)}{which(str(value), names)}")
        if expected and expected[2]:
            items = [f.name for t in types if isinstance(t, inspect.StructType) for f in t.fields]
            which_items = f": {', '.join(items)}" if items else ""
            self.fail(path, f"has {len(value)} items; give {expected[2]}{which_items}")
        if expected and any(map(_is_tables, types)):
            self.fail(path, f"must be tables; write each under [[{path[-1]}]]")
        if expected:
            # Words of one list are few; those that tell kinds of tables apart are many.
            few = len(literals) == 1
            words = {**_WANTED, "str": " or ".join(map(quote, names))} if few else _WANTED
            wanted = [words.get(name) for name in expected[1].split(" | ")]
            self._refuse(path, " or ".join(filter(None, wanted)))
        self.fail(path, f"cannot be used: {message}")

    def _fail_unknown(
        self, path: Path, table: dict[str, Any], kinds: list[inspect.StructType]
    ) -> NoReturn:
        """Raise a sentence about a key that tables, or tables of this kind, cannot have."""
        own = [kind for kind in kinds if not kind.tag_field or table[kind.tag_field] == kind.tag]
        known = {name for kind in own for name in _keys(kind)}
        key = next((key for key in table if key not in known), "")
        # A kind that several keys may hold is among the kinds several times.
        others = dict.fromkeys(repr(kind.tag) for kind in kinds if key in _keys(kind))
        if others:
            kind = own[0]
            self.fail(
                (*path, key),
                f"is of {kind.tag_field} = {' or '.join(others)}; "
                f"leave it out of {kind.tag_field} = {kind.tag!r}",
            )
        self.fail(path, f"has no key {quote(key)}{which(key, known)}", key)

    def _refuse(self, path: Path, wanted: str) -> NoReturn:
        self.fail(path, f"is {quote(self._at(path))}; it must be {wanted}")

    def fail(self, path: Path, problem: str, key: str = "") -> NoReturn:
        """Refuse the file for a problem at a place in it, by a sentence that names its line.

        Parameters
        ----------
        path
            Keys that lead to the place.
        problem
            Rest of a sentence that begins with the name of the place.
        key
            Key whose line is named in place of the place's; empty for none.

        Raises
        ------
        InputError
            In any case.
        """
        named = self._named(path)
        if named and not problem.startswith(":"):
            is_item = isinstance(path[-1], int) and not isinstance(self._at(path), dict)
            named += ", " if is_item else " "
        line = self._line((*path, key) if key else path, problem)
        raise InputError(f"{line}: {named}{problem}")

    def _named(self, path: Path) -> str:
        """Table, as the file writes it, and key of a place in the file."""
        depth = 0
        while depth < len(path) and isinstance(self._at(path[: depth + 1]), dict):
            depth += 1
        if depth:
            label, rest = f"[{'.'.join(map(str, path[:depth]))}]", path[depth:]
        elif path and isinstance(self._at(path[:2]), dict):
            label, rest = f"[[{path[0]}]] number {int(path[1]) + 1}", path[2:]
        else:
            label, rest = "", path
        # No user follows the whole way into tables that nest deep; the line says where it ends.
        begin, left_out, end = rest, "", ()
        if len(rest) > _MOST_STEPS:
            begin, left_out, end = rest[:2], " …", rest[-2:]
        return f"{label}{_keys_said(begin)}{left_out}{_keys_said(end)}".strip()

    def _line(self, path: Path, problem: str) -> str:
        """File and line of a place, or of the key in it whose words begin the problem."""
        table = self._at(path)
        if isinstance(table, dict):
            path = (*path, *_steps_of(problem, table))
        lines = lines_of(self._text, path)
        while path and path not in lines:
            path = path[:-1]
        return f"{self._where} line {lines[path]}" if path else self._where

    def _at(self, path: Path) -> Any:
        """Value at a path in the file; None if there is none."""
        value: Any = self._tree
        try:
            for step in path:
                value = value[step]
        except (KeyError, IndexError, TypeError):
            return None
        return value


def _keys_said(path: Path) -> str:
    """Keys and numbers of items, in words."""
    return "".join(f", number {s + 1}" if isinstance(s, int) else f" {s}" for s in path)


def quote(value: object) -> str:
    """Text for a value of a file, short enough to stand in a sentence."""
    try:
        said = repr(value)
    except ValueError:  # Python refuses to write numbers of thousands of digits
        return "too large a number"
    return said if len(said) <= _LONGEST_QUOTE else f"{said[:_LONGEST_QUOTE]}…"


def which(name: str, names: Collection[str]) -> str:
    """End of a sentence about an unknown name: the nearest known name, if any, and all known."""
    near = nearest(name, names)
    return f"{near}{', and' if near else ';'} there is {', '.join(sorted(names))}"


def _is_good(value: object, spaces: dict[int, str]) -> bool:
    """Tell whether a plain value is no string with control characters, nor too large."""
    if isinstance(value, str):
        return value.isprintable() or value.translate(spaces).isprintable()
    return not isinstance(value, int) or abs(value) <= _MOST_WHOLE


def _levels(tree: object) -> int:
    """Levels of tables and lists in a file, counted no further than is of use."""
    level: list[Any] = [tree]
    number = 0
    while level and number <= _MOST_LEVELS:
        inner = [v.values() if isinstance(v, dict) else v for v in level]
        level = [v for values in inner for v in values if isinstance(v, dict | list)]
        number += 1
    return number


def _leaves(tree: object) -> Iterator[tuple[Path, object]]:
    """All values of a file that contain no other values, with their paths, at any depth."""
    left: list[tuple[Path, object]] = [((), tree)]
    while left:
        path, value = left.pop()
        if isinstance(value, dict):
            left += [((*path, key), inner) for key, inner in value.items()]
        elif isinstance(value, list):
            left += [((*path, item), inner) for item, inner in enumerate(value)]
        else:
            yield path, value


def _types_at(kind: type, path: Path) -> list[inspect.Type]:
    """Types that the value at a path may have."""
    types = _each(inspect.type_info(kind))
    for step in path:
        found: list[inspect.Type] = []
        for t in types:
            if isinstance(t, inspect.StructType) and t.array_like:
                found += _each(t.fields[int(step)].type)
            elif isinstance(t, inspect.StructType):
                found += [t2 for f in t.fields if f.encode_name == step for t2 in _each(f.type)]
                found += [inspect.LiteralType((t.tag,))] if step == t.tag_field else []
            elif isinstance(t, inspect.VarTupleType):
                found += _each(t.item_type)
        types = found
    return types


def _each(t: inspect.Type) -> list[inspect.Type]:
    return list(t.types) if isinstance(t, inspect.UnionType) else [t]


def _is_tables(t: inspect.Type) -> bool:
    return isinstance(t, inspect.VarTupleType) and isinstance(t.item_type, inspect.StructType)


def _keys(kind: inspect.StructType) -> list[str]:
    tag = [kind.tag_field] if kind.tag_field else []
    return [*(field.encode_name for field in kind.fields), *tag]


def _steps_of(problem: str, table: dict[str, Any]) -> Path:
    """Path to the key of a table, or item of it, whose words begin a problem; empty if none."""
    said = problem.lstrip("'\"").replace("_", " ")
    for key in sorted(table, key=len, reverse=True):
        words = re.escape(_UNIT.sub("", key).replace("_", " "))
        named = re.match(rf"{words}(?!\w)(?:, number (\d+))?", said)
        if named:
            return (key, int(named[1]) - 1) if named[1] else (key,)
    return ()
