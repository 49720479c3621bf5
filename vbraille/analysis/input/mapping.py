"""A mapping file: where another program's tables have what the analysis needs, in TOML."""

from __future__ import annotations

import codecs
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import msgspec

from vbraille.analysis.input.parsing import NEEDED
from vbraille.toml.textfile import read_text
from vbraille.toml.tomlfile import Table, TomlFile

if TYPE_CHECKING:
    from collections.abc import Mapping

_DELIMITERS = {"comma": ",", "semicolon": ";", "tab": "\t"}
_CHANGES = ("key", "pattern", "missing", "pick", "replace", "times", "plus")

Scalar = str | int | float


class _FormTable(Table, frozen=True):
    """How the other program writes its files."""

    kind: Literal["csv", "json"] | None = None
    encoding: str | None = None
    delimiter: Literal["comma", "semicolon", "tab"] | None = None
    escape: Literal["\\"] | None = None

    def __post_init__(self) -> None:
        if self.encoding is not None:
            try:
                codecs.lookup(self.encoding)
            except LookupError:
                raise ValueError(
                    f"encoding is {self.encoding!r}, which is none; give utf-8 or cp1252, say, or "
                    f"leave it out"
                ) from None
        if self.kind == "json" and (self.delimiter or self.escape):
            which = "delimiter" if self.delimiter else "escape"
            raise ValueError(f"{which} is of CSV files; leave it out of kind = 'json'")

    @property
    def sign(self) -> str | None:
        """Sign between columns; None if the file itself tells."""
        return None if self.delimiter is None else _DELIMITERS[self.delimiter]


class ColumnSource(Table, frozen=True):
    """Where one of our columns comes from, and what is done to its values.

    What is given is done in the order of the parameters.

    Parameters
    ----------
    from_
        Column of the other program, or columns whose values are joined by a blank; ``from`` in the
        file.
    always
        Value of all rows, in place of a column.
    key
        Key of the value that is taken, where a column's values are objects of JSON.
    pattern
        Regular expression; the part that its one group matches is the value, and nothing if it
        matches nowhere.
    missing
        Values that mean that there is none, such as "NA"; each of the columns that are joined may
        have them.
    pick
        Columns of the other program, by the values for which the row's value in that column is
        taken.
    replace
        Values that stand for others: the other program's first.
    times, plus
        Number that a number is multiplied by, and one that is added to it.
    """

    from_: str | tuple[str, ...] | None = msgspec.field(name="from", default=None)
    always: Scalar | None = None
    key: str | None = None
    pattern: str | None = None
    missing: tuple[Scalar, ...] = ()
    pick: dict[str, str] = {}  # noqa: RUF012 - msgspec copies it
    replace: dict[str, Scalar] = {}  # noqa: RUF012 - msgspec copies it
    times: float | None = None
    plus: float | None = None

    def __post_init__(self) -> None:
        if (self.from_ is None) == (self.always is None):
            raise ValueError("needs either from, a column, or always, a value of all rows")
        if self.always is not None:
            more = [name for name in _CHANGES if getattr(self, name) not in (None, (), {})]
            if more:
                raise ValueError(f"{more[0]} changes a column's values; leave it out beside always")
        if not self.columns and self.always is None:
            raise ValueError("from names no column; name one")
        if self.key is not None and len(self.columns) > 1:
            raise ValueError("key is of one column; name one in from")
        if self.pattern is not None:
            try:
                groups = re.compile(self.pattern).groups
            except re.error as error:
                raise ValueError(f"pattern is no regular expression: {error}") from None
            if groups != 1:
                raise ValueError(f"pattern has {groups} groups; put one pair of ( ) in it")

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns of the other program whose values are joined."""
        if isinstance(self.from_, str):
            return (self.from_,)
        return self.from_ or ()


class RowRule(Table, frozen=True):
    """A rule by which rows are left out.

    Parameters
    ----------
    column
        Column of the other program.
    is_, is_not
        Values of the rows that are left out, or of those alone that stay; ``is`` in the file.
    reason
        Why they are left out, for the report.
    """

    column: str
    reason: str
    is_: tuple[Scalar, ...] | None = msgspec.field(name="is", default=None)
    is_not: tuple[Scalar, ...] | None = None

    def __post_init__(self) -> None:
        if (self.is_ is None) == (self.is_not is None):
            raise ValueError("needs either is, or is_not: a list of values")
        if not self.reason.strip():
            raise ValueError("reason is empty; say why these rows are left out")

    def leaves_out(self, value: str) -> bool:
        """Whether the rule leaves a row with this value out."""
        if self.is_ is not None:
            return value in map(spelling, self.is_)
        return value not in map(spelling, self.is_not or ())


class _MappingTable(Table, frozen=True):
    """The mapping file as a whole; columns are read one by one."""

    format: Literal[1]
    columns: dict[str, dict]
    program: str = ""
    file: _FormTable = _FormTable()
    leave_out: tuple[RowRule, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class TrialMapping:
    """How trials of another program become trials of ours.

    Parameters
    ----------
    where
        Name of the mapping file, for messages.
    program
        Words for the other program, for the report; empty if the file has none.
    kind, encoding, delimiter, escape
        How its files are written: "csv" or "json", and so on; None for what each file tells.
    columns
        Where each of our columns comes from, by its name.
    rules
        Which rows are left out.
    lines
        Lines of the columns and the rules in the mapping file, by column or number of the rule.
    """

    where: str
    program: str
    kind: str | None
    encoding: str | None
    delimiter: str | None
    escape: str | None
    columns: Mapping[str, ColumnSource]
    rules: tuple[RowRule, ...]
    lines: Mapping[str | int, int]

    def place(self, what: str | int) -> str:
        """Words for where the mapping has a column or a rule."""
        return f"{self.where} line {self.lines[what]}" if what in self.lines else self.where


def load_mapping(path: str | Path) -> TrialMapping:
    """Read a mapping file.

    Raises
    ------
    InputError
        If it cannot be read, or is no mapping; the sentence has the line.
    """
    return parse_mapping(read_text(path, "mapping"), Path(path).name)


def parse_mapping(text: str, where: str) -> TrialMapping:
    """Read the text of a mapping file.

    Parameters
    ----------
    where
        Name of the file, for messages.

    Raises
    ------
    InputError
        If it is no mapping; the sentence has the line.
    """
    file = TomlFile(text, where)
    for name in file.names("columns"):
        if not file.is_table("columns", name):
            file.fail(("columns", name), 'must be a table, such as { from = "their column" }')
    table = file.read(_MappingTable)
    columns = {
        name: file.read(ColumnSource, under=("columns", name)) for name in file.names("columns")
    }
    missing = [name for name in NEEDED if name not in columns]
    if missing:
        file.fail(
            ("columns",),
            f"lacks {', '.join(missing)}; say where the table has it, with from, or what it "
            f"always is",
        )
    for name, source in columns.items():
        _check_replaced(file, name, source)
    lines = file.lines()
    found = {name: lines[("columns", name)] for name in columns if ("columns", name) in lines}
    ruled = {
        number: lines[("leave_out", number)]
        for number in range(len(table.leave_out))
        if ("leave_out", number) in lines
    }
    form = table.file
    return TrialMapping(
        where,
        table.program,
        form.kind,
        form.encoding,
        form.sign,
        form.escape,
        columns,
        table.leave_out,
        {**found, **ruled},
    )


def spelling(value: Scalar) -> str:
    """Text that a value of a mapping file stands for in a table."""
    if isinstance(value, str):
        return value.strip()
    return str(value).removesuffix(".0")


def _check_replaced(file: TomlFile, name: str, source: ColumnSource) -> None:
    """Raise InputError if a value is picked by one rule and replaced by another."""
    both = sorted(set(source.pick) & set(source.replace))
    if both:
        file.fail(
            ("columns", name),
            f"replaces {both[0]!r} and picks a column for it; leave one of them out",
        )
