"""A hand that was recorded, from a CSV file of times and places."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.csvfiles import SEPARATORS, parse_csv
from vbraille.errors import InputError
from vbraille.files import read_text
from vbraille.simulation.hand import Hand
from vbraille.simulation.motion import MOST_MM, SLACK, Motion
from vbraille.wording import nearest

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.simulation.steering import Area

MOST_BYTES = 100_000_000
# Ours: what a hand does in half a second cannot be told from its two ends.
MAX_GAP_S = 0.5
# Columns, and the largest value of each; the last two may be left out.
COLUMNS = {"t_s": 1e9, "x_mm": MOST_MM, "y_mm": MOST_MM, "theta_deg": 360_000.0}
_NEEDED = ("t_s", "x_mm")


class Recorded(Hand):
    """A hand that was recorded: one motion over the whole reading, not one for each line.

    Parameters
    ----------
    motion
        That motion.
    """

    goes_on = True

    def __init__(self, motion: Motion) -> None:
        self.motion = motion

    def read_line(self, start_mm: float, end_mm: float) -> Motion:  # noqa: ARG002
        """Return the whole motion, whatever the line."""
        return self.motion

    def read_page(self, area: Area) -> Motion:  # noqa: ARG002
        """Return the whole motion, whatever the page."""
        return self.motion


def load_recorded(path: Path | str) -> Recorded:
    """Read a recorded hand from a CSV file.

    Parameters
    ----------
    path
        A table, as in `vbraille.csvfiles`. Either its first row names the columns ``t_s`` and
        ``x_mm``, perhaps ``y_mm`` and ``theta_deg``, and no others; or each row is just these
        numbers, two to four in that order. ``x_mm`` is where the array is along its lines: half its
        span left of its centre, which is where its left column is as long as it is not turned.
        ``y_mm`` is where its centre is below the top of the page. ``theta_deg`` is how far it is
        turned, against the clock as the reader sees it.

    Raises
    ------
    InputError
        If the file cannot be read; if a column is missing or another than these; if a cell is not
        a finite number or out of range; if time does not increase, or leaves a gap.
    """
    text = read_text(path, "CSV file", MOST_BYTES)
    first = text.lstrip().partition("\n")[0]
    columns = [*COLUMNS][: 1 + max(map(first.count, SEPARATORS))]
    is_named = not first or first[0].isalpha() or first[0] == '"'
    sheet = parse_csv(text.encode(), str(path), () if is_named else columns)
    for name in sheet.columns:
        if name not in COLUMNS:
            raise InputError(
                f"{path} names a column {name!r}, which hands do not have{nearest(name, COLUMNS)}; "
                f"there are {', '.join(COLUMNS)}"
            )
    for name in _NEEDED:
        if name not in sheet.columns:
            raise InputError(f"{path} does not name a column {name}; name t_s and x_mm")
    if len(sheet.rows) < 2:
        raise InputError(f"{path} has fewer than 2 samples; record for longer")
    samples = []
    for row, line in zip(sheet.rows, sheet.lines, strict=True):
        where = f"{path}, line {line}"
        cells = zip(row, sheet.columns, strict=True)
        samples.append([_number(cell, name, where) for cell, name in cells])
    columns = dict(zip(sheet.columns, np.array(samples).T, strict=True))
    steps_s = np.diff(columns["t_s"])
    wrong = ~((steps_s > 0) & (steps_s <= MAX_GAP_S + SLACK))
    if wrong.any():
        at = int(wrong.argmax())
        raise InputError(
            f"{path}, line {sheet.lines[at + 1]}: t_s is {steps_s[at]:g} s later than in "
            f"the sample before; it must be later, by at most {MAX_GAP_S:g} s"
        )
    t_s, theta_deg = columns["t_s"], columns.get("theta_deg")
    theta_rad = None if theta_deg is None else np.deg2rad(theta_deg)
    motion = Motion(t_s - t_s[0], columns["x_mm"], columns.get("y_mm"), theta_rad)
    return Recorded(motion)


def _number(cell: str, name: str, where: str) -> float:
    """Return the number in a cell, which must be finite and in the range of its column."""
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    most = COLUMNS[name]
    if not (math.isfinite(value) and abs(value) <= most):
        raise InputError(
            f"{where}: {name} is {cell[:40]!r}; give a number from {-most:g} to {most:g}"
        )
    return value
