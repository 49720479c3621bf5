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
from vbraille.simulation.motion import MOST_MM, SLACK, Motion
from vbraille.wording import nearest, printable

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

# Ours: what a hand does in half a second cannot be told from its two ends.
MAX_GAP_S = 0.5
COLUMNS = ("t_s", "x_mm", "y_mm", "theta_deg")  # the last two may be left out
_NEEDED = 2
_MOST_DEG = 360_000.0


@dataclass(frozen=True, slots=True, eq=False)
class Recorded:
    """A hand that was recorded: one motion over the whole reading, not one for each line.

    Parameters
    ----------
    t_s : float64[n]
        Time of each sample, beginning anywhere, increasing by at most `MAX_GAP_S`.
    x_mm, y_mm, theta_rad : float64[n]
        Places and angles of the array as in `Motion`; the last two are None if they were not
        recorded.

    Raises
    ------
    ValueError
        If the values make no `Motion`, or there is a gap in time.
    """

    t_s: NDArray[np.float64]
    x_mm: NDArray[np.float64]
    y_mm: NDArray[np.float64] | None = None
    theta_rad: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        gap_s = float(np.diff(self.motion().t_s).max())
        if gap_s > MAX_GAP_S + SLACK:
            raise ValueError(f"there is a gap of {gap_s:g} s; it must be at most {MAX_GAP_S:g} s")

    def motion(self) -> Motion:
        """Return the whole reading, its times shifted to begin at 0."""
        return Motion(self.t_s - self.t_s[:1], self.x_mm, self.y_mm, self.theta_rad)


def load_recorded(path: Path | str) -> Recorded:
    """Read a recorded hand from a CSV file.

    Parameters
    ----------
    path
        UTF-8, commas between fields. Either a header names the columns
        ``t_s`` and ``x_mm``, perhaps ``y_mm`` and ``theta_deg``, and no others;
        or each row is just these numbers, two to four in that
        order. Blank lines are passed over. ``x_mm`` is where the array is along
        its lines: half its span left of its centre, which is where its left
        column is as long as it is not turned. ``y_mm`` is where its centre is
        below the top of the page. ``theta_deg`` is how far it is turned,
        against the clock as the reader sees it.

    Returns
    -------
    Recorded
        Recorded hand, whose times begin at 0.

    Raises
    ------
    InputError
        If the file is missing, a directory, unreadable, not text or empty;
        if a column is missing, named twice, or another than these; if a field is not a number or
        not finite, or a position beyond `MOST_MM`, or an angle beyond 1000
        turns; if time does not increase, or leaves a gap.
    """
    rows = _rows(path)
    where, fields = next(rows, ("", []))
    if not fields:
        raise InputError(f"{path} is empty; give a CSV file with the columns t_s and x_mm")
    if any(_is_number(field) for field in fields):
        if not _NEEDED <= len(fields) <= len(COLUMNS):
            raise InputError(
                f"{where} has neither names nor two to four numbers; name the columns t_s and "
                f"x_mm there"
            )
        names, rows = list(COLUMNS[: len(fields)]), chain([(where, fields)], rows)
    else:
        names = [field.strip() for field in fields]
        for number, name in enumerate(COLUMNS):
            if names.count(name) > 1 or (number < _NEEDED and name not in names):
                raise InputError(
                    f"{where} does not name one column {name}; "
                    f"name one t_s and one x_mm, with a comma between"
                )
        for name in names:
            if name not in COLUMNS:
                raise InputError(
                    f"{where} names a column {printable(name)!r}, which no hand has"
                    f"{nearest(name, COLUMNS)}; there are {', '.join(COLUMNS)}"
                )
    places = {name: names.index(name) for name in COLUMNS if name in names}
    t_s = array("d")
    where_it_was = {name: array("d") for name in places if name != "t_s"}
    origin_s = 0.0
    for where, fields in rows:
        if len(fields) != len(names):
            raise InputError(
                f"{where} has more or fewer fields than the first line; give it {len(names)}"
            )
        time_s = _number(fields[places["t_s"]], "t_s", where)
        for name, values in where_it_was.items():
            values.append(_bounded(fields[places[name]], name, where))
        if t_s:
            _check_step(time_s - origin_s - t_s[-1], where)
        else:
            origin_s = time_s
        t_s.append(time_s - origin_s)
    if len(t_s) < 2:
        raise InputError(f"{path} has fewer than 2 samples; record for longer")
    x_mm, y_mm, theta_deg = (
        np.array(where_it_was[name]) if name in where_it_was else None for name in COLUMNS[1:]
    )
    assert x_mm is not None, "it was seen to be named"
    return Recorded(np.array(t_s), x_mm, y_mm, None if theta_deg is None else np.deg2rad(theta_deg))


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
    """Value of a field, which must be a finite number."""
    try:
        value = float(field)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        shown = repr(shorten(field, 40)) if field.strip() else "empty"
        raise InputError(f"{where}: {name} is {shown}; give a number, or leave the line out")
    return value


def _bounded(field: str, name: str, where: str) -> float:
    """Value of a field that is a place of the array, within the bounds of places."""
    value = _number(field, name, where)
    most, unit = (_MOST_DEG, "degrees") if name == "theta_deg" else (MOST_MM, "mm")
    if abs(value) > most:
        raise InputError(f"{where}: {name} is {value:g}; it must be {-most:g} to {most:g} {unit}")
    return value


def _check_step(step_s: float, where: str) -> None:
    """Raise InputError for a sample that does not follow the one before, or follows it too late."""
    if step_s <= 0:
        raise InputError(
            f"{where}: t_s is not later than in the sample before; put the lines in order of time"
        )
    if step_s > MAX_GAP_S + SLACK:
        raise InputError(
            f"{where}: nothing was recorded for {step_s:g} s; "
            f"cut the file there, a gap may be {MAX_GAP_S:g} s long"
        )
