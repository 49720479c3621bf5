"""Reading of a calibration's file; apart from `calibrations`, since most have no such file."""

from __future__ import annotations

from vbraille.devices.calibration import Calibration, State, Tried
from vbraille.display import MOST_COLUMNS, MOST_ROWS
from vbraille.errors import check_range
from vbraille.tomlfile import Table, TomlFile


class ActuatorTable(Table, frozen=True):
    """A table ``[[actuator]]``: what was found of one actuator."""

    row: int
    column: int
    state: State = "ok"
    inverted: bool = False
    gain: float = 1.0

    def __post_init__(self) -> None:
        self.tried()

    def tried(self) -> Tried:
        """The same with rows and columns that count from 0."""
        check_range("row", self.row, 1, MOST_ROWS)
        check_range("column", self.column, 1, MOST_COLUMNS)
        return Tried(self.row - 1, self.column - 1, self.state, self.inverted, self.gain)


class CalibrationTable(Table, frozen=True):
    """A calibration's file as a whole."""

    device: str
    rows: int
    columns: int
    actuator: tuple[ActuatorTable, ...] = ()


def parse(text: str, where: str) -> Calibration:
    """Read a calibration.

    Parameters
    ----------
    text
        Text of the file.
    where
        Name of the file, for messages.

    Raises
    ------
    InputError
        If the text is no calibration; one sentence says the line and the key.
    """
    file = TomlFile(text, where)
    found = file.read(CalibrationTable)
    with file.checking():
        return Calibration(
            found.device,
            found.rows,
            found.columns,
            tuple(one.tried() for one in found.actuator),
        )
