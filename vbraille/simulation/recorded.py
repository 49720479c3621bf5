"""A hand that was recorded, from a CSV file of times and places."""

from __future__ import annotations

import csv
import io
import math
from array import array
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from textwrap import shorten
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import InputError
from vbraille.simulation.motion import SLACK, Motion

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

# Ours: what a hand does in half a second cannot be told from its two ends.
MAX_GAP_S = 0.5
MOST_MM = 10_000.0  # as far as any carriage goes
COLUMNS = ("t_s", "x_mm")


@dataclass(frozen=True, slots=True, eq=False)
class Recorded:
    """A hand that was recorded: one motion over the whole reading, not one a line.

    Parameters
    ----------
    t_s : float64[n]
        Time of each sample, from anywhere, increasing by at most `MAX_GAP_S`.
    x_mm : float64[n]
        Where the array's left column was then.

    Raises
    ------
    ValueError
        If they make no `Motion`, or there is a gap.
    """

    t_s: NDArray[np.float64]
    x_mm: NDArray[np.float64]

    def __post_init__(self) -> None:
        gap_s = float(np.diff(self.motion().t_s).max())
        if gap_s > MAX_GAP_S + SLACK:
            raise ValueError(f"there is a gap of {gap_s:g} s; it must be at most {MAX_GAP_S:g} s")

    def motion(self) -> Motion:
        """Return the whole reading, its times shifted to begin at 0."""
        return Motion(self.t_s - self.t_s[:1], self.x_mm)


def load_recorded(path: Path | str) -> Recorded:
    """Read a recorded hand from a CSV file.

    Parameters
    ----------
    path
        UTF-8, commas between fields. Either a header names the columns
        ``t_s`` and ``x_mm``, and others are passed over, or each row is just
        these two numbers. Blank lines are passed over.

    Returns
    -------
    Recorded
        Its times begin at 0.

    Raises
    ------
    InputError
        If the file is missing, a directory, unreadable, not text or empty;
        if a column is missing; if a field is not a number or not finite, or
        a position beyond `MOST_MM`; if time does not increase, or leaves a gap.
    """
    rows = _rows(path)
    where, fields = next(rows, ("", []))
    if not fields:
        raise InputError(f"{path} is empty; give a CSV file with the columns t_s and x_mm")
    if any(_is_number(field) for field in fields):
        if len(fields) != len(COLUMNS):
            raise InputError(
                f"{where} has neither names nor two numbers; name the columns t_s and x_mm there"
            )
        names, rows = list(COLUMNS), chain([(where, fields)], rows)
    else:
        names = [field.strip() for field in fields]
        for name in COLUMNS:
            if names.count(name) != 1:
                raise InputError(
                    f"{where} does not name one column {name}; "
                    f"name one t_s and one x_mm, with a comma between"
                )
    t_place, x_place = (names.index(name) for name in COLUMNS)
    t_s, x_mm = array("d"), array("d")
    origin_s = 0.0
    for where, fields in rows:
        if len(fields) != len(names):
            raise InputError(
                f"{where} has more or fewer fields than the first line; give it {len(names)}"
            )
        time_s = _number(fields[t_place], "t_s", where)
        place_mm = _number(fields[x_place], "x_mm", where)
        if abs(place_mm) > MOST_MM:
            raise InputError(
                f"{where}: x_mm is {place_mm:g}; it must be {-MOST_MM:g} to {MOST_MM:g} mm"
            )
        if t_s:
            _check_step(time_s - origin_s - t_s[-1], where)
        else:
            origin_s = time_s
        t_s.append(time_s - origin_s)
        x_mm.append(place_mm)
    if len(t_s) < 2:
        raise InputError(f"{path} has fewer than 2 samples; record for longer")
    return Recorded(np.array(t_s), np.array(x_mm))


def _rows(path: Path | str) -> Iterator[tuple[str, list[str]]]:
    """Rows of a CSV file that are not blank, each with the place to name in messages."""
    try:
        text = Path(path).read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"there is no file {path}; check the name") from None
    except IsADirectoryError:
        raise InputError(f"{path} is a directory; give a CSV file in it") from None
    except UnicodeDecodeError as error:
        line = 1 + error.object.count(b"\n", 0, error.start)
        raise InputError(f"{path}, line {line} is not UTF-8 text; give a CSV file") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{path} cannot be read: {reason}; check the file") from None
    rows = csv.reader(io.StringIO(text, newline=""))
    try:
        for fields in rows:
            if len(fields) > 1 or "".join(fields).strip():
                yield f"{path}, line {rows.line_num}", fields
    except csv.Error as error:
        raise InputError(
            f"{path}, line {rows.line_num} is not CSV: {error}; give a CSV file"
        ) from None


def _is_number(field: str) -> bool:
    try:
        float(field)
    except ValueError:
        return False
    return True


def _number(field: str, name: str, where: str) -> float:
    """Value of a field, finite."""
    try:
        value = float(field)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        shown = repr(shorten(field, 40)) if field.strip() else "empty"
        raise InputError(f"{where}: {name} is {shown}; give a number, or leave the line out")
    return value


def _check_step(step_s: float, where: str) -> None:
    """Refuse a sample that is not later than the one before, or too late."""
    if step_s <= 0:
        raise InputError(
            f"{where}: t_s is not later than in the sample before; put the lines in order of time"
        )
    if step_s > MAX_GAP_S + SLACK:
        raise InputError(
            f"{where}: nothing was recorded for {step_s:g} s; "
            f"cut the file there, a gap may be {MAX_GAP_S:g} s long"
        )
