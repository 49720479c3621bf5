"""Line numbers of the keys, tables and items of a TOML text, which `tomllib` does not tell."""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

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
