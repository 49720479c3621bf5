"""A table of a TOML file, from which values are taken one by one, each of its type."""

from __future__ import annotations

import difflib
from contextlib import contextmanager
from typing import TYPE_CHECKING, NoReturn

from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

# Beyond this TOML readers differ, and no number of a protocol is so large.
_MOST_WHOLE = 2**63 - 1
_LONGEST_QUOTE = 60


def nearest(name: str, names: Collection[str]) -> str:
    """End of a sentence that says what comes nearest to a name, and all that there is."""
    close = difflib.get_close_matches(name, names, n=1, cutoff=0.0)
    return f"; the nearest is {close[0]}, and there is {', '.join(sorted(names))}"


def quote(value: object) -> str:
    """A value of the file, as it can be said in a sentence."""
    try:
        said = repr(value)
    except ValueError:  # Python does not write whole numbers of thousands of digits
        return "too large a number"
    return said if len(said) <= _LONGEST_QUOTE else f"{said[:_LONGEST_QUOTE]}…"


class Section:
    """A table of a TOML file.

    Parameters
    ----------
    where
        The file, as messages name it.
    label
        The table as written in the file, ``[design]``; empty for the whole file.
    table
        As `tomllib` read it.
    known
        Its keys; None for any.

    Raises
    ------
    InputError
        If it is no table, or has a key that is not known.
    """

    def __init__(
        self, where: str, label: str, table: object, known: Collection[str] | None
    ) -> None:
        self._where = f"{where}: {label} " if label else f"{where}: "
        self._file = where
        if not isinstance(table, dict):
            raise InputError(f"{where}: {label} is {quote(table)}; it must be a table")
        self._table: dict[str, object] = table
        for key in self._table:
            if known is not None and key not in known:
                self.fail(f"has no key {quote(key)}{nearest(key, known)}")

    def __contains__(self, key: str) -> bool:
        return key in self._table

    def __iter__(self) -> Iterator[str]:
        return iter(self._table)

    def fail(self, problem: str) -> NoReturn:
        """Say what is wrong with this table.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError(f"{self._where}{problem}")

    @contextmanager
    def checking(self, about: str = "") -> Iterator[None]:
        """Name the file and the table in what values say of themselves.

        Raises
        ------
        InputError
            For a `ValueError` within.
        """
        try:
            yield
        except ValueError as error:
            self.fail(f"{about}{error}")

    def text(self, key: str, default: str | None = None) -> str:
        """A string of one line; without a default it must be there."""
        return self._line(key, self._take(key, default))

    def texts(self, key: str) -> tuple[str, ...]:
        """Strings of a list, in order."""
        return tuple(self._line(f"{key}, number {n},", v) for n, v in self._list(key))

    def number(self, key: str, default: float | None = None) -> float:
        """A number; without a default it must be there."""
        return self._number(key, self._take(key, default))

    def numbers(self, key: str) -> tuple[float, ...]:
        """Numbers of a list, in order."""
        return tuple(self._number(f"{key}, number {n},", v) for n, v in self._list(key))

    def maybe_number(self, key: str) -> float | None:
        """A number, or None if it is left out."""
        return self.number(key) if key in self else None

    def whole(self, key: str, default: int | None = None) -> int:
        """A whole number; without a default it must be there."""
        value = self._take(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or abs(value) > _MOST_WHOLE:
            self.fail(f"{key} is {quote(value)}; it must be a whole number")
        return value

    def maybe_whole(self, key: str) -> int | None:
        """A whole number, or None if it is left out."""
        return self.whole(key) if key in self else None

    def is_text(self, key: str) -> bool:
        """Whether a value that may be of several types is a string."""
        return isinstance(self._table.get(key), str)

    def flag(self, key: str, default: bool) -> bool:
        """True or false."""
        value = self._take(key, default)
        if not isinstance(value, bool):
            self.fail(f"{key} is {quote(value)}; it must be true or false")
        return value

    def one_of(self, key: str, options: Collection[str], default: str | None = None) -> str:
        """A string that is one of some; without a default it must be there."""
        value = self.text(key, default)
        if value not in options:
            self.fail(f"{key} is {quote(value)}{nearest(value, options)}")
        return value

    def table(self, key: str, known: Collection[str] | None) -> Section:
        """A table in this one; an empty one if it is left out."""
        return Section(self._file, f"[{key}]", self._table.get(key, {}), known)

    def tables(self, key: str, known: Collection[str]) -> list[Section]:
        """Tables of one name, each written under ``[[name]]``; none if they are left out."""
        value = self._table.get(key, [])
        if not isinstance(value, list):
            self.fail(f"{key} must be tables; write each under [[{key}]]")
        return [
            Section(self._file, f"[[{key}]] number {number}", table, known)
            for number, table in enumerate(value, 1)
        ]

    def _take(self, key: str, default: object) -> object:
        value = self._table.get(key, default)
        if value is None:
            self.fail(f"lacks {key}; add it")
        return value

    def _list(self, key: str) -> list[tuple[int, object]]:
        value = self._take(key, None)
        if not isinstance(value, list):
            self.fail(f"{key} is {quote(value)}; it must be a list, in brackets")
        return list(enumerate(value, 1))

    def _line(self, key: str, value: object) -> str:
        if not isinstance(value, str):
            self.fail(f"{key} is {quote(value)}; it must be a string, in quotation marks")
        if not value.isprintable():
            self.fail(f"{key} is {quote(value)}; it must be one line without control characters")
        return value

    def _number(self, key: str, value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail(f"{key} is {quote(value)}; it must be a number")
        try:
            return float(value)
        except OverflowError:
            self.fail(f"{key} is {quote(value)}; it must be a smaller number")
