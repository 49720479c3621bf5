"""In which line of a TOML text each key, table and item stands, which `tomllib` does not tell."""

from __future__ import annotations

import re
import tomllib
from collections import Counter

# Keys of tables and numbers of items, from 0, that lead from the whole file to a value in it.
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


def lines_of(text: str) -> dict[Path, int]:
    r"""Line of every key, table and item, from 1, by its path.

    Parameters
    ----------
    text
        A TOML text that `tomllib` has read; of any other the lines mean nothing.

    Examples
    --------
    >>> lines_of('size = 3\n[[box]]\nnames = [\n  "a",\n  "b",\n]')["box", 0, "names", 1]
    5
    """
    scan = _Scan(text)
    table: Path = ()
    while scan.token:
        if scan.token == "[":
            table = scan.header()
        elif scan.token == "\n":
            scan.take()
        else:
            scan.pair(table)
    return scan.lines


class _Scan:
    """The tokens of a text, taken one after the other, and the lines that are known so far."""

    def __init__(self, text: str) -> None:
        self.lines: dict[Path, int] = {}
        self.line = 1
        self._tables: Counter[Path] = Counter()  # under each [[name]] so far
        self._matches = _TOKEN.finditer(text)
        self.token = ""
        self.take()

    def take(self) -> str:
        """Go on to the next token, which is empty at the end, and return the one before it."""
        taken, self.token = self.token, ""
        self.line += taken.count("\n")
        for match in self._matches:
            if match["nothing"] is None:
                self.token = match[0]
                break
        return taken

    def header(self) -> Path:
        """Path of the table that ``[a.b]`` or ``[[a.b]]`` begins."""
        self.take()
        several, line = self.token == "[", self.line
        if several:
            self.take()
        *before, last = self._keys()
        path: Path = ()
        for key in before:
            path = (*path, key)
            self.lines.setdefault(path, line)
            if path in self._tables:
                path = (*path, self._tables[path] - 1)
        path = (*path, last)
        self.lines.setdefault(path, line)
        if several:
            self._tables[path] += 1
            path = (*path, self._tables[path] - 1)
        self.lines[path] = line
        while self.token == "]":
            self.take()
        return path

    def pair(self, path: Path) -> None:
        """Pass over a key and its value."""
        line = self.line
        for key in self._keys():
            path = (*path, key)
            self.lines.setdefault(path, line)
        self.take()
        self._value(path)

    def _keys(self) -> list[str]:
        """Keys of a dotted key."""
        keys = [_unquoted(self.take())]
        while self.token == ".":
            self.take()
            keys.append(_unquoted(self.take()))
        return keys

    def _value(self, path: Path) -> None:
        first, number = self.take(), 0
        if first not in ("[", "{"):
            while self.token not in ("\n", ",", "]", "}", ""):
                self.take()  # the rest of a number with a point, or of a date with a time
            return
        while self.token not in ("]", "}", ""):
            if self.token in ("\n", ","):
                number += self.take() == ","
            elif first == "{":
                self.pair(path)
            else:
                self.lines[*path, number] = self.line
                self._value((*path, number))
        self.take()


def _unquoted(key: str) -> str:
    return tomllib.loads(f"key = {key}")["key"] if key[0] in "\"'" else key
