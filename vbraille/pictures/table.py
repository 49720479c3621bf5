"""The numbers of one picture, which are drawn, or written as CSV."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from typing import TextIO

    from numpy.typing import NDArray

    from vbraille.render.braille.tuning import Tuning


@dataclass(frozen=True, slots=True, eq=False)
class FigureTable:
    """All that one picture draws.

    Parameters
    ----------
    kind
        Which picture it is: profile, mapping, wave, strain, page or resolution.
    title
        What the picture shows, in a line.
    columns
        Values by name, all of one length; the names tell the units. NaN stands
        where a row has no such value.

    Raises
    ------
    ValueError
        If the columns differ in length.
    """

    kind: str
    title: str
    columns: Mapping[str, NDArray]

    def __post_init__(self) -> None:
        lengths = {name: len(values) for name, values in self.columns.items()}
        if len(set(lengths.values())) > 1:
            raise ValueError(f"the columns of a table differ in length: {lengths}")

    def __getitem__(self, name: str) -> NDArray:
        return self.columns[name]

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def where(self, name: str, value: object) -> FigureTable:
        """Return the rows in which a column has a value."""
        chosen = self.columns[name] == value
        return replace(self, columns={n: v[chosen] for n, v in self.columns.items()})

    def rows(self) -> Iterator[tuple]:
        """Tell the values row by row, as plain Python values."""
        return zip(*(values.tolist() for values in self.columns.values()), strict=True)


def write_csv(table: FigureTable, stream: TextIO) -> None:
    """Write a table, its column names first, and its numbers to the sixth decimal."""
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(table.columns)
    writer.writerows(map(_spell, row) for row in table.rows())


def tuning_words(tuning: Tuning) -> str:
    """Name the texture, and the contrast if it is turned down, for the end of a title."""
    return f", T = {100 * tuning.texture:g} %{contrast_words(tuning)}"


def contrast_words(tuning: Tuning) -> str:
    """Name the contrast for the end of a title; nothing if it is full."""
    return "" if tuning.contrast == 1 else f", contrast {100 * tuning.contrast:g} %"


def _spell(value: str | float) -> str:
    if isinstance(value, str):
        return value
    if math.isnan(value):
        return ""
    return f"{round(value, 6) + 0.0:.12g}"  # + 0.0, so that no "-0" is written
